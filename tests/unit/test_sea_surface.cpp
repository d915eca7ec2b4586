// Waves drawn one by one against their spectrum. (Where it goes: tests/unit.)
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <stdexcept>

#include "sim/scene/fourier.hpp"
#include "sim/scene/sea_surface.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = 3.14159265358979323846;

double meanSquare(const std::vector<double>& values) {
  double sum = 0.0;
  for (double x : values) sum += x * x;
  return sum / static_cast<double>(values.size());
}

/// What wave (m, n) has in a field: mean of h exp(-i k x).
Complex waveIn(const std::vector<double>& field, const SeaPatch& p, int m, int n) {
  Complex sum = 0.0;
  for (int j = 0; j < p.points; ++j)
    for (int i = 0; i < p.points; ++i) {
      const double x = static_cast<double>(i) / p.points - 0.5, y = static_cast<double>(j) / p.points - 0.5;
      sum += field[static_cast<size_t>(j * p.points + i)] * std::polar(1.0, -2.0 * kPi * (m * x + n * y));
    }
  return sum / static_cast<double>(p.points * p.points);
}

/// Of what each wave adds to a variance: their sum, and how much that of one sea scatters about it, relative. Powers are exponentially distributed, and a
/// wave and its opposite are one.
struct Expected {
  double sum = 0.0, scatter = 0.0;
};
template <typename Weight>
Expected expectedOf(const SeaPatch& p, Weight&& weight) {
  const WaveSpectrum spectrum(p.wind_m_s, p.inverseWaveAge);
  const double dk = 2.0 * kPi / p.size_m;
  const int most = p.points / 2 - 1;
  Expected e;
  double squares = 0.0;
  for (int n = -most; n <= most; ++n)
    for (int m = -most; m <= most; ++m) {
      if ((m == 0 && n == 0) || m * m + n * n > most * most) continue;
      const double k = dk * std::hypot(m, n), phi = std::atan2(n, m) - p.windTo_rad, w = spectrum.directional(k, phi) * dk * dk * weight(k, phi);
      e.sum += w;
      squares += w * w;
    }
  e.scatter = std::sqrt(2.0 * squares) / e.sum;
  return e;
}

TEST(Fourier, IsTheSum) {
  std::vector<Complex> x;
  for (int i = 0; i < 32; ++i) x.emplace_back(std::sin(1.7 * i * i), std::cos(0.3 * i * i));
  const auto before = x;
  fourierSum(x);
  double worst = 0.0;
  for (int n = 0; n < 32; ++n) {
    Complex sum = 0.0;
    for (int m = 0; m < 32; ++m) sum += before[static_cast<size_t>(m)] * std::polar(1.0, 2.0 * kPi * m * n / 32.0);
    worst = std::max(worst, std::abs(sum - x[static_cast<size_t>(n)]));
  }
  bound("a Fourier sum of 32 against the plain sum", worst, 1e-12, "rounding");
  std::vector<Complex> odd(12);
  EXPECT_THROW(fourierSum(odd), std::invalid_argument);
  EXPECT_THROW(fourierSumSquare(x, 8), std::invalid_argument);
}

// Over many seeds: heights and slopes of the places, and of what lies between the vertices.
TEST(SeaSurface, VariancesAreTheSpectrums) {
  for (double wind : {5.0, 12.0}) {
    SeaPatch p{.wind_m_s = wind, .windTo_rad = 0.7, .size_m = 300.0, .points = 128};
    const SeaMesh expected = seaMoments(p);
    const double c = std::cos(p.windTo_rad), s = std::sin(p.windTo_rad);
    constexpr int kSeeds = 48;
    double height = 0.0, up = 0.0, cross = 0.0, drawnUp = 0.0, drawnCross = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      p.seed = static_cast<std::uint64_t>(seed);
      const SeaField f = seaField(p);
      height += meanSquare(f.height_m) / kSeeds;
      // Corners 1/6, pairs of corners 1/12: a triangle's mean square of what is linear over it.
      const auto at = [&](int i, int j) { return static_cast<size_t>(j % p.points * p.points + i % p.points); };
      for (int j = 0; j < p.points; ++j)
        for (int i = 0; i < p.points; ++i) {
          const auto along = [&](size_t k) { return c * f.slopeX[k] + s * f.slopeY[k]; };
          const auto across = [&](size_t k) { return c * f.slopeY[k] - s * f.slopeX[k]; };
          const double each = 1.0 / (kSeeds * p.points * p.points);
          up += each * std::pow(along(at(i, j)), 2.0);
          cross += each * std::pow(across(at(i, j)), 2.0);
          const auto mean = [&](const auto& of, size_t a, size_t b, size_t d) {
            return (std::pow(of(a), 2.0) + std::pow(of(b), 2.0) + std::pow(of(d), 2.0) + of(a) * of(b) + of(b) * of(d) + of(a) * of(d)) / 6.0;
          };
          for (const size_t third : {at(i + 1, j), at(i, j + 1)}) {
            drawnUp += 0.5 * each * mean(along, at(i, j), third, at(i + 1, j + 1));
            drawnCross += 0.5 * each * mean(across, at(i, j), third, at(i + 1, j + 1));
          }
        }
    }
    const Expected h = expectedOf(p, [](double, double) { return 1.0; }),
                   u = expectedOf(p, [](double k, double phi) { return std::pow(k * std::cos(phi), 2.0); }),
                   v = expectedOf(p, [](double k, double phi) { return std::pow(k * std::sin(phi), 2.0); });
    figure(print("sum over waves, %.0f m/s [m2]", wind), expected.nodes.height_m2, h.sum, 1e-12, "the same sum");
    const auto within = [&](const char* what, double measured, double wanted, double scatter) {
      figure(print("%s of 48 seas, %.0f m/s", what, wind), measured, wanted, 4.0 * scatter / std::sqrt(kSeeds), "4 sigma of exponentially distributed powers");
    };
    within("height's variance", height, expected.nodes.height_m2, h.scatter);
    within("slopes along the wind", up, expected.nodes.slopeUp, u.scatter);
    within("slopes across it", cross, expected.nodes.slopeCross, v.scatter);
    // Short waves, of which there are most, are taken from: the rest scatters more.
    within("between vertices along the wind", drawnUp, expected.drawn.slopeUp, 1.5 * u.scatter);
    within("between vertices across it", drawnCross, expected.drawn.slopeCross, 1.5 * v.scatter);
    EXPECT_LT(drawnUp, up);
  }
}

