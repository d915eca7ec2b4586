#include "sim/plan/fine_grid.hpp"

#include <algorithm>

namespace pitviper {
namespace {

constexpr double kWidth_per_cm = 5.0, kWidth_um = 1e-3;

/// Width of a bin that begins at a wavelength [um].
double widthAt(double wavelength_um) { return std::max(kWidth_um, kWidth_per_cm * 1e-4 * wavelength_um * wavelength_um); }

/// Bins of a table's own from `low` to `high`, wide ones cut into usual ones.
std::vector<QuadratureNode> tableGrid(const Spectrum& kernel, std::span<const double> table, double low, double high) {
  std::vector<QuadratureNode> nodes;
  auto add = [&](double from, double to, double at) {
    const double weight = from < to ? kernel.integral(from, to) : 0.0;
    if (weight != 0.0) nodes.push_back({at, weight});
  };
  for (size_t k = 0; k < table.size(); ++k) {
    const double from = k == 0 ? low : std::max(low, 0.5 * (table[k - 1] + table[k]));
    const double to = k + 1 == table.size() ? high : std::min(high, 0.5 * (table[k] + table[k + 1]));
    if (!(from < to)) continue;
    if (to - from <= widthAt(table[k])) {
      add(from, to, std::clamp(table[k], from, to));
      continue;
    }
    const int bins = static_cast<int>((to - from) / widthAt(table[k]) + 0.999);
    for (int b = 0; b < bins; ++b) add(from + (to - from) * b / bins, from + (to - from) * (b + 1) / bins, from + (to - from) * (b + 0.5) / bins);
  }
  return nodes;
}

}  // namespace

std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, std::span<const double> table) {
  if (!table.empty()) return tableGrid(kernel, table, kernel.supportLow(), kernel.supportHigh());
  const double low = kernel.supportLow(), high = kernel.supportHigh();
  std::vector<double> edges = {low, high};
  for (double k : kernel.knots())
    if (k > low && k < high) edges.push_back(k);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  // A response with more bends than bins is averaged over the bins.
  std::vector<double> kept = {edges.front()};
  for (double e : edges)
    if (e - kept.back() > 0.25 * widthAt(e)) kept.push_back(e);
  if (kept.size() == 1) kept.push_back(high);
  else if (kept.back() != high) kept.back() = high;
  std::vector<QuadratureNode> nodes;
  for (size_t i = 0; i + 1 < kept.size(); ++i) {
    const int bins = std::max(1, static_cast<int>((kept[i + 1] - kept[i]) / widthAt(0.5 * (kept[i] + kept[i + 1])) + 0.999));
    for (int b = 0; b < bins; ++b) {
      const double a = kept[i] + (kept[i + 1] - kept[i]) * b / bins, e = kept[i] + (kept[i + 1] - kept[i]) * (b + 1) / bins;
      const double weight = kernel.integral(a, e);
      if (weight != 0.0) nodes.push_back({0.5 * (a + e), weight});
    }
  }
  return nodes;
}

std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, const Path* air) {
  return fineGrid(kernel, air && air->isTabulated() ? air->knots_um() : std::vector<double>());
}

}  // namespace pitviper
