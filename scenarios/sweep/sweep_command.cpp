#include "scenarios/sweep/sweep_command.hpp"

#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <thread>

#include "scenarios/commands/child_run.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/scenario_wish.hpp"
#include "scenarios/sweep/sample_drawer.hpp"
#include "scenarios/sweep/slurm_job.hpp"
#include "scenarios/sweep/solve_sweep.hpp"
#include "scenarios/sweep/sweep_folder.hpp"
#include "scenarios/sweep/sweep_identity.hpp"
#include "sim/frame/file_formats.hpp"
#include "sim/parameters/print.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

struct SweepWish {
  ScenarioWish scenario;  ///< its roots; `file` is the sweep's
  std::string out, part, share, goal, factor;
  std::vector<std::string> slurmOptions;
  int workers = 0, parts = 0, repeats = 16;
  bool merge = false, slurm = false;
};

Location ofOption(const std::string& option) { return {option, 0, 0, -1}; }

int processors() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

/// Words of the command line that every process of the sweep has.
Arguments carriedWords(const SweepWish& w) {
  Arguments words;
  for (const auto& root : w.scenario.roots) words.insert(words.end(), {"--root", std::filesystem::absolute(root).string()});
  return words;
}

/// Draws what a store does not have of a share of a part.
void drawShare(const SweepWish& w, const Sweep& sweep, SampleDrawer& drawer, SweepStore& store, const std::vector<const Sample*>& samples,
               const std::function<void()>& drawn) {
  const bool keeps = keepsFrames(sweep);
  if (!samples.empty()) drawer.prepare();
  if (keeps) ensureWritableFolder(std::filesystem::path(w.out) / "frames");
  FileOptions options;
  options.compression = ExrCompression::Zip;
  for (const Sample* s : samples) {
    const DrawnSample sample = drawer.draw(*s, keeps);
    if (keeps && sample.row.why.empty())
      for (const auto& f : sample.frames) writeExrFile(frameFileOf(w.out, f->camera, s->number), *f, options);
    store.learnUnits(drawer.units());
    store.put(sample.row);  // last: what is stored has its frames
    drawn();
  }
}

/// This process draws one share of what processes beside it draw too, into the same store.
int drawBeside(const SweepWish& w, const Sweep& sweep, const std::filesystem::path& file) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // who started it waits for it
  const PartChoice part = w.part.empty() ? PartChoice{} : readPartChoice(w.part, ofOption("--part " + w.part));
  const PartChoice share = readPartChoice(w.share, ofOption("--share " + w.share));
  SampleDrawer drawer(sweep, w.scenario.roots);
  SweepStore store(file, identityOf(sweep, drawer.simulation()));
  std::vector<const Sample*> own;
  for (const Sample* s : missingSamples(sweep, store, part))
    if (share.has(s->number / part.of)) own.push_back(s);
  drawShare(w, sweep, drawer, store, own, [] {});
  return 0;
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Processes that each draw a share. Errors: runtime_error or UserError with what one of them said.
void drawByProcesses(const SweepWish& w, const Sweep& sweep, const SweepStore& store, std::size_t before, int workers, Progress& progress) {
  std::vector<Arguments> all;
  for (int k = 0; k < workers; ++k) {
    Arguments words{"sweep", sweep.file, "--out", w.out, "--share", PartChoice{k, workers}.text()};
    if (!w.part.empty()) words.insert(words.end(), {"--part", w.part});
    const Arguments carried = carriedWords(w);
    words.insert(words.end(), carried.begin(), carried.end());
    all.push_back(std::move(words));
  }
  std::size_t seen = before;
  const auto look = [&] {
    const std::vector<char> done = store.done();
    const auto now = static_cast<std::size_t>(std::count(done.begin(), done.end(), 1));
    for (; seen < now; ++seen) progress.step();
  };
  // Pictures of small films gain nothing by more threads of one process.
  const std::vector<ChildResult> results = runChildren(all, {{"LP_NUM_THREADS", "1"}}, look);
  look();
  for (const ChildResult& r : results) {
    if (r.code == 2) throw UserError(ofOption(sweep.file), firstLine(r.output));
    if (r.code != 0) throw std::runtime_error("a process of the sweep ended with " + std::to_string(r.code) + ": " + firstLine(r.output));
  }
}

