// The sun near the horizon: its disc's visible part against closed forms, and direct sunlight through layered air against straight lines worked out here.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "atmosphere/layered.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/world/sun_legs.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

/// Of a disc of radius 1 whose centre is x above a straight horizon: share above it, and height of that part's middle, by acos and its integral.
double segmentShare(double x) { return (std::acos(-x) + x * std::sqrt(1.0 - x * x)) / kPi; }
double segmentMiddle(double x) {
  double area = 0.0, moment = 0.0;
  static const auto nodes = gaussLegendre(200, 0.0, 1.0);
  for (const QuadratureNode& n : nodes) {
    // y = 1 - (1 + x) t^2 from the centre: strips close together at the limb, where the width has a root.
    const double y = 1.0 - (1.0 + x) * n.x * n.x, strip = 2.0 * std::sqrt(std::max(1.0 - y * y, 0.0)) * 2.0 * (1.0 + x) * n.x * n.weight;
    area += strip, moment += strip * (y + x);
  }
  return moment / area;
}

TEST(LowSun, DiscIsACirclesSegment) {
  double share = 0.0, middle = 0.0, half = 0.0;
  for (int i = -999; i <= 999; ++i) {
    const double x = 1e-3 * i;
    share = std::max(share, std::abs(physics::sunShare(x) - segmentShare(x)));
    middle = std::max(middle, std::abs(x + physics::sunRise(x) - segmentMiddle(x)));
    half = std::max(half, std::abs(physics::sunShare(x) + physics::sunShare(-x) - 1.0));
  }
  bound("sun's disc above the horizon, share, against acos", share, 1e-7, "arc tangent of single precision");
  bound("the same, middle of what is up over the horizon, in radii", middle, 2e-4, "thin segments by 2/5 of their height");
  bound("share of x and of -x, sum less 1", half, 1e-15, "rounding");
  EXPECT_EQ(physics::sunShare(1.0), 1.0);
  EXPECT_EQ(physics::sunShare(-1.0), 0.0);
  EXPECT_EQ(physics::sunRise(1.0), 0.0);
  EXPECT_NEAR(physics::sunRadius(), std::sqrt(6.7943e-5 / kPi), 1e-7);
}

TEST(LowSun, HorizonDropsWithHeight) {
  const double radius = 6371000.0;
  double worst = 0.0;
  for (double height : {0.0, 2.0, 100.0, 1e4, 4e5, 3.6e7})
    for (double off_deg : {-0.2, -0.05, 0.0, 0.1, 0.26}) {
      const long double dip = std::acos(static_cast<long double>(radius) / (radius + height)), off = static_cast<long double>(off_deg * kDegree);
      const double x = physics::sunAboveHorizon(height, static_cast<double>(std::sin(off - dip)), radius);
      worst = std::max(worst, std::abs(x - static_cast<double>(off) / physics::sunRadius()));
    }
  bound("sun's centre over the horizon, 0 to 36000 km up, in radii", worst, 1e-5, "sine for the angle: 0.26 deg squared / 6");
  EXPECT_EQ(risenSun(0.0, std::sin(-0.3 * kDegree), radius).share, 0.0);
  EXPECT_EQ(risenSun(10000.0, std::sin(-2.0 * kDegree), radius).share, 1.0);
  EXPECT_EQ(risenSun(3.6e7, 1.0, radius).share, 1.0);
  EXPECT_NEAR(risenSun(-100.0, 0.0, radius).share, 0.5, 1e-9);
}

