#include "sim/flight/point_mass.hpp"

#include <algorithm>
#include <cmath>

#include "sim/flight/flight_error.hpp"
#include "sim/scene/gravity.hpp"

namespace pitviper {

PointMass::PointMass(PointMassOptions options) : options_(std::move(options)) {
  const PointMassOptions& o = options_;
  checkFlight(std::isfinite(o.launchMass_kg) && o.launchMass_kg > 0.0, "mass", o.launchMass_kg, "a mass above 0", "give the mass at launch");
  checkFlight(std::isfinite(o.referenceArea_m2) && o.referenceArea_m2 >= 0.0, "area", o.referenceArea_m2, "an area", "give that of the cross-section");
  checkFlight(o.mostLateral_g >= 0.0, "g_limit", o.mostLateral_g, "0 or more", "give the limit as a positive number");
  if (o.mostLiftCoefficient)
    checkFlight(std::isfinite(*o.mostLiftCoefficient) && *o.mostLiftCoefficient >= 0.0, "lift_coefficient", *o.mostLiftCoefficient, "0 or more",
                "give the limit as a positive number");
  checkCurve("thrust", o.thrust);
  checkCurve("drag", o.drag);
  double sum = 0.0;
  for (std::size_t i = 0; i < o.thrust.size(); ++i) {
    if (i > 0) sum += 0.5 * (o.thrust[i].y + o.thrust[i - 1].y) * (o.thrust[i].x - o.thrust[i - 1].x);
    impulse_.push_back(sum);
  }
  if (o.propellantMass_kg && o.specificImpulse_s) throw FlightError("propellant", "given with a specific impulse", "one of them", "leave one out");
  if (o.propellantMass_kg) propellant_kg_ = *o.propellantMass_kg;
  if (o.specificImpulse_s) {
    checkFlight(std::isfinite(*o.specificImpulse_s) && *o.specificImpulse_s > 0.0, "specific_impulse", *o.specificImpulse_s, "a time above 0",
                "solid motors have 200 to 270 s");
    propellant_kg_ = sum / (*o.specificImpulse_s * kStandardGravity);
  }
  checkFlight(std::isfinite(propellant_kg_) && propellant_kg_ >= 0.0, "propellant", propellant_kg_, "0 or more", "correct it");
  checkFlight(propellant_kg_ < o.launchMass_kg, "propellant", propellant_kg_, "less than the mass at launch", "the mass at launch includes the propellant");
  if (propellant_kg_ > 0.0 && !(sum > 0.0)) throw FlightError("propellant", "propellant without thrust", "a table of thrust", "give thrust over time");
}

double PointMass::thrust_N(double time_s, double within_s) const {
  const auto& all = options_.thrust;
  if (all.size() < 2 || within_s < all.front().x || within_s > all.back().x) return 0.0;
  return curveAt(all, time_s);
}

double PointMass::mass_kg(double time_s) const {
  const auto& all = options_.thrust;
  if (propellant_kg_ == 0.0 || time_s <= all.front().x) return options_.launchMass_kg;
  if (time_s >= all.back().x) return options_.launchMass_kg - propellant_kg_;
  const auto next = std::upper_bound(all.begin(), all.end(), time_s, [](double t, const CurvePoint& p) { return t < p.x; });
  const auto i = static_cast<std::size_t>(next - all.begin()) - 1;
  const double impulse = impulse_[i] + 0.5 * (all[i].y + curveAt(all, time_s)) * (time_s - all[i].x);
  return options_.launchMass_kg - propellant_kg_ * impulse / impulse_.back();
}

double PointMass::dragArea_m2(double /*time_s*/, double mach) const { return options_.referenceArea_m2 * curveAt(options_.drag, mach); }

double PointMass::mostLateral_m_s2(double time_s, double dynamicPressure_Pa) const {
  const double structure = options_.mostLateral_g * kStandardGravity;
  if (!options_.mostLiftCoefficient) return structure;
  return std::min(structure, dynamicPressure_Pa * options_.referenceArea_m2 * *options_.mostLiftCoefficient / mass_kg(time_s));
}

std::vector<double> PointMass::breaks_s() const {
  std::vector<double> times;
  for (const CurvePoint& p : options_.thrust) times.push_back(p.x);
  return times;
}

}  // namespace pitviper
