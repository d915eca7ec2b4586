#pragma once
// What flies without thrust or lift and may lose mass as it burns: flares, shells, debris.
#include <optional>
#include <vector>

#include "sim/flight/curve.hpp"
#include "sim/flight/flying_body.hpp"

namespace pitviper {

/// Mass: m(t) = m0 (1 - b (1 - (1 - (t - t0)/t_b)^n)) from ignition t0 for the burn time t_b, b the share that burns. n = 1: constant rate (end burner);
/// n = 3: a grain that shrinks on all sides at a constant rate (its volume goes with the cube of its length). What leaves takes no momentum along: no thrust.
struct BallisticOptions {
  double mass_kg = 0.0;
  double burntShare = 0.0;    ///< of the mass, 0 to 0.99: a body without mass would stop at once
  double ignition_s = 0.0;    ///< since launch
  double burnTime_s = 0.0;    ///< needed where a share burns
  double burnExponent = 1.0;  ///< n, 1 or more
  /// Drag: area and coefficient, or the ballistic coefficient m0/(C_D A) [kg/m2] at launch.
  double area_m2 = 0.0;
  std::vector<CurvePoint> drag;  ///< Mach number, drag coefficient
  std::optional<double> ballisticCoefficient_kg_m2;
  std::vector<CurvePoint> areaFactor;  ///< time since launch [s], factor on the area; straight between, held outside; none: 1
};

class Ballistic : public FlyingBody {
 public:
  /// Errors: FlightError naming the option.
  explicit Ballistic(BallisticOptions options);
  double mass_kg(double time_s) const override;
  double dragArea_m2(double time_s, double mach) const override;
  std::vector<double> breaks_s() const override;
  const BallisticOptions& options() const { return options_; }

 private:
  BallisticOptions options_;
};

}  // namespace pitviper
