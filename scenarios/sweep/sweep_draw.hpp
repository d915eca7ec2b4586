#pragma once
// The samples of a sweep from its design, one by one.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/sweep/distribution.hpp"
#include "scenarios/sweep/factor_values.hpp"
#include "scenarios/sweep/sample_design.hpp"
#include "sim/parameters/csv_table.hpp"

namespace pitviper {

/// A path of the scenario and its value, in which factors may stand.
using SetByPath = std::pair<std::string, Value>;

class SweepDraw {
 public:
  /// `design` gives the points, or `table` the values where it has no design: columns by factor are `columns`.
  struct Plan {
    std::uint64_t seed = 0;
    std::vector<SweepFactor> factors;
    std::vector<Distribution> distributions;  ///< by factor, of a design
    std::vector<SetByPath> sets;              ///< of each sample
    std::vector<Constraint> constraints;
    std::unique_ptr<const SampleDesign> design;
    CsvTable table;
    std::vector<std::size_t> columns;
    bool drawnAgain = false;  ///< a point that breaks a constraint: another in its place, as independent points allow
  };
  explicit SweepDraw(Plan plan) : plan_(std::move(plan)) {}

  /// Points of the design, those that break constraints among them.
  long long size() const;
  /// The sample of a point, by its number; nothing where it breaks a constraint and is left out. Errors: UserError where kMostTries draws in a row do, where
  /// an expression cannot be worked out, and for a place of a choice that there is not.
  std::optional<Sample> sample(int number) const;

  /// The same with one factor at a value of its own: the others are drawn as ever, once. Nothing where that breaks a constraint.
  std::optional<Sample> sampleAt(int number, std::size_t factor, double value) const;
  /// What a factor is drawn from; null where a table has its values.
  const Distribution* distributionOf(std::size_t factor) const { return plan_.design ? &plan_.distributions[factor] : nullptr; }

  static constexpr int kMostTries = 1000;

 private:
  std::vector<double> values(int number, int attempt) const;
  std::vector<double> valuesOfRow(int number) const;
  void setBy(Sample& sample) const;
  const Constraint* broken(const DrawnFactors& drawn) const;
  Plan plan_;
};

}  // namespace pitviper
