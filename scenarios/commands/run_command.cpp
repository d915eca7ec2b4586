#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/geometry_report.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/run_timing.hpp"
#include "scenarios/commands/run_total.hpp"
#include "scenarios/commands/seen_report.hpp"
#include "scenarios/commands/sensor_report.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/frame/frame_files.hpp"
#include "sim/frame/spectral_image.hpp"
#include "sim/gl/context.hpp"
#include "sim/gl/timing.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/table.hpp"
#include "sim/parameters/units.hpp"
#include "sim/plan/planner.hpp"
#include "sim/plan/sampling_check.hpp"
#include "sim/render/tables.hpp"
#include "sim/run/memory_need.hpp"
#include "sim/run/run.hpp"
#include "sim/run/spectral_renderer.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

RunRange framesWanted(const Options& o, const Simulation& sim) {
  RunRange range{0, sim.time.frames - 1};
  if (!o.has("--frames")) return range;
  const auto [a, b] = readRange(o.value("--frames"), "--frames");
  if (a < 0 || b < a || b >= sim.time.frames)
    throw UserError({"--frames " + o.value("--frames"), 0, 0, -1}, "there is no such range of frames",
                    "within 0:" + std::to_string(sim.time.frames - 1) + ", rising", "choose frames of the scenario's 'time.frames'");
  return {static_cast<int>(a), static_cast<int>(b)};
}

