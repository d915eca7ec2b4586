// `pitviper audit`: a user's own check of the promise. Whole frames by their plan and by the reference along the same lines, every pixel compared.
#include <algorithm>
#include <cstdio>
#include <set>

#include "scenarios/commands/accuracy_error.hpp"
#include "scenarios/commands/accuracy_renderings.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/scenario_wish.hpp"
#include "sim/camera/camera_pointer.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/image/png.hpp"
#include "sim/image/preview.hpp"
#include "sim/model/stage.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/table.hpp"
#include "sim/run/memory_need.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

constexpr int kBeyondAsked = 4;  ///< exit code

/// What a layer's pixels are off by; layers of one kernel are one.
struct AuditedLayer {
  std::string name;
  std::optional<double> predicted;
  ErrorFigures found;
  double beyond = 0.0;  ///< share of pixels that are farther off than asked
  ComparedPixel worst;
  double planned = 0.0, reference = 0.0;  ///< of the worst pixel: integral of kernel times radiance
  std::vector<double> errors;             ///< of every pixel that is compared
};

std::vector<AuditedLayer> layersOf(const Camera& camera, const Plan& plan, const std::vector<std::vector<double>>& drawn,
                                   std::vector<std::vector<double>> exact) {
  std::vector<AuditedLayer> all;
  std::set<int> seen;
  for (size_t o = 0; o < drawn.size(); ++o) {
    if (!seen.insert(plan.slotOfOutput[o]).second || drawn[o].empty()) continue;
    const ChannelReference reference(camera.outputs[o].kernel, std::move(exact[o]));
    AuditedLayer layer;
    layer.name = camera.outputs[o].layer();
    layer.predicted = predictedError(plan, static_cast<size_t>(plan.slotOfOutput[o]));
    layer.errors = reference.relative(drawn[o]);
    std::vector<double> sorted = layer.errors;
    layer.found = figuresOf(sorted);
    const auto count = std::count_if(sorted.begin(), sorted.end(), [&](double e) { return !(e <= plan.accuracy); });
    layer.beyond = static_cast<double>(count) / static_cast<double>(sorted.size());
    const auto worst = static_cast<size_t>(std::max_element(layer.errors.begin(), layer.errors.end()) - layer.errors.begin());
    layer.worst = placeOf(worst, camera);
    layer.planned = drawn[o][worst];
    layer.reference = reference.values()[worst];
    all.push_back(std::move(layer));
  }
  return all;
}

/// Each layer's errors in the frame where the largest of it lies.
void writePicture(const std::filesystem::path& file, const Camera& camera, const std::vector<int>& numbers, const std::vector<AuditedLayer>& layers) {
  const auto pixels = static_cast<size_t>(camera.pinhole.width) * static_cast<size_t>(camera.pinhole.height);
  std::vector<Rgb8Image> pictures;
  for (const AuditedLayer& layer : layers) {
    std::vector<float> errors(pixels, 0.0f);
    for (size_t p = 0; p < pixels; ++p) errors[p] = static_cast<float>(100.0 * layer.errors[static_cast<size_t>(layer.worst.frame) * pixels + p]);
    PreviewOptions look;
    look.title = camera.name + " " + layer.name + ", frame " + std::to_string(numbers[static_cast<size_t>(layer.worst.frame)]) + ": off by";
    look.unit = "% of the reference";
    pictures.push_back(makePreview(camera.pinhole.width, camera.pinhole.height, errors, look));
  }
  writePng(file, placeSideBySide(pictures));
}

std::string percent(double share) { return print("%.3g", 100.0 * share); }

std::string csvOf(const std::string& camera, double asked, const std::vector<int>& numbers, const std::vector<AuditedLayer>& layers) {
  std::string text;
  for (const AuditedLayer& l : layers) {
    text += print("%s,%s,%.6g,%s,%.6g,%.6g,%.6g,%.6g,%d,%d,%d,%.9g,%.9g\n", camera.c_str(), l.name.c_str(), asked,
                  l.predicted ? std::to_string(*l.predicted).c_str() : "", l.found.median, l.found.percentile99, l.found.maximum, l.beyond,
                  numbers[static_cast<size_t>(l.worst.frame)], l.worst.column, l.worst.row, l.planned, l.reference);
  }
  return text;
}

struct AuditWish {
  ScenarioWish scenario;
  std::string frames, out;
  std::vector<std::string> cameras;
};

