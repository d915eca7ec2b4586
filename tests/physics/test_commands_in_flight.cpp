// What a host commands of what flies and burns: flares ejected, throttles, speeds along routes; what goes with a body that is moved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "materials/fields/flares.hpp"
#include "materials/fields/jets.hpp"
#include "scenarios/commands/commands.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/world/field_states.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const std::string kEye =
    "time: {rate: 10 Hz, frames: 20}\nbackground: {temperature: 200 K}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}}\n"
    "cameras: [{name: c, film: {width: 32, height: 24}, field_of_view: 4 deg, aperture: 20 mm, position: [0 m, -2 km, 1 km], heading: 0 deg, channels: [{name: "
    "mw, response: {band: [3 um, 5 um]}}]}]\n";

std::string jet(const std::string& motion) {
  return "entities: [{name: jet, shape: {model: sphere, radius: 2 m}, material: m, temperature: 300 K, " + motion + "}]\n";
}
const std::string kStraight = "motion: [{time: 0 s, position: [-100 m, 0 m, 1 km]}, {time: 2 s, position: [100 m, 0 m, 1 km]}]",
                  kStill = "position: [-20 m, 0 m, 1 km], heading: 90 deg";

std::string flare(const std::string& time, const std::string& more = "") {
  return "flares: [{name: f, type: mtv, from: jet, time: " + time + ", position: [-2 m, 0 m, 0 m], direction: [0, 0, -1], speed: 20 m/s" + more + "}]\n";
}

const FieldState& field(const WorldState& state, std::size_t index) {
  const FieldState* there = fieldOf(state, index);
  if (!there) throw std::runtime_error("no such field now");
  return *there;
}

/// The light of a flare that a command ejects is that of the one that a scenario ejects then, and so is the picture.
TEST(CommandsInFlight, AFlareThatIsEjectedIsThatOfTheScenario) {
  for (const char* at : {"0.2 s", "0.5 s", "1.1 s"}) {
    const Simulation asked = scene(kEye + jet(kStraight) + flare("on_command") + "commands: [{command: eject, at: " + std::string(at) + ", flare: f}]\n"),
                     written = scene(kEye + jet(kStraight) + flare(at));
    for (double t : {0.1, 0.6, 1.15, 1.9}) {
      const WorldState a = advance(asked, t), b = advance(written, t);
      EXPECT_NEAR(a.lightLevels[0], b.lightLevels[0], 1e-12) << at << t;
      EXPECT_EQ(fieldOf(a, 0) == nullptr, fieldOf(b, 0) == nullptr) << at << t;
      EXPECT_EQ(fieldOf(a, 1) == nullptr, fieldOf(b, 1) == nullptr) << at << t;
      if (b.lightLevels[0] > 0.0) {
        EXPECT_LT(glm::length(a.lights[0] - b.lights[0]), 1e-9) << at << t;
      }
    }
    if (std::string(at) != "0.5 s") continue;  // one picture tells that light is what is drawn
    const Frame a = renderFrame(asked, 15), b = renderFrame(written, 15);
    double worst = 0.0, most = 0.0;
    for (std::size_t p = 0; p < a.layers[0].pixels.size(); ++p) {
      most = std::max(most, static_cast<double>(b.layers[0].pixels[p]));
      worst = std::max(worst, std::abs(static_cast<double>(a.layers[0].pixels[p] - b.layers[0].pixels[p])));
    }
    EXPECT_LE(worst, 1e-6 * most) << at;
    EXPECT_GT(most, 10.0 * blackBodyBand(3, 5, 300)) << "it burns in the picture";
  }
}

