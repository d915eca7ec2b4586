#include "sim/radiometry/spectral_rule.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pitviper {
namespace {

std::vector<QuadratureNode> cells(const Spectrum& kernel, int samples, bool logarithmic, double low, double high) {
  std::vector<QuadratureNode> nodes;
  auto edge = [&](double i) { return logarithmic ? low * std::pow(high / low, i / samples) : low + (high - low) * i / samples; };
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
  return gaussRule(
      samples, [&kernel](double w) { return kernel(w); }, low, high, knots);
}

std::vector<SpectralPiece> commonPieces(const std::vector<const Spectrum*>& kernels) {
  std::vector<double> edges;
  for (const auto* k : kernels) edges.insert(edges.end(), {k->supportLow(), k->supportHigh()});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<SpectralPiece> pieces;
  for (size_t i = 0; i + 1 < edges.size(); ++i) {
    const double middle = 0.5 * (edges[i] + edges[i + 1]);
    if (std::any_of(kernels.begin(), kernels.end(), [&](const auto* k) { return middle > k->supportLow() && middle < k->supportHigh(); }))
      pieces.push_back({edges[i], edges[i + 1]});
  }
  return pieces;
}

std::vector<QuadratureNode> sharedRule(const Spectrum& kernel, int samples, Spacing spacing, const std::vector<SpectralPiece>& pieces) {
  auto width = [&](const SpectralPiece& p) { return spacing == Spacing::Log ? std::log(p.high_um / p.low_um) : p.high_um - p.low_um; };
  double total = 0.0, sum = 0.0;
  for (const auto& p : pieces) total += width(p);
  std::vector<QuadratureNode> nodes;
  for (const auto& p : pieces) {
    const int n = std::max(2, static_cast<int>(std::lround(samples * width(p) / total)));
    auto part = spacing == Spacing::Gauss ? gaussLegendre(n, p.low_um, p.high_um) : cells(kernel, n, spacing == Spacing::Log, p.low_um, p.high_um);
    for (auto& node : part) {
      if (spacing == Spacing::Gauss) node.weight *= kernel(node.x);
      sum += node.weight;
      nodes.push_back(node);
    }
  }
  if (std::abs(sum - kernel.integral(kernel.supportLow(), kernel.supportHigh())) > 1e-3 * sum)
    throw std::invalid_argument("its response is too narrow or too uneven for the wavelengths that all channels share");
  return nodes;
}

}  // namespace pitviper
