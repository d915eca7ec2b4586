// Cumulus clouds: noise, shapes, the cover of a field, and what a scenario may ask for.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "materials/fields/cloud_field.hpp"
#include "materials/fields/cloud_light.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(Cumulus, NoiseIsTheSameEverywhere) {
  // Of integers alone: its values at nodes are those of a hash, the mean over many 0, the variance that of even numbers from -1 to 1, 1/3.
  double sum = 0.0, square = 0.0;
  constexpr int kSide = 40;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j)
      for (int k = 0; k < kSide; ++k) {
        const double v = valueNoise({i - 20.0, j - 20.0, k - 20.0}, 7);
        sum += v, square += v * v;
      }
  const double count = kSide * kSide * kSide;
  figure("mean of noise", 1.0 + sum / count, 1.0, 0.01, "four standard errors of 64 000 even numbers");
  figure("variance of noise", square / count, 1.0 / 3.0, 0.015, "even numbers from -1 to 1");
  EXPECT_EQ(valueNoise({0.5, 0.25, 3.0}, 7), valueNoise({0.5, 0.25, 3.0}, 7));
  EXPECT_NE(valueNoise({0.5, 0.25, 3.0}, 7), valueNoise({0.5, 0.25, 3.0}, 8));
  // No steps between cells.
  figure("noise across a node", 1.0 + valueNoise({2.0 - 1e-9, 0.4, 0.6}, 3) - valueNoise({2.0 + 1e-9, 0.4, 0.6}, 3), 1.0, 1e-7, "its neighbour");
}

TEST(Cumulus, StandsOnItsBaseWithinItsGrid) {
  const CumulusShapeOptions o{1000.0, 700.0, 0.6, 5};
  const DensityGrid grid = cumulusGrid(o, 32, 25.0);
  double largest = 0.0;
  for (int j = 0; j < grid.nodes.y; ++j)
    for (int i = 0; i < grid.nodes.x; ++i) {
      double column = 0.0;
      for (int k = 0; k < grid.nodes.z; ++k) column += grid.value[grid.index(i, j, k)] * grid.spacing.z;
      largest = std::max(largest, column);
      EXPECT_EQ(grid.value[grid.index(i, j, 0)], 0.0f);
    }
  figure("largest optical depth of a cloud", largest, 25.0, 1e-5, "as asked; single precision");
  EXPECT_EQ(CumulusShape(o).extinction({0.0, 0.0, -1.0}), 0.0);
  EXPECT_EQ(CumulusShape(o).extinction({5000.0, 0.0, 100.0}), 0.0);
}

// In the middle of a cloud that turns nothing away, light of the sky and of the ground add up to 1, half of each by symmetry about the middle of a slab.
TEST(Cumulus, LightOfSkyAndGroundIsWhole) {
  DensityGrid slab({9, 9, 17}, {-4e4, -4e4, 0.0}, {1e4, 1e4, 50.0});
  for (int k = 1; k < 16; ++k)
    for (int n = 0; n < 81; ++n) slab.value[slab.index(n % 9, n / 9, k)] = 0.02f;
  const auto texels = cloudNumbers(slab, {0.0, 0.0, 1.0}, true);
  const std::size_t middle = kCloudTexels * slab.index(4, 4, 8);
  figure("light of the sky in the middle of a slab", texels[middle].z, 0.5, 2e-3, "symmetry");
  figure("optical depth to the sun above the middle of a slab", texels[middle].y, 0.02 * 50.0 * 7.5, 0.01, "sum over nodes");
}

