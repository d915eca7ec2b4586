#include "scenarios/session/air_physics.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/session/array_checks.hpp"
#include "sim/parameters/print.hpp"
#include "sim/plan/fine_grid.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/world/coverage.hpp"
#include "sim/world/ground.hpp"

namespace pitviper {
namespace {

constexpr const char *kPathCall = "path()", *kSkyCall = "sky_radiance()", *kBandCall = "band_transmittance()";

/// The air with what lights it, without all that stands in it.
Simulation airAlone(const Simulation& of) {
  Simulation air;
  air.name = of.name;
  air.frame = of.frame;
  air.air = of.air;
  air.sun = of.sun;
  air.background = of.background;
  if (of.ground) {
    air.materials = {of.materials[static_cast<std::size_t>(of.ground->material)]};
    air.ground = of.ground;
    air.ground->material = 0;
  }
  return air;
}

bool hasSomeAir(const Simulation& simulation) { return simulation.air && simulation.air->traits().any; }

void requireAirPlace(const char* function, const char* name, const glm::dvec3& place) {
  const double all[] = {place.x, place.y, place.z};
  requireFinite({function, name}, all);
}

struct AirLine {
  double range_m = 0.0;
  glm::dvec3 direction{0.0, 0.0, 1.0};
};

/// Errors: UserError where the earth is in the way of places that both stand above it.
AirLine airLineBetween(const char* function, const Simulation& air, const glm::dvec3& from, const glm::dvec3& to) {
  requireAirPlace(function, "from", from);
  requireAirPlace(function, "to", to);
  AirLine line{glm::length(to - from), {}};
  if (!(line.range_m > 0.0)) return line;
  line.direction = (to - from) / line.range_m;
  const double height = air.frame.height(from);
  if (!air.overEarth() || height < 0.0 || air.frame.height(to) < 0.0) return line;
  const double ground = physics::groundRange(height, glm::dot(line.direction, air.frame.up(from)), air.frame.earthRadius_m());
  // A place on the ground itself may be rounded below it.
  if (ground < line.range_m * (1.0 - 1e-6) - 1e-3)
    throw UserError({function, 0, 0, -1}, print("the earth stands between the two places, %.6g m from the first", ground), "a path that is clear of it",
                    "raise one of the places, or end the path at the ground");
  return line;
}

AirRay airRayOf(const Simulation& air, const glm::dvec3& from, const glm::dvec3& direction) {
  return {air.frame.height(from), glm::dot(direction, air.frame.up(from)), air.frame.earthRadius_m()};
}

/// Errors: UserError for wavelengths without data.
void requireAirData(const char* function, const Simulation& air, std::span<const double> wavelength_um) {
  requireWavelengths({function, "wavelength_um"}, wavelength_um);
  if (wavelength_um.empty()) return;
  const auto [low, high] = std::minmax_element(wavelength_um.begin(), wavelength_um.end());
  ChannelOutput all;
  all.channel = "wavelength_um";
  all.where = {function, 0, 0, -1};
  all.kernel = Spectrum::band(*low, *low < *high ? *high : std::nextafter(*high, INFINITY));
  requireData(air, all);
}

std::vector<SpectralNode> airNodesAt(const Simulation& air, std::span<const double> wavelength_um) {
  std::vector<SpectralNode> nodes;
  for (const double um : wavelength_um) nodes.push_back(nodeAt(air, um));
  return nodes;
}

/// As the reference has them.
Terms referenceAirTerms(const Simulation& air) {
  Terms terms = termsOf(air);
  if (terms.streams > 0) terms.streams = kFinestStreams;
  return terms;
}

/// Radiance of a line that meets nothing: as far as a range, or to the end of the air and what lies behind.
std::vector<double> airLightAlong(const Simulation& air, const std::vector<SpectralNode>& nodes, const glm::dvec3& from, const glm::dvec3& direction,
                                  std::optional<double> range_m) {
  const Terms terms = referenceAirTerms(air);
  const NodeSpectra spectra(air, nodes, terms);
  const auto legs = terms.scatteredSun ? SunLegs::of(air.air, glm::dot(air.frame.up(glm::dvec3(0.0)), air.sun->toSun), air.frame.earthRadius_m()) : nullptr;
  const WorldState nothing;
  const RadianceScene scene{air, terms, legs.get(), nothing, {}};
  const LineOfSight line{from, direction, {}, 0.0};
  NodeSum sum(spectra);
  sum.begin();
  if (range_m) lightOfWay(scene, line, *range_m, sum);
  else radianceAlong(scene, line, sum);
  return {sum.radiance().begin(), sum.radiance().end()};
}

}  // namespace

AirPath pathThrough(const Simulation& simulation, const glm::dvec3& from, const glm::dvec3& to, std::span<const double> wavelength_um) {
  const Simulation air = airAlone(simulation);
  const AirLine line = airLineBetween(kPathCall, air, from, to);
  requireWavelengths({kPathCall, "wavelength_um"}, wavelength_um);
  AirPath path{line.range_m, std::vector<double>(wavelength_um.size(), 0.0), std::vector<double>(wavelength_um.size(), 1.0),
               std::vector<double>(wavelength_um.size(), 0.0)};
  if (!hasSomeAir(air) || !(line.range_m > 0.0) || wavelength_um.empty()) return path;
  requireAirData(kPathCall, air, wavelength_um);
  const std::vector<SpectralNode> nodes = airNodesAt(air, wavelength_um);
  const AirAmounts powered = air.air->powered(air.air->amounts(airRayOf(air, from, line.direction), line.range_m));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    path.opticalDepth[i] = Atmosphere::depthOf(nodes[i].air, powered);
    path.transmittance[i] = std::exp(-path.opticalDepth[i]);
  }
  path.pathRadiance = airLightAlong(air, nodes, from, line.direction, line.range_m);
  return path;
}

