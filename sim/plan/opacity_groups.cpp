#include "sim/plan/opacity_groups.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "sim/plan/group_refine.hpp"
#include "sim/plan/group_start.hpp"
#include "sim/plan/product_set.hpp"

namespace pitviper {
namespace {

using Eigen::VectorXd;

/// Shares of a wavelength below this go to its other groups: they cost the builder of tables time and change nothing.
constexpr double kLeastShare = 1e-6;

/// Part of each wavelength that is spread evenly over all groups before a fit: a share of 0 could not move. Neither is always the better.
constexpr double kLittleSpread = 0.01, kSpreads[] = {0.1, kLittleSpread};

/// Products in a fit at most, before the oldest are forgotten, of those at first.
constexpr size_t kKeptProducts = 4;

/// Groups tried first.
constexpr int kFirstTried = 4;

/// Rounds between two looks at all products.
constexpr int kRoundsPerPass = 6;

/// What a fit of many groups gets at least.
constexpr int kFewestRounds = 4;

/// What the second pass leaves the later ones rarely lower by more than half of this.
constexpr double kHopeless = 5.0;

/// Whether the budget of time is spent; without one, never.
std::function<bool()> clockOf(const FitEffort& effort) {
  if (!(effort.budget_s > 0.0)) return [] { return false; };
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(effort.budget_s);
  return [end] { return std::chrono::steady_clock::now() >= end; };
}

std::vector<int> spreadOf(int count, int most) {
  std::vector<int> picked;
  const int n = std::min(count, std::max(most, 1));
  for (int j = 0; j < n; ++j) picked.push_back(static_cast<int>(static_cast<long long>(j) * count / n));
  return picked;
}

void dropSmallShares(GroupState& s) {
  for (Eigen::Index i = 0; i < s.share.cols(); ++i) {
    s.share.col(i) = (s.share.col(i).array() >= kLeastShare).select(s.share.col(i), 0.0);
    s.share.col(i) /= s.share.col(i).sum();
  }
}

std::vector<SpectralGroup> groupsOf(const ProductSet& set, const GroupState& s) {
  std::vector<SpectralGroup> groups;
  for (Eigen::Index g = 0; g < s.share.rows(); ++g) {
    SpectralGroup group;
    group.weight = s.share.row(g).dot(set.weight);
    if (!(group.weight > 0.0)) continue;
    for (Eigen::Index i = 0; i < s.share.cols(); ++i)
      if (s.share(g, i) > 0.0) group.members.emplace_back(set.fineIndex[static_cast<size_t>(i)], s.share(g, i) * set.weight[i] / group.weight);
    for (Eigen::Index k = 0; k < s.extinction.cols(); ++k) group.extinction.push_back(s.extinction(g, k));
    groups.push_back(std::move(group));
  }
  if (groups.empty()) {
    // A channel that sees nothing: one group of weight 0, so that averages still exist.
    SpectralGroup none;
    for (int i = 0; i < set.wavelengths; ++i) none.members.emplace_back(i, 1.0 / set.wavelengths);
    none.extinction.assign(static_cast<size_t>(set.columnCount()), 0.0);
    groups.push_back(std::move(none));
  }
  return groups;
}

GroupState stateOf(const ProductSet& set, const std::vector<SpectralGroup>& groups) {
  std::vector<int> keptIndex(static_cast<size_t>(set.wavelengths), -1);
  for (size_t i = 0; i < set.fineIndex.size(); ++i) keptIndex[static_cast<size_t>(set.fineIndex[i])] = static_cast<int>(i);
  const auto g = static_cast<Eigen::Index>(groups.size());
  GroupState state{Eigen::MatrixXd::Zero(g, set.fineCount()), Eigen::MatrixXd::Zero(g, set.columnCount())};
  for (Eigen::Index j = 0; j < g; ++j) {
    const SpectralGroup& group = groups[static_cast<size_t>(j)];
    if (static_cast<int>(group.extinction.size()) != set.columnCount()) throw std::invalid_argument("opacity groups: another number of columns");
    for (Eigen::Index k = 0; k < set.columnCount(); ++k) state.extinction(j, k) = group.extinction[static_cast<size_t>(k)];
    for (const auto& [index, share] : group.members) {
      if (index < 0 || index >= set.wavelengths) throw std::invalid_argument("opacity groups: a member outside the grid");
      const int i = keptIndex[static_cast<size_t>(index)];
      if (i >= 0) state.share(j, i) = share * group.weight / set.weight[i];
    }
  }
  return state;
}

/// Divides in two the group whose wavelengths' logarithms of extinction vary most, by what these matter, until there are so many, or all are alike.
GroupState divided(const ProductSet& set, GroupState state, Eigen::Index count) {
  // What each wavelength matters: its part of the sources, and a little where none shines.
  VectorXd matters = 1e-6 * set.weight / set.weight.sum();
  for (Eigen::Index s = 0; s < set.weighted.cols(); ++s)
    if (const double sum = set.weighted.col(s).cwiseAbs().sum(); sum > 0.0) matters += set.weighted.col(s).cwiseAbs() / sum;
  Eigen::MatrixXd opacity(set.fineCount(), set.columnCount());
  for (Eigen::Index k = 0; k < opacity.cols(); ++k)
    opacity.col(k) = (set.extinction.col(k).array() + 1e-3 * std::max(set.extinction.col(k).mean(), 1e-300)).log();
  while (state.share.rows() < count) {
    const Eigen::MatrixXd parts = state.share * matters.asDiagonal();  // [group, fine]
    const VectorXd sums = parts.rowwise().sum();
    const Eigen::MatrixXd mean = (parts * opacity).array().colwise() / sums.array().max(1e-300);
    const Eigen::MatrixXd spread = parts * opacity.cwiseAbs2() - (mean.cwiseAbs2().array().colwise() * sums.array()).matrix();
    Eigen::Index g = 0, k = 0;
    if (opacity.cols() == 0 || !(spread.maxCoeff(&g, &k) > 0.0)) break;
    const Eigen::Index more = state.share.rows();
    state.share.conservativeResize(more + 1, Eigen::NoChange);
    state.extinction.conservativeResize(more + 1, Eigen::NoChange);
    state.share.row(more).setZero();
    for (Eigen::Index i = 0; i < state.share.cols(); ++i)
      if (opacity(i, k) > mean(g, k)) std::swap(state.share(more, i), state.share(g, i));
    for (const Eigen::Index row : {g, more}) {
      const VectorXd weight = state.share.row(row).transpose().cwiseProduct(set.weight);
      if (weight.sum() > 0.0) state.extinction.row(row) = weight.transpose() * set.extinction / weight.sum();
      else state.extinction.row(row) = state.extinction.row(g);
    }
  }
  return state;
}

/// Products with a start, for fits of several counts.
class Fitter {
 public:
  Fitter(const ProductSet& products, const FitEffort& effort, GroupState from)
      : effort_(effort),
        expired_(clockOf(effort)),
        all_(products),
        from_(std::move(from)),
        working_(spreadOf(all_.size(), effort.workingProducts)),
        set_(all_.subset(working_)),
        start_(all_) {}

