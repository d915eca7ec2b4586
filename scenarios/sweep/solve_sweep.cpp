#include "scenarios/sweep/solve_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "scenarios/commands/progress.hpp"
#include "scenarios/sweep/goal.hpp"
#include "scenarios/sweep/sample_drawer.hpp"
#include "scenarios/sweep/solve.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

/// The ends of what a factor is drawn from, where that has ends.
constexpr double kEnd = 1e-12;

std::size_t factorNamed(const Sweep& sweep, const std::string& name) {
  std::vector<std::string> names;
  for (const SweepFactor& f : sweep.factors) names.push_back(f.name);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) throw unknownWord({"--over " + name, 0, 0, -1}, "the sweep has no factor", name, names);
  return static_cast<std::size_t>(at - names.begin());
}

std::size_t columnNamed(const Sweep& sweep, const std::string& name, const std::string& goal) {
  std::vector<std::string> names;
  for (const Measure& m : sweep.measures) names.insert(names.end(), m.names.begin(), m.names.end());
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) throw unknownWord({"--solve " + goal, 0, 0, -1}, "the sweep has no measure", name, names);
  return static_cast<std::size_t>(at - names.begin());
}

}  // namespace

int solveSweep(const Sweep& sweep, const std::vector<std::filesystem::path>& roots, const SweepGoal& wanted) {
  const Location where{"--solve '" + wanted.goal + "'", 0, 0, -1};
  const Goal goal = parseGoal(wanted.goal, where);
  const std::size_t factor = factorNamed(sweep, wanted.factor), column = columnNamed(sweep, goal.measure, wanted.goal);
  const SweepFactor& varied = sweep.factors[factor];
  const Distribution* drawnFrom = sweep.draw->distributionOf(factor);
  if (!drawnFrom || !varied.choices.empty())
    throw UserError({"--over " + wanted.factor, 0, 0, -1}, "it has no range", "a factor that is uniform, log_uniform or normal 'within'", "give it one");
  SampleDrawer drawer(sweep, roots);
  drawer.prepare();
  SolveWish wish;
  wish.target = goal.value;
  wish.low = drawnFrom->quantile(kEnd), wish.high = drawnFrom->quantile(1.0 - kEnd);
  wish.logarithmic = drawnFrom->isLogarithmic();
  wish.repeats = wanted.repeats;
  wish.seed = static_cast<std::uint64_t>(sweep.seed);
  wish.factor = varied.name, wish.measure = goal.measure;
  wish.where = where;
  Progress progress("solving " + goal.measure, 0);
  progress.phase("preparing");
  int draws = 0;
  std::map<std::uint64_t, int> numbers;  // a draw of all else for each seed
  const auto measure = [&](double x, std::uint64_t seed) {
    const int number = numbers.try_emplace(seed, static_cast<int>(numbers.size())).first->second;
    std::optional<Sample> sample = sweep.draw->sampleAt(number % static_cast<int>(std::max(1ll, sweep.draw->size())), factor, x);
    if (!sample)
      throw UserError(where, "a constraint of the sweep keeps " + varied.name + " from a value that is tried", "constraints that hold over its range",
                      "leave them out, or narrow the range");
    sample->seed = seed;
    const DrawnSample drawn = drawer.draw(*sample, false);
    if (!drawn.row.why.empty()) throw UserError(where, drawn.row.why);
    progress.phase(std::to_string(++draws) + " pictures");
    return drawn.row.measures[column];
  };
  const Solution found = solve(measure, wish);
  progress.withdraw();
  const std::string unit = varied.unit.empty() ? "" : " " + varied.unit, unitOfMeasure = drawer.units()[column].empty() ? "" : " " + drawer.units()[column];
  std::printf("%-24s %-28s repeats\n", (varied.name + (varied.unit.empty() ? "" : " [" + varied.unit + "]")).c_str(),
              (goal.measure + " (mean, its error)").c_str());
  for (const SolveTry& t : found.tried) std::printf("%-24.9g %-14.6g %-13.3g %d\n", t.x, t.mean, t.standardError, t.repeats);
  std::printf("%s = %.6g%s at %s = %.6g%s, %s %.6g to %.6g%s (%d pictures)\n", goal.measure.c_str(), goal.value, unitOfMeasure.c_str(), varied.name.c_str(),
              found.x, unit.c_str(), found.isNoisy ? "in 95 of 100 cases within" : "between", found.low95, found.high95, unit.c_str(), found.evaluations);
  return 0;
}

}  // namespace pitviper
