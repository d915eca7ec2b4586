#include "scenarios/sweep/sample_moments.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>

namespace pitviper {

double quantileOf(const std::vector<double>& rising, double part) {
  if (rising.empty()) return NAN;
  const double place = part * static_cast<double>(rising.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), rising.size() - 1), above = std::min(below + 1, rising.size() - 1);
  const double step = place - static_cast<double>(below);
  // Equal neighbours may be infinite: their difference is no number.
  if (step == 0.0 || rising[below] == rising[above]) return rising[below];
  return std::lerp(rising[below], rising[above], step);
}

std::vector<double> ranksOf(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t from = 0, to = 0; from < order.size(); from = to) {
    while (to < order.size() && values[order[to]] == values[order[from]]) ++to;
    for (std::size_t i = from; i < to; ++i) ranks[order[i]] = 0.5 * static_cast<double>(from + 1 + to);
  }
  return ranks;
}

double rankCorrelation(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size()) throw std::invalid_argument("rankCorrelation: two lengths");
  const std::vector<double> a = ranksOf(x), b = ranksOf(y);
  const double mean = 0.5 * (static_cast<double>(x.size()) + 1.0);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) ab += (a[i] - mean) * (b[i] - mean), aa += (a[i] - mean) * (a[i] - mean), bb += (b[i] - mean) * (b[i] - mean);
  return aa > 0.0 && bb > 0.0 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : NAN;
}

}  // namespace pitviper