/// Of a body that a host moves: from where that is, as fast as it goes, whether the host says how fast or only where.
TEST(CommandsInFlight, AFlareLeavesWhereTheHostHasItsCarrier) {
  const Simulation sim = scene(kEye + jet(kStill) + flare("on_command", ", sequence: {count: 3}"));
  ASSERT_EQ(sim.stores.size(), 3u);
  const auto say = [&](World& world, int tick, const std::vector<std::pair<std::string, std::string>>& words) {
    world.apply(commandOf(words, "test", sim, sim.time.at(tick)), tick);
  };
  const auto move = [&](World& world, int tick, const glm::dvec3& at, const std::string& velocity) {
    std::vector<std::pair<std::string, std::string>> words{
        {"command", "move"}, {"entity", "jet"}, {"position", print("%.17g m, %.17g m, ", at.x, at.y) + print("%.17g m", at.z)}, {"heading", "90 deg"}};
    if (!velocity.empty()) words.emplace_back("velocity", velocity);
    say(world, tick, words);
  };
  std::mt19937 dice(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 v(250.0 * unit(dice), 250.0 * unit(dice), 50.0 * unit(dice)), from(300.0 * unit(dice), 300.0 * unit(dice), 1000.0 + 100.0 * unit(dice));
    const bool told = k % 2 == 0;
    World world(sim);
    if (told) move(world, 3, from, print("%.17g m/s, %.17g m/s, ", v.x, v.y) + print("%.17g m/s", v.z));
    else
      for (int tick = 0; tick <= 3; ++tick) move(world, tick, from + v * sim.time.at(tick - 3), "");
    say(world, 3, {{"command", "eject"}, {"flare", "f_1"}});
    const WorldState now = world.at(sim.time.at(3));
    ASSERT_EQ(now.ejected.size(), 1u);
    const Trajectory& path = *now.ejected.at(1)->path;
    EXPECT_LT(glm::length(path.at(sim.time.at(3)).position - (from + glm::dvec3(-2.0, 0.0, 0.0))), 1e-9) << "2 m behind the middle of a body that looks east";
    EXPECT_LT(glm::length(path.velocityAt(sim.time.at(3)) - (v + glm::dvec3(0.0, 0.0, -20.0))), 1e-6 * glm::length(v)) << told;
    EXPECT_EQ(fieldOf(world.at(0.9), 0), nullptr) << "the others are aboard";
    EXPECT_NE(fieldOf(world.at(0.9), 2), nullptr);
    EXPECT_GT(world.at(0.9).lightLevels[1], 0.0);
    EXPECT_EQ(world.at(0.9).lightLevels[0], 0.0);
  }
  // Ejected once more it begins anew.
  World world(sim);
  say(world, 1, {{"command", "eject"}, {"flare", "f_0"}});
  say(world, 9, {{"command", "eject"}, {"flare", "f_0"}});
  EXPECT_NEAR(world.at(1.0).ejected.at(0)->lit_s, 0.9 + findFlareType("mtv")->ignition_s, 1e-9);
}

/// A throttle that is commanded is the scenario's own, but for the tenth of a second that a nozzle takes.
TEST(CommandsInFlight, AThrottleIsAsTheScenarioHasIt) {
  for (const auto& [engine, from, to] : {std::tuple{"turbofan_military", 1.0, 0.2}, {"turbofan_afterburner", 0.1, 0.9}, {"nozzle", 1.0, 0.4}}) {
    const auto plume = [&, engine = engine](double throttle) {
      return jet(kStill) + "plumes: [{name: ex, on: jet, begin: 0 s, length: 20 m, " +
             (std::string(engine) == "nozzle" ? "nozzle: {diameter: 40 cm, temperature: 900 K, speed: 300 m/s, species: {co2: 5 %, h2o: 5 %}}"
                                              : "engine: " + std::string(engine)) +
             print(", throttle: %g}]\n", throttle);
    };
    const Simulation asked = scene(kEye + plume(from) + print("commands: [{command: throttle, at: 0.5 s, plume: ex, value: %g}]\n", to)),
                     before = scene(kEye + plume(from)), after = scene(kEye + plume(to));
    const auto jetAt = [](const Simulation& sim, double t) {
      std::vector<double> all;
      std::vector<FieldStep> steps;
      for (double behind : {0.5, 2.0, 8.0}) {
        field(advance(sim, t), 0).along({{-20.0 - behind, -50.0, 1000.05}, {0.0, 1.0, 0.0}, 0.0, 100.0}, 16, steps);
        for (const FieldStep& step : steps) all.insert(all.end(), {step.temperature_K, step.amount[0]});
      }
      return all;
    };
    EXPECT_FALSE(jetAt(asked, 0.4).empty());
    EXPECT_EQ(jetAt(asked, 0.45), jetAt(before, 0.45)) << engine;
    EXPECT_EQ(jetAt(asked, 0.61), jetAt(after, 0.61)) << engine;
    if (std::string(engine) == "nozzle") {
      EXPECT_NE(jetAt(asked, 0.55), jetAt(after, 0.55)) << "on its way";
    }
    EXPECT_NE(jetAt(before, 0.61), jetAt(after, 0.61)) << engine;
    if (std::string(engine) != "turbofan_afterburner") continue;
    // In the picture of a plan that has seen both.
    const auto light = [](const Simulation& sim, int frame) { return sum(layer(renderFrame(sim, frame), "mw.radiance")); };
    const double dark = light(scene(kEye + jet(kStill)), 0);
    figure("light of an afterburner that a command has lit, over that of a scenario's", (light(asked, 7) - dark) / (light(after, 7) - dark), 1.0, 0.01,
           "both drawn to the 1 % of pictures of fields");
    EXPECT_GT(light(after, 7) - dark, 1.5 * (light(before, 7) - dark));
  }
}

