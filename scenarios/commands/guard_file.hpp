#pragma once
// Figures that are held against: what the program took when a line was written, and why it may.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// What a line's subject is, by which its figure is found.
enum class GuardSubject {
  Scenario,  ///< a scenario's file
  Bench,     ///< the word "bench": a row of `bench`, its state is factor/value/mode
  Folder     ///< a folder of sources
};

struct GuardLine {
  Location where;
  bool quick = false;  ///< also of --quick
  GuardSubject subject = GuardSubject::Scenario;
  std::string name;             ///< of the subject, as written
  std::filesystem::path path;   ///< where it lies: found from the file's own folder
  std::string state, figure;
  double value = 0.0;
  std::string reason;
  std::string label() const { return name + ", " + (state.empty() ? "" : state + ", ") + figure; }
};

inline constexpr const char *kBenchSubject = "bench", *kLinesFigure = "lines", *kByYardstickFigure = "by_yardstick";

/// Lines of "set, subject, state, figure, value, reason"; the reason may hold commas, and must say something. Empty lines and those that begin with # are none.
/// Errors: UserError with the place of what is not as expected.
std::vector<GuardLine> readGuardFile(const std::filesystem::path& file);

}  // namespace pitviper
