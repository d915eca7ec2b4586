#pragma once
// Which parts of a subpixel bodies cover: of what is behind them, the rest alone shows.
#include <array>
#include <unordered_map>

#include "sim/world/view.hpp"

namespace pitviper {

class CoveredCells {
 public:
  /// Cells of a subpixel, each way.
  static constexpr int kAcross = 8;
  /// Of each cell, rows from below, the share that is covered, or above 1 where samples lie in each other.
  using Cells = std::array<double, kAcross * kAcross>;

  explicit CoveredCells(const View& film) : width_(film.width), height_(film.height) {}
  /// A sample at a place of the film covers a square around it of an area [subpixels], as far as that is on the film.
  void add(const glm::dvec2& at, double area);
  /// Null: nothing covers any of it. (Row by row from below.)
  const Cells* of(std::size_t subpixel) const;

 private:
  int width_, height_;
  std::unordered_map<std::size_t, Cells> cells_;
};

/// A part of a view (corner, size in its pixels), each pixel as cells by cells of them.
View magnified(const View& view, const glm::ivec4& part, int cells);

}  // namespace pitviper
