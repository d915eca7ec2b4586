#include "sim/render/path_block.hpp"

#include "sim/render/scene_pass.hpp"

namespace pitviper {

PathBlock::PathBlock(const Simulation& simulation, const Plan& plan, bool wanted) {
  if (!wanted || !plan.terms.air || !simulation.path->isTabulated()) return;
  const auto powers = simulation.path->exponents();
  vectors_ = (static_cast<int>(powers.size()) + 3) / 4;
  std::vector<float> block;
  for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) block.push_back(k < powers.size() ? static_cast<float>(powers[k]) : 1.0f);
  for (const SpectralNode& n : plan.nodes)
    for (size_t k = 0; k < static_cast<size_t>(4 * vectors_); ++k) block.push_back(static_cast<float>(n.air.extinction[k]));
  checkUniformSize(block.size() * sizeof(float), "the air's coefficients");
  block_.upload(block);
}

void PathBlock::addConstants(ShaderSlots& slots) const {
  if (isNeeded()) slots.constants["AIR_VECTORS"] = vectors_;
}

void PathBlock::bind() const {
  if (isNeeded()) block_.bindUniform(3);
}

}  // namespace pitviper
