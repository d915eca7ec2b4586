#include "materials/fields/cumulus.hpp"

#include "sim/parameters/on_threads.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Water's growth with height [kg/m4]; drops [1/m3]; density [kg/m3]; (volume radius / effective radius)^3.
constexpr double kWaterLapse = 0.6 * 2.0e-6, kDrops = 2.0e8, kWaterDensity = 1000.0, kSpread = 0.8;
/// Standard deviation of ln(water) inside; octaves of noise, the finest finer than any grid's nodes.
constexpr double kVariability = 0.35;
constexpr int kOctaves = 6;
/// What counts as cloud from above; pixels across a square on which cover is counted.
constexpr double kCloudy = 0.3;
constexpr int kPixels = 256;

std::uint32_t mixed(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  return h ^ (h >> 16);
}

std::uint32_t hashOf(int x, int y, int z, std::uint32_t seed) {
  return mixed(static_cast<std::uint32_t>(x) + mixed(static_cast<std::uint32_t>(y) + mixed(static_cast<std::uint32_t>(z) + mixed(seed + 0x9e3779b9u))));
}

/// Draw n of a seed, in [0, 1).
double draw(std::uint32_t seed, int n) { return hashOf(n, 17, 91, seed) * 0x1.0p-32; }

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Sum of octaves, each half as wide as the one before, of variance 1 as noise has it.
double fractalNoise(const glm::dvec3& p, std::uint32_t seed, double gain) {
  double sum = 0.0, amplitude = 1.0, square = 0.0, frequency = 1.0;
  for (int o = 0; o < kOctaves; ++o) {
    sum += amplitude * valueNoise(p * frequency + glm::dvec3(13.7, 7.3, 3.1) * static_cast<double>(o), seed + static_cast<std::uint32_t>(o));
    square += amplitude * amplitude;
    amplitude *= gain;
    frequency *= 2.0;
  }
  return sum / std::sqrt(square);
}

/// 0 to 1: round humps and sharp creases.
double billowNoise(const glm::dvec3& p, std::uint32_t seed, double gain) {
  double sum = 0.0, amplitude = 1.0, total = 0.0, frequency = 1.0;
  for (int o = 0; o < kOctaves; ++o) {
    const double v = valueNoise(p * frequency + glm::dvec3(5.3, 9.1, 1.7) * static_cast<double>(o), seed + static_cast<std::uint32_t>(o));
    sum += amplitude * (1.0 - 2.0 * std::abs(v));
    total += amplitude;
    amplitude *= gain;
    frequency *= 2.03;
  }
  return 0.5 + 0.5 * sum / total;
}

}  // namespace

double valueNoise(const glm::dvec3& p, std::uint32_t seed) {
  const glm::dvec3 low = glm::floor(p), t = p - low;
  const glm::ivec3 c(low);
  const glm::dvec3 f = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
  const auto corner = [&](int a, int b, int d) { return hashOf(c.x + a, c.y + b, c.z + d, seed) * 0x1.0p-31 - 1.0; };
  const auto row = [&](int b, int d) { return corner(0, b, d) * (1.0 - f.x) + corner(1, b, d) * f.x; };
  return (row(0, 0) * (1.0 - f.y) + row(1, 0) * f.y) * (1.0 - f.z) + (row(0, 1) * (1.0 - f.y) + row(1, 1) * f.y) * f.z;
}

CumulusShape::CumulusShape(const CumulusShapeOptions& options) : o_(options) {
  const int count = 10 + static_cast<int>(5.0 * draw(o_.seed, 0));
  const double half = 0.5 * o_.width_m;
  for (int n = 0; n < count; ++n) {
    const double angle = 2.0 * kPi * (n * 0.381966 + 0.15 * draw(o_.seed, 10 + 4 * n));  // the golden angle: no two in line
    const double radius = half * (n == 0 ? 0.40 : 0.22 + 0.16 * draw(o_.seed, 11 + 4 * n));
    const double reach = n == 0 ? 0.15 * half : (half - radius) * std::sqrt((n + draw(o_.seed, 12 + 4 * n)) / (count + 1.0));
    const double rim = reach / half;
    const double top = n == 0 ? o_.depth_m : o_.depth_m * (1.0 - 1.1 * rim * rim) * (0.6 + 0.35 * draw(o_.seed, 13 + 4 * n));
    turrets_.push_back({reach * std::cos(angle), reach * std::sin(angle), radius, top});
  }
  for (const Turret& t : turrets_) halfExtent_m_ = std::max(halfExtent_m_, std::hypot(t.x, t.y) + t.radius * (1.05 + 0.6 * o_.roughness));
}

