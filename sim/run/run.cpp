#include "sim/run/run.hpp"

#include <algorithm>
#include <future>
#include <optional>

#include "sim/camera/probe.hpp"
#include "sim/camera/exposure_parts.hpp"
#include "sim/frame/make_frame.hpp"
#include "sim/frame/truth_table.hpp"
#include "sim/gl/timing.hpp"
#include "sim/model/world.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/run/spectral_renderer.hpp"

namespace pitviper {

RunReport runFrames(const Simulation& sim, const ShaderLibrary& library, const RunRange& range, const FrameTaker& frames, const ProbeSink& probes,
                    const RunProgress& progress, bool stopsAtBroken) {
  std::optional<TimedPart> once(kPreparingPart);
  auto scene = std::make_shared<const GpuScene>(sim);
  std::vector<Camera> cameras;  // which the renderers look at: it is not to grow
  for (const Camera& camera : sim.cameras) cameras.push_back(drawnCamera(camera));
  std::vector<std::unique_ptr<CameraRenderer>> renderers;
  std::vector<std::unique_ptr<SensorChain>> chains;  // null for a camera without stages
  std::vector<Auditor> auditors;
  std::vector<std::unique_ptr<TruthMeter>> truth;  // null for a camera that asks for none of it
  std::vector<std::unique_ptr<SpectralRenderer>> spectral;  // null for a camera without a spectral image
  for (const auto& camera : sim.cameras) {
    const auto planning = [&](double share) {
      if (progress.planning) progress.planning(camera, share);
    };
    renderers.push_back(std::make_unique<CameraRenderer>(sim, cameras[renderers.size()], library, scene, planning));
    if (progress.picture) renderers.back()->setProgress(progress.picture);
    auditors.emplace_back(sim, cameras[auditors.size()], renderers.back()->plan(), library, scene);
    chains.push_back(camera.stages.empty() ? nullptr : std::make_unique<SensorChain>(camera, library));
    truth.push_back(camera.truth.targets || camera.truth.terms ? std::make_unique<TruthMeter>(sim, camera) : nullptr);
    spectral.push_back(camera.spectralImage ? std::make_unique<SpectralRenderer>(sim, camera, library, scene) : nullptr);
  }
  std::vector<std::unique_ptr<ProbeMeter>> meters;
  for (size_t p = 0; probes && p < sim.probes.size(); ++p) meters.push_back(std::make_unique<ProbeMeter>(sim, sim.probes[p], library, scene));
  std::future<void> handing;  // its destructor waits, so nothing it uses goes first
  auto wait = [&handing] {
    const TimedPart part("waiting for files");
    if (handing.valid()) handing.get();
  };
  auto hand = [&](Frame drawn) {
    auto frame = std::make_shared<const Frame>(std::move(drawn));
    wait();
    handing = std::async(std::launch::async, [&frames, frame] { frames(frame); });
  };
  auto isBroken = [&] { return std::any_of(auditors.begin(), auditors.end(), [](const Auditor& a) { return !a.broken().empty(); }); };
  once.reset();
  once.emplace(kFirstFramePart);
  // Detectors that remember see the frames before the first, which nobody gets.
  for (size_t c = 0; c < renderers.size(); ++c) {
    const TimedPart part("frames before the first");
    for (int number = range.first - warmUpOf(sim.cameras[c], sim.time.step_s); number < range.first; ++number)
      sensed(sim, sim.cameras[c], renderExposure(*renderers[c], sim, sim.cameras[c], sim.time.at(number)), advance(sim, sim.time.at(number)), number, *chains[c]);
  }
  for (int number = range.first; number <= range.last && !(stopsAtBroken && isBroken()); ++number) {
    const WorldState state = advance(sim, sim.time.at(number));
    for (size_t c = 0; c < renderers.size(); ++c) {
      const Camera& camera = sim.cameras[c];
      const CameraImage image = renderExposure(*renderers[c], sim, camera, state.time_s, [&](const WorldState& then, CameraImage& drawn) {
        const TimedPart part("audit");
        auditors[c].look(then, number, drawn, number == range.first);
      });
      std::vector<TargetRow> targets;
      std::vector<FrameLayer> terms;
      if (truth[c]) {
        const TimedPart part("truth");
        if (camera.truth.targets) targets = truth[c]->targets(state);
        if (camera.truth.terms) terms = truth[c]->terms(state);
      }
      std::optional<Frame> made;
      {
        const TimedPart part("frame");
        made = makeFrame(sim, camera, image, state, number, chains[c].get(), std::move(targets), std::move(terms));
      }
      hand(std::move(*made));
      if (spectral[c]) hand(spectral[c]->render(state, number));
    }
    for (size_t p = 0; p < meters.size(); ++p) probes({sim.probes[p], number, state.time_s, meters[p]->read(state)});
    once.reset();
  }
  wait();
  RunReport report;
  for (size_t c = 0; c < auditors.size(); ++c) {
    const std::string& name = sim.cameras[c].name;
    if (!auditors[c].broken().empty()) report.broken[name] = auditors[c].broken();
    if (auditors[c].tally().pixels > 0) report.audits[name] = auditors[c].tally();
    if (!sim.cameras[c].spectral.reference) report.plans[name] = writePlanned(renderers[c]->plan());
  }
  return report;
}

}  // namespace pitviper
