#include "sim/radiometry/spectral_rule.hpp"

#include <cmath>
#include <stdexcept>

namespace pitviper {
namespace {

std::vector<QuadratureNode> cells(const Spectrum& kernel, int samples, bool logarithmic, double low, double high) {
  std::vector<QuadratureNode> nodes;
  auto edge = [&](double i) {
    return logarithmic ? low * std::pow(high / low, i / samples) : low + (high - low) * i / samples;
  };
  for (int i = 0; i < samples; ++i) {
    const double a = i == 0 ? low : edge(i), b = i + 1 == samples ? high : edge(i + 1);
    nodes.push_back({edge(i + 0.5), kernel.integral(a, b)});
  }
  return nodes;
}

}  // namespace

std::vector<QuadratureNode> spectralRule(const Spectrum& kernel, int samples, Spacing spacing) {
  const double low = kernel.supportLow(), high = kernel.supportHigh();
  if (!(low < high) || !(kernel.integral(low, high) > 0.0)) throw std::invalid_argument("the response is zero everywhere");
  if (spacing != Spacing::Gauss) return cells(kernel, samples, spacing == Spacing::Log, low, high);
  const auto knots = kernel.knots();
  return gaussRule(samples, [&kernel](double w) { return kernel(w); }, low, high, knots);
}

std::vector<QuadratureNode> sharedRule(const Spectrum& kernel, int samples, Spacing spacing, double low, double high) {
  if (spacing != Spacing::Gauss) return cells(kernel, samples, spacing == Spacing::Log, low, high);
  auto nodes = gaussLegendre(samples, low, high);
  for (auto& node : nodes) node.weight *= kernel(node.x);
  return nodes;
}

}  // namespace pitviper
