#pragma once
// A scenario from nothing cached, a second time, and after each of a few changes: every time by a process of its own.
#include <functional>
#include <stdexcept>

#include "scenarios/commands/first_once.hpp"

namespace pitviper {

struct FirstState {
  std::string name;   ///< "first", "second", or that of a change
  std::string words;  ///< what was changed, or why this was not measured
  bool measured = false;
  FirstFigures figures;
};

struct FirstRequest {
  OnceRequest once;                 ///< of each state
  std::vector<std::string> states;  ///< to measure besides "first"; in any order
};

/// "first", "second" and the names of all changes.
std::vector<std::string> firstStateNames();

/// A process that was to measure said why it could not.
class FirstFailure : public std::runtime_error {
 public:
  FirstFailure(const std::string& why, int code) : std::runtime_error(why), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

/// In the order of firstStateNames(). Every change is measured with what "first" and "second" have cached, and nothing of other changes. A change that the
/// scenario cannot have, or cannot be drawn with, is not measured and says so. `next`: told the name of each state before it begins. Errors: FirstFailure;
/// UserError as of reading.
std::vector<FirstState> measureFirst(const FirstRequest& request, const std::function<void(const std::string&)>& next);

}  // namespace pitviper
