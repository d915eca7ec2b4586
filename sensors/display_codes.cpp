#include "sensors/display_codes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pitviper {
namespace {

constexpr double kCodes = 255.0;

/// Shares of a picture's pixels by count.
struct Histogram {
  std::vector<double> share;
  /// The count below which, with its own, so much of the picture lies.
  std::size_t at(double part) const {
    double below = 0.0;
    for (std::size_t k = 0; k < share.size(); ++k)
      // A share that a double's sum of pixels misses by its rounding is reached.
      if ((below += share[k]) >= part - 1e-9 && share[k] > 0.0) return k;
    return share.size() - 1;
  }
};

/// Codes that each count gets.
std::vector<double> codesOf(const Histogram& h, const DisplayLaw& law, std::size_t low, std::size_t high, double most) {
  const double n = static_cast<double>(high - low) + 1.0, even = kCodes / n * (law.agc == Agc::Plateau ? law.linear : 1.0);
  std::vector<double> codes(h.share.size(), std::min(most, even));
  if (law.agc != Agc::Plateau) return codes;
  double all = 0.0;
  for (std::size_t k = low; k <= high; ++k) all += std::min(h.share[k], law.plateau);
  for (std::size_t k = low; k <= high; ++k) codes[k] = std::min(most, even + kCodes * (1.0 - law.linear) * std::min(h.share[k], law.plateau) / all);
  return codes;
}

}  // namespace

void toDisplayCodes(std::vector<float>& counts, const DetectorLaw& law, double noise_counts) {
  const DisplayLaw& display = law.display;
  const auto last = static_cast<std::size_t>(law.mostCount());
  const auto binOf = [last](float v) { return v <= static_cast<float>(last) ? static_cast<std::size_t>(std::max(v, 0.0f)) : last; };
  std::vector<float> codeOf(last + 1);
  const auto none = static_cast<std::size_t>(std::count_if(counts.begin(), counts.end(), [](float v) { return std::isnan(v); }));
  if (display.agc == Agc::Fixed || none == counts.size()) {
    for (std::size_t k = 0; k <= last; ++k) codeOf[k] = static_cast<float>(std::round(kCodes * static_cast<double>(k) / static_cast<double>(last)));
  } else {
    Histogram h{std::vector<double>(last + 1, 0.0)};
    for (float v : counts) h.share[binOf(v)] += std::isnan(v) ? 0.0 : 1.0;
    for (double& share : h.share) share /= static_cast<double>(counts.size() - none);
    const std::size_t low = h.at(display.tails), high = std::max(low, h.at(1.0 - display.tails)), median = h.at(0.5);
    const double most = display.most_codesPerCount > 0.0 ? display.most_codesPerCount : DisplayLaw::kNoise_codes / std::max(noise_counts, 1e-12);
    const std::vector<double> codes = codesOf(h, display, low, high, most);
    std::vector<double> place(last + 1);
    double below = 0.0, from = 0.0;
    for (std::size_t k = 0; k <= last; ++k) {
      if (k == low) from = below;
      place[k] = below + 0.5 * codes[k];
      below += codes[k];
    }
    const double used = place[high] + 0.5 * codes[high] - from;
    const double black = from - std::clamp(0.5 * kCodes - (place[median] - from), 0.0, std::max(0.0, kCodes - used));
    for (std::size_t k = 0; k <= last; ++k) codeOf[k] = static_cast<float>(std::round(std::clamp(place[k] - black, 0.0, kCodes)));
  }
  for (float& v : counts) v = std::isnan(v) ? static_cast<float>(kCodes) : codeOf[binOf(v)];
}

}  // namespace pitviper
