#include <algorithm>
#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/first_bench.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

struct FirstRow {
  std::string scenario;  ///< its file
  std::vector<FirstState> states;
};

/// Empty where there is no such figure.
std::string figure(const FirstState& state, const std::string& name, const char* format) {
  const auto found = state.figures.find(name);
  return found == state.figures.end() ? "" : print(format, found->second);
}

/// Of the clock, and of all processors together.
std::string seconds(const FirstState& state, const std::string& name) {
  return figure(state, name, "%.2f") + " (" + figure(state, name + "_work", "%.2f") + ")";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) out += c == '"' ? "\"\"" : c == '\n' ? " " : std::string(1, c);
  return out + "\"";
}

std::string shortName(const std::string& scenario) { return std::filesystem::path(scenario).stem().string(); }

/// A row a state: where the time to the first picture went, and what the pictures after it took.
std::string firstTable(const FirstRow& row) {
  std::string out = shortName(row.scenario) + ": s, in brackets processor s\n";
  out +=
      "| state | reading | planning | tables | programs | first frame | to a picture | programs: made, lines, compiled | groups | frame ms: 50 %, 99 %, most "
      "(which of) | of it the processor's own | MB | yardstick ms |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::string changes;
  for (const FirstState& s : row.states) {
    if (s.name != "first" && s.name != "second") changes += "  " + s.name + ": " + s.words + (s.measured ? "" : "; left out") + "\n";
    if (!s.measured) continue;
    out += "| " + s.name + " |";
    for (const char* stage : {"reading", "planning", "tables", "programs", "first_frame", "picture"}) out += " " + seconds(s, stage) + " |";
    out += " " + figure(s, "programs_made", "%.0f") + ", " + figure(s, "program_lines", "%.0f") + ", " + figure(s, "compiled", "%.0f") + " | " +
           figure(s, "groups", "%.0f") + " | " + figure(s, "frame_50", "%.1f") + ", " + figure(s, "frame_99", "%.1f") + ", " + figure(s, "frame_most", "%.1f") +
           " (" + figure(s, "frame_most_at", "%.0f of ") + figure(s, "frames", "%.0f") + ") | " + figure(s, "frame_own", "%.1f") + " | " +
           figure(s, "memory", "%.0f") + " | " + figure(s, "yardstick", "%.1f") + " |\n";
  }
  return out + changes;
}

/// A row a scenario, a column a state: seconds to the first picture.
std::string firstSummary(const std::vector<FirstRow>& rows, const std::vector<std::string>& states) {
  std::string out = "Seconds to a picture, in brackets processor seconds\n| scenario |", line = "\n|---|";
  for (const std::string& state : states) out += " " + state + " |", line += "---|";
  out += " planning of first | MB |" + line + "---|---|\n";
  for (const FirstRow& row : rows) {
    out += "| " + shortName(row.scenario) + " |";
    for (const std::string& name : states) {
      const auto found = std::find_if(row.states.begin(), row.states.end(), [&](const FirstState& s) { return s.name == name && s.measured; });
      out += found == row.states.end() ? " - |" : " " + seconds(*found, "picture") + " |";
    }
    out += " " + seconds(row.states.front(), "planning") + " | " + figure(row.states.front(), "memory", "%.0f") + " |\n";
  }
  return out;
}

/// A line a state, a column a figure.
std::string firstCsv(const std::vector<FirstRow>& rows) {
  std::string out = "scenario,state,words";
  for (const FigureName& f : firstFigureNames()) out += std::string(",") + f.name;
  out += "\n";
  for (const FirstRow& row : rows)
    for (const FirstState& s : row.states) {
      out += quoted(row.scenario) + "," + s.name + "," + quoted(s.words);
      for (const FigureName& f : firstFigureNames()) out += "," + figure(s, f.name, "%.6g");
      out += "\n";
    }
  return out;
}

