// Commands of a scenario: what they set is drawn as if the scenario had it from the beginning, in every mode.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

struct Kind {
  const char* name;
  std::string scene;  ///< with TEMPERATURE
};

std::string with(std::string text, const std::string& word, const std::string& value) {
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + value.size())) text.replace(at, word.size(), value);
  return text;
}

const std::string kEye =
    "time: {rate: 10 Hz, frames: 3}\n"
    "cameras: [{name: c, film: {width: 24, height: 24}, field_of_view: 6 deg, aperture: 20 mm, position: [30 m, 3 m, 2 m], look_at: [0 m, 0 m, 0 m], "
    "channels: [{name: mw, response: {band: [3 um, 5 um]}}, {name: lw, response: {band: [8 um, 12 um]}}]}]\n"
    "sun: {azimuth: 60 deg, elevation: 30 deg, temperature: 5772 K}\n";

std::vector<Kind> kinds() {
  const std::string grey = "g: {components: [{reflection: lambertian, reflectance: 0.3}]}",
                    wall = "{name: wall, shape: {model: plate, width: 4 m, height: 4 m}, material: g, temperature: 290 K, position: [-3 m, 0 m, 0 m]}";
  return {
      {"a simple surface",
       "materials: {" + grey + "}\nentities: [" + wall + ", {name: b, shape: {model: sphere, radius: 1 m}, material: g, temperature: TEMPERATURE}]\n"},
      {"a lobe", "materials: {" + grey + ", p: {components: [{reflection: phong, reflectance: 0.2, exponent: 12}]}}\nentities: [" + wall +
                     ", {name: b, shape: {model: sphere, radius: 1 m}, material: p, temperature: TEMPERATURE}]\n"},
      {"a pane", "materials: {" + grey + ", w: {components: [{reflection: lambertian, reflectance: 0.1}], transmission: {transmittance: 0.5}}}\nentities: [" +
                     wall + ", {name: b, shape: {model: plate, width: 1 m, height: 1 m}, material: w, temperature: TEMPERATURE}]\n"},
      {"a medium", "materials: {" + grey + ", m: {absorption: 0.4 /m}}\nentities: [" + wall +
                       ", {name: b, shape: {model: sphere, radius: 1 m}, material: m, temperature: TEMPERATURE}]\n"},
      {"a small body",
       "materials: {" + grey + "}\nentities: [" + wall + ", {name: b, shape: {model: sphere, radius: 5 cm}, material: g, temperature: TEMPERATURE}]\n"},
  };
}

// A body heated from frame 1 on is, in frame 1, the body that a scenario has hot; in frame 0 the cold one.
TEST(Commands, HeatAsIfItHadBeenHot) {
  for (const Kind& kind : kinds())
    for (const char* accuracy : {"", "accuracy: reference\n"}) {
      const Simulation heated = scene(kEye + accuracy + with(kind.scene, "TEMPERATURE", "300 K") +
                                      "commands: [{command: temperature, at: 0.1 s, entity: b, value: 700 K}]\n"),
                       cold = scene(kEye + accuracy + with(kind.scene, "TEMPERATURE", "300 K")),
                       hot = scene(kEye + accuracy + with(kind.scene, "TEMPERATURE", "700 K"));
      EXPECT_EQ(layer(renderFrame(heated, 0), "mw.radiance").pixels, layer(renderFrame(cold, 0), "mw.radiance").pixels) << kind.name << accuracy;
      const Frame a = renderFrame(heated, 1), b = renderFrame(hot, 1);
      EXPECT_EQ(layer(a, "mw.radiance").pixels, layer(b, "mw.radiance").pixels) << kind.name << accuracy;
      EXPECT_EQ(layer(a, "lw.radiance").pixels, layer(b, "lw.radiance").pixels) << kind.name << accuracy;
      EXPECT_GT(sum(layer(b, "mw.radiance")), 1.01 * sum(layer(renderFrame(cold, 1), "mw.radiance"))) << kind.name;
    }
}

