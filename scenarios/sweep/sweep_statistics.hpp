#pragma once
// What a sweep's results come to: how each measure is spread, and which factors it goes with.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/sweep/sobol_indices.hpp"
#include "scenarios/sweep/sweep_identity.hpp"

namespace pitviper {

inline constexpr std::array<double, 7> kSweepQuantiles{0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0};

/// Spearman's, of a measure with a factor; of a choice with the order of its words. NaN where either does not vary.
struct FactorCorrelation {
  double rho = 0.0;
  /// Holds it with 95 %: Fisher's z with the standard error of Bonett and Wright (Psychometrika 65, 23 (2000)). NaN for fewer than 4 samples.
  Interval interval;
  int samples = 0;
};

struct MeasureStatistics {
  std::string name, unit;
  int count = 0;    ///< samples with a number
  int missing = 0;  ///< drawn, but their picture does not have it
  int failed = 0;   ///< samples without any measures
  double mean = 0.0;
  double sigma = 0.0;                         ///< standard deviation, of n - 1; NaN for fewer than 2 samples
  std::array<double, 7> quantiles{};          ///< at kSweepQuantiles
  std::vector<FactorCorrelation> withFactor;  ///< by factor
  std::optional<SobolIndices> sobol;          ///< of a Saltelli design
};

/// By column of measures. Of a Saltelli design correlations are those of its independent samples (A and B of each row); rows of it that are not wholly
/// stored yet are left out of the indices.
std::vector<MeasureStatistics> sweepStatistics(const SweepIdentity& identity, const std::vector<SweepRow>& rows, bool isSaltelli);

/// As FactorCorrelation has it.
Interval correlationInterval(double rho, int samples);

}  // namespace pitviper
