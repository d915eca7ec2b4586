#pragma once
// Air that says how it bends light.
#include <memory>
#include <optional>

#include "sim/model/atmosphere.hpp"

namespace pitviper {

/// Mean k = -R dn/dh of the lowest kilometre of the US Standard Atmosphere 1976 in visible light: for air that does not say its own.
constexpr double kStandardRefraction = 0.163;

class Refracts {
 public:
  virtual ~Refracts() = default;
  /// k over the kilometre above a height; none: this air does not say.
  virtual std::optional<double> refractionCoefficient(double height_m) const = 0;
  /// By how much light from space is turned on its way to a height where it comes from an apparent elevation [rad]: for elevations below those that the earth
  /// leaves free, what it is for the lowest of these. `earthRadius_m` is the real one. Only where refractionCoefficient() says something.
  virtual double bending_rad(double height_m, double sinElevation, double earthRadius_m) const = 0;
  /// This air with lines that bend, for geometry over an earth of radius 1 / (1 - coefficient); null: it has ducts, in which light does not leave.
  virtual std::shared_ptr<const Atmosphere> bent(double coefficient) const = 0;
  virtual bool bends() const = 0;
  /// The height at which lines that bend are straight instead of a real one, and back [m].
  virtual double straightened_m(double height_m) const = 0;
  virtual double bentBack_m(double straightened_m) const = 0;
};

}  // namespace pitviper
