#pragma once
// Zoomed views of which some lines are wanted: drawn in few boxes around these.
#include "sim/render/line_drawer.hpp"

namespace pitviper {

/// Sizes of pictures of fields: few are ever made, and llvmpipe compiles programs again for textures whose sizes are no powers of two (half a minute each).
int powerOfTwo(int lines);

/// Views of more lines a side are drawn as a whole: pictures are kept, by size.
inline constexpr int kLargestInBoxes = 512;

/// Draws what View::wanted says of a view, and not much more where `fields` may show: a sample through one costs as much as a hundred others.
RawImage drawWanted(LineDrawer& drawer, const View& view, const WorldState& state, const std::vector<char>& drawn, bool fields, int largest = kLargestInBoxes);

}  // namespace pitviper
