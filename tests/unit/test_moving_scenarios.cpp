// Motions and temperatures over time as scenarios have them: read, flown, and refused at their places.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim/flight/recovery_temperature.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/gravity.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

const std::string kCamera =
    "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 5 mm, position: [20 m, 0 m, 0 m], heading: 0 deg, channels: [{name: x, "
    "response: {band: [3 "
    "um, 5 um]}}]}]\n";

/// A ball with more keys.
std::string ball(const std::string& name, const std::string& keys) {
  return "  - {name: " + name + ", shape: {model: sphere, radius: 1 m}, material: blackbody, " +
         (keys.find("temperature:") == std::string::npos ? "temperature: 300 K, " : "") + keys + "}\n";
}

Simulation flown(const std::string& entities, const std::string& top = "", int frames = 50) {
  return scene("time: {rate: 10 Hz, frames: " + std::to_string(frames) + "}\n" + top + "entities:\n" + entities + kCamera);
}

double off(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }

TEST(MovingScenarios, WaypointsWithAModelEndsAndSpin) {
  const Simulation sim =
      flown(ball("a",
                 "ends: {before: vanish, after: go_on}, spin: {axis: [2, 0, 0], rate: 720 deg/s}, motion: {model: waypoints, interpolation: linear, points: "
                 "[{time: 1 s, position: [0 m, 0 m, 0 m]}, {time: 2 s, position: [0 m, 30 m, 0 m]}]}") +
            ball("rotor", "position: [0 m, 0 m, 2 m], spin: {axis: [0, 0, 1], angle: [[0 s, 0 deg], [1 s, 900 deg]]}"));
  const Motion& m = sim.entities[0].motion;
  EXPECT_FALSE(advance(sim, 0.5).isThere(0));
  EXPECT_LT(off(m.at(4.0).position, {0.0, 90.0, 0.0}), 1e-12);
  EXPECT_LT(off(m.at(1.125).orientation * glm::dvec3(0, 1, 0), m.at(1.0).orientation * glm::dvec3(0, 0, 1)), 1e-12);  // 90 deg of its 720 a second from 0 s on
  EXPECT_LT(off(sim.entities[1].motion.at(1.0).orientation * glm::dvec3(1, 0, 0), {-1.0, 0.0, 0.0}), 1e-12);          // 900 deg are two turns and a half
}

// Rationale: a route flies its turns with the g it is given: v^2/R is the limit, speed stays; then it goes on.
TEST(MovingScenarios, RouteTurnsWithinItsLimit) {
  const Simulation sim =
      flown(ball("jet",
                 "motion: {model: route, speed: 200 m/s, g_limit: 4, begin: 0.5 s, points: [{position: [0 m, 0 m, 3 km]}, {position: [3 km, 0 m, 3 "
                 "km]}, {position: [3 km, 3 km, 3 km], speed: 200 m/s}]}"),
            "", 300);
  ASSERT_TRUE(sim.entities[0].flight);
  EXPECT_EQ(sim.entities[0].flight->model, "route");
  const Motion& m = sim.entities[0].motion;
  // Its turn: tangents of 1020 m leave 1980 m of the first leg, 9.9 s; the arc takes 8 s.
  double most = 0.0, least = 1e9;
  for (double t = 0.5 + 10.2; t < 0.5 + 17.6; t += 0.05) {
    const double h = 1e-3, a = off(m.velocityAt(t + h), m.velocityAt(t - h)) / (2.0 * h);
    most = std::max(most, a), least = std::min(least, a);
  }
  double slowest = 1e9, fastest = 0.0;
  for (double t = 0.6; t < m.end_s() - 0.1; t += 0.01) {
    slowest = std::min(slowest, glm::length(m.velocityAt(t)));
    fastest = std::max(fastest, glm::length(m.velocityAt(t)));
  }
  figure("lateral acceleration of a route of 4 g [m/s2]", most, 4.0 * kStandardGravity, 0.01,
         "v^2/R; legs follow the earth: 0.006 m/s2 more, and differences over joints");
  EXPECT_NEAR(slowest, 200.0, 0.1);  // 3 km above the sphere that legs are laid out on: 5e-4 of speeds
  EXPECT_NEAR(fastest, 200.0, 0.1);
  EXPECT_EQ(m.after(), AtEnd::GoOn);
  EXPECT_TRUE(advance(sim, 0.0).isThere(0));
}

