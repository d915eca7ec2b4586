#pragma once
#include "scenarios/commands/measure_bench.hpp"

namespace pitviper {

/// Adds the MRTD over frequency to what a bench found, by its design and by its pictures: figures, a chart, and who looks at what.
void tellResolvable(BenchResult& result);

}  // namespace pitviper
