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

/// Entries of the tables. Ranges lie evenly in ln(1 + range / scale), scale a thousandth of the farthest: 7 % apart beyond it.
constexpr int kElevations = 65, kRanges = 96;
/// Below 0.3 %: twice as many elevations and ranges, for a quarter of what is lost between them (0.3 % of the worst pixel in a field of 40 degrees).
constexpr double kFine = 0.003;
constexpr double kScale = 1e-3;
/// Ranges of places towards space [m].
constexpr double kFirstSky_m = 100.0, kLastSky_m = 2e6;
/// Temperatures of air anywhere [K] and entries over their inverse.
constexpr double kColdest_K = 140.0, kWarmest_K = 400.0;
constexpr int kTemperatures = 256;
constexpr double kNothing = 1e-30;
/// Tables reach so much of a view's elevations beyond it, to serve the next views of a camera that turns.
constexpr double kMargin = 0.2;
/// At 1 %: heights [m] and azimuths (cosines) to the sun that one table serves. Haze thins by 0.1 % in a metre.
constexpr double kSameHeight_m = 1.0, kSameAzimuth = 0.02;

double logOf(double v) { return std::log(std::max(v, kNothing)); }

/// Elevations lie evenly in the signed root of their sine: near the horizon a small step crosses much air.
double spread(double sine) { return std::copysign(std::sqrt(std::abs(sine)), sine); }

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
  const glm::dvec3 zenith = glm::transpose(v.localFromCamera) * up;
  for (double sign : {1.0, -1.0}) {
    const glm::dvec3 d = sign * zenith;
    if (d.z >= 0.0) continue;
    const glm::dvec2 at = filmPosition(v, d);
    if (at.x >= 0 && at.y >= 0 && at.x <= v.width && at.y <= v.height) (sign > 0 ? high : low) = sign;
  }
  const double margin = 0.03 * (high - low) + 1e-4;  // between the places looked at
  return {std::max(low - margin, -1.0), std::min(high + margin, 1.0)};
}

}  // namespace

