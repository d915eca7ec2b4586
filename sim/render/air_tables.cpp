#include "sim/render/air_tables.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <future>
#include <thread>

#include "sim/model/sunlit_air.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Entries of the tables, elevations at first. Ranges lie evenly in ln(1 + range / scale), scale a thousandth of the farthest: 7 % apart beyond it.
constexpr int kElevations = 33, kRanges = 96;
/// Below 0.3 %: twice as many ranges, for a quarter of what is lost between them.
constexpr double kFine = 0.003;
/// Elevations are doubled until what is lost between them is no more than this part of the accuracy (of 1 % where none is asked for), or they are so many.
constexpr double kElevationShare = 0.1;
constexpr int kMostElevations = 257;
/// Radiance below this part of a table's greatest is not looked at.
constexpr double kFaint = 1e-3;
constexpr double kScale = 1e-3;
/// Ranges of places towards space [m].
constexpr double kFirstSky_m = 100.0, kLastSky_m = 2e6;
/// Part of a range to the next place on the way to space: at 1.6 um a black body of air halves within 12 K, some 2 km.
constexpr double kSkyStep = 0.08;
/// Temperatures of air anywhere [K] and entries over their inverse.
constexpr double kColdest_K = 140.0, kWarmest_K = 400.0;
constexpr int kTemperatures = 256;
constexpr double kNothing = 1e-30;
/// Tables reach so much of a view's elevations beyond it, to serve the next views of a camera that turns.
constexpr double kMargin = 0.2;
/// At 1 %: heights [m] and azimuths (cosines) to the sun that one table serves. Haze thins by 0.1 % in a metre.
constexpr double kSameHeight_m = 1.0, kSameAzimuth = 0.02;

/// What of the accuracy one azimuth for a whole view may take, and the steps between several; the greatest number of them.
constexpr double kAzimuthShare = 0.3, kStepShare = 0.15;
constexpr int kMostAzimuths = 9;
/// For how much sunlight scattered far away differs between azimuths: vertical depth of clear air in the visible, how far it is seen through [m], lowest sine.
constexpr double kVerticalDepth = 0.3, kSeen_m = 1e5, kLowestSun = 0.02;

double logOf(double v) { return std::log(std::max(v, kNothing)); }

/// Elevations lie evenly in the signed root of their sine: near the horizon a small step crosses much air.
double spread(double sine) { return std::copysign(std::sqrt(std::abs(sine)), sine); }

glm::dvec3 axisOf(const View& v) { return v.localFromCamera * glm::dvec3(0, 0, -1); }

bool onFilm(const View& v, const glm::dvec3& direction) {
  const glm::dvec3 d = glm::transpose(v.localFromCamera) * direction;
  if (d.z >= 0.0) return false;
  const glm::dvec2 at = filmPosition(v, d);
  return at.x >= 0 && at.y >= 0 && at.x <= v.width && at.y <= v.height;
}

/// Least and greatest sine of elevation in a view.
std::pair<double, double> elevations(const View& v, const glm::dvec3& up) {
  double low = 1.0, high = -1.0;
  constexpr int kSteps = 16;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      const double s = glm::dot(glm::normalize(v.localFromCamera * v.ray(v.width * i / double(kSteps), v.height * j / double(kSteps))), up);
      low = std::min(low, s);
      high = std::max(high, s);
    }
  if (onFilm(v, up)) high = 1.0;
  if (onFilm(v, -up)) low = -1.0;
  const double margin = 0.03 * (high - low) + 1e-4;  // between the places looked at
  return {std::max(low - margin, -1.0), std::min(high + margin, 1.0)};
}

/// Azimuths to the sun that tables of scattered sunlight are needed for. Air d away has the sun higher by d / R cos(azimuth): its way is longer or shorter by
/// that over the sine, and the depth of that way is the vertical one over the sine.
int azimuthsOf(const Simulation& simulation, const Plan& plan) {
  if (!plan.terms.scatteredSun) return 1;
  const double accuracy = plan.accuracy > 0.0 ? plan.accuracy : 0.01, radius = simulation.frame.earthRadius_m();
  const double sine = glm::dot(simulation.sun->toSun, simulation.frame.up(glm::dvec3(0.0))), horizontal = std::sqrt(std::max(1.0 - sine * sine, 0.0));
  const double apart = 2.0 * horizontal * std::sin(0.5 * std::min(plan.field_rad, kPi)), high = std::max(sine, kLowestSun);
  const double change = kVerticalDepth / (high * high) * kSeen_m / radius * apart;
  if (0.5 * change <= kAzimuthShare * accuracy) return 1;
  // Linear between two: a step of relative change x is off by x^2 / 8.
  return std::clamp(1 + static_cast<int>(std::ceil(change / std::sqrt(8.0 * kStepShare * accuracy))), 2, kMostAzimuths);
}

}  // namespace