// The sum over a grid of waves against integrals, and what is left.
TEST(SeaSurface, ExpectationsAreIntegrals) {
  for (double wind : {5.0, 10.0}) {
    const SeaPatch p{.wind_m_s = wind, .size_m = 1000.0, .points = 512};
    const SeaMesh sea = seaMoments(p);
    const WaveSpectrum s(wind);
    const double most = 2.0 * kPi / p.size_m * (p.points / 2 - 0.5);
    const WaveMoments between = s.moments(kPi / p.size_m, most), all = s.moments();
    figure(print("height's variance of a square's waves, %.0f m/s [m2]", wind), sea.nodes.height_m2, between.height_m2, 0.01,
           "a grid of waves, 2 pi / L apart");
    figure(print("slopes, %.0f m/s", wind), sea.nodes.slope(), between.slope(), 0.01, "the same");
    figure(print("drawn and left slopes, %.0f m/s", wind), sea.drawn.slope() + sea.unresolved.slope(), all.slope(), 1e-9, "all");
    figure(print("slopes drawn by a step of %.2f m, %.0f m/s", p.size_m / p.points, wind), drawnSlope(s, p.size_m / p.points), sea.drawn.slope(), 0.03,
           "rounded edge of the grid's waves");
  }
}

// Each wave turns with its own frequency, and goes with the wind.
TEST(SeaSurface, WavesTravel) {
  SeaPatch p{.wind_m_s = 8.0, .windTo_rad = 0.3, .size_m = 60.0, .points = 64, .seed = 5};
  const SeaField now = seaField(p);
  const double step = 0.01;
  p.time_s = step;
  const SeaField then = seaField(p);
  for (const auto& [m, n] : {std::pair{1, 0}, {3, -2}, {0, 4}, {10, 7}}) {
    const double k = 2.0 * kPi / p.size_m * std::hypot(m, n);
    const Complex turn = waveIn(then.height_m, p, m, n) / waveIn(now.height_m, p, m, n);
    figure(print("frequency of wave (%d, %d) [rad/s]", m, n), -std::arg(turn) / step, waveFrequency_rad_s(k), 1e-9, "its dispersion");
    figure("its amplitude", std::abs(turn), 1.0, 1e-9, "kept");
  }
  double forward = 0.0;
  for (size_t i = 0; i < now.height_m.size(); ++i)
    forward -= (then.height_m[i] - now.height_m[i]) * (std::cos(p.windTo_rad) * now.slopeX[i] + std::sin(p.windTo_rad) * now.slopeY[i]);
  EXPECT_GT(forward, 0.0);
}

// Slopes are the heights', and more points add short waves to the same long ones.
TEST(SeaSurface, WavesAreTheirOwn) {
  const SeaPatch coarse{.wind_m_s = 9.0, .size_m = 80.0, .points = 32, .time_s = 2.0, .seed = 9},
      fine{.wind_m_s = 9.0, .size_m = 80.0, .points = 128, .time_s = 2.0, .seed = 9};
  const SeaField a = seaField(coarse), b = seaField(fine);
  for (const auto& [m, n] : {std::pair{1, 1}, {5, -3}, {-7, 2}}) {
    const Complex one = waveIn(a.height_m, coarse, m, n), other = waveIn(b.height_m, fine, m, n), k = Complex(0.0, 2.0 * kPi / coarse.size_m * m);
    EXPECT_NEAR(std::abs(one - other), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(waveIn(a.slopeX, coarse, m, n) - k * one), 0.0, 1e-12);
  }
  const SeaField again = seaField(coarse);
  EXPECT_EQ(again.height_m, a.height_m);
  SeaPatch other = coarse;
  other.seed = 10;
  EXPECT_NE(seaField(other).height_m, a.height_m);
}

