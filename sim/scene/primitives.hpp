#pragma once
// Simple shapes. Metres, body axes (x forward, y left, z up); each has one part, "all", unit outward normals, uv in
// 0..1 and triangles counter-clockwise seen from outside. Arguments out of range (sizes that are not finite and
// positive, too few segments, more than 2e7 triangles) throw std::invalid_argument.
#include <cstdint>
#include <vector>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// What a faceted sphere keeps of the true one.
enum class SphereFit {
  /// Vertices on the sphere: the silhouette is inside the true one and every area is too small.
  Inscribed,
  /// Scaled so that the surface area is 4 pi r^2. By Cauchy's formula the projected area of a convex body, averaged
  /// over
  /// all directions, is a quarter of its surface area, so the mean flux of a distant sphere is exact.
  EqualArea,
};

/// Rectangle in the y-z plane around the origin, normal +x, width along y, height along z; u runs along y, v along z
/// (upright seen from the front). Not closed.
Mesh makePlate(double width_m, double height_m, int columns = 1, int rows = 1);

/// Box around the origin with parts front (+x), back, left (+y), right, top (+z), bottom; each side has its own uv 0..1, v up. Closed.
Mesh makeBox(double length_m, double width_m, double height_m);

/// Disc in the y-z plane around the origin, normal +x, inscribed in the circle. At least 3 segments. Not closed.
Mesh makeDisc(double radius_m, int segments = 64);

/// Sphere around the origin with `segments` meridians and segments/2 rings; normals are the true sphere's. At least 4
/// segments. Inscribed: the surface area is too small by 8.2/segments^2 (0.20 % at 64, 0.05 % at 128). EqualArea: the
/// mean over all directions is exact; the projected area towards any one direction is within 3.6/segments^2 of pi r^2
/// (0.09 % at 64; found over 2000 directions).
Mesh makeSphere(double radius_m, int segments = 64, SphereFit fit = SphereFit::Inscribed);

/// Ellipsoid around the origin with full axes along x, y and z: an inscribed sphere, stretched; normals are the true ellipsoid's.
Mesh makeEllipsoid(double length_m, double width_m, double height_m, int segments = 64);

/// Cylinder along x, centred on the origin, inscribed. Closed if capped. At least 3 segments.
Mesh makeCylinder(double radius_m, double length_m, int segments = 64, bool capped = true);

/// Cone or frustum along x, centred on the origin: base at -length/2, top at +length/2; one of the radii may be 0.
/// Closed if capped. At least 3 segments.
Mesh makeCone(double baseRadius_m, double topRadius_m, double length_m, int segments = 64, bool capped = true);

/// Fractal terrain.
struct TerrainShape {
  double size_m = 1000.0;  ///< side of the square
  int columns = 256;       ///< cells along a side, 1 or more
  double relief_m = 50.0;  ///< all heights lie within +-relief/2, 0 or more
  double roughness = 0.5;  ///< amplitude of each octave relative to the one before, 0..1: 0.4 gentle, 0.6 rugged
  int octaves = 8;         ///< 1..16; those finer than two cells are left out
  double largest_m = 0.0;  ///< wavelength of the first octave; 0 means half the size
  std::uint64_t seed = 0;
};

/// Height field over the x-y plane around the origin, z up, smooth normals; u along x, v along y. Gradient noise whose
/// lattice gradients are a hash of (seed, octave, lattice point): the height at a place depends on nothing else but the
/// shape, never on the number of columns, as long as the octaves are resolved. Not closed.
Mesh makeTerrain(const TerrainShape& shape);

/// The same over a map of (columns+1) x (rows+1) heights in metres, x fastest, starting at -x, -y. Square cells:
/// size_m is the extent along x.
Mesh makeTerrain(double size_m, int columns, int rows, const std::vector<float>& heights_m);

/// Level ground: a cap of the earth's sphere below the x-y plane that touches it at the origin, out to `extent_m` measured in that plane, z up, with
/// the sphere's normals. Facets grow with distance: they lie at most 4 m below the sphere, within 10 km of the origin 0.1 m. u runs along x, v along
/// y: from 0 to 1 over all of it, or by 1 in each `tile_m` from the origin where that is above 0. Not closed. The extent is below half the radius.
Mesh makeGround(double extent_m, double earthRadius_m, double tile_m = 0.0);

}  // namespace pitviper
