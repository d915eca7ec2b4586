#include "sim/stream/body_masks.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace pitviper {
namespace {

const std::vector<float>* pixelsOf(const Frame& frame, const char* layer) {
  for (const FrameLayer& l : frame.layers)
    if (l.name == layer) return &l.pixels;
  return nullptr;
}

/// A mask as it grows, column by column.
struct GrowingMask {
  BodyMask mask;
  std::size_t end = 0;  ///< of its last run
  double range = 0.0, temperature = 0.0;

  void add(std::size_t first, std::size_t count) {
    if (!mask.runs.empty() && first == end) mask.runs.back() += static_cast<std::uint32_t>(count);
    else {
      mask.runs.push_back(static_cast<std::uint32_t>(first - end));
      mask.runs.push_back(static_cast<std::uint32_t>(count));
    }
    end = first + count;
  }
};

}  // namespace

std::vector<BodyMask> bodyMasks(const Frame& frame, const std::function<bool(int)>& isWanted) {
  const std::vector<float>*entity = pixelsOf(frame, "truth.entity"), *range = pixelsOf(frame, "truth.range"),
        *temperature = pixelsOf(frame, "truth.temperature");
  std::vector<BodyMask> masks;
  if (!entity) return masks;
  const auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
  std::map<int, GrowingMask> growing;
  std::map<int, bool> wanted;
  for (std::size_t x = 0; x < width; ++x)
    for (std::size_t y = 0; y < height;) {
      const float value = (*entity)[y * width + x];
      std::size_t below = y + 1;
      while (below < height && (*entity)[below * width + x] == value) ++below;
      const std::size_t from = std::exchange(y, below);
      const int number = value > 0.0f ? static_cast<int>(value) : 0;
      if (number == 0) continue;
      const auto [known, isNew] = wanted.try_emplace(number, false);
      if (isNew) known->second = isWanted(number);
      if (!known->second) continue;
      GrowingMask& g = growing[number];
      BodyMask& m = g.mask;
      const int column = static_cast<int>(x), top = static_cast<int>(from), bottom = static_cast<int>(below);
      if (m.pixels == 0) m.number = number, m.left = column, m.top = top;
      m.right = column + 1, m.top = std::min(m.top, top), m.bottom = std::max(m.bottom, bottom);
      m.pixels += below - from;
      g.add(x * height + from, below - from);
      for (std::size_t row = from; row < below; ++row) {
        if (range) g.range += static_cast<double>((*range)[row * width + x]);
        if (temperature) g.temperature += static_cast<double>((*temperature)[row * width + x]);
      }
    }
  for (auto& [number, g] : growing) {
    if (g.end < width * height) g.mask.runs.push_back(static_cast<std::uint32_t>(width * height - g.end));
    if (range) g.mask.range_m = g.range / static_cast<double>(g.mask.pixels);
    if (temperature) g.mask.temperature_K = g.temperature / static_cast<double>(g.mask.pixels);
    masks.push_back(std::move(g.mask));
  }
  return masks;
}

std::string cocoCounts(const std::vector<std::uint32_t>& runs) {
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::int64_t left = runs[i];
    if (i > 2) left -= runs[i - 2];
    for (bool more = true; more;) {
      auto group = static_cast<char>(left & 31);
      left >>= 5;
      more = left != ((group & 16) ? -1 : 0);  // the fifth bit is the sign of what follows
      if (more) group |= 32;
      text += static_cast<char>(group + '0');
    }
  }
  return text;
}

}  // namespace pitviper
