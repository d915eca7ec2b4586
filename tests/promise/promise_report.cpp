#include "tests/promise/promise_report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "scenarios/commands/accuracy_error.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {

std::string promiseCsvHeading() {
  return "seed,channel,asked,predicted,of it wavelengths,of it tables,extremes,found,groups,wavelengths,worst frame,worst column,worst row,planned "
         "there,reference "
         "there,pixels,below 0,"
         "reference [s],planned [s]\n";
}

std::string promiseCsv(const PromiseScene& scene) {
  std::string out;
  for (const PromiseCell& c : scene.cells)
    out +=
        print("%llu,%s,%g,%.4g,%.4g,%.4g,%.4g,%.4g,%d,%d,%d,%d,%d,%.6g,%.6g,%d,%d,%.2f,%.2f\n", static_cast<unsigned long long>(c.seed), c.channel.c_str(),
              c.asked, c.predicted, c.ofWavelengths, c.ofTables, c.extremes, c.found, c.groups, c.wavelengths, c.worst.frame, c.worst.column, c.worst.row,
              c.worst.planned, c.worst.reference, scene.pixels, scene.negative, scene.reference_s, scene.planned_s);
  return out;
}

std::vector<PromiseFigures> promiseFigures(const std::vector<PromiseCell>& cells) {
  std::map<double, std::vector<PromiseCell>, std::greater<>> byAccuracy;
  for (const PromiseCell& c : cells) byAccuracy[c.asked].push_back(c);
  std::vector<PromiseFigures> all;
  for (const auto& [asked, own] : byAccuracy) {
    PromiseFigures f;
    f.asked = asked;
    f.cells = static_cast<int>(own.size());
    std::set<std::uint64_t> scenes;
    std::vector<double> found, margin;
    int held = 0, foreseen = 0;
    for (const PromiseCell& c : own) {
      scenes.insert(c.seed);
      found.push_back(c.found / asked);
      held += c.found <= asked;
      foreseen += c.predicted >= c.found;
      // Nothing to be off by: whatever is predicted is no margin. Next to nothing is a twentieth of what is asked.
      if (c.found > 0.0) margin.push_back(c.predicted / std::max(c.found, 0.05 * c.asked));
    }
    f.scenes = static_cast<int>(scenes.size());
    const ErrorFigures figures = figuresOf(found);
    f.median = figures.median, f.percentile99 = figures.percentile99, f.worst = figures.maximum;
    f.held = static_cast<double>(held) / f.cells;
    f.foreseen = static_cast<double>(foreseen) / f.cells;
    f.margin = figuresOf(margin).median;
    all.push_back(f);
  }
  return all;
}

std::string promiseTable(const std::vector<PromiseFigures>& figures) {
  std::string out =
      "| asked | scenes | cells | found / asked: median | 99th percentile | worst | found within asked | found within predicted | predicted / found, median |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const PromiseFigures& f : figures)
    out += print("| %g %% | %d | %d | %.2g | %.3g | %.3g | %.4g %% | %.4g %% | %.2g |\n", 100.0 * f.asked, f.scenes, f.cells, f.median, f.percentile99, f.worst,
                 100.0 * f.held, 100.0 * f.foreseen, f.margin);
  return out;
}

}  // namespace pitviper::test
