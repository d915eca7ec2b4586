#include "sensors/signal_memory.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

constexpr double kForgotten = 1e-5;
constexpr std::size_t kMostFrames = 4096;

std::vector<double> fading(double left) {
  std::vector<double> weights;
  double rest = 1.0;
  while (rest > kForgotten && weights.size() < kMostFrames) {
    weights.push_back(rest * (1.0 - left));
    rest *= left;
  }
  weights.back() += rest;
  return weights;
}

}  // namespace

std::vector<double> memoryWeights(const DetectorLaw& law, double step_s) {
  std::vector<double> both{1.0};
  for (double left : {law.lag, law.timeConstant_s > 0.0 ? std::exp(-step_s / law.timeConstant_s) : 0.0}) {
    if (!(left > 0.0)) continue;
    const std::vector<double> one = fading(left);
    std::vector<double> next(both.size() + one.size() - 1, 0.0);
    for (std::size_t i = 0; i < both.size(); ++i)
      for (std::size_t j = 0; j < one.size(); ++j) next[i + j] += both[i] * one[j];
    double rest = 0.0;
    while (next.size() > 1 && rest + next.back() < kForgotten) rest += next.back(), next.pop_back();
    next.back() += rest;
    both = next;
  }
  return both;
}

void SignalMemory::apply(std::uint32_t channel, int frame, const std::vector<double>& weights, std::vector<float>& picture) {
  if (weights.size() < 2) return;
  Kept& kept = kept_[channel];
  if (!kept.pictures.empty() && (frame != kept.last + 1 || kept.pictures.front().size() != picture.size())) kept.pictures.clear();
  kept.last = frame;
  kept.pictures.insert(kept.pictures.begin(), picture);
  if (kept.pictures.size() > weights.size()) kept.pictures.pop_back();
  std::vector<double> sum(picture.size(), 0.0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const std::vector<float>& then = kept.pictures[std::min(k, kept.pictures.size() - 1)];
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += weights[k] * static_cast<double>(then[p]);
  }
  for (std::size_t p = 0; p < sum.size(); ++p) picture[p] = static_cast<float>(sum[p]);
}

}  // namespace pitviper
