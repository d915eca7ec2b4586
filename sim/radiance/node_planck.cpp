#include "sim/radiance/node_planck.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/exponentials.hpp"

namespace pitviper {
namespace {

/// Above it 1 - exp(-x) keeps its digits.
constexpr double kLeast = 0.125;

// Planck's law, B = c1L / lambda^5 exp(-x) / (1 - exp(-x)), and dB/dT = B x / (T (1 - exp(-x))), x = c2 / (lambda T) above kLeast.
PITVIPER_WIDE void blackBodies(const double* c2OverWavelength_K, const double* c1OverWavelength5, double temperature_K, int count, double* radiance,
                               double* rise) {
  for (int i = 0; i < count; ++i) radiance[i] = -c2OverWavelength_K[i] / temperature_K;
  wide::exponential(radiance, count);
  for (int i = 0; i < count; ++i) {
    const double left = radiance[i], lost = 1.0 - left;
    radiance[i] = c1OverWavelength5[i] * left / lost;
    rise[i] = radiance[i] * c2OverWavelength_K[i] / (lost * temperature_K * temperature_K);
  }
}

}  // namespace

NodePlanck::NodePlanck(std::span<const SpectralNode> nodes) {
  for (const SpectralNode& n : nodes) {
    members_.push_back(n.members.size());
    for (const auto& m : n.members) {
      c2OverWavelength_K_.push_back(kSecondRadiation_umK / m.wavelength_um);
      c1OverWavelength5_.push_back(m.share * kFirstRadianceConstant / std::pow(m.wavelength_um, 5));
    }
  }
  least_K_ = c2OverWavelength_K_.empty() ? 0.0 : *std::min_element(c2OverWavelength_K_.begin(), c2OverWavelength_K_.end());
}

void NodePlanck::at(double temperature_K, std::span<double> radiance, std::span<double> rise) const {
  const std::size_t count = c2OverWavelength_K_.size();
  std::vector<double> black(count), rising(count);
  blackBodies(c2OverWavelength_K_.data(), c1OverWavelength5_.data(), temperature_K, static_cast<int>(count), black.data(), rising.data());
  for (std::size_t i = 0; i < count && least_K_ < kLeast * temperature_K; ++i) {
    const double x = c2OverWavelength_K_[i] / temperature_K;
    if (x >= kLeast) continue;
    black[i] = c1OverWavelength5_[i] / std::expm1(x);
    rising[i] = black[i] * x / (-std::expm1(-x) * temperature_K);
  }
  const auto sum = [&](const std::vector<double>& all, std::span<double> into) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < into.size(); ++i) {
      into[i] = 0.0;
      for (const std::size_t end = first + members_[i]; first < end; ++first) into[i] += all[first];
    }
  };
  sum(black, radiance);
  if (!rise.empty()) sum(rising, rise);
}

}  // namespace pitviper
