// Bodies of some pixels before, in and behind a jet: pictures against the reference, and both against rays all over a pixel. A pixel that a cold body hides
// a bright jet in has what the body sends, not what is left of the jet when two means of it are taken from each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "scenarios/commands/accuracy_renderings.hpp"
#include "sim/camera/covered_cells.hpp"
#include "sim/camera/whole_pixel.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr int kSize = 12;
constexpr double kAsked = 0.01, kPixel_m = 0.1, kRange_m = 1000.0;
/// Middle of the body [pixels from the upper left].
constexpr double kColumn = 6.3, kRow = 5.8;
/// A pixel that 32 x 32 rays know as well as this is on no outline: there the zoomed view's samples, few as the reference works each of them out, count.
constexpr double kWellKnown = 1e-3;

std::string text(double v) { return std::to_string(v); }

/// A jet of a nozzle of so many pixels, across the picture; a sphere of 300 K at a distance.
std::string yaml(double nozzle_px, double sphere_px, double range_m) {
  const double pixel_m = kPixel_m * range_m / kRange_m;
  return "accuracy: 1 %\ntime: {frames: 1, rate: 1 Hz}\nbackground: {temperature: 270 K}\n"
         "plumes: [{name: p, position: [-0.8 m, 1000 m, 1000 m], direction: [1, 0, 0], nozzle: {diameter: " +
         text(kPixel_m * nozzle_px) +
         " m, temperature: 1200 K, speed: 400 m/s, species: {co2: 0.08, h2o: 0.1, soot: 0.0001}}, length: " + text(std::max(2.0, 0.3 * nozzle_px)) +
         " m}]\nentities: [{name: s, shape: {model: sphere, radius: " + text(0.5 * sphere_px * pixel_m) +
         " m}, material: blackbody, temperature: 300 K, position: [" + text((kColumn - 0.5 * kSize) * pixel_m) + " m, " + text(range_m) + " m, " +
         text(1000.0 + (0.5 * kSize - kRow) * pixel_m) + " m]}]\ncameras:\n  - name: c\n    film: {width: 12, height: 12}\n    field_of_view: " +
         text(glm::degrees(2.0 * std::atan(0.5 * kSize * kPixel_m / kRange_m))) +
         " deg\n    aperture: 10 mm\n    position: [0 m, 0 m, 1000 m]\n    heading: 0 deg\n"
         "    channels:\n      - {name: red, response: {band: [4.40 um, 4.41 um]}}\n      - {name: long, response: {band: [9.0 um, 9.01 um]}}\n";
}

/// Pixels that the sphere covers some of.
std::vector<int> covered(double sphere_px) {
  std::vector<int> all;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (std::hypot(std::max(std::abs(x + 0.5 - kColumn) - 0.5, 0.0), std::max(std::abs(y + 0.5 - kRow) - 0.5, 0.0)) < 0.5 * sphere_px)
        all.push_back(kSize * y + x);
  return all;
}

TEST(SmallBodiesAtFields, PixelsHaveTheBodyAndWhatIsBesideIt) {
  needContext();
  for (const double nozzle_px : {3.0, 10.0})
    for (const double sphere_px : {1.0, 3.0})
      for (const auto& [where, range_m] : {std::pair{"before", 990.0}, {"in", 1000.0}, {"behind", 1010.0}}) {
        // Each place with each size, of the jet and of the sphere: what is before and behind a jet as narrow as the sphere, what is in one of another size.
        if ((nozzle_px < 5.0) == (sphere_px < 2.0) ? range_m == 1000.0 : range_m != 1000.0) continue;
        Simulation sim = scene(yaml(nozzle_px, sphere_px, range_m));
        Camera& camera = sim.cameras[0];
        keepRadianceAlone(camera);
        camera.zoomedSamples = 32;
        const auto gpu = std::make_shared<const GpuScene>(sim);
        const WorldState state = advance(sim, sim.time.at(0));
        ComparedFrames all{{state}, {}};
        SpectralSampling asked;
        asked.accuracy = kAsked;
        Renderings exact(sim, camera, referenceSampling(), gpu), ours(sim, camera, asked, gpu);
        const auto reference = exact.draw(all), planned = ours.draw(all);
        const WholePixels whole(sim, camera, ours.plan(), 5);
        double worst = 0.0, off = 0.0, referenceOff = 0.0;
        int known = 0;
        for (const int pixel : covered(sphere_px)) {
          const auto p = static_cast<size_t>(pixel);
          const auto seen = whole.look(state, pixel);
          ASSERT_TRUE(seen);
          for (size_t c = 0; c < planned.size(); ++c) {
            const auto slot = static_cast<size_t>(ours.plan().slotOfOutput[c]);
            const double mean = seen->mean[slot];
            worst = std::max(worst, std::abs(planned[c][p] / reference[c][p] - 1.0));
            if (seen->error[slot] > kWellKnown * mean) continue;
            ++known;
            off = std::max(off, std::abs(planned[c][p] / mean - 1.0));
            referenceOff = std::max(referenceOff, std::abs(reference[c][p] / mean - 1.0));
          }
        }
        char what[120];
        std::snprintf(what, sizeof what, "sphere of %.0f pixels %s a jet of a nozzle of %.0f: ", sphere_px, where, nozzle_px);
        bound(std::string(what) + "pictures against the reference, worst pixel that it covers", worst, kAsked, "the accuracy asked for");
        if (known == 0) continue;
        bound(std::string(what) + "against rays all over a pixel, where these know it to 0.1 %", off, kAsked, "the accuracy asked for");
        bound(std::string(what) + "the reference against them", referenceOff, 0.5 * kAsked, "half of what is asked; rays may be off by three standard errors");
      }
}

// Samples are squares: however they lie to the grid, what they cover adds up, to the borders of the film.
TEST(CoveredCells, AddUpToWhatIsCovered) {
  View film;
  film.width = 4, film.height = 3;
  CoveredCells cells(film);
  cells.add({1.93, 1.41}, 0.09);
  cells.add({2.0, 1.0}, 0.01);
  double sum = 0.0;
  std::set<size_t> touched;
  for (size_t p = 0; p < 12; ++p)
    if (const auto* c = cells.of(p)) {
      touched.insert(p);
      for (double share : *c) sum += share / (CoveredCells::kAcross * CoveredCells::kAcross);
    }
  EXPECT_NEAR(sum, 0.1, 1e-12);
  EXPECT_EQ(touched, (std::set<size_t>{1, 2, 5, 6}));
  CoveredCells corner(film);
  corner.add({0.0, 3.0}, 0.04);  // a quarter of it is on the film
  ASSERT_TRUE(corner.of(8));
  double inside = 0.0;
  for (double share : *corner.of(8)) inside += share / (CoveredCells::kAcross * CoveredCells::kAcross);
  EXPECT_NEAR(inside, 0.01, 1e-12);
}

TEST(CoveredCells, MagnifiedSeesTheSameDirections) {
  View film;
  film.width = 40, film.height = 30, film.tanPerPixelX = 1e-3, film.tanPerPixelY = 2e-3, film.axisX = 20.0, film.axisY = 15.0;
  const View z = magnified(film, {7, 4, 2, 3}, 8);
  EXPECT_EQ(z.width, 16);
  EXPECT_EQ(z.height, 24);
  const glm::dvec3 a = film.ray(7.0 + 5.0 / 8.0, 4.0 + 9.0 / 8.0), b = z.ray(5.0, 9.0);
  EXPECT_NEAR(a.x, b.x, 1e-15);
  EXPECT_NEAR(a.y, b.y, 1e-15);
}

}  // namespace
}  // namespace pitviper::test
