#include "atmosphere/coefficients_gpu.hpp"

#include <algorithm>

namespace pitviper {
namespace {

constexpr int kUnit = 24;

}  // namespace

CoefficientsOnGpu::CoefficientsOnGpu(const Plan& plan, int vectors) : vectors_(vectors) {
  std::vector<float> numbers;
  for (const SpectralNode& n : plan.nodes)
    std::transform(n.air.extinction.begin(), n.air.extinction.begin() + 4 * vectors, std::back_inserter(numbers),
                   [](double k) { return static_cast<float>(k); });
  block_.upload(numbers);
}

void CoefficientsOnGpu::addSlots(ShaderSlots& slots) const {
  slots.constants["AIR_VECTORS"] = vectors_;
  slots.generated["air_extinction"] = planNumbers("airExtinction", kUnit);
}

void CoefficientsOnGpu::bind() const { block_.bindTexture(kUnit, 4); }

}  // namespace pitviper
