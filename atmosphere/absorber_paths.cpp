// Amounts on lines through layered air. Rays are straight; where light bends they are so over levels that stand where refraction puts them (setRefraction()).
#include <algorithm>
#include <cmath>

#include "atmosphere/absorber_table.hpp"
#include "sim/radiometry/exponentials.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

// Below this the first interval's exponential is held: the deepest open ground on earth is 0.43 km below the sea.
constexpr double kLowest_m = -2000.0;

// A straight line over a sphere. From r0 = radius + height and b = r0 sin(elevation): r^2 = r0^2 + s (2 b + s).
struct Ray {
  double height_m, r0, b, radius_m;

  Ray(double height, double sinElevation, double radius) : height_m(height), r0(radius + height), b(r0 * sinElevation), radius_m(radius) {}
  double heightAt(double s) const {
    const double grown = s * (2.0 * b + s);  // r^2 - r0^2, without the difference of large numbers
    return height_m + grown / (r0 + std::sqrt(std::max(r0 * r0 + grown, 0.0)));
  }
  double lowest_m() const { return -b; }  // where along the line
  // Where it crosses a height, if it does: first <= second.
  std::optional<std::pair<double, double>> crossings(double altitude_m) const {
    const double q2 = (altitude_m - height_m) * (2.0 * radius_m + altitude_m + height_m);
    const double root2 = b * b + q2;
    if (root2 <= 0.0) return std::nullopt;
    const double far = b >= 0.0 ? -b - std::sqrt(root2) : -b + std::sqrt(root2);
    const double near = -q2 / far;  // the product of the roots is -q2
    return std::minmax({near, far});
  }
};

// A stretch over which no logarithm of a density changes by more than twice the first, and departs from a straight line by more than the second, is summed by
// its middle and a series: the terms left out are below 2e-8 of it.
constexpr double kShortStretch = 0.5, kStraight = 1e-3;

// Mean of exp(a u + b u^2) over u from -1 to 1, for |a| <= kShortStretch and |b| <= kStraight.
double meanExponential(double a, double b) {
  const double a2 = a * a;
  return 1.0 + a2 * (1.0 / 6.0 + a2 * (1.0 / 120.0 + a2 * (1.0 / 5040.0))) + b * (1.0 / 3.0 + a2 * (1.0 / 10.0 + a2 * (1.0 / 168.0)) + b * (1.0 / 10.0));
}

const std::vector<QuadratureNode>& unitGauss(int points) {
  static const std::vector<QuadratureNode> few = gaussLegendre(3, 0.0, 1.0), many = gaussLegendre(AbsorberTable::kGaussPoints, 0.0, 1.0);
  return points == 3 ? few : many;
}

}  // namespace

struct AbsorberTable::Way {
  Ray ray;                        ///< over optical heights
  double begin_m, end_m;          ///< what of it lies in the air; the end not after the beginning: nothing
  std::vector<double> crossed_m;  ///< where along the ray it meets levels

  Way(const AbsorberTable& table, double height_m, double sinElevation, double range_m, double earthRadius_m)
      : ray(table.opticalOf(height_m), std::clamp(sinElevation, -1.0, 1.0), earthRadius_m) {
    for (const Level& level : table.levels_)
      if (const auto at = ray.crossings(level.optical_m)) crossed_m.push_back(at->first), crossed_m.push_back(at->second);
    if (table.refracts_) followPath(table);
    const auto within = ray.crossings(table.levels_.back().optical_m);
    begin_m = within ? std::max(within->first, 0.0) : 0.0;
    end_m = within ? std::min(within->second, onRay(range_m)) : 0.0;
  }
  bool isEmpty() const { return !(end_m > begin_m); }
  /// Length of path up to a place on the ray, and back.
  double onPath(double ray_m) const {
    if (knots_.empty()) return ray_m;
    const auto k = std::upper_bound(knots_.begin() + 1, knots_.end(), ray_m, [](double at, const Knot& n) { return at < n.ray_m; }) - 1;
    return k->path_m + (ray_m - k->ray_m) * k->stretch;
  }
  double onRay(double path_m) const {
    if (knots_.empty()) return path_m;
    const auto k = std::upper_bound(knots_.begin() + 1, knots_.end(), path_m, [](double at, const Knot& n) { return at < n.path_m; }) - 1;
    return k->ray_m + (path_m - k->path_m) / k->stretch;
  }

