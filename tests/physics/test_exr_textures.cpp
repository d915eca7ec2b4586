// Textures out of EXR files: the same pictures as of the same values in rows.
#include <gtest/gtest.h>

#include "sim/image/exr.hpp"
#include "sim/parameters/error.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

Frame seen(const std::string& temperature) {
  return renderFrame(
      scene("materials: {m: {components: [{reflection: lambertian, reflectance: 0.1}]}}\nentities: [{name: p, shape: {model: plate, width: 2 m, height: 2 m}, "
            "material: m, "
            "temperature: " +
            temperature +
            "}]\ncameras: [{name: c, film: {width: 16, height: 16}, field_of_view: 10 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: p, channels: "
            "[{name: mw, response: {band: [3 um, 5 um]}}]}]\n"));
}

TEST(ExrTextures, TemperaturesFromALayer) {
  const TemporaryFolder folder;
  ExrImage image{3, 2, {{"T", {300, 320, 340, 400, 450, 500}}, {"other", {0, 0, 0, 0, 0, 0}}}, {}};
  writeExr(folder.path() / "map.exr", image);
  const std::string file = "file: " + (folder.path() / "map.exr").string();
  const Frame rows = seen("{rows: [[300 K, 320 K, 340 K], [400 K, 450 K, 500 K]]}"), map = seen("{" + file + ", layer: T}");
  EXPECT_EQ(layer(rows, "mw.radiance").pixels, layer(map, "mw.radiance").pixels);
  const auto refusal = [&](const std::string& temperature) -> std::string {
    try {
      seen(temperature);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{" + file + "}").find("2 layers"), std::string::npos);
  EXPECT_NE(refusal("{" + file + ", layer: TT}").find("did you mean 'T'"), std::string::npos) << refusal("{" + file + ", layer: TT}");
  EXPECT_NE(refusal("{" + file + ", layer: T, minimum: 3 K}").find("its own values"), std::string::npos);
  EXPECT_NE(refusal("{rows: [[300 K]], layer: T}").find("no EXR"), std::string::npos);
  image.layers.front().pixels[4] = -3.0f;
  writeExr(folder.path() / "cold.exr", image);
  EXPECT_NE(refusal("{file: " + (folder.path() / "cold.exr").string() + ", layer: T}").find("-3"), std::string::npos);
}

}  // namespace
}  // namespace pitviper::test