AirTables::AirTables(const Simulation& simulation, const Plan& plan, bool perChannel, bool wanted)
    : simulation_(simulation), plan_(plan), perChannel_(perChannel), needed_(wanted && plan.terms.air && simulation.path->isLayered()) {
  if (!needed_) return;
  const int finer = plan.accuracy > 0.0 && plan.accuracy < kFine ? 2 : 1;
  elevations_ = kElevations;
  ranges_ = finer * kRanges;
  azimuths_ = azimuthsOf(simulation, plan);
  vectors_ = (static_cast<int>(simulation.path->exponents().size()) + 3) / 4;
  values_ = perChannel ? 4 * plan.groupCount() : plan.nodeCount();
  texels_ = perChannel ? plan.groupCount() : plan.nodeCount();
  parts_ = plan.terms.scatteredSun ? 3 : 1;
  for (const SpectralNode& n : plan.nodes) {
    std::vector<double> table;
    for (int t = 0; t < kTemperatures; ++t) {
      const double inverse = 1.0 / kWarmest_K + (1.0 / kColdest_K - 1.0 / kWarmest_K) * t / (kTemperatures - 1);
      table.push_back(std::log(std::max(n.planck(1.0 / inverse), 1e-300)));
    }
    logPlanck_.push_back(std::move(table));
    sunIrradiance_.push_back(plan.terms.scatteredSun ? n.mean(simulation.sun->irradiance) : 0.0);
  }
  if (plan.lightCount > 0) addHeights(heights_);  // ways on to them
}

double AirTables::planck(size_t node, double temperature_K) const {
  const double t = (1.0 / temperature_K - 1.0 / kWarmest_K) / (1.0 / kColdest_K - 1.0 / kWarmest_K) * (kTemperatures - 1);
  if (!(t >= 0.0 && t <= kTemperatures - 1)) return plan_.nodes[node].planck(temperature_K);
  const auto i = std::min(static_cast<size_t>(t), static_cast<size_t>(kTemperatures - 2));
  const double f = t - static_cast<double>(i);
  return std::exp((1 - f) * logPlanck_[node][i] + f * logPlanck_[node][i + 1]);
}

void AirTables::addConstants(ShaderSlots& slots) const {
  if (!needed_) return;
  slots.constants["AIR_VECTORS"] = vectors_;
  slots.constants["AIR_AZIMUTHS"] = azimuths_;
  slots.constants["AIR_RANGES"] = ranges_;
  slots.constants["AIR_HEIGHTS"] = SunLegs::kHeights;
  slots.constants["AIR_SUNS"] = plan_.sunLegs ? SunLegs::kElevations : 0;
  slots.constants["AIR_PARTS"] = parts_;
  slots.constants["AIR_ASYMMETRIES"] = (values_ + 3) / 4;
  slots.constants["AIR_BLACKS"] = (plan_.nodeCount() + 3) / 4;
}

void AirTables::addHeights(std::vector<float>& out) const {
  const Path& path = *simulation_.path;
  const auto put = [&](const AirAmounts& logs) {
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) out.push_back(static_cast<float>(logs.amount[k]));
  };
  for (int h = 0; h < SunLegs::kHeights; ++h) {
    AirAmounts density = path.densities(SunLegs::heightAt(h, path.top_m()));
    for (double& d : density.amount) d = logOf(d);
    put(density);
    for (int e = 0; plan_.sunLegs && e < SunLegs::kElevations; ++e) put(plan_.sunLegs->logAt(e, h));
  }
}

std::vector<double> AirTables::rangesFrom(double entry_m) const {
  std::vector<double> ranges;
  const double scale = kScale * grid_.farthest_m;
  for (int r = 0; r < ranges_; ++r) ranges.push_back(entry_m + scale * std::expm1(std::log1p(1.0 / kScale) * r / (ranges_ - 1)));
  // Beyond the scene, as far as space: the sky's emission needs places there, the table doesn't.
  const double step = 1.0 + kSkyStep * kRanges / ranges_;
  for (double r = step * std::max(grid_.farthest_m, kFirstSky_m); r < kLastSky_m; r *= step) ranges.push_back(entry_m + r);
  ranges.push_back(physics::kFar);
  return ranges;
}

