#pragma once
// Where a field may show in a view, and how close together lines through it have to lie: it is drawn without a zoomed view, and may be far finer than a pixel.
#include <span>

#include "sim/model/field.hpp"
#include "sim/model/view.hpp"

namespace pitviper {

/// On the film [pixels from the lower left].
struct FieldLines {
  glm::dvec2 low{0.0}, high{0.0};  ///< nothing of it shows outside; empty: none of it does
  double apart_px = 1.0;           ///< lines so far apart see all of its structure
  bool isEmpty() const { return !(high.x > low.x && high.y > low.y); }
};
FieldLines fieldLines(const View& view, const FieldState& field);
/// The rectangle around one of its elements, and how many lines see it as it is.
struct ElementLines {
  FieldLines on;
  double across = 0.0;    ///< over a pixel's breadth, lines beside each other where it changes fastest
  double perPixel = 0.0;  ///< over a whole pixel: fewer where it is drawn out
};
ElementLines elementLines(const View& view, const FieldState& field, const FieldElement& element);

/// A line through a pixel and the share of the pixel that it stands for.
struct FilmLine {
  glm::dvec2 at{0.0};  ///< [pixels from the lower left]
  double share = 1.0;
};
/// Through pixel (x, y): over the part of it in which fields show so many across each way as they ask for, `most` at most; its middle alone where one does.
struct PixelLines {
  std::vector<FilmLine> within;
  double outside = 0.0;  ///< share of the pixel where none of them shows
};
PixelLines pixelLines(std::span<const FieldLines> fields, int x, int y, int most);

/// Lines across a pixel, each way, at most: of the reference. A field 16 times finer than that is some percent off in a single pixel, and right in sum.
constexpr int kReferenceLines = 24;

}  // namespace pitviper
