#include "scenarios/commands/first_once.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numeric>

#include "scenarios/commands/bench_timing.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/run_timing.hpp"
#include "sim/gl/context.hpp"
#include "sim/gl/timing.hpp"
#include "sim/gl/undrawn.hpp"
#include "sim/parameters/error.hpp"
#include "sim/run/camera_line.hpp"
#include "sim/run/memory_need.hpp"
#include "sim/run/run.hpp"

namespace pitviper {
namespace {

/// Frames of the yardstick, whose median counts.
constexpr int kYardsticks = 9;
/// Frames without drawing at most.
constexpr std::size_t kUndrawn = 50;

struct Clocks {
  double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  double work_s = workSoFar_s();
};

void put(FirstFigures& into, const std::string& name, const Clocks& from, const Clocks& to) {
  into[name] = to.wall_s - from.wall_s;
  into[name + "_work"] = to.work_s - from.work_s;
}

/// The most that this process has had resident; not of what it was before it became this program, as getrusage() has it.
double peakMemory_MB() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kB = 0.0;
    if (word == "VmHWM:" && status >> kB) return kB / 1024.0;
  }
  return 0.0;
}

/// Every camera of a scenario, one frame after the other.
class Cameras {
 public:
  explicit Cameras(const Simulation& sim) : sim_(sim), scene_(std::make_shared<const GpuScene>(sim)) {
    for (const Camera& camera : sim.cameras)
      lines_.push_back(std::make_unique<CameraLine>(sim, camera, shaderLibrary(), scene_, std::function<void(double)>()));
  }
  void warmUp() {
    for (const auto& line : lines_) line->warmUp(0);
  }
  void draw(int number) {
    const StateAt stateAt = [this](double t) { return advance(sim_, t); };
    const WorldState state = stateAt(sim_.time.at(number));
    for (const auto& line : lines_) {
      line->begin(stateAt, state.time_s, number);
      line->frame(line->finish(), state, number);
      if (line->camera().follower) line->takePoses();
    }
  }
  /// Gimbals go on from where they are: such a scenario has no frame twice.
  bool mayBeginAgain() const {
    return std::none_of(lines_.begin(), lines_.end(), [](const auto& line) { return line->camera().follower.has_value(); });
  }
  int groups() const {
    return std::accumulate(lines_.begin(), lines_.end(), 0, [](int sum, const auto& line) { return sum + line->renderer().plan().nodeCount(); });
  }

 private:
  const Simulation& sim_;
  std::shared_ptr<const GpuScene> scene_;
  std::vector<std::unique_ptr<CameraLine>> lines_;
};

void measureFrames(Cameras& cameras, const Simulation& sim, const OnceRequest& request, FirstFigures& into) {
  const int most = cameras.mayBeginAgain() ? request.frames : std::min(request.frames, sim.time.frames - 1);
  std::vector<double> each, work, own;
  const Clocks start;
  for (int k = 1; k <= most && Clocks().wall_s - start.wall_s < request.most_s; ++k) {
    const double before = workSoFar_s();
    each.push_back(timed([&] { cameras.draw(k % sim.time.frames); }));
    work.push_back(workSoFar_s() - before);
  }
  into["frames"] = static_cast<double>(each.size());
  if (each.empty()) return;
  if (cameras.mayBeginAgain()) {
    const Undrawn undrawn;
    for (std::size_t k = 1; k <= std::min(each.size(), kUndrawn); ++k) own.push_back(timed([&] { cameras.draw(static_cast<int>(k) % sim.time.frames); }));
    into["frame_own"] = 1e3 * median(own);
  }
  into["frame_work"] = median(work);  // a few, in which a driver compiles, are not what frames take
  into["frame_most_at"] = static_cast<double>(std::max_element(each.begin(), each.end()) - each.begin() + 1);
  into["programs_later"] = static_cast<double>(programsSoFar().programs) - into["programs_made"];
  std::sort(each.begin(), each.end());
  const auto percentile = [&](double share) { return each[static_cast<std::size_t>(std::ceil(share * static_cast<double>(each.size()))) - 1]; };
  into["frame_50"] = 1e3 * percentile(0.5);
  into["frame_99"] = 1e3 * percentile(0.99);
  into["frame_most"] = 1e3 * each.back();
}

void measureYardstick(const GlContext& context, FirstFigures& into) {
  Yardstick yardstick;
  std::vector<double> wall, work;
  timed([&] { yardstick.draw(); });
  for (int k = 0; k < kYardsticks; ++k) {
    const double before = workSoFar_s();
    wall.push_back(timed([&] { yardstick.draw(); }));
    work.push_back(workSoFar_s() - before);
  }
  into["yardstick"] = 1e3 * median(wall);
  // Elsewhere than on this processor its work says nothing of the processor's speed.
  if (context.limits().renderer.find("llvmpipe") != std::string::npos) into["yardstick_work"] = median(work);
}

}  // namespace

FirstFigures measureOnce(const OnceRequest& request) {
  FirstFigures figures;
  const Clocks start;
  const Simulation sim = request.scenario.read();
  const Clocks read;
  put(figures, "reading", start, read);
  if (sim.cameras.empty())
    throw UserError({request.scenario.file, 0, 0, -1}, "the scenario has no camera, so there is no picture to wait for", "one under 'cameras:'",
                    "choose another scenario");
  refuseBeyondMemory(sim);
  const GlContext context;
  Timing timing;
  std::optional<TimedPart> part(kPreparingPart);
  Cameras cameras(sim);
  part.reset();
  part.emplace(kFirstFramePart);
  cameras.warmUp();
  cameras.draw(0);
  part.reset();
  timing.end();
  put(figures, "picture", start, Clocks());
  for (const char* stage : {"planning", "tables", "programs", "first_frame"}) figures[stage] = figures[std::string(stage) + "_work"] = 0.0;
  for (const auto& [name, seconds] : timing.seconds()) figures[stageOf(name)] += seconds;
  for (const auto& [name, seconds] : timing.workSeconds()) figures[stageOf(name) + "_work"] += seconds;
  const ProgramCount programs = programsSoFar();
  figures["programs_made"] = static_cast<double>(programs.programs);
  figures["program_lines"] = static_cast<double>(programs.lines);
  figures["groups"] = cameras.groups();
  measureFrames(cameras, sim, request, figures);
  figures["memory"] = peakMemory_MB();
  measureYardstick(context, figures);
  return figures;
}

}  // namespace pitviper
