#include "sim/plan/channel_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pitviper {
namespace {

/// Of the error asked for: what groups may take of the products they are fitted to, and of those they are not. The rest is for tables and for
/// what was not drawn.
constexpr double kFitted = 0.35, kUnseen = 0.5;
/// Parts of the sights: to fit to, and to check with and learn from; the rest is never learnt from.
constexpr double kTraining = 0.25, kChecked = 0.65;
constexpr int kMostGroups = 64, kRounds = 4;
/// Of the worst that a round learns from.
constexpr size_t kLearnt = 60;

SpectralProblem without(const SpectralProblem& all) {
  SpectralProblem p = all;
  p.products.clear();
  return p;
}

double largest(const std::vector<double>& errors) {
  double most = 0.0;
  for (double e : errors) most = std::max(most, std::abs(e));
  return most;
}

}  // namespace

ChannelFit fitChannel(const Simulation& simulation, const Sights& sights, const Spectrum& kernel, double accuracy) {
  ChannelFit channel;
  channel.grid = fineGridOf(simulation, kernel);
  channel.absorbers = sights.absorbers(channel.grid);
  SpectralProblem all = sights.problem(channel.grid, channel.absorbers);
  SpectralProblem training = without(all), checked = without(all);
  const auto first = static_cast<std::ptrdiff_t>(kTraining * static_cast<double>(all.products.size())),
             last = static_cast<std::ptrdiff_t>(kChecked * static_cast<double>(all.products.size()));
  training.products.assign(all.products.begin(), all.products.begin() + first);
  checked.products.assign(all.products.begin() + first, all.products.begin() + last);

  GroupFit fit;
  for (int round = 0; round < kRounds; ++round) {
    fit = fitToTolerance(training, kFitted * accuracy, kMostGroups, {}, static_cast<int>(fit.groups.size()));
    const std::vector<double> errors = groupErrors(checked, fit.groups);
    if (largest(errors) <= kUnseen * accuracy) break;
    std::vector<size_t> order(errors.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return std::abs(errors[a]) > std::abs(errors[b]); });
    for (size_t k = 0; k < std::min(kLearnt, order.size()) && std::abs(errors[order[k]]) > kFitted * accuracy; ++k)
      training.products.push_back(checked.products[order[k]]);
  }
  channel.error = largest(groupErrors(all, fit.groups));
  channel.groups = std::move(fit.groups);
  return channel;
}

}  // namespace pitviper
