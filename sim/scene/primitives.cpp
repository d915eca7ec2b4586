#include "sim/scene/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/mesh_tools.hpp"

namespace pitviper {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

void requireLength(double value, const char* what) { require(std::isfinite(value) && value > 0.0, what); }

/// The bound of mesh_tools.hpp; segments up to 4096 keep a sphere within it.
void requireGrid(long long columns, long long rows) {
  require(columns >= 1 && rows >= 1, "a mesh needs at least one cell");
  require(columns <= 1'000'000 && rows <= 1'000'000 && 2 * columns * rows <= static_cast<long long>(kMostTriangles), "too many cells for one mesh");
}

void addVertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal, double u, double v) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(normal);
  mesh.uv.emplace_back(u, v);
}

/// Two triangles per cell of a grid of (columns+1) x (rows+1) vertices, columns fastest, from `first` on;
/// columns x rows points along the outward normal.
void addGrid(Mesh& mesh, std::uint32_t first, int columns, int rows) {
  const auto stride = static_cast<std::uint32_t>(columns) + 1;
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j)
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
      const std::uint32_t a = first + j * stride + i;
      mesh.triangles.emplace_back(a, a + 1, a + stride + 1);
      mesh.triangles.emplace_back(a, a + stride + 1, a + stride);
    }
}

Mesh finished(Mesh mesh, bool closed) {
  mesh.parts = {{"all", 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  mesh.closed = closed;
  return mesh;
}

/// Direction i of `segments` around the x axis; i = segments gives exactly the direction of i = 0, so seams close.
glm::dvec3 around(int i, int segments) {
  const double angle = 2.0 * kPi * (i % segments) / segments;
  return {0.0, std::cos(angle), std::sin(angle)};
}

/// A fan in the plane x = x_m, facing +x or -x.
void addCap(Mesh& mesh, double radius_m, double x_m, int segments, double facing) {
  const auto centre = static_cast<std::uint32_t>(mesh.positions.size());
  addVertex(mesh, {x_m, 0.0, 0.0}, {facing, 0.0, 0.0}, 0.5, 0.5);
  for (int i = 0; i < segments; ++i) {
    const glm::dvec3 d = around(i, segments);
    addVertex(mesh, glm::dvec3(x_m, 0.0, 0.0) + radius_m * d, {facing, 0.0, 0.0}, 0.5 + 0.5 * facing * d.y, 0.5 + 0.5 * d.z);
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(segments); ++i) {
    const std::uint32_t a = centre + 1 + i, b = centre + 1 + (i + 1) % static_cast<std::uint32_t>(segments);
    mesh.triangles.emplace_back(centre, facing > 0.0 ? a : b, facing > 0.0 ? b : a);
  }
}

/// Hash of (seed, octave, lattice point): the SplitMix64 finaliser (Steele, Lea, Flood 2014) over the counters.
std::uint64_t latticeHash(std::uint64_t seed, int octave, long long i, long long j) {
  std::uint64_t h = 0;
  // The seed by itself: added to the octave, neighbouring seeds would have octaves in common.
  for (const std::uint64_t counter : {seed, static_cast<std::uint64_t>(octave), static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)}) {
    h += counter + 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
    h ^= h >> 31;
  }
  return h;
}

/// Gradient noise with unit gradients in the plane, |value| <= 1: its bound is sqrt(1/2), at a cell's centre.
double gradientNoise(std::uint64_t seed, int octave, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto towards = [&](int dx, int dy) {
    const std::uint64_t hash = latticeHash(seed, octave, static_cast<long long>(fx) + dx, static_cast<long long>(fy) + dy);
    const double angle = static_cast<double>(hash >> 11) * (2.0 * kPi / 9007199254740992.0);  // 53 bits to 0..2 pi
    return std::cos(angle) * (x - fx - dx) + std::sin(angle) * (y - fy - dy);
  };
  const auto fade = [](double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); };  // second derivative continuous
  const double u = fade(x - fx), v = fade(y - fy);
  return std::numbers::sqrt2 * std::lerp(std::lerp(towards(0, 0), towards(1, 0), u), std::lerp(towards(0, 1), towards(1, 1), u), v);
}

}  // namespace

