#include "sim/flight/flight_world.hpp"

#include <algorithm>
#include <cmath>

#include "sim/flight/flight_error.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/scene/gravity.hpp"

namespace pitviper {
namespace {

glm::dvec3 windAt(const std::vector<WindAt>& wind, double height_m) {
  if (wind.empty()) return glm::dvec3(0.0);
  if (!(height_m > wind.front().height_m)) return wind.front().velocity_m_s;
  if (!(height_m < wind.back().height_m)) return wind.back().velocity_m_s;
  const auto next = std::upper_bound(wind.begin(), wind.end(), height_m, [](double h, const WindAt& w) { return h < w.height_m; });
  const WindAt &a = *(next - 1), &b = *next;
  return glm::mix(a.velocity_m_s, b.velocity_m_s, (height_m - a.height_m) / (b.height_m - a.height_m));
}

}  // namespace

double heightIn(const FlightWorld& world, const glm::dvec3& position) {
  return world.uniform ? position.z + world.frame.origin().height_m : world.frame.altitude(position);
}

glm::dvec3 upIn(const FlightWorld& world, const glm::dvec3& position) { return world.uniform ? glm::dvec3(0.0, 0.0, 1.0) : world.frame.up(position); }

AirHere airIn(const FlightWorld& world, const glm::dvec3& position) {
  const double height_m = heightIn(world, position);
  AirHere air;
  air.wind_m_s = windAt(world.wind, height_m);
  if (world.uniform) {
    air.density_kg_m3 = world.uniform->density_kg_m3;
    air.soundSpeed_m_s = world.uniform->soundSpeed_m_s;
  } else {
    const StandardAir standard = standardAir(height_m);
    air.density_kg_m3 = standard.density_kg_m3;
    air.soundSpeed_m_s = standard.soundSpeed_m_s;
  }
  return air;
}

glm::dvec3 gravityIn(const FlightWorld& world, const glm::dvec3& position) {
  return world.uniform ? glm::dvec3(0.0, 0.0, -world.uniform->gravity_m_s2) : normalGravity(world.frame, position);
}

void checkWorld(const FlightWorld& world) {
  for (std::size_t i = 0; i < world.wind.size(); ++i) {
    const WindAt& w = world.wind[i];
    if (!std::isfinite(w.height_m) || !std::isfinite(glm::dot(w.velocity_m_s, w.velocity_m_s)))
      throw FlightError("wind", "not a finite number", "finite numbers", "correct the row", i);
    if (i > 0 && !(w.height_m > world.wind[i - 1].height_m))
      throw FlightError("wind", "height goes back to " + std::to_string(w.height_m) + " m", "rising heights", "put the rows in order", i);
  }
}

}  // namespace pitviper
