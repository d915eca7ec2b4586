#include "scenarios/commands/accuracy_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "scenarios/commands/accuracy_renderings.hpp"
#include "scenarios/commands/accuracy_report.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/scenario_wish.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"

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
  for (double accuracy : {0.1, 0.03, 0.01, 0.003, 0.001}) {
    SpectralSampling s;
    s.accuracy = accuracy;
    all.push_back({AccuracySetting::Kind::Planned, print("%g %%", 100.0 * accuracy), s});
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

namespace {

struct AccuracyWish {
  ScenarioWish scenario;
  int size_px = 0;  ///< columns of the film; 0: as it is
  int frames = 3;
  std::string out;
};

AccuracyReport measureAccuracy(const AccuracyWish& wish) {
  Simulation sim = wish.scenario.read();
  if (sim.cameras.empty()) throw UserError({wish.scenario.file, 0, 0, -1}, "the scenario has no camera", "at least one", "choose another scenario");
  sim.cameras.resize(1);
  Camera& camera = sim.cameras[0];
  keepRadianceAlone(camera);
  if (wish.size_px > 0) resizeFilm(camera.pinhole, wish.size_px);
  const int frames = std::min(wish.frames, sim.time.frames);
  std::vector<WorldState> states;
  std::string numbers;
  for (int i = 0; i < frames; ++i) {
    const int number = (2 * i + 1) * sim.time.frames / (2 * frames);
    states.push_back(advance(sim, sim.time.at(number)));
    numbers += (i == 0 ? "" : i + 1 < frames ? ", " : " and ") + std::to_string(number);
  }
  const auto scene = std::make_shared<const GpuScene>(sim);

  ComparedFrames compared{states, {}};
  Progress waiting("reference", frames);
  Renderings truth(sim, camera, referenceSampling(), scene);
  truth.renderer().setProgress([&](double share) { waiting.within(share); });
  std::vector<std::vector<double>> found = truth.draw(compared, [&] { waiting.step(); });
  waiting.finish();
  std::vector<ChannelReference> reference;
  for (size_t c = 0; c < found.size(); ++c) reference.emplace_back(camera.outputs[c].kernel, std::move(found[c]));

  AccuracyReport report;
  report.heading =
      print("%s, camera %s, %dx%d pixels of %dx%d subpixels, frame%s %s, against the reference (%d wavelengths)", sim.name.c_str(), camera.name.c_str(),
            camera.pinhole.width, camera.pinhole.height, camera.samples, camera.samples, frames == 1 ? "" : "s", numbers.c_str(), truth.plan().nodeCount());

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

int bench(const AccuracyWish& w) {
  if (!w.out.empty()) ensureWritableFolder(w.out);
  const GlContext context;
  const AccuracyReport report = measureAccuracy(w);
  std::printf("%s\n%s\n%s", report.heading.c_str(), context.limits().renderer.c_str(), accuracyTables(report).c_str());
  if (w.out.empty()) return 0;
  std::printf("\n");
  const auto charts = accuracyCharts(report);
  writeWithCharts(w.out, "accuracy", accuracyCsv(report), charts, std::min(static_cast<int>(charts.size()), 4));
  return 0;
}

}  // namespace

CommandLine accuracyBenchCommand() {
  const auto w = std::make_shared<AccuracyWish>();
  return {{"bench --accuracy", "SCENARIO.yaml"},
          "The scenario's first camera at accuracies of 10 to 0.1 %, at 4 to 340 even samples and at 16 Gauss points a channel, against the reference (double "
          "precision on the CPU, every wavelength; slow). Prints frames a second and the error of each channel's pixels, |L - Lref| / max(Lref, 1e-3 x the "
          "99th percentile of Lref), and as a temperature difference. The error is that of spectral sampling, tables, dropped terms and single precision; what "
          "a pixel sees is the same on both sides.",
          joined({{"--size", "N", "columns of the film, its field of view kept", number(w->size_px, {8, 4096, "", false, "not a number of columns"})},
                  {"--frames", "N", "frames, spread over the scenario's time", number(w->frames, {1, 1000, "", false, "not a number of frames to compare"})},
                  {"--out", "FOLDER", "also write accuracy.csv and a chart, accuracy.png (needs VTK)", into(w->out)}},
                 scenarioOptions(w->scenario)),
          [w](const Arguments& words) { return w->scenario.file = words[0], bench(*w); }};
}

}  // namespace pitviper
