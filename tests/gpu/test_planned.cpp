// Pictures of planned wavelengths against every wavelength in double precision, pixel by pixel, in shipped scenarios.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/plan/planner.hpp"
#include "sim/render/direct_pass.hpp"
#include "sim/render/reference/reference_pixel.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Errors over pixels: of the plan's wavelengths in double precision, and of the picture drawn with them.
struct PlanErrors {
  std::vector<double> spectral, drawn;
};

/// |L - L_ref| / max(L_ref, 1e-3 x 99th percentile of L_ref).
double errorOf(double got, double want, double p99) { return std::abs(got - want) / std::max(want, 1e-3 * p99); }

/// Per slot.
std::vector<PlanErrors> compare(const Simulation& sim, Camera camera, const Plan& plan, int size, int stride, const std::vector<double>& times) {
  needContext();
  camera.pinhole.pitchX_m *= static_cast<double>(camera.pinhole.width) / size;
  camera.pinhole.pitchY_m *= static_cast<double>(camera.pinhole.height) / size;
  camera.pinhole.width = camera.pinhole.height = size;
  SpectralSampling all = camera.spectral;
  all.reference = true;
  const Plan fine = makePlan(sim, camera.outputs, all, camera.where);
  auto gpu = std::make_shared<const GpuScene>(sim);
  const auto pass = makeScenePass(sim, plan, shaderLibrary(), gpu, true, camera.pinhole.apertureArea_m2());
  std::vector<char> present(sim.entities.size(), 1);
  if (camera.mount.carrier >= 0) present[static_cast<size_t>(camera.mount.carrier)] = 0;
  struct Seen {
    std::vector<double> drawn, planned, fine;
  };
  std::vector<Seen> pixels;
  for (double t : times) {
    const WorldState state = advance(sim.entities, sim.lights, t);
    const View view = cameraView(camera.pinhole, cameraPose(camera.mount, state), camera.near_m, 1);
    pass->setState(state);
    pass->draw(view, state, present);
    pass->startReadback(true);
    const RawImage raw = pass->finishReadback();
    const ReferenceShader planned(sim, plan, view, state, present), exact(sim, fine, view, state, present);
    for (int y = 0; y < size; y += stride)
      for (int x = 0; x < size; x += stride) {
        const size_t p = static_cast<size_t>(y * size + x);
        const TruthPixel truth = truthAt(raw, p);
        const ReferencePixel want = exact.pixel(x, y);
        if (static_cast<int>(truth.entity) != want.entity + 1 || static_cast<int>(truth.part) != want.surface + 1) continue;
        Seen seen;
        for (size_t s = 0; s < want.slots.size(); ++s) seen.drawn.push_back(static_cast<double>(raw.groups[s / 4][4 * p + s % 4]));
        seen.planned = planned.pixel(x, y).slots;
        seen.fine = want.slots;
        pixels.push_back(std::move(seen));
      }
  }
  std::vector<PlanErrors> errors(static_cast<size_t>(plan.slotCount));
  for (size_t s = 0; s < errors.size(); ++s) {
    std::vector<double> level;
    for (const Seen& p : pixels) level.push_back(p.fine[s]);
    std::sort(level.begin(), level.end());
    const double p99 = level[level.size() * 99 / 100];
    for (const Seen& p : pixels) {
      errors[s].spectral.push_back(errorOf(p.planned[s], p.fine[s], p99));
      errors[s].drawn.push_back(errorOf(p.drawn[s], p.fine[s], p99));
    }
    std::sort(errors[s].spectral.begin(), errors[s].spectral.end());
    std::sort(errors[s].drawn.begin(), errors[s].drawn.end());
  }
  return errors;
}

TEST(Planned, ShippedScenarios) {
  for (const char* name : {"first_light", "canopy_plume_smoke", "far_jet", "lamp_on_plane"}) {
    Simulation sim = readScenario(std::string(PITVIPER_SOURCE_DIR) + "/scenarios/" + name + ".yaml", {}, findLibraries());
    for (Camera camera : sim.cameras) {
      camera.spectral.accuracy = std::getenv("ACC") ? std::atof(std::getenv("ACC")) : 0.01;
      camera.spectral.reference = false;
      const Plan plan = planFor(sim, {&camera, nullptr});
      const double end = sim.time.at(sim.time.frames - 1);
      const auto errors = compare(sim, camera, plan, 64, 5, {sim.time.start_s, 0.35 * end, 0.7 * end});
      for (size_t s = 0; s < errors.size(); ++s) {
        const auto& e = errors[s];
        const size_t n = e.drawn.size();
        std::printf("%s %s slot %zu: %d nodes, predicted %.4f; spectral median %.5f p99 %.5f max %.5f; drawn median %.5f p99 %.5f max %.5f (%zu pixels)\n",
                    name, camera.name.c_str(), s, plan.nodeCount(), plan.predictedError[s], e.spectral[n / 2], e.spectral[n * 99 / 100], e.spectral.back(),
                    e.drawn[n / 2], e.drawn[n * 99 / 100], e.drawn.back(), n);
      }
    }
  }
}

}  // namespace
}  // namespace pitviper::test
