#include "sim/plan/channel_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "sim/plan/budget.hpp"
#include "sim/plan/product_set.hpp"

namespace pitviper {
namespace {

constexpr int kMostGroups = 96;
/// Most of hundreds of lines say the same: a fit begins with some, and the worst of the others join them.
constexpr FitEffort kEffort{60, 160, 0.0, 12};
/// Kernels whose ratio varies by less than this differ by a factor alone.
constexpr double kSameShape = 1e-6;
/// At most so many of the worst products are learnt at a time.
constexpr size_t kLearnt = 60;

}  // namespace

ChannelFit::ChannelFit(const Simulation& simulation, std::span<const Spectrum* const> kernels, double accuracy)
    : grid_(fineGridOf(simulation, kernels)), accuracy_(accuracy) {
  if (!simulation.fields.empty()) accuracy_ = budget::kBesideFields.of(accuracy_);
  for (size_t k = 0; k < grid_.ratio.size(); ++k) {
    const auto [least, most] = std::minmax_element(grid_.ratio[k].begin(), grid_.ratio[k].end());
    if (*most - *least > kSameShape * *most) kernels_.push_back(k + 1);
  }
}

SpectralProblem ChannelFit::problemOf(const Sights& sights, size_t first) const { return sights.problem(grid_, kernels_, absorbers_, floors_, first); }

double ChannelFit::weightOf(const SpectralGroup& group, size_t kernel) const {
  if (kernel == 0) return group.weight;
  double mean = 0.0;
  for (const auto& [index, share] : group.members) mean += share * grid_.ratio[kernel - 1][static_cast<size_t>(index)];
  return group.weight * mean;
}

void ChannelFit::look(const ProductSet& products) {
  for (Eigen::Index m = 0; m < products.parts.cols(); ++m)
    for (Eigen::Index k = 0; k < products.parts.rows(); ++k)
      shares_[static_cast<size_t>(k)] = std::max(shares_[static_cast<size_t>(k)], std::abs(products.parts(k, m)) * products.scale[m]);
}

void ChannelFit::begin(const Sights& sights, std::vector<double> floors) {
  absorbers_ = sights.absorbers(grid_);
  floors_ = std::move(floors);
  SpectralProblem problem = problemOf(sights, 0);
  seen_ = sights.size();
  const ProductSet products(problem);
  look(products);
  fit_ = fitToTolerance(products, budget::kFitted.of(accuracy_), kMostGroups, kEffort, {});
  training_ = std::move(problem.products);
}

bool ChannelFit::check(const Sights& sights) {
  SpectralProblem problem = problemOf(sights, seen_);
  seen_ = sights.size();
  const ProductSet products(problem);
  look(products);
  const std::vector<double> errors = groupErrors(products, fit_.groups);
  std::vector<size_t> order(errors.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return std::abs(errors[a]) > std::abs(errors[b]); });
  const double worst = order.empty() ? 0.0 : std::abs(errors[order.front()]);
  holds_ = worst <= budget::kUnseen.of(accuracy_);
  if (holds_) return true;
  for (size_t k = 0; k < std::min(kLearnt, order.size()) && std::abs(errors[order[k]]) > budget::kFitted.of(accuracy_); ++k)
    training_.push_back(problem.products[order[k]]);
  fit(std::move(problem));
  return false;
}

void ChannelFit::learn(const Sights& sights, size_t first, double part) {
  SpectralProblem problem = problemOf(sights, first);
  seen_ = sights.size();
  const ProductSet products(problem);
  look(products);
  before_ = {fit_, accuracy_};
  const std::vector<double> errors = groupErrors(products, fit_.groups);
  const bool isShown = std::any_of(errors.begin(), errors.end(), [&](double e) { return std::abs(e) > budget::kFitted.of(accuracy_); });
  if (!isShown) accuracy_ *= part;
  holds_ = false;
  training_.insert(training_.end(), problem.products.begin(), problem.products.end());
  fit(std::move(problem));
}

void ChannelFit::goBack() { std::tie(fit_, accuracy_) = before_; }

/// Fits to all products learnt, beginning with the groups it has.
void ChannelFit::fit(SpectralProblem problem) {
  problem.products = training_;
  fit_ = fitToTolerance(ProductSet(problem), budget::kFitted.of(accuracy_), kMostGroups, kEffort, fit_.groups);
}

}  // namespace pitviper
