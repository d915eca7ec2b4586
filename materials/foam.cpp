#include "materials/foam.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pitviper {

double whitecapShare(double wind10_m_s) { return wind10_m_s > 0.0 ? std::min(1.0, 3.84e-6 * std::pow(wind10_m_s, 3.41)) : 0.0; }

double foamReflectance(double wavelength_um) {
  constexpr std::array<std::array<double, 2>, 6> kTable{{{0.44, 0.22}, {0.65, 0.2}, {0.85, 0.132}, {1.02, 0.11}, {1.65, 0.033}, {2.0, 0.02}}};
  if (wavelength_um <= kTable.front()[0]) return kTable.front()[1];
  for (std::size_t i = 1; i < kTable.size(); ++i)
    if (const auto& [x1, y1] = kTable[i]; wavelength_um < x1) {
      const auto& [x0, y0] = kTable[i - 1];
      return y0 + (y1 - y0) * (wavelength_um - x0) / (x1 - x0);
    }
  return kTable.back()[1];
}

}  // namespace pitviper