/// "layer=a:b" in the layer's unit.
PreviewRanges previewRanges(const Options& o, const Simulation& sim) {
  PreviewRanges ranges;
  for (const auto& text : o.values("--preview-range")) {
    const Location where{"--preview-range " + text, 0, 0, -1};
    const size_t equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
    if (equals == std::string::npos || colon == std::string::npos)
      throw UserError(where, "not a range", "layer=low:high", "write --preview-range lw.radiance=28:45");
    const std::string layer = text.substr(0, equals);
    std::vector<std::string> layers;
    for (const auto& c : sim.cameras)
      for (const auto& out : c.outputs) layers.push_back(out.layer());
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) throw unknownWord(where, "there is no layer", layer, layers);
    auto number = [&](const std::string& t) {
      const auto q = splitQuantity(t);
      if (!q || !q->unit.empty())
        throw UserError(where, "'" + t + "' is not a number", "numbers in the layer's own unit", "write --preview-range " + layer + "=28:45");
      return q->value;
    };
    ranges[layer] = {number(text.substr(equals + 1, colon - equals - 1)), number(text.substr(colon + 1))};
    if (!(ranges[layer].first < ranges[layer].second)) throw UserError(where, "the range does not rise", "low:high", "swap its ends");
  }
  return ranges;
}

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
    char cell[64];
    std::snprintf(cell, sizeof cell, "%d,%.9g", reading.frame, reading.time_s);
    text += cell;
    for (double v : reading.values) {
      std::snprintf(cell, sizeof cell, ",%.9g", v);
      text += cell;
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

/// One line for each camera whose wavelengths miss the bands of a gas by more than a per cent.
void noteSampling(const Simulation& sim) {
  for (const Camera& c : sim.cameras) {
    if (c.spectral.reference || c.spectral.accuracy > 0.0) continue;  // planned for the gas
    const auto notes = checkSampling(sim, makePlan(sim, c.outputs, c.spectral, c.where), c.outputs, 0.01);
    if (notes.empty()) continue;
    const SamplingNote& n = notes.front();
    std::fprintf(stderr,
                 "note: camera %s: %d spectral samples are %.2g %% off for the emission of %.2g m of '%s' in channel %s; raise spectral.samples, such as "
                 "{samples: 64, spacing: even}%s\n",
                 c.name.c_str(), c.spectral.samples, 100.0 * n.error, n.thickness_m, n.medium.c_str(), n.channel.c_str(),
                 notes.size() > 1 ? " (the worst of several)" : "");
  }
}

/// One line for each camera that begins with part of a body nearer than it draws: a dome in front of it, for instance.
void noteNear(const Simulation& sim, double time_s) {
  const WorldState state = advance(sim, time_s);
  for (const Camera& c : sim.cameras) {
    const glm::dvec3 eye = cameraAt(c, state).pose.position;
    for (size_t e = 0; e < sim.entities.size(); ++e) {
      const Entity& body = sim.entities[e];
      const Pose& pose = state.entities[e];
      const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(body.boundingCentre);
      if (static_cast<int>(e) == c.mount.carrier || sim.mediumOf(body) || glm::length(eye - centre) > static_cast<double>(body.boundingRadius_m) + c.near_m)
        continue;
      const glm::dvec3 at = glm::inverse(pose.orientation) * (eye - pose.position);
      double nearest = INFINITY;
      for (const glm::vec3& p : body.mesh->positions) nearest = std::min(nearest, glm::length(glm::dvec3(p) - at));
      if (nearest >= c.near_m) continue;
      std::fprintf(stderr, "note: camera %s: part of '%s' is %.2g m away, nearer than its near (%.2g m), and is not drawn; set near: %.1g mm\n", c.name.c_str(),
                   body.name.c_str(), nearest, c.near_m, std::max(1e3 * nearest / 10.0, 0.1));
    }
  }
}

/// A sink and where it was asked for.
struct PlacedSink {
  std::unique_ptr<Sink> sink;
  Location where;
};

/// Those of the scenario, or files; and what the command line asks for besides.
std::vector<PlacedSink> makeSinks(const Simulation& sim, const SinkPlace& place, const PreviewRanges* previews) {
  std::vector<PlacedSink> sinks;
  for (const SinkChoice& choice : sim.sinks) sinks.push_back({choice.make(sim, place), choice.where});
  if (sim.sinks.empty()) sinks.push_back({sinkNamed("files", sim).make(sim, place), {}});
  if (previews) sinks.push_back({makePreviewsSink(place, *previews), {"--preview", 0, 0, -1}});
  return sinks;
}

/// What a run would write, and who: more names than this are not held against each other.
constexpr size_t kMostNames = 200000;

/// Before any work: every file has one writer, and no folder of one is a file of another.
void refuseClashes(const Simulation& sim, const RunRange& range, const std::filesystem::path& folder, const std::vector<PlacedSink>& sinks) {
  std::map<std::string, const Location*> files;
  const auto clash = [](const Location& where, const std::filesystem::path& file) {
    throw UserError(where, "two sinks write '" + file.string() + "', or one writes into it as a folder", "sinks whose files lie apart",
                    "give this one a 'folder:' of its own, or remove it");
  };
  const auto add = [&](const std::filesystem::path& file, const Location* who) {
    if (!file.empty() && !files.emplace(file.lexically_normal().string(), who).second && who) clash(*who, file);
  };
  for (const Camera& c : sim.cameras) add(folder / (c.name + ".plan"), nullptr);
  for (const Probe& p : sim.probes) add(folder / ProbeTables::fileOf(p.name), nullptr);
  for (int number = range.first; number <= range.last && files.size() < kMostNames; ++number)
    for (const Camera& c : sim.cameras)
      for (const auto& [sink, where] : sinks)
        for (const char* kind : {"", kSpectralKind})
          if (!*kind || c.spectralImage) add(sink->fileOf(c.name, number, kind), &where);
  for (const auto& [sink, where] : sinks)
    for (const Camera& c : sim.cameras) {
      const auto file = sink->fileOf(c.name, range.first, "").lexically_normal();
      for (auto above = file.parent_path(); !above.empty() && above != above.root_path(); above = above.parent_path())
        if (files.count(above.string())) clash(where, above);
    }
}

/// Nor may any be of another scenario.
void refuseForeignFiles(const Simulation& sim, const RunRange& range, const std::filesystem::path& folder, const std::vector<PlacedSink>& sinks) {
  const auto refuse = [&](const std::filesystem::path& file) {
    if (!file.empty()) refuseForeignFile(file, sim);
  };
  for (int number = range.first; number <= range.last; ++number)
    for (const Camera& c : sim.cameras)
      for (const auto& placed : sinks) {
        refuse(placed.sink->fileOf(c.name, number, ""));
        if (c.spectralImage) refuse(placed.sink->fileOf(c.name, number, kSpectralKind));
      }
  for (const Probe& p : sim.probes) refuse(folder / ProbeTables::fileOf(p.name));
}

/// One line for each channel whose response ends before its own end, where the scene has no data.
void noteCuts(const Simulation& sim) {
  std::set<std::string> told;
  auto note = [&](const std::string& owner, const std::vector<ChannelOutput>& outputs) {
    for (const ChannelOutput& o : outputs)
      if (!o.cut.empty() && told.insert(owner + o.channel).second)
        std::fprintf(stderr, "note: %s, channel '%s': %s\n", owner.c_str(), o.channel.c_str(), o.cut.c_str());
  };
  for (const Camera& c : sim.cameras) note("camera " + c.name, c.outputs);
  for (const Probe& p : sim.probes) note("probe " + p.name, p.outputs);
}

/// Once per camera: what of a picture's transparent things is not in its right order.
void noteOrder(const Frame& f, std::set<std::string>& told) {
  for (const auto& a : f.attributes) {
    if (a.name != "pitviper.transparent_order") continue;
    const std::string order = std::get<std::string>(a.value);
    if (order != "exact" && told.insert(f.camera).second)
      std::fprintf(stderr,
                   "note: camera %s, frame %d: the order of transparent things is %s; of two that pass through each other one is drawn over the other\n",
                   f.camera.c_str(), f.number, order.c_str());
  }
}

/// By so much light scattered more than once must brighten a channel to be worth a word.
constexpr double kWorthSaying = 1.1;

void sayScatteredAgain(const std::string& camera, const std::string& channel, double factor) {
  std::fprintf(stderr,
               "note: camera %s, channel %s: light that the air scatters more than once is left out; with it pixels would be about %.2g times as bright "
               "(two-stream estimate: good to a factor of two or so)\n",
               camera.c_str(), channel.c_str(), factor);
}

/// Once per camera and channel.
void noteScattering(const Frame& f, std::set<std::string>& told) {
  const std::string begin = "pitviper.scattered_again.";
  for (const auto& a : f.attributes)
    if (a.name.rfind(begin, 0) == 0 && std::get<double>(a.value) > kWorthSaying && told.insert(f.camera + "/" + a.name).second)
      sayScatteredAgain(f.camera, a.name.substr(begin.size()), std::get<double>(a.value));
}

/// Once a run: what the plan was not made for.
void noteLimits(const Frame& f, bool& told) {
  for (const auto& a : f.attributes)
    if (a.name == "pitviper.outside_limits" && !std::exchange(told, true))
      std::fprintf(stderr, "note: camera %s, frame %d is outside the scenario's limits: %s; pixels may be off by more than the accuracy asked for\n",
                   f.camera.c_str(), f.number, std::get<std::string>(a.value).c_str());
}

/// Times that a run starts over with what its audits found.
constexpr int kMostStarts = 3;

/// `--plan FILE`: each is the plan of the camera that it is named after.
void readPlans(const Options& o, Simulation& sim) {
  for (const std::string& name : o.values("--plan")) {
    const std::filesystem::path file = name;
    const Location where{name, 0, 0, -1};
    const auto camera = std::find_if(sim.cameras.begin(), sim.cameras.end(), [&](const Camera& c) { return c.name == file.stem().string(); });
    if (camera == sim.cameras.end())
      throw UserError(where, "a plan of no camera of this scenario", "a file named after a camera, CAMERA.plan", "name the .plan file that a run wrote");
    camera->plan = readWholeFile(file, {}, where);
    camera->planFile = name;
  }
}

/// The lines that audits found to be off by more than was asked become part of what the plan must hold for.
void learn(const RunReport& report, Simulation& sim, int start) {
  for (Camera& c : sim.cameras) {
    const auto found = report.broken.find(c.name);
    if (found == report.broken.end()) continue;
    const AuditTally& tally = report.audits.at(c.name);
    std::fprintf(stderr, "note: camera %s: an audit found %.2g %% in '%s', of %.2g %% asked; its plan learns that line and the run starts over (%d of %d)\n",
                 c.name.c_str(), 100.0 * tally.largest, tally.channel.c_str(), 100.0 * tally.asked, start, kMostStarts);
    c.learnt.insert(c.learnt.end(), found->second.begin(), found->second.end());
    c.plan.clear();  // what --plan gave does not hold
  }
}

/// A line a camera that was audited.
std::string auditText(const RunReport& report) {
  std::string text;
  for (const auto& [camera, t] : report.audits) {
    std::vector<double> sorted = t.errors;
    std::sort(sorted.begin(), sorted.end());
    char line[256];
    std::snprintf(line, sizeof line, "  %s: audited %d pixel%s of %d frame%s against the reference: median %.2g %%, largest %.2g %% (%s)", camera.c_str(),
                  t.pixels, t.pixels == 1 ? "" : "s", t.frames, t.frames == 1 ? "" : "s", 100.0 * sorted[sorted.size() / 2], 100.0 * t.largest,
                  t.channel.c_str());
    text += line;
    if (t.asked > 0.0) {
      std::snprintf(line, sizeof line, " of %.2g %% asked%s", 100.0 * t.asked, t.largest > t.asked ? ": MORE THAN ASKED, those frames say so" : "");
      text += line;
    }
    text += "\n";
    if (t.whole.empty()) continue;
    sorted = t.whole;
    std::sort(sorted.begin(), sorted.end());
    std::snprintf(line, sizeof line, "  %s: with its geometry, against 32x32 places a pixel: median %.2g %%, largest %.2g %% (standard error up to %.2g %%)\n",
                  camera.c_str(), 100.0 * sorted[sorted.size() / 2], 100.0 * sorted.back(), 100.0 * t.wholeError);
    text += line;
  }
  return text;
}

/// Pixels that `check --audit` looks at in each of its frames, where the scenario does not say.
constexpr double kCheckedPixels = 16.0;

/// Draws the first, the middle and the last frame, holds some of their pixels against the reference, and writes nothing.
void auditFrames(Simulation& sim) {
  const GlContext context;
  if (!(sim.audit > 0.0)) sim.audit = kCheckedPixels;
  std::set<int> frames = {0, sim.time.frames / 2, sim.time.frames - 1};
  for (int frame : frames) std::printf("frame %d\n%s", frame, auditText(runFrames(sim, shaderLibrary(), {frame, frame}, [](const auto&) {})).c_str());
}

}  // namespace

