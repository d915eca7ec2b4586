#include "scenarios/commands/dri_report.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/spot_detection.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

std::string metres(double range_m) {
  if (range_m == 0.0) return "nowhere";
  if (std::isinf(range_m)) return "beyond 1000 km";
  return range_m < 9995.0 ? print("%.4g m", range_m) : print("%.4g km", 1e-3 * range_m);
}

/// Of what a task needs at 50 %, for another probability.
double neededAt(Criterion criterion, double needed, double probability) {
  double low = 0.01, high = 100.0;  // of the ratio: probabilities from 1e-5 on, and as near to 1
  for (int k = 0; k < 60; ++k) {
    const double middle = std::sqrt(low * high);
    (probabilityOf(criterion, middle, 1.0) < probability ? low : high) = middle;
  }
  return high * needed;
}

/// Signal of the target's light on its pixel, in electrons: as a spot, at most that of a target that fills the pixel.
double spotSignal(const BenchSight& sight, const AcquiredTarget& target, double range_m, double transmittance, double share) {
  return sight.electrons_per_K * target.difference_K * transmittance * std::min(1.0, target.area_m2() / (range_m * range_m) / sight.pixel_sr * share);
}

/// Where a value that falls with range falls to `least`; as rangeOf().
double rangeWhere(const std::function<double(double)>& value, double least) {
  double low = 0.0, high = std::log(1e6);
  if (value(1.0) < least) return 0.0;
  if (value(1e6) >= least) return INFINITY;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (value(std::exp(middle)) >= least ? low : high) = middle;
  }
  return std::exp(low);
}

}  // namespace

DriReport driReport(const BenchResult& bench, const DriWish& wish, const Transmittance& air, const std::string& aboutAir) {
  const BenchSight& sight = bench.sight;
  const AcquiredTarget& t = wish.target;
  DriReport report;
  report.about = print("target %g m x %g m, %g K over %.4g K; ", t.width_m, t.height_m, t.difference_K, bench.temperature_K) + aboutAir;
  report.rangeHead = {"task", "needs, Johnson", "50 %", "90 %", "needs, TTP", "50 %", "90 %"};
  constexpr double kShown[] = {0.5, 0.9};
  double farthest = 0.0;
  for (std::size_t task = 0; task < kTasks.size(); ++task) {
    std::vector<std::string> row{kTasks[task]};
    for (const Criterion c : {Criterion::Johnson, Criterion::Ttp}) {
      row.push_back(print(c == Criterion::Johnson ? "%g cycles" : "V50 %g", neededFor(c)[task]));
      for (const double p : kShown) {
        const double range = rangeOf(sight.design, t, c, neededAt(c, neededFor(c)[task], p), air);
        row.push_back(metres(range));
        if (std::isfinite(range)) farthest = std::max(farthest, range);
      }
    }
    report.ranges.push_back(row);
  }
  const double threshold = thresholdForRate(wish.alarms_per_hour, sight.pixels_per_s);
  const auto tnr = [&](double range, double share) { return spotSignal(sight, t, range, air(range), share) / sight.noise_electrons; };
  const auto inMiddle = [&](double range) { return tnr(range, sight.shareInMiddle); };
  const auto inCorner = [&](double range) { return tnr(range, sight.shareInCorner); };
  report.aboutSpot = print(
      "as a spot (%.3g and %.3g of its light on one pixel, in its middle and in its corner): a threshold of %.3g sigma for %g false alarm(s) an hour over the "
      "film (%.3g where video is compared as it comes, by Rice); found in a frame with 50 %% as far as %s and %s, with 90 %% as far as %s and %s",
      sight.shareInMiddle, sight.shareInCorner, threshold, wish.alarms_per_hour, thresholdByCrossings(wish.alarms_per_hour, sight.pixels_per_s),
      metres(rangeWhere(inMiddle, threshold)).c_str(), metres(rangeWhere(inCorner, threshold)).c_str(),
      metres(rangeWhere(inMiddle, tnrFor(0.9, threshold))).c_str(), metres(rangeWhere(inCorner, tnrFor(0.9, threshold))).c_str());
  report.spotHead = {"range", "transmittance", "pixels across", "TNR, middle", "detected", "TNR, corner", "detected"};
  for (const double range : {500.0, 1e3, 2e3, 5e3, 1e4, 2e4, 5e4}) {
    const double a = inMiddle(range), b = inCorner(range);
    report.spots.push_back({metres(range), print("%.4g", air(range)), print("%.3g", std::sqrt(t.area_m2() / sight.pixel_sr) / range), print("%.4g", a),
                            print("%.3g %%", 100.0 * detection(a, threshold)), print("%.4g", b), print("%.3g %%", 100.0 * detection(b, threshold))});
  }
  const double end = farthest > 0.0 ? 1.3 * farthest : 2e4;
  constexpr int kPoints = 80;
  Chart acquired{"Probability of tasks", "range [km]", "probability", false, false, true, {}, {}, {}};
  for (const Criterion c : {Criterion::Johnson, Criterion::Ttp})
    for (std::size_t task = 0; task < kTasks.size(); ++task) {
      Series s{std::string(kTasks[task]) + (c == Criterion::Johnson ? ", Johnson" : ", TTP"), {}, {}, c == Criterion::Ttp, false};
      for (int k = 1; k <= kPoints; ++k) {
        const double range = end * k / kPoints;
        s.x.push_back(1e-3 * range), s.y.push_back(probabilityOf(c, seenOf(sight.design, t, c, range, air(range)), neededFor(c)[task]));
      }
      acquired.series.push_back(s);
    }
  Series passed{"", {}, {}, false, false}, middle{"in a pixel's middle", {}, {}, false, false}, corner{"in a corner", {}, {}, true, false};
  Series foundMiddle = middle, foundCorner = corner;
  const double spotEnd = std::min(1e6, 1.3 * std::max(1.0, rangeWhere(inMiddle, 1.0)));
  for (int k = 1; k <= kPoints; ++k) {
    const double range = end * k / kPoints, spot = spotEnd * k / kPoints, a = inMiddle(spot), b = inCorner(spot);
    passed.x.push_back(1e-3 * range), passed.y.push_back(air(range));
    middle.x.push_back(1e-3 * spot), middle.y.push_back(a), corner.x.push_back(1e-3 * spot), corner.y.push_back(b);
    foundMiddle.x.push_back(1e-3 * spot), foundMiddle.y.push_back(detection(a, threshold)), foundCorner.x.push_back(1e-3 * spot),
        foundCorner.y.push_back(detection(b, threshold));
  }
  report.charts = {acquired,
                   {"Transmittance of the band", "range [km]", "mean of dB/dT", false, false, true, {passed}, {}, {}},
                   {"TNR of a spot", "range [km]", "signal over noise", false, true, false, {middle, corner}, {}, {}},
                   {"Detection of a spot", "range [km]", "probability in a frame", false, false, true, {foundMiddle, foundCorner}, {}, {}}};
  return report;
}

}  // namespace pitviper
