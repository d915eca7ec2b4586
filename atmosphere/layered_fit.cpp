#include "atmosphere/layered_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/parameters/on_threads.hpp"
#include "sim/plan/budget.hpp"
#include "sim/plan/sights.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/world/ground.hpp"

namespace pitviper {
namespace {

/// Lines looked at, besides the film's corners and edges: of the film, and half as many of the extremes; where nodes are many, each costs as much as they do.
constexpr size_t kFilm = 64, kFewest = 8;
constexpr int kFewNodes = 24;
/// Sizes to begin with and to end at.
constexpr AirTableSize kLeast{17, 49, 1}, kMost{257, 385, 17};
/// No more values than this (200 MB): what smaller tables lose then is said, not mended.
constexpr double kMostValues = 5e7;
/// Ranges lie evenly up to this part of the nearest thing's.
constexpr double kNear = 0.3;
/// Air that lets less through than this hides all that is behind it [kernel unit x um].
constexpr double kOpaque = 1e-9;
/// Steps of heights and suns become no smaller than this part of the usual ones.
constexpr double kSame = 1.0 / 1024.0;
/// Sizes tried.
constexpr int kTries = 6;
/// How much finer than a table's ranges the air is looked at to tell what is lost by adding it up over these.
constexpr int kFiner = 4;

/// What a pixel has of an entry, per slot.
struct Seen {
  std::vector<double> air, passed;
};

/// Works out entries as the shader does in direct mode (atmosphere/layered.glsl), in double precision.
class Reader {
 public:
  /// `shells`: what the line has of them, in closed form.
  Reader(const Simulation& simulation, const Plan& plan, const AirRows& rows, double cosScatter, const AirAmounts& shells)
      : plan_(plan), rows_(rows), powers_(simulation.air->exponents()), cosScatter_(cosScatter), shells_(shells), black_(rows.black()) {}
  /// Of rows of two heights, mixed.
  Reader(const Simulation& simulation, const Plan& plan, const AirRows& rows, const AirRows& others, double share, double cosScatter, const AirAmounts& shells)
      : Reader(simulation, plan, rows, cosScatter, shells) {
    for (size_t i = 0; i < black_.size(); ++i) black_[i] += share * (others.black()[i] - black_[i]);
  }

  /// Between two entries, a share of the way to the second. `length_m`: of the air before it.
  Seen between(const AirRow& a, size_t columnA, const AirRow& b, size_t columnB, double length_m, double share = 0.5) const {
    const size_t slots = plan_.weight.size(), logs = static_cast<size_t>(4 * rows_.vectors()), values = static_cast<size_t>(rows_.values());
    const double logLength = length_m >= physics::kFar ? 0.0 : std::log(1e-3 * length_m);
    const auto mixed = [share](const std::vector<float>& x, size_t i, const std::vector<float>& y, size_t j) {
      return (1.0 - share) * static_cast<double>(x[i]) + share * static_cast<double>(y[j]);
    };
    std::array<double, kMostAirAmounts> u{};
    for (size_t k = 0; k < powers_.size(); ++k)
      u[k] = std::exp((mixed(a.amounts, columnA * logs + k, b.amounts, columnB * logs + k) + logLength) * powers_[k]) + shells_.amount[k];
    Seen seen{std::vector<double>(slots, 0.0), std::vector<double>(slots, 0.0)};
    for (size_t i = 0; i < plan_.nodes.size(); ++i) {
      double depth = 0.0;
      for (size_t k = 0; k < powers_.size(); ++k) depth += plan_.nodes[i].air.extinction[k] * u[k];
      const double tau = std::exp(-depth), black = black_[i] * physics::oneMinusExp(depth);
      for (size_t s = 0; s < slots; ++s) {
        seen.air[s] += plan_.weight[s][i] * black;
        seen.passed[s] += plan_.weight[s][i] * tau;
      }
    }
    const auto parts = static_cast<size_t>(rows_.parts());
    for (size_t s = 0; s < slots; ++s) {
      const auto part = [&](size_t p) { return mixed(a.radiance, (columnA * parts + p) * values + s, b.radiance, (columnB * parts + p) * values + s); };
      seen.air[s] += part(0);
      if (parts > 1)
        seen.air[s] += physics::rayleighPhase(cosScatter_) * part(1) + physics::henyeyGreensteinPhase(cosScatter_, rows_.asymmetries()[s]) * part(2);
      if (parts > 3) seen.air[s] += hazeAgainPhase(cosScatter_, rows_.asymmetries()[s]) * part(3);
    }
    return seen;
  }
  Seen at(const AirRow& row, size_t column, double length_m) const { return between(row, column, row, column, length_m); }

