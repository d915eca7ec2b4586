#include "scenarios/sweep/solve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
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
/// The last three places are moved where the crossing lies beyond them: so often at most.
constexpr int kSolveMostMoves = 4;
/// Draws at each of the last two places of a measure that seems to have no noise and few values: of one that is either as often, 1 in 1000 is missed.
constexpr int kSolveCommonDraws = 6;

/// All draws at one place.
struct SolvePlace {
  double at = 0.0;  ///< 0 to 1 over the range
  std::vector<double> values;

  int count() const { return static_cast<int>(values.size()); }
  bool isAlike() const {
    return std::all_of(values.begin(), values.end(), [this](double v) { return v == values.front(); });
  }
  /// Of draws that are alike exactly what they are.
  double mean() const { return isAlike() ? values.front() : std::accumulate(values.begin(), values.end(), 0.0) / count(); }
  double variance() const {
    if (isAlike()) return 0.0;
    const double middle = mean();
    double sum = 0.0;
    for (const double v : values) sum += (v - middle) * (v - middle);
    return sum / (count() - 1);
  }
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
    result_.isNoisy = !low.isAlike() || !high.isAlike();
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
    least_ = std::min(least_, value), most_ = std::max(most_, value);
  }

  void keep(const SolvePlace& place) { result_.tried.push_back({xAt(place.at), place.mean(), place.standardError(), place.count()}); }

  SolveSide sideOf(double value) const { return value > wish_.target ? SolveSide::Above : value < wish_.target ? SolveSide::Below : SolveSide::Unknown; }

  /// Draws until it is known, or as often as may be.
  SolveSide told(SolvePlace& place) {
    for (int wanted = kSolveFewestRepeats;; wanted = std::min(2 * wanted, wish_.repeats)) {
      while (place.count() < wanted) draw(place);
      const bool isAlike = place.isAlike(),
                 isKnown =
                     isAlike ? toldByAlike(place) : std::abs(place.mean() - wish_.target) > studentQuantile(sure_, place.count() - 1) * place.standardError();
      if (!isKnown && wanted < wish_.repeats) continue;
      keep(place);
      return isKnown || isAlike ? sideOf(place.mean()) : SolveSide::Unknown;
    }
  }

  /// Draws that are all alike may have missed others: so large a share of them, as large as any was so far, leaves the mean on this side.
  bool toldByAlike(const SolvePlace& place) const {
    const double value = place.values.front(), other = value > wish_.target ? least_ : most_, missed = 1.0 - std::pow(1.0 - sure_, 1.0 / place.count());
    return (value + missed * (other - value) - wish_.target) * (value - wish_.target) > 0.0;
  }

  std::string described(const SolvePlace& place) const {
    return print("%g%s at %s = %g", place.mean(), !place.isAlike() ? print(" +- %.2g", place.standardError()).c_str() : "", wish_.factor.c_str(),
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
    double noise = 0.0;
    while (!near && high.at - low.at > wish_.tolerance) {
      SolvePlace middle{0.5 * (low.at + high.at), {}};
      const SolveSide side = told(middle);
      if (side == SolveSide::Unknown) noise = middle.variance(), near = closeIn(low, high, middle.at, first);
      else (side == first ? low : high) = middle;
    }
    fit(low, high, std::max(noise, 0.5 * (low.variance() + high.variance())));
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

  /// What three places say of the crossing, in steps from the middle one.
  struct Crossing {
    double at = 0.0;
    std::optional<std::array<double, 2>> interval;  ///< none: the slope is not sure
    bool isBent = false;                            ///< so that a line through them is off by more than noise
  };

  /// A line through the middle place with the slope between the other two: of a measure that bends evenly it is off by the bend times the square of the steps
  /// to the crossing, which are few.
  Crossing crossingOf(const std::array<SolvePlace, 3>& places, double rising) const {
    std::array<double, 3> mean{}, variance{};
    for (std::size_t k = 0; k < 3; ++k) mean[k] = places[k].mean(), variance[k] = places[k].variance() / places[k].count();
    // Deviation of a sum of the means with these weights at a share of certainty.
    const auto sure = [&](const std::array<double, 3>& weights, double doubt) {
      double sum = 0.0, squares = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double part = weights[k] * weights[k] * variance[k];
        sum += part, squares += part * part / (places[k].count() - 1);
      }
      return sum > 0.0 ? studentQuantile(1.0 - 0.5 * doubt, sum * sum / squares) * std::sqrt(sum) : 0.0;
    };
    const double off = mean[1] - wish_.target, slope = 0.5 * (mean[2] - mean[0]), bend = 0.5 * (mean[0] + mean[2]) - mean[1];
    Crossing crossing;
    if (!(slope * rising > 0.0)) return crossing;
    const double u = crossing.at = -off / slope, error = sure({-0.5 * u, 1.0, 0.5 * u}, kSolveDoubt);
    crossing.isBent = std::abs(bend) > sure({0.5, -1.0, 0.5}, kSolveBentDoubt) && std::abs(bend) * u * u > 0.5 * error;
    // (off + slope u)^2 <= t^2 of its variance.
    const double ofSlope = 0.25 * (variance[0] + variance[2]), all = variance[1] + u * u * ofSlope, t2 = all > 0.0 ? error * error / all : 0.0,
                 a = slope * slope - t2 * ofSlope, b = off * slope, c = off * off - t2 * variance[1];
    if (!(a > 0.0)) return crossing;
    const double root = std::sqrt(std::max(b * b - a * c, 0.0));
    crossing.interval = {(-b - root) / a, (-b + root) / a};
    return crossing;
  }

  /// `noise`: variance of draws about where the crossing lies.
  void fit(const SolvePlace& low, const SolvePlace& high, double noise) {
    const double rising = high.mean() - low.mean(), slope = rising / (high.at - low.at);
    const int aside = std::max(wish_.repeats / 2, kSolveFewestRepeats), within = 2 * wish_.repeats;
    // The slope is then sure to a sixth.
    const double step = std::clamp(6.0 * std::sqrt(0.5 * noise / aside) / std::abs(slope), 0.5 * wish_.tolerance, 0.5);
    double centre = between(low, high);
    for (int move = 0;; ++move) {
      centre = std::clamp(centre, step, 1.0 - step);
      std::array<SolvePlace, 3> places;
      for (std::size_t k = 0; k < 3; ++k) {
        places[k].at = centre + step * (static_cast<double>(k) - 1.0);
        while (places[k].count() < (k == 1 ? within : aside)) draw(places[k]);
        keep(places[k]);
      }
      const Crossing crossing = crossingOf(places, rising);
      if (move < kSolveMostMoves && std::abs(crossing.at) > 1.0) {
        centre += step * std::clamp(crossing.at, -2.0, 2.0);
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
  double sure_;                                 ///< quantile at which a side is told
  double least_ = INFINITY, most_ = -INFINITY;  ///< of all draws
  Solution result_;
};

}  // namespace

Solution solve(const SeededMeasure& measure, const SolveWish& wish) {
  checkSolveWish(wish);
  return SolveSearch(measure, wish).run();
}

}  // namespace pitviper
