#pragma once
// What became of the promise over many scenarios: a line per cell for machines, a table for readers.
#include <string>
#include <vector>

#include "tests/promise/promise_scene.hpp"

namespace pitviper::test {

std::string promiseCsvHeading();
std::string promiseCsv(const PromiseScene& scene);

/// Over the cells of one accuracy.
struct PromiseFigures {
  double asked = 0.0;
  int cells = 0, scenes = 0;
  double median = 0.0, percentile99 = 0.0, worst = 0.0;  ///< of found / asked
  double held = 0.0;                                     ///< share of cells with found <= asked
  double foreseen = 0.0;                                 ///< share of cells with predicted >= found
  double margin = 0.0;                                   ///< median of predicted / found, or a twentieth of what is asked where that is more
};
/// One per accuracy, coarse ones first.
std::vector<PromiseFigures> promiseFigures(const std::vector<PromiseCell>& cells);

/// Markdown.
std::string promiseTable(const std::vector<PromiseFigures>& figures);

}  // namespace pitviper::test