// Three clouds, one behind another as the sun sees them; places on the ground, among them and above.
TEST(Cumulus, ShadeIsWhatStandsBeforeTheSun) {
  for (const double elevation : {0.2, 0.7, 1.5}) {
    const glm::dvec3 toSun(std::cos(elevation) * 0.6, std::cos(elevation) * 0.8, std::sin(elevation));
    CloudSet clouds(toSun, true);
    for (const std::uint32_t seed : {1u, 2u, 3u})
      clouds.add(std::make_shared<const CloudBody>(CloudBodyOptions{{900.0, 600.0, 0.4, seed}, 24, 20.0}), {500.0 * seed, 700.0 * seed, 1000.0 + 50.0 * seed});
    const SunShadeGrid& grid = clouds.grid();
    double square = 0.0, most = 0.0;
    int shaded = 0;
    for (int k = 0; k < 4000; ++k) {
      const auto part = [k](double step) { return std::fmod(k * step, 1.0); };
      // About the clouds, then down towards the ground along the sun's line.
      glm::dvec3 p(4000.0 * part(0.7548776662) - 1000.0, 4500.0 * part(0.5698402910) - 1000.0, 1000.0 + 800.0 * part(0.3819660113));
      if (k % 2 == 0) p -= (p.z - 5.0) / toSun.z * toSun;
      double depth = 0.0;
      for (std::size_t c = 0; c < clouds.size(); ++c) depth += clouds.body(c).density().along(p - clouds.base(c), toSun, 0.25);
      square += std::pow(grid.at(p) - depth, 2), most = std::max(most, depth);
      shaded += depth > 0.5;
    }
    EXPECT_GT(shaded, 200);
    figure("shade of clouds under a sun of " + std::to_string(elevation) + " rad, rms over the largest", 1.0 + std::sqrt(square / 4000.0) / most, 1.0, 0.003,
           "the integral; nodes half as far apart as the clouds' own");
    EXPECT_EQ(grid.at({2000.0, 2000.0, 9000.0}), 0.0);
  }
}

// Behind an even depth the beam is weaker by exp(-c depth) everywhere, and with it all that comes of it: the equation is linear.
TEST(Cumulus, IsDimmedByWhatStandsBeforeIt) {
  const DensityGrid grid = cumulusGrid({700.0, 500.0, 0.4, 3}, 16, 12.0);
  const glm::dvec3 toSun(0.6, 0.0, 0.8);
  const auto alone = cloudNumbers(grid, toSun, true), behind = cloudNumbers(grid, toSun, true, std::vector<float>(grid.value.size(), 3.0f));
  const glm::dvec4 albedos = physics::cloudAlbedos();
  const std::size_t n = kCloudTexels * grid.index(8, 8, grid.nodes.z / 2);
  for (int i = 0; i < 4; ++i)
    figure("sunlight in a cloud behind a depth of 3, albedo " + std::to_string(albedos[i]), behind[n + 1][i] / alone[n + 1][i],
           std::exp(-3.0 * physics::cloudScale(albedos[i], 0.85)), 1e-3, "linearity; the iteration's residual");
  figure("depth to the sun", behind[n].y - alone[n].y, 3.0, 1e-5, "as told");
}

// Of two clouds in line the farther is lit through the nearer, the nearer as if alone; of two side by side both.
TEST(Cumulus, CloudsShadeEachOther) {
  const glm::dvec3 toSun(0.6, 0.0, 0.8);
  const auto body = std::make_shared<const CloudBody>(CloudBodyOptions{{700.0, 500.0, 0.4, 3}, 16, 12.0});
  const auto sunlight = [&](const CloudSet& set, std::size_t cloud) {
    double sum = 0.0;
    const auto& texels = set.texels(cloud)->texel;
    for (std::size_t n = 5; n < texels.size(); n += kCloudTexels) sum += static_cast<double>(texels[n].x) * static_cast<double>(texels[n + 1].x);
    return sum;
  };
  CloudSet inLine(toSun, true), apart(toSun, true), without(toSun, false);
  for (CloudSet* set : {&inLine, &without}) set->add(body, {0.0, 0.0, 1000.0}), set->add(body, glm::dvec3(0.0, 0.0, 1000.0) + 1500.0 * toSun);
  apart.add(body, {0.0, 0.0, 1000.0}), apart.add(body, {0.0, 3000.0, 1000.0});
  EXPECT_LT(sunlight(inLine, 0), 0.5 * sunlight(inLine, 1));
  EXPECT_EQ(sunlight(inLine, 1), sunlight(apart, 0));
  EXPECT_EQ(apart.texels(0), apart.texels(1));
  EXPECT_EQ(sunlight(without, 0), sunlight(inLine, 1));
}

