#pragma once
// Extinction coefficients of a plan's nodes as shaders read them: airExtinction(node * AIR_VECTORS + vector).
#include "sim/gl/objects.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

class CoefficientsOnGpu {
 public:
  /// `vectors`: of four absorbers each.
  CoefficientsOnGpu(const Plan& plan, int vectors);
  void addSlots(ShaderSlots& slots) const;
  void bind() const;

 private:
  int vectors_;
  Buffer block_;
};

}  // namespace pitviper