/// The skin of an engine whose throttle is moved follows by its time constant, from whatever it has.
TEST(CommandsInFlight, ASkinFollowsByItsTimeConstant) {
  const Simulation sim = scene(kEye + jet(kStill) +
                               "commands: [{command: temperature, at: 0.2 s, entity: jet, value: 900 K, time_constant: 0.5 s}, {command: temperature, at: 1 s, "
                               "entity: jet, value: 400 K, time_constant: 0.2 s}]\n");
  const double turned = 900.0 - 600.0 * std::exp(-0.8 / 0.5);
  for (double t : {0.0, 0.2, 0.3, 0.9, 1.0, 1.1, 1.9}) {
    const double right = t <= 0.2 ? 300.0 : t <= 1.0 ? 900.0 - 600.0 * std::exp(-(t - 0.2) / 0.5) : 400.0 + (turned - 400.0) * std::exp(-(t - 1.0) / 0.2);
    EXPECT_NEAR(advance(sim, t).temperatures_K[0][0], right, 1e-9) << t;
  }
}

/// A host that sets a throttle every tick: what is kept does not grow, and it follows.
TEST(CommandsInFlight, ThrottlesEveryTick) {
  const Simulation sim = scene(kEye + jet(kStill) + "plumes: [{name: ex, on: jet, engine: turbofan_military, length: 20 m}]\n");
  World world(sim);
  for (int tick = 0; tick < 200; ++tick)
    world.apply(commandOf({{"command", "throttle"}, {"plume", "ex"}, {"value", print("%g", 0.5 + 0.4 * std::sin(0.1 * tick))}}, "test", sim, sim.time.at(tick)),
                tick);
  const WorldState now = world.at(sim.time.at(199));
  EXPECT_LT(now.throttles.at(0)->steps.size(), 14u);
  EXPECT_NEAR(*now.throttles.at(0)->at(sim.time.at(199)), 0.5 + 0.4 * std::sin(19.9), 1e-5);
}

/// A plume on a body that is moved goes with it, in the flow that it flies through.
TEST(CommandsInFlight, APlumeGoesWithTheBodyThatIsMoved) {
  const std::string plume = "plumes: [{name: ex, on: jet, engine: turbofan_military, length: 20 m}]\n";
  for (double speed : {0.0, 100.0, 250.0}) {
    const std::string motion = print("motion: [{time: 0 s, position: [-%g m, 0 m, 1 km], heading: 90 deg}, ", 0.5 * speed) +
                               print("{time: 1 s, position: [%g m, 0 m, 1 km], heading: 90 deg}]", 0.5 * speed);
    const Simulation flown = scene(kEye + jet(motion) + plume), moved = scene(kEye + jet(kStill) + plume);
    const double at = -0.5 * speed + 0.5 * speed;
    World world(moved);
    world.apply(commandOf({{"command", "move"},
                           {"entity", "jet"},
                           {"position", print("%g m, 0 m, 1000 m", at)},
                           {"heading", "90 deg"},
                           {"velocity", print("%g m/s, 0 m/s, 0 m/s", speed)}},
                          "test", moved, 0.5),
                5);
    const WorldState a = world.at(0.5), b = advance(flown, 0.5);
    std::vector<FieldStep> stepsA, stepsB;
    for (double behind : {1.0, 3.0, 10.0}) {
      const FieldLine line{{at - behind, -50.0, 1000.1}, {0.0, 1.0, 0.0}, 0.0, 100.0};
      field(a, 0).along(line, 32, stepsA);
      field(b, 0).along(line, 32, stepsB);
      ASSERT_EQ(stepsA.size(), stepsB.size()) << speed << ' ' << behind;
      ASSERT_FALSE(stepsA.empty());
      for (std::size_t k = 0; k < stepsA.size(); ++k) EXPECT_NEAR(stepsA[k].temperature_K, stepsB[k].temperature_K, 1e-3 * stepsB[k].temperature_K) << speed;
    }
  }
}

