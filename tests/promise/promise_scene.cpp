#include "tests/promise/promise_scene.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "scenarios/commands/accuracy_error.hpp"
#include "scenarios/commands/accuracy_renderings.hpp"
#include "sim/world/world.hpp"
#include "tests/promise/random_dice.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Both sides draw small bodies by views of so many samples across. The reference works every one of them out: with the usual 256 that is some
/// hundred times the film.
constexpr int kZoomedSamples = 16;

double secondsSince(std::chrono::steady_clock::time_point start) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }

/// An own folder of plans, emptied for each scenario: none is found again that another left. (What the driver keeps beside them stays.)
class OwnCache {
 public:
  OwnCache() : folder_(std::filesystem::temp_directory_path() / ("pitviper_promise_" + std::to_string(getpid()))) {
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  }
  ~OwnCache() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  OwnCache(const OwnCache&) = delete;
  OwnCache& operator=(const OwnCache&) = delete;
  void forget() const { std::filesystem::remove_all(folder_ / "pitviper"); }

 private:
  std::filesystem::path folder_;
};

}  // namespace

PromiseScene keepPromise(std::uint64_t seed, const std::string& scenario, const std::vector<double>& accuracies, bool automatic) {
  static const OwnCache plans;
  plans.forget();
  needContext();
  PromiseScene out;
  out.seed = seed;
  out.text = scenario;
  Simulation sim = scene(scenario);
  sim.cameras.resize(1);
  Camera& camera = sim.cameras[0];
  keepRadianceAlone(camera);
  camera.zoomedSamples = kZoomedSamples;
  if (automatic) camera.samples = 2, camera.sharesShading = true;
  const auto gpu = std::make_shared<const GpuScene>(sim);
  std::vector<WorldState> states;
  for (int f = 0; f < sim.time.frames; ++f) {
    states.push_back(advance(sim, sim.time.at(f)));
    RandomDice dice(seed + 977 * static_cast<std::uint64_t>(f));
    if (camera.follower && dice.chance(0.6)) {  // wherever its gimbal may look
      const double across = dice.between(0.0, 1.0), up = dice.between(0.0, 1.0);
      states.back() = pointed(states.back(), camera, camera.follower->anywhere(followerTick(camera, states.back(), f), {across, up}));
    }
  }
  ComparedFrames compared{states, {}};

  const auto draw = [&](const SpectralSampling& sampling, std::vector<std::vector<double>>& pixels) {
    auto renderings = std::make_unique<Renderings>(sim, camera, sampling, gpu);
    pixels = renderings->draw(compared);
    for (const auto& channel : pixels) out.negative += static_cast<int>(std::count_if(channel.begin(), channel.end(), [](double l) { return l < 0.0; }));
    return renderings;
  };

  auto start = std::chrono::steady_clock::now();
  std::vector<std::vector<double>> found;
  draw(referenceSampling(), found);
  out.reference_s = secondsSince(start);
  out.pixels = static_cast<int>(found.empty() ? 0 : found.front().size());
  std::vector<ChannelReference> reference;
  for (size_t c = 0; c < found.size(); ++c) reference.emplace_back(camera.outputs[c].kernel, std::move(found[c]));

  start = std::chrono::steady_clock::now();
  for (double accuracy : accuracies) {
    SpectralSampling sampling;
    sampling.accuracy = accuracy;
    std::vector<std::vector<double>> pixels;
    const auto renderings = draw(sampling, pixels);
    const Plan& plan = renderings->plan();
    for (size_t c = 0; c < pixels.size(); ++c) {
      const auto slot = static_cast<size_t>(plan.slotOfOutput[c]);
      PromiseCell cell;
      cell.seed = seed;
      cell.channel = camera.outputs[c].channel;
      cell.asked = accuracy;
      cell.predicted = predictedError(plan, slot).value_or(0.0);
      if (slot < plan.parts.size())
        cell.ofWavelengths = plan.parts[slot].wavelengths, cell.ofTables = plan.parts[slot].tables, cell.extremes = plan.parts[slot].extremes;
      cell.groups = static_cast<int>(std::count_if(plan.weight[slot].begin(), plan.weight[slot].end(), [](double w) { return w != 0.0; }));
      cell.wavelengths = slot < plan.fineCount.size() ? plan.fineCount[slot] : 0;
      auto errors = reference[c].relative(pixels[c]);
      for (double& e : errors)
        if (std::isnan(e)) e = INFINITY;
      if (!errors.empty()) {
        const auto worst = static_cast<size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
        cell.found = errors[worst];
        cell.beyond =
            static_cast<double>(std::count_if(errors.begin(), errors.end(), [&](double e) { return e > accuracy; })) / static_cast<double>(errors.size());
        static_cast<ComparedPixel&>(cell.worst) = placeOf(worst, camera);
        cell.worst.planned = pixels[c][worst];
        cell.worst.reference = reference[c].values()[worst];
      }
      out.cells.push_back(std::move(cell));
    }
  }
  out.planned_s = secondsSince(start);
  return out;
}

}  // namespace pitviper::test