void AirTables::update(const View& view, const WorldState& state) {
  if (!needed_) return;
  const auto [low, high] = elevations(view, simulation_.frame.up(view.position));
  double farthest = 1.0;
  for (size_t e = 0; e < state.entities.size(); ++e) {
    const Entity& entity = simulation_.entities[e];
    farthest = std::max(farthest, glm::length(state.entities[e].position + state.entities[e].orientation * glm::dvec3(entity.boundingCentre) - view.position) +
                                      static_cast<double>(entity.boundingRadius_m));
  }
  for (const auto& light : state.lights) farthest = std::max(farthest, glm::length(light - view.position));
  const double radius = simulation_.frame.earthRadius_m(), above = std::max(simulation_.frame.height(view.position), 0.0);
  if (simulation_.ground) farthest = std::max(farthest, std::sqrt(above * (2.0 * radius + above)));  // the ground as far as the horizon
  if (serves(view, low, high, farthest)) return;
  const double margin = kMargin * (high - low);
  const auto [acrossLow, acrossHigh] = sunAcrossIn(view);
  // No farther than towards the sun and away from it: beyond, scattering angles have no cosine.
  const double acrossMargin = kMargin * (acrossHigh - acrossLow), most = sunAcrossAtMost(view);
  grid_ = {view.position,
           simulation_.frame.height(view.position),
           sunAcrossOf(view, axisOf(view)),
           std::max(acrossLow - acrossMargin, -most),
           std::min(acrossHigh + acrossMargin, most),
           std::max(low - margin, -1.0),
           std::min(high + margin, 1.0),
           1.1 * farthest};
  const AirRay here{std::min(grid_.height_m, simulation_.path->top_m()), 1.0, simulation_.frame.earthRadius_m()};
  const double temperature_K = simulation_.path->stationsAt(here, std::array{0.0}).front().temperature_K;
  black_.clear();
  for (size_t i = 0; i < plan_.nodes.size(); ++i) black_.push_back(temperature_K > 0.0 ? planck(i, temperature_K) : 0.0);
  fill(view);
}

/// What was made for a wider view serves its parts (zoomed views of small bodies), and a camera on the move where its height is the same but
/// for what the plan's accuracy allows: air knows heights and elevations, no places.
bool AirTables::serves(const View& view, double low, double high, double farthest_m) const {
  if (!(grid_.farthest_m > 0.0)) return false;
  const double share = plan_.accuracy / 0.01;
  const auto [acrossLow, acrossHigh] = sunAcrossIn(view);
  const bool sameHeight = grid_.position == view.position || std::abs(simulation_.frame.height(view.position) - grid_.height_m) <= kSameHeight_m * share;
  const bool sameAzimuths = (acrossLow >= grid_.acrossLow && acrossHigh <= grid_.acrossHigh) ||
                            (azimuths_ == 1 && std::abs(sunAcrossOf(view, axisOf(view)) - grid_.sunAcross) <= kSameAzimuth * share);
  return sameHeight && sameAzimuths && low >= grid_.low && high <= grid_.high && farthest_m <= grid_.farthest_m && high - low > 0.0 &&
         farthest_m > 0.5 * grid_.farthest_m;
}

/// Cosine of the azimuth between a direction and the sun, times the sun's horizontal part.
double AirTables::sunAcrossOf(const View& view, const glm::dvec3& direction) const {
  if (!plan_.terms.scatteredSun) return 0.0;
  const glm::dvec3 up = simulation_.frame.up(view.position), toSun = simulation_.sun->toSun;
  const glm::dvec3 a = direction - glm::dot(direction, up) * up, b = toSun - glm::dot(toSun, up) * up;
  return glm::length(a) > 1e-6 && glm::length(b) > 1e-6 ? glm::dot(glm::normalize(a), b) : 0.0;
}

/// Towards the sun's own azimuth.
double AirTables::sunAcrossAtMost(const View& view) const {
  if (!plan_.terms.scatteredSun) return 0.0;
  const glm::dvec3 up = simulation_.frame.up(view.position), toSun = simulation_.sun->toSun;
  return glm::length(toSun - glm::dot(toSun, up) * up);
}

