#pragma once
// What `bench` varies: one factor at a time, everything else at the centre.
#include <string>
#include <vector>

#include "scenarios/commands/bench_scenarios.hpp"

namespace pitviper {

/// One row of the bench.
struct BenchVariant {
  std::string value;  ///< of the factor
  double x = 0.0;     ///< the same as a number, for charts
  std::string mode;   ///< "direct", "buffered", or a kind of layer
  BenchSetting setting;
  bool whole = false;  ///< the whole way to memory, not the drawing pass alone
  int base = -1;       ///< variant that its time is compared with, in the same rounds
  int added = 0;       ///< layers more than the base has, where the cost of one is asked for
};

struct BenchFactor {
  std::string name;     ///< as for --factor
  std::string heading;  ///< of the varied quantity
  std::vector<BenchVariant> variants;
};

std::vector<BenchFactor> benchFactors();

}  // namespace pitviper
