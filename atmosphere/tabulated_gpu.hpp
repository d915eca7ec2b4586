#pragma once
// Air from tables as the shader reads it (atmosphere/tabulated.glsl): exponents and every node's coefficients, once for a plan.
#include "atmosphere/coefficients_gpu.hpp"
#include "sim/gl/objects.hpp"
#include "sim/plan/plan.hpp"
#include "sim/render/assembly/air_on_gpu.hpp"

namespace pitviper {

class TabulatedOnGpu final : public AirOnGpu {
 public:
  /// Throws GlError where the coefficients do not fit into a uniform block.
  TabulatedOnGpu(const Simulation& simulation, const Plan& plan);
  void addSlots(ShaderSlots& slots) const override;
  void bind() const override;

 private:
  CoefficientsOnGpu coefficients_;
  Buffer block_;
};

}  // namespace pitviper
