#include "sim/run/run.hpp"

#include <algorithm>
#include <future>
#include <optional>

#include "sim/camera/probe.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/gl/timing.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/plan/plan_origin.hpp"
#include "sim/plan/planner.hpp"
#include "sim/run/camera_line.hpp"
#include "sim/run/drawings_beside.hpp"
#include "sim/run/spectral_renderer.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

RunReport runFrames(const Simulation& sim, const ShaderLibrary& library, const RunRange& range, const FrameTaker& frames, const ProbeSink& probes,
                    const RunProgress& progress, bool stopsAtBroken) {
  std::optional<TimedPart> once(kPreparingPart);
  auto scene = std::make_shared<const GpuScene>(sim);
  std::vector<std::unique_ptr<CameraLine>> lines;
  std::vector<size_t> drafts;
  for (size_t c = 0; range.drafts && c < sim.cameras.size(); ++c)
    if (hasDraft(sim, sim.cameras[c])) drafts.push_back(c);
  std::vector<std::unique_ptr<SpectralRenderer>> spectral;  // null for a camera without a spectral image
  for (const auto& camera : sim.cameras) {
    const auto planning = [&](double share) {
      if (progress.planning) progress.planning(camera, share);
    };
    lines.push_back(
        std::make_unique<CameraLine>(sim, camera, library, scene, planning, false, std::find(drafts.begin(), drafts.end(), lines.size()) != drafts.end()));
    if (progress.picture) lines.back()->renderer().setProgress(progress.picture);
    spectral.push_back(camera.spectralImage ? std::make_unique<SpectralRenderer>(sim, camera, library, scene) : nullptr);
  }
  std::vector<std::unique_ptr<ProbeMeter>> meters;
  for (size_t p = 0; probes && p < sim.probes.size(); ++p)
    meters.push_back(std::make_unique<ProbeMeter>(sim, sim.probes[p], planFor(sim, {nullptr, &sim.probes[p]}), library, scene));
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
  auto isBroken = [&] { return std::any_of(lines.begin(), lines.end(), [](const auto& l) { return !l->auditor().broken().empty(); }); };
  once.reset();
  once.emplace(kFirstFramePart);
  for (const auto& line : lines) line->warmUp(range.first);
  const StateAt stateAt = [&sim](double t) { return advance(sim, t); };
  RunReport report;
  std::optional<DrawingsBeside> beside;
  if (!drafts.empty() && range.last > range.first)
    beside.emplace(sim, library, drafts, DrawingsBeside::Which::First, sim.time.at(range.first));  // of one frame a draft is all
  for (int number = range.first; number <= range.last && !(stopsAtBroken && isBroken()); ++number) {
    const WorldState state = stateAt(sim.time.at(number));
    if (beside && beside->isReady()) {
      for (auto& made : beside->take()) lines[made.camera]->takeOver(std::move(made.drawing));
      report.whyDrafts = beside->why();
      beside.reset();
    }
    report.drafts += std::any_of(lines.begin(), lines.end(), [](const auto& l) { return l->isDraft(); });
    for (size_t c = 0; c < lines.size(); ++c) {
      lines[c]->begin(stateAt, state.time_s, number);
      const bool audits = !lines[c]->isDraft();
      const CameraImage image = lines[c]->finish(audits ? std::optional(number) : std::nullopt, audits && number == range.first + report.drafts);
      Frame drawn = lines[c]->frame(image, state, number);
      if (progress.drawn)
        progress.drawn(lines[c]->camera(), drawn, state, image.pointing ? image.pointing->followed.pose : cameraAt(lines[c]->camera(), state).pose);
      hand(std::move(drawn));
      if (spectral[c]) hand(spectral[c]->render(image.pointing ? pointed(state, lines[c]->camera(), image.pointing->followed.pose) : state, number));
    }
    for (size_t p = 0; p < meters.size(); ++p) probes({sim.probes[p], number, state.time_s, meters[p]->read(state)});
    once.reset();
  }
  wait();
  for (const auto& line : lines) {
    const std::string& name = line->camera().name;
    const Auditor& auditor = line->auditor();
    if (!auditor.broken().empty()) report.broken[name] = auditor.broken();
    if (auditor.tally().pixels > 0) report.audits[name] = auditor.tally();
    if (line->camera().follower) report.poses[name] = line->camera().follower->recordHeader + line->takePoses();
    if (!line->camera().spectral.reference && !line->isDraft()) {
      PlanOrigin origin = originOf(sim, drawnCamera(line->camera()));
      origin.samples = line->camera().samples;  // of a pixel of its own, not of a stage's cell
      report.plans[name] = tableMark(sim) + originLine(origin) + writePlanned(line->renderer().plan());
    }
  }
  return report;
}

}  // namespace pitviper
