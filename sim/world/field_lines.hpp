#pragma once
// Where a field may show in a view, and how close together lines through it have to lie: it is drawn without a zoomed view, and may be far finer than a pixel.
#include <span>
#include <vector>

#include "sim/model/field.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

/// On the film [pixels from the lower left].
struct FieldLines {
  glm::dvec2 low{0.0}, high{0.0};  ///< nothing of it shows outside; empty: none of it does
  double apart_px = 1.0;           ///< lines so far apart see all of its structure
  struct Part {
    glm::dvec2 low{0.0}, high{0.0};
    glm::dvec2 apart_px{1.0};  ///< across the film and up: less where it is fine that way
    std::size_t element = 0;   ///< of the field
    double coarser = 1.0;      ///< lines may lie so many times farther apart
  };
  std::vector<Part> parts = {};  ///< of its elements that show, each with its own: nothing shows outside all of them
  bool isEmpty() const { return !(high.x > low.x && high.y > low.y); }
};
FieldLines fieldLines(const View& view, const FieldState& field);

/// A line through a pixel and the share of the pixel that it stands for.
struct FilmLine {
  glm::dvec2 at{0.0};  ///< [pixels from the lower left]
  double share = 1.0;
};
/// How far apart lines through a pixel may lie: so many times what fields ask for; so many at least, each way, in a part of it that is finer than that part.
struct LinesApart {
  double coarser = 1.0;
  int atLeast = 2;
};
/// Through pixel (x, y): over the parts of it in which fields show, as far apart as said, its middle alone where that does. Where that takes more than
/// `most` x `most`, all of them farther apart.
struct PixelLines {
  std::vector<FilmLine> within;
  double outside = 0.0;  ///< share of the pixel where none of them shows
};
PixelLines pixelLines(std::span<const FieldLines* const> fields, int x, int y, int most, const LinesApart& apart = {});

/// Of the reference: three of Gauss and Legendre hold where what a pixel has changes by a factor of a hundred, as soot's light in the violet does at a jet's
/// edge.
constexpr int kReferenceLines = 128;
constexpr LinesApart kReferenceApart{0.5, 3};

}  // namespace pitviper
