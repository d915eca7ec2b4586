// Shapes as they come out in pictures: which way a mesh from a file points, where level ground ends, what a pixel's field is.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// A bar along the z axis of its file with a nose at -z and a fin towards +y, as Blender writes OBJ: three boxes.
std::string barAlongMinusZ() {
  std::string text;
  int corners = 0;
  auto box = [&](const char* name, double x0, double x1, double y0, double y1, double z0, double z1) {
    text += std::string("g ") + name + "\n";
    for (int k = 0; k < 8; ++k) {
      char line[80];
      std::snprintf(line, sizeof line, "v %g %g %g\n", k & 1 ? x1 : x0, k & 2 ? y1 : y0, k & 4 ? z1 : z0);
      text += line;
    }
    const int faces[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    for (const auto& f : faces) {
      text += "f";
      for (int c : f) text += " " + std::to_string(corners + c);
      text += "\n";
    }
    corners += 8;
  };
  box("nose", -0.5, 0.5, -0.5, 0.5, -4, -2);
  box("tail", -0.5, 0.5, -0.5, 0.5, -2, 4);
  box("fin", -0.1, 0.1, 0.5, 2.5, 2, 4);
  return text;
}

// Rationale: Blender's OBJ (forward -z, up +y) stood on its tail. Expected: with 'forward' and 'up' the nose of a body that heads east is in the east,
// its fin above its tail; without them it stands as its file has it.
TEST(ShapesInPictures, ANosePointsForward) {
  const auto file = std::filesystem::temp_directory_path() / ("pitviper_nose_" + std::to_string(getpid()) + ".obj");
  std::ofstream(file) << barAlongMinusZ();
  auto picture = [&](const std::string& axes) {
    return renderFrame(
        scene("background: {temperature: 0 K}\nmaterials: {m: {}}\n"
              "entities: [{name: bar, shape: {model: mesh, file: " +
              file.string() + ", unit: 1 m" + axes +
              "}, material: m, temperature: 300 K, heading: 90 deg, "
              "position: [0 m, 100 m, 0 m], parts: {nose: {temperature: 400 K}, fin: {temperature: 350 K}}}]\n"
              "cameras: [{name: c, film: {width: 11, height: 11, pitch: 50 um}, focal_length: 5 mm, aperture: 5 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, "
              "pitch: 0 deg, small_bodies: 0, "
              "channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n"));
  };
  // A pixel is 1 m at 100 m; the picture's middle is column 5, row 5; east is to the right.
  const Frame turned = picture(", forward: -z, up: +y");
  const FrameLayer& l = layer(turned, "lw.radiance");
  EXPECT_NEAR(at(l, turned, 8, 5), blackBodyBand(8, 12, 400), 1e-4);
  EXPECT_NEAR(at(l, turned, 3, 5), blackBodyBand(8, 12, 300), 1e-4);
  EXPECT_NEAR(at(l, turned, 2, 4), blackBodyBand(8, 12, 350), 1e-4);
  EXPECT_EQ(at(l, turned, 8, 4), 0.0);
  EXPECT_EQ(at(l, turned, 5, 8), 0.0);
  const Frame standing = picture("");
  const FrameLayer& s = layer(standing, "lw.radiance");
  EXPECT_NEAR(at(s, standing, 5, 8), blackBodyBand(8, 12, 400), 1e-4);  // nose down
  EXPECT_NEAR(at(s, standing, 5, 3), blackBodyBand(8, 12, 300), 1e-4);  // on its tail no more than asked for
  std::filesystem::remove(file);
}

// The dip of the horizon from a height h above a sphere: cos(dip) = R / (R + h).
TEST(ShapesInPictures, LevelGroundEndsAtTheHorizon) {
  for (const double h : {20.0, 1000.0, 10000.0}) {
    const double R = LocalFrame().earthRadius_m(), dip = std::acos(R / (R + h)), pixel = dip / 100.0;
    char text[1200];
    std::snprintf(text, sizeof text,
                  "background: {temperature: 0 K}\nmaterials: {m: {}}\n"
                  "entities: [{name: earth, shape: {model: ground}, material: m, temperature: 300 K}]\n"
                  "cameras: [{name: c, film: {width: 3, height: 401, pitch: 50 um}, focal_length: %.9g m, aperture: 5 mm, position: [0 m, 0 m, %.9g m], "
                  "heading: 30 deg, pitch: 0 deg, channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n",
                  50e-6 / std::tan(pixel), h);
    const Frame f = renderFrame(scene(text));
    const FrameLayer& l = layer(f, "lw.radiance");
    int first = 0;
    while (first < 401 && at(l, f, 1, first) == 0.0) ++first;
    // Rows are counted from the top, the axis is in the middle of row 200: the first row below the horizon tells its tangent to a pixel.
    const double found = std::tan(dip) / std::tan(pixel) + 200.5;
    EXPECT_NEAR(first, found, 1.0) << h;
    for (int row = first; row < 401; ++row) EXPECT_NEAR(at(l, f, 1, row), blackBodyBand(8, 12, 300), 1e-4) << h << " " << row;
  }
}

// What a pixel's field is; over a film it adds up to that of a rectangle seen from above its middle, 4 asin(sin(h/2) sin(v/2)).
TEST(ShapesInPictures, SolidAnglesOfPixelsAddUp) {
  const Frame f = renderFrame(
      scene("materials: {m: {}}\nentities: [{name: b, shape: {model: sphere, radius: 1 m}, material: m, temperature: 300 K, position: [0 m, 9 m, 0 m]}]\n"
            "cameras: [{name: c, film: {width: 64, height: 40}, field_of_view: 100 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], look_at: b, truth: "
            "[pixel_solid_angle], channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n"));
  ASSERT_EQ(f.layers.size(), 2u);  // nothing else is drawn for it
  const FrameLayer& l = layer(f, "truth.pixel_solid_angle");
  EXPECT_EQ(l.unit, "sr");
  const double x = std::tan(50.0 * M_PI / 180.0), y = x * 40.0 / 64.0;
  // 1e-6: single precision of the layer.
  EXPECT_NEAR(sum(l) / (4.0 * std::asin(x * y / std::sqrt((1 + x * x) * (1 + y * y)))), 1.0, 1e-6);
  EXPECT_GT(at(l, f, 32, 20), at(l, f, 0, 0));
}

}  // namespace
}  // namespace pitviper::test
