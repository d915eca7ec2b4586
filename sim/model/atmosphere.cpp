#include "sim/model/atmosphere.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/refracts.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {

namespace {

const Refracts* bendsOf(const Atmosphere& air) {
  const auto* own = dynamic_cast<const Refracts*>(&air);
  return own && own->bends() ? own : nullptr;
}

double straightened(const Refracts* bends, double height_m) { return bends ? bends->straightened_m(height_m) : height_m; }

}  // namespace

std::vector<AirShell> straightShells(const Atmosphere& air) {
  std::vector<AirShell> all(air.shells().begin(), air.shells().end());
  const Refracts* bends = all.empty() ? nullptr : bendsOf(air);
  for (AirShell& s : all) {
    const double thickness_m = s.high_m - s.low_m;
    s.low_m = straightened(bends, s.low_m), s.high_m = straightened(bends, s.high_m);
    s.per_m *= thickness_m / (s.high_m - s.low_m);
  }
  return all;
}

void addShells(const Atmosphere& air, const AirRay& ray, double range_m, AirAmounts& into) {
  if (air.shells().empty()) return;
  const double height_m = straightened(bendsOf(air), ray.height_m);
  for (const AirShell& s : straightShells(air))
    into.amount[static_cast<std::size_t>(s.amount)] +=
        s.per_m * physics::lengthInShell(s.low_m, s.high_m, height_m, ray.sinElevation, range_m, ray.earthRadius_m);
}

namespace {

/// Amounts between an edge and places within, a unit of which is about an optical depth of 1 in the visible; of tables, whose neighbours must lose the same.
constexpr double kWithin[] = {0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0},
                 kWithinTables[] = {0.03, 0.06, 0.1, 0.15, 0.21, 0.3, 0.4, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0, 22.0, 32.0};

}  // namespace

std::vector<double> withShellPlaces(const Atmosphere& air, const AirRay& ray, std::span<const double> ranges_m, Within within) {
  std::vector<double> all(ranges_m.begin(), ranges_m.end());
  if (air.shells().empty()) return all;
  const double h0 = straightened(bendsOf(air), ray.height_m), r0 = ray.earthRadius_m + h0, b = r0 * ray.sinElevation;
  const auto meet = [&](double height_m) {
    const double c = (height_m - h0) * (ray.earthRadius_m + height_m + r0), d = b * b + c;
    if (!(d > 0.0)) return;
    const double far = b >= 0.0 ? -b - std::sqrt(d) : -b + std::sqrt(d);
    for (double range : {far, -c / far})
      if (range > ranges_m.front() && range < ranges_m.back()) all.push_back(range);
  };
  for (const AirShell& s : straightShells(air)) {
    meet(s.low_m), meet(s.high_m);
    for (double amount : within == Within::Tables ? std::span<const double>(kWithinTables) : std::span<const double>(kWithin))
      if (const double in = amount / s.per_m; in < 0.5 * (s.high_m - s.low_m)) meet(s.low_m + in), meet(s.high_m - in);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void dropShells(std::span<const AirShell> shells, AirAmounts& from) {
  for (const AirShell& s : shells) from.amount[static_cast<std::size_t>(s.amount)] = 0.0;
}

ParticleKinds particleKinds(std::span<const AirNode> nodes) {
  ParticleKinds kinds;
  for (std::size_t k = 0; k < kMostAirAmounts; ++k) {
    if (std::all_of(nodes.begin(), nodes.end(), [&](const AirNode& n) { return n.haze[k] == 0.0; })) continue;
    const auto own = std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) {
      return std::all_of(nodes.begin(), nodes.end(), [&](const AirNode& n) { return n.asymmetry[k] == n.asymmetry[kind.front()]; });
    });
    if (own == kinds.end()) kinds.push_back({k});
    else own->push_back(k);
  }
  return kinds;
}

AirAmounts Atmosphere::densities(double) const { return {}; }

std::vector<AirStation> Atmosphere::stations(const AirRay& ray, double range_m) const { return {{}, {range_m, 0.0, 0.0, amounts(ray, range_m)}}; }

std::vector<double> Atmosphere::placesAlong(const AirRay& ray, double range_m) const {
  std::vector<double> ranges;
  for (const AirStation& s : stations(ray, range_m)) ranges.push_back(s.range_m);
  return ranges;
}

std::vector<AirStation> Atmosphere::stationsAt(const AirRay& ray, std::span<const double> ranges_m) const {
  std::vector<AirStation> stations;
  for (double r : ranges_m) stations.push_back({r, 0.0, 0.0, amounts(ray, r)});
  return stations;
}

AirAmounts Atmosphere::powered(const AirAmounts& amounts) const {
  AirAmounts u;
  const auto powers = exponents();
  for (size_t k = 0; k < powers.size(); ++k) {
    const double w = std::max(amounts.amount[k], 0.0);
    u.amount[k] = powers[k] == 1.0 ? w : std::pow(w, powers[k]);
  }
  return u;
}

double Atmosphere::depthOf(const AirNode& node, const AirAmounts& powered) {
  double depth = 0.0;
  for (size_t k = 0; k < node.extinction.size(); ++k) depth += node.extinction[k] * powered.amount[k];
  return depth;
}

double Atmosphere::transmittance(const AirNode& node, const AirAmounts& amounts) const { return std::exp(-opticalDepth(node, amounts)); }

void AirLight::emitted(std::span<const double> source, std::span<double> radiance) const {
  double sum = 0.0, seen = 1.0;
  if (!depth.empty()) seen = std::exp(-depth[0]), radiance[0] = 0.0;
  for (size_t i = 1; i < depth.size(); ++i) {
    const double d = std::max(depth[i] - depth[i - 1], 0.0), left = std::exp(-d);
    sum += seen * physics::segmentRadiance(source[i - 1], source[i], d, left, physics::lostOf(d, left));
    seen *= left;
    radiance[i] = sum;
  }
}

}  // namespace pitviper
