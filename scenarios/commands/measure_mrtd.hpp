#pragma once
// What an observer resolves through a camera on the bench, by its design and by its pictures.
#include "scenarios/commands/measure_bench.hpp"

namespace pitviper {

/// Adds the MRTD over frequency to what a bench found, by its design and by its pictures: figures, a chart, and who looks at what.
void tellResolvable(BenchResult& result);

}  // namespace pitviper
