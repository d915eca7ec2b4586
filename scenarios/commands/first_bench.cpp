#include "scenarios/commands/first_bench.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <sstream>

#include "scenarios/commands/child_run.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/commands/scenario_changes.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

constexpr const char *kNow = "now", *kMarked = "marked";

void copyAll(const fs::path& from, const fs::path& to) {
  fs::remove_all(to);
  fs::copy(from, to, fs::copy_options::recursive);
}

/// A folder for what a program keeps between runs, which nothing else has filled: this program's own plans, tables and meshes, and the driver's programs.
class OwnCache {
 public:
  /// In the folder for temporary files. Errors: OutputError.
  OwnCache() {
    std::string name = (fs::temp_directory_path() / "pitviper_cache_XXXXXX").string();
    if (!::mkdtemp(name.data())) throw OutputError(name, "cannot make a folder for what is kept between runs", errno);
    folder_ = name;
    fs::create_directories(folder_ / kNow);
  }
  ~OwnCache() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  OwnCache(const OwnCache&) = delete;
  OwnCache& operator=(const OwnCache&) = delete;

  /// What a process needs to know to keep its things there.
  std::map<std::string, std::string> environment() const {
    const std::string now = (folder_ / kNow).string();
    return {{"XDG_CACHE_HOME", now}, {"MESA_SHADER_CACHE_DIR", now}, {"MESA_GLSL_CACHE_DIR", now}, {"__GL_SHADER_DISK_CACHE_PATH", now}};
  }
  /// Files in which the driver keeps programs.
  std::size_t driverFiles() const {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / kNow))
      if (entry.is_regular_file() && entry.path().filename() != "index" && entry.path().parent_path().filename() != "pitviper") ++count;
    return count;
  }
  /// Notes what is in it; back() makes it so again.
  void mark() { copyAll(folder_ / kNow, folder_ / kMarked); }
  void back() { copyAll(folder_ / kMarked, folder_ / kNow); }

 private:
  fs::path folder_;
};

constexpr int kEndedBySignals = 128;

/// What a process said that is no figure.
std::string otherWords(const std::string& output) {
  std::istringstream in(output);
  std::string words;
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with("figure ") && !line.empty()) words += (words.empty() ? "" : "\n") + line;
  return words;
}

class Measuring {
 public:
  explicit Measuring(const OnceRequest& request) : request_(request) {}

  FirstFigures measure(const std::vector<std::string>& sets) {
    const auto& [scenario, frames, most_s] = request_;
    Arguments arguments{"bench", "--once", scenario.file, "--frames", std::to_string(frames), "--seconds", print("%.9g", most_s)};
    for (const std::vector<std::string>& all : {scenario.changes, sets})
      for (const std::string& set : all) arguments.insert(arguments.end(), {"--set", set});
    for (const auto& root : scenario.roots) arguments.insert(arguments.end(), {"--root", root.string()});
    const std::size_t before = cache_.driverFiles();
    const ChildResult result = runChild(arguments, cache_.environment());
    const std::string words = otherWords(result.output);
    if (result.code != 0) throw FirstFailure(words.empty() ? scenario.file + ": its process ended with " + std::to_string(result.code) : words, result.code);
    if (!words.empty() && words != said_) tell((said_ = words).c_str());
    FirstFigures figures = readFigures(result.output);
    figures["compiled"] = static_cast<double>(cache_.driverFiles()) - static_cast<double>(before);
    return figures;
  }
  void mark() { cache_.mark(); }
  void back() { cache_.back(); }

 private:
  const OnceRequest& request_;
  OwnCache cache_;
  std::string said_;
};

}  // namespace

std::vector<std::string> firstStateNames() {
  std::vector<std::string> names{"first", "second"};
  names.insert(names.end(), scenarioChangeNames().begin(), scenarioChangeNames().end());
  return names;
}

std::vector<FirstState> measureFirst(const FirstRequest& request, const std::function<void(const std::string&)>& next) {
  const auto wanted = [&](const std::string& state) { return std::find(request.states.begin(), request.states.end(), state) != request.states.end(); };
  Measuring measuring(request.once);
  std::vector<FirstState> states;
  next("first");
  states.push_back({"first", "nothing cached", true, measuring.measure({})});
  if (wanted("second")) {
    next("second");
    states.push_back({"second", "the same again", true, measuring.measure({})});
  }
  measuring.mark();
  const auto& names = scenarioChangeNames();
  if (std::none_of(names.begin(), names.end(), wanted)) return states;
  for (const ScenarioChange& change : changesOf(request.once.scenario)) {
    if (!wanted(change.name)) continue;
    FirstState state{change.name, change.words, false, {}};
    next(change.name);
    if (!change.sets.empty()) {
      measuring.back();
      try {
        state.figures = measuring.measure(change.sets);
        state.measured = true;
      } catch (const FirstFailure& failure) {
        if (failure.code() >= kEndedBySignals) throw;
        state.words += ": " + std::string(failure.what());
      }
    }
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace pitviper
