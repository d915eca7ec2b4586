#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/history_files.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/commands/pose_files.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/run_notes.hpp"
#include "scenarios/commands/run_report_page.hpp"
#include "scenarios/commands/run_sinks.hpp"
#include "scenarios/commands/run_timing.hpp"
#include "scenarios/commands/run_total.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/gl/context.hpp"
#include "sim/gl/timing.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/run/memory_need.hpp"
#include "sim/run/run.hpp"

namespace pitviper {
namespace {

struct RunWish {
  DrawWish draw;
  std::string frames;
  HistoryWish history;
  bool times = false, reports = false, drafts = false;
};

/// Probe readings as CSV, one file a probe.
class ProbeTables {
 public:
  explicit ProbeTables(const Simulation& simulation) : mark_(tableMark(simulation)) {}
  void add(const ProbeReading& reading) {
    std::string& text = texts_[reading.probe.name];
    if (text.empty()) {
      text = mark_ + "frame,time [s]";
      for (const auto& o : reading.probe.outputs) text += "," + o.layer() + " [" + o.unit + "]";
      text += "\n";
    }
    text += print("%d,%.9g", reading.frame, reading.time_s);
    for (double v : reading.values) {
      text += print(",%.9g", v);
    }
    text += "\n";
  }
  void write(const std::filesystem::path& folder, const MayReplace& mayReplace) const {
    for (const auto& [name, text] : texts_) writeFileAtomically(folder / fileOf(name), text, mayReplace);
  }
  static std::string fileOf(const std::string& probe) { return probe + ".csv"; }

 private:
  std::string mark_;
  std::map<std::string, std::string> texts_;
};

/// What a run writes besides its sinks' files.
OwnFiles ownFiles(const Simulation& sim, const std::filesystem::path& folder, bool report, const HistoryWish& history) {
  OwnFiles files = HistoryFiles::filesIn(folder, history);
  for (const Camera& c : sim.cameras) {
    files.push_back(folder / (c.name + ".plan"));
    if (leavesPoses(c)) files.push_back(posesFileIn(folder, c));
  }
  for (const Probe& p : sim.probes) files.push_back(folder / ProbeTables::fileOf(p.name));
  if (report) files.push_back(RunReportPage::fileIn(folder));
  return files;
}

/// Times that a run starts over with what its audits found.
constexpr int kMostStarts = 3;

/// The lines that audits found to be off by more than was asked become part of what the plan must hold for.
void learn(const RunReport& report, Simulation& sim, int start, Notes& notes) {
  for (Camera& c : sim.cameras) {
    const auto found = report.broken.find(c.name);
    if (found == report.broken.end()) continue;
    const AuditTally& tally = report.audits.at(c.name);
    notes.say(print("camera %s: an audit found %.2g %% in '%s', of %.2g %% asked; its plan learns that line and the run starts over (%d of %d)", c.name.c_str(),
                    100.0 * tally.largest, tally.channel.c_str(), 100.0 * tally.asked, start, kMostStarts));
    c.learnt.insert(c.learnt.end(), found->second.begin(), found->second.end());
    c.plan.clear();  // what --plan gave does not hold
  }
}

int run(RunWish& w) {
  Simulation sim = w.draw.read();
  const auto [first, last] = framesWanted(w.frames, sim);
  const RunRange range{first, last, w.drafts};
  sim.alone = first == last;
  HistoryWish& history = w.history;
  history.settle(sim, w.reports);
  PictureWish& pictures = w.draw.pictures;
  pictures.settle(sim);
  if (w.reports && !pictures.sheet) {
    pictures.sheet = true;
    if (!pictures.scaled && !pictures.previews) pictures.style.ownScale = false;
  }
  const std::filesystem::path out = w.draw.out.empty() ? "out" : w.draw.out;
  SinkPlace place{out, {}};
  const auto sinksOf = [&] { return makeSinks(sim, place, pictures); };
  refuseClashes(sim, range, ownFiles(sim, out, w.reports, history), sinksOf());
  if (!w.draw.overwrites) {
    refuseForeignFiles(sim, range, ownFiles(sim, out, w.reports, history), sinksOf());
    // And again for each: another run may have put it there meanwhile.
    place.mayReplace = [&sim](const std::filesystem::path& file) { refuseForeignFile(file, sim); };
  }
  ensureWritableFolder(out);
  Notes notes;
  noteScenario(sim, notes);
  noteSampling(sim, notes);
  noteNear(sim, sim.time.at(range.first), notes);
  notePointing(sim, range.first, notes);
  const GlContext context;
  const int frames = range.last - range.first + 1;
  const auto spectral = static_cast<size_t>(std::count_if(sim.cameras.begin(), sim.cameras.end(), [](const Camera& c) { return c.spectralImage.has_value(); }));
  FrameNotes ofFrames(notes);
  for (int attempt = 0;; ++attempt) {
    Progress progress(sim.name, frames * static_cast<int>(std::max<size_t>(1, sim.cameras.size() + spectral)));
    progress.phase("preparing");
    ProbeTables probes(sim);
    std::optional<RunReportPage> page;
    if (w.reports) page.emplace(sim);
    std::optional<HistoryFiles> flown;
    if (history.tables || history.picture) flown.emplace(sim, out, history);
    RunTotal total;
    Stopwatch writing;
    std::optional<Timing> timing;
    const ProgramCount before = programsSoFar();
    if (w.times) timing.emplace();
    const auto sinks = sinksOf();
    for (const auto& placed : sinks) placed.sink->start();
    const RunReport report = runFrames(
        sim, shaderLibrary(), range,
        [&](const std::shared_ptr<const Frame>& f) {
          ofFrames.look(*f);
          writing.time([&] {
            for (const auto& placed : sinks) placed.sink->take(f);
          });
          total.add(*f);
          if (page) page->add(*f);
          progress.step();
        },
        sim.probes.empty() ? ProbeSink{} : [&](const ProbeReading& r) {
          probes.add(r);
          if (sim.cameras.empty() && &r.probe == &sim.probes.back()) progress.step();
        },
        {[&](double share) { progress.within(share); },
         [&](const Camera& c, double share) { progress.phase(share < 1.0 ? "planning camera " + c.name : "preparing", share < 1.0 ? share : 0.0); },
         [&](const Camera& c, const Frame& frame, const WorldState& world, const Pose& pose) {
           if (flown) flown->look(c, frame, world, pose);
         }},
        attempt < kMostStarts);
    if (!report.broken.empty() && attempt < kMostStarts) {
      learn(report, sim, attempt + 1, notes);
      continue;
    }
    progress.phase("pictures");
    for (const auto& placed : sinks) placed.sink->finish([&](double share) { progress.phase("pictures", share); });
    probes.write(out, place.mayReplace);
    for (const Camera& c : sim.cameras)
      if (leavesPoses(c)) writePoses(out, sim, c, report.poses.at(c.name), place.mayReplace);
    for (const auto& [camera, plan] : report.plans) writeFileAtomically(out / (camera + ".plan"), plan, place.mayReplace);
    std::optional<HistoryReport> told;
    if (flown) {
      for (int number = range.first; sim.cameras.empty() && number <= range.last; ++number) flown->look(number, advance(sim, sim.time.at(number)));
      told = flown->write(sim.name, place.mayReplace);
      if (history.mustDraw && !told->whyNoPicture.empty()) notes.say("no picture of the trajectories: " + told->whyNoPicture);
    }
    progress.finish();
    if (!report.whyDrafts.empty()) notes.say("all frames are drafts: " + report.whyDrafts);
    auto count = [](size_t n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); };
    std::string done;
    if (!sim.cameras.empty()) done = count(static_cast<size_t>(frames), "frame") + " of " + count(sim.cameras.size(), "camera");
    if (spectral) done += " and " + count(spectral * static_cast<size_t>(frames), "spectral image");
    if (!sim.probes.empty()) done += (done.empty() ? "" : " and ") + count(sim.probes.size(), "probe table");
    const std::string summary = done + " in " + out.string() + " (" + context.limits().renderer + "), " + RunTotal::pace(frames, progress.elapsed_s()) + "\n" +
                                total.expected() + auditText(report);
    std::fputs(summary.c_str(), stdout);
    if (page) page->write(out, pictures.video, {summary, notes, told ? &*told : nullptr, history.tables}, place.mayReplace);
    if (timing) {
      const ProgramCount made{programsSoFar().programs - before.programs, programsSoFar().lines - before.lines};
      std::printf("%s", timingText(timing->seconds(), made, writing.seconds(), frames).c_str());
    }
    return 0;
  }
}

}  // namespace

