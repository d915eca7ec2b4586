#pragma once
// What files of pictures of values hold, whatever their format.
#include <string>
#include <vector>

#include "sim/image/exr.hpp"

namespace pitviper {

inline constexpr long long kMostPictureSide = 32768;  ///< as of EXR files
inline constexpr std::size_t kMostPictures = 1024;

/// Row-major, row 0 at the top.
struct ReadPicture {
  std::string name;  ///< empty where the file has none
  std::string unit;  ///< the same
  std::vector<float> pixels;
};

/// All of one size.
struct PictureFile {
  int width = 0, height = 0;
  std::vector<ReadPicture> pictures;
  std::vector<Attribute> attributes;
};

/// "name [unit]" as its two parts; a text without brackets is a name.
inline ReadPicture namedWithUnit(const std::string& text) {
  const std::size_t open = text.rfind(" [");
  if (open == std::string::npos || text.back() != ']') return {text, "", {}};
  return {text.substr(0, open), text.substr(open + 2, text.size() - open - 3), {}};
}

}  // namespace pitviper
