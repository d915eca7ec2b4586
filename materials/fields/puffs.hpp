#pragma once
// A field made of puffs: soft ellipsoids of gas, whose column along any part of a line is known in closed form (materials/fields/glsl/puff.glsl).
#include <array>
#include <vector>

#include "sim/model/field.hpp"

namespace pitviper {

/// Gases of a puff at most: one texel.
constexpr int kMostPuffGases = 4;
/// C of the kernel: the integral of C (1 - s^2)^3 over the unit ball is 1.
constexpr double kPuffNorm = 315.0 / (64.0 * 3.14159265358979323846);
/// Support over the standard deviation along any axis: the kernel's variance is R^2/11.
constexpr double kPuffSupport = 3.3166247903553998;

struct Puff {
  glm::dvec3 centre{0.0};                       ///< local frame
  double radius_m = 1.0;                        ///< of its support, across the axis
  double halfLength_m = 0.0;                    ///< of its support along the axis; 0: as across
  glm::dvec3 axis{1.0, 0.0, 0.0};               ///< unit
  std::array<double, kMostPuffGases> amount{};  ///< of each gas in all of it
  double temperature_K = 288.15, gain = 1.0, sun = 0.0, sunAmount = 0.0;
  double length_m() const { return halfLength_m > 0.0 ? halfLength_m : radius_m; }
};

/// Amount of a puff's gas along a part of a line, per unit of its amount [1/m2]: the integral of its density. `direction` is of unit length.
double puffColumn(const Puff& puff, const glm::dvec3& origin, const glm::dvec3& direction, double from_m, double to_m);
/// Gives each puff the column of all of them between its centre and the sun, of the first gas.
void shadeTowards(const glm::dvec3& toSun, std::vector<Puff>& puffs);

class PuffsState : public FieldState {
 public:
  /// Its axes are the local frame's, moved to the first puff. One puff or more, radii above 0.
  explicit PuffsState(std::vector<Puff> puffs);
  /// Equal parts of what lies between the first puff that the line meets and the last, each a quarter of finest_m or longer; none that holds nothing. Where
  /// puffs of different temperatures share one, each temperature is a step of its own on the same stretch.
  void along(const FieldLine& line, int steps, std::vector<FieldStep>& out) const override;
  const std::vector<Puff>& puffs() const { return puffs_; }

 private:
  std::vector<Puff> puffs_;
};

/// The file for the slot `field`.
constexpr const char* kPuffsShader = "materials/fields/glsl/puffs.field.glsl";

}  // namespace pitviper