TEST(Cumulus, FieldsCoverWhatIsAsked) {
  for (const double cover : {0.1, 0.25, 0.4}) {
    CumulusFieldOptions o;
    o.cover = cover, o.side_m = 8000.0, o.most = 128, o.seed = 4;
    const CumulusField f = cumulusField(o), again = cumulusField(o);
    figure("cover of " + std::to_string(f.clouds.size()) + " clouds", f.cover, cover, 0.1, "as asked; the last cloud is whole");
    ASSERT_EQ(f.clouds.size(), again.clouds.size());
    for (std::size_t k = 0; k < f.clouds.size(); ++k) {
      EXPECT_EQ(f.clouds[k].at, again.clouds[k].at);
      for (std::size_t n = 0; n < k; ++n)
        EXPECT_GT(glm::length(f.clouds[k].at - f.clouds[n].at),
                  0.5 * (f.shapes[static_cast<std::size_t>(f.clouds[k].shape)].width_m + f.shapes[static_cast<std::size_t>(f.clouds[n].shape)].width_m) - 1e-9);
    }
  }
  CumulusFieldOptions few;
  few.most = 3;
  EXPECT_EQ(cumulusField(few).clouds.size(), 3u);
}

/// Power of wave numbers 1 to `most` of a row.
std::vector<double> powerOf(const std::vector<double>& row, int most) {
  std::vector<double> power(static_cast<std::size_t>(most) + 1, 0.0);
  const auto count = static_cast<double>(row.size());
  for (int k = 1; k <= most; ++k) {
    std::complex<double> sum(0.0), turn(1.0);
    const std::complex<double> each = std::polar(1.0, -2.0 * kPi * k / count);
    for (std::size_t i = 0; i < row.size(); ++i, turn *= each) sum += row[i] * std::sin(kPi * (static_cast<double>(i) + 0.5) / count) * turn;
    power[static_cast<std::size_t>(k)] = std::norm(sum);
  }
  return power;
}

// Rationale: clutter is told by its spectrum. Expected: transects of the optical depth of fields of cumulus have about k^-3 below 5 km (Barker and Davies 1992,
// Remote Sens. Environ. 42, 51): here from 4 km to 100 m, by means over half octaves; "about" is taken as 0.5.
TEST(Cumulus, FieldsHaveTheSpectrumOfFairWeather) {
  constexpr int kRow = 512, kRows = 96;
  constexpr double kApart_m = 40.0;
  for (const double cover : {0.1, 0.3}) {
    CumulusFieldOptions o;
    o.side_m = kRow * kApart_m, o.cover = cover, o.most = 2000, o.shapes = 16, o.seed = 2, o.narrowest_m = 200.0;
    const CumulusField f = cumulusField(o);
    std::vector<CumulusShape> shapes(f.shapes.begin(), f.shapes.end());
    const auto most = static_cast<int>(kRow * kApart_m / 100.0);
    std::vector<double> power(static_cast<std::size_t>(most) + 1, 0.0);
    for (int j = 0; j < kRows; ++j) {
      std::vector<double> row(kRow, 0.0);
      const double y = o.side_m * ((j + 0.5) / kRows - 0.5);
      for (const CumulusField::Place& c : f.clouds) {
        const CumulusShape& shape = shapes[static_cast<std::size_t>(c.shape)];
        if (std::abs(y - c.at.y) > shape.halfExtent_m()) continue;
        for (int i = 0; i < kRow; ++i)
          if (const double x = kApart_m * (i + 0.5) - 0.5 * o.side_m - c.at.x; std::abs(x) < shape.halfExtent_m())
            row[static_cast<std::size_t>(i)] += shape.column(x, y - c.at.y, 24);
      }
      const auto own = powerOf(row, most);
      for (std::size_t k = 0; k < power.size(); ++k) power[k] += own[k];
    }
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, count = 0.0;
    for (double low = kRow * kApart_m / 4000.0; low < most; low *= std::sqrt(2.0)) {
      double sum = 0.0, logs = 0.0, bins = 0.0;
      for (int k = static_cast<int>(std::ceil(low)); k < std::min(low * std::sqrt(2.0), most + 1.0); ++k, ++bins)
        sum += power[static_cast<std::size_t>(k)], logs += std::log(k);
      if (bins == 0.0) continue;
      const double x = logs / bins, y = std::log(sum / bins);
      sx += x, sy += y, sxx += x * x, sxy += x * y, ++count;
    }
    figure("power of optical depth along lines through " + std::to_string(f.clouds.size()) + " clouds, exponent [ratio to -3]",
           (count * sxy - sx * sy) / (count * sxx - sx * sx) / -3.0, 1.0, 0.5 / 3.0, "Barker and Davies 1992");
  }
}

