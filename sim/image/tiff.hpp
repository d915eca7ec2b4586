#pragma once
// Grey pictures of values as TIFF files. The only place that knows libtiff.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/image/atomic_file.hpp"
#include "sim/image/picture_file.hpp"

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

/// Pages of one value a pixel: whole numbers of 8 to 64 bits, floats of 32 or 64; strips or tiles; uncompressed, LZW, deflate or PackBits. Reduced copies of a
/// page are left out. Name and unit are those of PageName and of an ImageDescription "name [unit]".
/// Errors: UserError with the file name for other files, those that are damaged or truncated, pages of different sizes, over 32768 on a side or over 1024.
PictureFile readTiff(const std::filesystem::path& path);

}  // namespace pitviper
