// Commands of a scenario: what they set is drawn as if the scenario had it from the beginning, in every mode.
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "sim/model/world.hpp"
#include "sim/stream/command_models.hpp"
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
  const std::string grey = "g: {components: [{reflection: lambertian, reflectance: 0.3}]}", wall =
      "{name: wall, shape: {model: plate, width: 4 m, height: 4 m}, material: g, temperature: 290 K, position: [-3 m, 0 m, 0 m]}";
  return {
      {"a simple surface", "materials: {" + grey + "}\nentities: [" + wall +
                               ", {name: b, shape: {model: sphere, radius: 1 m}, material: g, temperature: TEMPERATURE}]\n"},
      {"a lobe", "materials: {" + grey + ", p: {components: [{reflection: phong, reflectance: 0.2, exponent: 12}]}}\nentities: [" + wall +
                     ", {name: b, shape: {model: sphere, radius: 1 m}, material: p, temperature: TEMPERATURE}]\n"},
      {"a pane", "materials: {" + grey + ", w: {components: [{reflection: lambertian, reflectance: 0.1}], transmission: {transmittance: 0.5}}}\nentities: [" + wall +
                     ", {name: b, shape: {model: plate, width: 1 m, height: 1 m}, material: w, temperature: TEMPERATURE}]\n"},
      {"a medium", "materials: {" + grey + ", m: {absorption: 0.4 /m}}\nentities: [" + wall +
                       ", {name: b, shape: {model: sphere, radius: 1 m}, material: m, temperature: TEMPERATURE}]\n"},
      {"a small body", "materials: {" + grey + "}\nentities: [" + wall +
                           ", {name: b, shape: {model: sphere, radius: 5 cm}, material: g, temperature: TEMPERATURE}]\n"},
  };
}

// A body heated from frame 1 on is, in frame 1, the body that a scenario has hot; in frame 0 the cold one.
TEST(Commands, HeatAsIfItHadBeenHot) {
  for (const Kind& kind : kinds())
    for (const char* accuracy : {"", "accuracy: reference\n"}) {
      const Simulation heated = scene(kEye + accuracy + with(kind.scene, "TEMPERATURE", "300 K") + "commands: [{command: temperature, at: 0.1 s, entity: b, value: 700 K}]\n"),
                       cold = scene(kEye + accuracy + with(kind.scene, "TEMPERATURE", "300 K")), hot = scene(kEye + accuracy + with(kind.scene, "TEMPERATURE", "700 K"));
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
    CameraRenderer renderer(sim, sim.cameras[0], shaderLibrary(), std::make_shared<const GpuScene>(sim));
    const auto first = renderer.render(advance(sim, 0.0)).slots, hot = renderer.render(advance(sim, 0.1)).slots, again = renderer.render(advance(sim, 0.0)).slots;
    EXPECT_NE(first, hot) << kind.name;
    EXPECT_EQ(first, again) << kind.name;
  }
}

// A plan holds for what commands bring: a body that is hot in one frame of thirty.
TEST(Commands, ArePlannedFor) {
  const std::string text = with(with(kEye, "frames: 3", "frames: 30"), "film: {width: 24, height: 24}, field_of_view: 6 deg",
                                "film: {width: 3, height: 3}, field_of_view: 0.5 deg, small_bodies: 0") + "accuracy: 1 %\natmosphere: clear_us76\n" + with(kinds()[1].scene, "TEMPERATURE", "300 K") +
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
  const Simulation sim = scene(with(with(kEye, "position: [30 m, 3 m, 2 m]", "truth: [range], position: [30 m, 0 m, 0 m]"), "film: {width: 24, height: 24}", "film: {width: 25, height: 25}") +
                               plain + "commands: [{command: move, at: 0.1 s, entity: b, position: [2 m, 0 m, 0 m], velocity: [-30 m/s, 0 m/s, 0 m/s]}]\n");
  for (const auto& [frame, range_m] : {std::pair{0, 29.0}, {1, 27.0}, {2, 30.0}}) {
    const Frame f = renderFrame(sim, frame);
    figure("range of a moved sphere, frame " + std::to_string(frame) + " [m]", at(layer(f, "truth.range"), f, 12, 12), range_m, 2e-4, "faces of a sphere of 1 m");
  }
  const WorldState within = advance(sim, 0.15);
  EXPECT_NEAR(within.entities[1].position.x, 0.5, 1e-12) << "between two frames too";
}

// A camera turned, zoomed and exposed otherwise is the camera that a scenario has so.
TEST(Commands, PointACamera) {
  const std::string plain = with(kinds()[1].scene, "TEMPERATURE", "500 K"),
                    camera = "time: {rate: 10 Hz, frames: 2}\ncameras: [{name: c, film: {width: 24, height: 24, pitch: 15 um}, field_of_view: FIELD, aperture: 20 mm, "
                             "exposure: EXPOSURE, position: [30 m, 3 m, 2 m], heading: HEADING, pitch: -4 deg, channels: [{name: mw, response: {band: [3 um, 5 um]}, "
                             "quantum_efficiency: 0.7, output: [radiance, electrons, irradiance]}]}]\n";
  const auto written = [&](const char* field, const char* exposure, const char* heading) {
    return with(with(with(camera, "FIELD", field), "EXPOSURE", exposure), "HEADING", heading) + plain;
  };
  const Frame asked = renderFrame(
      scene(written("6 deg", "2 ms", "269 deg") +
            "commands: [{command: look, at: 0.1 s, camera: c, heading: 265 deg, pitch: -4 deg, field_of_view: 3 deg, exposure: 5 ms}]\n"), 1);
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
  const auto refusal = [&](const std::string& command) -> std::string {
    try {
      scene(text + "commands: [" + command + "]\n");
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
  expect("{at: 3 s}", "missing key 'command'");
  expect("{command: explode, entity: b}", "there is no command 'explode'");
}

// A world that takes commands for an hour keeps no more than it did after the first.
TEST(Commands, KeepNoMoreThanTheLast) {
  const Simulation sim = scene(kEye + with(kinds()[0].scene, "TEMPERATURE", "300 K"));
  World world(sim);
  for (int tick = 0; tick < 100000; ++tick)
    world.apply({0.0, "", {}, [tick](Courses& c, double) { c.temperatures_K[{1, 0}] = [tick](double) { return 300.0 + tick % 7; }; }}, tick);
  EXPECT_EQ(world.at(1e5).temperatures_K[1][0], 300.0 + 99999 % 7);
  EXPECT_EQ(world.at(1e5).temperatures_K[0][0], 290.0);
}

}  // namespace
}  // namespace pitviper::test
