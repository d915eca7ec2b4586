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
class LocalFrame {
 public:
  explicit LocalFrame(const Geodetic& origin = {});
  glm::dvec3 toLocal(const Geodetic& g) const;
  Geodetic toGeodetic(const glm::dvec3& local) const;
  glm::dvec3 toEcef(const glm::dvec3& local) const;
  /// Rotation that takes local directions to earth-centred, earth-fixed ones.
  const glm::dmat3& ecefFromLocal() const { return ecefFromLocal_; }
  const Geodetic& origin() const { return origin_; }
  /// Height above the ellipsoid [m] of a local position.
  double height(const glm::dvec3& local) const { return toGeodetic(local).height_m; }
  /// Gaussian radius of curvature at the origin [m]: the sphere that stands for the earth in path lengths.
  double earthRadius_m() const { return earthRadius_m_; }

 private:
  Geodetic origin_;
  glm::dmat3 ecefFromLocal_{1.0};
  glm::dvec3 originEcef_{0.0};
  double earthRadius_m_ = 6371000.0;
};

}  // namespace pitviper
