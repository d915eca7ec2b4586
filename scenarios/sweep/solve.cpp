#include "scenarios/sweep/solve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "scenarios/sweep/student.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr int kSolveFewestRepeats = 4, kSolveMostRepeats = 100000;
/// Of telling a side, and of the interval.
constexpr double kSolveDoubt = 0.05;
/// Of finding three means off a line that lie on one.
constexpr double kSolveBentDoubt = 0.01;
/// The last three places are moved where the crossing lies so many of their steps from the middle; so often at most.
constexpr double kSolveFarSteps = 1.5;
constexpr int kSolveMostMoves = 3;
/// Draws at each of the last two places of a measure that seems to have no noise and few values: of one that is either as often, 1 in 1000 is missed.
constexpr int kSolveCommonDraws = 6;

/// All draws at one place.
struct SolvePlace {
  double at = 0.0;  ///< 0 to 1 over the range
  std::vector<double> values;

  int count() const { return static_cast<int>(values.size()); }
  double mean() const {
    double sum = 0.0;
    for (const double v : values) sum += v / count();
    return sum;
  }
  /// Sum of squares about the mean.
  double squares() const {
    double sum = 0.0;
    for (const double v : values) sum += (v - mean()) * (v - mean());
    return sum;
  }
  double variance() const { return count() > 1 ? squares() / (count() - 1) : 0.0; }
  double standardError() const { return std::sqrt(variance() / count()); }
};

enum class SolveSide { Below = -1, Unknown = 0, Above = 1 };

void checkSolveWish(const SolveWish& w) {
  const auto refuse = [&](const std::string& wrong, const std::string& expected, const std::string& fix) { throw UserError(w.where, wrong, expected, fix); };
  if (!std::isfinite(w.target)) refuse(print("a target of %g", w.target), "a number", "write one");
  if (!(std::isfinite(w.low) && std::isfinite(w.high) && w.low < w.high))
    refuse(print("%s from %g to %g", w.factor.c_str(), w.low, w.high), "a range whose ends rise", "write the lower end first");
  if (w.logarithmic && !(w.low > 0.0))
    refuse(print("%s from %g on by ratios", w.factor.c_str(), w.low), "ends above 0", "begin above 0, or divide the range evenly");
  if (!(w.repeats >= kSolveFewestRepeats && w.repeats <= kSolveMostRepeats))
    refuse(print("%d repeats", w.repeats), print("%d to %d", kSolveFewestRepeats, kSolveMostRepeats), "fewer do not tell noise from what is measured");
  if (!(w.tolerance > 0.0 && w.tolerance < 1.0)) refuse(print("a tolerance of %g", w.tolerance), "a part of the range, above 0 and below 1", "write 0.001");
}

class SolveSearch {
 public:
  SolveSearch(const SeededMeasure& measure, const SolveWish& wish) : measure_(measure), wish_(wish), seeds_(wish.seed) {
    int looks = 0;
    for (int n = kSolveFewestRepeats; n < wish.repeats; n *= 2) ++looks;
    sure_ = 1.0 - 0.5 * kSolveDoubt / (looks + 1);
  }

  Solution run() {
    SolvePlace low{0.0, {}}, high{1.0, {}};
    for (SolvePlace* end : {&low, &high}) draw(*end), draw(*end);
    result_.isNoisy = low.variance() > 0.0 || high.variance() > 0.0;
    if (!result_.isNoisy) {
      keep(low), keep(high);
      if (quiet(low, high)) return std::move(result_);
      result_.isNoisy = true;
    }
    noisy(std::move(low), std::move(high));
    return std::move(result_);
  }

 private:
  double xAt(double at) const {
    if (at <= 0.0) return wish_.low;
    if (at >= 1.0) return wish_.high;
    return wish_.logarithmic ? wish_.low * std::pow(wish_.high / wish_.low, at) : wish_.low + (wish_.high - wish_.low) * at;
  }

  void draw(SolvePlace& place) {
    const double x = xAt(place.at), value = measure_(x, seeds_());
    ++result_.evaluations;
    if (!std::isfinite(value))
      throw UserError(wish_.where, print("%s is %g at %s = %g", wish_.measure.c_str(), value, wish_.factor.c_str(), x), "a number all over the range",
                      "choose a range in which all pictures have this measure");
    place.values.push_back(value);
  }

  void keep(const SolvePlace& place) { result_.tried.push_back({xAt(place.at), place.mean(), place.standardError(), place.count()}); }

  SolveSide sideOf(double value) const { return value > wish_.target ? SolveSide::Above : value < wish_.target ? SolveSide::Below : SolveSide::Unknown; }