int runCommand(const Arguments& arguments) {
  const Options o(
      "run", arguments,
      {{"--out"},
       {"--frames"},
       {"--set", true, true},
       {"--preview", false},
       {"--preview-range", true, true},
       {"--overwrite", false},
       {"--plan", true, true},
       {"--timing", false}},
      1, 1);
  Simulation sim = readScenario(o.words()[0], o.values("--set"), findLibraries());
  refuseBeyondMemory(sim);
  readPlans(o, sim);
  const RunRange range = framesWanted(o, sim);
  const PreviewRanges ranges = previewRanges(o, sim);
  const std::filesystem::path out = o.value("--out", "out");
  const bool previews = o.has("--preview") || !ranges.empty();
  SinkPlace place{out, {}};
  const auto sinksOf = [&] { return makeSinks(sim, place, previews ? &ranges : nullptr); };
  refuseClashes(sim, range, out, sinksOf());
  if (!o.has("--overwrite")) {
    refuseForeignFiles(sim, range, out, sinksOf());
    // And again for each: another run may have put it there meanwhile.
    place.mayReplace = [&sim](const std::filesystem::path& file) { refuseForeignFile(file, sim); };
  }
  ensureWritableFolder(out);
  noteCuts(sim);
  noteSampling(sim);
  noteNear(sim, sim.time.at(range.first));
  const GlContext context;
  const int frames = range.last - range.first + 1;
  const auto spectral = static_cast<size_t>(std::count_if(sim.cameras.begin(), sim.cameras.end(), [](const Camera& c) { return c.spectralImage.has_value(); }));
  std::set<std::string> told;
  bool toldOfLimits = false;
  for (int attempt = 0;; ++attempt) {
    Progress progress(sim.name, frames * static_cast<int>(std::max<size_t>(1, sim.cameras.size() + spectral)));
    progress.phase("preparing");
    ProbeTables probes(sim);
    RunTotal total;
    Stopwatch writing;
    std::optional<Timing> timing;
    if (o.has("--timing")) timing.emplace();
    const auto sinks = sinksOf();
    for (const auto& placed : sinks) placed.sink->start();
    const RunReport report = runFrames(
        sim, shaderLibrary(), range,
        [&](const std::shared_ptr<const Frame>& f) {
          noteOrder(*f, told);
          noteLimits(*f, toldOfLimits);
          noteScattering(*f, told);
          writing.time([&] {
            for (const auto& placed : sinks) placed.sink->take(f);
          });
          total.add(*f);
          progress.step();
        },
        sim.probes.empty() ? ProbeSink{} : [&](const ProbeReading& r) {
          probes.add(r);
          if (sim.cameras.empty() && &r.probe == &sim.probes.back()) progress.step();
        },
        {[&](double share) { progress.within(share); },
         [&](const Camera& c, double share) { progress.phase(share < 1.0 ? "planning camera " + c.name : "preparing", share < 1.0 ? share : 0.0); }},
        attempt < kMostStarts);
    if (!report.broken.empty() && attempt < kMostStarts) {
      learn(report, sim, attempt + 1);
      continue;
    }
    for (const auto& placed : sinks) placed.sink->finish();
    probes.write(out, place.mayReplace);
    for (const auto& [camera, plan] : report.plans) writeFileAtomically(out / (camera + ".plan"), plan);
    progress.finish();
    auto count = [](size_t n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); };
    std::string done;
    if (!sim.cameras.empty()) done = count(static_cast<size_t>(frames), "frame") + " of " + count(sim.cameras.size(), "camera");
    if (spectral) done += " and " + count(spectral * static_cast<size_t>(frames), "spectral image");
    if (!sim.probes.empty()) done += (done.empty() ? "" : " and ") + count(sim.probes.size(), "probe table");
    std::printf("%s in %s (%s), %s\n%s%s", done.c_str(), out.string().c_str(), context.limits().renderer.c_str(),
                RunTotal::pace(frames, progress.elapsed_s()).c_str(), total.expected().c_str(), auditText(report).c_str());
    if (timing) std::printf("%s", timingText(timing->seconds(), writing.seconds(), frames).c_str());
    return 0;
  }
}

