#pragma once
// Pixels of a zoomed view, which has thousands on one small body, worked out where they are needed.
#include <functional>
#include <optional>
#include <vector>

namespace pitviper {

/// A square of pixels. Where all of a part of it see the same things and its middle is what lies between its corners, the rest is linear between; else
/// the part is cut in four, down to single pixels: outlines, edges and shadows are followed.
class ZoomedTile {
 public:
  using Things = std::function<std::size_t(int x, int y)>;
  using Slots = std::function<std::vector<double>(int x, int y)>;
  /// What a middle may be off by and still count as between the corners, relative to it: a twenty-fifth of the least error that can be asked for (0.05 %), and
  /// an error of second order is greatest there.
  static constexpr double kLinear = 2e-5;
  /// `things`: the same number for pixels that see the same, 0 where nothing counts; `slots`: works a pixel out; `linear`: as kLinear.
  ZoomedTile(Things things, Slots slots, double linear = kLinear) : thingsAt_(std::move(things)), slotsAt_(std::move(slots)), linear_(linear) {}
  /// Pixels from (x, y) on, `width` x `height` of them; `put` takes each of those that see something.
  void fill(int x, int y, int width, int height, const std::function<void(int x, int y, const std::vector<double>& slots)>& put);
  static constexpr int kSize = 32;

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y - y_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x - x_); }
  const std::vector<double>& at(int x, int y);
  void part(int x0, int y0, int x1, int y1);
  bool seesOne(int x0, int y0, int x1, int y1) const;
  bool isLinear(int x0, int y0, int x1, int y1);

  Things thingsAt_;
  Slots slotsAt_;
  double linear_;
  int x_ = 0, y_ = 0, width_ = 0;
  std::vector<std::size_t> things_;
  std::vector<std::optional<std::vector<double>>> seen_;
};

}  // namespace pitviper
