// The lens against closed forms: transfer functions, shares of a point's light, energy, edges of films.
#include <gtest/gtest.h>

#include <cmath>

#include "sensors/convolution.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

double ofCircle(double s) { return 2.0 / kPi * (std::acos(0.5 * s) - 0.5 * s * std::sqrt(1.0 - 0.25 * s * s)); }

TEST(PointSpread, TransferOfApertures) {
  double worst = 0.0;
  for (int k = 0; k <= 200; ++k) worst = std::max(worst, std::abs(apertureTransfer(0.01 * k, 0.0, 0.0) - ofCircle(std::min(0.01 * k, 2.0))));
  bound("OTF of a circular aperture against its closed form", worst, 1e-9, "Gauss points on chords");
  // An annulus: overlaps of two circles each (O'Neill 1956), by areas.
  const auto overlap = [](double r, double R, double d) {
    if (d >= r + R) return 0.0;
    if (d <= R - r) return kPi * r * r;
    const double a = (d * d + r * r - R * R) / (2.0 * d * r), b = (d * d + R * R - r * r) / (2.0 * d * R);
    return r * r * std::acos(a) + R * R * std::acos(b) - 0.5 * std::sqrt((-d + r + R) * (d + r - R) * (d - r + R) * (d + r + R));
  };
  worst = 0.0;
  for (double e : {0.1, 0.35, 0.6})
    for (int k = 0; k <= 200; ++k) {
      const double s = 0.01 * k, both = overlap(1.0, 1.0, s) - 2.0 * overlap(e, 1.0, s) + overlap(e, e, s);
      worst = std::max(worst, std::abs(apertureTransfer(s, e, 0.0) - both / (kPi * (1.0 - e * e))));
    }
  bound("OTF of annular apertures against areas of overlap", worst, 1e-5, "Gauss points on chords");
  // Defocus: by brute force over the plane of the pupils.
  worst = 0.0;
  for (const auto& [s, e, waves] : {std::tuple{0.3, 0.0, 0.5}, std::tuple{0.05, 0.0, 10.0}, std::tuple{0.7, 0.4, 1.0}, std::tuple{1.2, 0.2, 0.25}}) {
    constexpr int kSteps = 1500;
    double sum = 0.0;
    for (int j = 0; j < kSteps; ++j)
      for (int i = 0; i < kSteps; ++i) {
        const double x = -1.0 + 2.0 * (i + 0.5) / kSteps, y = -1.0 + 2.0 * (j + 0.5) / kSteps;
        const double a = (x + 0.5 * s) * (x + 0.5 * s) + y * y, b = (x - 0.5 * s) * (x - 0.5 * s) + y * y;
        if (a <= 1.0 && b <= 1.0 && a >= e * e && b >= e * e) sum += std::cos(2.0 * kPi * waves * (a - b));
      }
    worst = std::max(worst, std::abs(apertureTransfer(s, e, waves) - sum * 4.0 / (kSteps * kSteps) / (kPi * (1.0 - e * e))));
  }
  bound("OTF with defocus against sums over 2,250,000 places", worst, 1e-3, "places on edges");
}

