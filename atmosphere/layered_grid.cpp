#include "atmosphere/layered_grid.hpp"

#include <algorithm>
#include <cmath>

#include "sim/plan/budget.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/world/field_states.hpp"

namespace pitviper {
namespace {

/// Ranges lie evenly in their logarithm beyond this part of the farthest.
constexpr double kScale = 1e-3;
/// Ranges of places towards space [m].
constexpr double kFirstSky_m = 100.0, kLastSky_m = 2e6;
/// Steps towards space as a part of the range, for tables with kRanges ranges: at 1.6 um a black body of air halves within 12 K, some 2 km.
constexpr double kSkyStep = 0.08;
constexpr int kRanges = 97;
/// A view that sees more than was planned for may have so many times the rows; one that sees still more has as many as were planned, farther apart.
constexpr double kMostRows = 4.0;

/// Step of azimuths (of their cosine) within which views share tables, at an accuracy of 1 %.
constexpr double kSameAzimuth = 0.02;
/// Step between two heights whose tables are mixed, at 1 % [m]: in air that thins by e in a kilometre their mean is off by 1e-3. Near the ground, where the way
/// to the horizon changes with height, a part of the height and a little at most.
constexpr double kHeightStep_m = 64.0, kPartOfHeight = 0.25, kLowest_m = 2.0;
/// What a view sees is widened to whole steps of about this part of it.
constexpr double kWidened = 0.125;

/// The sine of the sun's elevation below which its light comes through about as much air as here.
constexpr double kLowestSun = 0.02;

glm::dvec3 axisOf(const View& v) { return v.localFromCamera * glm::dvec3(0, 0, -1); }

bool onFilm(const View& v, const glm::dvec3& direction) {
  const glm::dvec3 d = glm::transpose(v.localFromCamera) * direction;
  if (d.z >= 0.0) return false;
  const glm::dvec2 at = filmPosition(v, d);
  return at.x >= 0 && at.y >= 0 && at.x <= v.width && at.y <= v.height;
}

/// Calls visit(direction) for rays all over a view.
template <class Visit>
void overView(const View& v, const Visit& visit) {
  constexpr int kSteps = 16;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) visit(glm::normalize(v.localFromCamera * v.ray(v.width * i / double(kSteps), v.height * j / double(kSteps))));
}

/// Least and greatest sine of elevation in a view.
std::pair<double, double> elevationsIn(const View& v, const glm::dvec3& up) {
  double low = 1.0, high = -1.0;
  overView(v, [&](const glm::dvec3& d) {
    const double s = glm::dot(d, up);
    low = std::min(low, s);
    high = std::max(high, s);
  });
  if (onFilm(v, up)) high = 1.0;
  if (onFilm(v, -up)) low = -1.0;
  const double margin = 0.03 * (high - low) + 1e-4;  // between the places looked at
  return {std::max(low - margin, -1.0), std::min(high + margin, 1.0)};
}

/// The sun's horizontal part, and the azimuths to it in a view.
class Across {
 public:
  Across(const View& view, const glm::dvec3& up, const glm::dvec3& toSun) : view_(view), up_(up), level_(toSun - glm::dot(toSun, up) * up) {}
  /// Towards the sun's own azimuth.
  double most() const { return glm::length(level_); }
  double of(const glm::dvec3& direction) const {
    const glm::dvec3 a = direction - glm::dot(direction, up_) * up_;
    return glm::length(a) > 1e-6 ? glm::dot(glm::normalize(a), level_) : 0.0;
  }
  /// Least and greatest; all where the view sees the zenith or its opposite.
  std::pair<double, double> all() const {
    double low = most(), high = -most();
    for (double sign : {1.0, -1.0})
      if (onFilm(view_, sign * up_)) return {-most(), most()};
    overView(view_, [&](const glm::dvec3& d) {
      low = std::min(low, of(d));
      high = std::max(high, of(d));
    });
    // The sun's own azimuth, or its opposite, may lie between the places looked at.
    const double margin = 0.03 * (high - low) + 1e-6;
    return {std::max(low - margin, -most()), std::min(high + margin, most())};
  }