AirTables::AirTables(const Simulation& simulation, const Plan& plan, bool perChannel, bool wanted)
    : simulation_(simulation), plan_(plan), perChannel_(perChannel), needed_(wanted && plan.terms.air && simulation.path->isLayered()) {
  if (!needed_) return;
  const int finer = plan.accuracy > 0.0 && plan.accuracy < kFine ? 2 : 1;
  elevations_ = finer * (kElevations - 1) + 1;
  ranges_ = finer * kRanges;
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
  slots.constants["AIR_ELEVATIONS"] = elevations_;
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
  for (double r = 1.15 * std::max(grid_.farthest_m, kFirstSky_m); r < kLastSky_m; r *= 1.15) ranges.push_back(entry_m + r);
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
  grid_ = {view.position, simulation_.frame.height(view.position), sunAcrossOf(view), std::max(low - margin, -1.0), std::min(high + margin, 1.0),
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
  const bool near = grid_.position == view.position || (std::abs(simulation_.frame.height(view.position) - grid_.height_m) <= kSameHeight_m * share &&
                                                        std::abs(sunAcrossOf(view) - grid_.sunAcross) <= kSameAzimuth * share);
  return near && low >= grid_.low && high <= grid_.high && farthest_m <= grid_.farthest_m && high - low > 0.0 && farthest_m > 0.5 * grid_.farthest_m;
}

/// Cosine of the azimuth between the view's middle and the sun, times both horizontal parts.
double AirTables::sunAcrossOf(const View& view) const {
  if (!plan_.terms.scatteredSun) return 0.0;
  const glm::dvec3 up = simulation_.frame.up(view.position), axis = view.localFromCamera * glm::dvec3(0, 0, -1), toSun = simulation_.sun->toSun;
  const glm::dvec3 a = axis - glm::dot(axis, up) * up, b = toSun - glm::dot(toSun, up) * up;
  return glm::length(a) > 1e-6 && glm::length(b) > 1e-6 ? glm::dot(glm::normalize(a), b) : 0.0;
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

/// One row of the tables.
void AirTables::fillElevation(const View& view, int e, const std::vector<double>& asymmetry, std::vector<float>& amounts, std::vector<float>& radiance) const {
  const Path& path = *simulation_.path;
  const double height = simulation_.frame.height(view.position), radius = simulation_.frame.earthRadius_m();
  const size_t nodes = plan_.nodes.size(), values = static_cast<size_t>(values_), parts = static_cast<size_t>(parts_),
               columns = static_cast<size_t>(ranges_) + 1;
  const auto sineOf = [this](int row) {
    const double x = spread(grid_.low) + (spread(grid_.high) - spread(grid_.low)) * row / (elevations_ - 1);
    return x * std::abs(x);
  };
  const double sine = sineOf(e);
  RaySun sun;
  if (plan_.terms.scatteredSun) {
    sun.sinElevation = glm::dot(simulation_.sun->toSun, simulation_.frame.up(view.position));
    sun.cosScatter = sine * sun.sinElevation + std::sqrt(std::max(1.0 - sine * sine, 0.0)) * grid_.sunAcross;
  }
  double entry = 0.0;
  if (height > path.top_m()) {
    const double b = (radius + height) * sine, q2 = (path.top_m() - height) * (2.0 * radius + path.top_m() + height), root = b * b + q2;
    entry = root <= 0.0 || b >= 0.0 ? physics::kFar : -q2 / (std::sqrt(root) - b);
  }
  const auto ranges = rangesFrom(std::min(entry, 1e12));
  const auto lineAt = [&](double sineAt) {
    RaySun at = sun;
    if (plan_.terms.scatteredSun) at.cosScatter = sineAt * sun.sinElevation + std::sqrt(std::max(1.0 - sineAt * sineAt, 0.0)) * grid_.sunAcross;
    const AirRay along{height, sineAt, radius};
    return SunlitAir(path, along, path.stationsAt(along, ranges), plan_.terms.scatteredSun ? plan_.sunLegs.get() : nullptr, at);
  };
  const SunlitAir line = lineAt(sine);
  // Below the horizon nothing is seen through the earth: between the last row there and the next the sky is mixed with that on the horizon.
  const double above = std::max(height, 0.0), horizon = -std::sqrt(above * (2.0 * radius + above)) / (radius + above);
  std::optional<SunlitAir> onHorizon;
  if (simulation_.ground && sine < horizon && sineOf(e + 1) >= horizon) onHorizon = lineAt(horizon);
  float* amount = &amounts[static_cast<size_t>(e) * columns * static_cast<size_t>(4 * vectors_)];
  for (size_t r = 0; r < columns; ++r) {
    // At the beginning of the air: the density there. Towards space: the whole amount.
    const double length_km = r == 0 || r + 1 == columns ? 1.0 : 1e-3 * (ranges[r] - ranges[0]);
    const size_t s = r + 1 == columns ? ranges.size() - 1 : r;
    const AirAmounts a = onHorizon && r + 1 == columns ? onHorizon->stations.back().amounts
                         : r == 0                      ? path.densities(line.stations.empty() ? height : line.stations[0].height_m)
                                                       : line.stations[s].amounts;
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) *amount++ = static_cast<float>(logOf(a.amount[k] / length_km));
  }
  std::vector<double> source(line.stations.size());
  const auto radianceOf = [&](const SunlitAir& along, size_t i) {
    for (size_t s = 0; s < source.size(); ++s) source[s] = along.stations[s].temperature_K > 0.0 ? planck(i, along.stations[s].temperature_K) : 0.0;
    AirRadiance found = airRadiance(plan_.nodes[i].air, along, source);
    // Emission is kept as what it differs from that of air of one temperature, which the shader works out by the pixel's own depth.
    for (size_t s = 0; s < found.depth.size(); ++s) found.thermal[s] -= black_[i] * physics::oneMinusExp(found.depth[s]);
    return found;
  };
  for (size_t i = 0; i < nodes; ++i) {
    AirRadiance found = radianceOf(line, i);
    if (onHorizon) {
      const AirRadiance sky = radianceOf(*onHorizon, i);
      found.thermal.back() = sky.thermal.back();
      if (!sky.haze.empty()) found.molecules.back() = sky.molecules.back(), found.haze.back() = sky.haze.back();
    }
    for (size_t part = 0; part < parts; ++part) {
      const auto& sent = part == 0 ? found.thermal : part == 1 ? found.molecules : found.haze;
      const double strength = part == 0 ? 1.0 : sunIrradiance_[i];
      for (size_t r = 0; r < columns; ++r) {
        const double value = r + 1 == columns ? sent.back() : sent[r];
        float* at = &radiance[((static_cast<size_t>(e) * columns + r) * parts + part) * values];
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

void AirTables::fill(const View& view) {
  const Path& path = *simulation_.path;
  const size_t columns = static_cast<size_t>(ranges_) + 1;
  std::vector<float> amounts(static_cast<size_t>(elevations_) * columns * static_cast<size_t>(4 * vectors_)),
      radiance(static_cast<size_t>(elevations_) * columns * static_cast<size_t>(parts_) * static_cast<size_t>(texels_) * (perChannel_ ? 4 : 1));
  const std::vector<double> asymmetry = asymmetries();
  std::atomic<int> next{0};
  auto work = [&] {
    for (int e = next++; e < elevations_; e = next++) fillElevation(view, e, asymmetry, amounts, radiance);
  };
  std::vector<std::future<void>> others;
  for (unsigned t = 1; t < std::thread::hardware_concurrency(); ++t) others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& o : others) o.get();
  amounts.insert(amounts.end(), heights_.begin(), heights_.end());
  amounts_.upload(amounts);
  radiance_.upload(radiance);

  std::vector<float> block;
  auto put = [&block](std::initializer_list<double> v) {
    for (double x : v) block.push_back(static_cast<float>(x));
  };
  const double top = path.top_m();
  put({spread(grid_.low), (elevations_ - 1) / (spread(grid_.high) - spread(grid_.low)), kScale * grid_.farthest_m, (ranges_ - 1) / std::log1p(1.0 / kScale)});
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