std::vector<double> skyRadiance(const Simulation& simulation, const glm::dvec3& from, const glm::dvec3& direction, std::span<const double> wavelength_um) {
  const Simulation air = airAlone(simulation);
  requireAirPlace(kSkyCall, "from", from);
  requireAirPlace(kSkyCall, "direction", direction);
  const double length = glm::length(direction);
  if (!(length > 0.0)) throw UserError({kSkyCall, 0, 0, -1}, "a direction of length 0", "a vector towards the sky", "give one, such as [0, 0, 1]");
  const glm::dvec3 unit = direction / length;
  const AirRay ray = airRayOf(air, from, unit);
  if (air.overEarth() && physics::groundRange(std::max(ray.height_m, 0.0), ray.sinElevation, ray.earthRadius_m) < physics::kFar)
    throw UserError({kSkyCall, 0, 0, -1}, print("a direction %.6g deg below the horizontal, which meets the earth", -glm::degrees(std::asin(ray.sinElevation))),
                    "one that meets the sky", "raise it");
  requireAirData(kSkyCall, air, wavelength_um);
  if (wavelength_um.empty()) return {};
  return airLightAlong(air, airNodesAt(air, wavelength_um), from, unit, {});
}

double bandTransmittance(const Simulation& simulation, const glm::dvec3& from, const glm::dvec3& to, const Responsivity& band, double source_K) {
  if (!(std::isfinite(source_K) && source_K > 0.0))
    throw UserError({kBandCall, 0, 0, -1}, print("a source of %g K", source_K), "a temperature above 0 K", "give that of the body whose light is looked at");
  // What lights the air takes nothing from a path.
  Simulation air;
  air.frame = simulation.frame, air.air = simulation.air;
  const AirLine line = airLineBetween(kBandCall, airAlone(simulation), from, to);
  if (!hasSomeAir(air) || !(line.range_m > 0.0)) return 1.0;
  ChannelOutput output;
  output.channel = "responsivity";
  output.where = {kBandCall, 0, 0, -1};
  output.kernel = band.spectrum();
  output.bandLow_um = band.low_um(), output.bandHigh_um = band.high_um();
  cutToData(air, output);
  const AirAmounts powered = air.air->powered(air.air->amounts(airRayOf(air, from, line.direction), line.range_m));
  double all = 0.0, passed = 0.0;
  for (const QuadratureNode& n : fineGrid(output.kernel, air)) {
    const double sent = n.weight * physics::planckRadiance(n.x, source_K);
    all += sent;
    passed += sent * std::exp(-Atmosphere::depthOf(air.air->node(n.x), powered));
  }
  if (!(all > 0.0))
    throw UserError({kBandCall, 0, 0, -1}, print("a source of %g K sends nothing in the band", source_K), "one that does",
                    "give a hotter source, or another band");
  return passed / all;
}

}  // namespace pitviper
