#include "sim/plan/sampling_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "sim/plan/fine_grid.hpp"
#include "sim/plan/scene_spectra.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

/// c2 / (lambda T) beyond which a black body sends less than 1e-17 of its c1L / lambda^5.
constexpr double kWien = 40.0;

/// Integral between the knots of two spectra, eight Gauss points each.
double fineIntegral(const Spectrum& kernel, const Spectrum& absorption, const std::function<double(double)>& f) {
  std::vector<double> at;
  const double low = kernel.supportLow(), high = kernel.supportHigh();
  for (const Spectrum* s : {&kernel, &absorption})
    for (double k : s->knots())
      if (k > low && k < high) at.push_back(k);
  at.insert(at.end(), {low, high});
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  double sum = 0.0;
  for (size_t i = 0; i + 1 < at.size(); ++i)
    for (const QuadratureNode& n : gaussLegendre(8, at[i], at[i + 1])) sum += n.weight * kernel(n.x) * f(n.x);
  return sum;
}

}  // namespace

std::vector<SamplingNote> checkSampling(const Simulation& sim, const Plan& plan, const std::vector<ChannelOutput>& outputs, double allowed) {
  std::map<std::pair<std::string, std::string>, SamplingNote> worst;
  for (const Entity& e : sim.entities) {
    const Medium* medium = sim.mediumOf(e);
    if (!medium || medium->absorption_per_m.isConstant()) continue;
    const Surface& s = e.surfaces.front();
    // Over the scenario's times: where it is hottest it shines most.
    const double temperature_K = s.temperature.empty() ? s.temperature_K : s.temperature.range(sim.time.at(0), sim.time.at(sim.time.frames - 1)).second;
    for (size_t o = 0; o < outputs.size(); ++o) {
      // Where the gas does not shine to speak of (smoke at 290 K in the visible), its error matters to nobody.
      if (kSecondRadiation_umK / (outputs[o].kernel.supportHigh() * temperature_K) > kWien) continue;
      for (double part : {0.1, 1.0}) {
        const double thickness_m = part * static_cast<double>(e.boundingRadius_m);
        auto emitted = [&](double w) { return physics::planckRadiance(w, temperature_K) * physics::oneMinusExp(medium->absorption_per_m(w) * thickness_m); };
        const double fine = fineIntegral(outputs[o].kernel, medium->absorption_per_m, emitted);
        if (!(fine > 0.0)) continue;
        double planned = 0.0;
        for (size_t i = 0; i < plan.nodes.size(); ++i) {
          const double weight = plan.weight[static_cast<size_t>(plan.slotOfOutput[o])][i];
          if (weight == 0.0) continue;
          const SpectralNode& n = plan.nodes[i];
          const double absorption = n.absorption_per_m[static_cast<size_t>(e.surfaces.front().material)];
          planned += weight * n.planck(temperature_K) * physics::oneMinusExp(absorption * thickness_m);
        }
        SamplingNote note{sim.materialOf(e.surfaces.front()).name, outputs[o].channel, thickness_m, std::abs(planned / fine - 1.0)};
        SamplingNote& kept = worst[{note.medium, note.channel}];
        if (note.error > kept.error) kept = note;
      }
    }
  }
  std::vector<SamplingNote> notes;
  for (const auto& [key, note] : worst)
    if (note.error > allowed) notes.push_back(note);
  std::sort(notes.begin(), notes.end(), [](const SamplingNote& a, const SamplingNote& b) { return a.error > b.error; });
  return notes;
}

std::vector<FringeNote> checkFringes(const Simulation& sim, const Plan& plan, const std::vector<ChannelOutput>& outputs, double allowed) {
  constexpr double kRoom_K = 300.0;
  std::vector<FringeNote> notes;
  if (fringedOf(sim).empty()) return notes;
  std::map<std::string, bool> seen;
  for (size_t o = 0; o < outputs.size(); ++o) {
    if (!seen.try_emplace(outputs[o].channel, true).second) continue;
    const auto grid = fineGrid(outputs[o].kernel, sim);
    const auto& weight = plan.weight[static_cast<size_t>(plan.slotOfOutput[o])];
    const bool thermal = kSecondRadiation_umK / (outputs[o].kernel.supportHigh() * kRoom_K) < kWien;
    for (const auto& m : sim.materials) {
      const bool fringed = std::any_of(m->reflections.begin(), m->reflections.end(), [](const auto& r) { return dynamic_cast<const HasFringes*>(r.get()); });
      if (!fringed) continue;
      double fine = 0.0, planned = 0.0, all = 0.0;
      for (const QuadratureNode& n : grid) fine += n.weight * m->reflectance(n.x, 0.0), all += n.weight;
      for (size_t i = 0; i < plan.nodes.size(); ++i)
        if (weight[i] != 0.0) planned += weight[i] * plan.nodes[i].mean([&](double w) { return m->reflectance(w, 0.0); });
      const double off = std::abs(planned - fine), of = thermal ? std::min(fine, all - fine) : fine;
      if (off > allowed * of) notes.push_back({m->name, outputs[o].channel, of > 0.0 ? off / of : 1.0});
    }
  }
  std::sort(notes.begin(), notes.end(), [](const FringeNote& a, const FringeNote& b) { return a.error > b.error; });
  return notes;
}

}  // namespace pitviper
