#include "sim/run/run.hpp"

#include <future>

#include "sim/render/probe.hpp"
#include "sim/run/spectral_renderer.hpp"

namespace pitviper {

void runFrames(const Simulation& sim, const ShaderLibrary& library, const RunRange& range, const FrameSink& frames, const ProbeSink& probes,
               const PictureProgress& progress) {
  auto scene = std::make_shared<const GpuScene>(sim);
  std::vector<std::unique_ptr<CameraRenderer>> renderers;
  std::vector<std::unique_ptr<SpectralRenderer>> spectral;  // null for a camera without a spectral image
  for (const auto& camera : sim.cameras) {
    renderers.push_back(std::make_unique<CameraRenderer>(sim, camera, library, scene));
    if (progress) renderers.back()->setProgress(progress);
    spectral.push_back(camera.spectralImage ? std::make_unique<SpectralRenderer>(sim, camera, library, scene) : nullptr);
  }
  std::future<void> handing;  // its destructor waits, so nothing it uses goes first
  auto wait = [&handing] {
    if (handing.valid()) handing.get();
  };
  auto hand = [&](Frame drawn) {
    auto frame = std::make_shared<const Frame>(std::move(drawn));
    wait();
    handing = std::async(std::launch::async, [&frames, frame] { frames(*frame); });
  };
  for (int number = range.first; number <= range.last; ++number) {
    const WorldState state = advance(sim.entities, sim.lights, sim.time.at(number));
    for (size_t c = 0; c < renderers.size(); ++c) {
      renderers[c]->begin(state);
      hand(makeFrame(sim, sim.cameras[c], renderers[c]->finish(), state, number));
      if (spectral[c]) hand(spectral[c]->render(state, number));
    }
    if (probes)
      for (const auto& probe : sim.probes) probes({probe, number, state.time_s, measureProbe(sim, probe, library, scene, state)});
  }
  wait();
}

}  // namespace pitviper
