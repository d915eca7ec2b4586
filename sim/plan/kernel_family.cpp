#include "sim/plan/kernel_family.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

constexpr double kMostRatio = 3.0;
/// Where responses are compared: at their bends, and at so many places between.
constexpr int kBetween = 32;

}  // namespace

bool areAlike(const Spectrum& a, const Spectrum& b) {
  const double low = a.supportLow(), high = a.supportHigh();
  if (b.supportLow() != low || b.supportHigh() != high) return false;
  for (const Spectrum* s : {&a, &b})
    if (s->validLow() > low || s->validHigh() < high) return false;
  const double sizeA = a.integral(low, high), sizeB = b.integral(low, high);
  if (!(sizeA > 0.0 && sizeB > 0.0)) return false;
  std::vector<double> edges = {low, high};
  for (const Spectrum* s : {&a, &b})
    for (double k : s->knots())
      if (k > low && k < high) edges.push_back(k);
  for (int k = 1; k < kBetween; ++k) edges.push_back(low + (high - low) * k / kBetween);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  // By pieces: what is 0 at an end says nothing of a ratio, and at a step there are two values.
  for (size_t i = 0; i + 1 < edges.size(); ++i) {
    const double inA = a.integral(edges[i], edges[i + 1]) / sizeA, inB = b.integral(edges[i], edges[i + 1]) / sizeB;
    if (inA < 0.0 || inB < 0.0 || inA > kMostRatio * inB || inB > kMostRatio * inA) return false;
  }
  return true;
}

std::vector<std::vector<size_t>> kernelFamilies(std::span<const ChannelOutput* const> slots) {
  std::vector<std::vector<size_t>> families;
  for (size_t s = 0; s < slots.size(); ++s) {
    const auto own = std::find_if(families.begin(), families.end(), [&](const auto& f) {
      const ChannelOutput& first = *slots[f.front()];
      return first.apart == slots[s]->apart && areAlike(first.kernel, slots[s]->kernel);
    });
    if (own == families.end()) families.push_back({s});
    else own->push_back(s);
  }
  return families;
}

}  // namespace pitviper
