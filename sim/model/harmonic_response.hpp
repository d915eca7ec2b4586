#pragma once
// What a reflection component sends to a view of light from all around: its kernel f cos(theta_l) in spherical harmonics, and what these can't hold as light
// from the mirrored direction.
//
// Law: L = rho_dh mean(L_in) + sum over l = 1..order, k of w_lk(view) L_l(a_k) + D(view) R(aim), a_k in the plane of view.
//
// R is L_in less its harmonics up to the order, blurred by exp((cos - 1) / sigma^2). A lobe is told as one of Gauss about its aim, in the plane of
// view near the mirrored direction, of variance v (1 + s) along that plane and v (1 - s) across [rad2]. Of its further degrees' moments J_m(k r)
// cos(m psi), k^2 = l (l + 1), for which Wigner's d^l_m0 stand on the sphere:
//   J_1's is 0 at the aim; J_2's over J_0's is I_1(z) / I_0(z), z = s v k^2 / 2; J_0's is D exp(-v k^2 / 2) I_0(z), and two bands tell D and v.
// Light of the open changes with elevation above all: sigma^2 is v (1 + s cos(2 psi)), psi from the plane of view to the vertical at the aim.
//
// Of sharp lobes, whose v is next to nothing beside 1 / (l (l + 1)), R is the blurred light itself less its mean, and w_lk leaves out what R then has
// of degree l, D exp(-l (l + 1) v / 2): R is read between directions, where harmonics bend more than light does.
//
// Uniform light is exact; of a matt surface D is nothing. Lobes of other shapes (cut off by the surface, with long tails) are what is lost.
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
/// stands D times the number of the blur.
constexpr int kResponses = kPlaneWeights + 1;
using Response = std::array<double, kResponses>;

/// Blurs by number: none, then variances from this on that double.
constexpr double kFirstBlur_rad = 0.005;
constexpr int kBlurs = 14;
double blurOf_rad(int number);
double blurNumber(double variance);

class HarmonicResponse {
 public:
  /// For orders 2 to kMostHarmonicOrder: higher degrees have weights of 0. Aims are those of `usual`, values of a column.
  HarmonicResponse(const ReflectionComponent& component, int order, std::span<const double> usual);
  /// View angles, evenly from 0 to 90 deg; 1 where the kernel is the same for all.
  static constexpr int kViews = 91;
  int views() const { return static_cast<int>(weights_.size()); }
  /// For a column's values at its entries. `sharp`: R is to be the light itself; else what harmonics leave, which any lobe can be told by.
  Response at(int view, std::span<const double> columns, bool sharp) const;
  struct Aim {
    double tilt_rad = 0.0;  ///< from the mirrored direction towards the normal
    double stretch = 0.0;   ///< s
    int band = 0;           ///< of degrees, by which its blur is told
    double variance = 0.0;  ///< v
  };
  const Aim& aim(int view) const { return aims_[static_cast<std::size_t>(view)]; }
  /// May R of its lobe, where it has one, be the light itself?
  bool isSharp() const { return isSharp_; }
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
  std::vector<Aim> aims_;
  std::vector<std::array<double, kPlaneWeights>> zonal_;  ///< by view: plane weights of 1 in each degree about the aim
  bool isSharp_ = false;
};

/// Where a lobe is aimed at, and how much further on the number of its blur is for light that changes along the vertical (z).
struct AimedLobe {
  glm::dvec3 direction;
  double further;
};
/// `across`: the view's part along the surface, of length 1.
AimedLobe aimedAt(const HarmonicResponse::Aim& aim, double viewAngle_rad, const glm::dvec3& normal, const glm::dvec3& across);

}  // namespace pitviper