// Shares on pixels of a point in a cell's middle by the closed form in polar coordinates; sums.
TEST(PointSpread, SharesOfADiffractedPoint) {
  const double wavelength_m = 10e-6, fNumber = 2.0, cutoff = 1.0 / (wavelength_m * fNumber);
  const auto transfer = [&](double fx, double fy) { return apertureTransfer(2.0 * std::hypot(fx, fy) / cutoff, 0.0, 0.0); };
  // On cells so small that a cell is a point: Airy's irradiance, and light within circles 1 - J0^2 - J1^2.
  const SpreadKernel fine = spreadKernel(transfer, cutoff, 1e-6, 60);
  for (int i : {0, 10, 24, 33}) {
    const double v = kPi * i * 1e-6 / (wavelength_m * fNumber), airy = i == 0 ? 1.0 : std::pow(2.0 * std::cyl_bessel_j(1.0, v) / v, 2.0);
    const double peak = 0.25 * kPi * std::pow(1e-6 / (wavelength_m * fNumber), 2.0);
    EXPECT_NEAR(fine.at(i, 0) / peak, airy, 3e-3) << i;
  }
  double within = 0.0;
  for (int j = -60; j <= 60; ++j)
    for (int i = -60; i <= 60; ++i)
      if (std::hypot(i, j) <= 50.0) within += fine.at(i, j);
  const double v = kPi * 50.0e-6 / (wavelength_m * fNumber);
  figure("light of a point within 50 um, 10 um F/2", within, 1.0 - std::pow(std::cyl_bessel_j(0.0, v), 2.0) - std::pow(std::cyl_bessel_j(1.0, v), 2.0), 2e-3,
         "Rayleigh 1881; cells of 1 um");
  for (int reach : {8, 16, 64}) {
    const SpreadKernel k = spreadKernel(transfer, cutoff, 7.5e-6, reach);
    const double edge = kPi * reach * 7.5e-6 / (wavelength_m * fNumber);
    bound(print("share beyond a square of %d cells, of that beyond a circle", reach), (1.0 - k.sum()) / (2.0 / (kPi * edge)), 1.1, "2 / (pi v), and corners");
  }
}

// Cells far wider than what the lens resolves: nearly all of a cell's light stays on it, and what leaves it is not lost.
TEST(PointSpread, CoarseCellsKeepTheirLight) {
  for (double cells : {3.0, 30.0, 300.0}) {  // lambda F in a cell
    const double cutoff = 1.0, cell_m = cells;
    const SpreadKernel k = spreadKernel([&](double fx, double fy) { return apertureTransfer(2.0 * std::hypot(fx, fy) / cutoff, 0.0, 0.0); }, cutoff, cell_m, 8);
    // Beyond a circle of radius r a point sends 2 / (pi v), v = pi r / (lambda F); corners lie farther.
    const double beyond = 2.0 / (kPi * kPi * 8.5 * cells);
    bound(print("light of a cell of %g lambda F lost or made, beyond what leaves 17 x 17 cells", cells), std::abs(1.0 - k.sum() - 0.9 * beyond),
          0.15 * beyond + 2e-4, "2 / (pi v), and corners; frequencies to 32 cycles a cell");
    // Evenly from the cell, over its edges: 0.8 / cells or so, logarithms apart.
    EXPECT_GT(k.at(0, 0), 1.0 - 1.5 / cells - 0.01) << "what frequencies beyond 32 cycles a cell would bring back";
  }
}

/// One pixel of 15 um is 1.5e-4 rad. `kelvin` of a disc far away, `side` of it [m] at 1 km.
Simulation pointScene(double x_px, double y_px, const std::string& stages, int side = 65) {
  return scene(
      "background: {temperature: 3 K}\nlights: [{name: l, intensity: {wavelength: um, unit: W/(sr um), lines: [[10, 1000]], values: [[9, 0], [11, 0]]}, "
      "position: [1000 m, " +
      std::to_string(x_px * 1.5e-4 * 1000.0) + " m, " + std::to_string(y_px * 1.5e-4 * 1000.0) +
      " m]}]\ncameras: [{name: c, film: {width: " + std::to_string(side) + ", height: " + std::to_string(side) +
      ", pitch: 15 um}, focal_length: 100 mm, aperture: 50 mm, position: [0 m, 0 m, 0 m], heading: 90 deg, " + stages +
      "channels: [{name: lw, response: {band: [9.99 um, 10.01 um]}, output: flux}]}]\n");
}

/// Share of a square pixel of 15 um at (x, y) off its middle [pixels], 10 um F/2: integral of OTF sinc sinc cos cos.
double shareOfPixel(double x, double y) {
  const double cutoff = 1.0 / (10e-6 * 2.0), pitch = 15e-6;
  static const auto nodes = gaussLegendre(96, 0.0, cutoff);
  const auto sinc = [&](double f) { return f > 0.0 ? std::sin(kPi * f * pitch) / (kPi * f * pitch) : 1.0; };
  double sum = 0.0;
  for (const auto& a : nodes)
    for (const auto& b : nodes)
      sum += 4.0 * a.weight * b.weight * ofCircle(std::min(2.0, 2.0 * std::hypot(a.x, b.x) / cutoff)) * sinc(a.x) * sinc(b.x) *
             std::cos(2.0 * kPi * a.x * x * pitch) * std::cos(2.0 * kPi * b.x * y * pitch);
  return sum * pitch * pitch;
}