  /// Draws until it is known, or as often as may be.
  SolveSide told(SolvePlace& place) {
    for (int wanted = kSolveFewestRepeats;; wanted = std::min(2 * wanted, wish_.repeats)) {
      while (place.count() < wanted) draw(place);
      const int own = place.count() - 1;
      // Draws that are alike by chance have the noise of the others.
      const bool alike = !(place.variance() > 0.0) && degrees_ > 0;
      const double variance = alike ? squares_ / degrees_ : place.variance(), away = std::abs(place.mean() - wish_.target);
      const bool known = away > studentQuantile(sure_, alike ? degrees_ : own) * std::sqrt(variance / place.count());
      if (!known && wanted < wish_.repeats) continue;
      squares_ += place.squares(), degrees_ += own;
      keep(place);
      return known ? sideOf(place.mean()) : SolveSide::Unknown;
    }
  }

  std::string described(const SolvePlace& place) const {
    return print("%g%s at %s = %g", place.mean(), place.variance() > 0.0 ? print(" +- %.2g", place.standardError()).c_str() : "", wish_.factor.c_str(),
                 xAt(place.at));
  }

  /// The side of the lower end; the other has the other. Errors: UserError where the range does not hold the crossing.
  SolveSide sideOfLow(const SolvePlace& low, const SolvePlace& high) const {
    const SolveSide first = sideOf(low.mean()), last = sideOf(high.mean());
    if (first == last)
      throw UserError(wish_.where,
                      wish_.measure + " is " + described(low) + " and " + described(high) +
                          print(", both %s the %g asked for",
                                first == SolveSide::Above   ? "above"
                                : first == SolveSide::Below ? "below"
                                                            : "at",
                                wish_.target),
                      "a range over which it crosses that value", "widen the range, or ask for a value between these two");
    if (first != SolveSide::Unknown) return first;
    return last == SolveSide::Above ? SolveSide::Below : SolveSide::Above;
  }

  double between(const SolvePlace& low, const SolvePlace& high) const {
    const double share = (wish_.target - low.mean()) / (high.mean() - low.mean());
    return low.at + std::clamp(share, 0.0, 1.0) * (high.at - low.at);
  }

  void answer(double at, double low, double high) { result_.x = xAt(std::clamp(at, 0.0, 1.0)), result_.low95 = xAt(low), result_.high95 = xAt(high); }

  /// One draw a place. False: there is noise after all.
  bool quiet(SolvePlace low, SolvePlace high) {
    const auto isMet = [&](const SolvePlace& place) {
      if (sideOf(place.mean()) != SolveSide::Unknown) return false;
      answer(place.at, place.at, place.at);
      return true;
    };
    if (isMet(low) || isMet(high)) return true;
    const SolveSide first = sideOfLow(low, high);
    while (high.at - low.at > wish_.tolerance) {
      SolvePlace middle{0.5 * (low.at + high.at), {}};
      draw(middle);
      keep(middle);
      if (isMet(middle)) return true;
      (sideOf(middle.mean()) == first ? low : high) = middle;
    }
    for (SolvePlace* end : {&low, &high}) {
      // Equal draws of a measure that has the same value elsewhere too say little.
      const double value = end->values.front();
      const bool isCommon = std::count_if(result_.tried.begin(), result_.tried.end(), [&](const SolveTry& t) { return t.mean == value; }) > 1;
      while (end->count() < (isCommon ? kSolveCommonDraws : 2)) {
        draw(*end);
        if (end->values.back() != value) return false;
      }
    }
    answer(between(low, high), low.at, high.at);
    return true;
  }

  void noisy(SolvePlace low, SolvePlace high) {
    // An end that is not told from the target is on the side that its mean says.
    told(low), told(high);
    const SolveSide first = sideOfLow(low, high);
    bool near = false;
    while (!near && high.at - low.at > wish_.tolerance) {
      SolvePlace middle{0.5 * (low.at + high.at), {}};
      const SolveSide side = told(middle);
      if (side == SolveSide::Unknown) near = closeIn(low, high, middle.at, first);
      else (side == first ? low : high) = middle;
    }
    fit(low, high);
  }

  /// About a place whose side is not told. False: it lies on one side after all, and bisecting goes on.
  bool closeIn(SolvePlace& low, SolvePlace& high, double middle, SolveSide first) {
    while (high.at - low.at > wish_.tolerance) {
      SolvePlace left{0.5 * (low.at + middle), {}}, right{0.5 * (middle + high.at), {}};
      const SolveSide ofLeft = told(left), ofRight = told(right);
      if (ofLeft != SolveSide::Unknown && ofLeft != first) {
        high = left;
        return false;
      }
      if (ofRight == first) {
        low = right;
        return false;
      }
      if (ofLeft == first) low = left;
      if (ofRight != SolveSide::Unknown) high = right;
      if (ofLeft == SolveSide::Unknown || ofRight == SolveSide::Unknown) break;
    }
    return true;
  }