TEST(MovingScenarios, PathFromAFile) {
  const auto folder = std::filesystem::temp_directory_path() / ("pitviper_path_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "path.csv")
      << "time_s,north_m,east_m,down_m,heading_deg,pitch_deg,roll_deg\n0,0,0,-100,90,0,0\n1,0,50,-100,90,0,0\n2,0,100,-100,90,0,0\n";
  const std::string file = (folder / "path.csv").string();
  const Simulation sim = flown(ball("a", "ends: loop, motion: {model: csv, file: '" + file + "'}"));
  EXPECT_LT(off(sim.entities[0].motion.at(0.5).position, {25.0, 0.0, 100.0}), 1e-9);
  EXPECT_LT(off(sim.entities[0].motion.at(2.5).position, {25.0, 0.0, 100.0}), 1e-9);
  EXPECT_EQ(sim.entities[0].flight->model, "csv");
  std::ofstream(folder / "path.csv") << "time_s,x_m,y_m,z_m\n0,0,0,0\n0,1,0,0\n";
  try {
    flown(ball("a", "motion: {model: csv, file: '" + file + "'}"));
    ADD_FAILURE() << "taken";
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("path.csv:3:"), std::string::npos) << e.what();
  }
  std::filesystem::remove_all(folder);
}

// Rationale: without drag a thrown body falls by g t^2/2 from where it was thrown, with the velocity of what it was thrown from and its ejection in that body's
// axes.
TEST(MovingScenarios, BallisticFallsFromItsCarrier) {
  const std::string carrier =
      ball("carrier", "motion: [{time: 0 s, position: [0 m, 0 m, 1 km]}, {time: 5 s, position: [0 m, 1000 m, 1 km]}], interpolation: linear");
  const Simulation sim =
      flown(carrier + ball("flare",
                           "attached_to: carrier, position: [-4 m, 0 m, -1 m], motion: {model: ballistic, launch: 1 s, velocity: [0 m/s, 10 m/s, -20 m/s], "
                           "mass: 0.3 kg}"));
  const Entity& flare = sim.entities[1];
  EXPECT_EQ(flare.parent, -1);
  EXPECT_FALSE(advance(sim, 0.95).isThere(1));
  EXPECT_TRUE(advance(sim, 1.0).isThere(1));
  // The carrier flies north: its left is west, forward is north.
  const glm::dvec3 start(0.0, 200.0 - 4.0, 999.0), velocity(-10.0, 200.0, -20.0);
  const double t = 2.0, g = glm::length(normalGravity(sim.frame, {0.0, 400.0, 950.0}));
  const glm::dvec3 expected = start + t * velocity + glm::dvec3(0.0, 0.0, -0.5 * g * t * t);
  // Gravity over 40 m of height: 1.3e-5 of it; over 400 m of way it turns by 6e-5.
  bound("a body thrown from a carrier, after 2 s [m]", off(flare.motion.at(3.0).position, expected), 2e-3,
        "g t^2/2 with g at the middle: 2 s x 2 s x 9.8 x 6e-5 / 2");
  EXPECT_EQ(flare.flight->end, "duration");
  EXPECT_EQ(flare.flight->model, "ballistic");
}