 private:
  const View& view_;
  glm::dvec3 up_, level_;
};

double powerOfTwoBelow(double v) { return std::exp2(std::floor(std::log2(v))); }

/// The middle of the step that a value lies in; without a step the value itself.
double snapped(double value, double step) { return step > 0.0 ? step * std::round(value / step) : value; }

/// Widens limits to whole steps.
std::pair<double, double> widened(double low, double high, double least, double most) {
  const double step = powerOfTwoBelow(std::max(kWidened * (high - low), 1e-9));
  return {std::clamp(step * std::floor(low / step), least, most), std::clamp(step * std::ceil(high / step), least, most)};
}

double farthestIn(const Simulation& simulation, const View& view, const WorldState& state) {
  double farthest = 1.0;
  for (size_t e = 0; e < state.entities.size(); ++e) {
    const Entity& entity = simulation.entities[e];
    farthest = std::max(farthest, glm::length(state.entities[e].position + state.entities[e].orientation * glm::dvec3(entity.boundingCentre) - view.position) +
                                      static_cast<double>(entity.boundingRadius_m));
  }
  for (size_t f = 0; f < simulation.fields.size(); ++f)
    if (const FieldState* field = fieldOf(state, f)) {
      const glm::dvec3 centre = field->origin + field->localFromField * (0.5 * (field->low + field->high));
      farthest = std::max(farthest, glm::length(centre - view.position) + 0.5 * glm::length(field->high - field->low));
    }
  for (const auto& light : state.lights) farthest = std::max(farthest, glm::length(light - view.position));
  const double radius = simulation.frame.earthRadius_m(), above = std::max(simulation.frame.height(view.position), 0.0);
  if (simulation.ground) farthest = std::max(farthest, std::sqrt(above * (2.0 * radius + above)));  // the ground as far as the horizon
  return farthest;
}

/// Step of the sine of the sun's elevation that changes what comes through the air, exp(-depth / sine), by no more than its share of the accuracy.
double sunStep(double accuracy, double depth, double sine) {
  return powerOfTwoBelow(budget::kSunSteps.of(accuracy) * std::max(sine, kLowestSun) / std::max(depth, 1.0));
}

}  // namespace

double spreadOf(double sine) { return std::copysign(std::sqrt(std::abs(sine)), sine); }

double AirGrid::sineAt(int elevation) const {
  const double x = std::clamp(first + places.step * elevation, -1.0, 1.0);
  return x * std::abs(x);
}

double AirGrid::acrossAt(int azimuth) const { return firstAcross + places.stepAcross * azimuth; }

double AirGrid::entriesPerLog() const { return (places.ranges - 1) / std::log1p(places.farthest_m / places.scale_m); }

std::vector<double> AirGrid::rangesFrom(double entry_m) const {
  std::vector<double> all;
  for (int r = 0; r < places.ranges; ++r) all.push_back(entry_m + places.scale_m * std::expm1(r / entriesPerLog()));
  // Beyond the scene, as far as space: the sky's emission needs places there, the table doesn't.
  const double step = 1.0 + kSkyStep * kRanges / places.ranges;
  for (double r = step * std::max(places.farthest_m, kFirstSky_m); r < kLastSky_m; r *= step) all.push_back(entry_m + r);
  all.push_back(physics::kFar);
  return all;
}

namespace {

double horizonFrom(double height_m, double earthRadius_m) {
  const double above = std::max(height_m, 0.0);
  return -std::sqrt(above * (2.0 * earthRadius_m + above)) / (earthRadius_m + above);
}

}  // namespace

double AirGrid::horizon(double earthRadius_m) const { return horizonFrom(places.height_m, earthRadius_m); }

double AirGrid::lowestHorizon(double earthRadius_m) const { return horizonFrom(places.highest_m, earthRadius_m); }

std::vector<double> depthsToSun(const Simulation& simulation, const Plan& plan) {
  const double sine = std::max(glm::dot(simulation.sun->toSun, simulation.frame.up(glm::dvec3(0.0))), kLowestSun);
  const AirAmounts way = simulation.air->powered(simulation.air->amounts({0.0, sine, simulation.frame.earthRadius_m()}, physics::kFar));
  std::vector<double> sum(plan.weight.size(), 0.0), all(plan.weight.size(), 0.0);
  for (size_t i = 0; i < plan.nodes.size(); ++i) {
    const double depth = Atmosphere::depthOf(plan.nodes[i].air, way), passed = std::exp(-depth) * plan.nodes[i].mean(simulation.sun->irradiance);
    for (size_t s = 0; s < sum.size(); ++s) {
      sum[s] += plan.weight[s][i] * passed * depth;
      all[s] += plan.weight[s][i] * passed;
    }
  }
  for (size_t s = 0; s < sum.size(); ++s) sum[s] = all[s] > 0.0 ? sum[s] / all[s] : 0.0;
  return sum;
}

namespace {

/// Heights that have tables: closer together near the ground, then evenly. Both sides of the ground are alike.
class HeightSteps {
 public:
  /// Mixing leaves an error that grows with the step's square.
  explicit HeightSteps(double share) : part_(std::sqrt(share) * kPartOfHeight), even_m_(std::sqrt(share) * kHeightStep_m) {}
  double stepOf(double height_m) const { return std::copysign(countTo(std::abs(height_m)), height_m); }
  double heightAt(double step) const {
    const double s = std::abs(step), turn = countTo(turn_m());
    return std::copysign(s <= turn ? kLowest_m * std::expm1(s * part_) : turn_m() + (s - turn) * even_m_, step);
  }

