#include "sim/plan/planner.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <future>
#include <thread>

#include "sim/plan/channel_fit.hpp"
#include "sim/plan/plan_cache.hpp"

namespace pitviper {
namespace {

/// A group of a channel's fine wavelengths as a node of the scene.
SpectralNode nodeOf(const Simulation& sim, const ChannelFit& fit, const SpectralGroup& group) {
  const FineGrid& grid = fit.grid;
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
  for (size_t a = 0; a < fit.absorbers.size(); ++a) {
    const auto k = static_cast<size_t>(fit.absorbers[a]);
    if (k < kMostAirAmounts) node.air.extinction[k] = group.extinction[a];
    else node.absorption_per_m[k - kMostAirAmounts] = group.extinction[a];
  }
  // What is scattered is averaged, not fitted: which absorber a fit puts extinction on is of no matter to transmittance, but would be here.
  node.air.molecules = mean.molecules;
  node.air.haze = mean.haze;
  return node;
}

/// On as many threads as the machine has.
void fitAll(std::vector<ChannelFit>& fits, const std::function<ChannelFit(size_t)>& fit) {
  std::atomic<size_t> next{0};
  auto work = [&] {
    for (size_t s = next++; s < fits.size(); s = next++) fits[s] = fit(s);
  };
  std::vector<std::future<void>> others;
  for (unsigned t = 1; t < std::min<size_t>(std::thread::hardware_concurrency(), fits.size()); ++t) others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& o : others) o.get();
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
  const ContentKey key = planKey(sim, plan, eye);
  if (readCachedPlan(key, plan)) return plan;
  const Sights sights(sim, plan, eye, kSights, static_cast<unsigned long long>(sim.seed));
  std::vector<ChannelFit> fits(slots.size());
  fitAll(fits, [&](size_t s) { return fitChannel(sim, sights, slots[s]->kernel, sampling.accuracy); });

  plan.nodes.clear();
  plan.blocks.clear();
  for (size_t s = 0; s < fits.size(); ++s) {
    plan.blocks.push_back({plan.nodeCount(), static_cast<int>(fits[s].groups.size()), {static_cast<int>(s)}});
    for (const SpectralGroup& g : fits[s].groups) plan.nodes.push_back(nodeOf(sim, fits[s], g));
    plan.predictedError.push_back(fits[s].error);
  }
  plan.weight.assign(slots.size(), std::vector<double>(plan.nodes.size(), 0.0));
  for (size_t s = 0; s < slots.size(); ++s)
    for (size_t g = 0; g < fits[s].groups.size(); ++g) plan.weight[s][static_cast<size_t>(plan.blocks[s].first) + g] = fits[s].groups[g].weight;
  writeCachedPlan(key, plan);
  return plan;
}

}  // namespace pitviper
