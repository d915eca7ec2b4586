// How far two frames are apart.
#include <algorithm>
#include <cmath>

#include "sim/frame/read_frame.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

const FrameLayer& comparedLayer(const Frame& frame, const std::string& name) {
  const auto found = std::find_if(frame.layers.begin(), frame.layers.end(), [&](const FrameLayer& l) { return l.name == name; });
  if (found != frame.layers.end()) return *found;
  std::string names;
  for (const FrameLayer& l : frame.layers) names += (names.empty() ? "" : ", ") + l.name;
  throw UserError({}, "a frame of camera '" + frame.camera + "' has no layer '" + name + "'", "one of " + names, "choose another layer");
}

}  // namespace

FrameDifference differenceOf(const Frame& a, const Frame& b, const std::string& layer) {
  const std::vector<float>&of = comparedLayer(a, layer).pixels, &with = comparedLayer(b, layer).pixels;
  if (a.width != b.width || a.height != b.height || of.size() != with.size())
    throw UserError({}, print("the frames have %d x %d and %d x %d pixels", a.width, a.height, b.width, b.height), "frames of one size", "choose others");
  std::vector<double> sizes;
  for (const float v : of)
    if (std::isfinite(v)) sizes.push_back(std::abs(static_cast<double>(v)));
  double least = 0.0;
  if (!sizes.empty()) {
    const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(99 * (sizes.size() - 1) / 100);
    std::nth_element(sizes.begin(), at, sizes.end());
    least = 1e-3 * *at;
  }
  FrameDifference d;
  d.pixels.reserve(of.size());
  double sum = 0.0, sumRelative = 0.0;
  for (std::size_t p = 0; p < of.size(); ++p) {
    const double was = of[p], difference = static_cast<double>(with[p]) - was;
    if (!std::isfinite(of[p]) || !std::isfinite(with[p])) {
      d.pixels.push_back(NAN);
      continue;
    }
    d.pixels.push_back(static_cast<float>(difference));
    const double relative = difference == 0.0 ? 0.0 : std::abs(difference) / std::max(std::abs(was), least);
    sum += difference * difference, sumRelative += relative * relative;
    d.largestRelative = std::max(d.largestRelative, relative);
    if (d.compared++ == 0 || std::abs(difference) > d.largest) {
      d.largest = std::abs(difference);
      d.column = static_cast<int>(p % static_cast<std::size_t>(a.width)), d.row = static_cast<int>(p / static_cast<std::size_t>(a.width));
    }
  }
  if (d.compared == 0) d.largest = d.largestRelative = NAN;
  d.rms = std::sqrt(sum / static_cast<double>(d.compared)), d.rmsRelative = std::sqrt(sumRelative / static_cast<double>(d.compared));
  return d;
}

}  // namespace pitviper
