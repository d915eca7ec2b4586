// Subpixels resolved on the GPU. Expected: the mean of a film of as many pixels as there are subpixels, weighted by their projected solid angles in double
// precision (flux adds up); truth of the middle one; small bodies, which are added subpixel by subpixel, alike on both ways.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr int kColumns = 16, kRows = 12;

/// A tilted plate with a temperature texture, and a ball of a pixel or so; a field of view in which a subpixel's weight changes by a factor of two.
Frame picture(int samples, int finer, bool ball, const std::string& mode = "direct") {
  const std::string film = print("{width: %d, height: %d, pitch: %.17g um}", kColumns * finer, kRows * finer, 60.0 / finer);
  return renderFrame(scene(
      "render: {mode: " + mode +
      "}\nentities:\n- {name: plate, shape: {model: plate, width: 30 m, height: 30 m}, material: blackbody, temperature: {rows: [[280 K, 340 K, 290 K], [300 "
      "K, "
      "285 "
      "K, 360 K]]}, heading: 25 deg, position: [0 m, 0 m, 0 m]}\n" +
      std::string(ball ? "- {name: ball, shape: {model: sphere, radius: 0.2 m}, material: blackbody, temperature: 500 K, position: [2 m, 1 m, 0.7 m]}\n" : "") +
      "cameras: [{name: c, film: " + film + ", focal_length: 0.6 mm, aperture: 0.2 mm, position: [6 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], samples: " +
      std::to_string(samples) + ", channels: [{name: lw, response: {band: [8 um, 12 um]}}], truth: [range]}]\n"));
}

TEST(Resolve, MeansWeightedByProjectedSolidAngle) {
  for (int samples : {2, 3}) {
    const Frame coarse = picture(samples, 1, false), fine = picture(1, samples, false);
    const auto &drawn = layer(coarse, "lw.radiance"), &subpixels = layer(fine, "lw.radiance"), &range = layer(coarse, "truth.range"),
               &ranges = layer(fine, "truth.range");
    Pinhole film;
    film.width = kColumns * samples, film.height = kRows * samples;
    film.focalLength_m = 0.6e-3, film.pitchX_m = film.pitchY_m = 60e-6 / samples;
    double worst = 0.0, plain = 0.0;
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        double sum = 0.0, all = 0.0, mean = 0.0;
        for (int y = 0; y < samples; ++y)
          for (int x = 0; x < samples; ++x) {
            const double l = static_cast<double>(at(subpixels, fine, column * samples + x, row * samples + y)),
                         w = film.projectedSolidAngle_sr(column * samples + x, row * samples + y);
            sum += w * l, all += w, mean += l / (samples * samples);
          }
        const double found = static_cast<double>(at(drawn, coarse, column, row));
        worst = std::max(worst, std::abs(found / (sum / all) - 1.0));
        plain = std::max(plain, std::abs(found / mean - 1.0));
        // The middle of two is the one above on the right: as GL counts, rows from the bottom.
        const int middle = samples / 2;
        EXPECT_EQ(at(range, coarse, column, row), at(ranges, fine, column * samples + middle, (row + 1) * samples - 1 - middle));
      }
    bound(print("%d x %d subpixels resolved on the GPU, worst pixel", samples, samples), worst, 5e-5,
          "weights at middles instead of integrals; single precision of four to nine sums");
    EXPECT_GT(plain, 1e-4) << "weights matter here";
  }
}

/// Of the ball alone, over the picture; one of less than 16 pixels is drawn by a view of its own.
double flux(int samples, int finer, const std::string& mode = "direct") {
  const Frame with = picture(samples, finer, true, mode), without = picture(samples, finer, false, mode);
  Pinhole film;
  film.width = kColumns * finer, film.height = kRows * finer;
  film.focalLength_m = 0.6e-3, film.pitchX_m = film.pitchY_m = 60e-6 / finer;
  double sum = 0.0;
  for (int row = 0; row < film.height; ++row)
    for (int column = 0; column < film.width; ++column)
      sum += film.projectedSolidAngle_sr(column, row) * (static_cast<double>(at(layer(with, "lw.radiance"), with, column, row)) -
                                                         static_cast<double>(at(layer(without, "lw.radiance"), without, column, row)));
  return sum;
}

TEST(Resolve, SmallBodiesKeepTheirFlux) {
  const double whole = flux(1, 2);
  for (int samples : {2, 4})
    bound(print("flux of a body below a pixel with %d x %d subpixels against a finer film", samples, samples), std::abs(flux(samples, 1) / whole - 1.0), 2e-3,
          "what it hides, a slope, is the mean of one subpixel or another");
  bound("the same in buffered mode, which has no tiles, against direct", std::abs(flux(2, 1, "buffered") / flux(2, 1) - 1.0), 1e-5, "single precision");
}

}  // namespace
}  // namespace pitviper::test
