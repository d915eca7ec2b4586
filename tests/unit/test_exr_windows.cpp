// EXR files whose data window is not their display window: each pixel where the file has it, nothing elsewhere.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "sim/image/exr.hpp"
#include "sim/parameters/error.hpp"
#include "tests/support/exr_bytes.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

float valueAt(char channel, int x, int y) { return 1.0f + static_cast<float>(channel) + 0.25f * static_cast<float>(x) + 1000.0f * static_cast<float>(y); }

std::string refusal(const std::filesystem::path& file) {
  try {
    readExr(file);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(ExrWindows, PixelsStandWhereTheFileHasThem) {
  const TemporaryFolder folder;
  std::mt19937 random(39);
  const auto u = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  int cropped = 0, overscan = 0;
  for (int number = 0; number < 60; ++number) {
    const ExrWindow display{u(-9, 9), u(-9, 9), u(10, 20), u(10, 20)}, data{u(-20, 9), u(-20, 9), u(10, 30), u(10, 30)};
    const int tile = number % 3 == 0 ? 0 : number % 3 == 1 ? 4 : 64;
    const ExrImage image = readExr(folder.put("w.exr", exrBytes(data, display, "AB", valueAt, tile)));
    ASSERT_EQ(image.width, display.right - display.left + 1);
    ASSERT_EQ(image.height, display.bottom - display.top + 1);
    bool whole = true;
    for (char c : {'A', 'B'})
      for (int y = display.top; y <= display.bottom; ++y)
        for (int x = display.left; x <= display.right; ++x) {
          const bool inside = x >= data.left && x <= data.right && y >= data.top && y <= data.bottom;
          whole = whole && inside;
          const float got = image.find(std::string(1, c))->pixels[static_cast<std::size_t>((y - display.top) * image.width + x - display.left)];
          ASSERT_EQ(got, inside ? valueAt(c, x, y) : 0.0f) << number << ": " << x << ", " << y;
        }
    ASSERT_EQ(image.held.has_value(), !whole);
    if (image.held) {
      ++cropped;
      EXPECT_EQ(image.held->left, std::max(data.left, display.left) - display.left);
      EXPECT_EQ(image.held->bottom, std::min(data.bottom, display.bottom) + 1 - display.top);
    } else {
      ++overscan;
    }
  }
  EXPECT_GT(cropped, 10);
  EXPECT_GT(overscan, 3);
}

TEST(ExrWindows, HostileWindowsAndTilesAreUserErrors) {
  const TemporaryFolder folder;
  const auto put = [&](const std::string& bytes) { return folder.put("w.exr", bytes); };
  EXPECT_NE(refusal(put(exrBytes({0, 0, 3, 3}, {4, 0, 7, 3}, "A", valueAt))).find("no pixel in common"), std::string::npos);
  EXPECT_NE(refusal(put(exrBytes({0, 0, 3, 3}, {0, 0, 32767, 32767}, "A", valueAt))).find("far too short for 32768 x 32768"), std::string::npos);
  EXPECT_NE(refusal(put(exrBytes({0, 0, 3, 3}, {0, 0, 40000, 3}, "A", valueAt))).find("display window"), std::string::npos);
  EXPECT_NE(refusal(put(exrBytes({0, 0, 3, 3}, {5, 5, 4, 4}, "A", valueAt))).find("display window"), std::string::npos);
  std::string tiled = exrBytes({0, 0, 3, 3}, {0, 0, 3, 3}, "A", valueAt, 2);
  const auto patched = [&](std::int32_t width, std::int32_t height) {
    std::string bytes = tiled;
    const std::size_t at = bytes.find(std::string("tiles\0tiledesc\0", 15)) + 19;
    std::memcpy(bytes.data() + at, &width, 4);
    std::memcpy(bytes.data() + at + 4, &height, 4);
    return put(bytes);
  };
  for (const auto& [width, height, words] :
       {std::tuple<std::int32_t, std::int32_t, const char*>{0, 2, "tiles of 0 x 2"}, {-1, 2, "tiles of"}, {1 << 30, 2, "tiles of"}, {32768, 32768, "256 MB"}})
    EXPECT_NE(refusal(patched(width, height)).find(words), std::string::npos) << words << ": " << refusal(put(tiled));
  std::string flag = tiled;
  flag[5] = 0;  // tiles by its header alone
  EXPECT_NE(refusal(put(flag)), "");
  for (std::size_t end = 0; end < tiled.size(); end += 3) EXPECT_NE(refusal(put(tiled.substr(0, end))), "") << end;
  int refused = 0;
  for (std::size_t at = 8; at < tiled.size(); ++at)
    for (int bit : {0, 4, 7}) {
      std::string bytes = tiled;
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << bit);
      refused += refusal(put(bytes)).empty() ? 0 : 1;  // anything but a UserError ends the test
    }
  EXPECT_GT(refused, 300);
}

std::string sceneRefusal(const std::string& body) {
  try {
    scene(body +
          "cameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 10 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], "
          "channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n");
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(ExrWindows, WhatHasNoValueIsRefusedWhereNothingIsNone) {
  const TemporaryFolder folder;
  const std::string part = folder.put("part.exr", exrBytes({1, 1, 2, 2}, {0, 0, 3, 3}, "T", [](char, int, int) { return 300.0f; })),
                    over = folder.put("over.exr", exrBytes({-2, -2, 5, 5}, {0, 0, 3, 3}, "T", [](char, int, int) { return 300.0f; })),
                    half = folder.put("half.exr", exrBytes({1, 1, 2, 2}, {0, 0, 3, 3}, "T", [](char, int, int) { return 0.5f; }));
  const std::string plate = "entities: [{name: p, shape: {model: plate, width: 2 m, height: 2 m}, material: blackbody, temperature: {file: ";
  const std::string terrain = "entities: [{name: p, shape: {model: terrain, size: 100 m, height_map: {file: ";
  EXPECT_NE(sceneRefusal(plate + part + "}}]\n").find("has only a part of its picture, columns 1 to 2 and rows 1 to 2 of 4 x 4"), std::string::npos)
      << sceneRefusal(plate + part + "}}]\n");
  EXPECT_NE(sceneRefusal(terrain + part + "}}, material: blackbody, temperature: 300 K}]\n").find("a height map everywhere"), std::string::npos)
      << sceneRefusal(terrain + part + "}}, material: blackbody, temperature: 300 K}]\n");
  EXPECT_EQ(sceneRefusal(plate + over + "}}]\n"), "");
  // A share of nothing is nothing.
  EXPECT_EQ(sceneRefusal("materials: {m: {components: [{reflection: lambertian, reflectance: 0.5, modifier: {file: " + half +
                         "}}]}}\n"
                         "entities: [{name: p, shape: {model: plate, width: 2 m, height: 2 m}, material: m, temperature: 300 K}]\n"),
            "");
  // Where it is, a wrong texel is told.
  const std::string hole =
      folder.put("hole.exr", exrBytes({0, 0, 3, 3}, {0, 0, 3, 3}, "T", [](char, int x, int y) { return x == 2 && y == 1 ? -1.0f : 300.0f; }));
  EXPECT_NE(sceneRefusal(plate + hole + "}}]\n").find("holds -1 at column 2, row 1"), std::string::npos) << sceneRefusal(plate + hole + "}}]\n");
}

TEST(ExrWindows, EnvironmentsThatNoFloatHoldsAreRefusedAtTheirPixel) {
  const TemporaryFolder folder;
  const auto with = [&](float bad) {
    return folder.put(
        "env.exr", exrBytes({0, 0, 7, 3}, {0, 0, 7, 3}, "BGLR", [&](char c, int x, int y) { return (c == 'G' || c == 'L') && x == 5 && y == 2 ? bad : 1.0f; }));
  };
  const std::string rgb = ", light: {blackbody: 5000 K}}}\n", layers = ", layers: [{name: L, wavelength: 3 um}, {name: R, wavelength: 5 um}]}}\n";
  for (float bad : {3e38f, 1e31f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), -1.0f})
    for (const std::string& as : {rgb, layers}) {
      const std::string said = sceneRefusal("ambient: {map: {file: " + with(bad) + as);
      EXPECT_NE(said.find("env.exr holds"), std::string::npos) << bad << said;
      EXPECT_NE(said.find("at column 5, row 2"), std::string::npos) << bad << said;
      EXPECT_NE(said.find(as == rgb ? "layer 'G'" : "layer 'L'"), std::string::npos) << bad << said;
      EXPECT_EQ(said.rfind("test.yaml:1:", 0), 0u) << said;
    }
  // Beyond only with its scale or under its light.
  EXPECT_NE(sceneRefusal("ambient: {map: {file: " + with(1e25f) + ", scale: 1e6" + layers).find("'scale'"), std::string::npos);
  EXPECT_NE(sceneRefusal("ambient: {map: {file: " + with(1e26f) + rgb).find("column 5, row 2"), std::string::npos);
  EXPECT_EQ(sceneRefusal("ambient: {map: {file: " + with(1e20f) + layers), "");
}

}  // namespace
}  // namespace pitviper::test
