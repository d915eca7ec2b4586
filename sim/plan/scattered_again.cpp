#include "sim/plan/scattered_again.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/ground.hpp"
#include "sim/model/light_legs.hpp"
#include "sim/model/sunlit_air.hpp"
#include "sim/model/world.hpp"
#include "sim/radiance/factor.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/spectral_rule.hpp"

namespace pitviper {
namespace {

/// Heights of a column, closer together near the ground: 25 m there.
constexpr int kHeights = 65;
/// Wavelengths of a channel.
constexpr int kWavelengths = 2;
/// Lines of sight: parts of the film across and down.
constexpr double kLines[][2] = {{0.5, 0.5}, {0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}};
/// A channel is lit where white air in full sun would send this part of a black body of 288 K.
constexpr double kLit = 0.1, kWarm_K = 288.0;

double sumOver(const std::array<double, kMostAirAmounts>& coefficients, const AirAmounts& powered) {
  double sum = 0.0;
  for (size_t k = 0; k < coefficients.size(); ++k) sum += coefficients[k] * powered.amount[k];
  return sum;
}

}  // namespace

double ScatteringCheck::heightAt(int entry) const {
  const double t = static_cast<double>(entry) / (kHeights - 1);
  return sim_.air->top_m() * t * t;
}

ScatteringCheck::ScatteringCheck(const Simulation& sim, const Camera& camera, const Plan& plan) : sim_(sim), camera_(camera), plan_(plan) {
  if (!plan.sunLegs) return;
  std::vector<AirAmounts> above;
  for (int h = 0; h < kHeights; ++h) above.push_back(sim.air->powered(sim.air->amounts({heightAt(h), 1.0, sim.frame.earthRadius_m()}, physics::kFar)));
  for (const ChannelOutput& output : camera.outputs) {
    if (std::any_of(channels_.begin(), channels_.end(), [&](const Channel& c) { return c.name == output.channel; })) continue;
    Channel channel{output.channel, {}, {}, {}};
    double sunlit = 0.0, warm = 0.0;
    for (const QuadratureNode& q : spectralRule(output.kernel, kWavelengths, Spacing::Gauss)) {
      const SpectralNode node = nodeAt(sim, q.x);
      Column column;
      for (const AirAmounts& a : above) column.depth.push_back(Atmosphere::depthOf(node.air, a));
      const double molecules = sumOver(node.air.molecules, above.front()), haze = sumOver(node.air.haze, above.front());
      column.albedo = column.depth.front() > 0.0 ? (molecules + haze) / column.depth.front() : 0.0;
      column.asymmetry = molecules + haze > 0.0 ? haze * node.air.asymmetry / (molecules + haze) : 0.0;
      sunlit += q.weight * sim.sun->irradiance(q.x) / (4.0 * kPi), warm += q.weight * physics::planckRadiance(q.x, kWarm_K);
      channel.nodes.push_back(node), channel.weight.push_back(q.weight), channel.columns.push_back(std::move(column));
    }
    if (sunlit > kLit * warm) channels_.push_back(std::move(channel));
  }
}

double ScatteringCheck::depthAbove(const Column& column, double height_m) const {
  const double t = std::sqrt(std::clamp(height_m / sim_.air->top_m(), 0.0, 1.0)) * (kHeights - 1);
  const int h = std::min(static_cast<int>(t), kHeights - 2);
  const double f = std::clamp((height_m - heightAt(h)) / (heightAt(h + 1) - heightAt(h)), 0.0, 1.0);
  return (1.0 - f) * column.depth[static_cast<size_t>(h)] + f * column.depth[static_cast<size_t>(h) + 1];
}

/// A line of sight, with what it has of the sun.
struct ScatteringCheck::Line {
  std::optional<Hit> end;
  double end_K;  ///< temperature there
  SunlitAir air;
  double cosScatter;
  LightLeg sun;
  AirAmounts toSun;  ///< from its end on
};

std::vector<ScatteringCheck::Line> ScatteringCheck::linesOver(const WorldState& state, std::optional<Hit>& below) const {
  const CameraState eye = cameraAt(camera_, state);
  const glm::dvec3 place = eye.pose.position, up = sim_.frame.up(place);
  const glm::dmat3 axes = localFromCamera(eye.pose);
  std::vector<char> drawn(sim_.entities.size(), 1);
  if (camera_.mount.carrier >= 0) drawn[static_cast<size_t>(camera_.mount.carrier)] = 0;
  const auto endOf = [&](const glm::dvec3& direction) -> std::optional<Hit> {
    const RayHits hits = castRay(sim_, state, place, direction, camera_.near_m, &drawn, false, 0);
    return hits.solid.entity >= 0 ? hits.solid : groundHit(sim_, place, direction);
  };
  below = endOf(-up);
  std::vector<Line> lines;
  for (const auto& [across, down] : kLines) {
    const Pinhole& p = eye.pinhole;
    const glm::dvec3 direction = glm::normalize(axes * glm::dvec3(p.tanX(p.width * across), p.tanY(p.height * down), -1.0));
    const std::optional<Hit> end = endOf(direction);
    const AirRay ray{sim_.frame.height(place), glm::dot(direction, up), sim_.frame.earthRadius_m()};
    const RaySun sun{glm::dot(sim_.sun->toSun, up), glm::dot(direction, sim_.sun->toSun)};
    SunlitAir air(*sim_.air, ray, sim_.air->stations(ray, end ? end->distance : physics::kFar), plan_.sunLegs.get(), sun);
    const LightLeg leg = end ? lightLeg(sim_, state, *end, sim_.lights.size()) : LightLeg{};
    lines.push_back({end, end ? temperatureAt(sim_, state, *end) : 0.0, std::move(air), sun.cosScatter, leg, sim_.air->powered(leg.air)});
  }
  return lines;
}

ScatteringCheck::Parts ScatteringCheck::partsOf(const Channel& channel, size_t n, const Line& line, const std::optional<Hit>& below,
                                                const AirAmounts& slant) const {
  const SpectralNode& node = channel.nodes[n];
  const Column& column = channel.columns[n];
  const double um = node.members.front().wavelength_um, e0 = sim_.sun->irradiance(um);
  const double ground = below ? std::clamp(sim_.materialOf(surfaceAt(sim_, *below)).reflectance(um, 0.0), 0.0, 1.0) : 0.0;
  const double sine = column.depth.front() / std::max(Atmosphere::depthOf(node.air, slant), column.depth.front());
  const TwoStream layer(column.depth.front(), column.albedo, column.asymmetry, sine, ground);
  std::vector<double> source;
  for (const AirStation& s : line.air.stations) source.push_back(physics::planckRadiance(um, s.temperature_K));
  const AirRadiance seen = airRadiance(node.air, line.air, source);
  const double rayleigh = rayleighPhase(line.cosScatter), haze = henyeyGreensteinPhase(line.cosScatter, node.air.asymmetry);
  Parts parts{seen.thermal.back() + e0 * (rayleigh * seen.molecules.back() + haze * seen.haze.back()), 0.0, 0.0};
  for (size_t s = 1; s < line.air.stations.size(); ++s) {
    const auto passed = [&](const std::array<double, kMostAirAmounts>& c) { return sumOver(c, line.air.powered[s]) - sumOver(c, line.air.powered[s - 1]); };
    const double small = passed(node.air.molecules), large = passed(node.air.haze), d = seen.depth[s] - seen.depth[s - 1];
    parts.scattering += small + large;
    if (!(d > 0.0)) continue;
    const double height = 0.5 * (line.air.stations[s - 1].height_m + line.air.stations[s].height_m), from = depthAbove(column, height);
    const TwoStream::Fluxes flux = layer.at(from);
    // Once scattered is in the picture: what is left of the beam by all extinction. More than that goes its way, and all around.
    const double aside = std::max(flux.beam - std::exp(-from / std::max(sine, 1e-3)), 0.0);
    const double each = (small * rayleigh + large * haze) * aside + (small + large) * (flux.down + flux.up) / (2.0 * kPi);
    parts.more += e0 * each / d * std::exp(-seen.depth[s - 1]) * physics::oneMinusExp(d);
  }
  const double through = std::exp(-seen.depth.back());
  if (!line.end) {
    parts.own += through * sim_.background(um);
    return parts;
  }
  const Surface& surface = surfaceAt(sim_, *line.end);
  const Material& material = sim_.materialOf(surface);
  const double reflectance = material.reflectance(um, 0.0), cosine = glm::dot(line.end->normal, sim_.frame.up(line.end->point));
  const double height = sim_.frame.height(line.end->point), from = depthAbove(column, height), leg = Atmosphere::depthOf(node.air, line.toSun);
  const double dome = kPi * ambientOn(line.end->normal, height, um);
  const TwoStream::Fluxes flux = layer.at(from);
  parts.own +=
      through * (material.emissivity(um, 0.0) * physics::planckRadiance(um, line.end_K) + reflectance / kPi * (e0 * line.sun.factor * std::exp(-leg) + dome));
  // A dome that the scenario has lights every side alike; else half of what is level, by how the surface lies.
  const double around = sim_.ambient && !sim_.surroundings ? flux.down : 0.5 * (1.0 + cosine) * flux.down + 0.5 * (1.0 - cosine) * flux.up;
  const double falls = around + std::max(flux.beam - std::exp(-leg), 0.0) * line.sun.factor;
  parts.more += through * reflectance / kPi * std::max(e0 * falls - dome, 0.0);
  parts.scattering += sumOver(node.air.molecules, line.toSun) + sumOver(node.air.haze, line.toSun);
  return parts;
}

/// Irradiance over pi that the scenario's ambient light gives a surface.
double ScatteringCheck::ambientOn(const glm::dvec3& normal, double height_m, double um) const {
  if (!sim_.surroundings) return sim_.ambient ? (*sim_.ambient)(um) : 0.0;
  const auto place = sim_.surroundings->placeAt(height_m);
  return valueOf(sim_, Factor::around(std::asin(std::clamp(normal.z, -1.0, 1.0)), std::atan2(normal.y, normal.x), place.height), um);
}

std::vector<ScatteredAgain> ScatteringCheck::at(const WorldState& state) const {
  std::vector<ScatteredAgain> all;
  if (channels_.empty()) return all;
  const double sunSine = glm::dot(sim_.sun->toSun, sim_.frame.up(cameraAt(camera_, state).pose.position));
  // What the sun goes through from where over what lies straight above: the cosine that a flat layer would have.
  const RisenSun risen = risenSun(0.0, sunSine, sim_.frame.earthRadius_m());
  if (!(risen.share > 0.0)) return all;
  const AirAmounts slant = sim_.air->powered(plan_.sunLegs->at(0.0, risen.sinElevation));
  std::optional<Hit> below;
  const std::vector<Line> lines = linesOver(state, below);
  for (const Channel& channel : channels_) {
    std::vector<double> factors, depths;
    for (const Line& line : lines) {
      double once = 0.0, again = 0.0, depth = 0.0, total = 0.0;
      for (size_t n = 0; n < channel.nodes.size(); ++n) {
        const Parts parts = partsOf(channel, n, line, below, slant);
        const double weight = channel.weight[n];
        once += weight * parts.own, again += weight * parts.more, depth += weight * parts.scattering, total += weight;
      }
      if (!(once > 0.0)) continue;
      factors.push_back(1.0 + again / once), depths.push_back(depth / total);
    }
    if (factors.empty()) continue;
    const auto middle = [](std::vector<double>& v) {
      std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
      return v[v.size() / 2];
    };
    const double depth = middle(depths);
    if (depth > kMatters) all.push_back({channel.name, middle(factors), depth});
  }
  return all;
}

}  // namespace pitviper
