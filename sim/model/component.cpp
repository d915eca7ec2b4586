#include "sim/model/component.hpp"

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {

double angleBetween(Angle kind, const glm::dvec3& l, const glm::dvec3& v) {
  auto between = [](const glm::dvec3& a, const glm::dvec3& b) { return 2.0 * std::asin(std::min(1.0, 0.5 * glm::length(a - b))); };
  const glm::dvec3 n(0, 0, 1);
  switch (kind) {
    case Angle::None: return 0.0;
    case Angle::Incidence: return between(n, l);
    case Angle::View: return between(n, v);
    case Angle::Specular: return between(glm::dvec3(-l.x, -l.y, l.z), v);
    case Angle::Half: return between(n, glm::normalize(l + v));
    case Angle::Difference: return between(l, glm::normalize(l + v));
  }
  return 0.0;
}

double ReflectionComponent::lobe(const glm::dvec3&, const glm::dvec3&) const { return 1.0; }

double ReflectionComponent::brdf(double wavelength_um, const glm::dvec3& l, const glm::dvec3& v) const {
  const auto a = axes();
  return column(wavelength_um, angleBetween(a[0].angle, l, v), angleBetween(a[1].angle, l, v)) * lobe(l, v);
}

double ReflectionComponent::hemispherical(double wavelength_um, double viewAngle_rad) const {
  // Product rule over the hemisphere: Gauss-Legendre in cos^2(theta) (which absorbs cos sin), midpoint in azimuth.
  static const auto polar = gaussLegendre(48, 0.0, 1.0);
  const int azimuths = 64;
  const glm::dvec3 view(std::sin(viewAngle_rad), 0.0, std::cos(viewAngle_rad));
  double sum = 0.0;
  for (const auto& p : polar) {
    const double c = std::sqrt(p.x), s = std::sqrt(1.0 - p.x);
    for (int i = 0; i < azimuths; ++i) {
      const double phi = 2.0 * kPi * (i + 0.5) / azimuths;
      sum += p.weight * brdf(wavelength_um, {s * std::cos(phi), s * std::sin(phi), c}, view);
    }
  }
  return sum * kPi / azimuths;
}

}  // namespace pitviper