/// Least and greatest in a view, from its edge; all where it sees the zenith or its opposite.
std::pair<double, double> AirTables::sunAcrossIn(const View& view) const {
  if (!plan_.terms.scatteredSun) return {0.0, 0.0};
  const double most = sunAcrossAtMost(view);
  double low = most, high = -most;
  constexpr int kSteps = 16;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      const double across = sunAcrossOf(view, view.localFromCamera * view.ray(view.width * i / double(kSteps), view.height * j / double(kSteps)));
      low = std::min(low, across);
      high = std::max(high, across);
    }
  for (double sign : {1.0, -1.0})
    if (onFilm(view, sign * simulation_.frame.up(view.position))) return {-most, most};
  // The sun's own azimuth, or its opposite, may lie between the places looked at.
  const double margin = 0.03 * (high - low) + 1e-6;
  return {std::max(low - margin, -most), std::min(high + margin, most)};
}

double AirTables::acrossAt(int azimuth) const {
  return azimuths_ == 1 ? grid_.sunAcross : grid_.acrossLow + (grid_.acrossHigh - grid_.acrossLow) * azimuth / (azimuths_ - 1);
}

/// Per node, or per channel as its nodes' sunlight is scattered; padded to vec4.
std::vector<double> AirTables::asymmetries() const {
  std::vector<double> asymmetry(static_cast<size_t>((values_ + 3) / 4 * 4), 0.0);
  if (!perChannel_) {
    for (size_t i = 0; i < plan_.nodes.size(); ++i) asymmetry[i] = plan_.nodes[i].air.asymmetry;
    return asymmetry;
  }
  for (size_t slot = 0; slot < plan_.weight.size(); ++slot) {
    double sum = 0.0, total = 0.0;
    for (size_t i = 0; i < plan_.nodes.size(); ++i) {
      double share = 0.0;
      for (double h : plan_.nodes[i].air.haze) share += h;
      share *= plan_.weight[slot][i] * sunIrradiance_[i];
      sum += share * plan_.nodes[i].air.asymmetry;
      total += share;
    }
    asymmetry[slot] = total > 0.0 ? sum / total : 0.0;
  }
  return asymmetry;
}