// A star in the middle of a pixel, on its edge and in its corner, through 10 um F/2 on cells of a pixel: its share of that pixel.
TEST(PointSpread, APixelsShareOfAStar) {
  for (const auto& [x, y, name] : {std::tuple{0.0, 0.0, "centred"}, std::tuple{0.5, 0.0, "on its edge"}, std::tuple{0.5, 0.5, "in its corner"},
                                   std::tuple{0.13, -0.29, "anywhere"}}) {
    for (int cells : {1, 2, 3}) {
      const auto flux = [&](const std::string& stages) {
        const Frame f = renderFrame(pointScene(x, y, stages));
        return std::pair{at(layer(f, "lw.flux"), f, 32, 32), sum(layer(f, "lw.flux"))};
      };
      const auto [ignored, all] = flux("");
      const auto [middle, spread] = flux(print("stages: [{stage: point_spread, cells: %d, beyond: 0.02}], ", cells));
      figure(print("share of a pixel of 15 um, 10 um F/2, a star %s, %d cells", name, cells), middle / all, shareOfPixel(x, y), 1e-3,
             "its flux is that of the pixel it is in: cos^4 differs by 4e-6 a pixel");
      EXPECT_LE(spread, all * 1.0001);
      // Beyond a circle of radius r a point sends 2 / (pi v) of its light: what the film cannot hold.
      EXPECT_GE(spread, all * 0.97);
    }
  }
}

// Beyond the kernel a star's light falls off as the cube of the distance: what lies within circles against Airy's pattern.
TEST(PointSpread, FarLightOfAStar) {
  const Frame plain = renderFrame(pointScene(0.0, 0.0, "")), f = renderFrame(pointScene(0.0, 0.0, "stages: [{stage: point_spread, cells: 2, beyond: 0.05}], "));
  for (double radius_px : {12.0, 20.0, 30.0}) {
    double within = 0.0;
    for (int y = 0; y < 65; ++y)
      for (int x = 0; x < 65; ++x)
        if (std::hypot(x - 32, y - 32) <= radius_px) within += at(layer(f, "lw.flux"), f, x, y);
    const double v = kPi * radius_px * 15.0 / 20.0;
    figure(print("light of a star within %g pixels, 10 um F/2, a kernel of 95 %% of it", radius_px), within / sum(layer(plain, "lw.flux")),
           1.0 - std::pow(std::cyl_bessel_j(0.0, v), 2.0) - std::pow(std::cyl_bessel_j(1.0, v), 2.0), 3e-3,
           "Rayleigh 1881; a circle of whole pixels; rings averaged");
  }
}

