#pragma once
// Tables of spectral Phong lobes against the formula: error and time, after Table 1 of the tabulation paper.
#include <string>

namespace pitviper {

/// A sphere lit by one lamp, drawn on the CPU in double by the formula at 81 wavelengths and by three kinds of tables of 200 entries, far and near, for
/// three sets of curves: root mean square error in 8-bit units of linear sRGB and time of a picture, as Markdown.
std::string phongBench();

}  // namespace pitviper
