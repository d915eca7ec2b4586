#pragma once
// Pictures of values as FITS files (IAU FITS Standard 4.0). The only place that knows cfitsio.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/image/atomic_file.hpp"
#include "sim/image/exr.hpp"
#include "sim/image/picture_file.hpp"

namespace pitviper {

/// Row-major, row 0 at the top; the file has it from the bottom up, as viewers of FITS draw it.
struct FitsImage {
  std::string name;      ///< EXTNAME
  std::string unit;      ///< BUNIT
  bool isWhole = false;  ///< values are whole, 0 to 65535: 16-bit unsigned; otherwise 32-bit float
  const std::vector<float>& pixels;
  std::vector<Attribute> keywords = {};  ///< of it alone
};

/// The first image is the primary one, which has the keywords too; others follow as extensions. Keywords longer than 8 letters become HIERARCH cards, long
/// texts go on in CONTINUE cards, lists are numbered `NAME.1`, `NAME.2`, ..., curves become binary tables behind the images. Written atomically. Errors:
/// OutputError if it cannot be stored; std::invalid_argument for images that are not width * height, or none.
void writeFits(const std::filesystem::path& path, int width, int height, const std::vector<FitsImage>& images, const std::vector<Attribute>& keywords,
               const MayReplace& mayReplace = {});

/// The text of a keyword of at most 8 letters in the primary header. Nothing where it isn't there. Never throws but std::bad_alloc.
std::optional<std::string> readFitsText(const std::filesystem::path& path, std::string_view keyword);

/// Images of the primary part and of IMAGE extensions, of every BITPIX, scaled by BSCALE and BZERO; BLANK and NaN become NaN. Planes of a cube are images named
/// `NAME.001`, .... Tables are left out. Keywords of the primary header become attributes: `NAME.1`, `NAME.2`, ... a list again; HIERARCH
/// names come in small letters, as the file does not keep them.
/// Read without cfitsio, whose readers do not withstand damaged files.
/// Errors: UserError with the file name for other files, those that are damaged, truncated or without an image, images of different sizes, over 32768 on a
/// side, more than 1024, of more than three axes, compressed in tables, or random groups.
PictureFile readFits(const std::filesystem::path& path);

}  // namespace pitviper