 private:
  struct Knot {
    double ray_m, path_m, stretch;  ///< behind it
  };
  std::vector<Knot> knots_;  ///< none: the path is the ray

  void followPath(const AbsorberTable& table) {
    std::vector<double> at = {0.0};
    for (double s : crossed_m)
      if (s > 0.0) at.push_back(s);
    std::sort(at.begin(), at.end());
    for (size_t i = 0; i < at.size(); ++i) {
      const double middle = table.heightOf(ray.heightAt(i + 1 < at.size() ? 0.5 * (at[i] + at[i + 1]) : at[i] + 1.0));
      const double path = knots_.empty() ? 0.0 : onPathOfLast(at[i]);
      knots_.push_back({at[i], path, middle > table.top_m() ? table.stretchAbove_ : table.stretchOf(table.intervalAt(middle))});
    }
  }
  double onPathOfLast(double ray_m) const { return knots_.back().path_m + (ray_m - knots_.back().ray_m) * knots_.back().stretch; }
};

size_t AbsorberTable::intervalAt(double height_m) const {
  const auto above = std::upper_bound(levels_.begin() + 1, levels_.end() - 1, height_m, [](double h, const Level& l) { return h < l.altitude_m; });
  return static_cast<size_t>(above - levels_.begin()) - 1;
}

double AbsorberTable::partOf(size_t interval, double height_m) const {
  const Level &low = levels_[interval], &high = levels_[interval + 1];
  return (std::max(height_m, kLowest_m) - low.altitude_m) / (high.altitude_m - low.altitude_m);
}

void AbsorberTable::addDensities(size_t interval, double part, double weight_km, AbsorberAmounts& sum, double half, double bend) const {
  const Level &low = levels_[interval], &high = levels_[interval + 1];
  const size_t count = absorbers_.size();
  std::array<double, kMostAbsorbers> fallen{};
  for (size_t k = 0; k < count; ++k) fallen[k] = std::isnan(low.logRatio[k]) ? 0.0 : low.logRatio[k] * part;
  exponentials(fallen.data(), static_cast<int>(count));
  for (size_t k = 0; k < count; ++k) {
    const double log = low.logRatio[k];
    const double density = std::isnan(log) ? std::max(low.density[k] + (high.density[k] - low.density[k]) * (part + bend / 3.0), 0.0)
                                           : low.density[k] * fallen[k] * meanExponential(log * half, log * bend);
    sum.amount_km[k] += weight_km * scale_[k] * density;
  }
}

AbsorberAmounts AbsorberTable::densities(double height_m) const {
  AbsorberAmounts sum;
  if (height_m > top_m()) return sum;
  const size_t interval = intervalAt(height_m);
  addDensities(interval, partOf(interval, height_m), 1.0, sum);
  return sum;
}

double AbsorberTable::temperature_K(double height_m) const {
  const double h = std::clamp(height_m, kLowest_m, top_m());
  const size_t i = intervalAt(h);
  return levels_[i].temperature_K + partOf(i, h) * (levels_[i + 1].temperature_K - levels_[i].temperature_K);
}

