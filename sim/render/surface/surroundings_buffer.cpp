#include "sim/render/surface/surroundings_buffer.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

SurroundingsBuffer::SurroundingsBuffer(const Simulation& simulation, const NodeSurroundings& light) : simulation_(simulation), light_(light) {
  for (const Entity& e : simulation.entities)
    reflects_.push_back(std::any_of(e.surfaces.begin(), e.surfaces.end(), [&](const Surface& s) { return !simulation.materialOf(s).reflections.empty(); }));
}

std::vector<Surroundings::Place> SurroundingsBuffer::placesOf(const WorldState& state, double steps) const {
  const auto placed = [&](double height_m) {
    Surroundings::Place place = simulation_.surroundings->placeAt(height_m);
    place.share = std::round(place.share * steps) / steps;
    return place;
  };
  const Surroundings::Place ground = placed(0.0);
  std::vector<Surroundings::Place> places;
  for (std::size_t e = 0; e < state.entities.size(); ++e)
    places.push_back(reflects_[e] ? placed(simulation_.frame.height(state.entities[e].position)) : ground);
  places.push_back(ground);
  return places;
}

void SurroundingsBuffer::setState(const WorldState& state) {
  double steps = kMostSteps;
  std::vector<Surroundings::Place> places = placesOf(state, steps);
  if (size_ == 0) size_ = told(places.back()).size();
  for (; steps > 1.0 && std::set(places.begin(), places.end()).size() * size_ * sizeof(float) > kMostBytes; places = placesOf(state, steps)) steps /= 2.0;
  if (places == places_) return;
  places_ = std::move(places);
  // Places that stay keep their slots; others go where there is room.
  const std::set<Surroundings::Place> wanted(places_.begin(), places_.end());
  std::map<Surroundings::Place, std::size_t> slotOf;
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    if (slots_[k] && wanted.contains(*slots_[k])) slotOf[*slots_[k]] = k;
    else slots_[k].reset();
  }
  const bool grows = wanted.size() > slots_.size();
  if (grows) {
    slots_.resize(wanted.size()), slotOf.clear(), std::fill(slots_.begin(), slots_.end(), std::nullopt);
    buffer_.upload(nullptr, wanted.size() * size_ * sizeof(float));
  }
  std::size_t free = 0;
  for (const auto& place : wanted) {
    if (slotOf.contains(place)) continue;
    while (slots_[free]) ++free;
    slots_[free] = place;
    slotOf[place] = free;
    const std::vector<float> own = told(place);
    buffer_.uploadPart(free * size_ * sizeof(float), own.data(), size_ * sizeof(float));
  }
  at_.clear();
  for (const auto& place : places_) at_.push_back(slotOf[place]);
}

std::vector<float> SurroundingsBuffer::told(const Surroundings::Place& place) const {
  const NodeSurroundings::Light light = light_.lightAt(place);
  std::vector<float> all;
  const auto put = [&](double v) { all.push_back(static_cast<float>(v)); };
  const auto fill = [&] { all.resize((all.size() + 3) / 4 * 4, 0.0f); };
  put(light.grid.horizon_rad), put(light.grid.turn_rad / (2.0 * kPi)), fill();
  for (const Harmonics& h : light.harmonics) {
    for (double v : h) put(v);
    fill();
  }
  all.insert(all.end(), light.rest.begin(), light.rest.end());
  return all;
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
