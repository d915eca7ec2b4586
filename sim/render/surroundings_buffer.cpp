#include "sim/render/surroundings_buffer.hpp"

#include <cmath>
#include <map>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

Surroundings::Place SurroundingsBuffer::placed(double height_m) const {
  Surroundings::Place place = simulation_.surroundings->placeAt(height_m);
  place.share = std::round(place.share * kSteps) / kSteps;
  return place;
}

void SurroundingsBuffer::setState(const WorldState& state) {
  std::vector<Surroundings::Place> places;
  for (const Pose& pose : state.entities) places.push_back(placed(simulation_.frame.height(pose.position)));
  places.push_back(placed(0.0));
  if (places == places_) return;
  places_ = std::move(places);
  at_.clear();
  std::vector<float> all;
  std::map<Surroundings::Place, float> known;
  for (const auto& place : places_) {
    const auto [at, isNew] = known.try_emplace(place, static_cast<float>(all.size() / 4));
    if (isNew) append(place, all);
    at_.push_back(at->second);
  }
  buffer_.upload(all);
}

void SurroundingsBuffer::append(const Surroundings::Place& place, std::vector<float>& into) const {
  const NodeSurroundings::Light light = light_.lightAt(place);
  const auto put = [&](double v) { into.push_back(static_cast<float>(v)); };
  const auto fill = [&] { into.resize((into.size() + 3) / 4 * 4, 0.0f); };
  put(light.grid.horizon_rad), put(light.grid.turn_rad / (2.0 * kPi)), fill();
  for (const Harmonics& h : light.harmonics) {
    for (double v : h) put(v);
    fill();
  }
  for (const auto& rest : light.rest)
    for (std::size_t g = 0; g < rest.size() / nodes_; ++g) {
      for (std::size_t i = 0; i < nodes_; ++i) put(rest[g * nodes_ + i]);
      fill();
    }
}

void SurroundingsBuffer::addConstants(ShaderSlots& slots) const {
  const DirectionGrid grid = simulation_.surroundings->grids().front().finer();
  const NodeSurroundings::Blurs wide = light_.blursInUse(false), sharp = light_.blursInUse(true);
  slots.constants["AROUND_FIRST"] = wide.first;
  slots.constants["AROUND_BLURS"] = wide.count;
  slots.constants["AROUND_SHARP_FIRST"] = sharp.first;
  slots.constants["AROUND_SHARP_BLURS"] = sharp.count;
  slots.constants["AROUND_ABOVE"] = grid.above;
  slots.constants["AROUND_BELOW"] = grid.below;
  slots.constants["AROUND_AZIMUTHS"] = grid.azimuths;
}

}  // namespace pitviper
