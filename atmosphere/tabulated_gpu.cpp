#include "atmosphere/tabulated_gpu.hpp"

#include "sim/gl/context.hpp"

namespace pitviper {

TabulatedOnGpu::TabulatedOnGpu(const Simulation& simulation, const Plan& plan) {
  const auto powers = simulation.air->exponents();
  vectors_ = (static_cast<int>(powers.size()) + 3) / 4;
  std::vector<float> block;
  for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) block.push_back(k < powers.size() ? static_cast<float>(powers[k]) : 1.0f);
  for (const SpectralNode& n : plan.nodes)
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) block.push_back(static_cast<float>(n.air.extinction[k]));
  checkUniformSize(block.size() * sizeof(float), "the air's coefficients");
  block_.upload(block);
}

void TabulatedOnGpu::addSlots(ShaderSlots& slots) const {
  slots.files["path"] = "atmosphere/tabulated.glsl";
  slots.constants["AIR_VECTORS"] = vectors_;
}

}  // namespace pitviper
