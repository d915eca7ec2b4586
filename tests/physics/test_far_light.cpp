// What a lens sends far from bright things: no edge of a kernel, however bright they are, against the closed forms of the point spread.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <set>

#include "scenarios/commands/commands.hpp"
#include "sensors/far_wings.hpp"
#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"
#include "sim/model/stage.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

struct Case {
  const char* name;
  const char* band;  ///< of the channel [um]
  double low_um, high_um;
  double fNumber, pitch_um;
  const char* stage;  ///< keys of point_spread
  double obscuration = 0.0;
};

const Case kCases[] = {
    {"mid-wave, F/4, 15 um", "3.6 um, 4.9 um", 3.6, 4.9, 4.0, 15.0, "cells: 2"},
    {"long-wave, F/1.2, 12 um, obscured by 0.3", "8 um, 12 um", 8.0, 12.0, 1.2, 12.0, "cells: 1, obscuration: 0.3", 0.3},
    {"visible, F/4, 3.45 um, one cell", "0.45 um, 0.75 um", 0.45, 0.75, 4.0, 3.45, "cells: 1"},
    {"mid-wave, F/2, 30 um, a tenth of a cell wide", "3.6 um, 4.9 um", 3.6, 4.9, 2.0, 60.0, "cells: 1"},
    {"mid-wave, F/4, out of focus by 90 um, jitter", "3.6 um, 4.9 um", 3.6, 4.9, 4.0, 15.0, "cells: 2, defocus: 90 um, jitter: 40 urad"},
};

Simulation sceneOf(const Case& c, int width, int height) {
  return scene(
      print("background: {temperature: 300 K}\ncameras: [{name: c, film: {width: %d, height: %d, pitch: %g um}, focal_length: 100 mm, f_number: %g, position: "
            "[0 m, 0 m, 0 m], heading: 0 deg, "
            "stages: [{stage: point_spread, %s}], channels: [{name: a, response: {band: [%s]}}]}]\n",
            width, height, c.pitch_um, c.fNumber, c.stage, c.band));
}

struct Drawn {
  int width, height, cells;
  std::vector<float> picture;
};
/// The cells of a camera, nothing drawn.
Drawn sizeOf(const Simulation& sim) {
  const Camera drawn = drawnCamera(sim.cameras[0]);
  const SensorPictures pictures(sim.cameras[0].outputs, drawn.pinhole.width, drawn.pinhole.height, cellsOf(sim.cameras[0]), marginOf(sim.cameras[0]));
  return {pictures.width, pictures.height, pictures.cells, {}};
}
/// Of the cells of a camera: a background of 1 with a cell of `peak` at a place.
Drawn drawnThrough(const Simulation& sim, double peak, int column, int row, bool asPoint = false) {
  needContext();
  const Camera& camera = sim.cameras[0];
  const Camera drawn = drawnCamera(camera);
  SensorPictures pictures(camera.outputs, drawn.pinhole.width, drawn.pinhole.height, cellsOf(camera), marginOf(camera));
  const auto at = static_cast<std::size_t>(row * pictures.width + column);
  pictures.values(0).assign(static_cast<std::size_t>(pictures.width) * static_cast<std::size_t>(pictures.height), 1.0f);
  const std::vector<double> even(pictures.values(0).size(), 1.0);
  if (asPoint) {
    pictures.points = {{column + 0.5, row + 0.5, 0, peak}};
    pictures.cellWeights = &even;
  } else {
    pictures.values(0)[at] += static_cast<float>(peak);
  }
  SensorTick tick;
  tick.axis_sr = 1e-8;
  camera.stages[0].make(shaderLibrary())->run(tick, pictures);
  return {pictures.width, pictures.height, pictures.cells, pictures.values(0)};
}

/// Airy's pattern with an obscuration e of light that is even from one wavelength to another, as a share of a cell: pi (1 - e^2) / (4 (lambda F)^2) ((2 J1(v) /
/// v - e^2 2 J1(e v) / (e v)) / (1 - e^2))^2.
double airy(const Case& c, double cell_m, double r_cells) {
  double sum = 0.0;
  constexpr int kWaves = 160;
  const double e = c.obscuration;
  for (int k = 0; k < kWaves; ++k) {
    const double scale = (c.low_um + (c.high_um - c.low_um) * (k + 0.5) / kWaves) * 1e-6 * c.fNumber, v = kPi * r_cells * cell_m / scale;
    const double open = 2.0 * std::cyl_bessel_j(1.0, v) / v, dark = e > 0.0 ? e * e * 2.0 * std::cyl_bessel_j(1.0, e * v) / (e * v) : 0.0;
    sum += kPi / (4.0 * scale * scale) * (1.0 - e * e) * std::pow((open - dark) / (1.0 - e * e), 2.0) / kWaves;
  }
  return sum * cell_m * cell_m;
}

