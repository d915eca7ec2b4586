#pragma once
// Extinction coefficients of a plan's nodes as shaders read them: airExtinction(node * AIR_VECTORS + vector).
#include <optional>

#include "sim/gl/objects.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

class CoefficientsOnGpu {
 public:
  /// `vectors`: of four absorbers each. `most`: amounts, raised to their powers, that no way through the air exceeds; coefficients that together add less to a
  /// depth of these than budget::kThinAbsorbers are 0; empty: none is.
  CoefficientsOnGpu(const Plan& plan, int vectors, const std::optional<AirAmounts>& most = {});
  void addSlots(ShaderSlots& slots) const;
  void bind() const;

 private:
  int vectors_;
  std::vector<float> numbers_;
  Buffer block_;
};

}  // namespace pitviper
