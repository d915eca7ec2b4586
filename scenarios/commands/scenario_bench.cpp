// `bench --scenario`: frames a second of a scenario as it is: drawn, read back and resolved in memory, no files; beside the yardstick.
#include <algorithm>
#include <cstdio>
#include <numeric>

#include "scenarios/commands/bench_timing.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/scenario_wish.hpp"
#include "sim/camera/camera_renderer.hpp"
#include "sim/gl/context.hpp"
#include "sim/gl/timing.hpp"
#include "sim/parameters/print.hpp"
#include "sim/run/camera_line.hpp"

namespace pitviper {
namespace {

/// The speed that figures are told at, whatever the machine [pixels of the yardstick a second].
constexpr double kNominalRate = 6e6;

struct ScenarioRate {
  std::string camera;
  int nodes = 0, channels = 0, frames = 0;
  double seconds = 0.0;                      ///< of a frame: mean
  double slow = 0.0;                         ///< 95 % of frames take no longer [s]
  double yardstickSeconds = 0.0;             ///< of the yardstick's frame between
  std::map<std::string, double> parts = {};  ///< seconds of each part of a frame
};

/// Every camera over the scenario's frames one after the other, from the first again where there are not so many.
std::vector<ScenarioRate> timeScenario(const ScenarioWish& scenario, int frames) {
  const Simulation sim = scenario.read();
  const auto scene = std::make_shared<const GpuScene>(sim);
  Yardstick yardstick;
  std::vector<ScenarioRate> rates;
  Progress progress("bench", frames * static_cast<int>(sim.cameras.size()));
  for (const Camera& camera : sim.cameras) {
    const StateAt world = [&sim](double t) { return advance(sim, t); };
    // Of a camera that a gimbal points a frame is the whole loop: its picture, its sensor, what it finds in that; one frame after the other, none again.
    std::unique_ptr<CameraLine> loop;
    if (camera.follower) loop = std::make_unique<CameraLine>(sim, camera, shaderLibrary(), scene, std::function<void(double)>());
    const auto alone = loop ? nullptr : std::make_unique<CameraRenderer>(sim, camera, cameraPlan(sim, camera), shaderLibrary(), scene);
    const CameraRenderer& renderer = loop ? loop->renderer() : *alone;
    int next = 0;
    // One after the other, as they follow in a run: what has not changed is not made again.
    auto draw = [&](int k) {
      if (!loop) {
        alone->render(world(sim.time.at(k % sim.time.frames)));
        return;
      }
      const double time_s = sim.time.at(next);
      loop->begin(world, time_s, next);
      const CameraImage image = loop->finish();
      loop->frame(image, world(time_s), next++);
      loop->takePoses();
    };
    draw(0);  // the driver compiles
    timed([&] { yardstick.draw(); });
    std::vector<double> own, bare;
    for (int k = 0; k < frames; ++k) {
      bare.push_back(timed([&] { yardstick.draw(); }));
      own.push_back(timed([&] { draw(k); }));
      progress.step();
    }
    std::vector<double> sorted = own;
    std::sort(sorted.begin(), sorted.end());
    const double slow = sorted[static_cast<size_t>(0.95 * (frames - 1))];
    const Timing timing;
    for (int k = 0; k < frames; ++k) draw(k);
    auto parts = timing.seconds();
    for (auto& [name, seconds] : parts) seconds /= frames;
    rates.push_back({camera.name, renderer.plan().nodeCount(), renderer.plan().slotCount, frames, std::accumulate(own.begin(), own.end(), 0.0) / frames, slow,
                     median(bare), parts});
  }
  progress.finish();
  return rates;
}

std::string rateTable(const std::vector<ScenarioRate>& rates) {
  std::string out =
      "| camera | channels | nodes | ms a frame | 95 % within | frames/s | yardstick, million pixels/s | frames/s at 6 million "
      "|\n|---|---|---|---|---|---|---|---|\n";
  for (const ScenarioRate& r : rates) {
    const double yardstick = Yardstick::kSize_px * Yardstick::kSize_px / r.yardstickSeconds;
    out += print("| %s | %d | %d | %.2f | %.2f | %.1f | %.2f | %.1f |\n", r.camera.c_str(), r.channels, r.nodes, 1e3 * r.seconds, 1e3 * r.slow, 1.0 / r.seconds,
                 1e-6 * yardstick, kNominalRate / yardstick / r.seconds);
  }
  out += "\nBy part, ms a frame, each waited for (together they may take longer than what is not waited for):\n";
  for (const ScenarioRate& r : rates) {
    out += r.camera + ": ";
    for (const auto& [name, seconds] : r.parts) {
      out += print("%s%s %.2f", out.ends_with(": ") ? "" : ", ", name.c_str(), 1e3 * seconds);
    }
    out += "\n";
  }
  return out;
}

}  // namespace

CommandLine scenarioBenchCommand() {
  struct Wish {
    ScenarioWish scenario;
    int frames = 60;
  };
  const auto w = std::make_shared<Wish>();
  return {
      {"bench --scenario", "SCENARIO.yaml"},
      "Time of a frame of each camera, the frames in their order, drawing and readback, no files (with a gimbal its sensor and tracker too); beside them the "
      "yardstick, and where the time of a frame goes, part by part: what updates tables and shadow maps, what is seen, shading, readback and so on.",
      joined({{"--frames", "N", "frames to time", number(w->frames, {10, 100000, "", false, "not a number of frames to time"})}}, scenarioOptions(w->scenario)),
      [w](const Arguments& words) {
        w->scenario.file = words[0];
        const GlContext context;
        const auto rates = timeScenario(w->scenario, w->frames);
        std::printf("%s\n%s", context.limits().renderer.c_str(), rateTable(rates).c_str());
        return 0;
      }};
}

}  // namespace pitviper
