#pragma once
// What a reflection component sends to a view of light from all around: its kernel f cos(theta_l) in spherical harmonics, and what these can't hold as light
// from the mirrored direction.
//
// Law: L = rho_dh mean(L_in) + sum over l = 1..order, k of w_lk(view) L_l(a_k) + D(view) R_sigma(mirrored view), a_k in the plane of view; R_sigma: L_in less
// its harmonics, blurred by exp(kappa (cos - 1)), kappa = 1/sigma^2. D and sigma are those of D exp(-l (l + 1) sigma^2 / 2), which a blurred mirror has, that
// has two bands of the kernel's further degrees: rho and 0 of a mirror; of a matt surface D is nothing. Uniform light is exact.
// Source: Lindsay and Agu 2005, section 3 (T_lm by view), with Ramamoorthi and Hanrahan's convolution; the mirrored remainder is this project's own.
#include <memory>
#include <vector>

#include "sim/model/component.hpp"
#include "sim/radiometry/harmonics.hpp"

namespace pitviper {

/// Linear between its entries: places and weights of a reading of a component's column.
struct ColumnReading {
  std::array<std::size_t, 4> at{};
  std::array<double, 4> weight{};
};
/// Entries of a component's axes, the first runs fastest.
std::size_t columnEntries(const ReflectionComponent& component);
ColumnReading readColumn(const ReflectionComponent& component, const glm::dvec3& light, const glm::dvec3& view);
/// The column at all entries at a wavelength.
std::vector<double> columnsAt(const ReflectionComponent& component, double wavelength_um);

/// Degree by degree and direction by direction as planeWeightAt(), then D: a vec4 and three more. In the place of w_00, which is told by the reflectance,
/// stands D times the number of the blur, between those of kBlurs_rad.
constexpr int kResponses = kPlaneWeights + 1;
using Response = std::array<double, kResponses>;

constexpr std::array<double, 5> kBlurs_rad = {0.0, 0.035, 0.07, 0.14, 0.28};

class HarmonicResponse {
 public:
  /// For orders 2 to kMostHarmonicOrder: higher degrees have weights of 0.
  HarmonicResponse(const ReflectionComponent& component, int order);
  /// View angles, evenly from 0 to 90 deg; 1 where the kernel is the same for all.
  static constexpr int kViews = 91;
  int views() const { return static_cast<int>(weights_.size()); }
  /// For a column's values at its entries.
  Response at(int view, std::span<const double> columns) const;
  /// Is there anything but what depends on the normal alone?
  static bool isPlain(const ReflectionComponent& component);

 private:
  int order_;
  /// Of an entry: what Response has, of the two bands of degrees first and last; and its part of the reflectance.
  struct Weights {
    Response of{};
    double albedo = 0.0;
  };
  std::vector<std::vector<std::pair<std::size_t, Weights>>> weights_;  ///< by view: entries that it has something of
};

}  // namespace pitviper