TEST(MovingScenarios, BallisticEndsAtTheGroundAndDriftsWithTheWind) {
  const std::string puff =
      ball("leaf", "position: [0 m, 0 m, 20 m], motion: {model: ballistic, launch: 0 s, mass: 0.01 kg, area: 0.5 m2, drag: 1.2, step: 1 ms}");
  const Simulation sim = flown(puff, "wind: {speed: 10 m/s, direction: 270 deg}\n", 500);
  const Motion& m = sim.entities[0].motion;
  // It has the wind's velocity across, and its terminal speed down: v^2 = 2 m g / (rho C A).
  const double terminal = std::sqrt(2.0 * 0.01 * 9.7803 / (1.225 * 0.6));
  figure("drift of a light body in the wind [m/s]", m.velocityAt(5.0).x, 10.0, 1e-3, "no force along the wind once it drifts with it");
  figure("its fall [m/s]", -m.velocityAt(5.0).z, terminal, 2e-3, "terminal speed; density 20 m up is 0.2 % less");
  EXPECT_EQ(sim.entities[0].flight->end, "ground");
  EXPECT_NEAR(sim.frame.height(m.at(m.end_s()).position), 0.0, 1e-3);  // 400 m downwind the earth is 1 cm lower
  EXPECT_FALSE(advance(sim, m.end_s() + 0.1).isThere(0));
}

const std::string kMissile =
    "model: missile, launch: 0.5 s, speed: 300 m/s, mass: 85 kg, propellant: 20 kg, thrust: [[0 s, 15 kN], [2 s, 15 kN], [2.1 s, 0 N]], diameter: 13 cm, drag: "
    "[[0.8, 0.3], [1.2, 0.6], [3, 0.4]], g_limit: 40";
const std::string kTarget =
    "motion: {model: route, speed: 200 m/s, points: [{position: [-500 m, 3 km, 1 km]}, {position: [500 m, 3 km, 1 km]}, {position: [3 km, 4 km, 1 km]}]}";

TEST(MovingScenarios, MissilesHitWhatTheyFlyAt) {
  // The missile before its target in the file: who is flown first follows from who looks at whom.
  for (const char* law : {"true_pn", "pure_pn", "pursuit", "none"}) {
    const Simulation sim =
        flown(ball("missile", "position: [0 m, 0 m, 500 m], motion: {" + kMissile + ", target: jet, guidance: " + law + "}") + ball("jet", kTarget), "", 200);
    const FlightRecord& flight = *sim.entities[0].flight;
    EXPECT_EQ(flight.target, "jet");
    ASSERT_TRUE(flight.closest);
    const double miss = off(poseOf(sim, 0, flight.closest->time_s).position, poseOf(sim, 1, flight.closest->time_s).position);
    EXPECT_NEAR(miss, flight.closest->distance_m, 0.01) << law;
    if (std::string(law) == "none") {
      EXPECT_GT(flight.closest->distance_m, 100.0);  // the target is 1 km on
      EXPECT_NE(flight.end, "closest approach");
    } else {
      EXPECT_LT(flight.closest->distance_m, 10.0) << law;  // within what a fuze reaches: a tail chase of pursuit ends nearest last
      EXPECT_EQ(flight.end, "closest approach") << law;
    }
  }
}

TEST(MovingScenarios, ChainsOfFlights) {
  const Simulation sim = flown(ball("third", "position: [0 m, -1 km, 500 m], motion: {" + kMissile + ", target: second}") +
                                   ball("second", "position: [0 m, 0 m, 500 m], motion: {" + kMissile + ", target: jet}") + ball("jet", kTarget),
                               "", 100);
  for (int e : {0, 1}) EXPECT_TRUE(sim.entities[static_cast<size_t>(e)].flight->closest);
}

TEST(MovingScenarios, LightsFlyToo) {
  const Simulation sim = scene(
      "time: {rate: 10 Hz, frames: 30}\nentities:\n" + ball("carrier", "position: [0 m, 0 m, 500 m]") +
      "lights: [{name: flare, intensity: 5 W/(sr um), attached_to: carrier, motion: {model: ballistic, launch: 1 s, velocity: [0 m/s, 0 m/s, -30 m/s], mass: 1 "
      "kg}}]\n" +
      kCamera);
  EXPECT_EQ(advance(sim, 0.9).lightLevels[0], 0.0);
  EXPECT_EQ(advance(sim, 1.0).lightLevels[0], 1.0);
  EXPECT_NEAR(advance(sim, 2.0).lights[0].z, 500.0 - 30.0 - 0.5 * 9.779, 2e-3);  // g 480 m up at the equator: 9.7788
}

