#pragma once
// The contract of a reflection component: BRDF(lambda, l, v) = column(lambda; up to two angles) x lobe(l, v), times the
// modifier texture of the surface. Source: Duvenhage 2006, sections 4.2 and 5.2.
#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "sim/parameters/fingerprint.hpp"

namespace pitviper {

/// Angles a table can run over [rad]: incidence and view from the normal, specular between view and mirrored light direction, half
/// between normal and half vector, difference between light and half vector; root: sqrt(half x 90 deg), whose even steps crowd about the mirrored direction.
enum class Angle { None = 0, Incidence = 1, View = 2, Specular = 3, Half = 4, Difference = 5, HalfRoot = 6 };
/// The half angle of a root of it, and back.
double halfOfRoot(double root_rad);
double rootOfHalf(double half_rad);

/// Unit vectors towards the light and the viewer in a frame whose z is the normal, and the angle of a kind between them.
double angleBetween(Angle kind, const glm::dvec3& light, const glm::dvec3& view);

/// `count` entries equally spaced from 0 to `last_rad`; count is 1 for Angle::None.
struct AngleAxis {
  Angle angle = Angle::None;
  int count = 1;
  double last_rad = 0.0;
  double at(int entry) const { return count > 1 ? last_rad * entry / (count - 1) : 0.0; }
};

/// A direction of light, its angles on the axes asked for, and its share of an integral over the hemisphere.
struct LightSample {
  glm::dvec3 light;
  double weight;
  std::array<double, 2> angle;
};

/// integral f(l) cos(theta_l) dw_l over the hemisphere = sum of weight f(light) over the visited samples, for an f that is smooth between
/// the entries of the axes and the same on both sides of the plane of view (x z; the viewer at sin, 0, cos of the view angle).
/// Polar coordinates about the direction that an axis is measured from, Gauss points between all entries of both axes and the horizon: a
/// lobe as narrow as its table counts in full. Relative error below 1e-5 for one axis, 1e-3 for two. `azimuths`: so many even pieces, at least, of half a turn
/// about the pole, for an f that bends at azimuths.
void integrateHemisphere(const std::array<AngleAxis, 2>& axes, double viewAngle_rad, const std::function<void(const LightSample&)>& visit, int azimuths = 1);

/// The part of a component that is a formula of directions: one .glsl body, float on the GPU, double in C++.
struct Lobe {
  std::string file;            ///< shader file with the body; empty: there is none, it is 1
  std::string function;        ///< PHYSICS Real function(Vec4 parameters, Vec3 normal, Vec3 toLight, Vec3 toViewer), of a name of its own
  glm::dvec4 parameters{0.0};  ///< what it takes
  double maximum = 1.0;        ///< the greatest that it can be
  double exponent = 0.0;  ///< of the cosine of the angle to the mirrored direction that is as narrow: how finely its integral and its glints are looked for
};

class ReflectionComponent {
 public:
  explicit ReflectionComponent(Lobe lobe = {}) : lobe_(std::move(lobe)) {}
  virtual ~ReflectionComponent() = default;
  /// The table part [1/sr where the lobe is 1].
  virtual double column(double wavelength_um, double angle1_rad, double angle2_rad) const = 0;
  virtual std::array<AngleAxis, 2> axes() const { return {}; }
  const Lobe& lobe() const { return lobe_; }
  /// Of reading column() linearly between the entries of its axes: the largest found, of what a mirror returns; 0 where it is such a table itself.
  virtual double angleError() const { return 0.0; }
  /// The lobe's value for directions in a frame whose z is the normal.
  virtual double lobeAt(const glm::dvec3& light, const glm::dvec3& view) const;
  /// Directional-hemispherical reflectance for a view angle: integral of BRDF cos(theta_l) over the hemisphere.
  virtual double hemispherical(double wavelength_um, double viewAngle_rad) const;
  /// Axes by which an integral over all light, for a view, finds a lobe as narrow as this one's; `bends`: and where its column bends under the lobe.
  virtual std::array<AngleAxis, 2> integrationAxes(bool bends = true) const;
  /// The whole BRDF [1/sr].
  double brdf(double wavelength_um, const glm::dvec3& light, const glm::dvec3& view) const;
  /// True where hemispherical() changes with the view angle.
  virtual bool hemisphericalVaries() const = 0;
  /// Wavelengths at which it bends or jumps, rising [um].
  virtual std::vector<double> knots_um() const = 0;
  virtual double validLow_um() const = 0;
  virtual double validHigh_um() const = 0;
  /// All that it depends on: the values of its model's parameters, whole. Empty where it was not read from any.
  const std::string& fingerprint() const { return fingerprint_; }
  void setFingerprint(std::string bytes) { fingerprint_ = std::move(bytes); }

 private:
  Lobe lobe_;
  std::string fingerprint_;
};

}  // namespace pitviper
