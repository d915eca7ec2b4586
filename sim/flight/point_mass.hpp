#pragma once
// A vehicle as a point mass: thrust over time, the mass it costs, drag by Mach number, lift within limits.
#include <limits>
#include <optional>
#include <vector>

#include "sim/flight/curve.hpp"
#include "sim/flight/flying_body.hpp"

namespace pitviper {

struct PointMassOptions {
  double launchMass_kg = 0.0;      ///< with propellant
  std::vector<CurvePoint> thrust;  ///< time since launch [s], thrust [N]; straight between, 0 before the first and after the last
  /// Burnt in proportion to thrust. Give one: the mass, or the specific impulse [s] (mass = total impulse / (I_sp 9.80665 m/s2)); neither: mass stays.
  std::optional<double> propellantMass_kg, specificImpulse_s;
  double referenceArea_m2 = 0.0;
  std::vector<CurvePoint> drag;                                    ///< Mach number, drag coefficient; straight between, held outside; none: no drag
  double mostLateral_g = std::numeric_limits<double>::infinity();  ///< what structure or autopilot allow, in units of 9.80665 m/s2
  std::optional<double> mostLiftCoefficient;                       ///< what the air gives: q S C_L,max / m; absent: no such limit
};

class PointMass : public FlyingBody {
 public:
  /// Errors: FlightError naming the option (mass not above 0, more propellant than mass, tables that go back, ...).
  explicit PointMass(PointMassOptions options);
  double mass_kg(double time_s) const override;
  double dragArea_m2(double time_s, double mach) const override;
  double thrust_N(double time_s, double within_s) const override;
  double mostLateral_m_s2(double time_s, double dynamicPressure_Pa) const override;
  std::vector<double> breaks_s() const override;
  double totalImpulse_Ns() const { return impulse_.empty() ? 0.0 : impulse_.back(); }
  double propellantMass_kg() const { return propellant_kg_; }
  const PointMassOptions& options() const { return options_; }

 private:
  PointMassOptions options_;
  std::vector<double> impulse_;  ///< until each point of thrust [N s]
  double propellant_kg_ = 0.0;
};

}  // namespace pitviper
