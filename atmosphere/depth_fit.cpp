#include "atmosphere/depth_fit.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace pitviper {
namespace {

constexpr size_t kMost = 4;
using Row = std::array<double, kMost + 1>;

// Least squares of the columns chosen (the last holds the right side), by modified Gram-Schmidt; false where they depend on each other.
bool solve(std::vector<Row> rows, std::span<const size_t> columns, std::array<double, kMost>& x, double& residual) {
  const size_t n = columns.size();
  std::array<std::array<double, kMost + 1>, kMost> r{};
  for (size_t j = 0; j < n; ++j) {
    double norm = 0.0, before = 0.0;
    for (const Row& row : rows) norm += row[columns[j]] * row[columns[j]];
    norm = std::sqrt(norm);
    for (size_t i = 0; i < j; ++i) before += r[i][j] * r[i][j];
    if (!(norm > 1e-7 * std::sqrt(before)) || norm == 0.0) return false;
    r[j][j] = norm;
    for (Row& row : rows) row[columns[j]] /= norm;
    const auto project = [&](size_t column, size_t place) {
      double dot = 0.0;
      for (const Row& row : rows) dot += row[columns[j]] * row[column];
      r[j][place] = dot;
      for (Row& row : rows) row[column] -= dot * row[columns[j]];
    };
    for (size_t i = j + 1; i < n; ++i) project(columns[i], i);
    project(kMost, kMost);
  }
  for (size_t j = n; j-- > 0;) {
    double sum = r[j][kMost];
    for (size_t i = j + 1; i < n; ++i) sum -= r[j][i] * x[columns[i]];
    x[columns[j]] = sum / r[j][j];
  }
  residual = 0.0;
  for (const Row& row : rows) residual += row[kMost] * row[kMost];
  return true;
}

}  // namespace

DepthFit fitDepth(std::span<const RangeDepth> rows, std::span<const double> exponents, double resolution) {
  const size_t count = std::min(exponents.size(), kMost);
  DepthFit best{std::vector<double>(exponents.size(), 0.0)};
  std::vector<Row> system;
  for (const RangeDepth& row : rows) {
    if (!(row.transmittance > resolution)) continue;
    Row r{};
    for (size_t k = 0; k < count; ++k) r[k] = row.transmittance * std::pow(row.range_km, exponents[k]);
    r[kMost] = row.transmittance * row.depth;
    system.push_back(r);
  }
  if (system.empty() && !rows.empty()) {
    const auto shortest = std::min_element(rows.begin(), rows.end(), [](const RangeDepth& a, const RangeDepth& b) { return a.range_km < b.range_km; });
    const double depth = std::max(shortest->depth, -std::log(0.5 * resolution));
    best.coefficients.back() = depth / std::pow(shortest->range_km, exponents.back());
  }
  double least = std::numeric_limits<double>::infinity();
  for (unsigned chosen = (1u << count) - 1; chosen > 0; --chosen) {
    if (static_cast<size_t>(std::popcount(chosen)) > system.size()) continue;
    std::array<size_t, kMost> columns{};
    size_t n = 0;
    for (size_t k = 0; k < count; ++k)
      if (chosen >> k & 1u) columns[n++] = k;
    std::array<double, kMost> x{};
    double residual = 0.0;
    if (!solve(system, std::span(columns).first(n), x, residual)) continue;
    if (*std::min_element(x.begin(), x.end()) < 0.0) continue;
    // Equal to rounding is not better: the first tried has the later exponents.
    if (!(residual < least * (1.0 - 1e-9) - 1e-24)) continue;
    least = residual;
    std::copy_n(x.begin(), count, best.coefficients.begin());
  }
  for (const RangeDepth& row : rows) {
    double depth = 0.0;
    for (size_t k = 0; k < exponents.size(); ++k) depth += best.coefficients[k] * std::pow(row.range_km, exponents[k]);
    const double difference = std::exp(-depth) - row.transmittance;
    best.largest = std::max(best.largest, std::abs(difference));
    best.sumOfSquares += difference * difference;
  }
  return best;
}

std::vector<double> fitSource(std::span<const std::vector<double>> depth, std::span<const double> exponents, std::span<const RangeRadiance> seen,
                              double& difference) {
  difference = 0.0;
  if (seen.empty()) return {};
  // Below, all transmittances are 1 to rounding.
  constexpr double kClear = 1e-14;
  std::vector<double> source(depth.size(), 0.0);
  std::vector<size_t> known;
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < depth.size(); ++i) {
    double above = 0.0, below = 0.0;
    std::vector<double> opacity;
    for (const RangeRadiance& s : seen) {
      double d = 0.0;
      for (size_t k = 0; k < exponents.size(); ++k) d += depth[i][k] * std::pow(s.range_km, exponents[k]);
      opacity.push_back(-std::expm1(-d));
      above += s.radiance[i] * opacity.back();
      below += opacity.back() * opacity.back();
    }
    if (below > kClear) {
      source[i] = above / below;
      known.push_back(i);
    }
    for (size_t s = 0; s < seen.size(); ++s) {
      largest = std::max(largest, seen[s].radiance[i]);
      worst = std::max(worst, std::abs(source[i] * opacity[s] - seen[s].radiance[i]));
    }
  }
  size_t next = 0;
  for (size_t i = 0; i < source.size() && !known.empty(); ++i) {
    while (next + 1 < known.size() && known[next] < i) ++next;
    if (known[next] == i) continue;
    const bool before = next > 0 && (known[next] < i || i - known[next - 1] < known[next] - i);
    source[i] = source[known[next] < i || !before ? known[next] : known[next - 1]];
  }
  difference = largest > 0.0 ? worst / largest : 0.0;
  return source;
}

}  // namespace pitviper
