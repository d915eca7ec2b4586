#include "sim/scene/sea_surface.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/fourier.hpp"

namespace pitviper {
namespace {

using Complex = std::complex<double>;

void check(const SeaPatch& p) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(std::isfinite(p.windTo_rad) && std::isfinite(p.time_s), "a sea's wind direction and time must be finite");
  require(p.size_m >= 0.01 && p.size_m <= 1e5, "a sea's size lies between 0.01 and 1e5 m");
  require(p.points >= 4 && p.points <= 2048 && (p.points & (p.points - 1)) == 0, "a sea's points are a power of two from 4 to 2048");
  require(p.choppiness >= 0.0 && p.choppiness <= 1.0, "a sea's choppiness lies between 0 and 1");
}

/// SplitMix64's finaliser (Steele, Lea, Flood 2014) over the counters.
std::uint64_t waveHash(std::uint64_t seed, int m, int n, int which) {
  std::uint64_t h = 0;
  // The seed goes through the finaliser too: added to m it would make neighbouring seeds' seas the same one, moved by a wave.
  for (const std::uint64_t counter : {seed, static_cast<std::uint64_t>(m), static_cast<std::uint64_t>(n), static_cast<std::uint64_t>(which)}) {
    h += counter + 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
    h ^= h >> 31;
  }
  return h;
}

/// Normally distributed, of mean square 1 (Box and Muller 1958).
Complex normalAt(std::uint64_t seed, int m, int n) {
  const auto uniform = [&](int which) { return (static_cast<double>(waveHash(seed, m, n, which) >> 11) + 0.5) * 0x1p-53; };
  return std::polar(std::sqrt(-std::log(uniform(0))), 2.0 * kPi * uniform(1));
}

/// Does this wave go with the wind? Of the two that stand across it, one.
bool goesAlong(const SeaPatch& p, int m, int n) {
  const double along = m * std::cos(p.windTo_rad) + n * std::sin(p.windTo_rad);
  return std::abs(along) > 1e-9 * std::hypot(m, n) ? along > 0.0 : n > 0 || (n == 0 && m > 0);
}

double stepOf(const SeaPatch& p) { return 2.0 * kPi / p.size_m; }

/// Over the waves of one half: all but the shortest that a grid can hold, which it could not move.
template <typename Visit>
void eachWave(const SeaPatch& p, Visit&& visit) {
  const int most = p.points / 2 - 1;
  for (int n = -most; n <= most; ++n)
    for (int m = -most; m <= most; ++m)
      if ((m != 0 || n != 0) && m * m + n * n <= most * most) visit(m, n);
}

}  // namespace

SeaField seaField(const SeaPatch& p) {
  check(p);
  const WaveSpectrum spectrum(p.wind_m_s, p.inverseWaveAge);
  const auto size = static_cast<std::size_t>(p.points);
  const double dk = stepOf(p);
  const bool moves = p.choppiness > 0.0;
  // Real fields two by two, one as the real and one as the imaginary part.
  std::vector<std::vector<Complex>> sums(moves ? 4 : 2, std::vector<Complex>(size * size));
  eachWave(p, [&](int m, int n) {
    if (!goesAlong(p, m, n)) return;
    const double kx = m * dk, ky = n * dk, k = std::hypot(kx, ky);
    const double mean = spectrum.directional(k, std::atan2(ky, kx) - p.windTo_rad) * dk * dk;
    // h = sum of (a exp(i k x) + conjugate) over half of the waves: the mean square of a is Psi dk^2, as k and -k hold Psi each.
    const Complex a = std::sqrt(mean) * normalAt(p.seed, m, n) * std::polar(1.0, -waveFrequency_rad_s(k) * p.time_s);
    const Complex i(0.0, 1.0);
    const auto put = [&](std::size_t which, Complex first, Complex second) {
      const auto at = [&](int u, int v) -> Complex& {
        return sums[which][static_cast<std::size_t>((v + p.points) % p.points) * size + static_cast<std::size_t>((u + p.points) % p.points)];
      };
      // The square's first place is its corner.
      const double sign = (m + n) % 2 == 0 ? 1.0 : -1.0;
      at(m, n) += sign * (first + i * second);
      at(-m, -n) += sign * (std::conj(first) + i * std::conj(second));
    };
    const Complex shift = moves ? i * p.choppiness / k * a : 0.0;
    put(0, a, i * kx * a);
    put(1, i * ky * a, kx * shift);
    if (!moves) return;
    put(2, ky * shift, i * kx * kx * shift);
    put(3, i * ky * ky * shift, i * kx * ky * shift);
  });
  SeaField field;
  const auto take = [&](std::size_t which, std::vector<double>& first, std::vector<double>* second) {
    fourierSumSquare(sums[which], p.points);
    for (const Complex& x : sums[which]) {
      first.push_back(x.real());
      if (second) second->push_back(x.imag());
    }
    sums[which].clear();
  };
  take(0, field.height_m, &field.slopeX);
  take(1, field.slopeY, moves ? &field.shiftX_m : nullptr);
  if (moves) {
    take(2, field.shiftY_m, &field.stretchXX);
    take(3, field.stretchYY, &field.stretchXY);
  }
  return field;
}