std::vector<double> AbsorberTable::placesOn(const Way& way, std::vector<double> cuts) const {
  const auto cut = [&](double s) { cuts.push_back(s); };
  cut(way.begin_m), cut(way.end_m), cut(way.ray.lowest_m());
  cuts.insert(cuts.end(), way.crossed_m.begin(), way.crossed_m.end());
  std::erase_if(cuts, [&](double s) { return !(s >= way.begin_m && s <= way.end_m); });
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

std::vector<PathStation> AbsorberTable::stationsOn(const Way& way, std::vector<double> cuts, int points) const {
  cuts = placesOn(way, std::move(cuts));
  const auto heightAt = [&](double s) { return heightOf(way.ray.heightAt(s)); };
  double height = heightAt(cuts.front());
  std::vector<PathStation> stations = {PathStation{cuts.front(), temperature_K(height), {}, height}};
  stations.reserve(cuts.size());
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double length = cuts[i + 1] - cuts[i], middle = heightAt(cuts[i] + 0.5 * length), before = height;
    const size_t interval = intervalAt(middle);
    const double path_km = 1e-3 * length * stretchOf(interval);
    height = heightAt(cuts[i + 1]);
    PathStation& next = stations.emplace_back(PathStation{cuts[i + 1], temperature_K(height), stations.back().amounts, height});
    const double first = partOf(interval, before), last = partOf(interval, height), at = partOf(interval, middle), half = 0.5 * (last - first),
                 bend = 0.5 * (first + last) - at;
    if (steepest_[interval] * std::abs(half) <= kShortStretch && steepest_[interval] * std::abs(bend) <= kStraight) {
      addDensities(interval, at, path_km, next.amounts, half, bend);
      continue;
    }
    for (const QuadratureNode& node : unitGauss(points))
      addDensities(interval, partOf(interval, heightAt(cuts[i] + length * node.x)), path_km * node.weight, next.amounts);
  }
  return stations;
}

std::vector<double> AbsorberTable::closerNearBy(const Way& way, int count, std::span<const double> alsoAt_m) {
  std::vector<double> cuts;
  for (double s : alsoAt_m) cuts.push_back(way.onRay(s));
  for (int i = 1; i < count; ++i) {
    const double f = static_cast<double>(i) / count;
    cuts.push_back(way.begin_m + (way.end_m - way.begin_m) * f * f);
  }
  return cuts;
}

std::vector<PathStation> AbsorberTable::stations(double height_m, double sinElevation, double range_m, double earthRadius_m, int count,
                                                 std::span<const double> alsoAt_m) const {
  const Way way(*this, height_m, sinElevation, range_m, earthRadius_m);
  if (way.isEmpty()) return {PathStation{0.0, temperature_K(height_m), {}, height_m}};
  auto all = stationsOn(way, closerNearBy(way, count, alsoAt_m), kGaussPoints);
  for (PathStation& s : all) s.range_m = way.onPath(s.range_m);
  return all;
}

std::vector<double> AbsorberTable::placesAlong(double height_m, double sinElevation, double range_m, double earthRadius_m, int count) const {
  const Way way(*this, height_m, sinElevation, range_m, earthRadius_m);
  if (way.isEmpty()) return {0.0};
  std::vector<double> places = placesOn(way, closerNearBy(way, count, {}));
  for (double& s : places) s = std::min(way.onPath(s), range_m);
  return places;
}

std::vector<PathStation> AbsorberTable::stationsAt(double height_m, double sinElevation, std::span<const double> ranges_m, double earthRadius_m) const {
  const Way way(*this, height_m, sinElevation, ranges_m.empty() ? 0.0 : ranges_m.back(), earthRadius_m);
  if (way.isEmpty()) return std::vector<PathStation>(ranges_m.size(), PathStation{0.0, temperature_K(height_m), {}, height_m});
  std::vector<double> onRay;
  for (double r : ranges_m) onRay.push_back(way.onRay(r));
  const auto all = stationsOn(way, onRay, 3);
  std::vector<PathStation> stations;
  stations.reserve(ranges_m.size());
  size_t at = 0;
  for (size_t i = 0; i < ranges_m.size(); ++i) {
    while (at + 1 < all.size() && all[at + 1].range_m <= onRay[i]) ++at;
    stations.push_back(all[at]);
    stations.back().range_m = all[at].range_m == onRay[i] ? ranges_m[i] : way.onPath(all[at].range_m);
  }
  return stations;
}

AbsorberAmounts AbsorberTable::amounts(double height_m, double sinElevation, double range_m, double earthRadius_m) const {
  return stations(height_m, sinElevation, range_m, earthRadius_m, 0).back().amounts;
}

}  // namespace pitviper
