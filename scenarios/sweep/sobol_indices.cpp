#include "scenarios/sweep/sobol_indices.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "scenarios/sweep/sample_moments.hpp"

namespace pitviper {
namespace {

constexpr int kDrawnAgain = 1000;
constexpr double kTail = 0.025;

/// First order and total of each factor, one after the other.
std::vector<double> indicesOf(const std::vector<const double*>& rows, std::size_t factors) {
  const double n = static_cast<double>(rows.size());
  double sum = 0.0, squares = 0.0;
  for (const double* r : rows) sum += r[0] + r[1], squares += r[0] * r[0] + r[1] * r[1];
  const double mean = sum / (2.0 * n), variance = squares / (2.0 * n) - mean * mean;
  std::vector<double> sums(2 * factors, 0.0);
  for (const double* r : rows)
    for (std::size_t i = 0; i < factors; ++i) {
      const double change = r[2 + i] - r[0];
      sums[2 * i] += (r[1] - mean) * change;
      sums[2 * i + 1] += 0.5 * change * change;
    }
  for (double& s : sums) s = variance > 0.0 ? s / (n * variance) : NAN;
  return sums;
}

/// Of those that are numbers: a set of rows drawn again may not vary.
Interval middle95(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  std::sort(values.begin(), values.end());
  return {quantileOf(values, kTail), quantileOf(values, 1.0 - kTail)};
}

}  // namespace

SobolIndices sobolIndices(const std::vector<double>& results, int factors) {
  const std::size_t d = static_cast<std::size_t>(std::max(factors, 0)), width = d + 2;
  if (factors < 1 || results.size() % width != 0) throw std::invalid_argument("sobolIndices: no whole rows");
  SobolIndices found;
  found.factors.resize(d);
  std::vector<double> kept;
  for (std::size_t at = 0; at < results.size(); at += width) {
    const auto from = results.begin() + static_cast<std::ptrdiff_t>(at), to = from + static_cast<std::ptrdiff_t>(width);
    if (!std::all_of(from, to, [](double v) { return std::isfinite(v); })) {
      ++found.leftOut;
      continue;
    }
    kept.insert(kept.end(), from, to);
    ++found.rows;
  }
  // Squares of large numbers would lose their differences; of equal ones nothing is left.
  const double about = kept.empty() ? 0.0 : kept.front();
  for (double& v : kept) v -= about;
  std::vector<const double*> rows;
  for (std::size_t at = 0; at < kept.size(); at += width) rows.push_back(&kept[at]);
  const std::vector<double> all = indicesOf(rows, d);
  std::vector<std::vector<double>> again(2 * d);
  std::mt19937_64 random(20100261);
  std::vector<const double*> drawn(rows.size());
  for (int k = 0; k < kDrawnAgain && !rows.empty(); ++k) {
    // A remainder, not a distribution of the library: those differ between compilers.
    for (const double*& r : drawn) r = rows[random() % rows.size()];
    const std::vector<double> some = indicesOf(drawn, d);
    for (std::size_t i = 0; i < some.size(); ++i) again[i].push_back(some[i]);
  }
  for (std::size_t i = 0; i < d; ++i) found.factors[i] = {all[2 * i], all[2 * i + 1], middle95(again[2 * i]), middle95(again[2 * i + 1])};
  return found;
}

}  // namespace pitviper