 private:
  double turn_m() const { return std::max(kHeightStep_m / kPartOfHeight - kLowest_m, 0.0); }
  double countTo(double above_m) const {
    const double low = std::min(above_m, turn_m());
    return std::log1p(low / kLowest_m) / part_ + (above_m - low) / even_m_;
  }
  double part_, even_m_;
};

/// Places from `first` on, `count` of them.
struct Lattice {
  double first, step;
  int count;
};

/// The places of a lattice that hold a range. Where `count` of them are to cover `over` the lattice stays where it is, so that a view that turns needs a few
/// new places only. One that sees much more than was planned for has as many, farther apart.
Lattice latticeOf(double low, double high, int count, double over) {
  const Lattice own{low, (high - low) / (count - 1), count};
  if (!(over > 0.0)) return own;
  const double step = over / (count - 1), from = std::floor(low / step), to = std::max(std::ceil(high / step), from + 1.0);
  if (to - from + 1.0 > kMostRows * count) return own;
  return {from * step, step, static_cast<int>(to - from) + 1};
}

/// The grid of a view but for its height.
AirGrid windowOf(const Simulation& simulation, const Plan& plan, const AirTableSize& size, const View& view, const WorldState& state) {
  const glm::dvec3 up = simulation.frame.up(view.position);
  const double share = size.same * plan.accuracy / kUsualAccuracy;
  AirGrid g;
  g.places.ranges = size.ranges;
  const auto seen = elevationsIn(view, up);
  std::tie(g.low, g.high) = widened(seen.first, seen.second, -1.0, 1.0);
  const Lattice rows = latticeOf(spreadOf(g.low), spreadOf(g.high), size.elevations, size.over);
  g.first = rows.first, g.places.step = rows.step, g.elevations = rows.count;
  g.places.farthest_m = std::exp2(0.5 * std::ceil(2.0 * std::log2(farthestIn(simulation, view, state))));
  g.places.scale_m = size.near_m > 0.0 ? std::min(size.near_m, kScale * g.places.farthest_m) : kScale * g.places.farthest_m;
  if (!plan.terms.scatteredSun) return g;
  const double sine = glm::dot(simulation.sun->toSun, up);
  g.places.sunSine = share > 0.0 ? snapped(sine, sunStep(size.same * plan.accuracy, size.sunDepth, sine)) : sine;
  const Across across(view, up, simulation.sun->toSun);
  const double most = std::sqrt(std::max(1.0 - g.places.sunSine * g.places.sunSine, 0.0));
  const auto [viewLow, viewHigh] = across.all();
  // No farther than towards the sun and away from it: beyond, scattering angles have no cosine.
  std::tie(g.viewLow, g.viewHigh) = widened(viewLow, viewHigh, -most, most);
  if (size.azimuths > 1) {
    const Lattice azimuths = latticeOf(g.viewLow, g.viewHigh, size.azimuths, size.across);
    g.firstAcross = azimuths.first, g.places.stepAcross = azimuths.step, g.azimuths = azimuths.count;
    return g;
  }
  g.firstAcross =
      std::clamp(share > 0.0 ? snapped(across.of(axisOf(view)), std::max(share * kSameAzimuth, size.across)) : across.of(axisOf(view)), -most, most);
  return g;
}

}  // namespace

std::pair<double, double> widthsOf(const Simulation& simulation, const View& view) {
  const glm::dvec3 up = simulation.frame.up(view.position);
  const auto [low, high] = elevationsIn(view, up);
  const auto [from, to] = simulation.sun ? Across(view, up, simulation.sun->toSun).all() : std::pair(0.0, 0.0);
  return {spreadOf(high) - spreadOf(low), to - from};
}

AirGrids airGrids(const Simulation& simulation, const Plan& plan, const AirTableSize& size, const View& view, const WorldState& state) {
  AirGrids grids;
  grids.below = grids.above = windowOf(simulation, plan, size, view, state);
  AirPlaces &below = grids.below.places, &above = grids.above.places;
  const double height = simulation.frame.height(view.position), share = size.same * plan.accuracy / kUsualAccuracy;
  if (!(share > 0.0)) {
    below.height_m = below.highest_m = above.height_m = above.highest_m = height;
    return grids;
  }
  const HeightSteps steps(share);
  const double at = steps.stepOf(height), low = std::floor(at);
  below.height_m = steps.heightAt(low);
  below.highest_m = above.height_m = steps.heightAt(low + 1.0);
  above.highest_m = steps.heightAt(low + 2.0);
  grids.share = std::clamp((height - below.height_m) / (above.height_m - below.height_m), 0.0, 1.0);
  return grids;
}

bool holds(const AirGrid& grid, const Simulation& simulation, const Plan& plan, const View& narrower, const WorldState& state) {
  const glm::dvec3 up = simulation.frame.up(narrower.position);
  const auto [low, high] = elevationsIn(narrower, up);
  if (low < grid.low || high > grid.high || farthestIn(simulation, narrower, state) > grid.places.farthest_m) return false;
  if (!plan.terms.scatteredSun) return true;
  const auto [acrossLow, acrossHigh] = Across(narrower, up, simulation.sun->toSun).all();
  const double most = std::sqrt(std::max(1.0 - grid.places.sunSine * grid.places.sunSine, 0.0));
  return std::max(acrossLow, -most) >= grid.viewLow && std::min(acrossHigh, most) <= grid.viewHigh;
}

}  // namespace pitviper