Mesh makePlate(double width_m, double height_m, int columns, int rows) {
  requireLength(width_m, "a plate's width must be positive");
  requireLength(height_m, "a plate's height must be positive");
  requireGrid(columns, rows);
  Mesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      // Seen from +x, looking along -x with z up, +y is on the right; u therefore grows with y.
      const double u = static_cast<double>(i) / columns, v = static_cast<double>(j) / rows;
      addVertex(mesh, {0.0, (u - 0.5) * width_m, (v - 0.5) * height_m}, {1.0, 0.0, 0.0}, u, v);
    }
  addGrid(mesh, 0, columns, rows);
  return finished(std::move(mesh), false);
}

Mesh makeBox(double length_m, double width_m, double height_m) {
  requireLength(length_m, "a box's length must be positive");
  requireLength(width_m, "a box's width must be positive");
  requireLength(height_m, "a box's height must be positive");
  Mesh box;
  // Where a plate's normal (x), right (y) and up (z) go; whole numbers, so that edges meet exactly.
  auto side = [&](const char* name, const Mesh& plate, glm::vec3 normal, glm::vec3 right, glm::vec3 up, double distance) {
    appendPart(box, plate, name,
               glm::mat4(glm::vec4(normal, 0), glm::vec4(right, 0), glm::vec4(up, 0), glm::vec4(normal * static_cast<float>(0.5 * distance), 1)));
  };
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  side("front", makePlate(width_m, height_m), x, y, z, length_m);
  side("back", makePlate(width_m, height_m), -x, -y, z, length_m);
  side("left", makePlate(length_m, height_m), y, -x, z, width_m);
  side("right", makePlate(length_m, height_m), -y, x, z, width_m);
  side("top", makePlate(width_m, length_m), z, y, -x, height_m);
  side("bottom", makePlate(width_m, length_m), -z, y, x, height_m);
  box.closed = true;
  return box;
}

Mesh makeDisc(double radius_m, int segments) {
  requireLength(radius_m, "a disc's radius must be positive");
  require(segments >= 3, "a disc needs at least 3 segments");
  requireGrid(segments, 1);
  Mesh mesh;
  addCap(mesh, radius_m, 0.0, segments, 1.0);
  return finished(std::move(mesh), false);
}

Mesh makeSphere(double radius_m, int segments, SphereFit fit) {
  requireLength(radius_m, "a sphere's radius must be positive");
  require(segments >= 4, "a sphere needs at least 4 segments");
  requireGrid(segments, segments);
  const int rings = segments / 2;
  Mesh mesh;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i <= segments; ++i) {
      const double elevation = kPi * j / rings - 0.5 * kPi;
      const bool pole = j == 0 || j == rings;
      const glm::dvec3 d = around(i, segments);  // y, z of it serve as x, y here: the poles are on z
      const double level = pole ? 0.0 : std::cos(elevation);
      const glm::dvec3 normal(level * d.y, level * d.z, pole ? (j == 0 ? -1.0 : 1.0) : std::sin(elevation));
      const double u = (i + (pole ? 0.5 : 0.0)) / segments;  // a pole's triangle has its tip's u in its middle
      addVertex(mesh, radius_m * normal, normal, std::min(u, 1.0), static_cast<double>(j) / rings);
    }
  addGrid(mesh, 0, segments, rings);
  const auto n = static_cast<std::uint32_t>(segments);
  std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {  // at each pole half of the cell's triangles have no area
    const auto poles = [&](std::uint32_t i) { return i <= n || i >= static_cast<std::uint32_t>(rings) * (n + 1); };
    return poles(t.x) + poles(t.y) + poles(t.z) >= 2;
  });
  for (glm::uvec3& t : mesh.triangles)  // at the north pole take the tip above the triangle's own middle
    if (t.z >= static_cast<std::uint32_t>(rings) * (n + 1)) t.z = t.x + n + 1;
  if (fit == SphereFit::EqualArea) {
    const double scale = std::sqrt(4.0 * kPi * radius_m * radius_m / surfaceArea(mesh));
    for (glm::vec3& p : mesh.positions) p = glm::vec3(glm::dvec3(p) * scale);
  }
  return finished(std::move(mesh), true);
}

Mesh makeEllipsoid(double length_m, double width_m, double height_m, int segments) {
  for (double axis : {length_m, width_m, height_m}) requireLength(axis, "an ellipsoid's axes must be positive");
  Mesh mesh = makeSphere(1.0, segments);
  const glm::dvec3 axes(0.5 * length_m, 0.5 * width_m, 0.5 * height_m);
  for (glm::vec3& p : mesh.positions) p = glm::vec3(glm::dvec3(p) * axes);
  for (glm::vec3& n : mesh.normals) n = glm::vec3(glm::normalize(glm::dvec3(n) / axes));
  return mesh;
}

