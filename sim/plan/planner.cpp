#include "sim/plan/planner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace pitviper {
namespace {

/// Of the error asked for: what groups may take of the products they are fitted to, and of those they are not.
constexpr double kFitted = 0.3, kUnseen = 0.5;
/// Lines of sight to fit to and to check with.
constexpr int kDrawn = 400, kFresh = 800;
constexpr int kMostGroups = 64;

/// A group of a channel's fine wavelengths as a node of the scene.
SpectralNode nodeOf(const Simulation& sim, const FineGrid& grid, const SpectralGroup& group, const std::vector<int>& absorbers) {
  SpectralNode node;
  node.absorption_per_m.assign(sim.materials.size(), 0.0);
  AirNode mean;
  double turned = 0.0, scattered = 0.0;
  for (const auto& [index, share] : group.members) {
    const auto i = static_cast<size_t>(index);
    node.members.push_back({grid.wavelength_um[i], share});
    mean.source += share * grid.air[i].source;
    for (size_t k = 0; k < kMostAirAmounts; ++k) {
      mean.molecules[k] += share * grid.air[i].molecules[k];
      mean.haze[k] += share * grid.air[i].haze[k];
      turned += share * grid.air[i].haze[k] * grid.air[i].asymmetry;
      scattered += share * grid.air[i].haze[k];
    }
  }
  node.air.source = mean.source;
  node.air.asymmetry = scattered > 0.0 ? turned / scattered : 0.0;
  for (size_t a = 0; a < absorbers.size(); ++a) {
    const auto k = static_cast<size_t>(absorbers[a]);
    if (k < kMostAirAmounts) node.air.extinction[k] = group.extinction[a];
    else node.absorption_per_m[k - kMostAirAmounts] = group.extinction[a];
  }
  // What is scattered is averaged, not fitted: which absorber a fit puts extinction on is of no matter to transmittance, but would be here.
  node.air.molecules = mean.molecules;
  node.air.haze = mean.haze;
  return node;
}

}  // namespace

Plan planFor(const Simulation& sim, const Eye& eye) {
  const auto& outputs = eye.camera ? eye.camera->outputs : eye.probe->outputs;
  const SpectralSampling& sampling = eye.camera ? eye.camera->spectral : eye.probe->spectral;
  const Location& where = eye.camera ? eye.camera->where : eye.probe->where;
  Plan plan = makePlan(sim, outputs, sampling, where);
  if (sampling.reference || !(sampling.accuracy > 0.0)) return plan;

  std::vector<const ChannelOutput*> slots(static_cast<size_t>(plan.slotCount), nullptr);
  for (size_t o = 0; o < outputs.size(); ++o)
    if (!slots[static_cast<size_t>(plan.slotOfOutput[o])]) slots[static_cast<size_t>(plan.slotOfOutput[o])] = &outputs[o];
  const auto begin = std::chrono::steady_clock::now();
  auto tell = [&](const char* what) {
    if (std::getenv("PITVIPER_PLAN_TIMES"))
      std::fprintf(stderr, "%8.3f s %s\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), what);
  };
  const Sights drawn(sim, plan, eye, kDrawn, 1), fresh(sim, plan, eye, kFresh, 2);
  tell("drawn");
  plan.nodes.clear();
  plan.blocks.clear();
  std::vector<std::vector<double>> weights;
  for (int s = 0; s < plan.slotCount; ++s) {
    const FineGrid grid = fineGridOf(sim, slots[static_cast<size_t>(s)]->kernel);
    tell("grid");
    const auto absorbers = drawn.absorbers(grid);
    const SpectralProblem problem = drawn.problem(grid, absorbers);
    const SpectralProblem check = fresh.problem(grid, absorbers);
    tell("problems");
    const GroupFit fit = fitToTolerance(problem, kFitted * sampling.accuracy, kMostGroups);
    tell("fitted");
    const GroupFit seen = evaluateGroups(check, fit.groups);
    plan.predictedError.push_back(std::max(fit.maximum, seen.maximum));
    if (std::getenv("PITVIPER_PLAN_TIMES")) {
      size_t terms = 0;
      for (const auto& p : problem.products) terms += p.terms.size();
      std::fprintf(stderr, "%s: %zu fine, %zu spectra, %zu paths, %zu terms, %zu absorbers -> %zu groups, %.5f fitted, %.5f unseen, p99 %.5f\n",
                   slots[static_cast<size_t>(s)]->channel.c_str(), grid.weight.size(), problem.spectra.size(), problem.paths.size(), terms, absorbers.size(),
                   fit.groups.size(), fit.maximum, seen.maximum, seen.p99);
    }
    plan.blocks.push_back({plan.nodeCount(), static_cast<int>(fit.groups.size()), {s}});
    for (const SpectralGroup& g : fit.groups) plan.nodes.push_back(nodeOf(sim, grid, g, absorbers));
    weights.emplace_back();
    for (const SpectralGroup& g : fit.groups) weights.back().push_back(g.weight);
  }
  plan.weight.assign(slots.size(), std::vector<double>(plan.nodes.size(), 0.0));
  for (size_t s = 0; s < slots.size(); ++s) std::copy(weights[s].begin(), weights[s].end(), plan.weight[s].begin() + plan.blocks[s].first);
  tell("done");
  return plan;
}

}  // namespace pitviper
