// Three ways to blend over the spectral image (PITVIPER_BLEND): read in order by the driver, as a texture with barriers, from copies. The same
// layers in the same order through the same arithmetic.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>

#include "scenarios/commands/commands.hpp"
#include "sim/gl/blend_path.hpp"
#include "sim/gl/context.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/fog_world.hpp"

namespace pitviper::test {
namespace {

/// Sets a variable of the environment while it lives.
class Setting {
 public:
  Setting(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) before_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Setting() {
    if (before_) setenv(name_, before_->c_str(), 1);
    else unsetenv(name_);
  }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

/// Panes at all angles (some pass through each other), closed transparent bodies, media in true form and as meshes, solids.
std::string crowd(int channels, const std::string& more) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::string y =
      "background: {temperature: 260 K}\natmosphere: {extinction: 0.01 /m, temperature: 285 K}\nambient: {temperature: 270 K}\n"
      "lights: [{name: l, intensity: 300 W/(sr um), visible: false, position: [2 m, 3 m, 4 m]}]\nentities:\n";
  for (int i = 0; i < 24; ++i)
    y += "  - {name: p" + std::to_string(i) + ", shape: {model: plate, width: " + text(2.0 + unit(random)) + " m, height: " + text(2.0 + unit(random)) +
         " m}, heading: " + text(90.0 + 40.0 * unit(random)) + " deg, pitch: " + text(40.0 * unit(random)) + " deg, position: " +
         text(glm::dvec3(8.0 + 1.7 * i, 2.0 * unit(random), 2.0 * unit(random))) + ", temperature: " + text(330.0 + 60.0 * unit(random)) +
         " K, material: {transmission: {transmittance: " + text(0.6 + 0.3 * unit(random)) + "}, components: [{reflection: lambertian, reflectance: 0.08}]}}\n";
  y += "  - {name: bubble, shape: {model: sphere, radius: 1.2 m, segments: 24}, material: {transmission: {transmittance: 0.8, angular: [[0 deg, 1], [90 deg, "
       "0.2]]}}, "
       "temperature: 350 K, position: [12 m, -1 m, 1 m]}\n"
       "  - {name: solid, shape: {model: box, length: 1 m, width: 1.5 m, height: 1.5 m}, material: concrete, temperature: 320 K, position: [20 m, 1 m, 0 m], "
       "heading: 30 deg}\n";
  const Cloud clouds[] = {of(placed(sphere(1.0), {14, 1, -1}), 0.5, 420), of(placed(box(2, 2, 2), {18, -1, 0}, 30, 40), 0.4, 300),
                          of(placed(cone(1, 0.2, 3), {24, 0, 1}, 20, 30), 0.9, 500), of(placed(box(3, 1, 1), {25, 1, -1}, 70, 10), 0.7, 280),
                          of(placed(ellipsoid(3, 2, 1), {30, 0, 0}, 50, 20), 0.3, 460)};
  for (size_t i = 0; i < std::size(clouds); ++i) y += clouds[i].yaml("m" + std::to_string(i));
  std::string list = "[";
  for (int c = 0; c < channels; ++c)
    list +=
        (c ? ", " : "") + std::string("{name: c") + std::to_string(c) + ", response: {band: [" + text(3.0 + 0.5 * c) + " um, " + text(4.0 + 0.6 * c) + " um]}}";
  return y + Eye{{0, 0, 0}, {1, 0, 0}, 30.0, 32}.yaml(list + "]", "    small_bodies: 0\n" + more);
}

/// The picture by one path, or nothing where the driver does not offer it.
std::optional<Frame> by(const std::string& path, const Simulation& sim) {
  const Setting setting("PITVIPER_BLEND", path);
  try {
    return renderFrame(sim);
  } catch (const GlError& e) {
    if (std::string(e.what()).find("none of what this driver offers") == std::string::npos) throw;
    std::printf("  %s\n", e.what());
    return std::nullopt;
  }
}

TEST(BlendPaths, AgreeWithEachOther) {
  needContext();
  for (const auto& [what, yaml] : {std::pair<std::string, std::string>{"1 channel", crowd(1, "")},
                                   {"16 channels, 80 nodes in 3 batches", crowd(16, "    spectral: {samples: 5}\n")},
                                   {"2 x 2 subpixels", crowd(2, "    samples: 2\n    spectral: {samples: 8}\n")}}) {
    const Simulation sim = scene(yaml);
    const auto copied = by("ping_pong", sim);
    ASSERT_TRUE(copied) << "copies need nothing of the driver";
    for (const std::string path : {"fetch", "barrier"}) {
      const auto other = by(path, sim);
      if (!other) continue;
      double worst = 0.0, lowest = INFINITY, highest = 0.0;
      for (size_t l = 0; l < copied->layers.size(); ++l)
        for (size_t p = 0; p < copied->layers[l].pixels.size(); ++p) {
          const double a = static_cast<double>(copied->layers[l].pixels[p]), b = static_cast<double>(other->layers[l].pixels[p]);
          EXPECT_TRUE(std::isfinite(b));
          worst = std::max(worst, std::abs(a - b) / a);
          if (l == 0) lowest = std::min(lowest, a), highest = std::max(highest, a);
        }
      EXPECT_GT(highest, 1.05 * lowest);  // there is something to compare
      bound(path + " against ping_pong, " + what, worst, 1e-6, "the same order and arithmetic; programs compiled apart");
    }
  }
}

// Same scenario, same driver: same bytes, also from a renderer that has drawn other frames before.
TEST(BlendPaths, SameBytesAgain) {
  const Simulation sim = scene(crowd(3, "    spectral: {samples: 6}\n"));
  for (const std::string path : {"fetch", "barrier", "ping_pong"}) {
    const auto one = by(path, sim), two = by(path, sim);
    if (!one) continue;
    for (size_t l = 0; l < one->layers.size(); ++l) EXPECT_EQ(one->layers[l].pixels, two->layers[l].pixels) << path;
    const Setting setting("PITVIPER_BLEND", path);
    auto gpu = std::make_shared<const GpuScene>(sim);
    CameraRenderer renderer(sim, sim.cameras.at(0), cameraPlan(sim, sim.cameras.at(0)), shaderLibrary(), gpu);
    const WorldState state = advance(sim, 0.0);
    const CameraImage first = renderer.render(state), again = renderer.render(state);
    EXPECT_EQ(first.slots, again.slots) << path;
  }
}

TEST(BlendPaths, UnknownNameIsRefused) {
  needContext();
  const Simulation sim = scene(crowd(1, ""));
  const Setting setting("PITVIPER_BLEND", "blend");
  try {
    renderFrame(sim);
    ADD_FAILURE() << "taken";
  } catch (const GlError& e) {
    std::vector<std::string> words{"PITVIPER_BLEND", "'blend'"};
    for (BlendPath path : offeredBlendPaths()) words.push_back(nameOf(path));
    for (const std::string& word : words) EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace pitviper::test
