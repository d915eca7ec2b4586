#include "scenarios/commands/geometry_report.hpp"

#include <cmath>
#include <set>

#include "sim/camera/small_bodies.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr int kMostSamples = 16, kBlock = 4;
/// Of a body's intensity.
constexpr double kWorthSaying = 0.01;

std::string percent(double part) { return print("%.2g %%", 100.0 * part); }

}  // namespace

double edgeError(int samples, int pixels) { return std::sqrt(0.0724 * pixels / std::pow(samples, 3.0)) / (pixels * pixels); }

std::string edgeText(const Camera& c, double accuracy) {
  std::string text = "edges: samples " + (c.sharesShading ? "auto" : std::to_string(c.samples)) + " leave a pixel that one crosses off by " +
                     percent(edgeError(c.samples, 1)) + " of the contrast beside it (1 sigma), means of 4x4 pixels by " + percent(edgeError(c.samples, kBlock));
  if (accuracy <= 0.0) return text;
  int enough = 1;
  while (enough < kMostSamples && edgeError(enough, kBlock) > accuracy) ++enough;
  if (edgeError(enough, kBlock) > accuracy)
    return text + "; no samples bring these to " + percent(accuracy) + ": the nearest is " + percent(edgeError(enough, kBlock)) + ", with samples " +
           std::to_string(enough);
  if (enough > c.samples) text += "; " + percent(accuracy) + " of these takes samples " + std::to_string(enough);
  return text;
}

std::string geometryText(const Simulation& sim, const Camera& c, const Plan& plan) {
  std::string text = "    " + edgeText(c, plan.accuracy) + "\n";
  if (c.outlineAccuracy > 0.0 || c.spectral.reference) return text;
  HotParts parts(sim, plan, kWorthSaying * 4.0);
  std::set<std::string> named;
  for (int frame : {0, sim.time.frames / 2, sim.time.frames - 1}) {
    const WorldState state = advance(sim, sim.time.at(frame));
    const View view = cameraView(c, state, c.samples);
    std::vector<char> present(sim.entities.size(), 1);
    if (c.mount.carrier >= 0) present[static_cast<std::size_t>(c.mount.carrier)] = 0;
    const double limit = c.smallBody_px * c.samples;
    for (const Ball& b : parts.inView(state, view, limit, findSmallBodies(sim, state, view, limit), present)) {
      const Entity& e = sim.entities[static_cast<std::size_t>(b.entity)];
      const std::string name = e.name + "'s " + e.mesh->parts[e.surfaces[static_cast<std::size_t>(b.surface)].meshPart].name;
      if (!named.insert(name).second) continue;
      text += print(
          "    %s: %.2g pixels wide in frame %d: its outline leaves the body's intensity off by more than %s; %san 'accuracy' samples such parts by "
          "themselves\n",
          name.substr(0, 120).c_str(), extentOf(b, view) / c.samples, frame, percent(kWorthSaying).c_str(),
          c.samples < kMostSamples ? "more 'samples' help, and " : "");
    }
  }
  return text;
}

}  // namespace pitviper