  int mostGroups() const { return all_.fineCount(); }

  /// Neighbouring wavelengths as one group each, without any fitting: exact where there are as many groups as wavelengths.
  GroupFit bins(int groups) const {
    const Eigen::Index n = all_.fineCount(), count = std::min<Eigen::Index>(groups, n);
    GroupState state{Eigen::MatrixXd::Zero(count, n), Eigen::MatrixXd::Zero(count, all_.columnCount())};
    VectorXd weight = VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index g = i * count / n;
      state.share(g, i) = 1.0;
      state.extinction.row(g) += all_.weight[i] * all_.extinction.row(i);
      weight[g] += all_.weight[i];
    }
    for (Eigen::Index g = 0; g < count; ++g) state.extinction.row(g) /= weight[g];
    return finish(std::move(state), static_cast<int>(count));
  }

  /// The best found of a count; stops early below a goal, or where it is plain that the goal cannot be met.
  GroupFit fit(int groups, double goal) {
    if (all_.fineCount() == 0) return finish(GroupState{}, 0);
    const int count = std::clamp(groups, 1, mostGroups());
    // A step costs as its groups; many groups begin near enough for a few.
    const int rounds = effort_.fewGroups > 0 ? std::clamp(effort_.rounds * effort_.fewGroups / count, std::min(effort_.rounds, kFewestRounds), effort_.rounds)
                                             : effort_.rounds;
    GroupState state = start_.state(count), best = state;
    forgetOldest();
    RefineProgress progress;
    // The start by itself is exact where wavelengths are few or alike.
    double least = errorFigures(all_.errors(all_.moments(state))).first;
    const int firstRounds = std::max(rounds / 3, 1);
    std::vector<GroupState> begins;
    const auto spreadOut = [](GroupState s, double part) {
      s.share = (1.0 - part) * s.share.array() + part / static_cast<double>(s.share.rows());
      return s;
    };
    if (from_.share.rows() == count) begins.push_back(from_);
    if (from_.share.rows() > 0 && from_.share.rows() < count)
      if (GroupState more = divided(all_, from_, count); more.share.rows() == count) begins.push_back(spreadOut(std::move(more), kLittleSpread));
    for (double spread : kSpreads) begins.push_back(spreadOut(state, spread));
    double leastBegun = INFINITY;
    for (GroupState& trial : begins) {
      if (std::min(least, leastBegun) <= goal) break;
      RefineProgress trialProgress;
      refineGroups(set_, trial, trialProgress, {firstRounds, 0.9 * goal, expired_});
      const double most = errorFigures(all_.errors(all_.moments(trial))).first;
      if (most >= leastBegun) continue;
      leastBegun = most;
      state = std::move(trial);
      progress = trialProgress;
    }
    if (leastBegun < least) {
      least = leastBegun;
      best = state;
    }
    std::array<double, 2> before{INFINITY, INFINITY};  // one and two passes ago
    for (int left = rounds - firstRounds; left > 0 && least > goal && !expired_(); left -= kRoundsPerPass) {
      if (static_cast<int>(working_.size()) < all_.size()) addWorst(all_.errors(all_.moments(state)));
      refineGroups(set_, state, progress, {std::min(left, kRoundsPerPass), 0.9 * goal, expired_});
      const double most = errorFigures(all_.errors(all_.moments(state))).first;
      if (most < least) {
        least = most;
        best = state;
      }
      if (goal > 0.0 && least > kHopeless * goal) break;
      // What two passes did not bring near enough for the others to do the rest they won't.
      const double gain = before[1] - least, passes = std::ceil(static_cast<double>(left - kRoundsPerPass) / kRoundsPerPass);
      if (goal > 0.0 && least > goal && gain * passes < least - goal) break;
      before = {least, before[0]};
    }
    if (least > goal && least < leastFound_) leastFound_ = least, from_ = best;  // more groups begin with it
    return finish(best, count);
  }