// A body of a fifth of a pixel is a star with the same light, wherever in a pixel it is; one of a pixel is its points one by one.
TEST(PointSpread, SmallBodiesFallWhereTheyAre) {
  const auto shareOf = [](double x_px, double radius_m) {
    const Frame f = renderFrame(scene(
        "background: {temperature: 3 K}\nmaterials: {m: {components: []}}\nentities: [{name: p, shape: {model: sphere, radius: " + std::to_string(radius_m) +
        " m}, material: m, temperature: 900 K, position: [1000 m, " + std::to_string(x_px * 0.15) +
        " m, 0 m]}]\ncameras: [{name: c, film: {width: 65, height: 65, pitch: 15 um}, focal_length: 100 mm, aperture: 50 mm, position: [0 m, 0 m, 0 m], "
        "heading: 90 deg, "
        "stages: [{stage: point_spread, cells: 2, beyond: 0.02}], channels: [{name: lw, response: {band: [9.99 um, 10.01 um]}, output: flux}]}]\n"));
    return at(layer(f, "lw.flux"), f, 32, 32) / sum(layer(f, "lw.flux"));
  };
  // Of an even disc: the mean of a star's shares over it.
  const auto ofDisc = [](double x, double radius_px) {
    double sum = 0.0;
    constexpr int kTurns = 12;
    for (const QuadratureNode& q : gaussLegendre(4, 0.0, 1.0))  // of r^2
      for (int k = 0; k < kTurns; ++k) {
        const double r = radius_px * std::sqrt(q.x), angle = 2.0 * kPi * (k + 0.5) / kTurns;
        sum += q.weight / kTurns * shareOfPixel(x + r * std::cos(angle), r * std::sin(angle));
      }
    return sum;
  };
  const Frame star = renderFrame(pointScene(0.0, 0.0, "stages: [{stage: point_spread, cells: 2, beyond: 0.02}], "));
  const double onFilm = at(layer(star, "lw.flux"), star, 32, 32) / sum(layer(star, "lw.flux")) / shareOfPixel(0.0, 0.0);  // what its far light leaves it
  for (double x : {0.0, 0.21, 0.5}) {
    figure(print("share of a body of a fifth of a pixel, %.2g off the middle", x), shareOf(x, 0.015), onFilm * ofDisc(x, 0.1), 1e-3,
           "points with its middle and its spread");
    figure(print("share of a body of a pixel, %.2g off the middle", x), shareOf(x, 0.075), onFilm * ofDisc(x, 0.5), 5e-3,
           "the same; a sphere's edge on 256 lines");
  }
}

// An even field stays what it is, at the edges too: nothing is lost, nothing made.
TEST(PointSpread, KeepsAnEvenField) {
  for (const char* stage :
       {"{stage: point_spread}", "{stage: point_spread, obscuration: 0.4, wavefront_error: 0.2 um, defocus: 30 um, jitter: 50 urad, veiling_glare: 0.03}",
        "{stage: point_spread, diffraction: false, blur: 12 um, cells: 1}"}) {
    const Frame f = renderFrame(scene(
        std::string("background: {temperature: 300 K}\ncameras: [{name: c, film: {width: 160, height: 120, pitch: 15 um}, focal_length: 100 mm, aperture: "
                    "50 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, stages: [") +
        stage + "], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n"));
    double worst = 0.0;
    for (float v : layer(f, "mw.radiance").pixels) worst = std::max(worst, std::abs(static_cast<double>(v) / blackBodyBand(3.6, 4.9, 300.0) - 1.0));
    bound(std::string("an even field off through ") + stage, worst, 1e-5, "shares and veil are 1 together");
  }
}

// A kernel of Gauss on pixels: an edge, of eight places within a pixel the mean, becomes erf averaged over pixels and places.
TEST(PointSpread, AnEdgeBecomesErf) {
  const double whole = blackBodyBand(3.6, 4.9, 400.0), sigma = 30.0 / 20.0;
  std::vector<double> row(40, 0.0);
  for (int k = 0; k < 8; ++k) {
    const double y = 0.2 * ((k + 0.5) / 8.0 - 0.5);  // a pixel is 0.2 m
    const Frame f =
        renderFrame(scene("background: {temperature: 3 K}\nmaterials: {m: {components: []}}\nentities: [{name: p, shape: {model: plate, width: 400 m, height: "
                          "800 m}, material: m, temperature: 400 K, "
                          "position: [1000 m, " +
                          std::to_string(-200.0 + y) +
                          " m, 0 m]}]\ncameras: [{name: c, film: {width: 40, height: 40, pitch: 20 um}, focal_length: 100 mm, aperture: 50 mm, samples: 7, "
                          "small_bodies: 0, position: [0 m, 0 m, "
                          "0 m], heading: 90 deg, stages: [{stage: point_spread, diffraction: false, blur: 30 um, cells: 1, beyond: 0.0001}], channels: "
                          "[{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n"));
    for (int column = 0; column < 40; ++column) row[static_cast<size_t>(column)] += at(layer(f, "mw.radiance"), f, column, 20) / (8.0 * whole);
  }
  // The second integral of erf: means over a pixel and over a pixel's places.
  const auto twice = [&](double x) {
    return 0.5 *
           ((x * x + sigma * sigma) * std::erf(x / (sigma * std::sqrt(2.0))) + x * sigma * std::sqrt(2.0 / kPi) * std::exp(-0.5 * x * x / (sigma * sigma)));
  };
  double worst = 0.0;
  for (int column = 5; column < 35; ++column) {
    const double x = (row[2] > row[37] ? 1.0 : -1.0) * (20.0 - (column + 0.5));  // into the bright, in pixels
    worst = std::max(worst, std::abs(row[static_cast<size_t>(column)] - (0.5 + 0.5 * (twice(x + 1.0) - 2.0 * twice(x) + twice(x - 1.0)))));
  }
  bound("an edge through a blur of 1.5 pixels against its closed form, of the step", worst, 4e-3,
        "7 x 7 subpixels have an edge 1/14 of a pixel off at most; eight places cancel most of it");
}

