#pragma once
// What a lobe sends on of what comes from everywhere, for each view, split by an angle of the light.
#include <functional>
#include <vector>

#include "sim/model/component.hpp"

namespace pitviper {

/// View angles, equally spaced from 0 to 90 degrees.
constexpr int kShareViews = 91;

/// Of equally spaced entries from 0 to 90 degrees, from one on, in what a view angle sees.
struct AngleShares {
  std::size_t first = 0;
  std::vector<double> share;
  double sum() const;
  /// Of values at all entries.
  double of(const std::vector<double>& values) const;
};

/// Where directions are looked for: as half vectors whose slopes are distributed so, or alike all over the hemisphere, by the cosine.
enum class Sampled { Trowbridge, NormalSlopes, Cosine };

/// integral f(l, v) cos(theta_l) dw_l for each view, split among `entries` of `kind` (Incidence or Difference), linear between. `width`: of the slopes.
/// Relative error 1e-3 for an f that is no narrower than that.
std::vector<AngleShares> lobeShares(const std::function<double(const glm::dvec3& light, const glm::dvec3& view)>& f, Sampled sampled, double width, Angle kind,
                                    int entries);

/// Linear between equally spaced values from 0 to 90 degrees.
double byAngle(const std::vector<double>& values, double angle_rad);

}  // namespace pitviper
