#include <algorithm>
#include <cstdio>
#include <fstream>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/run/run.hpp"

namespace pitviper {
namespace {

RunRange framesWanted(const Options& o, const Simulation& sim) {
  RunRange range{0, sim.time.frames - 1};
  if (!o.has("--frames")) return range;
  const auto [a, b] = readRange(o.value("--frames"), "--frames");
  if (a < 0 || b < a || b >= sim.time.frames)
    throw UserError({"--frames " + o.value("--frames"), 0, 0, -1}, "there is no such range of frames", "within 0:" + std::to_string(sim.time.frames - 1) + ", rising",
                    "choose frames of the scenario's 'time.frames'");
  return {static_cast<int>(a), static_cast<int>(b)};
}

/// Probe readings as CSV, one file a probe.
class ProbeTables {
 public:
  void add(const ProbeReading& reading) {
    std::string& text = texts_[reading.probe.name];
    if (text.empty()) {
      text = "frame,time [s]";
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
  void write(const std::filesystem::path& folder) const {
    for (const auto& [name, text] : texts_) writeFileAtomically(folder / (name + ".csv"), text);
  }

 private:
  std::map<std::string, std::string> texts_;
};

}  // namespace

int runCommand(const Arguments& arguments) {
  const Options o("run", arguments, {{"--out"}, {"--frames"}, {"--set", true, true}, {"--preview", false}}, 1, 1);
  const Simulation sim = readScenario(o.words()[0], o.values("--set"), findLibraries());
  const RunRange range = framesWanted(o, sim);
  const std::filesystem::path out = o.value("--out", "out");
  ensureWritableFolder(out);
  const GlContext context;
  const int frames = range.last - range.first + 1;
  Progress progress(sim.name, frames * static_cast<int>(std::max<size_t>(1, sim.cameras.size())));
  ProbeTables probes;
  runFrames(sim, shaderLibrary(), range,
            [&](const Frame& f) {
              writeFrame(out, f);
              if (o.has("--preview")) writePreview(out, f);
              progress.step();
            },
            sim.probes.empty() ? ProbeSink{} : [&](const ProbeReading& r) { probes.add(r); });
  probes.write(out);
  progress.finish();
  std::printf("%d frame%s of %zu camera%s in %s (%s)\n", frames, frames == 1 ? "" : "s", sim.cameras.size(), sim.cameras.size() == 1 ? "" : "s",
              out.string().c_str(), context.limits().renderer.c_str());
  return 0;
}

int checkCommand(const Arguments& arguments) {
  const Options o("check", arguments, {{"--set", true, true}}, 1, 1);
  const Simulation sim = readScenario(o.words()[0], o.values("--set"), findLibraries());
  size_t triangles = 0;
  for (const auto& e : sim.entities) triangles += e.mesh->triangles.size();
  std::printf("%s: good. %d frames, %zu cameras, %zu entities (%zu triangles), %zu lights, %zu materials, %zu probes\n", o.words()[0].c_str(), sim.time.frames,
              sim.cameras.size(), sim.entities.size(), triangles, sim.lights.size(), sim.materials.size(), sim.probes.size());
  for (const auto& c : sim.cameras) {
    const Plan plan = makePlan(sim, c.outputs, c.spectral, c.where);
    std::printf("  camera %s: %dx%d, %zu layers from %d spectral kernels, %d wavelengths\n", c.name.c_str(), c.pinhole.width, c.pinhole.height, c.outputs.size(),
                plan.slotCount, plan.nodeCount());
  }
  return 0;
}

int keysCommand(const Arguments& arguments) {
  const Options o("keys", arguments, {}, 0, 0);
  std::fputs(keyReference().c_str(), stdout);
  return 0;
}

}  // namespace pitviper