// Rationale: frames have no say in how something flies.
TEST(MovingScenarios, FlightsDoNotDependOnTheFrameRate) {
  const auto at = [](const std::string& time) {
    const Simulation sim =
        scene("time: {" + time + "}\nentities:\n" + ball("missile", "position: [0 m, 0 m, 500 m], motion: {" + kMissile + ", target: jet, duration: 4 s}") +
              ball("jet", kTarget) + kCamera);
    return sim.entities[0].motion.at(3.33).position;
  };
  EXPECT_EQ(at("rate: 10 Hz, frames: 40"), at("rate: 77 Hz, frames: 300"));
}

// T (1 + 0.2 r M^2) at the body's Mach number and height.
TEST(MovingScenarios, SkinTemperatureByRecovery) {
  const auto skin = [](const std::string& temperature, const std::string& top = "") {
    const Simulation sim =
        flown(ball("jet", "temperature: " + temperature +
                              ", motion: [{time: 0 s, position: [0 m, 0 m, 10 km]}, {time: 5 s, position: [0 m, 2.5 km, 10 km]}], interpolation: linear"),
              top);
    return advance(sim, 2.5).temperatures_K[0][0];
  };
  const StandardAir air = standardAir(10000.0);
  const double mach = 500.0 / air.soundSpeed_m_s;
  // 10 km up over the flat local frame: the sphere falls off by 0.1 m at 1.25 km, 7e-4 K.
  EXPECT_NEAR(skin("{recovery: turbulent}"), air.temperature_K * (1.0 + std::cbrt(0.71) * 0.2 * mach * mach), 0.002);
  EXPECT_NEAR(skin("{recovery: laminar}"), air.temperature_K * (1.0 + std::sqrt(0.71) * 0.2 * mach * mach), 0.002);
  EXPECT_NEAR(skin("{recovery: turbulent, factor: 0.5, offset: -20 K}"), air.temperature_K * (1.0 + 0.5 * 0.2 * mach * mach) - 20.0, 0.002);
  // A wind from behind of 50 m/s: 450 m/s through the air.
  const double slower = 450.0 / air.soundSpeed_m_s;
  EXPECT_NEAR(skin("{recovery: turbulent}", "wind: {speed: 50 m/s, direction: 180 deg}\n"), air.temperature_K * (1.0 + std::cbrt(0.71) * 0.2 * slower * slower),
              0.002);
}

TEST(MovingScenarios, CamerasZoomAndExposeOverTime) {
  const Simulation sim = scene("time: {rate: 10 Hz, frames: 20, start: 1 s}\nentities:\n" + ball("a", "position: [0 m, 0 m, 0 m]") +
                               "cameras: [{name: c, film: {width: 100, height: 100, pitch: 20 um}, field_of_view: [[0 s, 20 deg], [2 s, 10 deg]], exposure: "
                               "[[1 s, 4 ms], [3 s, 2 ms]], aperture: 5 "
                               "mm, position: [20 m, 0 m, 0 m], look_at: a, channels: [{name: x, response: {band: [3 um, 5 um]}}]}]\n");
  const auto at = [&](double t) { return cameraAt(sim.cameras[0], advance(sim, t)); };
  const auto focal = [](double degrees) { return 1e-3 / std::tan(0.5 * degrees * kPi / 180.0); };
  EXPECT_NEAR(at(2.0).pinhole.focalLength_m, focal(10.0), 1e-12);
  EXPECT_NEAR(at(1.0).pinhole.focalLength_m, 0.5 * (focal(10.0) + focal(20.0)), 1e-12);  // evenly by focal length
  EXPECT_NEAR(sim.cameras[0].pinhole.focalLength_m, focal(15.0), 1e-12) << "of the first frame, by the course of angles";
  EXPECT_NEAR(at(2.0).exposures_s.common, 3e-3, 1e-15);
  EXPECT_NEAR(sim.cameras[0].exposure_s, 4e-3, 1e-15);
}

