#pragma once
// Where in the unit cube the samples of a sweep lie. Each point depends on the design and its own number alone.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "scenarios/sweep/sobol_sequence.hpp"

namespace pitviper {

enum class Design { Random, LatinHypercube, Sobol, SobolIndices, Grid, Table };

/// Points of a design, of `factors` coordinates in (0, 1) each. Random numbers are counted (philox), of (seed, sample, factor, attempt).
/// - Random: independent.
/// - LatinHypercube: of N samples one in each N-th of every factor, at random there; the order is another for every factor.
///   Source: M. D. McKay, R. J. Beckman and W. J. Conover, Technometrics 21, 239 (1979).
/// - Sobol: Sobol's sequence with a random digital shift in each factor. It is balanced at powers of two: of 2^k samples one in each 2^k-th of every factor.
/// - SobolIndices: for variance-based indices by A. Saltelli et al., Computer Physics Communications 181, 259 (2010). Matrices A and B are the first and the
///   last d columns of N points of a Sobol sequence in 2d dimensions, shifted as above; see SaltelliRow for the order. Balanced at powers of two as well.
/// - Grid: all combinations of levels, the last factor changes first; each point in the middle of its cell.
class SampleDesign {
 public:
  /// Random, LatinHypercube, Sobol, SobolIndices. `samples` 1 to kMostSamples: N.
  SampleDesign(Design kind, std::uint64_t seed, int samples, std::size_t factors);
  /// Grid: the number of levels of each factor.
  explicit SampleDesign(std::vector<int> levels);

  /// Points that there are: N, of SobolIndices N (d + 2), of a grid the product of its levels.
  long long size() const { return size_; }
  /// By number from 0. `attempt` is for Random: other points, for those that nobody wants.
  std::vector<double> point(int number, int attempt = 0) const;

 private:
  std::vector<double> sobolPoint(std::uint32_t number, std::size_t first) const;

  Design kind_;
  std::uint64_t seed_ = 0;
  std::size_t factors_;
  long long size_ = 0;
  int strata_ = 0;
  std::vector<std::vector<std::uint32_t>> orders_;  ///< LatinHypercube: [factor][sample]
  std::vector<int> levels_;
  std::unique_ptr<const SobolSequence> sequence_;
};

/// Of one sweep.
constexpr long long kMostSamples = 10000000;

/// Which matrix a sample of SobolIndices belongs to. The d + 2 rows of base point 0 come first, then those of base point 1 and so on: each time A, then B, then
/// AB_1 to AB_d. AB_i is A with its factor i (from 1) out of B.
struct SaltelliRow {
  int base = 0;    ///< row of the matrix, from 0
  int matrix = 0;  ///< 0: A; 1 to d: AB_i; d + 1: B
};
SaltelliRow saltelliRow(int sample, std::size_t factors);

/// A sample's own seed: of the sweep's and its number; below 2^53, as seeds of scenarios are.
std::uint64_t sampleSeed(std::uint64_t sweepSeed, int sample);

}  // namespace pitviper