/// One row of the tables. Emission and amounts are those of the first azimuth.
void AirTables::fillElevation(const View& view, int azimuth, int e, const std::vector<double>& asymmetry, std::vector<float>& amounts,
                              std::vector<float>& radiance, std::vector<double>& totals) const {
  const Path& path = *simulation_.path;
  const double height = simulation_.frame.height(view.position), radius = simulation_.frame.earthRadius_m();
  const size_t nodes = plan_.nodes.size(), values = static_cast<size_t>(values_), parts = static_cast<size_t>(parts_),
               columns = static_cast<size_t>(ranges_) + 1;
  const double sine = sineAt(e), across = acrossAt(azimuth);
  RaySun sun;
  if (plan_.terms.scatteredSun) {
    sun.sinElevation = glm::dot(simulation_.sun->toSun, simulation_.frame.up(view.position));
    sun.cosScatter = sine * sun.sinElevation + std::sqrt(std::max(1.0 - sine * sine, 0.0)) * across;
  }
  double entry = 0.0;
  if (height > path.top_m()) {
    const double b = (radius + height) * sine, q2 = (path.top_m() - height) * (2.0 * radius + path.top_m() + height), root = b * b + q2;
    entry = root <= 0.0 || b >= 0.0 ? physics::kFar : -q2 / (std::sqrt(root) - b);
  }
  const auto ranges = rangesFrom(std::min(entry, 1e12));
  const auto lineAt = [&](double s) {
    RaySun at = sun;
    if (plan_.terms.scatteredSun) at.cosScatter = s * sun.sinElevation + std::sqrt(std::max(1.0 - s * s, 0.0)) * across;
    const AirRay along{height, s, radius};
    return SunlitAir(path, along, path.stationsAt(along, ranges), plan_.terms.scatteredSun ? plan_.sunLegs.get() : nullptr, at);
  };
  const SunlitAir line = lineAt(sine);
  // Below the horizon nothing is seen through the earth: between the last row there and the next the sky is mixed with that on the horizon.
  const double above = std::max(height, 0.0), horizon = -std::sqrt(above * (2.0 * radius + above)) / (radius + above);
  std::optional<SunlitAir> onHorizon;
  if (simulation_.ground && sine < horizon && sineAt(e + 1) >= horizon) onHorizon = lineAt(horizon);
  float* amount = &amounts[static_cast<size_t>(e) * columns * static_cast<size_t>(4 * vectors_)];
  for (size_t r = 0; azimuth == 0 && r < columns; ++r) {
    // At the beginning of the air: the density there. Towards space: the whole amount.
    const double length_km = r == 0 || r + 1 == columns ? 1.0 : 1e-3 * (ranges[r] - ranges[0]);
    const size_t s = r + 1 == columns ? ranges.size() - 1 : r;
    const AirAmounts a = onHorizon && r + 1 == columns ? onHorizon->stations.back().amounts
                         : r == 0                      ? path.densities(line.stations.empty() ? height : line.stations[0].height_m)
                                                       : line.stations[s].amounts;
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) *amount++ = static_cast<float>(logOf(a.amount[k] / length_km));
  }
  std::vector<double> source(line.stations.size());
  AirRadiance all;  // with all of the emission
  const auto radianceOf = [&](const SunlitAir& along, size_t i) {
    for (size_t s = 0; s < source.size(); ++s) source[s] = along.stations[s].temperature_K > 0.0 ? planck(i, along.stations[s].temperature_K) : 0.0;
    AirRadiance found = airRadiance(plan_.nodes[i].air, along, source);
    all = found;
    // Emission is kept as what it differs from that of air of one temperature, which the shader works out by the pixel's own depth.
    for (size_t s = 0; s < found.depth.size(); ++s) found.thermal[s] -= black_[i] * physics::oneMinusExp(found.depth[s]);
    return found;
  };
  for (size_t i = 0; i < nodes; ++i) {
    AirRadiance found = radianceOf(line, i);
    const double rayleigh = rayleighPhase(sun.cosScatter), mie = henyeyGreensteinPhase(sun.cosScatter, plan_.nodes[i].air.asymmetry);
    for (size_t r = 0; r < columns; ++r) {
      const size_t s = r + 1 == columns ? all.thermal.size() - 1 : r;
      double sent = all.thermal[s];
      if (!all.haze.empty()) sent += sunIrradiance_[i] * (rayleigh * all.molecules[s] + mie * all.haze[s]);
      for (size_t slot = 0; slot < plan_.weight.size(); ++slot)
        totals[(static_cast<size_t>(azimuth * elevations_ + e) * columns + r) * plan_.weight.size() + slot] += plan_.weight[slot][i] * sent;
    }
    if (onHorizon) {
      const AirRadiance sky = radianceOf(*onHorizon, i);
      found.thermal.back() = sky.thermal.back();
      if (!sky.haze.empty()) found.molecules.back() = sky.molecules.back(), found.haze.back() = sky.haze.back();
    }
    for (size_t part = azimuth == 0 ? 0 : 1; part < parts; ++part) {
      const auto& sent = part == 0 ? found.thermal : part == 1 ? found.molecules : found.haze;
      const double strength = part == 0 ? 1.0 : sunIrradiance_[i];
      for (size_t r = 0; r < columns; ++r) {
        const double value = r + 1 == columns ? sent.back() : sent[r];
        float* at = &radiance[((static_cast<size_t>(azimuth * elevations_ + e) * columns + r) * parts + part) * values];
        if (!perChannel_) {
          at[i] = static_cast<float>(strength * value);
          continue;
        }
        for (size_t slot = 0; slot < plan_.weight.size(); ++slot) {
          if (plan_.weight[slot][i] == 0.0) continue;
          // The shader has one asymmetry per channel: in the view's middle each node keeps its own.
          const double own =
              part < 2 ? 1.0 : henyeyGreensteinPhase(sun.cosScatter, plan_.nodes[i].air.asymmetry) / henyeyGreensteinPhase(sun.cosScatter, asymmetry[slot]);
          at[slot] += static_cast<float>(plan_.weight[slot][i] * strength * value * own);
        }
      }
    }
  }
}

double AirTables::sineAt(int elevation) const {
  const double x = spread(grid_.low) + (spread(grid_.high) - spread(grid_.low)) * elevation / (elevations_ - 1);
  return x * std::abs(x);
}

