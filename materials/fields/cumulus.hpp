#pragma once
// Seeded cumulus: the shape of a cloud as extinction in space, a grid of it, and where the clouds of a field stand.
//
// Shape: a union of upright turrets with round tops on a flat base, the tallest near the axis, carved by billows (humps and sharp creases) that grow with
//   height; all noise is of an integer hash, so that a seed gives the same cloud on every machine.
// Water: liquid water grows with height z above the base as the adiabatic lapse times what mixing leaves of it, 0.6 x 2e-6 kg/m4; inside it varies as
//   exp(noise) with the k^-5/3 spectrum that aircraft find, and thins out over the edge (fewer drops, not smaller ones).
//   Effective radius r = (3 q / (4 pi 1000 kg/m3 x 0.8 N))^(1/3), N = 200 /cm3: 4.5, 7.1, 9.6, 11.7 um at 50, 200, 500, 900 m.
//   Extinction at 0.55 um: 1.5 q / (1000 kg/m3 x r): an efficiency of 2.
// Field: widths D by N(D) ~ D^-1.9 exp(-D / 1000 m), placed without overlap, the largest first, until the cover is met.
// Source: H. R. Barker, J. A. Davies, Remote Sens. Environ. 42 (1992) 51: optical depth of fields of cumulus has a spectrum of about k^-3 below 5 km (these:
//   -2.8, of fields with cover 0.1 to 0.5). The size distribution and the lapse: usual values, chosen.
// Valid: widths of 100 m to 5 km; no anvils, no layers of stratus.
#include <cstdint>

#include "materials/fields/density_grid.hpp"

namespace pitviper {

/// -1 to 1.
double valueNoise(const glm::dvec3& p, std::uint32_t seed);

struct CumulusShapeOptions {
  double width_m = 1500.0, depth_m = 1000.0;
  double roughness = 0.5;  ///< 0 smooth to 1 ragged
  std::uint32_t seed = 1;
};

/// Its base lies in z = 0, its axis in x = y = 0.
class CumulusShape {
 public:
  explicit CumulusShape(const CumulusShapeOptions& options);
  /// [1/m] at 0.55 um.
  double extinction(const glm::dvec3& p) const;
  double column(double x, double y, int steps) const;    ///< vertical optical depth
  double halfExtent_m() const { return halfExtent_m_; }  ///< nothing lies farther from the axis

 private:
  struct Turret {
    double x, y, radius, top;
  };
  double fill(const glm::dvec3& p) const;

  CumulusShapeOptions o_;
  std::vector<Turret> turrets_;
  double halfExtent_m_ = 0.0;
};

/// `across`: nodes along x and y; along z about as far apart. Without values.
DensityGrid cumulusFrame(const CumulusShapeOptions& options, int across);
/// With them. `mostDepth`: its largest vertical optical depth; 0: as its water has it. The outermost nodes are empty.
DensityGrid cumulusGrid(const CumulusShapeOptions& options, int across, double mostDepth);

struct CumulusFieldOptions {
  double side_m = 10000.0;
  double cover = 0.3;  ///< wanted, seen from above
  double narrowest_m = 400.0, widest_m = 3000.0;
  double roughness = 0.5;
  int most = 64;   ///< clouds
  int shapes = 6;  ///< different ones
  std::uint32_t seed = 1;
};

struct CumulusField {
  std::vector<CumulusShapeOptions> shapes;
  struct Place {
    int shape = 0;
    glm::dvec2 at{0.0};  ///< from the middle of the square [m]
  };
  std::vector<Place> clouds;
  double cover = 0.0;  ///< share of the square under an optical depth of 0.3 at least: less than was wanted where `most` were too few
};
/// Always the same of the same options.
CumulusField cumulusField(const CumulusFieldOptions& options);

}  // namespace pitviper
