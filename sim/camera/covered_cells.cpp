#include "sim/camera/covered_cells.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {

/// A square, not a point: samples are farther apart than cells where bodies are large.
void CoveredCells::add(const glm::dvec2& at, double area) {
  const double side = std::sqrt(area), half = 0.5 * side;
  const glm::dvec2 low = glm::max((at - half) * static_cast<double>(kAcross), glm::dvec2(0.0)),
                   high = glm::min((at + half) * static_cast<double>(kAcross), static_cast<double>(kAcross) * glm::dvec2(width_, height_));
  for (int y = static_cast<int>(low.y); y < high.y; ++y)
    for (int x = static_cast<int>(low.x); x < high.x; ++x) {
      const double wide = std::min(high.x, x + 1.0) - std::max(low.x, static_cast<double>(x)),
                   tall = std::min(high.y, y + 1.0) - std::max(low.y, static_cast<double>(y));
      Cells& cells = cells_[static_cast<std::size_t>(y / kAcross) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x / kAcross)];
      cells[static_cast<std::size_t>(y % kAcross * kAcross + x % kAcross)] += wide * tall;
    }
}

const CoveredCells::Cells* CoveredCells::of(std::size_t subpixel) const {
  const auto found = cells_.find(subpixel);
  return found == cells_.end() ? nullptr : &found->second;
}

View magnified(const View& view, const glm::ivec4& part, int cells) {
  View z = view;
  z.subpixels = z.grouped = 1;
  z.kept = glm::ivec4(0);
  z.wanted = nullptr;
  z.width = part.z * cells, z.height = part.w * cells;
  z.tanPerPixelX /= cells, z.tanPerPixelY /= cells;
  z.axisX = (view.axisX - part.x) * cells, z.axisY = (view.axisY - part.y) * cells;
  z.zoomed = true;
  return z;
}

}  // namespace pitviper