// One renderer, hot and cold again: tables follow, nothing of the frame before stays.
TEST(Commands, CoolAgain) {
  needContext();
  for (const Kind& kind : kinds()) {
    const Simulation sim = scene(kEye + with(kind.scene, "TEMPERATURE", "300 K") + "commands: [{command: temperature, at: 0.1 s, entity: b, value: 700 K}]\n");
    CameraRenderer renderer(sim, sim.cameras[0], cameraPlan(sim, sim.cameras[0]), shaderLibrary(), std::make_shared<const GpuScene>(sim));
    const auto first = renderer.render(advance(sim, 0.0)).slots, hot = renderer.render(advance(sim, 0.1)).slots,
               again = renderer.render(advance(sim, 0.0)).slots;
    EXPECT_NE(first, hot) << kind.name;
    EXPECT_EQ(first, again) << kind.name;
  }
}

// A plan holds for what commands bring: a body that is hot in one frame of thirty.
TEST(Commands, ArePlannedFor) {
  const std::string text =
      with(with(kEye, "frames: 3", "frames: 30"), "film: {width: 24, height: 24}, field_of_view: 6 deg",
           "film: {width: 3, height: 3}, field_of_view: 0.5 deg, small_bodies: 0") +
      "accuracy: 1 %\natmosphere: clear_us76\n" + with(kinds()[1].scene, "TEMPERATURE", "300 K") +
      "commands: [{command: temperature, at: 1.7 s, entity: b, value: 2200 K}, {command: temperature, at: 1.75 s, entity: b, value: 300 K}]\n";
  const Simulation planned = scene(text), reference = scene(with(text, "accuracy: 1 %", "accuracy: reference"));
  for (int frame : {0, 17, 18}) {
    const Frame a = renderFrame(planned, frame), b = renderFrame(reference, frame);
    for (const char* name : {"mw.radiance", "lw.radiance"})
      figure(std::string(name) + " of a body that is 2200 K in one frame of thirty, frame " + std::to_string(frame), at(layer(a, name), a, 1, 1),
             at(layer(b, name), b, 1, 1), 0.01, "accuracy asked");
  }
}

// Where it is and how it goes on, seen in the truth layer of ranges.
TEST(Commands, MoveABody) {
  const std::string plain = with(kinds()[0].scene, "TEMPERATURE", "300 K");
  const Simulation sim = scene(with(with(kEye, "position: [30 m, 3 m, 2 m]", "truth: [range], position: [30 m, 0 m, 0 m]"), "film: {width: 24, height: 24}",
                                    "film: {width: 25, height: 25}") +
                               plain + "commands: [{command: move, at: 0.1 s, entity: b, position: [2 m, 0 m, 0 m], velocity: [-30 m/s, 0 m/s, 0 m/s]}]\n");
  for (const auto& [frame, range_m] : {std::pair{0, 29.0}, {1, 27.0}, {2, 30.0}}) {
    const Frame f = renderFrame(sim, frame);
    figure("range of a moved sphere, frame " + std::to_string(frame) + " [m]", at(layer(f, "truth.range"), f, 12, 12), range_m, 2e-4,
           "faces of a sphere of 1 m");
  }
  const WorldState within = advance(sim, 0.15);
  EXPECT_NEAR(within.entities[1].position.x, 0.5, 1e-12) << "between two frames too";
}