 private:
  /// Of the products that fits before this one added, the latest stay, as many as there were at first: they are hard for other counts too.
  void forgetOldest() {
    const size_t first = spreadOf(all_.size(), effort_.workingProducts).size();
    if (working_.size() <= kKeptProducts * first) return;
    working_.erase(working_.begin() + static_cast<std::ptrdiff_t>(first), working_.end() - static_cast<std::ptrdiff_t>(first));
    set_ = all_.subset(working_);
  }

  /// The worst products outside the working set join it.
  void addWorst(const VectorXd& errors) {
    std::vector<bool> has(static_cast<size_t>(all_.size()), false);
    for (int m : working_) has[static_cast<size_t>(m)] = true;
    std::vector<int> others;
    for (int m = 0; m < all_.size(); ++m)
      if (!has[static_cast<size_t>(m)]) others.push_back(m);
    std::stable_sort(others.begin(), others.end(), [&](int a, int b) { return std::abs(errors[a]) > std::abs(errors[b]); });
    others.resize(std::min(others.size(), working_.size() / 8 + 1));
    working_.insert(working_.end(), others.begin(), others.end());
    set_ = all_.subset(working_);
  }

  GroupFit finish(GroupState state, int count) const {
    GroupFit result;
    if (count > 0) dropSmallShares(state);
    result.groups = groupsOf(all_, state);
    if (count > 0) std::tie(result.maximum, result.p99) = errorFigures(all_.errors(all_.moments(state)));
    return result;
  }

