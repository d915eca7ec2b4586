#include "sim/world/field_states.hpp"

#include "sim/world/light_legs.hpp"
#include "sim/world/ray_hits.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// At which clouds dim what shines on fields, whose share of the sun has no wavelength.
constexpr double kShade_um = 0.55;

}  // namespace

FieldStates::FieldStates(const Simulation& simulation, const WorldState& state) : simulation_(simulation), world_(state), places_(simulation.fields.size()) {
  world_.fields.reset();
}

const FieldState* FieldStates::at(std::size_t field) const {
  Place& place = places_[field];
  std::call_once(place.once, [&] {
    const FieldWorld world{&simulation_,
                           world_.time_s,
                           [this](int entity, double time_s) {
                             return time_s == world_.time_s ? world_.bodyPose(static_cast<std::size_t>(entity)) : poseOf(simulation_, entity, time_s);
                           },
                           [this](const glm::dvec3& at) { return sunAt(at); },
                           [this](int entity) {
                             const auto moved = world_.velocities.find(entity);
                             return moved == world_.velocities.end() ? std::nullopt : std::optional(moved->second);
                           },
                           throttleOf(static_cast<int>(field)),
                           [this](int store) {
                             const auto flies = world_.ejected.find(store);
                             return flies == world_.ejected.end() ? nullptr : flies->second;
                           }};
    place.state = simulation_.fields[field].source->at(world);
  });
  return place.state.get();
}

std::function<std::optional<double>(double)> FieldStates::throttleOf(int field) const {
  const auto set = world_.throttles.find(field);
  if (set == world_.throttles.end()) return {};
  return [steps = set->second](double time_s) { return steps->at(time_s); };
}

double FieldStates::sunAt(const glm::dvec3& place) const {
  if (!simulation_.sun) return 0.0;
  const SunHere sun = sunHere(simulation_, place);
  if (!(sun.share > 0.0) || !simulation_.shadows) return sun.share;
  const RayHits hits = castRay(simulation_, world_, place, sun.toSun, 0.0, nullptr, false, 0);
  if (hits.solid.entity >= 0) return 0.0;
  if (!simulation_.sunShade) return sun.share;
  const Medium& drops = *simulation_.materials[static_cast<std::size_t>(simulation_.sunShade->material)]->medium;
  return sun.share * std::exp(-simulation_.sunShade->grid().at(place) * drops.absorption_per_m(kShade_um));
}

}  // namespace pitviper
