#include "atmosphere/layered_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sim/radiance/diffuse_light.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

constexpr double kNothing = 1e-30;

double logOf(double v) { return std::log(std::max(v, kNothing)); }

}  // namespace

AirRows::AirRows(const Simulation& simulation, const Plan& plan, bool perChannel)
    : simulation_(simulation),
      plan_(plan),
      perChannel_(perChannel),
      air_(plan.nodes, plan.terms.streams > 0 ? DiffuseLight::of(columnOf(simulation), plan.terms.streams) : nullptr, true) {
  vectors_ = (static_cast<int>(simulation.air->exponents().size()) + 3) / 4;
  values_ = perChannel ? 4 * plan.groupCount() : (plan.nodeCount() + 3) / 4 * 4;
  parts_ = plan.terms.scatteredSun ? plan.terms.streams > 0 ? 4 : 3 : 1;
  for (const SpectralNode& n : plan.nodes) sunIrradiance_.push_back(plan.terms.scatteredSun ? n.mean(simulation.sun->irradiance) : 0.0);
  asymmetry_ = asymmetriesOf();
}

void AirRows::begin(const AirGrid& grid) {
  grid_ = grid;
  const AirRay here{std::min(grid_.places.height_m, simulation_.air->top_m()), 1.0, simulation_.frame.earthRadius_m()};
  const double temperature_K = simulation_.air->stationsAt(here, std::array{0.0}).front().temperature_K;
  black_ = air_.planck(temperature_K);
}

/// The asymmetry of haze per node, or per channel the mean over its nodes by the sunlight that they scatter.
std::vector<double> AirRows::asymmetriesOf() const {
  std::vector<double> asymmetry(static_cast<size_t>(values_), 0.0);
  if (!perChannel_) {
    for (size_t i = 0; i < plan_.nodes.size(); ++i) asymmetry[i] = plan_.nodes[i].air.meanAsymmetry;
    return asymmetry;
  }
  for (size_t slot = 0; slot < plan_.weight.size(); ++slot) {
    double sum = 0.0, total = 0.0;
    for (size_t i = 0; i < plan_.nodes.size(); ++i) {
      double share = 0.0;
      for (double h : plan_.nodes[i].air.haze) share += h;
      share *= plan_.weight[slot][i] * sunIrradiance_[i];
      sum += share * plan_.nodes[i].air.meanAsymmetry;
      total += share;
    }
    asymmetry[slot] = total > 0.0 ? sum / total : 0.0;
  }
  return asymmetry;
}

double AirRows::entryOf(double sine) const {
  const double height = grid_.places.height_m, top = simulation_.air->top_m(), radius = simulation_.frame.earthRadius_m();
  if (!(height > top)) return 0.0;
  const double b = (radius + height) * sine, q2 = (top - height) * (2.0 * radius + top + height), root = b * b + q2;
  return std::min(root <= 0.0 || b >= 0.0 ? physics::kFar : -q2 / (std::sqrt(root) - b), 1e12);
}

double AirRows::cosScatterOf(const AirLine& line) const {
  return line.sine * grid_.places.sunSine + std::sqrt(std::max(1.0 - line.sine * line.sine, 0.0)) * line.across;
}

AirRow AirRows::at(const AirLine& line, SameElevation* known) const {
  std::vector<double> places = stationsOf(line);
  if (!line.reachesSpace) places.erase(places.begin() + grid_.places.ranges, places.end() - 1);
  AirRow row = at(line, places, known);
  // The places between the scene and space have no entries.
  const auto keep = [&](std::vector<float>& all, size_t each) {
    const auto ranges = static_cast<std::ptrdiff_t>(static_cast<size_t>(grid_.places.ranges) * each);
    all.erase(all.begin() + ranges, all.end() - static_cast<std::ptrdiff_t>(each));
  };
  keep(row.amounts, static_cast<size_t>(4 * vectors_));
  keep(row.radiance, static_cast<size_t>(parts_) * static_cast<size_t>(values_));
  return row;
}

namespace {

/// The same with the sky on the horizon as what is seen in space.
void endOn(NodeRadiance& line, const NodeRadiance& horizon, size_t nodes) {
  for (auto part : {&NodeRadiance::thermal, &NodeRadiance::molecules, &NodeRadiance::haze, &NodeRadiance::again})
    if (!(line.*part).empty())
      std::copy((horizon.*part).end() - static_cast<std::ptrdiff_t>(nodes), (horizon.*part).end(), (line.*part).end() - static_cast<std::ptrdiff_t>(nodes));
}

}  // namespace

