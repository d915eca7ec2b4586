// Speed against accuracy of a scenario: its middle frame at rising numbers of spectral samples, against many.
#include "scenarios/commands/accuracy_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/gl/context.hpp"
#include "sim/run/run.hpp"

namespace pitviper {
namespace {

constexpr int kReferenceSamples = 192;

struct Rendered {
  Frame frame;
  double secondsPerFrame = 0.0;
};

Rendered renderWith(Simulation sim, int samples, Spacing spacing, int repeats) {
  sim.cameras.resize(1);
  Camera& camera = sim.cameras[0];
  camera.spectral.samples = samples;
  camera.spectral.spacing = spacing;
  auto scene = std::make_shared<const GpuScene>(sim);
  CameraRenderer renderer(sim, camera, shaderLibrary(), scene);
  const int number = sim.time.frames / 2;
  const WorldState state = advance(sim.entities, sim.lights, sim.time.at(number));
  Rendered r{makeFrame(sim, camera, renderer.render(state), state, number), 1e30};
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    renderer.render(state);
    r.secondsPerFrame = std::min(r.secondsPerFrame, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return r;
}

double percentile(std::vector<double>& v, double part) {
  const auto at = v.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(v.size() - 1));
  std::nth_element(v.begin(), at, v.end());
  return *at;
}

}  // namespace

int accuracyBench(const std::string& scenario) {
  const Simulation sim = readScenario(scenario, {}, findLibraries());
  if (sim.cameras.empty()) throw UserError({scenario, 0, 0, -1}, "the scenario has no camera", "at least one", "choose another scenario");
  const GlContext context;
  const Rendered reference = renderWith(sim, kReferenceSamples, Spacing::Gauss, 1);
  std::printf("%s, camera %s, frame %d against %d Gauss points per channel (%s)\n", sim.name.c_str(), sim.cameras[0].name.c_str(), sim.time.frames / 2,
              kReferenceSamples, context.limits().renderer.c_str());
  std::printf("relative error per pixel, median / 99th percentile, per cent\n\n| samples | spacing | frames/s |");
  std::vector<size_t> shown;
  for (size_t l = 0; l < sim.cameras[0].outputs.size(); ++l)
    if (!sim.cameras[0].outputs[l].perEtendue) shown.push_back(l);
  for (size_t l : shown) std::printf(" %s |", reference.frame.layers[l].name.c_str());
  std::printf("\n|---|---|---|");
  for (size_t i = 0; i < shown.size(); ++i) std::printf("---|");
  std::printf("\n");
  for (const auto& [name, spacing] : {std::pair{"gauss", Spacing::Gauss}, {"even", Spacing::Even}})
    for (int samples : {4, 8, 16, 32, 64}) {
      const Rendered r = renderWith(sim, samples, spacing, 3);
      std::printf("| %d | %s | %.1f |", samples, name, 1.0 / r.secondsPerFrame);
      for (size_t l : shown) {
        std::vector<double> errors;
        for (size_t p = 0; p < r.frame.layers[l].pixels.size(); ++p) {
          const double want = static_cast<double>(reference.frame.layers[l].pixels[p]), got = static_cast<double>(r.frame.layers[l].pixels[p]);
          if (want > 0.0) errors.push_back(std::abs(got - want) / want * 100.0);
        }
        if (errors.empty()) errors.push_back(0.0);
        const double median = percentile(errors, 0.5), high = percentile(errors, 0.99);
        std::printf(" %.3f / %.3f |", median, high);
      }
      std::printf("\n");
    }
  return 0;
}

}  // namespace pitviper
