#pragma once
// Whose results are whose: what a sweep is known by, and the columns that its results have.
#include <string>
#include <vector>

#include "scenarios/sweep/sweep.hpp"

namespace pitviper {

struct SweepIdentity {
  std::string name, sha256, scenario, version;
  int samples = 0;
  std::vector<SweepFactor> factors;
  std::vector<Measure> measures;
};

struct MeasureColumn {
  std::string name, unit;
};

/// All columns of all measures, in the order of SweepRow::measures. A unit that is not known yet is empty.
std::vector<MeasureColumn> measureColumns(const SweepIdentity& identity);

/// Gives the columns units, in their order; those that are empty change nothing. std::invalid_argument where there are more or fewer than columns.
void setMeasureUnits(SweepIdentity& identity, const std::vector<std::string>& units);

/// The word of a choice. std::invalid_argument where `value` is none of its places.
const std::string& choiceWord(const SweepFactor& choice, double value);

/// Factors and measures must make a table: names that differ (but for upper and lower case) from each other and from sample, seed and why, of printable
/// characters; choices of words that differ; 1900 columns at most. Errors: UserError at the measure's place, or at `file`.
void refuseUnfitNames(const SweepIdentity& identity, const std::string& file);

}  // namespace pitviper
