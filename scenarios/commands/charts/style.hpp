#pragma once
// How charts look. Lengths are in pixels of the finished picture; what is drawn is larger and then averaged, which smooths lines and text.
#include <cstddef>

#include "sim/image/picture.hpp"

class vtkTextProperty;

namespace pitviper::chart_style {

inline constexpr int kOversampling = 2;
inline constexpr int kPanelWidth_px = 560, kPanelHeight_px = 400, kMargin_px = 16;
inline constexpr int kTitle_px = 17, kText_px = 13;

inline constexpr Rgb8 kInk{40, 40, 40}, kAxis{110, 110, 110}, kGrid{228, 228, 228};

/// Okabe and Ito's colours, told apart by the colour-blind too; the yellow, too pale on white, is left out.
inline Rgb8 seriesColour(std::size_t i) {
  constexpr Rgb8 all[] = {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {230, 159, 0}, {0, 0, 0}};
  return all[i % (sizeof all / sizeof all[0])];
}

void setFont(vtkTextProperty& text, int size_px, bool bold, Rgb8 colour);

}  // namespace pitviper::chart_style
