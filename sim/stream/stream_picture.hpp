#pragma once
// One layer of a camera as 16-bit grey: what devices, pipelines and projectors take.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/frame/frame.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// value = offset + gain x code, in `unit`; of counts that is radiance on the axis, as far as the frame says so, else the layer's own.
struct StreamPicture {
  std::vector<std::uint16_t> codes;  ///< row by row from the top
  double gain = 1.0, offset = 0.0;
  std::size_t outside = 0;  ///< pixels at an end of the scale or beyond
};

/// A layer's value range: of one that is no count.
using StreamRange = std::optional<std::pair<double, double>>;

class StreamCoder {
 public:
  /// `layer`: of the camera's channels; empty: its first counts, or else its first. Counts go out as they are; others over `range`, by which the whole stream
  /// is told: unless given from the smallest of the first frame, or 0, to twice its largest. Errors: UserError at `where` for a layer that is not there.
  StreamCoder(const Camera& camera, const std::string& layer, const StreamRange& range, const Location& where);
  int width() const { return width_; }
  int height() const { return height_; }
  int bits() const { return bits_; }  ///< that hold something
  const std::string& layer() const { return layer_; }
  /// Dark where the frame has no such layer.
  void code(const Frame& frame, StreamPicture& picture);

 private:
  int width_ = 0, height_ = 0, bits_ = 16;
  bool counts_ = false, display_ = false;
  std::string layer_;
  StreamRange range_;
};

/// Whether an output is whole numbers that a detector counts.
bool isCounts(const Camera& camera, const ChannelOutput& output);

}  // namespace pitviper