// A camera turned, zoomed and exposed otherwise is the camera that a scenario has so.
TEST(Commands, PointACamera) {
  const std::string
      plain = with(kinds()[1].scene, "TEMPERATURE", "500 K"),
      camera =
          "time: {rate: 10 Hz, frames: 2}\ncameras: [{name: c, film: {width: 24, height: 24, pitch: 15 um}, field_of_view: FIELD, aperture: 20 mm, "
          "exposure: EXPOSURE, position: [30 m, 3 m, 2 m], heading: HEADING, pitch: -4 deg, channels: [{name: mw, response: {band: [3 um, 5 um]}, "
          "quantum_efficiency: 0.7, output: [radiance, electrons, irradiance]}]}]\n";
  const auto written = [&](const char* field, const char* exposure, const char* heading) {
    return with(with(with(camera, "FIELD", field), "EXPOSURE", exposure), "HEADING", heading) + plain;
  };
  const Frame asked =
      renderFrame(scene(written("6 deg", "2 ms", "269 deg") +
                        "commands: [{command: look, at: 0.1 s, camera: c, heading: 265 deg, pitch: -4 deg, field_of_view: 3 deg, exposure: 5 ms}]\n"),
                  1);
  const Frame so = renderFrame(scene(written("3 deg", "5 ms", "265 deg")), 1);
  for (const FrameLayer& l : so.layers) {
    const FrameLayer& other = layer(asked, l.name);
    double worst = 0.0, most = 0.0;
    for (size_t p = 0; p < l.pixels.size(); ++p) {
      worst = std::max(worst, static_cast<double>(std::abs(l.pixels[p] - other.pixels[p])));
      most = std::max(most, static_cast<double>(l.pixels[p]));
    }
    EXPECT_GT(most, 0.0) << l.name;
    EXPECT_LE(worst, 1e-6 * most) << l.name;
  }
  const auto number = [](const Frame& f, const std::string& name) {
    for (const auto& a : f.attributes)
      if (a.name == name) return std::get<double>(a.value);
    return static_cast<double>(NAN);
  };
  EXPECT_EQ(number(asked, "pitviper.exposure_s"), 0.005);
  EXPECT_NEAR(number(asked, "pitviper.focal_length_m"), number(so, "pitviper.focal_length_m"), 1e-12);
}

