#pragma once
#include <vector>

namespace pitviper {

/// Directional-hemispherical reflectance of the unit Phong lobe:
///   A(theta) = (n + 2) / (n + 1) / (2 pi) integral_0^1 dt integral dphi max(0, cos theta cos alpha + sin theta sin alpha cos phi),
/// t = cos^(n+1) alpha; the azimuth integral in closed form.
class PhongAlbedo {
 public:
  explicit PhongAlbedo(double exponent);
  double at(double theta) const;

 private:
  struct Ring {
    double cosine, sine, weight;
  };
  double factor_;
  std::vector<Ring> rings_;
};

}  // namespace pitviper
