#pragma once
// The contract of the air between two points. `none` is a model too.
#include <string>

namespace pitviper {

/// What a shader needs of the air at one wavelength.
struct PathNode {
  double extinction_per_m = 0.0;
  double sourceRadiance = 0.0;  ///< radiance the air tends to at great depth [W/(m2 sr um)]
};

class Path {
 public:
  virtual ~Path() = default;
  /// Shader file for the slot `path`.
  virtual std::string slotFile() const = 0;
  virtual bool isNone() const { return false; }
  virtual PathNode node(double wavelength_um) const = 0;
  /// Height of the air's top above the sphere that stands for the earth [m]; infinite where it has none.
  virtual double top_m() const = 0;
  /// Length of air [m] on a ray from a height, with the sine of its elevation there, as far as a range (may be infinite).
  virtual double airLength_m(double height_m, double sinElevation, double range_m, double earthRadius_m) const = 0;
  /// Transmittance of a length of air, 0..1.
  virtual double transmittance(double wavelength_um, double airLength_m) const = 0;
  /// Path radiance seen from one end [W/(m2 sr um)].
  virtual double radiance(double wavelength_um, double airLength_m) const = 0;
  virtual double validLow_um() const = 0;
  virtual double validHigh_um() const = 0;
};

}  // namespace pitviper