TEST(Commands, RefusedWithTheName) {
  const std::string text = kEye + with(kinds()[0].scene, "TEMPERATURE", "300 K");
  std::string more;
  const auto refusal = [&](const std::string& command) -> std::string {
    try {
      scene(text + more + "commands: [" + command + "]\n");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  const auto expect = [&](const std::string& command, const std::string& words) {
    EXPECT_NE(refusal(command).find(words), std::string::npos) << command << " -> " << refusal(command);
  };
  expect("{command: temperature, entity: bb, value: 300 K}", "there is no entity 'bb'");
  expect("{command: temperature, entity: b, part: nose, value: 300 K}", "has no part 'nose'");
  expect("{command: temperature, entity: b}", "missing key 'value'");
  expect("{command: temperature, entity: b, value: -3 K}", "'value'");
  expect("{command: move, entity: b}", "a move to nowhere");
  expect("{command: move, entity: b, heading: 3 deg, velocity: [1 m/s, 0 m/s, 0 m/s]}", "a velocity without a position");
  expect("{command: look, camera: c}", "changes nothing");
  expect("{command: look, camera: d, heading: 3 deg}", "there is no camera 'd'");
  expect("{command: light, light: lamp, level: 2}", "there is no light 'lamp'");
  expect("{command: move, entity: b, roll: 0 deg}", "a roll but no heading");
  expect("{command: look, camera: c, pitch: -3 deg}", "a pitch but no heading");
  expect("{command: look, camera: c, field_of_view: 177 deg}", "wider than a flat film");
  expect("{at: 3 s}", "missing key 'command'");
  expect("{command: explode, entity: b}", "there is no command 'explode'");
  more = "lights: [{name: seat, intensity: 1 W/(sr um), position: [0 m, 0 m, 1 m]}]\norigin: {latitude: 50 deg, longitude: 8 deg, height: 0 m}\n";
  expect("{command: move, entity: seat, geodetic: {latitude: 50 deg, longitude: 8 deg, height: 10 m}}", "there is no entity 'seat'");
}

// A world that takes commands for an hour keeps no more than it did after the first.
TEST(Commands, KeepNoMoreThanTheLast) {
  const Simulation sim = scene(kEye + with(kinds()[0].scene, "TEMPERATURE", "300 K"));
  World world(sim);
  for (int tick = 0; tick < 100000; ++tick)
    world.apply({0.0, "", [tick](Courses& c, double) { c.temperatures_K[{1, 0}] = [tick](double) { return 300.0 + tick % 7; }; }}, tick);
  EXPECT_EQ(world.at(1e5).temperatures_K[1][0], 300.0 + 99999 % 7);
  EXPECT_EQ(world.at(1e5).temperatures_K[0][0], 290.0);
}

/// A lamp of 4.2 to 4.4 um, where the air is opaque within some hundred metres, 5 km off.
const std::string kLampInABand =
    "accuracy: 0.5 %\natmosphere: hazy_us76\nbackground: {temperature: 3 K}\n"
    "lights: [{name: la, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 0], [4.15, 0], [4.2, 30], [4.4, 30], [4.45, 0], [5, 0]]}, position: [0 m, "
    "5000 m, 1000 m]}]\n";
std::string watch(const std::string& field) {
  return "cameras: [{name: watch, film: {width: 16, height: 16}, field_of_view: " + field +
         ", aperture: 50 mm, position: [0 m, 0 m, 1000 m], look_at: [0 m, 5000 m, 1000 m], channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
}

/// The brightest pixel, planned and by the reference.
void expectPlanned(const std::string& yaml, int frame, const std::string& what) {
  const Frame a = renderFrame(scene(yaml), frame), b = renderFrame(scene(with(yaml, "accuracy: 0.5 %", "accuracy: reference")), frame);
  const auto &p = layer(a, "mw.radiance").pixels, &q = layer(b, "mw.radiance").pixels;
  const size_t at = static_cast<size_t>(std::max_element(q.begin(), q.end()) - q.begin());
  figure(what + " [W/(m2 sr)]", static_cast<double>(p[at]), static_cast<double>(q[at]), 0.005, "accuracy asked");
}

// What a command or a course lights up for a moment, and a field of view that a command narrows: plans look there.
TEST(Commands, ArePlannedForInLamps) {
  expectPlanned("time: {rate: 10 Hz, frames: 2}\n" + kLampInABand + watch("60 deg") + "commands: [{command: look, camera: watch, field_of_view: 0.02 deg}]\n",
                1, "a lamp in a camera that a command zooms");
  const std::string time = "time: {rate: 10 Hz, frames: 11}\n";
  expectPlanned(time + kLampInABand + watch("0.02 deg") +
                    "commands: [{command: light, light: la, level: 0}, {command: light, light: la, level: 1, at: 0.25 s}, {command: light, light: la, level: "
                    "0, at: 0.45 s}]\n",
                3, "a lamp that commands light for two frames of eleven");
  expectPlanned(time + with(kLampInABand, "name: la,", "name: la, level: [[0.25 s, 0], [0.3 s, 1], [0.35 s, 0]],") + watch("0.02 deg"), 3,
                "a lamp whose course lights it in one frame of eleven");
}

// Steps of time round: a command at a frame's time holds in it.
TEST(Commands, HoldFromTheFrameOfTheirTimeOn) {
  for (double start : {0.0, 0.7, 3.3})
    for (double rate : {10.0, 24.0, 30.0, 60.0, 120.0, 1000.0 / 3.0}) {
      Simulation sim = scene(kEye + with(kinds()[0].scene, "TEMPERATURE", "300 K"));
      sim.time = {start, 1.0 / rate, 400};
      for (int frame : {1, 2, 23, 31, 46, 399}) {
        sim.commands = {{start + frame / rate, "", [](Courses& c, double) { c.temperatures_K[{1, 0}] = [](double) { return 400.0; }; }}};
        EXPECT_EQ(advance(sim, sim.time.at(frame)).temperatures_K[1][0], 400.0) << start << " " << rate << " " << frame;
        EXPECT_EQ(advance(sim, sim.time.at(frame - 1)).temperatures_K[1][0], 300.0) << start << " " << rate << " " << frame;
      }
    }
}

// Two lamps that have changed names, and what a command says of one of them: two scenes, and two plans.
TEST(Commands, NamesAreOfTheScene) {
  const auto content = [](const char* first, const char* second) {
    return scene(std::string("lights: [{name: ") + first + ", intensity: 1 W/(sr um), position: [0 m, 0 m, 9 m]}, {name: " + second +
                 ", intensity: 2 W/(sr um), position: [0 m, 0 m, 8 m]}]\n" + kEye + with(kinds()[0].scene, "TEMPERATURE", "300 K") +
                 "commands: [{command: light, light: la, level: 0}]\n")
        .content;
  };
  EXPECT_NE(content("la", "lb"), content("lb", "la"));
}

}  // namespace
}  // namespace pitviper::test