// A flare of a million times its background, in rings around it: it falls without a step through all reaches, as Airy's pattern does.
TEST(FarLight, FallsWithoutAnEdge) {
  for (const Case& c : kCases) {
    const Simulation sim = sceneOf(c, 320, 256);
    const Drawn d = sizeOf(sim);
    const int column = d.width / 2 + 3, row = d.height / 2 - 5;
    const Drawn flare = drawnThrough(sim, 1e6, column, row);
    const double cell_m = c.pitch_um * 1e-6 / d.cells;
    constexpr double kRing = 3.0;
    const int rings = static_cast<int>(0.45 * std::min(d.width, d.height) / kRing);
    std::vector<double> sum(static_cast<std::size_t>(rings), 0.0), closed = sum;
    std::vector<int> count(static_cast<std::size_t>(rings), 0);
    std::map<int, double> known;  // by the square of the distance
    for (int y = 0; y < d.height; ++y)
      for (int x = 0; x < d.width; ++x) {
        const int square = (x - column) * (x - column) + (y - row) * (y - row);
        const auto ring = static_cast<std::size_t>(std::sqrt(square) / kRing);
        if (ring >= sum.size() || square == 0 || (x + y) % 5) continue;
        sum[ring] += (static_cast<double>(flare.picture[static_cast<std::size_t>(y * d.width + x)]) - 1.0) / 1e6, ++count[ring];
        if (const auto [at, isNew] = known.try_emplace(square, 0.0); true) {
          if (isNew) at->second = airy(c, cell_m, std::sqrt(square));
          closed[ring] += at->second;
        }
      }
    double worst = 0.0;
    // Blur and defocus stay near: from a distance on they leave Airy's mean.
    const int from = std::string(c.stage).find("defocus") != std::string::npos ? 16 : 6;
    for (int k = from; k < rings; ++k) {
      const auto i = static_cast<std::size_t>(k);
      EXPECT_LE(sum[i] / count[i], sum[i - 1] / count[i - 1]) << c.name << ", ring " << k;
      worst = std::max(worst, std::abs(sum[i] / closed[i] - 1.0));
    }
    bound(std::string("rings of three cells around a flare of 1e6 times its background, off Airy's: ") + c.name, worst, 0.03,
          "rings of the pattern within one of these; background 1 in single precision, 6e-8 of the flare a cell");
  }
}

// All light is somewhere: what a film holds of it, and what lies beyond by the cube of the distance.
TEST(FarLight, IsNotLost) {
  for (const Case& c : kCases) {
    const Simulation sim = sceneOf(c, 320, 256);
    const Drawn none = drawnThrough(sim, 0.0, 10, 10);
    for (bool point : {false, true}) {
      const Drawn flare = drawnThrough(sim, 1e4, none.width / 2, none.height / 2, point);
      double sum = 0.0;
      for (std::size_t k = 0; k < flare.picture.size(); ++k) sum += static_cast<double>(flare.picture[k]) - static_cast<double>(none.picture[k]);
      // Beyond a rectangle of half sides a and b: the integral of w / r^3 over its outside, 4 w sqrt(a^2 + b^2) / (a b).
      const double a = 0.5 * none.width, b = 0.5 * none.height, cell_m = c.pitch_um * 1e-6 / none.cells,
                   scale = 0.5 * (c.low_um + c.high_um) * 1e-6 * c.fNumber / cell_m,
                   beyond = 4.0 * scale / std::pow(kPi, 3.0) / (1.0 - c.obscuration) * std::hypot(a, b) / (a * b);
      figure(std::string("light of ") + (point ? "a star" : "a flare's cell") + " on the film: " + c.name, sum / 1e4, 1.0 - beyond, 1e-3,
             "4 w sqrt(a^2 + b^2) / (a b) beyond it; a star's cells at 32 cycles");
    }
  }
}

