#include "sim/radiance/node_planck.hpp"

#include <Eigen/Core>
#include <cmath>

#include "sim/model/node_air.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

Eigen::Map<const Eigen::ArrayXd> arrayOf(const std::vector<double>& v) { return {v.data(), static_cast<Eigen::Index>(v.size())}; }

}  // namespace

NodePlanck::NodePlanck(std::span<const SpectralNode> nodes) {
  for (const SpectralNode& n : nodes) {
    members_.push_back(n.members.size());
    for (const auto& m : n.members) {
      c2OverWavelength_K_.push_back(kSecondRadiation_umK / m.wavelength_um);
      c1OverWavelength5_.push_back(m.share * kFirstRadianceConstant / std::pow(m.wavelength_um, 5));
    }
  }
}

// Planck's law, B = c1L / lambda^5 exp(-x) / (1 - exp(-x)), and dB/dT = B x / (T (1 - exp(-x))), x = c2 / (lambda T).
void NodePlanck::at(double temperature_K, std::span<double> radiance, std::span<double> rise) const {
  std::vector<double> x(c2OverWavelength_K_);
  for (double& v : x) v /= temperature_K;
  const std::vector<double> lost = lostOf(x);
  const Eigen::ArrayXd black = arrayOf(c1OverWavelength5_) * (-arrayOf(x)).exp() / arrayOf(lost);
  const auto sum = [&](const Eigen::ArrayXd& all, std::span<double> into) {
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < into.size(); ++i) {
      const auto count = static_cast<Eigen::Index>(members_[i]);
      into[i] = all.segment(first, count).sum();
      first += count;
    }
  };
  sum(black, radiance);
  if (!rise.empty()) sum(black * arrayOf(x) / (arrayOf(lost) * temperature_K), rise);
}

}  // namespace pitviper
