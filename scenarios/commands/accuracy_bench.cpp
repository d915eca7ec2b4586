#include "scenarios/commands/accuracy_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "scenarios/commands/accuracy_renderings.hpp"
#include "scenarios/commands/progress.hpp"
#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

/// The best of so many: what else runs on the machine only ever adds time.
constexpr int kRounds = 6;

double secondsOf(const std::chrono::steady_clock::duration& d) { return std::chrono::duration<double>(d).count(); }

AccuracyRow rowOf(const AccuracySetting& setting, const Camera& camera, const Plan& plan, const std::vector<ChannelReference>& reference,
                  const std::vector<std::vector<double>>& rendered) {
  AccuracyRow row;
  row.setting = setting;
  row.nodes = plan.nodeCount();
  for (size_t c = 0; c < reference.size(); ++c) {
    const auto slot = static_cast<size_t>(plan.slotOfOutput[c]);
    const auto& weights = plan.weight[slot];
    const auto own = std::count_if(weights.begin(), weights.end(), [](double w) { return w != 0.0; });
    row.channels.push_back({camera.outputs[c].channel, static_cast<int>(own), predictedError(plan, slot), reference[c].errors(rendered[c])});
  }
  return row;
}

}  // namespace

std::vector<AccuracySetting> accuracyLadder() {
  std::vector<AccuracySetting> all;
  char name[32];
  for (double accuracy : {0.1, 0.03, 0.01, 0.003, 0.001}) {
    SpectralSampling s;
    s.accuracy = accuracy;
    std::snprintf(name, sizeof name, "%g %%", 100.0 * accuracy);
    all.push_back({AccuracySetting::Kind::Planned, name, s});
  }
  all.push_back({AccuracySetting::Kind::Gauss, "Gauss 16", {16, Spacing::Gauss}});
  for (int samples : {4, 8, 16, 32, 64, 128, 256, 340})
    all.push_back({AccuracySetting::Kind::Even, "even " + std::to_string(samples), {samples, Spacing::Even}});
  return all;
}

void resizeFilm(Pinhole& p, int columns) {
  const double width = p.width * p.pitchX_m, height = p.height * p.pitchY_m;
  p.height = std::max(1, static_cast<int>(std::lround(static_cast<double>(p.height) * columns / p.width)));
  p.width = columns;
  p.pitchX_m = width / p.width;
  p.pitchY_m = height / p.height;
}

AccuracyReport measureAccuracy(const AccuracyRequest& request) {
  Simulation sim = request.scenario.read();
  if (sim.cameras.empty()) throw UserError({request.scenario.file, 0, 0, -1}, "the scenario has no camera", "at least one", "choose another scenario");
  sim.cameras.resize(1);
  Camera& camera = sim.cameras[0];
  keepRadianceAlone(camera);
  if (request.size_px > 0) resizeFilm(camera.pinhole, request.size_px);
  const int frames = std::min(request.frames, sim.time.frames);
  std::vector<WorldState> states;
  std::string numbers;
  for (int i = 0; i < frames; ++i) {
    const int number = (2 * i + 1) * sim.time.frames / (2 * frames);
    states.push_back(advance(sim, sim.time.at(number)));
    numbers += (i == 0 ? "" : i + 1 < frames ? ", " : " and ") + std::to_string(number);
  }
  const auto scene = std::make_shared<const GpuScene>(sim);

  ComparedFrames compared = comparedFrames(sim, camera, states);
  Progress waiting("reference", frames);
  Renderings truth(sim, camera, referenceSampling(), scene);
  truth.renderer().setProgress([&](double share) { waiting.within(share); });
  std::vector<std::vector<double>> found = truth.draw(compared, [&] { waiting.step(); });
  waiting.finish();
  std::vector<ChannelReference> reference;
  for (size_t c = 0; c < found.size(); ++c) reference.emplace_back(camera.outputs[c].kernel, std::move(found[c]));

  AccuracyReport report;
  const int count = compared.leftOut();
  const std::string skipped = count > 0 ? "; " + std::to_string(count) + " pixels on outlines of transparent things left out" : "";
  char heading[512];
  std::snprintf(heading, sizeof heading, "%s, camera %s, %dx%d pixels of %dx%d subpixels, frame%s %s, against the reference (%d wavelengths)%s",
                sim.name.c_str(), camera.name.c_str(), camera.pinhole.width, camera.pinhole.height, camera.samples, camera.samples, frames == 1 ? "" : "s",
                numbers.c_str(), truth.plan().nodeCount(), skipped.c_str());
  report.heading = heading;

  const auto ladder = accuracyLadder();
  Progress progress("accuracies", static_cast<int>(ladder.size()) * (1 + kRounds));
  std::vector<std::unique_ptr<Renderings>> drawn;
  for (const AccuracySetting& setting : ladder) {
    try {
      auto renderings = std::make_unique<Renderings>(sim, camera, setting.sampling, scene);
      report.rows.push_back(rowOf(setting, camera, renderings->plan(), reference, renderings->draw(compared)));
      drawn.push_back(std::move(renderings));
    } catch (const GlError& e) {
      report.missing.push_back(setting.name + ": " + e.what());
    }
    progress.step();
  }
  std::vector<std::vector<double>> best(drawn.size(), std::vector<double>(states.size(), 1e30));
  for (int round = 0; round < kRounds; ++round)
    for (size_t k = 0; k < drawn.size(); ++k) {
      const size_t i = round % 2 == 0 ? k : drawn.size() - 1 - k;
      for (size_t f = 0; f < states.size(); ++f) {
        const auto start = std::chrono::steady_clock::now();
        drawn[i]->renderer().render(states[f]);
        best[i][f] = std::min(best[i][f], secondsOf(std::chrono::steady_clock::now() - start));
      }
      progress.step();
    }
  progress.finish();
  for (size_t i = 0; i < drawn.size(); ++i) {
    double sum = 0.0;
    for (double s : best[i]) sum += s;
    report.rows[i].framesPerSecond = static_cast<double>(states.size()) / sum;
  }
  return report;
}

}  // namespace pitviper
