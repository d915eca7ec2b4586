#include "sim/plan/scattered_again.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiance/factor.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/spectral_rule.hpp"
#include "sim/world/ground.hpp"
#include "sim/world/light_legs.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// Heights of a column, closer together near the ground: 25 m there.
constexpr int kHeights = 65;
/// Wavelengths of a channel.
constexpr int kWavelengths = 2;
/// Lines of sight: parts of the film across and down.
constexpr double kLines[][2] = {{0.5, 0.5}, {0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}};
/// Photons that are followed back from a line, and from what ends it, at each wavelength.
constexpr int kWalks = 400;
/// A body below the camera is the ground that lights the air if it reaches as far as this; else the ground beneath it is.
constexpr double kLand_m = 1000.0;
/// A channel is looked at where white air in full sun would send at least this part of what a black body of 288 K does.
constexpr double kLit = 0.1, kWarm_K = 288.0;
/// Where no accuracy is asked for, what is worth saying.
constexpr double kWorth = 0.01;
/// Sine of the sun's elevation below which the air around a place is lit otherwise than at the place, and the relative error of a factor that this leaves at
/// least.
constexpr double kLowSun = 0.1, kGuess = 0.5;

double sumOver(const std::array<double, kMostAirAmounts>& coefficients, const AirAmounts& powered) {
  double sum = 0.0;
  for (size_t k = 0; k < coefficients.size(); ++k) sum += coefficients[k] * powered.amount[k];
  return sum;
}

/// The mean of random samples, and the variance of that mean.
struct Tally {
  double sum = 0.0, squares = 0.0;
  int count = 0;
  void add(double v) { sum += v, squares += v * v, ++count; }
  double mean() const { return sum / count; }
  double variance() const { return std::max(squares / count - mean() * mean(), 0.0) / count; }
};

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
    Channel channel{output.channel, {}, {}, {}, {}};
    double sunlit = 0.0, warm = 0.0;
    for (const QuadratureNode& q : spectralRule(output.kernel, kWavelengths, Spacing::Gauss)) {
      const SpectralNode node = nodeAt(sim, q.x);
      Column column;
      for (const AirAmounts& a : above) {
        column.all.push_back(Atmosphere::depthOf(node.air, a));
        column.molecules.push_back(sumOver(node.air.molecules, a)), column.haze.push_back(sumOver(node.air.haze, a));
      }
      column.asymmetry = node.air.asymmetry;
      sunlit += q.weight * sim.sun->irradiance(q.x) / (4.0 * kPi), warm += q.weight * physics::planckRadiance(q.x, kWarm_K);
      channel.nodes.push_back(node), channel.weight.push_back(q.weight), channel.columns.push_back(std::move(column));
    }
    if (!(sunlit > kLit * warm)) continue;
    channel.air.emplace(channel.nodes);
    channels_.push_back(std::move(channel));
  }
}

double ScatteringCheck::aboveAt(const std::vector<double>& column, double height_m) const {
  const double t = std::sqrt(std::clamp(height_m / sim_.air->top_m(), 0.0, 1.0)) * (kHeights - 1);
  const int h = std::min(static_cast<int>(t), kHeights - 2);
  const double f = std::clamp((height_m - heightAt(h)) / (heightAt(h + 1) - heightAt(h)), 0.0, 1.0);
  return (1.0 - f) * column[static_cast<size_t>(h)] + f * column[static_cast<size_t>(h) + 1];
}

/// What lies between a height and the sun.
struct ScatteringCheck::SunAt {
  double height_m, share;
  AirAmounts powered;
};

WalkAir ScatteringCheck::airOver(const Channel& channel, size_t n, const std::optional<Hit>& below, const std::vector<SunAt>& sun,
                                 const glm::dvec3& toSun) const {
  const SpectralNode& node = channel.nodes[n];
  const Column& column = channel.columns[n];
  WalkAir air;
  for (const SunAt& s : sun) {
    air.above.push_back(aboveAt(column.all, s.height_m));
    air.sunlight.push_back(s.share > 0.0 ? s.share * std::exp(-Atmosphere::depthOf(node.air, s.powered)) : 0.0);
  }
  for (size_t k = 0; k + 1 < sun.size(); ++k) {
    const auto part = [&](const std::vector<double>& of) {
      const double all = air.above[k] - air.above[k + 1];
      return all > 0.0 ? std::clamp((aboveAt(of, sun[k].height_m) - aboveAt(of, sun[k + 1].height_m)) / all, 0.0, 1.0) : 0.0;
    };
    air.molecules.push_back(part(column.molecules));
    air.haze.push_back(std::min(part(column.haze), 1.0 - air.molecules.back()));
  }
  air.asymmetry = column.asymmetry;
  air.groundAlbedo = below ? std::clamp(sim_.materialOf(surfaceAt(sim_, *below)).reflectance(node.members.front().wavelength_um, 0.0), 0.0, 1.0) : 0.0;
  air.toSun = toSun;
  return air;
}

