#include "scenarios/commands/guard_bench.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "scenarios/commands/bench_timing.hpp"
#include "scenarios/commands/first_bench.hpp"
#include "scenarios/commands/process.hpp"
#include "sim/gl/context.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Of the machine that seconds are told for: pixels of the yardstick a second, on two processors.
constexpr double kNominalRate = 6e6, kNominalProcessors = 2.0;
constexpr double kYardstickPixels = Yardstick::kSize_px * Yardstick::kSize_px;
/// Each takes some seconds.
constexpr int kFramesOfBench = 20;
/// The same ones on every machine: what a driver compiles in them counts.
constexpr int kFramesOfScenario = 20;
constexpr double kMostOfFrames_s = 120.0;

FigureKind kindOf(const std::string& figure) {
  for (const FigureName& f : firstFigureNames())
    if (figure == f.name) return f.kind;
  return FigureKind::Count;
}

/// A figure as the file has it; nothing where there is no yardstick for it.
std::optional<double> byYardstick(const FirstFigures& figures, const std::string& figure) {
  const auto find = [&](const std::string& name) {
    const auto found = figures.find(name);
    return found == figures.end() ? std::optional<double>() : found->second;
  };
  const auto value = find(figure), wall_ms = find("yardstick"), work_s = find("yardstick_work");
  if (!value) return std::nullopt;
  switch (kindOf(figure)) {
    case FigureKind::Seconds:
      return wall_ms ? std::optional(*value * kYardstickPixels / kNominalRate / (1e-3 * *wall_ms)) : std::nullopt;
    case FigureKind::Work:
      return work_s ? std::optional(*value * kNominalProcessors * kYardstickPixels / kNominalRate / *work_s) : std::nullopt;
    case FigureKind::Frame:
      return wall_ms ? std::optional(*value / *wall_ms) : std::nullopt;
    case FigureKind::Count:
      break;
  }
  return value;
}

class Measured {
 public:
  explicit Measured(const std::vector<GuardLine>& lines, const std::function<void(const std::string&)>& next) : lines_(lines), next_(next) {}

  GuardResult of(const GuardLine& line) {
    if (line.subject == GuardSubject::Folder) return {line, static_cast<double>(codeLines(line.path)), ""};
    if (line.subject == GuardSubject::Bench) return {line, bench(line), ""};
    for (const FirstState& state : scenario(line.path)) {
      if (state.name != line.state) continue;
      if (!state.measured) return {line, std::nullopt, state.words};
      const auto now = byYardstick(state.figures, line.figure);
      return {line, now, now ? "" : "pictures are not drawn by this processor, so there is no yardstick for its seconds"};
    }
    return {line, std::nullopt, "it was not measured"};
  }

 private:
  const std::vector<FirstState>& scenario(const std::filesystem::path& file) {
    if (const auto known = scenarios_.find(file); known != scenarios_.end()) return known->second;
    FirstRequest request;
    for (const GuardLine& l : lines_)
      if (l.path == file) request.states.push_back(l.state);
    request.once.scenario.file = file.string(), request.once.frames = kFramesOfScenario, request.once.most_s = kMostOfFrames_s;
    return scenarios_[file] = measureFirst(request, [&](const std::string& state) { next_(file.filename().string() + ", " + state); });
  }

  double bench(const GuardLine& line) {
    const std::string factor = line.state.substr(0, line.state.find('/'));
    if (!rows_.count(factor)) {
      next_("bench, " + factor);
      if (!context_) context_ = std::make_unique<GlContext>(), yardstick_ = std::make_unique<Yardstick>();
      for (const BenchFactor& f : benchFactors()) {
        if (f.name != factor) continue;
        Progress quiet("bench", 1, {}, [](const std::string&) {});
        rows_[factor] = timeFactor(f, kFramesOfBench, *yardstick_, quiet);
      }
    }
    for (const BenchRow& row : rows_[factor])
      if (line.state == factor + "/" + row.variant.value + "/" + row.variant.mode) return 1.0 / row.rateByYardstick;
    return 0.0;
  }

  const std::vector<GuardLine>& lines_;
  const std::function<void(const std::string&)>& next_;
  std::map<std::filesystem::path, std::vector<FirstState>> scenarios_;
  std::map<std::string, std::vector<BenchRow>> rows_;
  std::unique_ptr<GlContext> context_;
  std::unique_ptr<Yardstick> yardstick_;
};