AirRow AirRows::at(const AirLine& asked, std::span<const double> ranges, SameElevation* known) const {
  const Atmosphere& path = *simulation_.air;
  const double height = grid_.places.height_m, radius = simulation_.frame.earthRadius_m();
  const auto placesOf = [&](double sine) { return withShellPlaces(path, {height, sine, radius}, ranges, Within::Tables); };
  const auto lineAt = [&](double sine) {
    RaySun sun;
    if (plan_.terms.scatteredSun) sun = {grid_.places.sunSine, cosScatterOf({sine, asked.across, false})};
    const AirRay along{height, sine, radius};
    return SunlitAir(path, along, path.stationsAt(along, placesOf(sine)), plan_.terms.scatteredSun ? plan_.sunLegs.get() : nullptr, sun);
  };
  const SunlitAir line = lineAt(asked.sine);
  NodeRadiance sent = sentAlong(line, known ? &known->sent : nullptr);
  // Below the horizon nothing is seen through the earth: between the last row there and the next the sky is mixed with that on the horizon.
  std::optional<SunlitAir> onHorizon;
  if (asked.meetsHorizon && ranges.back() >= physics::kFar)
    endOn(sent, sentAlong(onHorizon.emplace(lineAt(grid_.horizon(radius))), known ? &known->onHorizon : nullptr), plan_.nodes.size());
  // Which of the places looked at are those asked for.
  std::vector<size_t> asked_;
  const std::vector<double> places = placesOf(asked.sine);
  for (double r : ranges) asked_.push_back(static_cast<size_t>(std::lower_bound(places.begin(), places.end(), r) - places.begin()));
  AirRow row;
  row.amounts.reserve(ranges.size() * static_cast<size_t>(4 * vectors_));
  for (size_t r = 0; r < ranges.size(); ++r) {
    const bool space = ranges[r] >= physics::kFar;
    const double length_km = r == 0 || space ? 1.0 : 1e-3 * (ranges[r] - ranges[0]);
    AirAmounts a = r == 0               ? path.densities(line.stations.empty() ? height : line.stations[0].height_m)
                   : space && onHorizon ? onHorizon->stations.back().amounts
                                        : line.stations[asked_[r]].amounts;
    dropShells(path.shells(), a);
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) row.amounts.push_back(static_cast<float>(logOf(a.amount[k] / length_km)));
  }
  // Places of a lattice may lie beyond the sun's own azimuth, where angles have no cosine.
  writeRadiance(sent, asked_, std::clamp(cosScatterOf(asked), -1.0, 1.0), row);
  return row;
}

/// Emission as what it differs from that of air of one temperature, which the shader works out by the pixel's own depth.
NodeRadiance AirRows::sentAlong(const SunlitAir& line, SameWay* known) const {
  NodeRadiance sent = air_.along(line, known);
  const std::vector<double> lost = lostOf(sent.depth);
  for (size_t at = 0; at < lost.size(); ++at) sent.thermal[at] -= black_[at % black_.size()] * lost[at];
  return sent;
}

/// Radiance of nodes, or integrated over the channels, at some of the places looked at.
void AirRows::writeRadiance(const NodeRadiance& sent, std::span<const size_t> asked, double cosScatter, AirRow& row) const {
  const size_t nodes = plan_.nodes.size(), columns = asked.size(), parts = static_cast<size_t>(parts_), values = static_cast<size_t>(values_);
  row.radiance.assign(columns * parts * values, 0.0f);
  for (size_t part = 0; part < parts; ++part) {
    const auto& own = part == 0 ? sent.thermal : part == 1 ? sent.molecules : part == 2 ? sent.haze : sent.again;
    if (own.empty()) continue;  // the sun is far below the horizon
    const auto phaseOf = [&](double asymmetry) {
      return part == 2 ? physics::henyeyGreensteinPhase(cosScatter, asymmetry) : hazeAgainPhase(cosScatter, asymmetry);
    };
    for (size_t i = 0; i < nodes; ++i) {
      const double strength = part == 0 ? 1.0 : sunIrradiance_[i];
      const auto add = [&](size_t value, double weight) {
        for (size_t r = 0; r < columns; ++r) row.radiance[(r * parts + part) * values + value] += static_cast<float>(weight * own[asked[r] * nodes + i]);
      };
      if (!perChannel_) add(i, strength);
      for (size_t slot = 0; perChannel_ && slot < plan_.weight.size(); ++slot) {
        if (plan_.weight[slot][i] == 0.0) continue;
        // The shader has one asymmetry per channel: on the row's own azimuth each node keeps its own.
        const double turned = part < 2 ? 1.0 : phaseOf(plan_.nodes[i].air.meanAsymmetry) / phaseOf(asymmetry_[slot]);
        add(slot, strength * plan_.weight[slot][i] * turned);
      }
    }
  }
}

}  // namespace pitviper