/// --frames, --seconds, --set and --root.
std::vector<Option> onceOptions(OnceRequest& r) {
  return joined(
      {{"--frames", "N", "after the first, at most", number(r.frames, {0, 100000, "", false, "not a number of frames after the first"})},
       {"--seconds", "S", "that they may take in each state: fewer of slow ones", number(r.most_s, {0.0, 1e9, "s", true, "not a time that frames may take"})}},
      scenarioOptions(r.scenario));
}

std::vector<std::string> shippedScenarios() {
  const std::filesystem::path folder = findLibraries().materials.parent_path().parent_path() / "scenarios";
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") all.push_back(entry.path().string());
  std::sort(all.begin(), all.end());
  return all;
}

struct FirstWish {
  FirstRequest request;
  std::string out;
};

int first(FirstWish& w, std::vector<std::string> scenarios) {
  FirstRequest& request = w.request;
  const std::vector<std::string> all = firstStateNames();
  std::vector<std::string> states;  // in their order
  for (const std::string& name : all)
    if (name == "first" || request.states.empty() || std::find(request.states.begin(), request.states.end(), name) != request.states.end())
      states.push_back(name);
  request.states = states;
  if (scenarios.empty()) scenarios = shippedScenarios();
  const std::filesystem::path out = w.out;
  if (!out.empty()) ensureWritableFolder(out);
  std::vector<FirstRow> rows;
  int code = 0;
  for (const std::string& scenario : scenarios) {
    Progress progress("bench", static_cast<int>(states.size()));
    bool begun = false;
    try {
      request.once.scenario.file = scenario;
      rows.push_back({scenario, measureFirst(request, [&](const std::string& state) {
                        if (begun) progress.step();
                        begun = true;
                        progress.phase(scenario + ", " + state);
                      })});
    } catch (const FirstFailure& failure) {
      progress.withdraw();
      tell(failure.what());
      if (failure.code() >= 128) return failure.code();
      code = std::max(code, failure.code());
      continue;
    }
    progress.withdraw();
    std::printf("%s\n", firstTable(rows.back()).c_str());
    std::fflush(stdout);
    if (!out.empty()) writeFileAtomically(out / "first.csv", firstCsv(rows));  // after each: what ends it takes nothing that was measured
  }
  if (rows.size() > 1) std::printf("%s\n", firstSummary(rows, states).c_str());
  if (!out.empty() && !rows.empty()) std::printf("%s written\n", (out / "first.csv").string().c_str());
  return code;
}

}  // namespace

CommandLine onceBenchCommand() {
  const auto w = std::make_shared<OnceRequest>();
  return {{"bench --once", "SCENARIO.yaml"},
          "One state of bench --first by itself, with what is cached now, a figure a line.",
          onceOptions(*w),
          [w](const Arguments& words) {
            w->scenario.file = words[0];
            std::fputs(writeFigures(measureOnce(*w)).c_str(), stdout);
            return 0;
          }};
}

CommandLine firstBenchCommand() {
  const auto w = std::make_shared<FirstWish>();
  return {{"bench --first", "[SCENARIO.yaml]..."},
          "How long one waits for a picture. Each scenario (without one: all that are shipped) from nothing cached, a second time, and after each of six "
          "changes, with what the first two have cached: a body 10 K warmer, another visibility, field of view, position, material, half the accuracy's error. "
          "A process of its own for each state, and a cache of their own. A change that a scenario cannot have is left out, and said. Prints seconds by the "
          "clock and processor seconds of reading, planning, tables (all other preparing), programs (made, lines, and files that the driver's cache gained: 0 "
          "where it compiled nothing) and the first frame of every camera; percentiles of the frames after it, drawn and read back one after the other, and "
          "the processor's own time of one, with no drawing, from "
          "the first again where the scenario has fewer (not with a gimbal); memory. Spectral images, probes, audits and files are left out.",
          joined({{"--states", "A,B", "these alone, besides 'first'", someOf(w->request.states, firstStateNames(), "state")},
                  {"--out", "FOLDER", "also write first.csv, a line a state, with all figures", into(w->out)}},
                 onceOptions(w->request.once)),
          [w](const Arguments& words) { return first(*w, words); }};
}

}  // namespace pitviper
