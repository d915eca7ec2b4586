// Frames as EXR files, with a picture for programs that know nothing of their layers.
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/frame/file_formats.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/image/picture_scale.hpp"
#include "sim/image/srgb.hpp"

namespace pitviper {
namespace {

const FrameLayer* layerNamed(const Frame& frame, std::string_view name) {
  const auto found = std::find_if(frame.layers.begin(), frame.layers.end(), [&](const FrameLayer& l) { return l.name == name; });
  return found == frame.layers.end() ? nullptr : &*found;
}

/// So many pixels say where a picture's ends are.
constexpr std::size_t kLookedAt = 16384;

PictureScale scaleOf(const std::vector<float>& pixels) {
  const std::size_t step = pixels.size() / kLookedAt + 1;
  std::vector<float> some;
  for (std::size_t i = 0; i < pixels.size(); i += step) some.push_back(pixels[i]);
  return PictureScale::of(std::move(some));
}

/// What eyes would see, as bright as the brightest of it.
std::vector<float> colours(const FrameLayer& x, const FrameLayer& y, const FrameLayer& z) {
  const double white = scaleOf(strongestPrimary(x.pixels, y.pixels, z.pixels)).high();
  std::vector<float> picture;
  picture.reserve(3 * y.pixels.size());
  for (std::size_t p = 0; p < y.pixels.size(); ++p) {
    const glm::dvec3 rgb = linearSrgb(glm::dvec3(x.pixels[p], y.pixels[p], z.pixels[p]) / white);
    for (int k = 0; k < 3; ++k) picture.push_back(static_cast<float>(std::clamp(rgb[k], 0.0, 1.0)));
  }
  return picture;
}

/// Grey whose codes on a screen are even in the values; what is not finite is black.
std::vector<float> greys(const FrameLayer& layer) {
  const std::vector<float>& pixels = layer.pixels;
  static const std::array<float, 1025> linear = [] {
    std::array<float, 1025> table{};
    for (std::size_t k = 0; k < table.size(); ++k) {
      const double code = static_cast<double>(k) / 1024.0;  // IEC 61966-2-1
      table[k] = static_cast<float>(code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4));
    }
    return table;
  }();
  const auto ends = screenEnds(layer);
  const PictureScale scale = ends ? PictureScale::between(ends->first, ends->second) : scaleOf(pixels);
  std::vector<float> picture;
  picture.reserve(3 * pixels.size());
  for (float v : pixels) {
    const double at = std::isfinite(v) ? std::clamp(scale.position(v), 0.0, 1.0) : 0.0;
    picture.insert(picture.end(), 3, linear[static_cast<std::size_t>(std::lround(1024.0 * at))]);
  }
  return picture;
}

}  // namespace

void writeExrFile(const std::filesystem::path& file, const Frame& frame, const FileOptions& options) {
  ExrImage image;
  image.width = frame.width;
  image.height = frame.height;
  for (const auto& l : frame.layers) image.layers.push_back({l.name, l.pixels});
  image.attributes = frame.attributes;
  if (options.picture) {
    const FrameLayer *x = layerNamed(frame, "X.tristimulus"), *y = layerNamed(frame, "Y.tristimulus"), *z = layerNamed(frame, "Z.tristimulus");
    const bool seen = x && y && z;
    image.picture = seen ? colours(*x, *y, *z) : greys(frame.layers.front());
    image.attributes.push_back({kPictureAttribute, (seen ? "sRGB of X, Y, Z" : "grey of " + frame.layers.front().name) + ", for people: no measurements"});
  }
  writeExr(file, image, options.mayReplace, options.compression);
}

}  // namespace pitviper