Mesh makeCylinder(double radius_m, double length_m, int segments, bool capped) { return makeCone(radius_m, radius_m, length_m, segments, capped); }

Mesh makeCone(double baseRadius_m, double topRadius_m, double length_m, int segments, bool capped) {
  require(std::isfinite(baseRadius_m) && std::isfinite(topRadius_m) && std::min(baseRadius_m, topRadius_m) >= 0.0 && std::max(baseRadius_m, topRadius_m) > 0.0,
          "a cone's radii must be 0 or more, and one positive");
  requireLength(length_m, "a cone's length must be positive");
  require(segments >= 3, "a cone needs at least 3 segments");
  requireGrid(segments, 2);
  Mesh mesh;
  const double slant = std::hypot(length_m, baseRadius_m - topRadius_m);
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i <= segments; ++i) {
      const double radius = end == 0 ? baseRadius_m : topRadius_m;
      const bool tip = radius == 0.0;
      const double middle = 2.0 * kPi * (i + 0.5) / segments;
      const glm::dvec3 d = around(i, segments);
      const glm::dvec3 out = tip ? glm::dvec3(0.0, std::cos(middle), std::sin(middle)) : d;
      const glm::dvec3 normal = (glm::dvec3(baseRadius_m - topRadius_m, 0.0, 0.0) + length_m * out) / slant;
      addVertex(mesh, glm::dvec3((end - 0.5) * length_m, 0.0, 0.0) + (tip ? 0.0 : radius) * d, normal, std::min((i + (tip ? 0.5 : 0.0)) / segments, 1.0), end);
    }
  const auto stride = static_cast<std::uint32_t>(segments) + 1;
  for (std::uint32_t i = 0; i + 1 < stride; ++i) {
    const std::uint32_t a = i, b = i + 1, c = stride + i, d = stride + i + 1;
    if (topRadius_m > 0.0 && baseRadius_m > 0.0) mesh.triangles.emplace_back(a, b, d);
    mesh.triangles.push_back(topRadius_m > 0.0 ? glm::uvec3(a, d, c) : glm::uvec3(a, b, c));
  }
  if (capped && baseRadius_m > 0.0) addCap(mesh, baseRadius_m, -0.5 * length_m, segments, -1.0);
  if (capped && topRadius_m > 0.0) addCap(mesh, topRadius_m, 0.5 * length_m, segments, 1.0);
  return finished(std::move(mesh), capped);
}

Mesh makeTerrain(const TerrainShape& shape) {
  requireLength(shape.size_m, "a terrain's size must be positive");
  requireGrid(shape.columns, shape.columns);
  require(std::isfinite(shape.relief_m) && shape.relief_m >= 0.0, "a terrain's relief must be 0 or more");
  require(shape.roughness >= 0.0 && shape.roughness <= 1.0, "a terrain's roughness must be in 0..1");
  require(shape.octaves >= 1 && shape.octaves <= 16, "a terrain has 1..16 octaves");
  require(std::isfinite(shape.largest_m) && shape.largest_m >= 0.0, "a terrain's largest wavelength must be 0 or more");
  const double largest = shape.largest_m > 0.0 ? shape.largest_m : 0.5 * shape.size_m, cell = shape.size_m / shape.columns;
  require(shape.size_m / largest < 1e9, "a terrain's largest wavelength is too small for its size");
  double total = 0.0;
  for (int octave = 0; octave < shape.octaves; ++octave) total += std::pow(shape.roughness, octave);
  std::vector<float> heights;
  for (int j = 0; j <= shape.columns; ++j)
    for (int i = 0; i <= shape.columns; ++i) {
      double sum = 0.0, amplitude = 0.5 * shape.relief_m / total, wavelength = largest;
      for (int octave = 0; octave < shape.octaves && (octave == 0 || wavelength >= 2.0 * cell); ++octave) {
        sum += amplitude * gradientNoise(shape.seed, octave, (i * cell - 0.5 * shape.size_m) / wavelength, (j * cell - 0.5 * shape.size_m) / wavelength);
        amplitude *= shape.roughness;
        wavelength *= 0.5;
      }
      heights.push_back(static_cast<float>(sum));
    }
  return makeTerrain(shape.size_m, shape.columns, shape.columns, heights);
}