/// What is lost between elevations: a quarter of what every other one would be off by, if it stood between its neighbours.
double AirTables::elevationError(const std::vector<double>& totals) const {
  const double above = std::max(grid_.height_m, 0.0), radius = simulation_.frame.earthRadius_m();
  const double horizon = simulation_.ground ? -std::sqrt(above * (2.0 * radius + above)) / (radius + above) : -2.0;
  const size_t slots = plan_.weight.size(), row = (static_cast<size_t>(ranges_) + 1) * slots;
  std::vector<double> greatest(slots, 0.0);
  for (size_t k = 0; k < totals.size(); ++k) greatest[k % slots] = std::max(greatest[k % slots], totals[k]);
  double most = 0.0;
  for (int a = 0; a < azimuths_; ++a)
    for (int e = 1; e + 1 < elevations_; e += 2) {
      // Sky and ground meet on the horizon, where the row below has the sky's end.
      if (sineAt(e - 1) < horizon && sineAt(e + 2) >= horizon) continue;
      const double* here = &totals[static_cast<size_t>(a * elevations_ + e) * row];
      for (size_t k = 0; k < row; ++k) {
        const double between = 0.5 * (here[k - row] + here[k + row]), size = std::max(here[k], kFaint * greatest[k % slots]);
        if (size > 0.0) most = std::max(most, 0.25 * std::abs(here[k] - between) / size);
      }
    }
  return most;
}

void AirTables::fill(const View& view) {
  const Path& path = *simulation_.path;
  const size_t columns = static_cast<size_t>(ranges_) + 1;
  const double share = kElevationShare * (plan_.accuracy > 0.0 ? plan_.accuracy : 0.01);
  const std::vector<double> asymmetry = asymmetries();
  std::vector<float> amounts, radiance;
  for (;;) {
    amounts.assign(static_cast<size_t>(elevations_) * columns * static_cast<size_t>(4 * vectors_), 0.0f);
    radiance.assign(static_cast<size_t>(azimuths_ * elevations_) * columns * static_cast<size_t>(parts_) * static_cast<size_t>(texels_) * (perChannel_ ? 4 : 1),
                    0.0f);
    std::vector<double> totals(static_cast<size_t>(azimuths_ * elevations_) * columns * plan_.weight.size(), 0.0);
    std::atomic<int> next{0};
    auto work = [&] {
      for (int row = next++; row < azimuths_ * elevations_; row = next++)
        fillElevation(view, row / elevations_, row % elevations_, asymmetry, amounts, radiance, totals);
    };
    std::vector<std::future<void>> others;
    for (unsigned t = 1; t < std::thread::hardware_concurrency(); ++t) others.push_back(std::async(std::launch::async, work));
    work();
    for (auto& o : others) o.get();
    if (elevations_ >= kMostElevations) break;
    const double error = elevationError(totals);
    if (error <= share) break;
    // Each doubling leaves a quarter.
    const int doublings = std::max(1, static_cast<int>(std::ceil(0.5 * std::log2(error / share))));
    elevations_ = std::min(((elevations_ - 1) << std::min(doublings, 8)) + 1, kMostElevations);
  }
  amounts.insert(amounts.end(), heights_.begin(), heights_.end());
  amounts_.upload(amounts);
  radiance_.upload(radiance);

  std::vector<float> block;
  auto put = [&block](std::initializer_list<double> v) {
    for (double x : v) block.push_back(static_cast<float>(x));
  };
  const double top = path.top_m();
  put({spread(grid_.low), (elevations_ - 1) / (spread(grid_.high) - spread(grid_.low)), kScale * grid_.farthest_m, (ranges_ - 1) / std::log1p(1.0 / kScale)});
  put({acrossAt(0), azimuths_ > 1 ? (azimuths_ - 1) / std::max(acrossAt(azimuths_ - 1) - acrossAt(0), 1e-12) : 0.0, static_cast<double>(elevations_), 0.0});
  put({SunLegs::kBottom_m, (SunLegs::kHeights - 1) / std::sqrt(top - SunLegs::kBottom_m), plan_.sunLegs ? plan_.sunLegs->firstSine() : 0.0,
       plan_.sunLegs ? 1.0 / plan_.sunLegs->step() : 0.0});
  const auto powers = path.exponents();
  for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) put({k < powers.size() ? powers[k] : 1.0});
  for (const SpectralNode& n : plan_.nodes)
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) put({n.air.extinction[k]});
  block.insert(block.end(), asymmetry.begin(), asymmetry.end());
  for (size_t i = 0; i < (plan_.nodes.size() + 3) / 4 * 4; ++i) put({i < black_.size() ? black_[i] : 0.0});
  block_.upload(block);
}

void AirTables::bind() const {
  if (!needed_) return;
  block_.bindUniform(3);
  amounts_.bindTexture(20, 4);
  radiance_.bindTexture(21, perChannel_ ? 4 : 1);
}

}  // namespace pitviper