 private:
  const Plan& plan_;
  const AirRows& rows_;
  std::span<const double> powers_;
  double cosScatter_;
  AirAmounts shells_;
  std::vector<double> black_;
};

/// The ranges that lie before the first of some ends, and then these ends.
std::vector<double> upTo(std::vector<double> ranges, std::initializer_list<double> ends) {
  std::erase_if(ranges, [&](double r) { return r >= *ends.begin(); });
  ranges.insert(ranges.end(), ends);
  return ranges;
}

double largestOf(const std::vector<double>& all) { return all.empty() ? 0.0 : *std::max_element(all.begin(), all.end()); }

/// As many entries as bring an error to its share: each time steps are halved a quarter of it is left.
int finer(int entries, double error, double share, int most) {
  if (!(error > share)) return entries;
  const int doublings = static_cast<int>(std::clamp(std::ceil(0.5 * std::log2(error / share)), 1.0, 8.0));
  return std::min(((std::max(entries, 2) - 1) << doublings) + 1, most);
}

/// The size of tables where no accuracy is asked for, and of a probe.
constexpr AirTableSize kUsualSize{129, 193, 5};
/// The loss predicted is what tables lose on the lines that their size was chosen on, times this.
constexpr double kTableMargin = 2.0;
/// Beside that, what the tables of ways from lit surfaces to the sun lose, per unit of their depth and of the share of that light: 6e-4 of a pixel on the
/// ground at a depth of 8 (fog, visibility 0.7 km; found on the GPU against double precision).
constexpr double kSunWay = 1e-4;

/// A line of sight as a grid's tables have it.
struct TabledLine {
  const AirGrid& grid;
  const AirRows& rows;  ///< of the grid
  AirLine line;
  double end_m;     ///< physics::kFar: towards space
  double length_m;  ///< of the air on it
};

/// What tables lose on a line of sight, relative to the pixel: found beside what is right.
class LineLoss {
 public:
  LineLoss(const Simulation& simulation, const Plan& plan, const TabledLine& own, const std::vector<double>& radiance, const std::vector<double>& floor)
      : simulation_(simulation),
        plan_(plan),
        own_(own),
        radiance_(radiance),
        floor_(floor),
        shells_(shellsOf(simulation, own)),
        reader_(simulation, plan, own.rows, own.rows.cosScatterOf(own.line), shells_),
        stations_(own.rows.stationsOf(own.line)),
        ranges_(upTo(stations_, {own.end_m})),
        right_(reader_.at(own.rows.at(own.line, ranges_), ranges_.size() - 1, own.length_m)) {}

  /// What is lost as views share tables: mixed for the height and the sun of the tables, where the line has its own.
  void ofSharing(const AirGrids& tables, const AirGrid& exact, const AirRows& any, std::vector<double>& into) const {
    AirRows right = any, below = any, above = any;
    right.begin(exact), below.begin(tables.below), above.begin(tables.above);
    const auto rangesOf = [&](const AirRows& rows) {
      const auto all = rows.stationsOf(own_.line);
      return upTo(all, {own_.length_m >= physics::kFar ? physics::kFar : all.front() + own_.length_m});
    };
    const auto here = rangesOf(right), low = rangesOf(below), high = rangesOf(above);
    const double cosScatter = right.cosScatterOf(own_.line);
    note(into,
         Reader(simulation_, plan_, below, above, tables.share, cosScatter, shells_)
             .between(below.at(own_.line, low), low.size() - 1, above.at(own_.line, high), high.size() - 1, own_.length_m, tables.share),
         Reader(simulation_, plan_, right, cosScatter, shells_).at(right.at(own_.line, here), here.size() - 1, own_.length_m));
  }