/// Air at the same places of both.
std::shared_ptr<const Atmosphere> air() {
  AbsorberTable table = AbsorberTable::read(std::filesystem::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
  table.removeAerosol();
  return makeLayeredAir(std::move(table));
}

TEST(LowSun, TablesOfWaysToTheSun) {
  const double radius = LocalFrame().earthRadius_m();
  // Of haze that ends at 3 km: optical depths at 0.55 um of haze alone.
  double most = 0.0, low = 0.0, high = 0.0, gases = 0.0;
  for (double visibility_km : {1.0, 10.0, 23.0}) {
    AbsorberTable table = AbsorberTable::read(std::filesystem::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
    table.setVisibility(visibility_km);
    const auto path = makeLayeredAir(std::move(table));
    const AirNode node = path->node(0.55);
    std::mt19937 random(3);
    const auto between = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
    for (double sun_deg : {-9.0, -5.0, -3.0, -2.0, -0.6, -0.1, 0.3, 1.0, 2.0, 8.0, 30.0, 89.0}) {
      const auto legs = SunLegs::of(path, std::sin(sun_deg * kDegree), radius);
      for (int n = 0; n < 400; ++n) {
        const double height = n % 2 ? between(0.0, 4000.0) : between(0.0, sun_deg < -2.5 ? 90000.0 : 30000.0);
        const RisenSun sun = risenSun(height, std::min(std::sin(sun_deg * kDegree) + between(-0.01, 0.01), 1.0), radius);
        if (!(sun.share > 0.0)) continue;
        const AirAmounts near = legs->at(height, sun.sinElevation), exact = path->amounts({height, sun.sinElevation, radius}, physics::kFar);
        const double depth = Atmosphere::depthOf(node, path->powered(exact)), error = std::abs(Atmosphere::depthOf(node, path->powered(near)) - depth);
        if (depth > 20.0) continue;  // exp(-20): no sunlight to speak of
        if (visibility_km < 5.0) most = std::max(most, error);
        else (sun.sinElevation < 0.035 ? low : high) = std::max(sun.sinElevation < 0.035 ? low : high, error);
        for (size_t k = 0; k < path->exponents().size(); ++k)
          if (node.haze[k] == 0.0 && exact.amount[k] > 1e-3) gases = std::max(gases, std::abs(near.amount[k] / exact.amount[k] - 1.0));
      }
    }
  }
  bound("depth of hazy air towards the sun by table, sun from 2 deg up", high, 1e-3, "cubic between elevations, linear between heights");
  bound("the same, sun below", low, 0.02, "metres below where haze ends");
  bound("the same, fog that ends at 3 km", most, 0.15, "the same");
  bound("amounts of its gases, relative", gases, 2e-3, "the same");
}

TEST(LowSun, WaysToTheSunThroughClearAir) {
  const auto path = air();
  const double radius = LocalFrame().earthRadius_m();
  double low = 0.0, high = 0.0, aloft = 0.0;
  for (double sun_deg : {-2.0, -0.1, 0.3, 1.0, 2.0, 8.0, 30.0, 89.0}) {
    const auto legs = SunLegs::of(path, std::sin(sun_deg * kDegree), radius);
    for (double height : {0.0, 3.0, 260.0, 1777.0, 5000.0, 8200.0, 14321.0, 29000.0})
      for (double off : {-0.01, -0.003, 0.0, 0.0021, 0.01}) {
        const RisenSun sun = risenSun(height, std::min(std::sin(sun_deg * kDegree) + off, 1.0), radius);
        if (!(sun.share > 0.0)) continue;
        const AirAmounts near = legs->at(height, sun.sinElevation), exact = path->amounts({height, sun.sinElevation, radius}, physics::kFar);
        double& worst = height > 3000.0 ? aloft : sun.sinElevation < 0.035 ? low : high;
        for (size_t k = 0; k < path->exponents().size(); ++k)
          if (exact.amount[k] > 1e-6) worst = std::max(worst, std::abs(near.amount[k] / exact.amount[k] - 1.0));
      }
  }
  bound("amounts of air towards the sun by table, up to 3 km, sun below 2 deg, relative", low, 3e-3, "cubic between elevations, linear between heights");
  bound("the same, sun from 2 deg up", high, 1e-3, "the same");
  bound("the same, from 3 to 29 km", aloft, 5e-2, "water, of which there is next to nothing, towards a sun below the level; else 4e-3");
}

/// A white plate that stands facing the sun's azimuth, seen from 5 m away.
double plateInSun(double height_m, double elevation_deg, double um, const std::string& accuracy) {
  return renderFrame(
             scene(
                 "atmosphere: clear_us76\naccuracy: " + accuracy + "\nsun: {azimuth: 180 deg, elevation: " + print("%.9g", elevation_deg) +
                 " deg, irradiance: 1000 W/(m2 um)}\nmaterials: {w: {components: [{reflection: lambertian, reflectance: 1.0}]}}\n"
                 "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: w, temperature: 0 K, heading: 180 deg, position: [0 m, 0 m, " +
                 print("%.9g", height_m) +
                 " m]}]\ncameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 5 mm, position: [0 m, -5 m, " +
                 print("%.9g", height_m) + " m], look_at: p, small_bodies: 0, channels: [{name: a, response: {band: [" + print("%.9g", um - 1e-3) + " um, " +
                 print("%.9g", um + 1e-3) + " um]}, output: radiance_per_um}]}]\n"))
      .layers[0]
      .pixels[0];
}

/// Straight through the air from a height: densities in steps of 200 m and less, amounts to their powers.
double transmittanceToSun(const Atmosphere& path, double height_m, double elevation_rad, double um) {
  const double r0 = LocalFrame().earthRadius_m() + height_m, sine = std::sin(elevation_rad);
  AirAmounts sum;
  for (double s = 0.0, step; s < 2.5e6; s += step) {
    step = 10.0 + 1e-3 * s;
    const double at = s + 0.5 * step, h = std::sqrt(r0 * r0 + at * (2.0 * r0 * sine + at)) - LocalFrame().earthRadius_m();
    if (h > path.top_m()) break;
    AirAmounts part = path.densities(h);
    for (double& a : part.amount) a *= 1e-3 * step;
    sum += part;
  }
  // The mean over the channel: the air's coefficients bend within it.
  double mean = 0.0;
  for (int k = 0; k < 20; ++k) mean += path.transmittance(path.node(um + 1e-4 * (k - 9.5)), sum) / 20.0;
  return mean;
}

TEST(LowSun, DirectSunlightByStraightLines) {
  const auto path = air();
  const double radius = LocalFrame().earthRadius_m(), e0 = 1000.0;
  double planned = 0.0, exact = 0.0, closed = 0.0;
  int dark = 0;
  for (const auto& [height, um] : {std::pair{3.0, 0.55}, {8000.0, 2.2}})
    for (double e : {-3.5, -1.0, -0.2, 0.0, 0.2, 0.5, 5.0}) {
      const double x = (e * kDegree + std::acos(radius / (radius + height))) / std::sqrt(6.7943e-5 / kPi);
      const double share = x >= 1.0 ? 1.0 : x <= -1.0 ? 0.0 : segmentShare(x);
      const double fine = plateInSun(height, e, um, "0.1 %"), reference = plateInSun(height, e, um, "reference");
      if (share == 0.0) {
        ++dark;
        EXPECT_LT(reference, 1e-3) << height << " " << e;  // 5 m of air lit from above
        EXPECT_LT(fine, 1e-3) << height << " " << e;
        continue;
      }
      const double middle = x >= 1.0 ? e * kDegree : e * kDegree + (segmentMiddle(x) - x) * std::sqrt(6.7943e-5 / kPi);
      const double expected = e0 / kPi * share * std::cos(middle) * transmittanceToSun(*path, height, middle, um);
      closed = std::max(closed, std::abs(reference / expected - 1.0));
      planned = std::max(planned, std::abs(fine / reference - 1.0));
      exact = std::max(exact, std::abs(fine / expected - 1.0));
    }
  EXPECT_GE(dark, 3);
  bound("direct sunlight, sun at -1 to 5 deg, in double against straight lines by small steps, relative", closed, 1e-3,
        "steps of 10 m and a thousandth of the way");
  bound("the same, planned at 0.1 % against double", planned, 1e-3, "tables of ways to the sun; what was asked");
  bound("the same, planned at 0.1 % against straight lines", exact, 2e-3, "both");
}

}  // namespace
}  // namespace pitviper::test

