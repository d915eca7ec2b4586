// A spot light in one file (and its pattern's body): a cone with a soft edge. No other file knows of it.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/lights.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "tests/extensions/cone_light.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

LightModel coneModel() {
  return {"cone",
          "A lamp that shines within a cone.",
          {required(atLeast(spectrum("intensity", "W/(sr um)", "within it"), 0)), required(within(number("inner", "rad", "half angle of all"), 0, 1.5)),
           required(within(number("outer", "rad", "half angle beyond which it is dark"), 0, 1.5))},
          [](const ModelRecord& r, PointLight& light) {
            light.intensity = r.spectrum("intensity");
            light.pattern = {"tests/extensions/cone_light.glsl",
                             "coneLight",
                             physics::coneLight,
                             {std::cos(r.record.number("inner")), std::cos(r.record.number("outer")), 0, 0}};
          },
          true,
          {"tests/extensions/cone_light.glsl", readFileStart(std::filesystem::path(PITVIPER_SOURCE_DIR) / "tests/extensions/cone_light.glsl", 1 << 20)}};
}

[[maybe_unused]] const bool kRegistered = lightModels().add(coneModel());

}  // namespace

namespace test {
namespace {

/// A plate in the plane x = 0 that a cone at 10 m shines on straight, seen where rays from the lamp are `angle_deg` off its axis.
std::string lit(const std::string& light, double angle_deg, const std::string& accuracy = "") {
  const std::string y = std::to_string(10.0 * std::tan(angle_deg * kPi / 180.0));
  return accuracy + "materials: {m: {components: [{reflection: lambertian, reflectance: 0.5}]}}\nlights: [" + light +
         "]\nentities: [{name: p, shape: {model: plate, width: 100 m, height: 100 m}, material: m, temperature: 0 K}]\n"
         "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [20 m, " +
         y + " m, 0 m], look_at: [0 m, " + y + " m, 0 m], channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
}

const std::string kCone = "{name: l, model: cone, intensity: 7 W/(sr um), inner: 10 deg, outer: 20 deg, position: [10 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m]}";

double seen(double angle_deg, const std::string& accuracy = "") {
  const Frame f = renderFrame(scene(lit(kCone, angle_deg, accuracy)));
  return at(layer(f, "mw.radiance"), f, 4, 4);
}

// L = rho / pi I cos^3 / d^2 x 2 um times the cone's share: all, half of the way in cosine, none.
TEST(ConeLight, ShinesWithinItsCone) {
  const auto all = [](double angle_deg) { return 0.5 / kPi * 7.0 * 2.0 * std::pow(std::cos(angle_deg * kPi / 180.0), 3.0) / 100.0; };
  const double half_deg = std::acos(0.5 * (std::cos(10.0 * kPi / 180.0) + std::cos(20.0 * kPi / 180.0))) * 180.0 / kPi;
  for (const auto& [accuracy, allowed] : {std::pair<std::string, double>{"", 5e-6}, {"accuracy: 1 %\n", 0.01}, {"accuracy: reference\n", 5e-6}}) {
    figure("under a cone of light, on its axis " + accuracy, seen(0.0, accuracy), all(0.0), allowed, "rho I / (pi d^2), single precision or the accuracy");
    figure("under a cone of light, within it " + accuracy, seen(8.0, accuracy), all(8.0), allowed, "the same times cos^3");
    figure("under a cone of light, half way through its edge " + accuracy, seen(half_deg, accuracy), 0.5 * all(half_deg), std::max(allowed, 2e-5),
           "half of it; the edge spans 0.045 of cosine, a pixel 4e-5 of angle");
    EXPECT_EQ(seen(21.0, accuracy), 0.0);
  }
}

TEST(ConeLight, IsReadByItsTable) {
  EXPECT_NE(keyReference().find("### light: cone"), std::string::npos);
  const auto refusal = [](const std::string& light) -> std::string {
    try {
      scene(lit(light, 0.0));
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{name: l, model: cone, intensity: 7 W/(sr um), inner: 10 deg, position: [10 m, 0 m, 0 m], look_at: p}").find("missing key 'outer'"),
            std::string::npos);
  EXPECT_NE(refusal("{name: l, model: cone, intensity: 7 W/(sr um), inner: 10 deg, outer: 20 deg, position: [10 m, 0 m, 0 m]}").find("looks nowhere"),
            std::string::npos);
  EXPECT_NE(refusal("{name: l, intensity: 7 W/(sr um), position: [10 m, 0 m, 0 m], look_at: p}").find("'look_at'"), std::string::npos) << "a lamp has no axis";
}

}  // namespace
}  // namespace test
}  // namespace pitviper