SeaMesh seaMoments(const SeaPatch& p) {
  check(p);
  const WaveSpectrum spectrum(p.wind_m_s, p.inverseWaveAge);
  SeaMesh sea;
  const double dk = stepOf(p), cell = p.size_m / p.points;
  eachWave(p, [&](int m, int n) {
    const double kx = m * dk, ky = n * dk, k = std::hypot(kx, ky), phi = std::atan2(ky, kx) - p.windTo_rad;
    const double mean = spectrum.directional(k, phi) * dk * dk, up = k * k * std::cos(phi) * std::cos(phi) * mean, cross = k * k * mean - up;
    // Mean square of what is linear between the corners of triangles that share the diagonal: weights' means 1/6 and 1/12.
    const double kept = 0.5 + (std::cos(kx * cell) + std::cos(ky * cell) + std::cos((kx + ky) * cell)) / 6.0;
    sea.nodes.height_m2 += mean;
    sea.nodes.slopeUp += up;
    sea.nodes.slopeCross += cross;
    sea.drawn.height_m2 += kept * mean;
    sea.drawn.slopeUp += kept * up;
    sea.drawn.slopeCross += kept * cross;
  });
  const WaveMoments all = spectrum.moments();
  sea.unresolved = {std::max(0.0, all.height_m2 - sea.drawn.height_m2), std::max(0.0, all.slopeUp - sea.drawn.slopeUp),
                    std::max(0.0, all.slopeCross - sea.drawn.slopeCross)};
  return sea;
}

double drawnSlope(const WaveSpectrum& spectrum, double step_m) {
  if (!(step_m > 0.0)) throw std::invalid_argument("a sea's step must be positive");
  if (!(spectrum.peak_rad_m() > 0.0)) return 0.0;
  // As in seaMoments(), over all directions: cosines become Bessel functions. Waves of all lengths down to two steps, in steps of 2 %.
  double sum = 0.0;
  const double from = std::log(0.1 * spectrum.peak_rad_m()), to = std::log(kPi / step_m);
  constexpr double kStep = 0.02;
  for (double x = from + 0.5 * kStep; x < to; x += kStep) {
    const double k = std::exp(x), kept = 0.5 + (2.0 * std::cyl_bessel_j(0.0, k * step_m) + std::cyl_bessel_j(0.0, std::sqrt(2.0) * k * step_m)) / 6.0;
    sum += kStep * kept * spectrum.curvature(k);
  }
  return sum;
}

SeaMesh makeSea(const SeaPatch& p) {
  SeaMesh sea = seaMoments(p);
  const SeaField field = seaField(p);
  Mesh& mesh = sea.mesh;
  mesh.heightField = true;
  const double cell = p.size_m / p.points;
  for (int j = 0; j <= p.points; ++j)
    for (int i = 0; i <= p.points; ++i) {
      const auto at = static_cast<std::size_t>(j % p.points) * static_cast<std::size_t>(p.points) + static_cast<std::size_t>(i % p.points);
      glm::dvec3 place((i - 0.5 * p.points) * cell, (j - 0.5 * p.points) * cell, field.height_m[at]), alongX(1.0, 0.0, field.slopeX[at]),
          alongY(0.0, 1.0, field.slopeY[at]);
      if (!field.shiftX_m.empty()) {
        place += glm::dvec3(field.shiftX_m[at], field.shiftY_m[at], 0.0);
        alongX += glm::dvec3(field.stretchXX[at], field.stretchXY[at], 0.0);
        alongY += glm::dvec3(field.stretchXY[at], field.stretchYY[at], 0.0);
      }
      const glm::dvec3 normal = glm::cross(alongX, alongY);
      mesh.heightField = mesh.heightField && normal.z > 0.0;
      mesh.positions.emplace_back(place);
      // Where a crest folds over, upwards: seen from below nothing is drawn.
      mesh.normals.emplace_back(glm::normalize(normal.z > 0.0 ? normal : glm::dvec3(normal.x, normal.y, 1e-3)));
      mesh.uv.emplace_back(static_cast<float>(i) / static_cast<float>(p.points), static_cast<float>(j) / static_cast<float>(p.points));
    }
  const auto stride = static_cast<std::uint32_t>(p.points) + 1;
  for (std::uint32_t j = 0; j + 1 < stride; ++j)
    for (std::uint32_t i = 0; i + 1 < stride; ++i) {
      const std::uint32_t a = j * stride + i;
      mesh.triangles.emplace_back(a, a + 1, a + stride + 1);
      mesh.triangles.emplace_back(a, a + stride + 1, a + stride);
    }
  mesh.parts = {{"all", 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  return sea;
}

}  // namespace pitviper