Mesh makeTerrain(double size_m, int columns, int rows, const std::vector<float>& heights_m) {
  requireLength(size_m, "a terrain's size must be positive");
  requireGrid(columns, rows);
  const std::size_t stride = static_cast<std::size_t>(columns) + 1;
  require(heights_m.size() == stride * (static_cast<std::size_t>(rows) + 1), "a height map has (columns+1) x (rows+1) heights");
  require(std::all_of(heights_m.begin(), heights_m.end(), [](float h) { return std::isfinite(h); }), "heights must be finite");
  const double cell = size_m / columns;
  const auto height = [&](int i, int j) { return static_cast<double>(heights_m[static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i)]); };
  // Central differences inside, one-sided ones at the rim.
  const auto slope = [&](int i, int j, int di, int dj) {
    const int i0 = std::max(i - di, 0), i1 = std::min(i + di, columns), j0 = std::max(j - dj, 0), j1 = std::min(j + dj, rows);
    return (height(i1, j1) - height(i0, j0)) / (cell * (i1 - i0 + j1 - j0));
  };
  Mesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      addVertex(mesh, {(i - 0.5 * columns) * cell, (j - 0.5 * rows) * cell, height(i, j)},
                glm::normalize(glm::dvec3(-slope(i, j, 1, 0), -slope(i, j, 0, 1), 1.0)), static_cast<double>(i) / columns, static_cast<double>(j) / rows);
  addGrid(mesh, 0, columns, rows);
  // In tiles of 16 x 16 cells: neighbours in the list are neighbours in the field, and what a view leaves out is left out in long runs.
  const auto tileOf = [&](const glm::uvec3& t) {
    const auto corner = static_cast<std::size_t>(std::min({t.x, t.y, t.z}));
    return corner / stride / 16 * stride + corner % stride / 16;
  };
  std::stable_sort(mesh.triangles.begin(), mesh.triangles.end(), [&](const glm::uvec3& a, const glm::uvec3& b) { return tileOf(a) < tileOf(b); });
  mesh.heightField = true;
  return finished(std::move(mesh), false);
}

Mesh makeGround(double extent_m, double earthRadius_m, double tile_m) {
  requireLength(extent_m, "a ground's extent must be positive");
  requireLength(earthRadius_m, "the earth's radius must be positive");
  require(std::isfinite(tile_m) && tile_m >= 0.0, "a ground's tile must be 0 or more");
  require(extent_m < 0.5 * earthRadius_m, "a ground reaches less than half the earth's radius");
  // A facet from r1 to r2 lies (r2 - r1)2 / 8R below the sphere in its middle: rings grow by a seventh to 10 km (2 m); 256 sectors add
  // (r dphi)2 / 8R, 1.9 m at 400 km.
  constexpr double kFirst_m = 100.0, kGrowth = 1.15, kWidest_m = 1e4;
  constexpr int kSectors = 256;
  std::vector<double> radius_m;
  for (double r = std::min(kFirst_m, extent_m); r < extent_m; r = std::min(r * kGrowth, r + kWidest_m)) radius_m.push_back(r);
  if (radius_m.size() > 1 && extent_m - radius_m.back() < 0.02 * extent_m) radius_m.pop_back();
  radius_m.push_back(extent_m);
  Mesh mesh;
  const double perTurn = tile_m > 0.0 ? tile_m : 2.0 * extent_m, middle = tile_m > 0.0 ? 0.0 : 0.5;
  auto add = [&](double x, double y) {
    const double r2 = x * x + y * y, down = std::sqrt(earthRadius_m * earthRadius_m - r2);
    addVertex(mesh, {x, y, -r2 / (earthRadius_m + down)}, glm::dvec3(x, y, down) / earthRadius_m, middle + x / perTurn, middle + y / perTurn);
  };
  add(0.0, 0.0);
  for (double r : radius_m)
    for (int i = 0; i < kSectors; ++i) {
      const glm::dvec3 d = around(i, kSectors);
      add(r * d.y, r * d.z);
    }
  auto at = [](size_t ring, int i) { return static_cast<std::uint32_t>(1 + ring * kSectors + static_cast<size_t>(i % kSectors)); };
  for (int i = 0; i < kSectors; ++i) mesh.triangles.emplace_back(0u, at(0, i), at(0, i + 1));
  for (size_t ring = 0; ring + 1 < radius_m.size(); ++ring)
    for (int i = 0; i < kSectors; ++i) {
      mesh.triangles.emplace_back(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
      mesh.triangles.emplace_back(at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
  mesh.heightField = true;
  return finished(std::move(mesh), false);
}

}  // namespace pitviper