std::string change(const GuardResult& r) { return r.line.value > 0.0 ? print("%+.0f %%", 100.0 * (*r.now / r.line.value - 1.0)) : print("from 0"); }

std::string named(const char* what, const GuardResult& r) {
  return print("%s: %s: %.4g, %.4g in the file (%s): %s\n", what, r.line.label().c_str(), *r.now, r.line.value, change(r).c_str(), r.line.reason.c_str());
}

}  // namespace

std::vector<GuardResult> measureGuard(const std::vector<GuardLine>& lines, const std::function<void(const std::string&)>& next) {
  Measured measured(lines, next);
  std::vector<GuardResult> results;
  for (const GuardLine& line : lines) results.push_back(measured.of(line));
  return results;
}

long codeLines(const std::filesystem::path& folder) {
  long lines = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto kind = entry.path().extension();
    if (!entry.is_regular_file() || (kind != ".cpp" && kind != ".hpp" && kind != ".glsl")) continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) lines += line.find_first_not_of(" \t\r") != std::string::npos;
  }
  return lines;
}

bool hasGrown(const GuardResult& r) { return r.now && *r.now > (1.0 + kGuarded) * r.line.value; }
bool hasShrunk(const GuardResult& r) { return r.now && *r.now < (1.0 - kGuarded) * r.line.value; }

std::string guardText(const std::vector<GuardResult>& results, const std::string& file) {
  std::string table = "| of | state | figure | in the file | now | change |\n|---|---|---|---|---|---|\n", grown, shrunk, missing;
  int counts[3] = {0, 0, 0};
  for (const GuardResult& r : results) {
    table += print("| %s | %s | %s | %.6g | ", r.line.name.c_str(), r.line.state.c_str(), r.line.figure.c_str(), r.line.value);
    table += r.now ? print("%.6g | %s |\n", *r.now, change(r).c_str()) : std::string("- | |\n");
    if (hasGrown(r)) grown += named("grown", r), ++counts[0];
    if (hasShrunk(r)) shrunk += named("better, write it down", r), ++counts[1];
    if (!r.now) missing += "not measured: " + r.line.label() + ": " + r.why + "\n", ++counts[2];
  }
  return table + "\n" + grown + missing + shrunk +
         print("%zu figures of %s: %d grown by more than a fifth, %d shrunk by more than a fifth, %d not measured\n", results.size(), file.c_str(), counts[0],
               counts[1], counts[2]);
}

namespace {

struct GuardWish {
  bool quick = false, strict = false;
};

int guard(const GuardWish& w, const std::string& file) {
  std::vector<GuardLine> lines = readGuardFile(file);
  if (w.quick) std::erase_if(lines, [](const GuardLine& l) { return !l.quick; });
  if (lines.empty())
    throw UserError({file, 0, 0, -1}, w.quick ? "there is no figure of the set 'quick'" : "there is no figure",
                    "a line each: set, subject, state, figure, value, reason", "add one");
  Progress progress("bench", 0);
  std::vector<GuardResult> results;
  try {
    results = measureGuard(lines, [&](const std::string& what) { progress.phase(what); });
  } catch (const FirstFailure& failure) {
    progress.withdraw();
    tell(failure.what());
    return failure.code();
  }
  progress.withdraw();
  std::fputs(guardText(results, file).c_str(), stdout);
  const bool broken = std::any_of(results.begin(), results.end(), [](const GuardResult& r) { return hasGrown(r); });
  return w.strict && broken ? 1 : 0;
}

}  // namespace

CommandLine guardBenchCommand() {
  const auto w = std::make_shared<GuardWish>();
  return {{"bench --guard", "FILE.csv"},
          "Measures again the figures that FILE holds (tests/bench_guard.csv says how it is written) and names each that grew, or shrank, by more than a "
          "fifth. Seconds are told as where the yardstick gives 6 million pixels a second, so that machines compare. Exit code 0 whatever grew.",
          {{"--quick", "", "the set 'quick' alone: under a minute", into(w->quick)},
           {"--strict", "", "exit code 1 where a figure grew by more than a fifth", into(w->strict)}},
          [w](const Arguments& words) { return guard(*w, words[0]); }};
}

}  // namespace pitviper