  FitEffort effort_;
  std::function<bool()> expired_;
  const ProductSet& all_;
  GroupState from_;  ///< found elsewhere, or the best that was not enough; tried first where it has as many groups, divided where it has fewer
  double leastFound_ = INFINITY;
  std::vector<int> working_;
  ProductSet set_;
  GroupStart start_;
};

}  // namespace

GroupFit fitGroups(const SpectralProblem& problem, int groups, const FitEffort& effort) {
  const ProductSet products(problem);
  return Fitter(products, effort, {}).fit(groups, 0.0);
}

namespace {

GroupFit fitToTolerance(const ProductSet& products, double tolerance, int mostGroups, const FitEffort& effort, int fewest, GroupState from) {
  Fitter fitter(products, effort, std::move(from));
  const int most = std::max(std::min(mostGroups, fitter.mostGroups()), 1);
  // Below the first there may be enough too, unless they are known not to be.
  const int first = std::clamp(fewest > 1 ? fewest : kFirstTried, 1, most);
  int tooFew = fewest > 1 ? first - 1 : 0, enough = most + 1;
  GroupFit best;
  // Growing by halves until it holds, then between the last two.
  for (int n = first; tooFew + 1 < enough;) {
    GroupFit fit = fitter.fit(n, tolerance);
    if (fit.maximum <= tolerance) {
      enough = n;
      best = std::move(fit);
      n = (tooFew + enough) / 2;
      if (n == tooFew || (effort.fewGroups > 0 && enough > effort.fewGroups && 6 * (enough - tooFew) <= enough)) break;
    } else {
      tooFew = n;
      if (best.groups.empty() || (enough > most && fit.maximum < best.maximum)) best = std::move(fit);
      n = enough <= most ? (tooFew + enough) / 2 : std::min(std::max(n + 1, fewest > 1 ? n * 5 / 4 : n * 3 / 2), most);
      if (n <= tooFew) break;
    }
  }
  // Where even these are not enough, spectra too rich to share groups: bins, each half as many again.
  for (int n = most; best.maximum > tolerance && n < fitter.mostGroups();) {
    n = std::min(n * 3 / 2 + 1, fitter.mostGroups());
    if (GroupFit fit = fitter.bins(n); fit.maximum < best.maximum) best = std::move(fit);
  }
  return best;
}

}  // namespace

GroupFit fitToTolerance(const SpectralProblem& problem, double tolerance, int mostGroups, const FitEffort& effort, int fewest) {
  return fitToTolerance(ProductSet(problem), tolerance, mostGroups, effort, fewest, {});
}

GroupFit fitToTolerance(const ProductSet& products, double tolerance, int mostGroups, const FitEffort& effort, const std::vector<SpectralGroup>& from) {
  return fitToTolerance(products, tolerance, mostGroups, effort, std::max(static_cast<int>(from.size()), 1),
                        from.empty() ? GroupState{} : stateOf(products, from));
}

std::vector<double> groupErrors(const ProductSet& set, const std::vector<SpectralGroup>& groups) {
  if (set.size() == 0 || groups.empty()) return std::vector<double>(static_cast<size_t>(set.size()), 0.0);
  const Eigen::VectorXd errors = set.errors(set.moments(stateOf(set, groups)));
  return {errors.data(), errors.data() + errors.size()};
}

GroupFit evaluateGroups(const SpectralProblem& fresh, const std::vector<SpectralGroup>& groups) {
  const std::vector<double> errors = groupErrors(ProductSet(fresh), groups);
  GroupFit result{groups, 0.0, 0.0};
  std::tie(result.maximum, result.p99) = errorFigures(Eigen::Map<const Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size())));
  return result;
}

}  // namespace pitviper
