#include "tests/support/scene_builder.hpp"

#include <cmath>
#include <stdexcept>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/camera/exposure_parts.hpp"
#include "sim/camera/probe.hpp"
#include "sim/frame/truth_table.hpp"
#include "sim/plan/planner.hpp"
#include "sim/gl/context.hpp"

namespace pitviper::test {
namespace {
const GlContext& context() {
  static const GlContext one;
  return one;
}
}  // namespace

void needContext() { context(); }
bool onSoftware() { return context().limits().software; }

Simulation scene(const std::string& yaml) {
  const std::filesystem::path home = PITVIPER_SOURCE_DIR;
  Simulation sim =
      readScenarioText(yaml, "test.yaml", home / "scenarios", {}, {home / "materials/library", home / "atmosphere/library", home / "sensors/library"});
  if (yaml.find("samples:") == std::string::npos)
    for (Camera& c : sim.cameras) c.samples = 1, c.sharesShading = false;
  return sim;
}

CameraImage renderImage(const Simulation& sim, int frame) {
  needContext();
  auto gpu = std::make_shared<const GpuScene>(sim);
  const Camera drawn = drawnCamera(sim.cameras.at(0));
  CameraRenderer renderer(sim, drawn, cameraPlan(sim, drawn), shaderLibrary(), gpu);
  return renderExposure(renderer, sim, sim.cameras.at(0), sim.time.at(frame));
}

Frame renderFrame(const Simulation& sim, int frame) {
  const Camera& camera = sim.cameras.at(0);
  std::optional<SensorChain> chain;
  needContext();
  if (camera.hasStages()) chain.emplace(camera, shaderLibrary());
  for (int before = frame - warmUpOf(camera, sim.time.step_s); before < frame; ++before)
    sensed(sim, camera, renderImage(sim, before), advance(sim, sim.time.at(before)), before, *chain);
  const CameraImage image = renderImage(sim, frame);
  const WorldState state = advance(sim, sim.time.at(frame));
  std::vector<TargetRow> targets;
  std::vector<FrameLayer> terms;
  if (camera.truth.targets || camera.truth.terms) {
    const TruthMeter meter(sim, camera);
    if (camera.truth.targets) targets = meter.targets(state);
    if (camera.truth.terms) terms = meter.terms(state);
  }
  return makeFrame(sim, camera, image, state, frame, chain ? &*chain : nullptr, std::move(targets), std::move(terms));
}

const FrameLayer& layer(const Frame& frame, const std::string& name) {
  for (const auto& l : frame.layers)
    if (l.name == name) return l;
  throw std::runtime_error("no layer " + name);
}

double at(const FrameLayer& l, const Frame& f, int column, int row) { return static_cast<double>(l.pixels[static_cast<size_t>(row * f.width + column)]); }

double sum(const FrameLayer& l) {
  double s = 0.0;
  for (float v : l.pixels) s += static_cast<double>(v);
  return s;
}

std::vector<double> probeReading(const Simulation& sim) {
  needContext();
  auto gpu = std::make_shared<const GpuScene>(sim);
  return ProbeMeter(sim, sim.probes.at(0), planFor(sim, {nullptr, &sim.probes.at(0)}), shaderLibrary(), gpu).read(advance(sim, sim.time.at(0)));
}

double blackBodyBand(double low_um, double high_um, double temperature_K) {
  const double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
  auto below = [&](double lambda_um) {
    const double x = h * c / (lambda_um * 1e-6 * k * temperature_K);
    double s = 0.0;
    for (int n = 1; n <= 400; ++n) {
      const double term = std::exp(-n * x) * (x * x * x / n + 3 * x * x / n / n + 6 * x / std::pow(n, 3) + 6 / std::pow(n, 4));
      s += term;
      if (term < 1e-18 * s) break;
    }
    return 2.0 * std::pow(k * temperature_K, 4) / (h * h * h * c * c) * s;
  };
  return below(high_um) - below(low_um);
}

}  // namespace pitviper::test