  /// What is lost between two elevations, a half step below and above the line's own.
  void ofElevations(std::vector<double>& into) const {
    const AirGrid& grid = own_.grid;
    const double horizon = grid.horizon(simulation_.frame.earthRadius_m());
    const double half = 0.5 * grid.places.step, x = spreadOf(own_.line.sine);
    const auto beside = [&](double spread) {
      const double clamped = std::clamp(spread, -1.0, 1.0);
      return AirLine{clamped * std::abs(clamped), own_.line.across, false};
    };
    AirLine below = beside(x - half);
    const AirLine above = beside(x + half);
    below.meetsHorizon = simulation_.ground && below.sine < horizon && above.sine >= horizon;
    // A line to space starts where its own air does.
    const auto rangesOf = [&](const AirLine& l) {
      const auto all = own_.rows.stationsOf(l);
      return upTo(all, {own_.length_m >= physics::kFar ? physics::kFar : all.front() + own_.length_m});
    };
    const auto rangesBelow = rangesOf(below), rangesAbove = rangesOf(above);
    note(into,
         reader_.between(own_.rows.at(below, rangesBelow), rangesBelow.size() - 1, own_.rows.at(above, rangesAbove), rangesAbove.size() - 1, own_.length_m),
         right_);
  }

  /// What is lost between two ranges, and by adding air up in as wide steps.
  void ofRanges(std::vector<double>& into) const {
    const AirGrid& grid = own_.grid;
    const double entry = stations_.front();
    if (own_.length_m < physics::kFar) {
      const double entryAt = std::log1p(own_.length_m / grid.places.scale_m) * grid.entriesPerLog();
      const auto rangeAt = [&](double t) { return entry + grid.places.scale_m * std::expm1(t / grid.entriesPerLog()); };
      // Nothing is nearer than the first entry, which stands at the eye.
      const double share = std::min(0.5, entryAt), before = rangeAt(entryAt - share), after = rangeAt(entryAt - share + 1.0);
      const auto three = upTo(stations_, {before, own_.end_m, after});
      const AirRow row = own_.rows.at(own_.line, three);
      const size_t n = three.size();
      if (after > own_.end_m && own_.end_m > before)
        note(into, reader_.between(row, n - 3, row, n - 1, own_.length_m, share), reader_.at(row, n - 2, own_.length_m));
    }
    AirGrid fine = grid;
    fine.places.ranges = kFiner * (grid.places.ranges - 1) + 1;
    const auto fineRanges = upTo(fine.rangesFrom(entry), {own_.end_m});
    note(into, right_, reader_.at(own_.rows.at(own_.line, fineRanges), fineRanges.size() - 1, own_.length_m));
  }

  /// What is lost between two azimuths, a half step to each side, or by having one for the whole view.
  void ofAzimuths(std::vector<double>& into) const {
    const AirGrid& grid = own_.grid;
    const size_t last = ranges_.size() - 1;
    const auto turned = [&](double across) { return own_.rows.at({own_.line.sine, across, false}, ranges_); };
    if (grid.azimuths == 1) return note(into, reader_.at(turned(grid.firstAcross), last, own_.length_m), right_);
    const double step = 0.5 * grid.places.stepAcross, most = std::sqrt(std::max(1.0 - grid.places.sunSine * grid.places.sunSine, 0.0));
    const double middle = std::clamp(own_.line.across, std::min(step - most, 0.0), std::max(most - step, 0.0));
    note(into, reader_.between(turned(std::max(middle - step, -most)), last, turned(std::min(middle + step, most)), last, own_.length_m),
         reader_.at(turned(middle), last, own_.length_m));
  }