CommandLine runCommand() {
  const auto w = std::make_shared<RunWish>();
  return {
      {"run", "SCENARIO.yaml", "render a scenario to calibrated EXR frames"},
      "Renders the scenario's frames: one EXR per camera and frame in FOLDER, named <camera>_<frame>.exr, with a float layer <channel>.<quantity> per "
      "output, truth.* layers and a grey picture for programs that know nothing of layers; other formats by 'sinks: [{sink: files, format: tiff}]'; probes "
      "write <probe>.csv; a camera with 'spectral_image:' also writes <camera>_<frame>_spectral.exr for pitviper integrate.",
      joined({{"--out", "FOLDER", "where to write (default 'out'); created if missing", into(w->draw.out)},
              {"--frames", "A:B", "frames A to B only, both included (or one: A); counted from 0: --frames 0:9 draws ten", into(w->frames)},
              {"--report", "", "also report.html: scenario, plans, sensors, sheet, what its layers and targets do over time, notes; all in one file",
               into(w->reports)},
              {"--no-history", "", "without history.csv and encounters.csv, which are written where something moves", into(w->history.none)},
              {"--trajectories", "", "also trajectories.png, what was flown (needs VTK; with --report too)", into(w->history.mustDraw)},
              {"--draft", "",
               "a picture soon: frames are drawn by a draft's few groups (20 %; each says so, with the error to expect) while plans are made beside, and as "
               "asked from the frame on at which they are there; one frame alone by a draft, unless its plan is known",
               into(w->drafts)},
              {"--timing", "",
               "says at the end how long planning, tables, programs and the first frame took, and where the time of frames after it went: visibility, "
               "shadows, air, shading, readback, files; drawing then waits for each part, which makes it somewhat slower",
               into(w->times)}},
             drawOptions(w->draw)),
      [w](const Arguments& words) { return w->draw.scenario.file = words[0], run(*w); },
      "Files of the same names are replaced where they are of the same scenario (its text, what it extends and includes, --set); another's is refused "
      "before anything is drawn. Other files in FOLDER are left as they are. Any number of runs of one scenario may write one FOLDER at once.\n"
      "On a terminal a bar shows how far it is; elsewhere lines come on stderr, the first after 3 s, each next after as long again as all before.\n"
      "The last lines sum up: frames, time, frames a second, and for each camera what its plan expects to be off by at most."};
}

}  // namespace pitviper