TEST(Cumulus, MistakesAreToldWithTheirPlace) {
  const std::string camera =
      "cameras:\n  - {name: c, film: {width: 4, height: 4}, field_of_view: 8 deg, aperture: 10 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, pitch: 0 deg, "
      "channels: [{name: mw, response: {band: [4 um, 5 um]}}]}\n";
  for (const auto& [text, told] : std::vector<std::pair<std::string, std::string>>{
           {"{name: a}", "a cloud nowhere"},
           {"{name: a, position: [0 m, 1 km, 1 km], width: 10 m}", "width"},
           {"{name: a, position: [0 m, 1 km, 1 km], radius: 10 m}", "radius"},
           {"{name: a, position: [0 m, 1 km, 1 km], seed: -1}", "seed"},
           {"{name: a, position: [0 m, 1 km, 1 km], field: {side: 3 km}}", "cover"},
           {"{name: a, position: [0 m, 1 km, 1 km], width: 1 km, field: {cover: 0.3}}", "'width' of a field"},
           {"{name: a, position: [0 m, 1 km, 1 km], field: {cover: 0.3, narrowest: 2 km, widest: 1 km}}", "widest is narrower"},
           {"{name: a, position: [0 m, 1 km, 1 km], field: {cover: 0.3, side: 1 km}}", "wider than the square"},
           {"{name: a, position: [0 m, 1 km, 1 km], field: {cover: 0.01, side: 3 km, narrowest: 1 km}}", "so little cover"},
           {"{name: a, position: [0 m, 1 km, 1 km], resolution: 128, width: 500 m, depth: 6000 m}", "more clouds than"},
           {"{name: a, position: [0 m, 1 km, 1 km], cover: 0.3}", "unknown key 'cover'"}}) {
    try {
      scene("clouds: [" + text + "]\n" + camera);
      ADD_FAILURE() << text;
    } catch (const UserError& e) {
      EXPECT_NE(std::string(e.what()).find(told), std::string::npos) << text << ": " << e.what();
      EXPECT_NE(std::string(e.what()).find("test.yaml:1:"), std::string::npos) << e.what();
    }
  }
  const Simulation sim =
      scene("clouds: [{name: a, position: [0 m, 1 km, 1 km]}, {name: b, position: [0 m, 9 km, 1 km], field: {cover: 0.1, side: 4 km}}]\n" + camera);
  EXPECT_GT(sim.fields.size(), 2u);
  EXPECT_TRUE(sim.fields.back().source->droplets());
}

}  // namespace
}  // namespace pitviper::test
