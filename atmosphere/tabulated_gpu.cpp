#include "atmosphere/tabulated_gpu.hpp"

namespace pitviper {

TabulatedOnGpu::TabulatedOnGpu(const Simulation& simulation, const Plan& plan)
    : coefficients_(plan, (static_cast<int>(simulation.air->exponents().size()) + 3) / 4) {
  std::vector<float> block;
  for (double power : simulation.air->exponents()) block.push_back(static_cast<float>(power));
  block.resize((block.size() + 3) / 4 * 4, 1.0f);
  block_.upload(block);
}

void TabulatedOnGpu::addSlots(ShaderSlots& slots) const {
  slots.files["path"] = "atmosphere/tabulated.glsl";
  coefficients_.addSlots(slots);
}

void TabulatedOnGpu::bind() const {
  block_.bindUniform(3);
  coefficients_.bind();
}

}  // namespace pitviper
