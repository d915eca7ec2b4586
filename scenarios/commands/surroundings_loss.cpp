#include "scenarios/commands/surroundings_loss.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/print.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiance/node_surroundings.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

constexpr double kWavelengths_um[] = {0.55, 1.6, 4.0, 10.0};
constexpr double kBody_K = 300.0;
constexpr int kDegrees[] = {0, 2, 3, 4};
constexpr double kDegree = kPi / 180.0;

std::vector<SurfaceView> viewsOf() {
  std::vector<SurfaceView> all;
  for (double tilt : {0.0, 45.0, 90.0, 135.0})
    for (int turn = 0; turn < (tilt > 0.0 ? 4 : 1); ++turn) {
      const double t = tilt * kDegree, a = (20.0 + 90.0 * turn) * kDegree;
      const glm::dvec3 normal(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)),
          x(std::cos(t) * std::cos(a), std::cos(t) * std::sin(a), -std::sin(t)), y = glm::cross(normal, x);
      for (double view : {5.0, 30.0, 55.0, 75.0, 85.0})
        for (double around : {30.0, 160.0, 275.0}) {
          const double v = view * kDegree, p = around * kDegree;
          all.push_back({normal, std::cos(v) * normal + std::sin(v) * (std::cos(p) * x + std::sin(p) * y), 0.0});
        }
    }
  return all;
}

}  // namespace

std::string surroundingsLoss(const Simulation& sim) {
  const Material& m = sim.materialOf(sim.entities[0].surfaces[0]);
  std::vector<SpectralNode> nodes;
  for (double w : kWavelengths_um)
    if (w >= m.validLow_um() && w <= m.validHigh_um()) nodes.push_back(nodeAt(sim, w));
  if (nodes.empty() || m.reflections.empty()) return "";
  const NodeSurroundings whole(sim, nodes, Terms::kWhole);
  std::vector<std::unique_ptr<NodeSurroundings>> told;
  for (int degree : kDegrees) told.push_back(std::make_unique<NodeSurroundings>(sim, nodes, degree));
  struct Sums {
    double squares = 0.0, most = 0.0;
  };
  std::vector<std::vector<Sums>> errors(nodes.size(), std::vector<Sums>(told.size()));
  std::vector<double> radiance2(nodes.size(), 0.0), reflected(nodes.size(), 0.0), all(nodes.size(), 0.0);
  const auto views = viewsOf();
  const double count = static_cast<double>(views.size());
  for (const SurfaceView& view : views) {
    const auto sumOver = [&](const NodeSurroundings& light) {
      std::vector<double> sum(nodes.size(), 0.0);
      for (const auto& r : m.reflections) {
        const std::vector<double> own = light.reflected(*r, view);
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
      }
      return sum;
    };
    const std::vector<double> exact = sumOver(whole);
    const double angle = std::acos(glm::dot(view.normal, view.toViewer));
    std::vector<double> size;
    for (size_t i = 0; i < nodes.size(); ++i) {
      const double w = nodes[i].members.front().wavelength_um;
      size.push_back(exact[i] + m.emissivity(w, angle) * physics::planckRadiance(w, kBody_K));
      radiance2[i] += size[i] * size[i], reflected[i] += exact[i], all[i] += size[i];
    }
    for (size_t d = 0; d < told.size(); ++d) {
      const std::vector<double> found = sumOver(*told[d]);
      for (size_t i = 0; i < nodes.size(); ++i) {
        const double error = std::abs(found[i] - exact[i]);
        errors[i][d].squares += error * error;
        errors[i][d].most = std::max(errors[i][d].most, error);
      }
    }
  }
  std::string out =
      "\nLight from all around (clear sky by day over soil), errors of the radiance of a surface of 300 K over that radiance's root mean square:\n"
      "root mean square, largest\n"
      "| wavelength [um] | reflected part | its mean alone | 9 harmonics | 16 | 25 |\n|---|---|---|---|---|---|\n";
  for (size_t i = 0; i < nodes.size(); ++i) {
    out += print("| %.4g | %.2g %% |", nodes[i].members.front().wavelength_um, 100.0 * reflected[i] / all[i]);
    for (const Sums& s : errors[i]) {
      out += print(" %.2g %%, %.2g %% |", 100.0 * std::sqrt(s.squares / radiance2[i]), 100.0 * s.most / std::sqrt(radiance2[i] / count));
    }
    out += "\n";
  }
  return out;
}

}  // namespace pitviper