/// Lines on what is not as it was asked: errors expected beyond the accuracy, pictures beyond limits, measures without a number.
void tellDoubts(const SweepStore& store, const std::vector<SweepRow>& rows, const Simulation& sim) {
  double asked = 0.0;
  for (const Camera& c : sim.cameras) asked = std::max(asked, c.spectral.accuracy);
  const std::vector<MeasureColumn> columns = measureColumns(store.identity());
  int beyond = 0, outside = 0, firstOutside = -1;
  double worst = 0.0;
  std::vector<int> without(columns.size(), 0);
  int drawn = 0;
  for (const SweepRow& r : rows) {
    if (!r.why.empty()) continue;
    ++drawn;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      without[c] += std::isnan(r.measures[c]);
      if (columns[c].name == "predicted_error" && asked > 0.0 && r.measures[c] > asked) ++beyond, worst = std::max(worst, r.measures[c]);
      if (columns[c].name == "outside_limits" && r.measures[c] > 0.0 && outside++ == 0) firstOutside = r.sample;
    }
  }
  if (beyond > 0)
    std::printf("  %d of %d samples: their plans expect errors beyond the %.3g %% asked, up to %.3g %% (column predicted_error)\n", beyond, drawn,
                100.0 * asked, 100.0 * worst);
  if (outside > 0)
    std::printf(
        "  %d of %d samples show what is beyond the scenario's 'limits', the first of them sample %d (column outside_limits): what plans lose there is not "
        "known\n",
        outside, drawn, firstOutside);
  for (std::size_t c = 0; c + 2 < columns.size(); ++c)
    if (without[c] > 0)
      std::printf("  %s has no number in %d of %d samples: a target out of view has none, nor has the signal to noise of one whose pixels are full\n",
                  columns[c].name.c_str(), without[c], drawn);
}

/// What is stored, in words; the exit code.
int tellResults(const SweepWish& w, const Sweep& sweep, const SweepStore& store, const Simulation& sim, double seconds) {
  const std::vector<SweepRow> rows = store.rows();
  const auto failed = static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const SweepRow& r) { return !r.why.empty(); }));
  std::printf("%zu of %zu samples in %s, %.3g s: sweep.sqlite, sweep.csv, sweep.html\n", rows.size(), sweep.samples.size(), w.out.c_str(), seconds);
  if (failed > 0) {
    const auto first = std::find_if(rows.begin(), rows.end(), [](const SweepRow& r) { return !r.why.empty(); });
    std::printf("  %zu could not be drawn; sample %d: %s\n", failed, first->sample, first->why.c_str());
  }
  tellDoubts(store, rows, sim);
  return failed == rows.size() && failed > 0 ? 2 : 0;
}

int finish(const SweepWish& w, const Sweep& sweep, const SweepStore& store, const Simulation& sim, double seconds) {
  writeResults(w.out, sweep, store);
  if (!sweep.sinks.items.empty()) {
    Progress progress(sweep.name, 0);
    feedSinks(w.out, sweep, store, sim, [&](double share) { progress.phase("data set", share); });
    progress.finish();
  }
  return tellResults(w, sweep, store, sim, seconds);
}

