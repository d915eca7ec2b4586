#include "sensors/display_codes.hpp"

#include <cmath>
#include <cstddef>

namespace pitviper {

void toDisplayCodes(std::vector<float>& counts, const DetectorLaw& law) {
  constexpr double kCodes = 255.0, kLowest = 0.005, kHighest = 0.995, kPlateau = 0.02;
  const auto most = static_cast<std::size_t>(law.mostCount());
  const auto binOf = [most](float v) { return std::min(static_cast<std::size_t>(std::max(v, 0.0f)), most); };
  std::vector<double> histogram(most + 1, 0.0);
  for (float v : counts) histogram[binOf(v)] += 1.0 / static_cast<double>(counts.size());
  std::vector<float> codeOf(most + 1);
  if (law.agc == Agc::Plateau) {
    double all = 0.0, below = 0.0;
    for (double& h : histogram) h = std::min(h, kPlateau), all += h;
    for (std::size_t k = 0; k <= most; ++k) {
      codeOf[k] = static_cast<float>(std::round(kCodes * (below + 0.5 * histogram[k]) / all));
      below += histogram[k];
    }
  } else {
    double low = 0.0, high = law.mostCount();
    if (law.agc == Agc::Percentile) {
      double below = 0.0;
      bool found = false;
      for (std::size_t k = 0; k <= most; ++k) {
        below += histogram[k];
        if (!found && below >= kLowest) low = static_cast<double>(k), found = true;
        if (below >= kHighest) {
          high = static_cast<double>(k);
          break;
        }
      }
    }
    for (std::size_t k = 0; k <= most; ++k)
      codeOf[k] = static_cast<float>(std::round(kCodes * std::clamp((static_cast<double>(k) - low) / std::max(high - low, 1.0), 0.0, 1.0)));
  }
  for (float& v : counts) v = codeOf[binOf(v)];
}

}  // namespace pitviper
