#include "atmosphere/coefficients_gpu.hpp"

#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

constexpr int kBinding = 4;

}  // namespace

CoefficientsOnGpu::CoefficientsOnGpu(const Plan& plan, int vectors) : vectors_(vectors) {
  for (const SpectralNode& n : plan.nodes)
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors); ++k) numbers_.push_back(static_cast<float>(n.air.extinction[k]));
  checkUniformSize(numbers_.size() * sizeof(float), "the air's coefficients");
  block_.upload(numbers_);
}

void CoefficientsOnGpu::addSlots(ShaderSlots& slots) const {
  slots.constants["AIR_VECTORS"] = vectors_;
  slots.generated["air_extinction"] = planNumbers("airExtinction", numbers_, kBinding, slots.constants["WRITTEN_OUT"] != 0);
}

void CoefficientsOnGpu::bind() const { block_.bindUniform(kBinding); }

}  // namespace pitviper
