#pragma once
// Which factor a result's variance comes from: indices of Sobol from a design of Saltelli.
#include <vector>

namespace pitviper {

struct Interval {
  double low = 0.0, high = 0.0;
};

/// Of one factor; intervals hold the index with 95 %. NaN where the result does not vary.
struct SobolIndex {
  double first = 0.0, total = 0.0;
  Interval firstInterval, totalInterval;
};

struct SobolIndices {
  std::vector<SobolIndex> factors;
  int rows = 0;     ///< of the design that were used
  int leftOut = 0;  ///< because one of their samples has no finite result
};

/// `results` by sample: row r of the design is samples r (d + 2) on: A, B, then A with factor 1 of B, ... with factor d of B (d = `factors`); a sample that
/// failed or is missing is NaN. First order by Saltelli et al. (Comput. Phys. Commun. 181, 259 (2010), table 2 b), total by Jansen (ibid. 117, 35 (1999)),
/// both about the mean of A and B; intervals from 1000 sets of rows drawn again (percentiles; the same for the same results).
/// Errors: std::invalid_argument where `results` are no whole rows.
SobolIndices sobolIndices(const std::vector<double>& results, int factors);

}  // namespace pitviper