// A blur without diffraction has no far light, and its bell goes down to the last digit.
TEST(FarLight, ABellFallsToNothing) {
  const Simulation sim = scene(
      "background: {temperature: 300 K}\ncameras: [{name: c, film: {width: 160, height: 128, pitch: 15 um}, focal_length: 100 mm, f_number: 4, position: [0 m, "
      "0 m, 0 m], heading: 0 deg, "
      "stages: [{stage: point_spread, diffraction: false, blur: 75 um, cells: 1}], channels: [{name: a, response: {band: [8 um, 12 um]}}]}]\n");
  const Drawn empty = drawnThrough(sim, 0.0, 1, 1);
  const int column = empty.width / 2, row = empty.height / 2;
  const Drawn d = drawnThrough(sim, 1e6, column, row);
  double worst = 0.0;
  for (int x = 0; x < 40; ++x) {
    // Cells that sample a bell have its density in their middles.
    const auto cell = [](double at) { return std::exp(-0.5 * at * at / 25.0) / (5.0 * std::sqrt(2.0 * kPi)); };
    worst = std::max(worst, std::abs(static_cast<double>(d.picture[static_cast<std::size_t>(row * d.width + column + x)]) - 1.0 - 1e6 * cell(x) * cell(0)) /
                                (1.0 + 1e6 * cell(x) * cell(0)));
  }
  bound("a bell of 5 cells around a flare of 1e6 times its background, off its closed form", worst, 2e-3,
        "its transform is cut where it is 1e-9, a thousandth of the background here");
}

// The grid of far light against the sum itself, of cells and of points anywhere between them.
TEST(FarLight, CoarseGridsHoldIt) {
  LensSpread law = [] {
    const Simulation sim = sceneOf(kCases[0], 64, 64);
    Lens lens;
    lens.zoom(0.1);
    lens.aperture_m = 0.025, lens.pitch_m = 15e-6;
    lens.zoom(0.1);
    lens.setCells(2);
    return LensSpread(lens, sim.cameras[0].outputs[0]);
  }();
  const int width = 700, height = 500;
  FarWings wings(law, width, height);
  double worst = 0.0;
  for (const auto& [column, row] : {std::pair{350.5, 250.5}, std::pair{351.13, 247.8}, std::pair{20.02, 480.7}, std::pair{0.3, 0.4}}) {
    std::vector<double> cells(static_cast<std::size_t>(width * height), 0.0);
    wings.gather(column, row, 1.0);
    wings.spread(cells);
    for (int y = 0; y < height; y += 3)
      for (int x = 0; x < width; x += 3) {
        const double r = std::hypot(x + 0.5 - column, y + 0.5 - row), own = r > 0.0 ? (1.0 - law.cut(r)) * law.far(r) : 0.0;
        worst = std::max(worst, std::abs(cells[static_cast<std::size_t>(y * width + x)] - own) / std::max(law.far(std::max(r, law.cut.begin)), 1e-300));
      }
  }
  bound("far light on a coarse grid, off its law, of that", worst, 5e-3, "Lagrange's cubic, an eighth of the distance over which it sets in a step");
}

// What would be wider than can be worked out is refused at once, with the most that is taken; that is taken.
TEST(FarLight, TooWideIsRefusedWithTheMost) {
  const auto refusal = [](const std::string& stage) -> std::string {
    try {
      (void)scene(
          "cameras: [{name: c, film: {width: 640, height: 512, pitch: 15 um}, focal_length: 100 mm, f_number: 4, position: [0 m, 0 m, 0 m], heading: 0 deg, "
          "stages: [" +
          stage + "], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  std::set<std::string> tried;
  for (const auto& [key, value, unit] : {std::tuple{"defocus", "1 m", "um"}, std::tuple{"defocus", "20 mm", "um"}, std::tuple{"blur", "1 m", "um"},
                                         std::tuple{"jitter", "0.1 rad", "urad"}, std::tuple{"blur", "2 mm", "um"}}) {
    const auto began = std::chrono::steady_clock::now();
    const std::string said = refusal(std::string("{stage: point_spread, ") + key + ": " + value + "}");
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    EXPECT_NE(said.find(std::string("wider than 128 cells")), std::string::npos) << said;
    const std::size_t at = said.find("of at most ");
    ASSERT_NE(at, std::string::npos) << said;
    const double most = std::stod(said.substr(at + 11));
    // Which value was asked for is no matter of the most: it is tried once.
    if (tried.insert(key).second) {
      EXPECT_EQ(refusal(print("{stage: point_spread, cells: 1, %s: %.6g %s}", key, most, unit)), "") << key;
      EXPECT_NE(refusal(print("{stage: point_spread, cells: 1, %s: %.6g %s}", key, 1.1 * most, unit)), "") << key;
    }
    bound(std::string("seconds until '") + key + ": " + value + "' is refused", took_s, 60.0,
          "a kernel of 128 cells takes at most a second of a core; nine are made");
  }
  EXPECT_NE(refusal("{stage: point_spread, wavefront_error: 1 mm}").find("at most"), std::string::npos);
}

}  // namespace
}  // namespace pitviper::test