/// 0 outside to 1 in the core.
double CumulusShape::fill(const glm::dvec3& q) const {
  if (q.z <= 0.0 || q.z >= 1.1 * o_.depth_m || q.x * q.x + q.y * q.y > halfExtent_m_ * halfExtent_m_) return 0.0;
  // Depth below the surface of the union, rounded where turrets meet.
  double sum = 0.0, nearest = -1e30;
  const double blend = 0.025 * o_.width_m, size = 0.30 * o_.width_m;
  for (const Turret& t : turrets_) {
    const double cap = std::min(t.radius, 0.8 * t.top), above = std::max(0.0, q.z - (t.top - cap)) * t.radius / cap;
    const double d = t.radius - std::sqrt((q.x - t.x) * (q.x - t.x) + (q.y - t.y) * (q.y - t.y) + above * above);
    nearest = std::max(nearest, d);
    sum += std::exp(std::min(d / blend, 60.0));
  }
  if (nearest < -o_.roughness * 0.75 * size) return 0.0;
  const double inside = blend * std::log(sum);
  // Billows grow with height: the base is set by where vapour condenses and stays flat.
  const double grown = 0.35 + 0.65 * smooth(q.z / (0.5 * o_.depth_m));
  const double billow = billowNoise(q / size, o_.seed * 977u + 5u, 0.62) - 0.55;
  const double d = inside + 1.5 * o_.roughness * size * grown * billow, edge = (0.06 + 0.10 * o_.roughness) * size;
  return smooth(d / edge) * smooth(q.z / (0.04 * o_.depth_m));
}

double CumulusShape::extinction(const glm::dvec3& p) const {
  const double f = fill(p);
  if (!(f > 0.0)) return 0.0;
  // Gain 2^(-1/3): lines through it have a spectrum of k^-5/3.
  const double v = fractalNoise(p / (0.5 * o_.width_m), o_.seed * 131u + 11u, 0.7937), adiabatic = kWaterLapse * std::max(p.z, 1.0);
  const double radius = std::cbrt(3.0 * adiabatic / (4.0 * kPi * kWaterDensity * kSpread * kDrops));
  return 1.5 * f * adiabatic * std::exp(1.7 * kVariability * v) / (kWaterDensity * radius);
}

double CumulusShape::column(double x, double y, int steps) const {
  const double each = 1.1 * o_.depth_m / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += extinction({x, y, (i + 0.5) * each});
  return sum * each;
}

DensityGrid cumulusFrame(const CumulusShapeOptions& options, int across) {
  const double half = CumulusShape(options).halfExtent_m(), apart = 2.0 * half / (across - 1), height = 1.12 * options.depth_m;
  const int up = std::max(static_cast<int>(std::ceil(height / apart)) + 1, 8);
  DensityGrid frame;
  frame.nodes = {across, across, up};
  frame.first = {-half, -half, 0.0};
  frame.spacing = {apart, apart, height / (up - 1)};
  return frame;
}

DensityGrid cumulusGrid(const CumulusShapeOptions& options, int across, double mostDepth) {
  const CumulusShape shape(options);
  const DensityGrid frame = cumulusFrame(options, across);
  DensityGrid grid(frame.nodes, frame.first, frame.spacing);
  const int up = frame.nodes.z;
  onStretches(static_cast<std::size_t>(up), 1, [&](std::size_t from, std::size_t to) {
    for (int k = static_cast<int>(from); k < static_cast<int>(to); ++k)
      for (int j = 1; j < across - 1; ++j)
        for (int i = 1; i < across - 1 && k > 0 && k < up - 1; ++i) grid.value[grid.index(i, j, k)] = static_cast<float>(shape.extinction(grid.place(i, j, k)));
  });
  if (!(mostDepth > 0.0)) return grid;
  double largest = 0.0;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      double column = 0.0;
      for (int k = 0; k < up; ++k) column += grid.value[grid.index(i, j, k)] * grid.spacing.z;
      largest = std::max(largest, column);
    }
  for (float& v : grid.value) v *= static_cast<float>(mostDepth / std::max(largest, 1e-30));
  return grid;
}

