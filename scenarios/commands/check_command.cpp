#include <algorithm>
#include <cstdio>
#include <set>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/geometry_report.hpp"
#include "scenarios/commands/run_notes.hpp"
#include "scenarios/commands/run_total.hpp"
#include "scenarios/commands/scenario_wish.hpp"
#include "scenarios/commands/seen_report.hpp"
#include "scenarios/commands/sensor_report.hpp"
#include "sim/gl/context.hpp"
#include "sim/plan/planner.hpp"
#include "sim/render/assembly/tables.hpp"
#include "sim/run/memory_need.hpp"
#include "sim/run/run.hpp"
#include "sim/run/spectral_renderer.hpp"

namespace pitviper {
namespace {

/// Pixels that `check --audit` looks at in each of its frames, where the scenario does not say.
constexpr double kCheckedPixels = 16.0;

/// Gauss points a channel that stand for a plan where none is asked for.
constexpr int kRoughSamples = 8;

/// Planning takes as long as all the rest of a check many times over, and finds no mistakes that its tables don't show with any wavelengths.
Plan roughPlan(const Simulation& sim, const Camera& camera) {
  SpectralSampling rough;
  rough.samples = kRoughSamples;
  return makePlan(sim, camera.outputs, rough, camera.where);
}

/// Draws the first, the middle and the last frame, holds some of their pixels against the reference, and writes nothing.
void auditFrames(Simulation& sim) {
  const GlContext context;
  if (!(sim.audit > 0.0)) sim.audit = kCheckedPixels;
  std::set<int> frames = {0, sim.time.frames / 2, sim.time.frames - 1};
  for (int frame : frames) std::printf("frame %d\n%s", frame, auditText(runFrames(sim, shaderLibrary(), {frame, frame}, [](const auto&) {})).c_str());
}

struct CheckWish {
  ScenarioWish scenario;
  bool plans = false, audits = false;
};

int check(const CheckWish& w) {
  Simulation sim = w.scenario.read();
  refuseBeyondMemory(sim);
  Notes notes;
  size_t triangles = 0;
  for (const auto& e : sim.entities) triangles += e.mesh->triangles.size();
  const auto lamps = static_cast<size_t>(std::count_if(sim.lights.begin(), sim.lights.end(), [](const PointLight& l) { return l.lamp < 0; }));
  auto count = [](size_t n, const char* one, const char* many) { return std::to_string(n) + " " + (n == 1 ? one : many); };
  std::printf("%s: good. %s, %s, %s (%s), %s, %s, %s\n", w.scenario.file.c_str(), count(static_cast<size_t>(sim.time.frames), "frame", "frames").c_str(),
              count(sim.cameras.size(), "camera", "cameras").c_str(), count(sim.entities.size(), "entity", "entities").c_str(),
              count(triangles, "triangle", "triangles").c_str(), count(lamps, "light", "lights").c_str(),
              count(sim.materials.size(), "material", "materials").c_str(), count(sim.probes.size(), "probe", "probes").c_str());
  for (const auto& c : sim.cameras) {
    const Camera drawn = drawnCamera(c);
    const Plan plan = w.plans ? planFor(sim, {&drawn, nullptr}) : roughPlan(sim, drawn);
    makeTables(sim, plan);  // what only the tables can find wrong
    std::printf("  camera %s: %dx%d, %s from %s%s\n", c.name.c_str(), c.pinhole.width, c.pinhole.height, count(c.outputs.size(), "layer", "layers").c_str(),
                count(static_cast<size_t>(plan.slotCount), "spectral kernel", "spectral kernels").c_str(),
                w.plans ? (", " + count(static_cast<size_t>(plan.nodeCount()), "wavelength", "wavelengths")).c_str() : "");
    if (c.follower) std::printf("    %s\n", c.follower->words.c_str());
    std::printf("%s%s", sensorText(c, sim.time.step_s).c_str(), geometryText(sim, drawn, plan).c_str());
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
  noteScenario(sim, notes);
  noteSampling(sim, notes);
  noteNear(sim, sim.time.at(0), notes);
  if (w.audits) auditFrames(sim);
  return 0;
}

}  // namespace

CommandLine checkCommand() {
  const auto w = std::make_shared<CheckWish>();
  return {
      {"check", "SCENARIO.yaml", "validate a scenario, render nothing"},
      "Reads everything the scenario names and reports the first mistake as file:line:col with the fix (exit code 2).\n"
      "Then tells what each camera sees in the first, the middle and the last frame: a line a body (many alike in one) with its size, range, size in pixels, "
      "and whether it is out of view, behind the camera, hidden by another or smaller than a pixel; 'hidden' is found by rays to a few dozen places on the "
      "body. Meshes whose size smells of another unit than the one given are noted.",
      joined(
          {{"--plan", "", "also plans each camera, which takes seconds, and says how many wavelengths it takes; the plan is kept, as of run", into(w->plans)},
           {"--audit", "",
            "also draws those frames, works 16 pixels of each (or as many as the scenario's 'audit' says) out by the reference, and tells how far they are "
            "from it; writes nothing",
            into(w->audits)}},
          scenarioOptions(w->scenario)),
      [w](const Arguments& words) { return w->scenario.file = words[0], check(*w); }};
}

}  // namespace pitviper
