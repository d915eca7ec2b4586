#pragma once
// Grey pictures of values as TIFF files. The only place that knows libtiff.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/image/atomic_file.hpp"

namespace pitviper {

/// Row-major, row 0 at the top.
struct TiffPage {
  std::string name;         ///< its PageName
  std::string description;  ///< its ImageDescription
  bool isWhole = false;     ///< values are whole, 0 to 65535: 16-bit unsigned; otherwise 32-bit float
  const std::vector<float>& pixels;
};

/// A directory for each page, one after another. Written atomically. Errors: OutputError if it cannot be stored; std::invalid_argument for pages that are not
/// width * height, or none.
void writeTiff(const std::filesystem::path& path, int width, int height, const std::vector<TiffPage>& pages, const MayReplace& mayReplace = {});

}  // namespace pitviper
