#include "sim/plan/plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/plan/air_table_request.hpp"
#include "sim/plan/fine_grid.hpp"
#include "sim/plan/kernel_family.hpp"
#include "sim/world/coverage.hpp"

namespace pitviper {
namespace {

bool sameKernel(const Spectrum& a, const Spectrum& b) {
  if (a.factors().size() != b.factors().size()) return false;
  for (size_t i = 0; i < a.factors().size(); ++i) {
    const auto &x = a.factors()[i], &y = b.factors()[i];
    if (x.index() != y.index()) return false;
    if (const auto* t = std::get_if<Spectrum::Table>(&x)) {
      const auto& u = std::get<Spectrum::Table>(y);
      if (t->wavelength_um != u.wavelength_um || t->value != u.value || t->outside != u.outside) return false;
    } else if (const auto* c = std::get_if<Spectrum::Constant>(&x)) {
      if (c->value != std::get<Spectrum::Constant>(y).value) return false;
    } else {
      const auto &b1 = std::get<Spectrum::BlackBody>(x), &b2 = std::get<Spectrum::BlackBody>(y);
      if (b1.temperature_K != b2.temperature_K || b1.scale != b2.scale) return false;
    }
  }
  return true;
}

/// The user's sampling of a response; narrow lines of the scene, which it would step over or hit by chance, have nodes of their own.
std::vector<QuadratureNode> ruleWithLines(const Simulation& sim, const Spectrum& kernel, const SpectralSampling& sampling) {
  auto rule = spectralRule(kernel, sampling.samples, sampling.spacing);
  const auto lines = narrowLines(spectraOf(sim), kernel, rule);
  if (lines.empty()) return rule;
  rule = spectralRule(kernel * betweenLines(lines), sampling.samples, sampling.spacing);
  const auto own = lineNodes(lines, kernel);
  rule.insert(rule.end(), own.begin(), own.end());
  return rule;
}

}  // namespace

SpectralNode nodeAt(const Simulation& sim, double wavelength_um) {
  SpectralNode node;
  node.members = {{wavelength_um, 1.0}};
  if (sim.air) node.air = sim.air->node(wavelength_um);
  for (const auto& m : sim.materials) node.absorption_per_m.push_back(m->medium ? m->medium->absorption_per_m(wavelength_um) : 0.0);
  return node;
}

std::vector<const ChannelOutput*> differentKernels(std::span<const ChannelOutput> outputs, std::vector<int>* slotOfOutput) {
  std::vector<const ChannelOutput*> slots;
  for (const auto& output : outputs) {
    const auto same = std::find_if(slots.begin(), slots.end(), [&](const auto* s) { return s->apart == output.apart && sameKernel(s->kernel, output.kernel); });
    if (slotOfOutput) slotOfOutput->push_back(static_cast<int>(same - slots.begin()));
    if (same == slots.end()) slots.push_back(&output);
  }
  return slots;
}

Plan makePlan(const Simulation& sim, const std::vector<ChannelOutput>& outputs, const SpectralSampling& sampling, const Location& where) {
  Plan plan;
  plan.terms = termsOf(sim);
  if (plan.terms.surroundings != 0 && !sampling.reference) plan.terms = withSurroundings(plan.terms, plan.surroundings);
  if (plan.terms.streams > 0) plan.streams = plan.terms.streams = sampling.reference ? kFinestStreams : plan.streams;
  plan.lightCount = static_cast<int>(sim.lights.size()) + (sim.sun ? 1 : 0);

  if (plan.terms.air && sim.air->traits().scattersSun && sim.sun)
    plan.sunLegs = SunLegs::of(sim.air, glm::dot(sim.frame.up(glm::dvec3(0.0)), sim.sun->toSun), sim.frame.earthRadius_m());

  for (const auto& output : outputs) requireData(sim, output);
  const auto slots = differentKernels(outputs, &plan.slotOfOutput);
  plan.slotCount = static_cast<int>(slots.size());
  if (plan.slotCount > kMostSlots)
    throw UserError(where, "this camera or probe needs " + std::to_string(plan.slotCount) + " different spectral kernels in one pass", "at most 16",
                    "split the channels over two cameras on the same mount, or ask for fewer quantities");

  std::vector<const Spectrum*> kernels;
  for (const auto* slot : slots) kernels.push_back(&slot->kernel);
  const auto pieces = commonPieces(kernels);
  std::vector<std::vector<QuadratureNode>> rules(slots.size());
  const auto families = sampling.reference ? kernelFamilies(slots) : std::vector<std::vector<size_t>>();
  for (size_t s = 0; s < slots.size(); ++s) {
    const ChannelOutput* slot = slots[s];
    try {
      if (!sampling.reference)
        rules[s] = sampling.shared ? sharedRule(slot->kernel, sampling.samples, sampling.spacing, pieces) : ruleWithLines(sim, slot->kernel, sampling);
      else
        for (const auto& family : families) {
          // Responses of one band at the same wavelengths: what is told of them serves all.
          if (family.front() != s) continue;
          std::vector<const Spectrum*> alike;
          for (size_t k : family) alike.push_back(kernels[k]);
          auto grids = fineGrids(alike, sim);
          for (size_t k = 0; k < family.size(); ++k) rules[family[k]] = std::move(grids[k]);
        }
    } catch (const std::invalid_argument& e) {
      throw UserError(slot->where, "channel '" + slot->channel + "': " + e.what(),
                      sampling.shared ? "a response that these samples integrate to 0.1 %" : "a response above zero somewhere",
                      sampling.shared ? "raise 'samples', use 'spacing: even', or leave out 'shared'" : "check its band or table");
    } catch (const OutsideSpectrum& e) {
      throw UserError(slot->where, "channel '" + slot->channel + "': " + e.what(), "factors of a response that cover its band", "extend the table");
    }
  }
  plan.weight.assign(slots.size(), {});
  for (size_t s = 0; s < slots.size(); ++s) {
    auto sameNodes = [&](const NodeBlock& b) {
      if (static_cast<size_t>(b.count) != rules[s].size()) return false;
      for (int i = 0; i < b.count; ++i)
        if (plan.nodes[static_cast<size_t>(b.first + i)].members.front().wavelength_um != rules[s][static_cast<size_t>(i)].x) return false;
      return true;
    };
    auto block = std::find_if(plan.blocks.begin(), plan.blocks.end(), sameNodes);
    if (block == plan.blocks.end()) {
      plan.blocks.push_back({plan.nodeCount(), static_cast<int>(rules[s].size()), {}});
      for (const auto& n : rules[s]) plan.nodes.push_back(nodeAt(sim, n.x));
      block = plan.blocks.end() - 1;
    }
    block->slots.push_back(static_cast<int>(s));
    for (auto& w : plan.weight) w.resize(plan.nodes.size(), 0.0);
    for (int i = 0; i < block->count; ++i) plan.weight[s][static_cast<size_t>(block->first + i)] = rules[s][static_cast<size_t>(i)].weight;
  }
  for (auto& w : plan.weight) w.resize(plan.nodes.size(), 0.0);
  if (plan.terms.air) sim.air->planTables({sim, plan, nullptr, nullptr, nullptr});
  return plan;
}

Plan someWavelengths(const Plan& plan, int most) {
  Plan some = plan;
  some.nodes.clear(), some.blocks.clear();
  for (auto& w : some.weight) w.clear();
  for (const NodeBlock& b : plan.blocks) {
    const int count = std::min(b.count, most);
    some.blocks.push_back({some.nodeCount(), count, b.slots, b.lit});
    for (int k = 0; k < count; ++k) {
      const int begin = b.first + k * b.count / count, end = b.first + (k + 1) * b.count / count;
      some.nodes.push_back(plan.nodes[static_cast<size_t>((begin + end) / 2)]);
      for (size_t s = 0; s < plan.weight.size(); ++s)
        some.weight[s].push_back(std::accumulate(plan.weight[s].begin() + begin, plan.weight[s].begin() + end, 0.0));
    }
  }
  return some;
}

std::vector<double> Plan::darkFloors() const {
  std::vector<double> floors;
  for (const auto& w : weight) floors.push_back(darkFloor(0.0, std::accumulate(w.begin(), w.end(), 0.0)));
  return floors;
}

}  // namespace pitviper