int checkCommand(const Arguments& arguments) {
  const Options o("check", arguments, {{"--set", true, true}, {"--audit", false}}, 1, 1);
  Simulation sim = readScenario(o.words()[0], o.values("--set"), findLibraries());
  refuseBeyondMemory(sim);
  size_t triangles = 0;
  for (const auto& e : sim.entities) triangles += e.mesh->triangles.size();
  auto count = [](size_t n, const char* one, const char* many) { return std::to_string(n) + " " + (n == 1 ? one : many); };
  std::printf("%s: good. %s, %s, %s (%s), %s, %s, %s\n", o.words()[0].c_str(), count(static_cast<size_t>(sim.time.frames), "frame", "frames").c_str(),
              count(sim.cameras.size(), "camera", "cameras").c_str(), count(sim.entities.size(), "entity", "entities").c_str(),
              count(triangles, "triangle", "triangles").c_str(), count(sim.lights.size(), "light", "lights").c_str(),
              count(sim.materials.size(), "material", "materials").c_str(), count(sim.probes.size(), "probe", "probes").c_str());
  for (const auto& c : sim.cameras) {
    const Camera drawn = drawnCamera(c);
    const Plan plan = planFor(sim, {&drawn, nullptr});
    makeTables(sim, plan);  // what only the tables can find wrong
    std::printf("  camera %s: %dx%d, %s from %s, %s\n", c.name.c_str(), c.pinhole.width, c.pinhole.height, count(c.outputs.size(), "layer", "layers").c_str(),
                count(static_cast<size_t>(plan.slotCount), "spectral kernel", "spectral kernels").c_str(),
                count(static_cast<size_t>(plan.nodeCount()), "wavelength", "wavelengths").c_str());
    std::printf("%s%s", sensorText(c).c_str(), geometryText(sim, drawn, plan).c_str());
    for (const ScatteredAgain& s : ScatteringCheck(sim, c, plan).at(advance(sim, sim.time.at(0))))
      if (s.factor > kWorthSaying) sayScatteredAgain(c.name, s.channel, s.factor);
    if (!c.spectralImage) continue;
    const auto passes = spectralPasses(c);
    for (const auto& pass : passes) makeTables(sim, makePlan(sim, pass.outputs, pass.spectral, pass.where));
    std::printf("    spectral image: %d bins, %.6g to %.6g um, in %s\n", c.spectralImage->count(), c.spectralImage->edge_um.front(),
                c.spectralImage->edge_um.back(), count(passes.size(), "pass", "passes").c_str());
  }
  const SeenReport seen = reportSeen(sim);
  std::printf("%s", seen.text.c_str());
  std::fflush(stdout);  // before the notes, where both go to one place
  std::fprintf(stderr, "%s", seen.notes.c_str());
  noteCuts(sim);
  noteSampling(sim);
  noteNear(sim, sim.time.at(0));
  if (o.has("--audit")) auditFrames(sim);
  return 0;
}

int keysCommand(const Arguments& arguments) {
  const Options o("keys", arguments, {}, 0, 0);
  std::fputs(keyReference().c_str(), stdout);
  return 0;
}

}  // namespace pitviper
