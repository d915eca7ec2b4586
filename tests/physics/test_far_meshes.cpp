// A mesh whose file has its vertices thousands of kilometres away, brought home by its position: the same picture as the mesh about its own origin.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "sim/scene/mesh_tools.hpp"
#include "sim/scene/motion.hpp"
#include "sim/scene/primitives.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper {
namespace {

constexpr double kDegree = 3.14159265358979324 / 180.0;

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.15g", v);
  return text;
}

std::string place(const glm::dvec3& p) { return "[" + number(p.x) + " m, " + number(p.y) + " m, " + number(p.z) + " m]"; }

/// A frustum and a box, as parts of one file, all of it moved.
std::string objAt(const glm::dvec3& offset) {
  Mesh mesh;
  appendPart(mesh, makeCone(1.0, 0.6, 5.0, 12), "hull", glm::mat4(1.0f));
  glm::mat4 beside(1.0f);
  beside[3] = glm::vec4(1.0f, 2.0f, 0.5f, 1.0f);
  appendPart(mesh, makeBox(1.0, 0.5, 0.5), "hot", beside);
  std::string text;
  for (const glm::vec3& p : mesh.positions) text += "v " + number(p.x + offset.x) + " " + number(p.y + offset.y) + " " + number(p.z + offset.z) + "\n";
  for (const MeshPart& part : mesh.parts) {
    text += "g " + part.name + "\n";
    for (std::uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangleCount; ++t)
      text +=
          "f " + std::to_string(mesh.triangles[t].x + 1) + " " + std::to_string(mesh.triangles[t].y + 1) + " " + std::to_string(mesh.triangles[t].z + 1) + "\n";
  }
  return text;
}

/// Over a floor that it shades, with a body that it carries and, where `inSmoke`, a second one of it filled with smoke. `farther`: times as far away.
std::string sceneOf(const std::string& file, const glm::dvec3& offset, const std::string& accuracy, const std::string& material, double farther) {
  const glm::dquat turn = orientationFrom({40.0 * kDegree, 10.0 * kDegree, 5.0 * kDegree});
  const std::string eye = place(farther * glm::dvec3(16.0, -22.0, 14.0));
  return "accuracy: " + accuracy + R"(
background: {temperature: 250 K}
sun: {azimuth: 130 deg, elevation: 40 deg, irradiance: 50 W/(m2 um)}
materials:
  white: {components: [{reflection: lambertian, reflectance: 0.6}]}
  smoke: {medium: gas, absorption: 0.4 1/m}
lights:
  - {name: lamp, intensity: 30 W/(sr um), position: [4 m, -3 m, 6 m]}
entities:
  - {name: floor, shape: {model: plate, width: 40 m, height: 40 m}, material: white, temperature: 290 K, pitch: 90 deg}
  - {name: m, shape: {model: mesh, file: )" +
         file + ", unit: 1 m}, material: " + material + ", temperature: 310 K, position: " + place(glm::dvec3(0.0, 0.0, 3.0) - turn * offset) +
         ", heading: 40 deg, pitch: 10 deg, roll: 5 deg" + (material == "white" ? ", parts: {hot: {temperature: 700 K}}" : "") + R"(}
  - {name: carried, attached_to: m, shape: {model: sphere, radius: 0.4 m}, material: white, temperature: 400 K, position: )" +
         place(offset + glm::dvec3(1.0, -2.0, 0.5)) + R"(}
cameras:
  - {name: c, film: {width: 32, height: 24}, field_of_view: 30 deg, aperture: 20 mm, position: )" +
         eye + R"(, look_at: [0 m, 0 m, 2 m], samples: 2, truth: [targets, range, normal], channels: [{name: mw, response: {band: [3.7 um, 4.8 um]}}]}
)";
}

}  // namespace

// Rationale: vertices count from an offset, and everything that uses them must see it once: pictures, shadows, pieces of hot parts, bodies under a pixel,
// media, truth, what the body carries; drawn by the plan, by the reference and sampled. Expected: what the same mesh without an offset gives.
TEST(FarMeshes, AreDrawnAsNearOnes) {
  const test::TemporaryFolder folder;
  const glm::dvec3 offset(4649776.2, -500123.4, 100.7);
  const std::string near = folder.put("near.obj", objAt(glm::dvec3(0.0))), far = folder.put("far.obj", objAt(offset));
  struct Case {
    std::string accuracy, material;
    double farther;
  };
  double worst = 0.0, worstTarget = 0.0;
  for (const Case& c : {Case{"none", "white", 1.0},
                        {"none", "smoke", 1.0},
                        {"1 %", "white", 1.0},
                        {"1 %", "white", 60.0},
                        {"1 %", "smoke", 60.0},
                        {"reference", "white", 1.0}}) {
    const Frame a = test::renderFrame(test::scene(sceneOf(near, glm::dvec3(0.0), c.accuracy, c.material, c.farther)));
    const Frame b = test::renderFrame(test::scene(sceneOf(far, offset, c.accuracy, c.material, c.farther)));
    for (const char* name : {"mw.radiance", "truth.range", "truth.normal_up"}) {
      const FrameLayer &x = test::layer(a, name), &y = test::layer(b, name);
      double largest = 0.0, difference = 0.0;
      for (std::size_t i = 0; i < x.pixels.size(); ++i) {
        largest = std::max(largest, static_cast<double>(std::abs(x.pixels[i])));
        difference = std::max(difference, static_cast<double>(std::abs(x.pixels[i] - y.pixels[i])));
      }
      EXPECT_GT(largest, 0.0);
      worst = std::max(worst, difference / largest);
    }
    ASSERT_EQ(a.targets.size(), b.targets.size());
    for (std::size_t t = 0; t < a.targets.size(); ++t)
      worstTarget = std::max({worstTarget, std::abs(a.targets[t].column - b.targets[t].column), std::abs(a.targets[t].row - b.targets[t].row)});
  }
  test::bound("pictures of a mesh 4700 km from its file's origin against the same near it, worst pixel over the largest", worst, 1e-5,
              "vertices and the body's place in single precision before the camera: some 2^-24 of each");
  test::bound("the same, places of targets [pixels]", worstTarget, 1e-4,
              "doubles at 5e6 m are good to 1e-9 m, single precision of a body of 5 m to 3e-7 m; a pixel is 0.5 m and more");
}

}  // namespace pitviper
