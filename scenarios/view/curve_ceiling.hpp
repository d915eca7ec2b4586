#pragma once
// The most that a curve may be at each wavelength, where several share what is 1 together.
#include <functional>
#include <vector>

#include "scenarios/view/edited_curve.hpp"

namespace pitviper {

/// What 1 leaves a curve beside others. All are piecewise linear: what holds where they bend holds everywhere. Their lower bounds are 0.
class CurveCeiling {
 public:
  explicit CurveCeiling(const std::vector<const EditedCurve*>& others);
  /// Beside none: no ceiling.
  CurveCeiling() = default;

  bool allows(const EditedCurve& curve) const;
  /// Points lowered where it is above: those next to where it is; where that does not do, all by one factor.
  EditedCurve under(EditedCurve curve) const;
  /// made(1), or of what made(0) .. made(1) give the furthest found by halving that is allowed; made(0), where that is not allowed either.
  EditedCurve furthest(const std::function<EditedCurve(double)>& made) const;

 private:
  /// Visits every wavelength at which the curve or the ceiling bends, with how far the curve is above there.
  template <class Visit>
  void visit(const EditedCurve& curve, const Visit& visit) const;
  bool none_ = true;
  std::vector<double> wavelength_um_, left_;  ///< held outside
};

}  // namespace pitviper
