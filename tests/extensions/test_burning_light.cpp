// A light in one file: a grey fire that burns for a while, with a rise and a fall of its own. No other file knows it.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/lights.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

LightModel burningModel() {
  return {"burning",
          "A grey fire that burns for a while.",
          {required(within(number("temperature", "K", "of the fire"), 1, 10000)), required(above(number("area", "m2", "emissivity times area"), 0)),
           required(number("from", "s", "it begins")), required(above(number("burns", "s", "so long; a tenth of it each to rise and to fall"), 0))},
          [](const ModelRecord& r, PointLight& light) {
            light.intensity = Spectrum(Spectrum::BlackBody{r.record.number("temperature"), r.record.number("area")});
            const double from = r.record.number("from"), burns = r.record.number("burns");
            light.level = TimeCourse({{from, 0.0}, {from + 0.1 * burns, 1.0}, {from + 0.9 * burns, 1.0}, {from + burns, 0.0}},
                                     TimeCourse::Interpolation::Linear, TimeCourse::Outside::Zero);
          }};
}

[[maybe_unused]] const bool kRegistered = lightModels().add(burningModel());

}  // namespace

namespace test {
namespace {

std::string fire(const std::string& light) {
  return "time: {rate: 100 Hz, frames: 20}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.5}]}}\nlights: [" + light +
         "]\nentities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: m, temperature: 0 K}]\n"
         "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: p, "
         "channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
}

// L = rho / pi x A B(T) / d^2 x level.
TEST(BurningLight, FollowsItsCourse) {
  const double steady = 0.5 / kPi * 0.02 * blackBodyBand(3, 5, 2000) / 400.0;
  const std::string light =
      "{name: fire, model: burning, temperature: 2000 K, area: 0.02 m2, from: 30 ms, burns: 100 ms, position: [20 m, 0 m, 0 m], visible: false}";
  for (const auto& [accuracy, allowed] : {std::pair<std::string, double>{"", 2e-6}, {"accuracy: 1 %\n", 0.01}, {"accuracy: reference\n", 2e-6}}) {
    const Simulation sim = scene(accuracy + fire(light));
    EXPECT_EQ(at(layer(renderFrame(sim, 2), "mw.radiance"), renderFrame(sim, 2), 4, 4), 0.0);
    for (const auto& [frame, level] : {std::pair{4, 1.0}, {8, 1.0}}) {
      const Frame f = renderFrame(sim, frame);
      figure("a plate by a fire, frame " + std::to_string(frame) + " " + accuracy, at(layer(f, "mw.radiance"), f, 4, 4), level * steady, allowed,
             "rho A B / (pi d^2), single precision or the accuracy");
    }
  }
  // Within the rise, by its level.
  Simulation rising = scene(fire(light));
  rising.time.start_s = 0.035;
  const Frame f = renderFrame(rising, 0);
  figure("a plate by a fire that rises", at(layer(f, "mw.radiance"), f, 4, 4), 0.5 * steady, 2e-6, "half of it");
}

TEST(BurningLight, IsReadByItsTable) {
  EXPECT_NE(keyReference().find("### light: burning"), std::string::npos);
  const auto refusal = [](const std::string& light) -> std::string {
    try {
      scene(fire(light));
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{name: f, model: burning, temperature: 2000 K, area: 1 m2, from: 0 s, position: [1 m, 0 m, 0 m]}").find("missing key 'burns'"),
            std::string::npos);
  EXPECT_NE(refusal("{name: f, model: burnin, position: [1 m, 0 m, 0 m]}").find("did you mean 'burning'?"), std::string::npos);
  EXPECT_NE(refusal("{name: f, intensity: 1 W/(sr um), area: 1 m2, position: [1 m, 0 m, 0 m]}").find("'area'"), std::string::npos) << "a fire's, not a lamp's";
}

TEST(LightModels, TwoOfOneNameAreRefused) {
  Registry<LightModel> two("light", {burningModel(), burningModel()});
  EXPECT_THROW(two.all(), std::logic_error);
}

}  // namespace
}  // namespace test
}  // namespace pitviper
