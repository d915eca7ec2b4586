#include "sim/scene/geodesy.hpp"

#include <GeographicLib/Geocentric.hpp>
#include <cmath>
#include <vector>

namespace pitviper {
namespace {
constexpr double kDegrees = 57.29577951308232;

/// sqrt(M N): Gaussian radius of the ellipsoid, a sqrt(1 - e^2) / (1 - e^2 sin^2).
double gaussianRadius_m(double latitude_rad) {
  const double a = GeographicLib::Constants::WGS84_a(), f = GeographicLib::Constants::WGS84_f();
  const double e2 = f * (2.0 - f), s = std::sin(latitude_rad);
  return a * std::sqrt(1.0 - e2) / (1.0 - e2 * s * s);
}

}  // namespace

LocalFrame::LocalFrame(const Geodetic& origin, double ground_m, double refraction) : origin_(origin), ground_m_(ground_m), refraction_(refraction) {
  std::vector<double> m(9);
  GeographicLib::Geocentric::WGS84().Forward(origin.latitude_rad * kDegrees, origin.longitude_rad * kDegrees, origin.height_m, originEcef_.x, originEcef_.y,
                                             originEcef_.z, m);
  // GeographicLib gives the rotation row by row: columns are east, north and up in ECEF.
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) ecefFromLocal_[column][row] = m[static_cast<size_t>(3 * row + column)];
  earthRadius_m_ = gaussianRadius_m(origin.latitude_rad) / (1.0 - refraction) + ground_m;
}

double LocalFrame::lift(const glm::dvec3& local) const {
  return 0.5 * refraction_ / gaussianRadius_m(origin_.latitude_rad) * (local.x * local.x + local.y * local.y);
}

glm::dvec3 LocalFrame::toLocal(const Geodetic& g) const {
  glm::dvec3 x;
  GeographicLib::Geocentric::WGS84().Forward(g.latitude_rad * kDegrees, g.longitude_rad * kDegrees, g.height_m, x.x, x.y, x.z);
  return fromEcef(x);
}

glm::dvec3 LocalFrame::fromEcef(const glm::dvec3& ecef) const {
  const glm::dvec3 local = glm::transpose(ecefFromLocal_) * (ecef - originEcef_);
  return {local.x, local.y, local.z + lift(local)};
}

Geodetic LocalFrame::toGeodetic(const glm::dvec3& local) const {
  const glm::dvec3 x = toEcef(local);
  Geodetic g;
  GeographicLib::Geocentric::WGS84().Reverse(x.x, x.y, x.z, g.latitude_rad, g.longitude_rad, g.height_m);
  g.latitude_rad /= kDegrees;
  g.longitude_rad /= kDegrees;
  return g;
}

glm::dvec3 LocalFrame::toEcef(const glm::dvec3& local) const { return originEcef_ + ecefFromLocal_ * glm::dvec3(local.x, local.y, local.z - lift(local)); }

}  // namespace pitviper