// A stage that asks for finer cells changes nothing of a lens; areas of truth are those of pixels.
TEST(PointSpread, CellsAreAStagesOwnBusiness) {
  const auto seen = [](const std::string& stages) {
    return renderFrame(
        scene("materials: {m: {components: []}}\nentities: [{name: p, shape: {model: sphere, radius: 1.2 m}, material: m, temperature: 400 K, position: [1000 "
              "m, 0 m, 0 m]}]\n"
              "cameras: [{name: c, film: {width: 33, height: 33, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, samples: 4, small_bodies: 0, position: "
              "[0 m, 0 m, 0 m], "
              "heading: 90 deg, truth: [area, range], " +
              stages + "channels: [{name: lw, response: {band: [9 um, 10 um]}}]}]\n"));
  };
  const Frame plain = seen(""), own = seen("stages: [{stage: point_spread, beyond: 0.05}], "),
              finer = seen("stages: [{stage: point_spread, beyond: 0.05}, {stage: point_spread, diffraction: false, blur: 0.5 um, cells: 4}], ");
  double most = 0.0, worst = 0.0;
  for (size_t k = 0; k < layer(own, "lw.radiance").pixels.size(); ++k) {
    most = std::max(most, static_cast<double>(layer(own, "lw.radiance").pixels[k]));
    worst = std::max(worst, std::abs(static_cast<double>(layer(own, "lw.radiance").pixels[k] - layer(finer, "lw.radiance").pixels[k])));
  }
  bound("a disc through a lens on 4 x 4 cells against 2 x 2, of its brightest", worst / most, 0.03,
        "cells of 7.5 um sample 38 um of diffraction; half wide it would be 0.3");
  figure("area of the middle pixel on cells [m2]", at(layer(own, "truth.area"), own, 16, 16), at(layer(plain, "truth.area"), plain, 16, 16), 3e-3,
         "A = w R^2 / cos; a cell of four lies beside the middle");
}

TEST(PointSpread, RefusesWhatIsNone) {
  const auto refusal = [](const std::string& stage, const std::string& film = "width: 64, height: 64, pitch: 15 um") -> std::string {
    try {
      (void)scene("cameras: [{name: c, film: {" + film + "}, focal_length: 100 mm, aperture: 50 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, stages: [" +
                  stage + "], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{stage: point_spread, diffraction: false}").find("of no width"), std::string::npos);
  EXPECT_NE(refusal("{stage: point_spread, wavefront_error: 1 um}").find("more than 0.18 waves"), std::string::npos);
  EXPECT_NE(refusal("{stage: point_spread, blur: 600 um}").find("wider than"), std::string::npos);
  EXPECT_NE(refusal("{stage: point_spread, diffraction: false, blur: 20 um, obscuration: 0.2}").find("does not diffract"), std::string::npos);
  EXPECT_NE(refusal("{stage: detector, full_well: 1e6}, {stage: point_spread}").find("optics after the detector"), std::string::npos);
}

}  // namespace
}  // namespace pitviper::test