/// Along a route: so far at that speed as the route is long.
TEST(CommandsInFlight, SpeedAlongARoute) {
  const std::string corner =
      "motion: {model: waypoints, points: [{time: 0 s, position: [0 m, 0 m, 1 km]}, {time: 1 s, position: [100 m, 0 m, 1 km]}, {time: 3 s, position: [100 m, "
      "400 m, 1 km]}], interpolation: linear}";
  const auto placed = [&](const std::string& motion, const std::string& commands, double t) {
    return advance(scene(kEye + jet(motion) + "commands: [" + commands + "]\n"), t).entities[0].position;
  };
  double worst = 0.0;
  for (double speed : {30.0, 100.0, 350.0})
    for (double t : {0.6, 1.0, 1.7, 2.4}) {
      const double way = 50.0 + speed * (t - 0.5);  // half of the first leg has been flown by 0.5 s
      const glm::dvec3 right = way < 100.0 ? glm::dvec3(way, 0.0, 1000.0) : glm::dvec3(100.0, std::min(way - 100.0, 400.0), 1000.0);
      worst = std::max(worst, glm::length(placed(corner, "{command: speed, at: 0.5 s, entity: jet, value: " + print("%g m/s}", speed), t) - right));
    }
  bound("place on two straight legs of 100 and 200 m/s flown at 30 to 350 [m]", worst, 0.01,
        "Simpson's rule over parts of 50 ms, exact on straight legs; the interpolation between");
  EXPECT_LT(glm::length(placed(corner, "{command: speed, at: 0.5 s, entity: jet, value: 0 m/s}", 1.9) - glm::dvec3(50.0, 0.0, 1000.0)), 1e-6);
  // Faster, then slower.
  EXPECT_LT(glm::length(placed(corner, "{command: speed, at: 0.5 s, entity: jet, value: 200 m/s}, {command: speed, at: 1 s, entity: jet, value: 50 m/s}", 2.0) -
                        glm::dvec3(100.0, 100.0, 1000.0)),
            0.01);
  // A smooth route: an arc as long as it is; a circle in loops.
  const std::string arc =
      "motion: {model: waypoints, points: [{time: 0 s, position: [0 m, 0 m, 1 km]}, {time: 1 s, position: [80 m, 10 m, 1 km]}, {time: 2 s, position: [120 m, "
      "90 m, 1 km]}, {time: 3 s, position: [90 m, 170 m, 1 km]}]}";
  const Simulation smooth = scene(kEye + jet(arc) + "commands: [{command: speed, at: 0 s, entity: jet, value: 60 m/s}]\n");
  double way = 0.0;
  glm::dvec3 last = advance(smooth, 0.0).entities[0].position;
  for (int k = 1; k <= 4000; ++k) {
    const glm::dvec3 next = advance(smooth, 5e-4 * k).entities[0].position;
    way += glm::length(next - last);
    last = next;
  }
  figure("way along a smooth route in 2 s at 60 m/s [m]", way, 120.0, 2e-4, "chords of 3 cm; steps of 50 ms");
  // A move takes it off, a speed brings it back.
  EXPECT_LT(
      glm::length(
          placed(corner, "{command: move, at: 0.2 s, entity: jet, position: [9 m, 9 m, 9 m]}, {command: speed, at: 0.5 s, entity: jet, value: 100 m/s}", 0.7) -
          glm::dvec3(70.0, 0.0, 1000.0)),
      0.01);
  // Its plume feels the speed.
  const Simulation plume = scene(
      kEye + jet(corner) + "plumes: [{name: ex, on: jet, engine: turbofan_military}]\ncommands: [{command: speed, at: 0.1 s, entity: jet, value: 222 m/s}]\n");
  EXPECT_NEAR(glm::length(advance(plume, 0.3).velocities.at(0)), 222.0, 0.1);
}