/// A line of sight, with what it has of the sun.
struct ScatteringCheck::Line {
  std::optional<Hit> end;
  double end_K;                  ///< temperature there
  glm::dvec3 direction, normal;  ///< z up, the sun above x
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
  // A roof or a deck is not the ground that lights the air.
  if (below && below->entity >= 0 && sim_.ground && static_cast<double>(sim_.entities[static_cast<size_t>(below->entity)].boundingRadius_m) < kLand_m)
    below = groundHit(sim_, place, -up);
  // Axes of a photon's walk: z up, the sun above x.
  glm::dvec3 x = sim_.sun->toSun - glm::dot(sim_.sun->toSun, up) * up;
  if (!(glm::length(x) > 1e-9)) x = std::abs(up.x) < 0.9 ? glm::cross(up, glm::dvec3(1, 0, 0)) : glm::cross(up, glm::dvec3(0, 1, 0));
  x = glm::normalize(x);
  const glm::dvec3 y = glm::cross(up, x);
  const auto turned = [&](const glm::dvec3& v) { return glm::normalize(glm::dvec3(glm::dot(v, x), glm::dot(v, y), glm::dot(v, up))); };
  std::vector<Line> lines;
  for (const auto& [across, down] : kLines) {
    const Pinhole& p = eye.pinhole;
    const glm::dvec3 direction = glm::normalize(axes * glm::dvec3(p.tanX(p.width * across), p.tanY(p.height * down), -1.0));
    const std::optional<Hit> end = endOf(direction);
    const AirRay ray{sim_.frame.height(place), glm::dot(direction, up), sim_.frame.earthRadius_m()};
    const RaySun sun{glm::dot(sim_.sun->toSun, up), glm::dot(direction, sim_.sun->toSun)};
    SunlitAir air(*sim_.air, ray, sim_.air->stations(ray, end ? end->distance : physics::kFar), plan_.sunLegs.get(), sun);
    const LightLeg leg = end ? lightLeg(sim_, state, *end, sim_.lights.size()) : LightLeg{};
    lines.push_back({end, end ? temperatureAt(sim_, state, *end) : 0.0, turned(direction), end ? turned(end->normal) : glm::dvec3(0, 0, 1), std::move(air),
                     sun.cosScatter, leg, sim_.air->powered(leg.air)});
  }
  return lines;
}

