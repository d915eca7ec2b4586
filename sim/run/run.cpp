#include "sim/run/run.hpp"

#include <future>

#include "sim/render/probe.hpp"

namespace pitviper {

void runFrames(const Simulation& sim, const ShaderLibrary& library, const RunRange& range, const FrameSink& frames, const ProbeSink& probes) {
  auto scene = std::make_shared<const GpuScene>(sim);
  std::vector<std::unique_ptr<CameraRenderer>> renderers;
  for (const auto& camera : sim.cameras) renderers.push_back(std::make_unique<CameraRenderer>(sim, camera, library, scene));
  std::future<void> handing;  // its destructor waits, so nothing it uses goes first
  auto wait = [&handing] {
    if (handing.valid()) handing.get();
  };
  for (int number = range.first; number <= range.last; ++number) {
    const WorldState state = advance(sim.entities, sim.lights, sim.time.at(number));
    for (size_t c = 0; c < renderers.size(); ++c) {
      renderers[c]->begin(state);
      auto frame = std::make_shared<const Frame>(makeFrame(sim, sim.cameras[c], renderers[c]->finish(), state, number));
      wait();
      handing = std::async(std::launch::async, [&frames, frame] { frames(*frame); });
    }
    if (probes)
      for (const auto& probe : sim.probes) probes({probe, number, state.time_s, measureProbe(sim, probe, library, scene, state)});
  }
  wait();
}

}  // namespace pitviper
