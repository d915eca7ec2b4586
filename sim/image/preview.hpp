#pragma once
// A float image as a picture with title, colour bar and unit.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/image/picture.hpp"
#include "sim/image/picture_scale.hpp"

namespace pitviper {

struct PreviewOptions {
  std::string title;                               ///< UTF-8, one line; shortened if it does not fit
  std::string unit;                                ///< UTF-8, above the colour bar
  std::string colourMap = "thermal";               ///< a name of colour_map.hpp
  std::optional<PictureScale> scale = {};          ///< such as that of a whole run
  std::optional<std::pair<double, double>> range = {};  ///< values of the bar's ends, where there is no scale; none: PictureScale::of()
  std::vector<Rgb8> colours = {};                  ///< of the pixels, instead of the colour map's; empty: none
};

/// `pixels` is row-major, row 0 at the top. Each becomes a square of whole size so that the longer side has at least 512 picture pixels.
/// NaN and infinity are magenta. Values beyond the range take the colour of its end; then the bar ends in an arrow with the
/// true extreme beside it. Of one size and title layout the picture has one size, whose sides are even (as video wants them).
/// Errors: std::invalid_argument for wrong sizes (a side is 1..8192), an unknown colour map, or a range that is not finite or falls.
Rgb8Image makePreview(int width, int height, const std::vector<float>& pixels, const PreviewOptions& options);

/// The pixels alone, one to one, the sides filled up to even numbers with black. Errors: as makePreview.
Rgb8Image makePlainPreview(int width, int height, const std::vector<float>& pixels, const PreviewOptions& options);

/// Pictures in one row from left to right, tops aligned, the previews' background between; empty for none.
Rgb8Image placeSideBySide(const std::vector<Rgb8Image>& pictures);

}  // namespace pitviper
