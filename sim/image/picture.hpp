#pragma once
// An 8-bit colour picture for people to look at; measurements are in ExrImage.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pitviper {

/// sRGB code values.
struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// Row-major, row 0 at the top, three bytes per pixel: `rgb` holds 3 * width * height.
struct Rgb8Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  Rgb8Image() = default;
  Rgb8Image(int w, int h, Rgb8 colour) : width(w), height(h) {
    rgb.resize(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    for (std::size_t i = 0; i < rgb.size(); i += 3) rgb[i] = colour.r, rgb[i + 1] = colour.g, rgb[i + 2] = colour.b;
  }

  bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  /// Index of the red byte; x and y must be inside.
  std::size_t offset(int x, int y) const { return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)); }
  Rgb8 at(int x, int y) const {
    const std::size_t i = offset(x, y);
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
  /// Pixels outside are ignored.
  void set(int x, int y, Rgb8 colour) {
    if (!holds(x, y)) return;
    const std::size_t i = offset(x, y);
    rgb[i] = colour.r;
    rgb[i + 1] = colour.g;
    rgb[i + 2] = colour.b;
  }
  /// Columns x0 .. x1-1 and rows y0 .. y1-1, cut at the edges.
  void fill(int x0, int y0, int x1, int y1, Rgb8 colour) {
    for (int y = y0 < 0 ? 0 : y0; y < y1 && y < height; ++y)
      for (int x = x0 < 0 ? 0 : x0; x < x1 && x < width; ++x) set(x, y, colour);
  }
};

}  // namespace pitviper
