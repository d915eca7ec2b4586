// A command in one file: a point light that flickers from a time on. No other file knows it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

CommandModel flickerCommand() {
  return {"flicker",
          "Lets a point light flicker.",
          {required(text("light", "name of a point light")), required(within(number("depth", "", "of its level, about 1"), 0.0, 1.0)),
           withDefault(above(number("rate", "Hz", "flickers a second"), 0.0), "10 Hz")},
          [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
            return [l = lightOf(r, sim), depth = r.number("depth"), rate_Hz = r.number("rate")](Courses& courses, double at_s) {
              courses.lightLevels[l] = [=](double t) { return 1.0 + depth * std::sin(2.0 * kPi * rate_Hz * (t - at_s)); };
            };
          }};
}

[[maybe_unused]] const bool kRegistered = commandModels().add(flickerCommand());

}  // namespace

namespace test {
namespace {

Simulation lamp(const std::string& more) {
  return scene("time: {rate: 100 Hz, frames: 20}\n" + more +
               "materials: {m: {components: [{reflection: lambertian, reflectance: 0.5}]}}\n"
               "lights: [{name: lamp, intensity: 7 W/(sr um), position: [20 m, 0 m, 0 m], visible: false}]\n"
               "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: m, temperature: 0 K}]\n"
               "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: p, "
               "channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n");
}

// L = rho I / (pi d^2) x 2 um x level, before its time, in it, and planned.
TEST(Flicker, FollowsItsCourse) {
  const std::string command = "commands: [{command: flicker, at: 50 ms, light: lamp, depth: 0.4, rate: 12.5 Hz}]\n";
  const double steady = 0.5 * 7.0 / (kPi * 400.0) * 2.0;
  for (const char* accuracy : {"", "accuracy: 1 %\n", "accuracy: reference\n"}) {
    const Simulation sim = lamp(command + accuracy);
    for (const auto& [frame, level] : {std::pair{3, 1.0}, {7, 1.4}, {9, 1.0}, {11, 0.6}}) {
      const Frame f = renderFrame(sim, frame);
      figure(std::string("a plate under a flickering lamp, frame ") + std::to_string(frame) + ", " +
                 (*accuracy ? "accuracy " + std::string(accuracy + 10, std::strlen(accuracy) - 11) : "sampled") + " [W/(m2 sr)]",
             at(layer(f, "mw.radiance"), f, 4, 4), level * steady, 2e-6, "rho I / (pi d^2), single precision");
    }
  }
}

TEST(Flicker, IsReadByItsTable) {
  EXPECT_NE(keyReference().find("### command: flicker"), std::string::npos);
  const auto refusal = [](const std::string& command) -> std::string {
    try {
      lamp("commands: [" + command + "]\n");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{command: flicker, light: lamp}").find("missing key 'depth'"), std::string::npos);
  EXPECT_NE(refusal("{command: flicker, light: lmp, depth: 1}").find("did you mean 'lamp'?"), std::string::npos)
      << refusal("{command: flicker, light: lmp, depth: 1}");
  EXPECT_NE(refusal("{command: flicer, light: lamp}").find("did you mean 'flicker'?"), std::string::npos);
}

// The same while it runs, from the beginning of a tick on; and not in what is past.
TEST(Flicker, IsTakenLive) {
  const Simulation sim = lamp("");
  World world(sim);
  Value words;
  words.kind = Value::Kind::Map;
  for (const auto& [key, text] : {std::pair{"command", "flicker"}, {"light", "lamp"}, {"depth", "0.5"}, {"rate", "25 Hz"}}) {
    Value v;
    v.kind = Value::Kind::Scalar;
    v.text = text;
    words.entries.emplace_back(key, v);
    words.keyPlaces.emplace_back();
  }
  const Command command = readCommand(words, sim, sim.time.at(5));
  EXPECT_EQ(world.at(sim.time.at(4)).lightLevels[0], 1.0);
  world.apply(command, 5);
  EXPECT_NEAR(world.at(sim.time.at(6)).lightLevels[0], 1.5, 1e-12);
  EXPECT_NEAR(world.at(sim.time.at(6) + 0.005).lightLevels[0], 1.0 + 0.5 * std::sin(2.0 * kPi * 25.0 * 0.015), 1e-12) << "within a tick";
  EXPECT_THROW(world.apply(command, 4), std::invalid_argument);
  EXPECT_NO_THROW(world.at(sim.time.at(4))) << "an exposure may begin before";
}

TEST(CommandModels, TwoOfOneNameAreRefused) {
  Registry<CommandModel> two("command", {flickerCommand(), flickerCommand()});
  EXPECT_THROW(two.all(), std::logic_error);
}

}  // namespace
}  // namespace test
}  // namespace pitviper