/// Draws all of a part here, or of the whole sweep.
int draw(const SweepWish& w, const Sweep& sweep, const std::filesystem::path& file, const PartChoice& part) {
  const auto from = std::chrono::steady_clock::now();
  std::optional<SampleDrawer> drawer(std::in_place, sweep, w.scenario.roots);
  const Simulation sim = drawer->simulation();
  for (const Value& sink : sweep.sinks.items) readSink(sink, sim);  // its mistakes, before hours of drawing
  SweepStore store(file, identityOf(sweep, sim));
  const std::vector<const Sample*> missing = missingSamples(sweep, store, part);
  if (!sim.limits.any() && missing.size() > 1)
    tell(
        "note: the scenario has no 'limits', so that each sample has a plan of its own; write 'limits: {range: [500 m, 6 km], temperature: [250 K, 900 K]}' "
        "under 'set:' for one plan of many");
  const std::vector<char> done = store.done();
  const auto before = static_cast<std::size_t>(std::count(done.begin(), done.end(), 1));
  const int workers = std::min<int>(w.workers > 0 ? w.workers : processors(), static_cast<int>(missing.size()));
  Progress progress(sweep.name, static_cast<int>(missing.size()));
  progress.phase("preparing");
  if (workers > 1) {
    drawer.reset();
    drawByProcesses(w, sweep, store, before, workers, progress);
  } else if (!missing.empty()) {
    drawShare(w, sweep, *drawer, store, missing, [&] { progress.step(); });
  }
  progress.finish();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  if (part.of == 1) return finish(w, sweep, store, sim, seconds);
  std::printf("part %s of %s: %zu samples, %zu of them now, %.3g s\n", part.text().c_str(), sweep.name.c_str(), before + missing.size(), missing.size(),
              seconds);
  return 0;
}

Simulation scenarioOf(const SweepWish& w, const Sweep& sweep) {
  ScenarioWish scenario{sweep.scenario.string(), sweep.sets, w.scenario.roots};
  return scenario.read();
}

/// Parts that lie in the folder, of which none is of another division.
int merge(const SweepWish& w, const Sweep& sweep) {
  const Simulation sim = scenarioOf(w, sweep);
  const PartFiles parts = w.parts > 0 ? partFilesIn(w.out, w.parts) : partFilesIn(w.out);
  if (parts.files.empty())
    throw UserError(ofOption("--merge"), "no parts lie in " + (std::filesystem::path(w.out) / "parts").string(), "what --part K/N left there",
                    "draw them first, or name their folder by --out");
  std::vector<std::filesystem::path> files;
  for (const auto& [number, file] : parts.files) files.push_back(file);
  const std::filesystem::path file = std::filesystem::path(w.out) / "sweep.sqlite";
  mergeStores(file, identityOf(sweep, sim), files);
  const SweepStore store(file, identityOf(sweep, sim));
  const std::size_t missing = missingSamples(sweep, store, {}).size();
  for (int p = 0; p < parts.of; ++p)
    if (!parts.files.count(p)) std::printf("part %s is not there\n", PartChoice{p, parts.of}.text().c_str());
  if (missing > 0) std::printf("%zu samples are not drawn yet: draw their parts again (--part K/%d, or --slurm), then merge\n", missing, parts.of);
  return finish(w, sweep, store, sim, 0.0);
}

bool isComplete(const SweepWish& w, const Sweep& sweep, const SweepIdentity& identity, const PartChoice& part) {
  const std::filesystem::path file = partFile(w.out, part);
  if (!std::filesystem::exists(file)) return false;
  return missingSamples(sweep, SweepStore::existing(file, identity), part).empty();
}

int submitToSlurm(const SweepWish& w, const Sweep& sweep) {
  const Simulation sim = scenarioOf(w, sweep);
  const SweepIdentity identity = identityOf(sweep, sim);
  partFilesIn(w.out, w.parts);  // of another division: refused
  const std::vector<int> left = partsLeft(w.parts, [&](int p) { return isComplete(w, sweep, identity, {p, w.parts}); });
  if (left.empty()) {
    std::printf("all %d parts are drawn\n", w.parts);
    return merge(w, sweep);
  }
  SlurmWish wish;
  wish.program = std::filesystem::read_symlink("/proc/self/exe");
  wish.sweepFile = sweep.file;
  wish.out = w.out;
  wish.parts = w.parts;
  wish.options = w.slurmOptions;
  wish.carried = carriedWords(w);
  const SubmittedJob job = submit(wish, left);
  std::printf("job %s: %zu of %d parts, by %s\n", job.job.c_str(), left.size(), w.parts, job.script.string().c_str());
  if (!job.mergeJob.empty()) std::printf("job %s merges them when they have ended\n", job.mergeJob.c_str());
  else std::printf("they are to be merged by hand (--merge): %s\n", job.whyNoMerge.c_str());
  return 0;
}

