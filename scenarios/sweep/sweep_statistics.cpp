#include "scenarios/sweep/sweep_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/sweep/sample_moments.hpp"

namespace pitviper {
namespace {

/// Of the normal distribution, both sides, 95 %.
constexpr double kNormal95 = 1.959963984540054;

void setSpread(MeasureStatistics& s, std::vector<double> values) {
  const double n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (double v : values) sum += v;
  s.mean = values.empty() ? NAN : sum / n;
  for (double v : values) squares += (v - s.mean) * (v - s.mean);
  s.sigma = values.size() < 2 ? NAN : std::sqrt(squares / (n - 1.0));
  std::sort(values.begin(), values.end());
  for (std::size_t q = 0; q < kSweepQuantiles.size(); ++q) s.quantiles[q] = quantileOf(values, kSweepQuantiles[q]);
}

}  // namespace

Interval correlationInterval(double rho, int samples) {
  if (std::isnan(rho) || samples < 4) return {NAN, NAN};
  const double z = std::atanh(rho), error = std::sqrt((1.0 + 0.5 * rho * rho) / (samples - 3));
  return {std::tanh(z - kNormal95 * error), std::tanh(z + kNormal95 * error)};
}

std::vector<MeasureStatistics> sweepStatistics(const SweepIdentity& identity, const std::vector<SweepRow>& rows, bool isSaltelli) {
  const std::vector<MeasureColumn> columns = measureColumns(identity);
  const std::size_t width = identity.factors.size() + 2;
  std::vector<MeasureStatistics> all;
  for (std::size_t column = 0; column < columns.size(); ++column) {
    MeasureStatistics& s = all.emplace_back();
    s.name = columns[column].name, s.unit = columns[column].unit;
    std::vector<double> values, independent;
    std::vector<std::vector<double>> factors(identity.factors.size());
    std::vector<double> design(static_cast<std::size_t>(identity.samples) / width * width, NAN);
    for (const SweepRow& r : rows) {
      const std::size_t sample = static_cast<std::size_t>(r.sample);
      const double value = r.why.empty() ? r.measures.at(column) : NAN;
      if (!r.why.empty()) ++s.failed;
      else if (std::isnan(value)) ++s.missing;
      if (std::isnan(value)) continue;
      ++s.count;
      values.push_back(value);
      if (sample < design.size()) design[sample] = value;
      if (isSaltelli && sample % width >= 2) continue;
      independent.push_back(value);
      for (std::size_t i = 0; i < factors.size(); ++i) factors[i].push_back(r.factors.at(i));
    }
    setSpread(s, values);
    for (const std::vector<double>& f : factors) {
      const double rho = rankCorrelation(f, independent);
      const int n = static_cast<int>(f.size());
      s.withFactor.push_back({rho, correlationInterval(rho, n), n});
    }
    if (isSaltelli && !factors.empty()) s.sobol = sobolIndices(design, static_cast<int>(factors.size()));
  }
  return all;
}

}  // namespace pitviper