TEST(SeaSurface, MeshIsWhole) {
  for (double choppiness : {0.0, 0.8}) {
    const SeaPatch p{.wind_m_s = 6.0, .size_m = 100.0, .points = 64, .time_s = 1.0, .choppiness = choppiness, .seed = 3};
    const SeaMesh sea = makeSea(p);
    const Mesh& m = sea.mesh;
    ASSERT_EQ(m.positions.size(), 65u * 65u);
    ASSERT_EQ(m.normals.size(), m.positions.size());
    ASSERT_EQ(m.uv.size(), m.positions.size());
    ASSERT_EQ(m.triangles.size(), 2u * 64u * 64u);
    ASSERT_EQ(m.parts.size(), 1u);
    EXPECT_EQ(m.parts[0].triangleCount, m.triangles.size());
    EXPECT_TRUE(m.heightField);
    EXPECT_FALSE(m.closed);
    double area = 0.0, along = 0.0, worst = 0.0;
    for (const auto& t : m.triangles) {
      const glm::dvec3 a = m.positions[t.x], b = m.positions[t.y], c = m.positions[t.z], n = glm::cross(b - a, c - a);
      EXPECT_GT(n.z, 0.0);
      area += 0.5 * n.z;
      along +=
          glm::dot(glm::normalize(n), glm::normalize(glm::dvec3(m.normals[t.x] + m.normals[t.y] + m.normals[t.z]))) / static_cast<double>(m.triangles.size());
    }
    for (size_t i = 0; i < m.normals.size(); ++i) worst = std::max(worst, std::abs(1.0 - static_cast<double>(glm::length(m.normals[i]))));
    figure(print("area seen from above, choppiness %.1f [m2]", choppiness), area, 1e4, 1e-5, "it repeats: moved sideways it covers the same");
    figure(print("normals against triangles, choppiness %.1f", choppiness), along, 1.0, 2e-3, "waves of two steps");
    bound("normals' length", worst, 1e-6, "single precision");
    // One edge continues the other.
    double gap = 0.0;
    for (size_t k = 0; k <= 64; ++k) {
      gap = std::max(gap, static_cast<double>(glm::length(m.positions[k * 65 + 64] - m.positions[k * 65] - glm::vec3(100.0f, 0.0f, 0.0f))));
      gap = std::max(gap, static_cast<double>(glm::length(m.positions[64 * 65 + k] - m.positions[k] - glm::vec3(0.0f, 100.0f, 0.0f))));
    }
    bound("gap between squares side by side [m]", gap, 2e-5, "single precision");
  }
}

// Level motion draws crests together: mean of height x stretch = -choppiness x sum of k Psi. Neighbouring seeds are other seas.
TEST(SeaSurface, ChoppinessDrawsCrestsTogether) {
  constexpr int kSeeds = 32;
  SeaPatch p{.wind_m_s = 8.0, .size_m = 200.0, .points = 128, .choppiness = 0.7};
  const Expected e = expectedOf(p, [](double k, double) { return k; });
  double sum = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    p.seed = static_cast<std::uint64_t>(seed);
    const SeaField f = seaField(p);
    const auto n = static_cast<double>(f.height_m.size());
    double area = 0.0;
    for (size_t i = 0; i < f.height_m.size(); ++i) {
      area += ((1.0 + f.stretchXX[i]) * (1.0 + f.stretchYY[i]) - f.stretchXY[i] * f.stretchXY[i]) / n;
      sum += f.height_m[i] * (f.stretchXX[i] + f.stretchYY[i]) / (n * kSeeds);
    }
    EXPECT_NEAR(area, 1.0, 1e-9);  // it repeats
  }
  figure("height x stretch [m]", sum, -p.choppiness * e.sum, 4.0 * e.scatter / std::sqrt(kSeeds), "4 sigma of exponentially distributed powers");
  const SeaField one = seaField({.seed = 1}), two = seaField({.seed = 2});
  double both = 0.0;
  const SeaPatch usual;
  for (const auto& [m, k] : {std::pair{3, 2}, {7, -1}, {5, 4}})
    both = std::max(both, std::abs(std::arg(waveIn(two.height_m, usual, m, k) / waveIn(one.height_m, usual, m + 1, k))));
  EXPECT_GT(both, 0.1);
}

TEST(SeaSurface, MistakesAreRefused) {
  EXPECT_THROW(makeSea({.points = 100}), std::invalid_argument);
  EXPECT_THROW(makeSea({.points = 4096}), std::invalid_argument);
  EXPECT_THROW(makeSea({.size_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(makeSea({.choppiness = 1.5}), std::invalid_argument);
  EXPECT_THROW(makeSea({.time_s = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(makeSea({.wind_m_s = -1.0}), std::invalid_argument);
  EXPECT_THROW(drawnSlope(WaveSpectrum(5.0), 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace pitviper::test