ScatteringCheck::Parts ScatteringCheck::partsOf(const Channel& channel, size_t n, const Line& line, const NodeRadiance& seen, const PhotonWalk& walk) const {
  const SpectralNode& node = channel.nodes[n];
  const Column& column = channel.columns[n];
  const double um = node.members.front().wavelength_um, e0 = sim_.sun->irradiance(um);
  const size_t nodes = channel.nodes.size(), end = (line.air.stations.size() - 1) * nodes + n;
  const double rayleigh = physics::rayleighPhase(line.cosScatter), haze = physics::henyeyGreensteinPhase(line.cosScatter, node.air.asymmetry);
  Parts parts{seen.thermal[end] + e0 * (rayleigh * seen.molecules[end] + haze * seen.haze[end]), 0.0, 0.0};
  WalkDice dice(1 + n);
  // What is seen of light scattered before each station, and which part of it particles scattered.
  std::vector<double> reached{0.0}, particles{0.0};
  for (size_t s = 1; s < line.air.stations.size(); ++s) {
    const auto passed = [&](const std::array<double, kMostAirAmounts>& c) { return sumOver(c, line.air.powered[s]) - sumOver(c, line.air.powered[s - 1]); };
    const double small = std::max(passed(node.air.molecules), 0.0), large = std::max(passed(node.air.haze), 0.0), before = seen.depth[(s - 1) * nodes + n];
    reached.push_back(reached.back() + (small + large) * std::exp(-before) * physics::meanDecay(std::max(seen.depth[s * nodes + n] - before, 0.0)));
    particles.push_back(small + large > 0.0 ? large / (small + large) : 0.0);
  }
  if (reached.back() > 0.0) {
    Tally tally;
    for (int k = 0; k < kWalks; ++k) {
      const double at = (k + unitOf(dice)) / kWalks * reached.back();
      const auto s = std::clamp<size_t>(static_cast<size_t>(std::upper_bound(reached.begin(), reached.end(), at) - reached.begin()), 1, reached.size() - 1);
      const double f = reached[s] > reached[s - 1] ? (at - reached[s - 1]) / (reached[s] - reached[s - 1]) : 0.5;
      const double height = (1.0 - f) * line.air.stations[s - 1].height_m + f * line.air.stations[s].height_m;
      const auto found = walk.from(aboveAt(column.all, height), walk.before(line.direction, unitOf(dice) < particles[s], dice), dice);
      tally.add(found.once + found.again + found.ground);
    }
    const double each = e0 * reached.back();
    parts.more += each * tally.mean(), parts.variance += each * each * tally.variance();
  }
  const double through = std::exp(-seen.depth[end]);
  if (!line.end) {
    parts.own += through * sim_.background(um);
    return parts;
  }
  const Surface& surface = surfaceAt(sim_, *line.end);
  const Material& material = sim_.materialOf(surface);
  const double reflectance = material.reflectance(um, 0.0), height = sim_.frame.height(line.end->point), leg = Atmosphere::depthOf(node.air, line.toSun);
  const double dome = kPi * ambientOn(line.end->normal, height, um);
  parts.own +=
      through * (material.emissivity(um, 0.0) * physics::planckRadiance(um, line.end_K) + reflectance / kPi * (e0 * line.sun.factor * std::exp(-leg) + dome));
  const double each = through * reflectance * e0;
  if (!(each > 0.0)) return parts;
  // Irradiance over pi is the mean radiance over directions drawn by their cosine. Where a scenario asks for no ambient light, skylight of the first order is
  // not missed either.
  Tally tally;
  for (int k = 0; k < kWalks; ++k) {
    const auto found = walk.from(aboveAt(column.all, height), walk.evenlySent(line.normal, dice), dice);
    tally.add(found.again + (sim_.ambient || sim_.surroundings ? found.once + found.ground : 0.0));
  }
  parts.more += std::max(each * tally.mean() - through * reflectance * dome / kPi, 0.0), parts.variance += each * each * tally.variance();
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
  const glm::dvec3 up = sim_.frame.up(cameraAt(camera_, state).pose.position);
  const double sunSine = glm::dot(sim_.sun->toSun, up), radius = sim_.frame.earthRadius_m();
  std::optional<Hit> below;
  const std::vector<Line> lines = linesOver(state, below);
  const double ground = below ? std::max(sim_.frame.height(below->point), 0.0) : 0.0;
  std::vector<SunAt> sun;
  bool lit = false;
  for (int h = 0; h < kHeights; ++h) {
    const double height = h == 0 ? ground : heightAt(h);
    if (h > 0 && height <= ground) continue;
    const RisenSun risen = risenSun(height, sunSine, radius);
    lit |= risen.share > 0.0;
    sun.push_back({height, risen.share, risen.share > 0.0 ? sim_.air->powered(plan_.sunLegs->at(height, risen.sinElevation)) : AirAmounts{}});
  }
  if (!lit || sun.size() < 2) return all;
  const glm::dvec3 toSun(std::sqrt(std::max(1.0 - sunSine * sunSine, 0.0)), 0.0, sunSine);
  for (const Channel& channel : channels_) {
    std::vector<PhotonWalk> walks;
    for (size_t n = 0; n < channel.nodes.size(); ++n) walks.emplace_back(airOver(channel, n, below, sun, toSun));
    std::vector<std::pair<double, double>> factors;  // with their errors
    for (const Line& line : lines) {
      const NodeRadiance seen = channel.air->along(line.air);
      double once = 0.0, again = 0.0, variance = 0.0;
      for (size_t n = 0; n < channel.nodes.size(); ++n) {
        const Parts parts = partsOf(channel, n, line, seen, walks[n]);
        const double weight = channel.weight[n];
        once += weight * parts.own, again += weight * parts.more, variance += weight * weight * parts.variance;
      }
      if (once > 0.0) factors.emplace_back(1.0 + again / once, std::sqrt(variance) / (once + again));
    }
    if (factors.empty()) continue;
    std::sort(factors.begin(), factors.end());
    const auto& [factor, error] = factors[factors.size() / 2];
    if (factors.back().first - 1.0 > (plan_.accuracy > 0.0 ? plan_.accuracy : kWorth))
      all.push_back({channel.name, factor, factors.front().first, factors.back().first, sunSine < kLowSun ? std::max(error, kGuess) : error});
  }
  return all;
}

}  // namespace pitviper
