// Bodies filled with an emitting medium, through the whole pipeline: the slab equation on exact chords, and radiance marched along each
// pixel's ray through medium and air. All spectra are grey unless the test is about spectra, so that both hold for whole bands.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/geodesy.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/fog_world.hpp"

namespace pitviper::test {
namespace {

// --- the slab equation on exact chords ---------------------------------------------------------------------------------------------

// L = B (1 - exp(-k s)) + exp(-k s) L_behind. Over a cold background every digit of a thin medium shows.
TEST(Media, SlabEquationOnExactChords) {
  const glm::dvec3 place(20, 0, 0);
  const std::vector<std::pair<std::string, Cloud>> bodies{{"box along its axis", placed(box(2, 6, 6), place)},
                                                          {"box obliquely", placed(box(2, 3, 1.5), place, 57, 23)},
                                                          {"sphere", placed(sphere(1.8), place)},
                                                          {"ellipsoid", placed(ellipsoid(4, 2, 1), place, 40, 30)},
                                                          {"flat ellipsoid", placed(ellipsoid(3, 3, 0.01), place, 70, 40)},
                                                          {"cylinder from its side", placed(cylinder(1, 3), place, 0)},
                                                          {"cylinder along its axis", placed(cylinder(1.5, 3), place)},
                                                          {"cylinder obliquely", placed(cylinder(0.7, 3), place, 50, 20)},
                                                          {"cone from its side", placed(cone(1.5, 0, 3), place, 0)},
                                                          {"cone along its axis", placed(cone(1.5, 0, 3), place)},
                                                          {"cone tip first", placed(cone(1.5, 0, 3), place, 270)},
                                                          {"cone obliquely", placed(cone(1.5, 0, 3), place, 330, -25)},
                                                          {"frustum obliquely", placed(cone(1.5, 0.5, 3), place, 300, 40)},
                                                          {"frustum that widens", placed(cone(0.2, 1.5, 3), place, 110, 10)}};
  for (const auto& [name, body] : bodies) {
    double cold = 0.0, warm = 0.0;
    int covered = 0;
    for (double depth : {1e-6, 1e-3, 0.1, 1.0, 10.0, 100.0})
      for (double background : {0.0, 300.0}) {
        World w{.background_K = background};
        w.clouds = {of(body, 1.0)};
        double longest = 0.0;
        for (int row = 0; row < 24; ++row)
          for (int column = 0; column < 24; ++column) longest = std::max(longest, w.clouds[0].depthOf(w.eye.ray(column, row)));
        w.clouds[0].absorption = depth / longest;
        // The rim, where a chord is short because of the rounding of two long numbers: below 2 % of the longest.
        const double worst = worstError(
            renderFrame(scene(w.yaml())),
            [&](int column, int row) {
              const Line ray = w.eye.ray(column, row);
              const double s = w.clouds[0].depthOf(ray);
              if (w.atEdge(column, row) || (background == 0.0 && s < 0.02 * depth)) return kNone;
              return B(400) * -std::expm1(-s) + B(background) * std::exp(-s);
            },
            &covered);
        (background > 0.0 ? warm : cold) = std::max(background > 0.0 ? warm : cold, worst);
      }
    EXPECT_GT(covered, 30) << name;
    bound(name + ", optical depth 1e-6 to 100, nothing behind, worst pixel", cold, 2e-4,
          "slab equation on chords found by bisection; single precision of the chord");
    bound(name + ", optical depth 1e-6 to 100, 300 K behind, worst pixel", warm, 5e-5,
          "slab equation on chords found by bisection; 1 cm of a 3 m body is seen");
  }
}

// The middle ray runs exactly along the axis: parallel to the whole side.
TEST(Media, ExactlyAlongTheAxis) {
  for (const auto& [name, body] :
       {std::pair<std::string, Cloud>{"frustum", cone(1, 0.5, 4)}, {"cone", cone(1, 0, 4)}, {"box", box(4, 2, 2)}, {"ellipsoid", ellipsoid(4, 2, 2)}})
    for (double heading : {90.0, 270.0}) {
      World w{.eye = {{0, 0, 0}, {1, 0, 0}, 1.0, 9}};
      w.clouds = {of(placed(body, {20, 0, 0}, heading), 0.3)};
      bound(name + " exactly along its axis, heading " + text(heading) + ", worst pixel", w.worst(), 1e-5, "slab equation");
    }
}

TEST(Media, FarAwayChordsKeepTheirDigits) {
  for (double range : {1e5, 2e6})
    for (const auto& [name, body] : {std::pair<std::string, Cloud>{"sphere", sphere(5)},
                                     {"ellipsoid", ellipsoid(12, 6, 8)},
                                     {"cylinder", cylinder(3, 10)},
                                     {"cone", cone(4, 1, 10)},
                                     {"box", box(8, 6, 5)}}) {
      World w{.eye = {{0, 0, 0}, {1, 0, 0}, 12.0 / range * 180.0 / kPi, 24}};
      w.clouds = {of(placed(body, {range, 0, 0}, 50, 20), 0.05)};
      const double worst = worstError(renderFrame(scene(w.yaml())), [&](int column, int row) {
        const Line ray = w.eye.ray(column, row);
        return w.atEdge(column, row) || w.clouds[0].depthOf(ray) < 0.01 ? kNone : w.expected(ray);
      });
      bound(name + " at " + text(range / 1000.0) + " km, worst pixel", worst, 1e-3, "chord from differences at the body");
    }
}

// --- meshes -------------------------------------------------------------------------------------------------------------------------

TEST(Media, ClosedMeshes) {
  const TemporaryFolder folder;
  const Cloud brick = meshed(folder.put("brick.obj", prism({{0, 0}, {3, 0}, {3, 2}, {0, 2}}, {{0, 1, 2}, {0, 2, 3}})), {{{0, 0, 0}, {3, 2, 1}}});
  const Cloud u = uShape(folder);
  for (double heading : {90.0, 0.0, 63.0, 200.0}) {
    for (double k : {1e-4, 0.7, 20.0}) {
      World w{.background_K = 300.0};
      w.clouds = {of(placed(brick, {20, -0.5, -0.5}, heading, 25), k)};
      bound("brick of an .obj file, heading " + text(heading) + " deg, k " + text(k) + "/m, worst pixel", w.worst(), 1e-5,
            "slab equation on the brick's chords");
      w.clouds = {of(placed(u, {20, -0.5, -0.5}, heading, 10), k)};
      bound("U of an .obj file, heading " + text(heading) + " deg, k " + text(k) + "/m, worst pixel", w.worst(), 2e-4,
            "lengths of both arms add up; a side seen at 1.4 deg is met to 1e-5 m in single precision");
    }
  }
  // A solid between the arms, and inside one.
  for (double x : {18.0, 19.5, 20.5, 21.5}) {
    World w{.background_K = 250.0};
    w.clouds = {of(placed(u, {19, -0.5, -0.5}, 90, 0), 0.5)};
    w.walls = {{.x = x, .kelvin = 320, .low = 0.3}};
    bound("plate at " + text(x) + " m, U from 19 to 22 m, worst pixel", w.worst(), 1e-5, "only what lies before the plate counts");
  }
}

// --- the camera, and solids ----------------------------------------------------------------------------------------------------------

const std::vector<std::pair<std::string, Cloud>>& rounds() {
  static const std::vector<std::pair<std::string, Cloud>> all{
      {"sphere", sphere(3)}, {"ellipsoid", ellipsoid(9, 6, 5)}, {"cylinder", cylinder(3, 6)}, {"frustum", cone(3, 2, 7)}};
  return all;
}

TEST(Media, CameraInside) {
  for (const auto& [name, body] : rounds()) {
    World w{.eye = {{0, 0, 0}, {1, 0.2, 0.1}, 100.0, 24}, .background_K = 300.0};
    w.clouds = {of(placed(body, {0.4, -0.3, 0.5}, 55, 10), 0.5)};
    bound("camera inside a " + name + ", worst pixel", w.worst(), 1e-5, "from the camera to where the ray leaves");
    w.background_K = 0.0, w.extinction = 0.2, w.air_K = 280, w.walls = {{.x = 30, .kelvin = 290}};
    bound("camera inside a " + name + " in air, worst pixel", w.worst(), 1e-5, "march");
  }
}

TEST(Media, BehindTheCamera) {
  for (const auto& [name, body] : {rounds()[0], rounds()[2], std::pair<std::string, Cloud>{"box", box(6, 6, 6)}})
    for (double x : {-3.5, -8.0, -40.0}) {
      World w{.eye = {{0, 0, 0}, {1, 0, 0}, 70.0, 24}, .background_K = 300.0};
      w.clouds = {of(placed(body, {x, 0, 0}), 5.0)};
      bound(name + " behind the camera by " + text(-x) + " m, worst pixel", w.worst(), 1e-6, "not seen");
    }
}

TEST(Media, SolidsInsideBeforeAndBehind) {
  for (const auto& [name, body] : {rounds()[0], rounds()[1], rounds()[2], rounds()[3], std::pair<std::string, Cloud>{"box", box(5, 6, 4)}})
    for (double x : {26.0, 21.0, 20.0, 18.5, 14.0}) {
      World w{.eye = {{0, 0, 0}, {1, 0, 0}, 25.0, 24}, .background_K = 260.0};
      w.clouds = {of(placed(body, {20, 0, 0}, 70, 15), 0.4)};
      w.walls = {{.x = x, .kelvin = 330, .low = -0.7}};
      bound("solid plate at " + text(x) + " m, " + name + " around 20 m, worst pixel", w.worst(), 3e-5,
            "only the part before the plate counts; short chords at the rim");
      w.extinction = 0.05, w.air_K = 285, w.background_K = 0.0;
      w.walls.push_back({.x = 45, .kelvin = 310});
      bound("the same in air, worst pixel", w.worst(), 3e-5, "march; short chords at the rim");
    }
}

// A plate inside a far medium: its place in it must keep its digits.
TEST(Media, SolidInsideFarAway) {
  for (double range : {1e5, 2e6}) {
    World w{.eye = {{0, 0, 0}, {1, 0, 0}, 12.0 / range * 180.0 / kPi, 24}, .background_K = 260.0, .wallSize = 40.0};
    w.clouds = {of(placed(sphere(5), {range, 0, 0}), 0.1)};
    w.walls = {{.x = range + 1.0, .kelvin = 330, .low = 0.0}};
    bound("plate inside a sphere at " + text(range / 1000.0) + " km, worst pixel", w.worst(), 1e-4, "chord from differences at the body");
  }
}

// --- air -----------------------------------------------------------------------------------------------------------------------------

TEST(Media, AirBeforeInsideAndBehind) {
  for (double air : {1e-4, 0.02, 0.3})
    for (double k : {1e-4, 0.02, 0.3, 5.0})
      for (double airKelvin : {280.0, 600.0}) {
        World w{.extinction = air, .air_K = airKelvin};
        w.clouds = {of(placed(ellipsoid(6, 3, 3), {15, 0, 0}, 70, 15), k)};
        w.walls = {{.x = 30, .kelvin = 350}};
        bound("ellipsoid of " + text(k) + "/m in air of " + text(air) + "/m, " + text(airKelvin) + " K, worst pixel", w.worst(), 1e-5, "march through both");
      }
  const TemporaryFolder folder;
  World w{.extinction = 0.2, .air_K = 280};
  w.clouds = {of(placed(box(3, 3, 2), {15, 0, 0}, 30, 40), 0.4)};
  w.walls = {{.x = 30, .kelvin = 350}};
  bound("box in air, worst pixel", w.worst(), 1e-5, "march through both");
}

TEST(Media, NoMediumInTheLimit) {
  for (double k : {0.0, 1e-12}) {
    World w{.extinction = 0.05, .air_K = 285};
    w.clouds = {of(placed(sphere(2), {15, 0, 0}), k), of(placed(box(3, 3, 2), {16, 1, 0}, 30, 20), k)};
    w.walls = {{.x = 30, .kelvin = 350}};
    const Frame without = renderFrame(scene(w.yaml(false))), with = renderFrame(scene(w.yaml()));
    bound("medium of " + text(k) + "/m against none, worst pixel",
          worstError(with, [&](int column, int row) { return at(without.layers[0], without, column, row); }), 4e-7,
          "single precision of air before and inside");
  }
}

// Air with a top over a spherical earth; the line of sight slants through it. Marched with the height of every point.
TEST(Media, AirWithATop) {
  const LocalFrame frame;
  const double radius = frame.earthRadius_m(), top = 1000.0, extinction = 1e-3;
  auto run = [&](const std::string& name, const Eye& eye, const glm::dvec3& place, double size, double allowed, const std::string& source) {
    const Cloud cloud = of(placed(sphere(size), place), 0.3 / size, 400.0);
    const auto sim = scene("background: {temperature: 250 K}\natmosphere: {extinction: " + text(extinction) + " /m, temperature: 285 K, top: " + text(top) +
                           " m}\nentities:\n" + cloud.yaml("c") + eye.yaml(kLw, "    small_bodies: 0\n"));
    int covered = 0;
    const double worst = worstError(
        renderFrame(sim),
        [&](int column, int row) {
          const Line ray = eye.ray(column, row);
          std::vector<Fog> fogs;
          for (const auto& s : cloud.stretches(ray)) fogs.push_back({s, cloud.absorption, cloud.source()});
          // The top: by bisection on the height, which falls or rises along the whole way here.
          const double end = 1e6;
          auto below = [&](double s) { return glm::length(ray.at(s) + glm::dvec3(0, 0, radius)) - radius < top; };
          double a = 0.0, b = end;
          const bool from = below(0.0);
          for (int i = 0; i < 80; ++i) (below(0.5 * (a + b)) == from ? a : b) = 0.5 * (a + b);
          fogs.push_back({from ? Stretch{0.0, a} : Stretch{a, end}, extinction, B(285)});
          return march(end, B(250), fogs, {});
        },
        &covered);
    bound(name + ", worst pixel", worst, allowed, source);
  };
  run("medium below the top, seen upwards", {{0, 0, 100}, {900, 0, 500}, 20, 24}, {900, 0, 500}, 120, 2e-5,
      "march with a height at every step; height in single precision");
  run("medium above the top, seen from below", {{0, 0, 100}, {3000, 0, 2500}, 12, 24}, {3000, 0, 2500}, 300, 2e-5, "march with a height at every step");
  run("camera inside a medium below the top", {{0, 0, 300}, {900, 0, 700}, 60, 24}, {20, 10, 320}, 150, 2e-5, "march with a height at every step");
}

// The top of the air within the medium: air inside is taken as spread evenly over the way.
TEST(Media, AirEndsInsideTheMedium) {
  const LocalFrame frame;
  const Eye eye{{0, 0, 100}, {900, 0, 1000}, 20, 24};
  const Cloud cloud = of(placed(sphere(150), {900, 0, 1000}), 0.002, 400.0);
  const auto sim = scene("background: {temperature: 250 K}\natmosphere: {extinction: 1 /km, temperature: 285 K, top: 1 km}\nentities:\n" + cloud.yaml("c") +
                         eye.yaml(kLw, "    small_bodies: 0\n"));
  const double worst = worstError(renderFrame(sim), [&](int column, int row) {
    const Line ray = eye.ray(column, row);
    std::vector<Fog> fogs;
    for (const auto& s : cloud.stretches(ray)) fogs.push_back({s, cloud.absorption, cloud.source()});
    double a = 0.0, b = 1e6;
    for (int i = 0; i < 80; ++i)
      (glm::length(ray.at(0.5 * (a + b)) + glm::dvec3(0, 0, frame.earthRadius_m())) - frame.earthRadius_m() < 1000.0 ? a : b) = 0.5 * (a + b);
    fogs.push_back({{0.0, a}, 1e-3, B(285)});
    return march(1e6, B(250), fogs, {});
  });
  bound("air whose top lies within the medium (depths 0.15 and 0.6), worst pixel", worst, 0.02,
        "second order in the two optical depths: air spread evenly inside");
}

// --- several ---------------------------------------------------------------------------------------------------------------------------

TEST(Media, TwoMedia) {
  for (double air : {0.0, 0.03}) {
    World w{.extinction = air, .air_K = 285};
    w.walls = {{.x = 60, .kelvin = 320}};
    w.clouds = {of(placed(sphere(1.5), {15, 0, 0}), 0.5, 450), of(placed(box(3, 5, 5), {22, 0.5, 0}, 60, 20), 0.3, 260)};
    bound("box behind a sphere, air " + text(air) + "/m, worst pixel", w.worst(), 1e-5, "march");
    std::swap(w.clouds[0].place, w.clouds[1].place);
    bound("sphere behind a box, air " + text(air) + "/m, worst pixel", w.worst(), 1e-5, "march");
    w.clouds = {of(placed(sphere(1), {20, -1.0, 0}), 0.5, 450), of(placed(cylinder(0.8, 2), {20, 1.2, 0}, 20, 20), 0.8, 330)};
    bound("sphere beside a cylinder, air " + text(air) + "/m, worst pixel", w.worst(), 1e-5, "march");
  }
}

TEST(Media, MediaAndPanesInAllOrders) {
  std::array<int, 4> order{0, 1, 2, 3};
  double worst = 0.0;
  do {
    World w{.background_K = 0.0, .extinction = 0.01, .air_K = 285};
    w.walls = {{.x = 60, .kelvin = 320}};
    for (size_t i = 0; i < 4; ++i) {
      const double x = 10.0 + 6.0 * static_cast<double>(order[i]);
      if (i == 0) w.clouds.push_back(of(placed(sphere(2), {x, 0.3, 0}), 0.4, 450));
      if (i == 1) w.clouds.push_back(of(placed(box(2, 3, 3), {x, -0.3, 0}, 60, 20), 0.3, 260));
      if (i == 2) w.walls.push_back({.x = x, .transmittance = 0.5, .kelvin = 380, .low = -0.6});
      if (i == 3) w.walls.push_back({.x = x, .transmittance = 0.8, .kelvin = 270, .high = 0.8});
    }
    worst = std::max(worst, w.worst());
  } while (std::next_permutation(order.begin(), order.end()));
  bound("two media and two panes in all 24 orders, worst pixel", worst, 1e-5, "march");
}

// --- spectra -----------------------------------------------------------------------------------------------------------------------------

// Absorption rises along a line over wavelength, and a further radiance falls; channel by channel, summed here by Simpson's rule.
TEST(Media, SixteenChannelsInSeveralBatches) {
  auto planck = [](double um, double kelvin) { return 1.191042972397e8 / std::pow(um, 5) / std::expm1(14387.768775 / (um * kelvin)); };
  std::string channels = "[";
  for (int c = 0; c < 16; ++c)
    channels +=
        (c ? ", " : "") + std::string("{name: c") + std::to_string(c) + ", response: {band: [" + text(3.0 + 0.5 * c) + " um, " + text(3.7 + 0.5 * c) + " um]}}";
  channels += "]";
  for (const std::string spectral : {"{samples: 6}", "{samples: 40, shared: true}"}) {
    const Eye eye{{0, 0, 0}, {1, 0, 0}, 0.5, 5};
    const auto sim = scene(
        "background: {temperature: 300 K}\natmosphere: {extinction: 0.01 /m, temperature: 280 K}\n"
        "materials: {gas: {absorption: {wavelength: um, unit: /m, values: [[2, 0.1], [13, 1.2]]}, radiance: {wavelength: um, unit: W/(m2 sr um), values: [[2, "
        "8], [13, "
        "0]]}}}\nentities:\n"
        "  - {name: c, shape: {model: sphere, radius: 1 m}, material: gas, temperature: 500 K, position: [10 m, 0 m, 0 m]}\n"
        "  - {name: p, shape: {model: plate, width: 9 m, height: 9 m}, material: blackbody, temperature: 350 K, position: [20 m, 0 m, 0 m]}\n" +
        eye.yaml(channels, "    small_bodies: 0\n    spectral: " + spectral + "\n"));
    const Frame f = renderFrame(sim);
    double worst = 0.0;
    for (int c = 0; c < 16; ++c) {
      const double low = 3.0 + 0.5 * c, high = low + 0.7;
      double sum = 0.0;
      const int n = 200;
      for (int i = 0; i <= n; ++i) {
        const double um = low + (high - low) * i / n, k = 0.1 + (um - 2.0) / 10.0, more = 8.0 - 8.0 * (um - 2.0) / 11.0;
        const double l = march(20.0, planck(um, 350), {{{9.0, 11.0}, k, planck(um, 500) + more}, {{0.0, 20.0}, 0.01, planck(um, 280)}}, {});
        sum += (i == 0 || i == n ? 1.0 : i % 2 ? 4.0 : 2.0) * l * (high - low) / n / 3.0;
      }
      worst = std::max(worst, std::abs(at(f.layers[static_cast<size_t>(c)], f, 2, 2) / sum - 1.0));
    }
    bound("16 channels through a medium, " + spectral + ", worst channel", worst, 2e-5, "Simpson's rule over marched radiances");
  }
}

TEST(Media, FurtherRadiance) {
  World w{.background_K = 300.0};
  w.clouds = {of(placed(sphere(1.5), {20, 0, 0}), 0.7, 350)};
  w.clouds[0].extra = 40.0;
  bound("medium with a radiance besides its emission, worst pixel", w.worst(), 1e-5, "slab equation with B + radiance");
  w.clouds[0].kelvin = 0.0;
  bound("medium at 0 K with a radiance, worst pixel", w.worst(), 1e-5, "slab equation with the radiance alone");
}

// --- flux -----------------------------------------------------------------------------------------------------------------------------------

// A thin sphere's intensity: 4/3 pi r^3 k B (1 - 3/4 k r at most, from its own absorption).
TEST(Media, ThinSphereFlux) {
  const double k = 1e-5, r = 1.0, range = 50.0, air = 0.01;
  for (double extinction : {0.0, air}) {
    const auto sim = scene(
        (extinction > 0.0 ? "atmosphere: {extinction: " + text(extinction) + " /m}\n" : std::string()) +
        "entities: [{name: c, shape: {model: sphere, radius: 1 m}, material: {absorption: " + text(k) +
        " /m}, temperature: 400 K, position: [50 m, 0 m, 0 m]}]\n"
        "cameras:\n  - {name: c, film: {width: 64, height: 64}, field_of_view: 2.6 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], look_at: [1 m, 0 m, 0 m], "
        "samples: 2, small_bodies: 0, channels: [{name: lw, response: {band: [8 um, 12 um]}, output: irradiance}]}\n");
    figure("optically thin sphere, irradiance" + std::string(extinction > 0.0 ? " through air" : "") + " [W/m2]", sum(layer(renderFrame(sim), "lw.irradiance")),
           4.0 / 3.0 * kPi * r * r * r * k * B(400) / (range * range) * std::exp(-extinction * range), 1e-3,
           "4/3 pi r3 k B tau/R2; near side, its own depth, silhouette on subpixels");
  }
}

}  // namespace
}  // namespace pitviper::test
