#include "atmosphere/layered_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Temperatures of air anywhere [K] and entries over their inverse.
constexpr double kColdest_K = 140.0, kWarmest_K = 400.0;
constexpr int kTemperatures = 256;
constexpr double kNothing = 1e-30;

double logOf(double v) { return std::log(std::max(v, kNothing)); }

}  // namespace

AirRows::AirRows(const Simulation& simulation, const Plan& plan, bool perChannel) : simulation_(simulation), plan_(plan), perChannel_(perChannel) {
  vectors_ = (static_cast<int>(simulation.air->exponents().size()) + 3) / 4;
  values_ = perChannel ? 4 * plan.groupCount() : plan.nodeCount();
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
  asymmetry_ = asymmetriesOf();
}

void AirRows::begin(const AirGrid& grid) {
  grid_ = grid;
  const AirRay here{std::min(grid_.height_m, simulation_.air->top_m()), 1.0, simulation_.frame.earthRadius_m()};
  const double temperature_K = simulation_.air->stationsAt(here, std::array{0.0}).front().temperature_K;
  black_.clear();
  for (size_t i = 0; i < plan_.nodes.size(); ++i) black_.push_back(temperature_K > 0.0 ? planck(i, temperature_K) : 0.0);
}

double AirRows::planck(size_t node, double temperature_K) const {
  const double t = (1.0 / temperature_K - 1.0 / kWarmest_K) / (1.0 / kColdest_K - 1.0 / kWarmest_K) * (kTemperatures - 1);
  if (!(t >= 0.0 && t <= kTemperatures - 1)) return plan_.nodes[node].planck(temperature_K);
  const auto i = std::min(static_cast<size_t>(t), static_cast<size_t>(kTemperatures - 2));
  const double f = t - static_cast<double>(i);
  return std::exp((1 - f) * logPlanck_[node][i] + f * logPlanck_[node][i + 1]);
}

/// Per node, or per channel as its nodes' sunlight is scattered.
std::vector<double> AirRows::asymmetriesOf() const {
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

double AirRows::entryOf(double sine) const {
  const double height = grid_.height_m, top = simulation_.air->top_m(), radius = simulation_.frame.earthRadius_m();
  if (!(height > top)) return 0.0;
  const double b = (radius + height) * sine, q2 = (top - height) * (2.0 * radius + top + height), root = b * b + q2;
  return std::min(root <= 0.0 || b >= 0.0 ? physics::kFar : -q2 / (std::sqrt(root) - b), 1e12);
}

double AirRows::cosScatterOf(const AirLine& line) const {
  return line.sine * grid_.sunSine + std::sqrt(std::max(1.0 - line.sine * line.sine, 0.0)) * line.across;
}

AirRow AirRows::at(const AirLine& line) const {
  AirRow row = at(line, stationsOf(line));
  // The places between the scene and space have no entries.
  const auto keep = [&](std::vector<float>& all, size_t each) {
    const auto ranges = static_cast<std::ptrdiff_t>(static_cast<size_t>(grid_.ranges) * each);
    all.erase(all.begin() + ranges, all.end() - static_cast<std::ptrdiff_t>(each));
  };
  keep(row.amounts, static_cast<size_t>(4 * vectors_));
  keep(row.radiance, static_cast<size_t>(parts_) * static_cast<size_t>(values_));
  return row;
}

AirRow AirRows::at(const AirLine& asked, std::span<const double> ranges) const {
  const Atmosphere& path = *simulation_.air;
  const double height = grid_.height_m, radius = simulation_.frame.earthRadius_m();
  const auto parts = static_cast<size_t>(parts_), values = static_cast<size_t>(values_), columns = ranges.size();
  const auto lineAt = [&](double sine) {
    RaySun sun;
    if (plan_.terms.scatteredSun) sun = {grid_.sunSine, cosScatterOf({sine, asked.across, false})};
    const AirRay along{height, sine, radius};
    return SunlitAir(path, along, path.stationsAt(along, ranges), plan_.terms.scatteredSun ? plan_.sunLegs.get() : nullptr, sun);
  };
  const SunlitAir line = lineAt(asked.sine);
  // Below the horizon nothing is seen through the earth: between the last row there and the next the sky is mixed with that on the horizon.
  std::optional<SunlitAir> onHorizon;
  if (asked.meetsHorizon && ranges.back() >= physics::kFar) onHorizon = lineAt(grid_.horizon(radius));
  AirRow row;
  row.amounts.reserve(columns * static_cast<size_t>(4 * vectors_));
  row.radiance.assign(columns * parts * values, 0.0f);
  for (size_t r = 0; r < columns; ++r) {
    const bool space = ranges[r] >= physics::kFar;
    const double length_km = r == 0 || space ? 1.0 : 1e-3 * (ranges[r] - ranges[0]);
    const AirAmounts a = r == 0               ? path.densities(line.stations.empty() ? height : line.stations[0].height_m)
                         : space && onHorizon ? onHorizon->stations.back().amounts
                                              : line.stations[r].amounts;
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) row.amounts.push_back(static_cast<float>(logOf(a.amount[k] / length_km)));
  }
  std::vector<double> source(line.stations.size());
  const auto radianceOf = [&](const SunlitAir& along, size_t i) {
    for (size_t s = 0; s < source.size(); ++s) source[s] = along.stations[s].temperature_K > 0.0 ? planck(i, along.stations[s].temperature_K) : 0.0;
    AirRadiance found = airRadiance(plan_.nodes[i].air, along, source);
    // Emission is kept as what it differs from that of air of one temperature, which the shader works out by the pixel's own depth.
    for (size_t s = 0; s < found.depth.size(); ++s) found.thermal[s] -= black_[i] * physics::oneMinusExp(found.depth[s]);
    return found;
  };
  const double cosScatter = cosScatterOf(asked);
  for (size_t i = 0; i < plan_.nodes.size(); ++i) {
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
        const double value = strength * sent[r];
        float* at = &row.radiance[(r * parts + part) * values];
        if (!perChannel_) {
          at[i] = static_cast<float>(value);
          continue;
        }
        for (size_t slot = 0; slot < plan_.weight.size(); ++slot) {
          if (plan_.weight[slot][i] == 0.0) continue;
          // The shader has one asymmetry per channel: on the row's own azimuth each node keeps its own.
          const double own =
              part < 2 ? 1.0 : henyeyGreensteinPhase(cosScatter, plan_.nodes[i].air.asymmetry) / henyeyGreensteinPhase(cosScatter, asymmetry_[slot]);
          at[slot] += static_cast<float>(plan_.weight[slot][i] * value * own);
        }
      }
    }
  }
  return row;
}

}  // namespace pitviper