TEST(MovingScenarios, WhatIsWrongIsNamedAtItsPlace) {
  struct Wrong {
    std::string keys, word, says;  ///< `word`: what the error points at
  };
  const std::vector<Wrong> all = {
      {"temperature: [[0 s, 300 K], [2 s, 310 K], [1 s, 320 K]]", "1 s", "do not rise"},
      {"temperature: [[0 s, 300 K], [2 s, 310 m]]", "310 m", "wrong unit"},
      {"temperature: [[0 s, 300 K], [2 s, -3 K]]", "-3 K", "out of range"},
      {"temperature: {over: [[0 s, 300 K]], outside: loop}", "[[0 s, 300 K]]", "one row"},
      {"temperature: {recovery: some}", "some", "recovery"},
      {"begin: 3 s, end: 2 s", "2 s}", "at or before the begin"},
      {"ends: stop, motion: [{time: 0 s, position: [0 m, 0 m, 0 m]}]", "stop", "stop"},
      {"ends: vanish", "vanish", "no motion"},
      {"spin: {axis: [0, 0, 0], rate: 3 deg/s}", "[0, 0, 0]", "length 0"},
      {"spin: {axis: [0, 0, 1]}", "{axis", "without a rate"},
      {"motion: {points: []}", "{points", "without a model"},
      {"motion: {model: rout}", "rout}", "'route'"},
      {"motion: {model: route, speed: 300 m/s, g_limit: 2, points: [{position: [0 m, 0 m, 1 km]}, {position: [1 km, 0 m, 1 km]}, {position: [1 km, 1 km, 1 "
       "km]}]}",
       "[1 km, 0 m, 1 km]", "g"},
      {"motion: {model: route, speed: 300 m/s, g_limit: 2, points: [{position: [0 m, 0 m, 1 km]}, {position: [9 km, 0 m, 1 km], turn_g: 3}, {position: [9 km, "
       "9 km, 1 km]}]}",
       "3}", "2 g are allowed"},
      {"motion: {model: route, points: [{position: [0 m, 0 m, 1 km]}, {position: [9 km, 0 m, 1 km]}]}", "{position: [0 m, 0 m, 1 km]}", "without a speed"},
      {"motion: {model: route, speed: 3 m/s, points: [{position: [0 m, 0 m, 1 km]}, {position: [0 m, 0 m, 1 km]}]}", "[0 m, 0 m, 1 km]}]",
       "is where the one before"},
      {"motion: {model: csv, file: nowhere.csv}", "nowhere.csv", "nowhere.csv"},
      {"position: [0 m, 0 m, 1 km], motion: {model: missile, launch: 9 s, mass: 1 kg}", "9 s", "after the last frame"},
      {"position: [0 m, 0 m, 1 km], motion: {model: missile, launch: 0 s, mass: 1 kg, target: nobody}", "nobody", "there is no entity"},
      {"position: [0 m, 0 m, 1 km], motion: {model: missile, launch: 0 s, mass: 1 kg, target: x}", "x}", "flies at itself"},
      {"position: [0 m, 0 m, 1 km], motion: {model: missile, launch: 0 s, mass: 1 kg, guidance: pursuit}", "pursuit", "without a target"},
      {"position: [0 m, 0 m, 1 km], motion: {model: missile, launch: 0 s, mass: 10 kg, heading: 3 deg}", "heading", "unknown key"},
      {"position: [0 m, 0 m, 1 km], motion: {model: missile, launch: 0 s, mass: 10 kg, speed: 30 m/s}", "30 m/s", "without a direction"},
      {"motion: {model: missile, launch: 0 s, mass: 10 kg, speed: 30 m/s}", "{name: x", "from nowhere"},
      {"position: [0 m, 0 m, 1 km], heading: 3 deg, motion: {model: missile, launch: 0 s, mass: 10 kg, propellant: 12 kg, thrust: [[0 s, 1 kN], [1 s, 0 N]]}",
       "12 kg", "less than the mass"},
      {"position: [0 m, 0 m, 1 km], heading: 3 deg, motion: {model: missile, launch: 0 s, mass: 10 kg, thrust: [[0 s, 1 kN], [1 s, 2 kN], [1 s, 0 N]]}",
       "1 s, 0 N", "do not rise"},
      {"position: [0 m, 0 m, 1 km], heading: 3 deg, motion: {model: missile, launch: 0 s, mass: 10 kg, drag: [[0.8, 0.3], [0.7, 0.2]], area: 1 m2}", "0.7",
       "do not rise"},
      {"position: [0 m, 0 m, 1 km], motion: {model: ballistic, launch: 0 s, mass: 10 kg, drag: 0.3}", "0.3}", "without an area"},
      {"position: [0 m, 0 m, 1 km], motion: {model: ballistic, launch: 0 s, mass: 10 kg, area: 1 m2, diameter: 1 m}", "1 m}", "an area and a diameter"},
      {"position: [0 m, 0 m, 1 km], motion: {model: ballistic, launch: 0 s, mass: 10 kg, burnt_share: 0.5}", "0.5", "burns in no time"},
      {"position: [0 m, 0 m, 1 km], motion: {model: ballistic, launch: 0 s, mass: 1e-5 kg, area: 100 m2, drag: 1, velocity: [900 m/s, 0 m/s, 0 m/s], step: 0.1 "
       "s}",
       "0.1 s", "step"},
  };
  for (const Wrong& w : all) {
    const std::string line = ball("x", w.keys);
    const auto column = line.find(w.word, line.find(w.keys) == std::string::npos || w.word.find("{name") == 0 ? 0 : line.find(w.keys)) + 1;
    ASSERT_NE(column, 0u) << w.keys << w.word;
    try {
      flown(line);
      ADD_FAILURE() << w.keys;
    } catch (const UserError& e) {
      const std::string message = e.what();
      EXPECT_NE(message.find(":3:" + std::to_string(column) + ": "), std::string::npos) << column << ": " << message;
      EXPECT_NE(message.find(w.says), std::string::npos) << message;
      EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
    }
  }
}