int audit(const AuditWish& w) {
  const Simulation sim = w.scenario.read();
  refuseBeyondMemory(sim);
  std::vector<std::string> names;
  for (const Camera& c : sim.cameras) names.push_back(c.name);
  for (const std::string& name : w.cameras)
    if (std::find(names.begin(), names.end(), name) == names.end()) throw unknownWord({"--camera " + name, 0, 0, -1}, "there is no camera", name, names);
  std::set<int> chosen{0, sim.time.frames / 2, sim.time.frames - 1};
  if (!w.frames.empty()) {
    chosen.clear();
    const auto [first, last] = framesWanted(w.frames, sim);
    for (int n = first; n <= last; ++n) chosen.insert(n);
  }
  const std::vector<int> numbers(chosen.begin(), chosen.end());
  const std::filesystem::path out = w.out;
  if (!out.empty()) ensureWritableFolder(out);
  const GlContext context;
  const auto scene = std::make_shared<const GpuScene>(sim);
  std::string csv = "camera,layer,asked [1],predicted [1],median [1],99 of 100 [1],largest [1],beyond asked [1],frame,column,row,planned,reference\n";
  bool isBroken = false;
  for (const Camera& base : sim.cameras) {
    if (!w.cameras.empty() && std::find(w.cameras.begin(), w.cameras.end(), base.name) == w.cameras.end()) continue;
    if (base.spectral.reference)
      throw UserError(base.where, "camera '" + base.name + "' draws the reference itself", "an accuracy, or none", "add --set accuracy='1 %'");
    // As a run draws it, by the plan that a run finds in its cache.
    Camera camera = drawnCamera(base);
    std::vector<WorldState> states;
    const StateAt world = [&sim](double t) { return advance(sim, t); };
    std::optional<CameraPointer> pointer;
    if (base.follower) pointer.emplace(sim, base);
    for (int n : numbers) {
      if (pointer) pointer->tickTo(world, n);
      states.push_back((pointer ? pointer->around(world) : world)(sim.time.at(n)));
    }
    ComparedFrames frames{std::move(states), {}};
    Progress progress("audit of camera " + camera.name, 2 * static_cast<int>(numbers.size()));
    progress.phase("planning camera " + camera.name);
    Renderings planned(sim, camera, camera.spectral, scene);
    const auto drawn = planned.draw(frames, [&] { progress.step(); });
    camera.sharesShading = false;
    camera.truth = {};
    Renderings exact(sim, camera, referenceSampling(), scene);
    exact.renderer().setProgress([&](double share) { progress.within(share); });
    auto found = exact.draw(frames, [&] { progress.step(); });
    progress.withdraw();
    const Plan& plan = planned.plan();
    const auto layers = layersOf(camera, plan, drawn, std::move(found));
    std::printf(
        "camera %s: %zu frame%s of %dx%d pixels of %dx%d lines, by the plan (%d wavelengths) and by the reference along the same lines (%d wavelengths)\n",
        camera.name.c_str(), numbers.size(), numbers.size() == 1 ? "" : "s", camera.pinhole.width, camera.pinhole.height, camera.samples, camera.samples,
        plan.nodeCount(), exact.plan().nodeCount());
    for (const AuditedLayer& l : layers) {
      const bool broken = plan.accuracy > 0.0 && !(l.found.maximum <= plan.accuracy);
      isBroken |= broken;
      std::printf("  %s: largest %s %%, 99 of 100 pixels within %s %%, half within %s %%", l.name.c_str(), percent(l.found.maximum).c_str(),
                  percent(l.found.percentile99).c_str(), percent(l.found.median).c_str());
      if (plan.accuracy > 0.0) std::printf("; asked %s %%", percent(plan.accuracy).c_str());
      if (l.predicted) std::printf(", predicted %s %%", percent(*l.predicted).c_str());
      std::printf("; worst at %d,%d of frame %d: %.6g for %.6g\n", l.worst.column, l.worst.row, numbers[static_cast<size_t>(l.worst.frame)], l.planned,
                  l.reference);
      if (broken) std::printf("    beyond what was asked in %s %% of the pixels\n", percent(l.beyond).c_str());
    }
    csv += csvOf(camera.name, plan.accuracy, numbers, layers);
    if (!out.empty() && !layers.empty()) writePicture(out / (camera.name + "_audit.png"), camera, numbers, layers);
  }
  if (!out.empty()) writeFileAtomically(out / "audit.csv", csv);
  return isBroken ? kBeyondAsked : 0;
}

}  // namespace

CommandLine auditCommand() {
  const auto w = std::make_shared<AuditWish>();
  return {{"audit", "SCENARIO.yaml", "hold a scenario's pictures against the reference, pixel by pixel: is what was asked for kept?"},
          "Draws frames (the first, the middle and the last) of each camera as run does, by its plan, and again by the reference: every wavelength, in double "
          "precision, along the same lines (subpixels, views of small bodies and of bright parts). Prints what each layer's pixels are off by, |L - Lref| / "
          "max(Lref, 1e-3 x the 99th percentile of Lref), beside what was asked and predicted, and where the worst is. The reference takes seconds to minutes "
          "a frame: --set cameras.seeker.film.width=64 and so on makes it quicker. Exit code 4 where a pixel is farther off than was asked.\n"
          "The same by hand: run, then run --set accuracy=reference --plan FOLDER/CAMERA.plan draws the reference along that run's lines, to another --out. A "
          "reference without that plan looks along its own lines (all subpixels, 256 across a small body): outlines and small bodies then differ.",
          joined({{"--frames", "A:B", "these frames, both included; of an exposure with motion its middle", into(w->frames)},
                  {"--camera", "NAME...", "this camera alone", into(w->cameras)},
                  {"--out", "FOLDER", "also audit.csv and CAMERA_audit.png, a picture of the errors; created if missing", into(w->out)}},
                 scenarioOptions(w->scenario)),
          [w](const Arguments& words) { return w->scenario.file = words[0], audit(*w); }};
}

}  // namespace pitviper
