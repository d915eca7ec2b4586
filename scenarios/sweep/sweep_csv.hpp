#pragma once
// Results of a sweep as a table that any program reads.
#include <string>
#include <vector>

#include "scenarios/sweep/sweep_identity.hpp"

namespace pitviper {

/// A number in as few digits as bring back the same double; a NaN is empty, infinities are "inf" and "-inf".
std::string numberThatReadsBack(double value);

/// "sample,seed,range [km],...,snr [1],why" and a line for each row, by sample, whatever order they come in. Choices are words, without a unit in the header.
std::string csvOf(const SweepIdentity& identity, std::vector<SweepRow> rows);

}  // namespace pitviper
