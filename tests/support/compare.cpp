#include "tests/support/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "sim/render/direct_pass.hpp"
#include "sim/render/reference/reference_pixel.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {

Worst compare(const Simulation& sim, int stride) {
  const Camera& camera = sim.cameras[0];
  return compare(sim, makePlan(sim, camera.outputs, camera.spectral, camera.where), stride);
}

Worst compare(const Simulation& sim, const Plan& plan, int stride, double floor) {
  needContext();
  const Camera& camera = sim.cameras[0];
  const WorldState state = advance(sim, 0.0);
  const View view = cameraView(camera, state, 1);
  auto gpu = std::make_shared<const GpuScene>(sim);
  const auto owned = makeScenePass(sim, plan, shaderLibrary(), gpu, true, camera.pinhole.apertureArea_m2());
  ScenePass& pass = *owned;
  pass.setState(state);
  pass.draw(view, state, std::vector<char>(sim.entities.size(), 1));
  pass.startReadback();
  const RawImage raw = pass.finishReadback();
  // One for all pixels: what they have in common is worked out once.
  const std::vector<char> all(sim.entities.size(), 1);
  const ReferenceShader shader(sim, plan, view, state, all);
  Worst worst;
  struct Pair {
    double got, want;
  };
  std::vector<std::vector<Pair>> pairs(static_cast<size_t>(plan.slotCount));
  for (int y = 0; y < view.height; y += stride)
    for (int x = 0; x < view.width; x += stride) {
      const size_t p = static_cast<size_t>(y * view.width + x);
      const ReferencePixel reference = shader.pixel(x, y);
      const TruthPixel truth = truthAt(raw, p);
      if (static_cast<int>(truth.entity) != reference.entity + 1 || static_cast<int>(truth.part) != reference.surface + 1) {
        ++worst.missed;
        continue;
      }
      ++worst.covered;
      for (size_t s = 0; s < reference.slots.size(); ++s) {
        const double got = static_cast<double>(raw.groups[s / 4][4 * p + s % 4]), want = reference.slots[s];
        EXPECT_TRUE(std::isfinite(got));
        pairs[s].push_back({got, want});
      }
    }
  std::vector<double> errors;
  for (const auto& slot : pairs) {
    double brightest = 0.0;
    for (const Pair& p : slot) brightest = std::max(brightest, p.want);
    for (const Pair& p : slot) {
      const double size = std::max(p.want, floor * brightest);
      if (!(size > 1e-37)) continue;
      errors.push_back(std::abs(p.got - p.want) / size);
      worst.error = std::max(worst.error, errors.back());
    }
  }
  std::sort(errors.begin(), errors.end());
  if (!errors.empty()) worst.percentile99 = errors[errors.size() * 99 / 100];
  return worst;
}

}  // namespace pitviper::test
