#include "sim/plan/group_refine.hpp"

#include <algorithm>
#include <cmath>

#include "sim/plan/group_step.hpp"

namespace pitviper {
namespace {

using Eigen::VectorXd;

/// An optical depth of the longest path that nobody sees: extinctions move by factors above it, by amounts below.
constexpr double kUnseenDepth = 0.02;

/// How far roots of shares may go where an extinction goes by a factor of e: between these, each round also tried with a multiple or a part.
constexpr double kLeastRootStep = 0.5, kMostRootStep = 32.0, kOther = 4.0;
/// Where that costs much, in two of so many rounds.
constexpr int kSeldom = 8;

/// A part of a step, and where it leads.
struct Trial {
  GroupState state;
  GroupMoments at;
  VectorXd errors;
  double merit = 0.0, length = 0.0, rootStep = 0.0;
  int place = 0;  ///< of its length
};

/// Parts of a step that are tried.
constexpr double kLengths[] = {1.0, 0.5, 0.25, 0.12, 0.06};
constexpr int kLengthCount = 5;

/// The norm's last power: a larger one swings between two errors.
constexpr double kMostPower = 12.0;

/// Dampings tried of one step, each ten times the last.
constexpr int kDampings = 3;

/// Part of the plain sum of squares in what is minimised: keeps what is already good from drifting.
constexpr double kEven = 1e-3;

/// Mean of (|e| / unit)^p 2/p unit^2 + kEven e^2: its derivative by an error is 2 ((|e| / unit)^(p-2) + kEven) e.
double merit(const VectorXd& errors, double p, double unit) {
  const auto parts = errors.array().abs() / unit;
  return (parts.pow(p) * (2.0 / p) + kEven * parts.square()).mean();
}

}  // namespace

double refineGroups(const ProductSet& set, GroupState& state, RefineProgress& progress, const RefineLimits& limits) {
  GroupMoments at = set.moments(state);
  VectorXd errors = set.errors(at);
  double most = errorFigures(errors).first;
  GroupState best = state;
  if (state.share.rows() < 1 || set.size() == 0) return most;
  VectorXd unseen(set.columnCount());
  for (Eigen::Index k = 0; k < unseen.size(); ++k) {
    const double longest = set.pathCount() ? set.amounts.row(k).maxCoeff() : 0.0;
    unseen[k] = longest > 0.0 && set.extinction.col(k).maxCoeff() > 0.0 ? kUnseenDepth / longest : 0.0;
  }
  double& damping = progress.damping;
  for (int round = 0; round < limits.rounds && most > limits.goal && !limits.expired(); ++round, ++progress.round) {
    const double p = std::clamp(2.0 * std::pow(1.25, progress.round - 4), 2.0, kMostPower);
    const double largest = errors.cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) break;
    // Newton's step on the p-norm: rows weighted with |e|^(p-2); a small part for all keeps the good ones good.
    VectorXd rowWeight = (errors.array().abs() / largest).pow(p - 2.0) + kEven;
    rowWeight /= rowWeight.sum();
    GroupStep step(set, state, at, errors, rowWeight, unseen);
    const double before = merit(errors, p, largest);
    const auto along = [&](double rootStep) {
      Trial nearest;
      nearest.merit = before;
      nearest.place = progress.place;
      step.solve(damping, rootStep);
      const auto isBetter = [&](int place) {
        if (place < 0 || place >= kLengthCount) return false;
        Trial trial{step.moved(kLengths[place]), {}, {}, 0.0, kLengths[place], rootStep, place};
        trial.at = set.moments(trial.state);
        trial.errors = set.errors(trial.at);
        trial.merit = merit(trial.errors, p, largest);
        if (!(trial.merit < nearest.merit)) return false;
        nearest = std::move(trial);
        return true;
      };
      // First as far as the last step went, then farther, or else less far, while that is better.
      const bool begun = isBetter(progress.place);
      bool farther = false;
      for (int k = progress.place - 1; begun && isBetter(k); --k) farther = true;
      for (int k = progress.place + 1; !farther && k < kLengthCount; ++k)
        if (!isBetter(k) && nearest.length > 0.0) break;
      return nearest;
    };
    Trial taken = along(progress.rootStep);
    // Which of the two kinds of unknowns should go farther differs from scene to scene, and from round to round.
    const double other = std::clamp(progress.rootStep * (progress.round % 2 == 0 ? kOther : 1.0 / kOther), kLeastRootStep, kMostRootStep);
    if (step.isCheap() || progress.round % kSeldom < 2)
      if (Trial trial = along(other); trial.merit < taken.merit) taken = std::move(trial);
    for (int tries = 1; tries < kDampings && taken.length == 0.0; ++tries) {
      damping = std::min(damping * 10.0, 1e3);
      taken = along(progress.rootStep);
    }
    if (taken.length == 0.0) {
      damping = std::min(damping * 10.0, 1e3);
      continue;
    }
    progress.rootStep = taken.rootStep;
    progress.place = taken.place;
    // Newton's step on the p-norm is 1 / (p - 1) of this one; much less says that the model is wrong so far out.
    const double newton = 1.0 / (p - 1.0);
    damping = std::clamp(damping * (taken.length >= std::min(2.0 * newton, 1.0) ? 0.4 : taken.length >= 0.9 * newton ? 1.0 : 4.0), 1e-9, 1e4);
    state = std::move(taken.state);
    at = std::move(taken.at);
    errors = std::move(taken.errors);
    const double reached = errorFigures(errors).first;
    if (reached < most) {
      most = reached;
      best = state;
    }
  }
  state = std::move(best);
  return most;
}

}  // namespace pitviper
