// Mistakes in what lights a scene from all around: each named, with its place and the fix.
#include <gtest/gtest.h>

#include "sim/image/exr.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

std::string refusal(const std::string& ambient) {
  try {
    scene("ambient: {" + ambient +
          "}\ncameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 20 mm, position: [1 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], "
          "channels: [{name: v, response: {band: [0.6 um, 0.62 um]}}]}]\n");
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(AmbientInput, MistakesAreNamed) {
  const TemporaryFolder folder;
  ExrImage image;
  image.width = 8, image.height = 4;
  for (const char* name : {"R", "G", "B", "cold"}) image.layers.push_back({name, std::vector<float>(32, 1.0f)});
  image.layers.push_back({"holes", std::vector<float>(32, -1.0f)});
  const std::string file = (folder.path() / "sky.exr").string();
  writeExr(file, image);
  const std::string gradient = "gradient: [{elevation: 10 deg, temperature: 280 K}, ", map = "map: {file: " + file + ", ";
  for (const auto& [ambient, part] :
       {std::pair<std::string, std::string>{"", "ambient light of nothing"},
        {"temperature: 280 K, from: sky", "'temperature' and from 'from'"},
        {"from: sky", "needs layered air"},
        {gradient + "{elevation: 5 deg, temperature: 280 K}]", "fall"},
        {gradient + "{elevation: 95 deg, temperature: 280 K}]", "elevation"},
        {gradient + "{elevation: 10 deg, temperature: 280 K}, {elevation: 10 deg, temperature: 280 K}]", "three entries"},
        {gradient + "{elevation: 20 deg}]", "neither temperature nor radiance"},
        {gradient + "{elevation: 20 deg, temperature: 280 K, radiance: \"1 W/(m2 sr um)\"}]", "a temperature and a radiance"},
        {"map: {file: nowhere.exr, light: cie_d65}", "cannot read the file"},
        {map + "layout: sphere, light: cie_d65}", "layout"},
        {map + "layout: cube, light: cie_d65}", "six square faces"},
        {map + "scale: 1}", "without a main light"},
        {map + "light: {product: [\"1 W/(m2 sr um)\", cie_d65]}, layers: [{name: cold, wavelength: 1 um}, {name: R, wavelength: 2 um}]}", "a main light"},
        {map + "light: {band: [3 um, 5 um], value: \"1 W/(m2 sr um)\"}}", "light"},
        {map + "layers: [{name: warm, wavelength: 1 um}, {name: R, wavelength: 2 um}]}", "no layer"},
        {map + "layers: [{name: holes, wavelength: 0.5 um}, {name: R, wavelength: 2 um}]}", "holds -1"},
        {map + "layers: [{name: R, wavelength: 2 um}, {name: G, wavelength: 1 um}]}", "do not rise"},
        {map + "layers: [{name: R, wavelength: 2 um}, {name: G, wavelength: 3 um}]}", "has no data for channel"}}) {
    const std::string said = refusal(ambient);
    EXPECT_NE(said.find(part), std::string::npos) << ambient << "\n" << said;
    EXPECT_NE(said.find("test.yaml:"), std::string::npos) << said;
    EXPECT_NE(said.find("expected"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace pitviper::test
