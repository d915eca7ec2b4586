// The ways to pack an EXR file: the same pixels from each, and each what its name says.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>

#include "sim/image/exr.hpp"

namespace pitviper::test {
namespace {

TEST(ExrCompression, KeepsEveryBitAndTakesTheRoomItIsChosenFor) {
  // A level sky, a gradient, and values that no arithmetic would bring back.
  ExrImage image{96, 64, {}, {{"note", std::string("x")}}};
  FloatLayer layer{"lw.radiance", {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      layer.pixels.push_back(y < 24 ? 17.25f : static_cast<float>(std::exp(0.01 * x) + 1e-3 * std::sin(12.9898 * x + 78.233 * y)));
  layer.pixels[5] = std::numeric_limits<float>::denorm_min();
  layer.pixels[6] = std::numeric_limits<float>::infinity();
  layer.pixels[7] = -0.0f;
  image.layers = {layer};
  const auto folder = std::filesystem::temp_directory_path() / ("pitviper_exr_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::map<ExrCompression, std::uintmax_t> bytes;
  for (ExrCompression c : {ExrCompression::None, ExrCompression::Zip}) {
    const auto file = folder / ("f" + std::to_string(static_cast<int>(c)) + ".exr");
    writeExr(file, image, {}, c);
    const auto back = readExr(file).layers.at(0).pixels;
    ASSERT_EQ(back.size(), layer.pixels.size());
    EXPECT_EQ(std::memcmp(back.data(), layer.pixels.data(), back.size() * sizeof(float)), 0);
    bytes[c] = std::filesystem::file_size(file);
  }
  std::filesystem::remove_all(folder);
  EXPECT_LT(bytes[ExrCompression::Zip], 0.8 * static_cast<double>(bytes[ExrCompression::None]));
}

}  // namespace
}  // namespace pitviper::test