  /// What three places say of the crossing, in steps from their middle.
  struct Crossing {
    double at = 0.0;
    std::optional<std::array<double, 2>> interval;  ///< none: the slope is not sure
    bool isBent = false;
  };

  static double degreesOf(const std::array<double, 3>& weights, const std::array<double, 3>& ofMeans, int count) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double part = weights[k] * weights[k] * ofMeans[k];
      sum += part, squares += part * part;
    }
    return sum * sum / squares * (count - 1);
  }

  Crossing crossingOf(const std::array<SolvePlace, 3>& places, double rising) const {
    std::array<double, 3> mean{}, variance{};
    for (std::size_t k = 0; k < 3; ++k) mean[k] = places[k].mean(), variance[k] = places[k].variance() / places[k].count();
    const double middle = (mean[0] + mean[1] + mean[2]) / 3.0 - wish_.target, slope = 0.5 * (mean[2] - mean[0]);
    const int count = places[0].count();
    Crossing crossing;
    if (!(slope * rising > 0.0)) return crossing;
    crossing.at = -middle / slope;
    const double bend = 0.5 * (mean[0] + mean[2]) - mean[1], ofBend = 0.25 * (variance[0] + variance[2]) + variance[1];
    const double u = crossing.at, ofMiddle = (variance[0] + variance[1] + variance[2]) / 9.0, ofSlope = 0.25 * (variance[0] + variance[2]),
                 ofBoth = (variance[2] - variance[0]) / 6.0;
    if (!(ofBend > 0.0)) {
      crossing.isBent = true;  // no noise to tell by
      return crossing;
    }
    crossing.isBent = std::abs(bend) > studentQuantile(1.0 - 0.5 * kSolveBentDoubt, degreesOf({0.5, -1.0, 0.5}, variance, count)) * std::sqrt(ofBend);
    const double t = studentQuantile(1.0 - 0.5 * kSolveDoubt, degreesOf({1.0 / 3.0 - 0.5 * u, 1.0 / 3.0, 1.0 / 3.0 + 0.5 * u}, variance, count));
    // (middle + slope u)^2 <= t^2 of its variance.
    const double a = slope * slope - t * t * ofSlope, b = middle * slope - t * t * ofBoth, c = middle * middle - t * t * ofMiddle;
    if (!(a > 0.0)) return crossing;
    const double root = std::sqrt(std::max(b * b - a * c, 0.0));
    crossing.interval = {(-b - root) / a, (-b + root) / a};
    return crossing;
  }

  void fit(const SolvePlace& low, const SolvePlace& high) {
    const double rising = high.mean() - low.mean(), slope = rising / (high.at - low.at), noise = std::sqrt(0.5 * (low.variance() + high.variance()));
    const double step = std::min(std::max(0.5 * (high.at - low.at), noise / std::abs(slope)), 0.5);
    double centre = between(low, high);
    for (int move = 0;; ++move) {
      centre = std::clamp(centre, step, 1.0 - step);
      std::array<SolvePlace, 3> places;
      for (std::size_t k = 0; k < 3; ++k) {
        places[k].at = centre + step * (static_cast<double>(k) - 1.0);
        while (places[k].count() < wish_.repeats) draw(places[k]);
        keep(places[k]);
      }
      const Crossing crossing = crossingOf(places, rising);
      if (std::abs(crossing.at) > kSolveFarSteps && move < kSolveMostMoves) {
        centre += step * crossing.at;
        continue;
      }
      double from = places[0].at, to = places[2].at;
      if (crossing.interval) {
        const double first = centre + step * crossing.interval->front(), last = centre + step * crossing.interval->back();
        from = crossing.isBent ? std::min(from, first) : first, to = crossing.isBent ? std::max(to, last) : last;
      } else {
        from = std::min(from, low.at), to = std::max(to, high.at);
      }
      answer(centre + step * crossing.at, from, to);
      return;
    }
  }

  const SeededMeasure& measure_;
  const SolveWish& wish_;
  std::mt19937_64 seeds_;
  double sure_;                           ///< quantile at which a side is told
  double squares_ = 0.0, degrees_ = 0.0;  ///< of all draws about the means of their places
  Solution result_;
};

}  // namespace

Solution solve(const SeededMeasure& measure, const SolveWish& wish) {
  checkSolveWish(wish);
  return SolveSearch(measure, wish).run();
}

}  // namespace pitviper
