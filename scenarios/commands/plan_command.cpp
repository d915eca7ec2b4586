#include <chrono>
#include <cstdio>

#include "scenarios/commands/bench_timing.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/plan_report.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/run_notes.hpp"
#include "scenarios/commands/scenario_wish.hpp"
#include "sim/frame/limits_check.hpp"
#include "sim/gl/context.hpp"
#include "sim/render/buffered_pass.hpp"
#include "sim/render/direct_pass.hpp"

namespace pitviper {
namespace {

double secondsSince(std::chrono::steady_clock::time_point start) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }

/// Pixels a second of the yardstick: the median of a few frames.
double yardstickRate() {
  Yardstick yardstick;
  std::vector<double> rates;
  for (int k = 0; k < 9; ++k) rates.push_back(Yardstick::kSize_px * Yardstick::kSize_px / timed([&] { yardstick.draw(); }));
  return median(rates);
}

/// Frames a second from the yardstick's. In pixels of the yardstick: what a frame costs whatever its size, a subpixel, and each of its nodes with
/// and without reflected light; about what `bench --scenario` finds for first_light and sixteen on llvmpipe, elsewhere within a factor of two or so.
double predictedRate(const Plan& plan, double subpixels, double yardstick, bool buffered) {
  constexpr double kFrame = 0.2e6, kSubpixel = 5.0, kLit = 0.28, kUnlit = 0.18, kShadows = 1.4, kBuffered = 1.6;
  const NodeCost cost = costOf(plan);
  const double each = (kSubpixel + kLit * cost.lit + kUnlit * cost.unlit) * (plan.terms.shadows ? kShadows : 1.0) * (buffered ? kBuffered : 1.0);
  return yardstick / (kFrame + subpixels * each);
}

/// The plan beside those of three times and a third of its accuracy: what is bought next, and what less would save.
std::string ladderOf(const Simulation& sim, const Camera& camera, const Plan& plan, double subpixels) {
  constexpr double kStep = 3.0, kLeast = 0.1;
  std::vector<Plan> plans;
  Camera other = camera;
  other.plan.clear();
  for (double accuracy : {plan.accuracy / kStep, plan.accuracy, plan.accuracy * kStep}) {
    if (accuracy == plan.accuracy) plans.push_back(plan);
    if (accuracy == plan.accuracy || accuracy > kLeast * (1.0 + 1e-9)) continue;
    other.spectral.accuracy = other.textureAccuracy = accuracy;
    plans.push_back(planFor(sim, {&other, nullptr}));
  }
  return ladderText(plans, plan.accuracy, subpixels);
}

struct PlanWish {
  ScenarioWish scenario;
  bool asJson = false, speed = false, shaders = false;
};

int plan(const PlanWish& w) {
  const Simulation sim = w.scenario.read();
  std::optional<GlContext> context;
  if (w.speed || w.shaders) context.emplace();
  const double yardstick = w.speed ? yardstickRate() : 0.0;
  std::string json;
  auto tell = [&](const std::string& name, const Eye& eye, double subpixels) {
    const auto start = std::chrono::steady_clock::now();
    Progress progress("plan", 1);
    const Plan plan = planFor(
        sim, eye, [&](double share) { progress.phase("planning " + name, share); }, Foretold::Always);
    progress.withdraw();
    const bool buffered = sim.mode == RenderMode::Buffered || sim.hasTransparent();
    PlannedEye told{name,
                    eye.camera ? eye.camera->outputs : eye.probe->outputs,
                    plan,
                    secondsSince(start),
                    subpixels,
                    0.0,
                    shadingTableBytes(sim, plan),
                    buffered,
                    plan.terms.air && plan.air.elevations > 0,
                    eye.camera && eye.camera->follower
                        ? (sim.limits.any() ? describe(sim.limits) + "; " : std::string()) + eye.camera->follower->words + ": its whole field"
                        : describe(sim.limits),
                    eye.camera};
    if (yardstick > 0.0) told.framesPerSecond = predictedRate(plan, subpixels, yardstick, buffered);
    if (w.asJson) json += (json.empty() ? "" : ", ") + planJson(told);
    else std::printf("%s%s\n", planText(told).c_str(), eye.camera && plan.accuracy > 0.0 ? ladderOf(sim, *eye.camera, plan, subpixels).c_str() : "");
    if (w.shaders) {
      const auto pass = makeScenePass(sim, plan, shaderLibrary(), std::make_shared<const GpuScene>(sim), eye.camera && eye.camera->truth.any(), 1.0);
      for (const NamedProgram& p : pass->programs())
        if (p.name == "shading") std::printf("%s\n", p.text.c_str());
    }
  };
  for (const Camera& one : sim.cameras) {
    const Camera c = drawnCamera(one);
    tell("camera " + c.name, {&c, nullptr}, static_cast<double>(c.pinhole.width) * c.pinhole.height * c.samples * c.samples);
  }
  for (const Probe& p : sim.probes) tell("probe " + p.name, {nullptr, &p}, 3.0 * p.resolution * p.resolution);
  if (w.asJson) std::printf("[%s]\n", json.c_str());
  std::fflush(stdout);
  Notes notes;
  noteFog(sim, notes);
  noteFringes(sim, notes);
  return 0;
}

}  // namespace

CommandLine planCommand() {
  const auto w = std::make_shared<PlanWish>();
  return {{"plan", "SCENARIO.yaml", "what a scenario's accuracy makes of it: terms, wavelengths, predicted error"},
          "Per camera and probe: how much of a pixel each term can be in each channel, which are kept and which dropped; into how many groups of wavelengths "
          "each channel's integral goes, of how many the reference has, and the error predicted for lines of sight the groups were not fitted to. 'accuracy: 1 "
          "%' in the scenario, or --set accuracy='0.1 %', asks for another. Plans are kept by content in $XDG_CACHE_HOME/pitviper (or ~/.cache/pitviper).",
          joined({{"--json", "", "for programs: a list with an object per camera and probe", into(w->asJson)},
                  {"--speed", "", "also predicted frames a second, from a measured yardstick", into(w->speed)},
                  {"--shaders", "", "also the text of the shading program", into(w->shaders)}},
                 scenarioOptions(w->scenario)),
          [w](const Arguments& words) { return w->scenario.file = words[0], plan(*w); }};
}

}  // namespace pitviper
