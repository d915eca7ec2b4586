#include "sim/frame/region.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pitviper {
namespace {

void requireSize(const std::vector<float>& pixels, int width, int height) {
  if (width < 1 || height < 1 || pixels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::invalid_argument("region: a layer or mask is not width * height");
}

PixelBox withinPicture(const PixelBox& box, int width, int height) {
  return {std::max(box.left, 0), std::max(box.top, 0), std::min(box.right, width), std::min(box.bottom, height)};
}

/// Values that are finite become figures; `values` are put in another order.
RegionFigures figuresOf(std::vector<float> values, int bins) {
  RegionFigures f;
  const std::size_t all = values.size();
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  f.count = values.size(), f.leftOut = all - values.size();
  f.histogram.assign(static_cast<std::size_t>(std::max(bins, 0)), 0);
  f.mean = f.standardDeviation = f.minimum = f.maximum = f.median = NAN;
  if (values.empty()) return f;
  const auto count = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const float v : values) sum += static_cast<double>(v);
  f.mean = sum / count;
  for (const float v : values) squares += (static_cast<double>(v) - f.mean) * (static_cast<double>(v) - f.mean);
  if (values.size() > 1) f.standardDeviation = std::sqrt(squares / (count - 1.0));
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  f.minimum = static_cast<double>(*least), f.maximum = static_cast<double>(*most);
  for (const float v : values) {
    if (f.histogram.empty()) break;
    const double at = f.maximum > f.minimum ? (static_cast<double>(v) - f.minimum) / (f.maximum - f.minimum) : 0.0;
    ++f.histogram[std::min(static_cast<std::size_t>(at * static_cast<double>(bins)), f.histogram.size() - 1)];
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  f.median = static_cast<double>(*middle);
  if (values.size() % 2 == 0) f.median = 0.5 * (f.median + static_cast<double>(*std::max_element(values.begin(), middle)));
  return f;
}

}  // namespace

RegionFigures regionOf(const FrameLayer& layer, int width, int height, const PixelBox& box, int bins, const std::vector<float>* entityMask, float entity) {
  requireSize(layer.pixels, width, height);
  if (entityMask) requireSize(*entityMask, width, height);
  const PixelBox held = withinPicture(box, width, height);
  std::vector<float> values;
  for (int y = held.top; y < held.bottom; ++y)
    for (int x = held.left; x < held.right; ++x) {
      const std::size_t p = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (!entityMask || (*entityMask)[p] == entity) values.push_back(layer.pixels[p]);
    }
  return figuresOf(std::move(values), bins);
}

RegionContrast contrastOf(const FrameLayer& layer, int width, int height, const PixelBox& inner, int ring_px) {
  RegionContrast c;
  c.inside = regionOf(layer, width, height, inner);
  const auto moved = [](int from, int by) { return static_cast<int>(std::clamp<long long>(static_cast<long long>(from) + by, -1000000000, 1000000000)); };
  const PixelBox outer =
      withinPicture({moved(inner.left, -ring_px), moved(inner.top, -ring_px), moved(inner.right, ring_px), moved(inner.bottom, ring_px)}, width, height);
  std::vector<float> values;
  for (int y = outer.top; y < outer.bottom; ++y)
    for (int x = outer.left; x < outer.right; ++x)
      if (x < inner.left || x >= inner.right || y < inner.top || y >= inner.bottom)
        values.push_back(layer.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]);
  c.ring = figuresOf(std::move(values), static_cast<int>(c.inside.histogram.size()));
  c.contrast = c.inside.mean - c.ring.mean;
  c.signalToNoise = c.ring.standardDeviation > 0.0 ? c.contrast / c.ring.standardDeviation : NAN;
  return c;
}

std::vector<ProfilePoint> profileOf(const FrameLayer& layer, int width, int height, double x0, double y0, double x1, double y1) {
  requireSize(layer.pixels, width, height);
  const double length = std::hypot(x1 - x0, y1 - y0);
  if (!(length <= 1e6) || !std::isfinite(x0) || !std::isfinite(y0)) throw std::invalid_argument("profileOf: a line without ends or over 1e6 pixels");
  // A pixel without weight has no say, so that a profile goes along the last row and beside gaps.
  const auto valueAt = [&](double x, double y) {
    if (!(x >= 0.0 && y >= 0.0 && x <= width - 1.0 && y <= height - 1.0)) return static_cast<double>(NAN);
    const double left = std::floor(x), top = std::floor(y);
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
      const double px = left + k % 2, py = top + k / 2, weight = (1.0 - std::abs(x - px)) * (1.0 - std::abs(y - py));
      if (weight <= 0.0) continue;
      const float v = layer.pixels[static_cast<std::size_t>(py) * static_cast<std::size_t>(width) + static_cast<std::size_t>(px)];
      if (!std::isfinite(v)) return static_cast<double>(NAN);
      sum += weight * static_cast<double>(v);
    }
    return sum;
  };
  std::vector<ProfilePoint> points;
  const auto add = [&](double distance) {
    const bool isEnd = distance == length;
    const double share = length > 0.0 ? distance / length : 0.0;
    const double x = isEnd ? x1 : x0 + share * (x1 - x0), y = isEnd ? y1 : y0 + share * (y1 - y0);
    points.push_back({x, y, distance, valueAt(x, y)});
  };
  for (int k = 0; k < length; ++k) add(k);
  add(length);
  return points;
}

}  // namespace pitviper
