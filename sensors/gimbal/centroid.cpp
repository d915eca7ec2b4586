#include "sensors/gimbal/centroid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace pitviper {
namespace {

constexpr std::size_t kMostSamples = 4096;
constexpr int kBorder_px = 4;
constexpr std::size_t kLeastBorder = 64;  // documented with Background
constexpr double kNormalDeviation = 1.4826;
// A picture that is flat but for single precision's rounding of a chain of some ten operations holds no target.
constexpr double kRounding = 8 * 0x1p-23;

/// First and one past the last column and row.
struct Box {
  int left, top, right, bottom;
  bool isEmpty() const { return left >= right || top >= bottom; }
};

struct Levels {
  bool known = false;
  double background = 0.0, noise = 0.0;
};

class Sample {
 public:
  void add(float v) {
    if (std::isfinite(v)) values_[count_++] = v;
  }
  std::size_t count() const { return count_; }
  Levels levels() {
    if (count_ == 0) return {};
    const float middle = median();
    for (std::size_t i = 0; i < count_; ++i) values_[i] = std::abs(values_[i] - middle);
    return {true, static_cast<double>(middle), kNormalDeviation * static_cast<double>(median())};
  }

 private:
  float median() {
    const auto at = values_.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
    std::nth_element(values_.begin(), at, values_.begin() + static_cast<std::ptrdiff_t>(count_));
    return *at;
  }
  std::array<float, kMostSamples> values_;
  std::size_t count_ = 0;
};

/// A step that has no divisor with `count` and falls, as the golden section does, between the places it has been to: no row or column is preferred.
std::size_t spreadingStep(std::size_t count) {
  auto stride = static_cast<std::size_t>(0.6180339887498949 * static_cast<double>(count)) | 1u;
  while (std::gcd(stride, count) != 1) stride += 2;
  return stride % count;
}

Levels levelsOfPicture(std::span<const float> picture) {
  Sample sample;
  const std::size_t stride = picture.size() > kMostSamples ? spreadingStep(picture.size()) : 1, taken = std::min(picture.size(), kMostSamples);
  std::size_t at = 0;
  for (std::size_t i = 0; i < taken; ++i) {
    sample.add(picture[at]);
    at += stride;
    if (at >= picture.size()) at -= picture.size();
  }
  return sample.levels();
}

Levels levelsAround(std::span<const float> picture, int width, int height, const Box& inner) {
  const Box outer{std::max(inner.left - kBorder_px, 0), std::max(inner.top - kBorder_px, 0), std::min(inner.right + kBorder_px, width),
                  std::min(inner.bottom + kBorder_px, height)};
  const auto area = [](const Box& b) { return static_cast<std::size_t>(b.right - b.left) * static_cast<std::size_t>(b.bottom - b.top); };
  const std::size_t each = 1 + (area(outer) - area(inner)) / kMostSamples;
  Sample sample;
  std::size_t number = 0;
  for (int y = outer.top; y < outer.bottom; ++y)
    for (int x = outer.left; x < outer.right; ++x) {
      if (y >= inner.top && y < inner.bottom && x == inner.left) x = inner.right;
      if (x >= outer.right) break;
      if (number++ % each == 0) sample.add(picture[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]);
    }
  return sample.count() < kLeastBorder ? Levels{} : sample.levels();
}

Box boxOf(const Gate& gate, int width, int height) {
  if (gate.whole) return {0, 0, width, height};
  const auto bounded = [](double v, int most) { return static_cast<int>(v > 0.0 ? std::min(v, static_cast<double>(most)) : 0.0); };
  const glm::dvec2 low = gate.centre_px - gate.half_px - 0.5, high = gate.centre_px + gate.half_px - 0.5;
  return {bounded(std::ceil(low.x), width), bounded(std::ceil(low.y), height), bounded(std::floor(high.x) + 1.0, width),
          bounded(std::floor(high.y) + 1.0, height)};
}

float peakOf(std::span<const float> picture, int width, const Box& box) {
  float peak = -std::numeric_limits<float>::infinity();
  for (int y = box.top; y < box.bottom; ++y) {
    const float* row = picture.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    for (int x = box.left; x < box.right; ++x)
      if (row[x] > peak && std::isfinite(row[x])) peak = row[x];
  }
  return peak;
}

Centroid centroidAbove(const Levels& levels, std::span<const float> picture, int width, const Box& box, const ThresholdRule& rule) {
  Centroid c;
  if (!levels.known || box.isEmpty()) return c;
  c.background = levels.background;
  c.noise = std::max(levels.noise, rule.leastNoise);
  c.threshold = c.background + std::max(rule.sigmas * c.noise, kRounding * std::abs(c.background));
  if (rule.shareOfPeak > 0.0) {
    const double peak = std::min(static_cast<double>(peakOf(picture, width, box)), rule.saturation);
    if (peak > c.background) c.threshold = std::max(c.threshold, c.background + rule.shareOfPeak * (peak - c.background));
  }
  double weight = 0.0, sumX = 0.0, sumY = 0.0, brightest = c.threshold;
  for (int y = box.top; y < box.bottom; ++y) {
    const float* row = picture.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    for (int x = box.left; x < box.right; ++x) {
      double v = static_cast<double>(row[x]);
      if (!(v > c.threshold) || !std::isfinite(v)) continue;
      if (v >= rule.saturation) v = rule.saturation, ++c.saturated;
      const double excess = v - c.threshold;
      if (!(excess > 0.0)) continue;
      if (v > brightest) brightest = v, c.peak_px = {x + 0.5, y + 0.5};
      ++c.pixels;
      c.signal += v - c.background;
      weight += excess;
      sumX += excess * x;
      sumY += excess * y;
    }
  }
  c.found = c.pixels >= std::max(rule.leastPixels, 1);
  if (c.found) c.at_px = glm::dvec2(sumX, sumY) / weight + 0.5;
  return c;
}

void requireSize(std::span<const float> picture, int width, int height) {
  if (width <= 0 || height <= 0 || picture.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::invalid_argument("centroid: a picture of another size than is said");
}

Levels levelsFor(std::span<const float> picture, int width, int height, const Gate& gate, const Box& box, const ThresholdRule& rule) {
  if (rule.background == ThresholdRule::Background::GateBorder && !gate.whole && !box.isEmpty())
    if (const Levels around = levelsAround(picture, width, height, box); around.known) return around;
  return levelsOfPicture(picture);
}

}  // namespace

Centroid centroidOf(std::span<const float> picture, int width, int height, const Gate& gate, const ThresholdRule& rule) {
  requireSize(picture, width, height);
  const Box box = boxOf(gate, width, height);
  return centroidAbove(levelsFor(picture, width, height, gate, box, rule), picture, width, box, rule);
}

Centroid CentroidTracker::look(std::span<const float> picture, int width, int height) {
  Centroid c = centroidOf(picture, width, height, gate_, options_.rule);
  if (gate_.whole && c.found) {
    const Gate there{false, c.peak_px, options_.gateHalf_px};
    c = centroidAbove({true, c.background, c.noise}, picture, width, boxOf(there, width, height), options_.rule);
  }
  if (c.found) {
    gate_ = {false, c.at_px, options_.gateHalf_px};
    missed_ = 0;
  } else if (++missed_ >= options_.reacquireAfter) {
    gate_ = {};
  }
  return c;
}

void CentroidTracker::expectAt(const glm::dvec2& at_px) {
  if (!gate_.whole) gate_.centre_px = at_px;
}

}  // namespace pitviper
