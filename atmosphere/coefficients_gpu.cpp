#include "atmosphere/coefficients_gpu.hpp"

#include <algorithm>

#include "sim/plan/budget.hpp"

namespace pitviper {
namespace {

constexpr int kUnit = 24;

}  // namespace

CoefficientsOnGpu::CoefficientsOnGpu(const Plan& plan, int vectors, const std::optional<AirAmounts>& most) : vectors_(vectors) {
  for (const SpectralNode& n : plan.nodes) {
    const size_t from = numbers_.size(), count = static_cast<size_t>(4 * vectors);
    for (size_t k = 0; k < count; ++k) numbers_.push_back(static_cast<float>(n.air.extinction[k]));
    if (!most) continue;
    std::vector<std::pair<double, size_t>> depths;
    for (size_t k = 0; k < count; ++k) depths.emplace_back(n.air.extinction[k] * most->amount[k], k);
    std::sort(depths.begin(), depths.end());
    double left = budget::kThinAbsorbers.of(plan.accuracy);
    for (const auto& [depth, k] : depths)
      if ((left -= depth) >= 0.0) numbers_[from + k] = 0.0f;
  }
  block_.upload(numbers_);
}

void CoefficientsOnGpu::addSlots(ShaderSlots& slots) const {
  slots.constants["AIR_VECTORS"] = vectors_;
  slots.generated["air_extinction"] = planNumbers("airExtinction", kUnit);
}

void CoefficientsOnGpu::bind() const { block_.bindTexture(kUnit, 4); }

}  // namespace pitviper