/// A plan knows what may be ejected: pictures of a flare that no frame of the scenario has.
TEST(CommandsInFlight, PlansAreMadeForFlaresThatMayBeEjected) {
  const std::string world = kEye + "atmosphere: clear_us76\n" + jet(kStraight) + flare("on_command", ", smoke: false");
  const Simulation planned = scene("accuracy: 1 %\n" + world), reference = scene("accuracy: reference\n" + world);
  needContext();
  const auto picture = [](const Simulation& sim) {
    World live(sim);
    live.apply(commandOf({{"command", "eject"}, {"flare", "f"}}, "test", sim, 0.5), 5);
    CameraRenderer renderer(sim, sim.cameras[0], cameraPlan(sim, sim.cameras[0]), shaderLibrary(), std::make_shared<const GpuScene>(sim));
    const CameraImage image = renderer.render(live.at(0.9));
    double sum = 0.0;
    for (std::size_t p = 0; p < image.slots[0].size(); ++p) sum += image.slots[0][p] * image.solidAngles->plain_sr[p];
    return sum;
  };
  const double with = picture(planned), right = picture(reference);
  figure("all light of a picture with a flare that a host ejects", with / right, 1.0, 0.01, "accuracy asked");
}

TEST(CommandsInFlight, MistakesAreNamed) {
  const std::string things =
      jet(kStraight) + flare("on_command") + "plumes: [{name: ex, on: jet, engine: turbofan_military}, {name: solid, on: jet, engine: double_base_motor}]\n";
  const std::pair<const char*, const char*> cases[] = {{"{command: eject, at: 0 s, flare: g}", "there is no flare"},
                                                       {"{command: throttle, at: 0 s, plume: eh, value: 1}", "there is no plume"},
                                                       {"{command: throttle, at: 0 s, plume: ex, value: 1.5}", "value"},
                                                       {"{command: throttle, at: 0 s, plume: f, value: 1}", "there is no plume of an engine or nozzle"},
                                                       {"{command: throttle, at: 0 s, plume: solid, value: 0.5}", "there is no plume of an engine or nozzle"},
                                                       {"{command: speed, at: 0 s, entity: jte, value: 100 m/s}", "there is no entity"},
                                                       {"{command: speed, at: 0 s, entity: jet, value: -1 m/s}", "value"},
                                                       {"{command: speed, at: 0 s, entity: still, value: 1 m/s}", "has no route"}};
  const auto told = [](const std::string& text) -> std::string {
    try {
      scene(text);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  for (const auto& [command, says] : cases) {
    std::string all = kEye + things;
    all.replace(all.find("entities: ["), 11,
                "entities: [{name: still, shape: {model: sphere, radius: 1 m}, material: m, temperature: 300 K, position: [0 m, 0 m, 1 km]}, ");
    const std::string said = told(all + "commands: [" + command + "]\n");
    EXPECT_NE(said.find(says), std::string::npos) << command << "\n" << said;
  }
  EXPECT_NE(told(kEye + jet(kStraight) + flare("on_comand")).find("time"), std::string::npos);
  EXPECT_NE(told(kEye + jet(kStraight) + flare("on_command", ", sequence: {count: 2, interval: 1 s}")).find("an interval between flares that commands eject"),
            std::string::npos);
  EXPECT_NE(told(kEye + jet(kStraight) + flare("1 s", ", sequence: {count: 2}")).find("a sequence without an interval"), std::string::npos);
  EXPECT_NE(told(kEye + jet("begin: 1 s, " + kStraight) + flare("on_command") + "commands: [{command: eject, at: 0.5 s, flare: f}]\n")
                .find("isn't there when it should eject"),
            std::string::npos);
}

}  // namespace
}  // namespace pitviper::test
