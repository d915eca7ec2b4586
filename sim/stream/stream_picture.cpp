#include "sim/stream/stream_picture.hpp"

#include <algorithm>
#include <cmath>

#include "sim/frame/frame_number.hpp"
#include "sim/frame/mark_header.hpp"
#include "sim/image/grey_codes.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

bool isCounts(const Camera& camera, const ChannelOutput& output) {
  return detectorOf(camera, output.channel) && (output.isCount() || output.asDisplay);
}

StreamCoder::StreamCoder(const Camera& camera, const std::string& layer, const StreamRange& range, const Location& where)
    : width_(camera.window ? camera.window->z : camera.pinhole.width), height_(camera.window ? camera.window->w : camera.pinhole.height), range_(range) {
  const ChannelOutput* chosen = nullptr;
  std::vector<std::string> names;
  for (const ChannelOutput& o : camera.outputs) {
    names.push_back(o.layer());
    if (layer.empty() ? !chosen && isCounts(camera, o) : o.layer() == layer) chosen = &o;
  }
  if (!chosen && layer.empty() && !camera.outputs.empty()) chosen = &camera.outputs.front();
  if (!chosen) throw unknownWord(where, "camera '" + camera.name + "' has no layer", layer, names);
  layer_ = chosen->layer();
  counts_ = isCounts(camera, *chosen);
  display_ = chosen->asDisplay;
  if (counts_) bits_ = chosen->asDisplay ? 8 : detectorOf(camera, chosen->channel)->bits;
}

void StreamCoder::code(const Frame& frame, StreamPicture& picture) {
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  picture.codes.resize(pixels);
  const auto layer = std::find_if(frame.layers.begin(), frame.layers.end(), [&](const FrameLayer& l) { return l.name == layer_; });
  if (layer == frame.layers.end() || layer->pixels.size() != pixels) {
    std::fill(picture.codes.begin(), picture.codes.end(), std::uint16_t{0});
    return;
  }
  const auto most = static_cast<std::uint16_t>((1 << bits_) - 1);
  if (counts_) {
    picture.gain = numberOf(frame, "calibration." + layer_ + ".radiance_per_count", 0.0);
    picture.offset = numberOf(frame, "calibration." + layer_ + ".radiance_at_0", 0.0);
    picture.outside = toGreyCodes(layer->pixels, 0.0, 1.0, most, picture.codes);
    // A well may be full below the highest code.
    const auto tallies = markTallies(frame);
    if (const auto own = tallies.find(layer_.substr(0, layer_.rfind('.'))); own != tallies.end())
      picture.outside = std::max(picture.outside, static_cast<std::size_t>(own->second.full));
    if (display_) picture.outside = 0;  // black and white are where automatic gain puts some
    return;
  }
  if (!range_) {
    double low = 0.0, high = 0.0;
    for (float v : layer->pixels)
      if (std::isfinite(v)) low = std::min(low, static_cast<double>(v)), high = std::max(high, static_cast<double>(v));
    range_ = {low, high > low ? low + 2.0 * (high - low) : low + 1.0};
  }
  picture.offset = range_->first;
  picture.gain = (range_->second - range_->first) / most;
  picture.outside = toGreyCodes(layer->pixels, picture.offset, picture.gain, most, picture.codes);
}

}  // namespace pitviper
