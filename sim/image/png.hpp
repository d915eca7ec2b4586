#pragma once
// PNG files: pictures for people, and grey maps as textures.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/image/atomic_file.hpp"
#include "sim/image/picture.hpp"

namespace pitviper {

/// Row-major, row 0 at the top. A pixel is its code divided by the largest code, 0 to 1; no gamma is applied, so the values are linear
/// in the codes whatever colour space the file claims.
struct GreyImage {
  int width = 0;
  int height = 0;
  int bits = 8;  ///< of the file's codes: 1, 2, 4, 8 or 16
  std::vector<float> pixels;
};

/// 8-bit RGB; the same picture gives the same bytes. Written atomically.
/// Errors: OutputError if it cannot be stored; std::invalid_argument if `rgb` is not 3 * width * height or a side is not in 1..16384.
/// `texts`: keywords (1 to 79 letters) and what they say, kept in the file. `mayReplace`: as of writeFileAtomically.
void writePng(const std::filesystem::path& path, const Rgb8Image& picture, const std::map<std::string, std::string>& texts = {},
              const MayReplace& mayReplace = {});

/// 16-bit grey codes; otherwise as writePng.
void writePngGrey(const std::filesystem::path& path, int width, int height, const std::vector<std::uint16_t>& codes,
                  const std::map<std::string, std::string>& texts = {}, const MayReplace& mayReplace = {});

/// What a keyword says, from before the pixels. Nothing where it isn't there, or the file is no PNG. Never throws but std::bad_alloc.
std::optional<std::string> readPngText(const std::filesystem::path& path, std::string_view keyword);

/// A grey PNG of 1 to 16 bits. Errors: UserError with the file name if it is missing, damaged, truncated or over 16384 on a side; and a colour, palette or
/// alpha PNG, where the value to take would be a guess.
GreyImage readPngGrey(const std::filesystem::path& path);

}  // namespace pitviper
