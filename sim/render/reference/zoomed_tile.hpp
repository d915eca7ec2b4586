#pragma once
// Pixels of a zoomed view, which has thousands on one small body, worked out where they are needed.
#include <functional>
#include <optional>
#include <vector>

namespace pitviper {

/// A square of pixels. Where the corners of a part of it see the same things and its middle is what lies between them, the rest is linear between; else
/// the part is cut in four, down to single pixels: outlines, edges and shadows are followed.
class ZoomedTile {
 public:
  struct Seen {
    std::vector<double> slots;
    std::size_t things = 0;  ///< what is seen; 0: nothing that counts
  };
  /// `see`: works a pixel out.
  explicit ZoomedTile(std::function<Seen(int x, int y)> see) : see_(std::move(see)) {}
  /// Pixels from (x, y) on, `width` x `height` of them; `put` takes each of those that see something.
  void fill(int x, int y, int width, int height, const std::function<void(int x, int y, const std::vector<double>& slots)>& put);
  static constexpr int kSize = 32;

 private:
  const Seen& at(int x, int y);
  void part(int x0, int y0, int x1, int y1);
  bool isLinear(int x0, int y0, int x1, int y1);

  std::function<Seen(int, int)> see_;
  int x_ = 0, y_ = 0, width_ = 0;
  std::vector<std::optional<Seen>> seen_;
};

}  // namespace pitviper