TEST(MovingScenarios, FlightsThatWaitForEachOtherAreNamed) {
  const std::string lost = "position: [0 m, 0 m, 1 km], motion: {model: missile, launch: 0 s, mass: 1 kg, target: ";
  try {
    flown(ball("a", lost + "b}") + ball("b", lost + "c}") + ball("c", lost + "a}"));
    ADD_FAILURE() << "taken";
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("'a' waits for 'b' waits for 'c' waits for 'a'"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("test.yaml:"), std::string::npos) << e.what();
  }
}

TEST(MovingScenarios, ReadmesExamplesAreOnes) {
  std::ifstream in(std::string(PITVIPER_SOURCE_DIR) + "/scenarios/README.md");
  std::stringstream all;
  all << in.rdbuf();
  const std::string text = all.str();
  const auto example = [&](const std::string& mark) {
    const size_t from = text.find("```yaml " + mark + "\n");
    EXPECT_NE(from, std::string::npos) << mark;
    const size_t begin = text.find('\n', from) + 1;
    return scene(text.substr(begin, text.find("```", begin) - begin));
  };
  const Simulation over = example("over time");
  EXPECT_NEAR(advance(over, 0.75).temperatures_K[0][0], 550.0, 1e-9);
  EXPECT_FALSE(advance(over, 0.3).isThere(1));
  EXPECT_EQ(advance(over, 0.41).lightLevels[0], 1.0);
  EXPECT_EQ(advance(over, 0.43).lightLevels[0], 0.0);
  const Simulation motion = example("motion");
  const FlightRecord& missile = *motion.entities[2].flight;
  EXPECT_EQ(missile.target, "jet");
  ASSERT_TRUE(missile.closest);
  EXPECT_GT(advance(motion, 1.0).temperatures_K[2][0], 300.0);
}