CumulusField cumulusField(const CumulusFieldOptions& o) {
  constexpr double kSlope = 1.9, kCutoff_m = 1000.0, kAspect = 0.7, kDeepest_m = 2000.0;
  constexpr int kTries = 200, kColumns = 48;
  CumulusField field;
  int drawn = 0;
  const auto random = [&] { return draw(o.seed * 7919u + 3u, drawn++); };
  // The size distribution's quantiles, one shape for the middle of each equal share of the area that it covers.
  std::vector<double> widths, area{0.0};
  for (int k = 0; k <= 256; ++k) {
    const double d = o.narrowest_m * std::pow(o.widest_m / o.narrowest_m, k / 256.0);
    if (k > 0) area.push_back(area.back() + std::pow(d, 3.0 - kSlope) * std::exp(-d / kCutoff_m));  // d^2 x N(D) dD, dD ~ D
    widths.push_back(d);
  }
  std::vector<std::vector<double>> columns;  // of each shape: vertical optical depth, on kColumns x kColumns
  std::vector<double> extent_m, covered_m2;
  for (int s = 0; s < o.shapes; ++s) {
    const double wanted = area.back() * (1.0 - (s + 0.5) / o.shapes);  // the largest first
    const auto at = static_cast<std::size_t>(std::lower_bound(area.begin(), area.end(), wanted) - area.begin());
    const double width = widths[at];
    field.shapes.push_back(
        {width, std::min(kAspect * width * (0.75 + 0.5 * random()), kDeepest_m), o.roughness, o.seed * 1000003u + static_cast<std::uint32_t>(s)});
    const CumulusShape shape(field.shapes.back());
    const double half = shape.halfExtent_m();
    std::vector<double>& c = columns.emplace_back(static_cast<std::size_t>(kColumns * kColumns));
    onStretches(c.size(), kColumns, [&](std::size_t from, std::size_t to) {
      for (std::size_t n = from; n < to; ++n)
        c[n] = shape.column(half * ((2.0 * static_cast<double>(n % kColumns) + 1.0) / kColumns - 1.0),
                            half * ((2.0 * static_cast<double>(n / kColumns) + 1.0) / kColumns - 1.0), 24);
    });
    extent_m.push_back(half);
    const auto cloudy = static_cast<double>(std::count_if(c.begin(), c.end(), [](double tau) { return tau > kCloudy; }));
    covered_m2.push_back(std::max(cloudy, 1.0) * 4.0 * half * half / (kColumns * kColumns));
  }
  std::vector<char> pixels(static_cast<std::size_t>(kPixels * kPixels), 0);
  const double pixel = o.side_m / kPixels, wanted = o.cover * kPixels * kPixels;
  double covered = 0.0;
  const auto cover = [&](std::size_t s, const glm::dvec2& at) {
    const int low = static_cast<int>(std::floor((at.x - extent_m[s]) / pixel + 0.5 * kPixels)), across = static_cast<int>(2.0 * extent_m[s] / pixel) + 1,
              bottom = static_cast<int>(std::floor((at.y - extent_m[s]) / pixel + 0.5 * kPixels));
    for (int j = bottom; j <= bottom + across; ++j)
      for (int i = low; i <= low + across; ++i) {
        const glm::dvec2 p = (glm::dvec2(i, j) + 0.5 - 0.5 * kPixels) * pixel - at, u = (p / extent_m[s] + 1.0) * (0.5 * kColumns);
        if (u.x < 0.0 || u.y < 0.0 || u.x >= kColumns || u.y >= kColumns || i < 0 || j < 0 || i >= kPixels || j >= kPixels) continue;
        char& cell = pixels[static_cast<std::size_t>(j * kPixels + i)];
        if (columns[s][static_cast<std::size_t>(u.y) * kColumns + static_cast<std::size_t>(u.x)] <= kCloudy || cell != 0) continue;
        cell = 1;
        covered += 1.0;
      }
  };
  // Each shape covers an equal share; the largest stand first, since small ones still find room later.
  for (std::size_t s = 0; s < field.shapes.size(); ++s) {
    const double until = wanted * static_cast<double>(s + 1) / static_cast<double>(field.shapes.size());
    while (until - covered > 0.5 * covered_m2[s] / (pixel * pixel) && static_cast<int>(field.clouds.size()) < o.most) {
      bool placed = false;
      for (int t = 0; t < kTries && !placed; ++t) {
        const double east = random(), north = random();
        const glm::dvec2 at = o.side_m * (glm::dvec2(east, north) - 0.5);
        placed = std::all_of(field.clouds.begin(), field.clouds.end(), [&](const CumulusField::Place& c) {
          return glm::length(c.at - at) > 0.5 * (field.shapes[static_cast<std::size_t>(c.shape)].width_m + field.shapes[s].width_m);
        });
        if (!placed) continue;
        field.clouds.push_back({static_cast<int>(s), at});
        cover(s, at);
      }
      if (!placed) break;
    }
  }
  field.cover = covered / (kPixels * kPixels);
  return field;
}

}  // namespace pitviper