int sweepBy(SweepWish& w) {
  const Sweep sweep = readSweep(w.scenario.file);
  if (w.out.empty()) w.out = sweep.name;
  if (!w.goal.empty()) return solveSweep(sweep, w.scenario.roots, {w.goal, w.factor, w.repeats});
  ensureWritableFolder(w.out);
  const std::filesystem::path folder = w.out;
  if (w.slurm) return submitToSlurm(w, sweep);
  if (w.merge) return merge(w, sweep);
  PartChoice part;
  std::filesystem::path file = folder / "sweep.sqlite";
  if (!w.part.empty()) {
    part = readPartChoice(w.part, ofOption("--part " + w.part));
    file = partFile(folder, part);
    partFilesIn(folder, part.of);
    ensureWritableFolder(file.parent_path());
  }
  return w.share.empty() ? draw(w, sweep, file, part) : drawBeside(w, sweep, file);
}

}  // namespace

CommandLine sweepCommand() {
  const auto w = std::make_shared<SweepWish>();
  return {{"sweep", "SWEEP.yaml", "draw a scenario again and again with other values: tables, sensitivities, data sets; on one machine or a cluster"},
          "SWEEP.yaml names a scenario, what varies in it and how, and what is measured of each picture (scenarios/README.md, \"Sweeps\"). What is found goes "
          "sample by sample into FOLDER/sweep.sqlite; at the end sweep.csv and the page sweep.html (spread, rank correlations, Sobol indices) are written and "
          "sinks get the frames. A sweep that was stopped or killed goes on where it was. A sample is the same whether it is drawn alone or among all.",
          std::vector<Option>{
              {"--out", "FOLDER", "where to write; the sweep's name unless given", into(w->out)},
              {"--workers", "N", "processes that draw at once; as many as processors unless given", number(w->workers, {1, 1024})},
              rootOption(w->scenario),
              {"", "", "Beyond one machine", {}},
              {"--part", "K/N", "draws the K-th of N parts, from 0, into FOLDER/parts: for any scheduler", into(w->part)},
              {"--merge", "", "puts the parts that lie there together, and says what lacks", into(w->merge)},
              {"--slurm", "", "writes FOLDER/sweep.sbatch and submits it: an array job of the parts that are not complete, and one that merges", into(w->slurm),
               "--parts"},
              {"--parts", "N", "so many parts", number(w->parts, {1, kMostParts})},
              {"--slurm-option", "'--X=Y'...", "a line of #SBATCH, as '--partition=long'", into(w->slurmOptions), "--slurm"},
              {"--share", "K/N", "one of N processes that share a file, as the command starts them itself", into(w->share)},
              {"", "", "Solving", {}},
              {"--solve", "'MEASURE = VALUE'",
               "finds where a measure's mean has a value, by bisection, noise counted: with every repeat the detector's noise and all other factors are drawn "
               "anew",
               into(w->goal), "--over"},
              {"--over", "FACTOR", "which factor is varied for that, over what it is drawn from", into(w->factor), "--solve"},
              {"--repeats", "N", "at one place at most", number(w->repeats, {4, 100000}), "--solve"}},
          [w](const Arguments& words) { return w->scenario.file = words[0], sweepBy(*w); },
          "By hand, on any number of machines that share FOLDER: pitviper sweep S.yaml --out FOLDER --part 0/40, 1/40, ..., then --merge."};
}

}  // namespace pitviper
