// A sensor's stage in one file and its formula (box_blur.glsl): a square point spread function. No other file knows it.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "scenarios/reader/scenario_reader.hpp"
#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"
#include "sim/parameters/read_file.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

StageModel boxBlurModel() {
  return {"box_blur",
          "Spreads every pixel evenly over a square.",
          {withDefault(integer("width", "pixels, odd", 1, 31), "3"), withDefault(integer("cells", "cells a side of a pixel, odd", 1, 7), "1")},
          [](const Record& r, const Camera&) {
            const auto width = static_cast<int>(r.integer("width")), cells = static_cast<int>(r.integer("cells"));
            if (width % 2 == 0)
              throw UserError(r.where("width"), "a box of " + std::to_string(width) + " pixels has no middle one", "an odd number", "add one");
            const int reach = (width * cells - 1) / 2;
            StageChoice choice;
            choice.margin_px = (reach + cells - 1) / cells;
            choice.cells = cells;
            choice.make = [reach](const ShaderLibrary& library) {
              return std::make_unique<FormulaStage>(library, "tests/extensions/box_blur.glsl", std::vector{static_cast<float>(reach)});
            };
            return choice;
          },
          {{"tests/extensions/box_blur.glsl", readFileStart(std::filesystem::path(PITVIPER_SOURCE_DIR) / "tests/extensions/box_blur.glsl", 1 << 20)}}};
}

[[maybe_unused]] const bool kRegistered = stageModels().add(boxBlurModel());

}  // namespace

namespace test {
namespace {

/// Pixels are 0.1 m on a black plate of 500 K from one y to another, before nothing.
Frame seen(double from_m, double to_m, const std::string& stages, const std::string& accuracy = "") {
  return renderFrame(scene(accuracy +
                           "materials: {m: {components: [{reflection: lambertian, reflectance: 0}]}}\n"
                           "entities: [{name: p, shape: {model: plate, width: " +
                           std::to_string(to_m - from_m) + " m, height: 20 m}, material: m, temperature: 500 K, position: [0 m, " +
                           std::to_string(0.5 * (from_m + to_m)) + " m, 0 m]}]\n" +
                           "cameras: [{name: c, film: {width: 9, height: 9, pitch: 1 mm}, focal_length: 100 mm, aperture: 20 mm, small_bodies: 0, "
                           "position: [10 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], truth: [range], " +
                           stages + "channels: [{name: mw, response: {band: [3 um, 5 um]}, output: [radiance, flux]}]}]\n"));
}

// A step becomes a ramp: 0, 1/3, 2/3, 1 of pixels; of nine cells a pixel one in 27 more on either side, where the first of nine columns of cells is met.
TEST(BoxBlur, MakesARampOfAStep) {
  const double black = blackBodyBand(3, 5, 500);
  for (const auto& [stages, foot] : {std::pair{"stages: [{stage: box_blur}], ", 0.0}, {"stages: [{stage: box_blur, cells: 3}], ", 1.0 / 27.0}})
    for (const char* accuracy : {"", "accuracy: 1 %\n", "accuracy: reference\n"}) {
      const Frame f = seen(0.05, 9.0, stages, accuracy);
      ASSERT_EQ(f.width, 9);
      const FrameLayer& l = layer(f, "mw.radiance");
      ASSERT_EQ(l.pixels.size(), 81u);
      for (const auto& [column, share] : {std::pair{3, foot}, {4, 1.0 / 3.0}, {5, 2.0 / 3.0}, {6, 1.0 - foot}, {8, 1.0}})
        EXPECT_NEAR(at(l, f, column, 4), share * black, (*accuracy ? 0.01 : 2e-5) * black) << stages << accuracy << column;
      EXPECT_NEAR(at(layer(f, "truth.range"), f, 6, 4), std::hypot(10.0, 0.2), 1e-4) << "truth is of the scene, at a pixel's middle";
    }
}

// What is beyond the film's edge reaches into it.
TEST(BoxBlur, TakesLightFromBeyondTheFilm) {
  const Frame f = seen(0.451, 0.651, "stages: [{stage: box_blur, width: 5}], ");
  const double black = blackBodyBand(3, 5, 500);
  figure("the film's last column under a box of 5 pixels, two beyond it bright [W/(m2 sr)]", at(layer(f, "mw.radiance"), f, 8, 4), 0.4 * black, 2e-6, "2 of 5");
  figure("the last but one [W/(m2 sr)]", at(layer(f, "mw.radiance"), f, 7, 4), 0.2 * black, 2e-6, "1 of 5");
  EXPECT_EQ(at(layer(f, "mw.radiance"), f, 6, 4), 0.0);
}

// Two stages one after the other, and flux that is neither made nor lost: cells of a pixel add up.
TEST(BoxBlur, KeepsFlux) {
  const auto flux = [](const std::string& stages) {
    const Frame f = seen(-0.15, 0.15, stages);
    double sum = 0.0;
    for (int column = 0; column < 9; ++column) sum += at(layer(f, "mw.flux"), f, column, 4);
    return sum;
  };
  const double plain = flux("");
  figure("flux of a row through two boxes [W]", flux("stages: [{stage: box_blur}, {stage: box_blur}], "), plain, 5e-4,
         "light moved by two pixels of 10 mrad, 2 psi^2");
  figure("the same with nine cells a pixel [W]", flux("stages: [{stage: box_blur}, {stage: box_blur, cells: 3}], "), plain, 5e-4,
         "light moved by two pixels of 10 mrad, 2 psi^2");
}

TEST(BoxBlur, IsReadByItsTable) {
  EXPECT_NE(keyReference().find("### stage: box_blur"), std::string::npos);
  const auto refusal = [](const std::string& stage) -> std::string {
    try {
      seen(0.0, 1.0, "stages: [" + stage + "], ");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{stage: box_blur, width: 4}").find("has no middle one"), std::string::npos);
  EXPECT_NE(refusal("{stage: box_blurr}").find("did you mean 'box_blur'?"), std::string::npos);
  EXPECT_NE(refusal("{stage: box_blur, wdth: 3}").find("wdth"), std::string::npos);
}

TEST(StageModels, TwoOfOneNameAreRefused) {
  Registry<StageModel> two("stage", {boxBlurModel(), boxBlurModel()});
  EXPECT_THROW(two.all(), std::logic_error);
}

}  // namespace
}  // namespace test
}  // namespace pitviper
