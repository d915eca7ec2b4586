#pragma once
// What the integrator asks of a body in flight.
#include <vector>

namespace pitviper {

class FlyingBody {
 public:
  virtual ~FlyingBody() = default;
  // Times are since launch.
  virtual double mass_kg(double time_s) const = 0;
  /// Drag coefficient times reference area.
  virtual double dragArea_m2(double time_s, double mach) const = 0;
  /// Along the flight. `within` is a time inside the step that is asked for: where thrust jumps, it tells which side is meant.
  virtual double thrust_N(double /*time_s*/, double /*within_s*/) const { return 0.0; }
  /// What lift can do across the flight [m/s2].
  virtual double mostLateral_m_s2(double /*time_s*/, double /*dynamicPressure_Pa*/) const { return 0.0; }
  /// Times at which one of these bends or jumps: steps end there, which keeps their order.
  virtual std::vector<double> breaks_s() const { return {}; }
};

}  // namespace pitviper