// Random poses, in three rows a frame: at each frame's time the body is there, turned so, and flies along its nose.
TEST(MovingScenarios, PosesOfYourOwnDice) {
  std::string yaml =
      "time: {rate: 1 Hz, frames: 40}\n"
      "accuracy: 1 %\n"
      "atmosphere: clear_us76\n"
      "entities:\n"
      "  - {name: jet, shape: {model: jet}, material: grey_aircraft_paint, temperature: {recovery: turbulent}, motion: {model: csv, file: poses.csv}}\n"
      "plumes:\n"
      "  - {name: exhaust, on: jet, position: [-7.3 m, 0 m, 0 m], engine: turbofan_military}\n"
      "cameras:\n"
      "  - name: eye\n"
      "    film: {width: 160, height: 120, pitch: 20 um}\n"
      "    field_of_view: 5 deg\n"
      "    aperture: 30 mm\n"
      "    position: [0 m, 0 m, 100 m]\n"
      "    heading: 90 deg\n"
      "    truth: [range, entity, targets]\n"
      "    channels: [{name: mw, response: {band: [3.7 um, 4.8 um]}}]\n";
  const TemporaryFolder folder;
  struct Row {
    glm::dvec3 place;
    double heading_deg, pitch_deg, roll_deg, speed_m_s;
  };
  std::vector<Row> rows;
  std::string csv = "time_s,x_m,y_m,z_m,heading_deg,pitch_deg,roll_deg\n";
  const auto ahead = [](const Row& r) { return orientationFrom({r.heading_deg * kPi / 180.0, r.pitch_deg * kPi / 180.0, 0.0}) * glm::dvec3(1.0, 0.0, 0.0); };
  for (int k = 0; k < 40; ++k) {  // leaps of kilometres and any attitudes
    const double a = std::fmod(0.618 * k, 1.0), b = std::fmod(0.755 * k, 1.0), c = std::fmod(0.57 * k, 1.0);
    rows.push_back({{500.0 * std::pow(20.0, a), 200.0 * b - 100.0, 100.0 + 80.0 * c}, 360.0 * b, 60.0 * c - 30.0, 120.0 * a - 60.0, 150.0 + 150.0 * c});
    for (double dt : {-0.01, 0.0, 0.01}) {
      const Row& r = rows.back();
      const glm::dvec3 at = r.place + r.speed_m_s * dt * ahead(r);
      char line[200];
      std::snprintf(line, sizeof line, "%.2f,%.6f,%.6f,%.6f,%.4f,%.4f,%.4f\n", k + dt, at.x, at.y, at.z, r.heading_deg, r.pitch_deg, r.roll_deg);
      csv += line;
    }
  }
  yaml.replace(yaml.find("poses.csv"), 9, folder.put("poses.csv", csv));
  const Simulation sim = scene(yaml);
  double place = 0.0, turn = 0.0, speed = 0.0;
  for (int k = 0; k < 40; ++k) {
    const Row& r = rows[static_cast<size_t>(k)];
    const Pose pose = poseOf(sim, 0, sim.time.at(k));
    place = std::max(place, glm::length(pose.position - r.place));
    const glm::dquat right = orientationFrom({r.heading_deg * kPi / 180.0, r.pitch_deg * kPi / 180.0, r.roll_deg * kPi / 180.0});
    turn = std::max(turn, 2.0 * std::acos(std::min(std::abs(glm::dot(pose.orientation, right)), 1.0)));
    speed = std::max(speed, glm::length(velocityOf(sim, 0, sim.time.at(k)) - r.speed_m_s * ahead(r)) / r.speed_m_s);
    EXPECT_NEAR(advance(sim, sim.time.at(k)).temperatures_K[0][0], recoveryTemperatureAt_K(r.place.z, r.speed_m_s, BoundaryLayer::Turbulent), 0.5) << k;
  }
  bound("poses of a file with three rows a frame: place [m]", place, 1e-5, "six digits behind the point");
  bound("the same: attitude [rad]", turn, 1e-5, "four digits of a degree");
  bound("the same: velocity, of the speed", speed, 1e-5, "six digits behind the point over 20 ms: 1e-4 m/s of 150; rows evenly about the frame's");
}

}  // namespace
}  // namespace pitviper::test