namespace pitviper::test {
namespace {

// From high up the sun is seen far below the level: its light comes up through the air from the lowest point of its way.
TEST(LowSun, SunFarBelowTheLevel) {
  double worst = 0.0;
  for (const auto& [height_m, elevation_deg] : {std::pair{12e3, -2.9}, {12e3, -3.3}, {25e3, -4.6}, {60e3, -7.2}})
    for (double um : {0.75, 1.25}) {
      const double exact = plateInSun(height_m, elevation_deg, um, "reference");
      EXPECT_GT(exact, 1e-3) << "there is light";
      worst = std::max(worst, std::abs(plateInSun(height_m, elevation_deg, um, "0.1 %") / exact - 1.0));
    }
  bound("sunlight from 2.9 to 7.2 deg below the level, 12 to 60 km up, planned at 0.1 % against double", worst, 1e-3, "what was asked");
}

// Ways to the sun from places in deep shade are thousands of optical depths long, and shorten upwards: their mean must not overflow.
TEST(LowSun, SkyOfASunBelowTheHorizonIsANumber) {
  for (const char* elevation : {"-1", "-0.3", "0"}) {
    const Simulation sim = scene(std::string("atmosphere: hazy_us76\nsun: {azimuth: 100 deg, elevation: ") + elevation +
                                 " deg, temperature: 5772 K}\nambient: {from: sky}\n"
                                 "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 1 mm, look_at: [1 m, 0 m, 0 m], channels: "
                                 "[{name: a, response: {band: [0.6 um, 0.7 um]}}]}]\n");
    ASSERT_TRUE(sim.ambient.has_value());
    const double sky = (*sim.ambient)(0.6);
    EXPECT_TRUE(std::isfinite(sky) && sky >= 0.0) << elevation << " deg: " << sky;
  }
}

}  // namespace
}  // namespace pitviper::test
