#pragma once
// Figures of a part of a picture, for a viewer's probe. Pixels that are not finite are left out and counted.
#include <cstddef>
#include <vector>

#include "sim/frame/frame.hpp"

namespace pitviper {

/// All in the layer's unit; NaN where no pixel counts.
struct RegionFigures {
  std::size_t count = 0;                       ///< finite pixels
  std::size_t leftOut = 0;                     ///< pixels that are not finite
  double mean = 0.0, standardDeviation = 0.0;  ///< the latter of the sample (n - 1); NaN of one pixel
  double minimum = 0.0, maximum = 0.0;
  double median = 0.0;                 ///< of an even count the mean of the middle two
  std::vector<std::size_t> histogram;  ///< even bins from minimum to maximum, which is in the last; all in the first where these are equal
};

/// Of the pixels of `box` within the picture, and, where there is a mask (width * height), whose value in it is `entity`. `bins` >= 0.
/// Errors: std::invalid_argument for a layer or a mask of another size.
RegionFigures regionOf(const FrameLayer& layer, int width, int height, const PixelBox& box, int bins = 64, const std::vector<float>* entityMask = nullptr,
                       float entity = 0.0f);

struct RegionContrast {
  RegionFigures inside, ring;
  double contrast = 0.0;       ///< mean inside - mean of the ring
  double signalToNoise = 0.0;  ///< contrast / standard deviation of the ring; NaN where that is 0
};

/// `inner` against the pixels around it that are at most `ring_px` columns and rows away. Errors: as regionOf.
RegionContrast contrastOf(const FrameLayer& layer, int width, int height, const PixelBox& inner, int ring_px);

/// A value along a line; places are of pixels' middles: (0, 0) is the middle of the first pixel.
struct ProfilePoint {
  double x = 0.0, y = 0.0;   ///< [pixels]
  double distance_px = 0.0;  ///< from the line's beginning
  double value = 0.0;        ///< NaN beyond the middles of the outermost pixels, and beside pixels that are not finite
};

/// One point a pixel's length from (x0, y0), and the end of the line last. Between pixels' middles values are bilinear.
/// Errors: std::invalid_argument for a layer of another size, ends that are not finite or more than 1e6 pixels apart.
std::vector<ProfilePoint> profileOf(const FrameLayer& layer, int width, int height, double x0, double y0, double x1, double y1);

}  // namespace pitviper
