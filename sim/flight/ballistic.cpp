#include "sim/flight/ballistic.hpp"

#include <algorithm>
#include <cmath>

#include "sim/flight/flight_error.hpp"

namespace pitviper {

Ballistic::Ballistic(BallisticOptions options) : options_(std::move(options)) {
  const BallisticOptions& o = options_;
  checkFlight(std::isfinite(o.mass_kg) && o.mass_kg > 0.0, "mass", o.mass_kg, "a mass above 0", "give the mass at launch");
  checkFlight(o.burntShare >= 0.0 && o.burntShare <= 0.99, "burnt_share", o.burntShare, "0 to 0.99", "leave some mass: a case or ash");
  checkFlight(std::isfinite(o.ignition_s) && o.ignition_s >= 0.0, "ignition", o.ignition_s, "a time since launch", "give 0 or more");
  checkFlight(std::isfinite(o.burnTime_s) && o.burnTime_s >= 0.0 && (o.burntShare == 0.0 || o.burnTime_s > 0.0), "burn_time", o.burnTime_s, "a time above 0",
              "say how long it burns");
  checkFlight(std::isfinite(o.burnExponent) && o.burnExponent >= 1.0, "burn_exponent", o.burnExponent, "1 or more", "1 burns evenly, 3 as a shrinking grain");
  checkFlight(std::isfinite(o.area_m2) && o.area_m2 >= 0.0, "area", o.area_m2, "an area", "give that of the cross-section");
  checkCurve("drag", o.drag);
  checkCurve("area_factor", o.areaFactor);
  if (o.ballisticCoefficient_kg_m2) {
    checkFlight(std::isfinite(*o.ballisticCoefficient_kg_m2) && *o.ballisticCoefficient_kg_m2 > 0.0, "ballistic_coefficient", *o.ballisticCoefficient_kg_m2,
                "a number above 0", "it is mass / (drag coefficient x area)");
    if (o.area_m2 > 0.0 || !o.drag.empty())
      throw FlightError("ballistic_coefficient", "given with an area or a drag coefficient", "one way to give drag", "leave one out");
  }
}

double Ballistic::mass_kg(double time_s) const {
  if (options_.burntShare == 0.0) return options_.mass_kg;
  const double left = 1.0 - std::clamp((time_s - options_.ignition_s) / options_.burnTime_s, 0.0, 1.0);
  return options_.mass_kg * (1.0 - options_.burntShare * (1.0 - std::pow(left, options_.burnExponent)));
}

double Ballistic::dragArea_m2(double time_s, double mach) const {
  const double still =
      options_.ballisticCoefficient_kg_m2 ? options_.mass_kg / *options_.ballisticCoefficient_kg_m2 : options_.area_m2 * curveAt(options_.drag, mach);
  return still * curveAt(options_.areaFactor, time_s, 1.0);
}

std::vector<double> Ballistic::breaks_s() const {
  std::vector<double> times;
  if (options_.burntShare > 0.0) times = {options_.ignition_s, options_.ignition_s + options_.burnTime_s};
  for (const CurvePoint& p : options_.areaFactor) times.push_back(p.x);
  return times;
}

}  // namespace pitviper
