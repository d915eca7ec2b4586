#pragma once
// Air from tables as the shader reads it (atmosphere/tabulated.glsl): exponents and every node's coefficients, once for a plan.
#include "sim/gl/objects.hpp"
#include "sim/gl/shader_assembler.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

class PathBlock {
 public:
  /// Throws GlError where the coefficients do not fit into a uniform block.
  PathBlock(const Simulation& simulation, const Plan& plan, bool wanted = true);
  /// Nothing to do for air of another kind.
  bool isNeeded() const { return vectors_ > 0; }
  void addConstants(ShaderSlots& slots) const;
  void bind() const;

 private:
  int vectors_ = 0;  ///< four exponents each
  Buffer block_;
};

}  // namespace pitviper