 private:
  static AirAmounts shellsOf(const Simulation& simulation, const TabledLine& own) {
    AirAmounts all;
    addShells(*simulation.air, {own.grid.places.height_m, own.line.sine, simulation.frame.earthRadius_m()}, own.end_m, all);
    return all;
  }
  void note(std::vector<double>& into, const Seen& found, const Seen& than) const {
    for (size_t s = 0; s < floor_.size(); ++s) {
      const double behind = right_.passed[s] > kOpaque ? std::max(radiance_[s] - right_.air[s], 0.0) / right_.passed[s] : 0.0;
      const double all = std::max(std::max(radiance_[s], right_.air[s]), floor_[s]);
      if (all > 0.0) into[s] += std::abs(found.air[s] - than.air[s] + behind * (found.passed[s] - than.passed[s])) / all;
    }
  }
  const Simulation& simulation_;
  const Plan& plan_;
  TabledLine own_;
  const std::vector<double>&radiance_, &floor_;
  AirAmounts shells_;
  Reader reader_;
  std::vector<double> stations_, ranges_;
  Seen right_;
};

}  // namespace

AirTableSize affordable(AirTableSize size, const Simulation& simulation, const Plan& plan) {
  const bool perNode = simulation.hasTransparent() || simulation.mode == RenderMode::Buffered;
  const double each = (plan.terms.scatteredSun ? 4.0 : 1.0) * (perNode ? plan.nodeCount() : 4 * plan.groupCount());
  while (each * size.elevations * (size.ranges + 1) * size.azimuths > kMostValues && size.elevations > kLeast.elevations) {
    int& most = size.azimuths > 5 ? size.azimuths : size.ranges > 97 && size.ranges > size.elevations ? size.ranges : size.elevations;
    most = (most - 1) / 2 + 1;
  }
  return size;
}

AirTableFit::AirTableFit(const Simulation& simulation, const Camera& camera, const NodesOfPlan& plan, SightRays& rays, const std::vector<double>& floor)
    : simulation_(simulation), camera_(camera), plan_(plan.plan), rows_(simulation, plan.plan, true), floor_(floor) {
  std::vector<SightRay> lines;
  const auto& extremes = rays.extremes();
  const size_t film = std::max(kFilm * kFewNodes / static_cast<size_t>(std::max(plan_.nodeCount(), kFewNodes)), kFewest),
               some = std::min(film / 2, extremes.size());
  for (size_t n = 0; n < some; ++n) lines.push_back(extremes[n * extremes.size() / some]);
  for (size_t n = 0; n < film; ++n) lines.push_back(rays.fromFilm());
  // The film's edges, where azimuths and elevations are farthest from its middle.
  const Pinhole& p = camera.pinhole;
  for (int frame : film < kFilm / 2 ? std::vector{simulation.time.frames / 2} : std::vector{0, simulation.time.frames / 2, simulation.time.frames - 1})
    for (double row : {0.5, 0.5 * p.height, p.height - 0.5})
      for (double column : {0.5, 0.5 * p.width, p.width - 0.5}) lines.push_back(rays.through({frame, column, row}));
  NodeSum sum(plan.spectra);
  const auto add = [&](const SightRay& ray, double range_m) {
    sum.begin();
    radianceAlong({simulation, plan_.terms, plan_.sunLegs.get(), *ray.state, {}, kUsualPlaces}, ray.line, sum);
    Sample sample{ray.state, ray.line.origin, ray.line.direction, range_m, std::vector<double>(floor_.size(), 0.0)};
    for (size_t s = 0; s < floor_.size(); ++s)
      for (size_t i = 0; i < plan_.nodes.size(); ++i) sample.radiance[s] += plan_.weight[s][i] * sum.radiance()[i];
    if (range_m > 0.0) nearest_m_ = std::min(nearest_m_, range_m);
    samples_.push_back(std::move(sample));
  };
  for (SightRay& ray : lines) {
    RayHits& hits = ray.line.hits;
    // The air before the first thing that stands in it may be all that is seen; what lies behind is looked at as if nothing stood there.
    double first = INFINITY;
    for (const Hit& h : hits.layers) first = std::min(first, h.distance);
    for (const Stretch& s : hits.stretches)
      if (s.enter > 0.0) first = std::min(first, s.enter);
    if (first < INFINITY) add(ray, first);
    hits.layers.clear();
    hits.stretches.clear();
    const auto ground = hits.solid.entity >= 0 ? std::nullopt : groundHit(simulation, ray.line.origin, ray.line.direction);
    add(ray, ground ? ground->distance : hits.solid.entity >= 0 ? hits.solid.distance : physics::kFar);
  }
}

View AirTableFit::viewOf(const Sample& sample) const {
  View view = cameraView(camera_, *sample.state, camera_.samples);
  view.position = sample.origin;  // limits move the eye
  return view;
}

AirTableFit::Lost AirTableFit::lostOn(const Sample& sample, const AirTableSize& size) const {
  const std::vector<double> none(floor_.size(), 0.0);
  Lost lost{none, none, none, none};
  const View view = viewOf(sample);
  const AirGrids tables = airGrids(simulation_, plan_, size, view, *sample.state);
  AirGrid grid = tables.below;
  grid.places.height_m = grid.places.highest_m = simulation_.frame.height(view.position);
  AirRows rows = rows_;
  rows.begin(grid);
  const glm::dvec3 up = simulation_.frame.up(view.position);
  AirLine line{glm::dot(sample.direction, up), 0.0, false};
  if (plan_.terms.scatteredSun) {
    const glm::dvec3 level = sample.direction - line.sine * up, sun = simulation_.sun->toSun - glm::dot(simulation_.sun->toSun, up) * up;
    if (glm::length(level) > 1e-6) line.across = std::clamp(glm::dot(glm::normalize(level), sun), grid.viewLow, grid.viewHigh);
  }
  const double length = sample.range_m >= physics::kFar ? physics::kFar : sample.range_m - rows.stationsOf(line).front();
  if (!(length > 0.0)) return lost;
  const LineLoss own(simulation_, plan_, {grid, rows, line, sample.range_m, length}, sample.radiance, floor_);
  AirGrid exact = grid;
  if (plan_.terms.scatteredSun) exact.places.sunSine = glm::dot(simulation_.sun->toSun, up);
  own.ofSharing(tables, exact, rows_, lost.shared);
  own.ofElevations(lost.elevation);
  own.ofRanges(lost.range);
  if (plan_.terms.scatteredSun) own.ofAzimuths(lost.azimuth);
  return lost;
}

AirTableLoss AirTableFit::lossOf(const AirTableSize& size) const {
  const size_t slots = floor_.size();
  std::vector<Lost> lost(samples_.size());
  onAllThreads(samples_.size(), [&](const auto& next) {
    for (size_t n = next(); n < samples_.size(); n = next()) lost[n] = lostOn(samples_[n], size);
  });
  const std::vector<double> none(slots, 0.0);
  AirTableLoss loss{none, none, none, none, none};
  for (const Lost& l : lost)
    for (size_t s = 0; s < slots; ++s) {
      loss.elevations[s] = std::max(loss.elevations[s], l.elevation[s]);
      loss.ranges[s] = std::max(loss.ranges[s], l.range[s]);
      loss.azimuths[s] = std::max(loss.azimuths[s], l.azimuth[s]);
      loss.shared[s] = std::max(loss.shared[s], l.shared[s]);
      loss.sums[s] = std::max(loss.sums[s], l.elevation[s] + l.range[s] + l.azimuth[s] + l.shared[s]);
    }
  return loss;
}

std::pair<AirTableSize, AirTableLoss> AirTableFit::within(double accuracy) const {
  const double share = budget::kTableSteps.of(accuracy);
  AirTableSize size = kLeast;
  size.sunDepth = plan_.air.sunDepth;
  for (const Sample& s : samples_) {
    const auto [over, across] = widthsOf(simulation_, viewOf(s));
    size.over = std::max(size.over, over), size.across = std::max(size.across, across);
  }
  if (nearest_m_ < physics::kFar) size.near_m = kNear * nearest_m_;
  AirTableLoss loss = lossOf(size);
  for (int tries = 1; tries < kTries; ++tries) {
    AirTableSize next{finer(size.elevations, largestOf(loss.elevations), share, kMost.elevations),
                      finer(size.ranges, largestOf(loss.ranges), share, kMost.ranges),
                      finer(size.azimuths, largestOf(loss.azimuths), budget::kAzimuthSteps.of(accuracy), kMost.azimuths),
                      size.over,
                      size.across,
                      size.near_m,
                      size.same,
                      size.sunDepth};
    if (const double shared = largestOf(loss.shared); shared > share) next.same = std::max(size.same * std::exp2(std::floor(std::log2(share / shared))), kSame);
    next = affordable(next, simulation_, plan_);
    if (next == size) break;
    size = next;
    loss = lossOf(size);
  }
  return {size, loss};
}

std::vector<double> planLayeredTables(const AirTableRequest& r) {
  Plan& plan = r.plan;
  const double accuracy = plan.accuracy > 0.0 ? plan.accuracy : kUsualAccuracy;
  plan.air = affordable(kUsualSize, r.simulation, plan);
  if (!r.rays || !r.camera) return std::vector<double>(plan.weight.size(), budget::kProbeTables.of(accuracy));
  const std::vector<double> toSun = r.simulation.sun ? depthsToSun(r.simulation, plan) : std::vector<double>();
  if (!toSun.empty()) plan.air.sunDepth = *std::max_element(toSun.begin(), toSun.end());
  const NodesOfPlan nodes(r.simulation, plan);
  auto [size, loss] = AirTableFit(r.simulation, *r.camera, nodes, *r.rays, *r.floor).within(accuracy);
  plan.air = size;
  for (size_t s = 0; s < loss.sums.size(); ++s) {
    double& l = loss.sums[s];
    l *= kTableMargin;
    if (toSun.empty()) continue;
    const size_t sun = static_cast<size_t>(TermKind::Sun);
    l += kSunWay * toSun[s] * (sun < plan.shares.size() && s < plan.shares[sun].share.size() ? std::min(plan.shares[sun].share[s], 1.0) : 1.0);
  }
  return loss.sums;
}

}  // namespace pitviper
