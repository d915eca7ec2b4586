// Textures over what a pixel covers: the choice of places, levels, moments, and the two temperatures that stand for a distribution.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/radiometry/physics.hpp"
#include "sim/scene/texture.hpp"

namespace pitviper {
namespace {

Texture noise(int width, int height, double low, double high, unsigned seed, bool repeats) {
  std::mt19937 random(seed);
  Texture t;
  t.width = width, t.height = height, t.repeats = repeats;
  for (int i = 0; i < width * height; ++i) t.texels.push_back(static_cast<float>(low + (high - low) * static_cast<double>(random() % 1024) / 1023.0));
  makeLevels(t, true);
  return t;
}

/// Of what is read over a parallelogram, by brute force.
struct Brute {
  double mean = 0.0, radiance = 0.0;
};
Brute brute(const Texture& t, glm::dvec2 uv, const Footprint& f, double um, int n) {
  Brute b;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double v = textureValue(t, uv + ((i + 0.5) / n - 0.5) * f.across + ((j + 0.5) / n - 0.5) * f.up);
      b.mean += v / (n * n);
      b.radiance += physics::planckRadiance(um, v) / (n * n);
    }
  return b;
}

double planckOf(const TextureMoments& m, double um) {
  const glm::dvec3 two = physics::twoTemperatures(m.mean, m.second, m.third);
  return (1.0 - two.z) * physics::planckRadiance(um, two.x) + two.z * physics::planckRadiance(um, two.y);
}

// Rectangle and parallelogram have the same second moments: a a^T + b b^T.
TEST(TextureFilter, PlacesCoverWhatThePixelDoes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(-20.0, 20.0);
  for (int n = 0; n < 200; ++n) {
    const glm::dvec2 a(side(random), side(random)), b(side(random), side(random));
    const physics::Taps t = physics::tapsOf(a, b, 2.0, 4.0, 16.0, 12);
    const glm::dvec2 along = t.along * static_cast<double>(t.alongCount), across = t.across * static_cast<double>(t.acrossCount);
    const double scale = glm::dot(a, a) + glm::dot(b, b);
    EXPECT_NEAR(a.x * a.x + b.x * b.x, along.x * along.x + across.x * across.x, 2e-3 * scale) << "where it is nearly round the pixel's own sides are taken";
    EXPECT_NEAR(a.x * a.y + b.x * b.y, along.x * along.y + across.x * across.y, 2e-3 * scale);
    EXPECT_NEAR(a.y * a.y + b.y * b.y, along.y * along.y + across.y * across.y, 2e-3 * scale);
    EXPECT_LE(t.acrossCount, 4);
    EXPECT_LE(t.alongCount, 16);
    // No gaps: places lie closer than the texels that they read.
    const double texel = std::ldexp(1.0, t.level);
    EXPECT_LE(glm::length(t.along), texel);
    EXPECT_LE(glm::length(t.across), texel);
  }
}

// Levels hold means and moments of the whole, whatever the size: sums don't drift from level to level.
TEST(TextureFilter, LevelsKeepTheMoments) {
  for (const auto& [w, h] : {std::pair{16, 16}, {37, 5}, {1, 9}, {100, 63}}) {
    const Texture t = noise(w, h, 250.0, 1000.0, 5, true);
    double m1 = 0.0, m2 = 0.0, m3 = 0.0;
    const int fine = 24 * std::max(w, h);
    for (int j = 0; j < fine; ++j)
      for (int i = 0; i < fine; ++i) {
        const double v = textureValue(t, {(i + 0.5) / fine, (j + 0.5) / fine}) - 600.0;
        m1 += v, m2 += v * v, m3 += v * v * v;
      }
    const double n = static_cast<double>(fine) * fine;
    m1 /= n, m2 /= n, m3 /= n;
    const TextureLevel& last = t.levels.back();
    ASSERT_EQ(last.mean.size(), 1u);
    // Midpoints: (1 / 24)^2 / 12 of what bends.
    EXPECT_NEAR(static_cast<double>(last.mean[0]), 600.0 + m1, 2e-4 * 750.0) << w << "x" << h;
    EXPECT_NEAR(static_cast<double>(last.second[0]), m2 - m1 * m1, 2e-3 * (m2 - m1 * m1)) << w << "x" << h;
    EXPECT_NEAR(static_cast<double>(last.third[0]), m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1, 5e-3 * std::pow(m2 - m1 * m1, 1.5)) << w << "x" << h;
  }
}

// Two values in any shares are met exactly; moments in any case.
TEST(TextureFilter, TwoTemperatures) {
  for (double share : {0.001, 0.1, 0.5, 0.8, 0.9999}) {
    const double low = 280.0, high = 1100.0, mean = (1.0 - share) * low + share * high, a = low - mean, b = high - mean;
    const glm::dvec3 two = physics::twoTemperatures(mean, (1.0 - share) * a * a + share * b * b, (1.0 - share) * a * a * a + share * b * b * b);
    EXPECT_NEAR(two.x, low, 1e-9 * low) << share;
    EXPECT_NEAR(two.y, high, 1e-9 * high) << share;
    EXPECT_NEAR(two.z, share, 1e-9) << share;
  }
  const glm::dvec3 even = physics::twoTemperatures(300.0, -1e-9, 0.0);
  EXPECT_EQ(even.x, 300.0);
  EXPECT_EQ(even.y, 300.0);
}

// A pixel of less than half a texel beside a hot one: what it does not see is not in it. (Squares of texels were mixed in at any size.)
TEST(TextureFilter, NoHaloBesideWhatIsHot) {
  Texture t;
  t.width = 8, t.height = 1;
  for (float k : {1000.0f, 1000.0f, 1000.0f, 300.0f, 300.0f, 300.0f, 300.0f, 300.0f}) t.texels.push_back(k);
  makeLevels(t, true);
  for (double width : {0.01, 0.1, 0.3, 0.45})
    for (double x : {3.8, 4.2, 5.0}) {
      const TextureMoments m = textureMoments(t, {x / 8.0, 0.5}, {{width / 8.0, 0.0}, {0.0, width}}, tapsFor(0.01));
      EXPECT_NEAR(m.mean, 300.0, 1e-9) << width << " at " << x;
      EXPECT_NEAR(m.second, 0.0, 1e-9) << width << " at " << x;
    }
}

// Footprints of any length, edge on and none at all.
TEST(TextureFilter, AnyFootprint) {
  const Texture t = noise(33, 7, 280.0, 300.0, 9, true);
  for (double size : {0.0, 1e-30, 1e-3, 1.0, 1e6, 1e30})
    for (const Footprint& f : {Footprint{{size, 0.0}, {0.0, size}}, Footprint{{size, 0.0}, {size, 0.0}}, Footprint{{size, size}, {-size, 1e-9}}}) {
      const TextureMoments m = textureMoments(t, {0.3, 0.4}, f, tapsFor(0.01));
      EXPECT_TRUE(m.mean > 279.9 && m.mean < 300.1) << size << ": " << m.mean;
      EXPECT_TRUE(m.second > -1e-6 && m.second < 101.0) << size << ": " << m.second;
    }
}

// Random textures under random footprints, from parts of a texel to half the texture, square and grazing: noise, whose texels have nothing to do with each
// other, and fields 16 texels wide.
TEST(TextureFilter, AgainstBruteForce) {
  Texture noisy = noise(256, 256, 280.0, 300.0, 1, true), fields = noisy;
  for (size_t i = 0; i < fields.texels.size(); ++i)
    fields.texels[i] = 280.0f + 20.0f * static_cast<float>((i % 256 / 16 * 7919 + i / 4096 * 104729) % 17) / 16.0f;
  makeLevels(fields, true);
  struct Case {
    double accuracy;
    double noise, fields;  ///< root mean square, of the texture's range: as found, with a fifth to spare
    double planck;         ///< of what the mean does not explain: too few places don't see all that there is
  };
  for (const Case& c : {Case{0.1, 0.027, 0.026, 0.03}, {0.01, 0.019, 0.013, 0.015}, {1e-3, 0.014, 0.008, 0.015}, {1e-4, 0.015, 0.008, 0.012}}) {
    for (const auto& [texture, allowed] : {std::pair{&noisy, c.noise}, {&fields, c.fields}}) {
      std::mt19937 random(11);
      std::uniform_real_distribution<double> unit(0.0, 1.0);
      double square = 0.0, planck = 0.0;
      const int count = 400;
      for (int n = 0; n < count; ++n) {
        const double size = std::exp(std::log(0.2) + unit(random) * std::log(300.0)) / 256.0, turn = 6.28 * unit(random),
                     grazing = 1.0 + 8.0 * unit(random) * unit(random);
        const glm::dvec2 axis(std::cos(turn), std::sin(turn));
        const Footprint f{size * axis, size * grazing * glm::dvec2(-axis.y, axis.x)};
        const glm::dvec2 uv(unit(random), unit(random));
        TextureMoments m = textureMoments(*texture, uv, f, tapsFor(c.accuracy));
        const Brute b = brute(*texture, uv, f, 4.0, 64);
        const double off = (m.mean - b.mean) / 20.0;
        square += off * off / count;
        m.mean = b.mean;
        planck = std::max(planck, std::abs(planckOf(m, 4.0) / b.radiance - 1.0));
      }
      RecordProperty("rms", std::to_string(std::sqrt(square)));
      EXPECT_LT(std::sqrt(square), allowed) << c.accuracy;
      EXPECT_LT(planck, c.planck) << c.accuracy;
    }
  }
}

}  // namespace
}  // namespace pitviper
