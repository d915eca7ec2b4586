#pragma once
// Earth: WGS 84 geodetic positions and the local east-north-up frame of a scenario. The only user of GeographicLib.
#include <glm/glm.hpp>
#include <memory>

namespace pitviper {

struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double height_m = 0.0;  ///< above the ellipsoid
};

/// East-north-up frame at an origin on the WGS 84 ellipsoid. Positions in metres, double precision.
///
/// Refraction: with a coefficient k = -R dn/dh light bends as if it went straight over an earth of radius R / (1 - k). Local positions are those of the
/// picture: of that earth, whose far things stand higher by k d^2 / (2 R) than they do; geodetic and earth-centred ones are the real ones. Source: Gauss's
/// coefficient, as in Torge and Mueller 2012, Geodesy (terrestrial refraction). Valid: eye and things well below 8 km, over which k falls off, and distances of
/// at most some hundred kilometres; on the ground k is 0.13 to 0.25 by day and night, and beyond over heated or cooled ground.
class LocalFrame {
 public:
  /// `ground_m`: height of the ground above the ellipsoid; `refraction`: k.
  explicit LocalFrame(const Geodetic& origin = {}, double ground_m = 0.0, double refraction = 0.0);
  glm::dvec3 toLocal(const Geodetic& g) const;
  Geodetic toGeodetic(const glm::dvec3& local) const;
  glm::dvec3 toEcef(const glm::dvec3& local) const;
  glm::dvec3 fromEcef(const glm::dvec3& ecef) const;
  /// Rotation that takes local directions to earth-centred, earth-fixed ones.
  const glm::dmat3& ecefFromLocal() const { return ecefFromLocal_; }
  const Geodetic& origin() const { return origin_; }
  /// Radius of the sphere that stands for the earth in path lengths: the Gaussian radius of curvature at the origin, and the ground's height [m]. It touches
  /// the ground below the origin; 100 km away they differ by less than 3 m in height.
  /// Refraction makes it 1 / (1 - k) times as long.
  double earthRadius_m() const { return earthRadius_m_; }
  double refraction() const { return refraction_; }
  /// Height above that sphere [m], and the unit vector away from its centre.
  double height(const glm::dvec3& local) const { return glm::length(fromCentre(local)) - earthRadius_m_; }
  double ground_m() const { return ground_m_; }
  /// Height above the sea [m].
  double altitude(const glm::dvec3& local) const { return height(local) + ground_m_; }
  glm::dvec3 up(const glm::dvec3& local) const { return glm::normalize(fromCentre(local)); }

 private:
  glm::dvec3 fromCentre(const glm::dvec3& local) const { return local + glm::dvec3(0.0, 0.0, earthRadius_m_ - ground_m_ + origin_.height_m); }
  /// How much higher things stand in the picture [m].
  double lift(const glm::dvec3& local) const;
  Geodetic origin_;
  glm::dmat3 ecefFromLocal_{1.0};
  glm::dvec3 originEcef_{0.0};
  double earthRadius_m_ = 6371000.0, ground_m_ = 0.0, refraction_ = 0.0;
};

}  // namespace pitviper
