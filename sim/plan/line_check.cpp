#include "sim/plan/line_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/parameters/on_threads.hpp"
#include "sim/plan/budget.hpp"
#include "sim/plan/sights.hpp"
#include "sim/radiance/node_sum.hpp"

namespace pitviper {
namespace {

/// Numbers of places tried, which are held against all that the air's model has, and lines looked at, of the film and of the extremes.
constexpr int kTried[] = {5, 9, 18, 36, 72};
constexpr size_t kLooked = 20;
/// Lines of each frame in which filmFloors() looks for how dark the film gets, at least.
constexpr int kFewestLines = 12;

/// Whether a node of the plan leaves a kind of terms out.
bool isDropped(const Plan& plan, const Terms& all, TermKind kind, const NodeBlock& block) {
  switch (kind) {
    case TermKind::Ambient:
      return all.ambient && !plan.terms.ambient;
    case TermKind::ScatteredSun:
      return all.scatteredSun && !plan.terms.scatteredSun;
    case TermKind::ScatteredAgain:
      return all.streams > 0 && plan.terms.streams == 0;
    case TermKind::Sun:
    case TermKind::Lights:
      return all.lights && (!plan.terms.lights || !block.lit);
    default:
      return false;
  }
}

/// What each slot of a line lacks by the terms that a plan leaves out.
std::vector<double> droppedOf(const Plan& plan, const Terms& all, const NodeSum& sum) {
  std::vector<double> lost(plan.weight.size(), 0.0);
  for (const NodeBlock& b : plan.blocks)
    for (int kind = 0; kind < kTermKinds; ++kind) {
      if (!isDropped(plan, all, static_cast<TermKind>(kind), b)) continue;
      const auto part = sum.part(static_cast<TermKind>(kind));
      for (int s : b.slots)
        for (int i = b.first; i < b.first + b.count; ++i)
          lost[static_cast<size_t>(s)] += plan.weight[static_cast<size_t>(s)][static_cast<size_t>(i)] * part[static_cast<size_t>(i)];
    }
  return lost;
}

/// Tells a line once to all.
class AllSums final : public TermSink {
 public:
  explicit AllSums(std::vector<std::unique_ptr<NodeSum>>& sums) : sums_(sums) {}
  void restart() override {
    for (auto& sum : sums_) sum->restart();
  }
  void term(const Term& t) override {
    for (auto& sum : sums_) sum->term(t);
  }
  void segment(const Segment& s) override {
    for (auto& sum : sums_) sum->segment(s);
  }
  void pane(const Factor& transmittance, double modifier) override {
    for (auto& sum : sums_) sum->pane(transmittance, modifier);
  }

 private:
  std::vector<std::unique_ptr<NodeSum>>& sums_;
};

}  // namespace

std::vector<double> slotsOf(const Plan& plan, std::span<const double> radiance) {
  std::vector<double> slots(plan.weight.size(), 0.0);
  for (size_t s = 0; s < slots.size(); ++s)
    for (size_t i = 0; i < radiance.size(); ++i) slots[s] += plan.weight[s][i] * radiance[i];
  return slots;
}

RadianceScene sceneOf(const Simulation& sim, const Plan& fine, const ShadowCaster& shadows, const SightRay& ray, int places) {
  RadianceScene scene{sim, fine.terms, fine.sunLegs.get(), *ray.state, {}, places};
  if (fine.terms.shadows)
    scene.lit = [&](const Hit& hit, size_t light, const LightLeg& leg) {
      const double radius_m = light < sim.lights.size() ? sim.lights[light].radius_m : 0.0;
      return shadows.lit(*ray.state, hit, leg.toLight, leg.distance_m - radius_m) ? 1.0 : 0.0;
    };
  return scene;
}

std::vector<double> filmFloors(const Simulation& sim, const NodesOfPlan& fine, SightRays& rays, const PlanEffort& effort) {
  const Plan& plan = fine.plan;
  const int all = sim.time.frames, looked = std::min(all, effort.floorFrames), each = std::max(effort.floor / looked, kFewestLines);
  std::vector<SightRay> lines;
  for (int k = 0; k < looked; ++k) {
    const int frame = k == 0 ? 0 : k == looked - 1 ? all - 1 : std::min(static_cast<int>((k + rays.dice().unit()) * all / looked), all - 1);
    for (SightRay& ray : rays.overFilm(each, frame)) lines.push_back(std::move(ray));
  }
  const ShadowCaster shadows(sim);
  std::vector<std::vector<double>> seen(lines.size());
  onAllThreads(lines.size(), [&](const auto& next) {
    NodeSum sum(fine.spectra);
    for (size_t n = next(); n < lines.size(); n = next()) {
      sum.begin();
      radianceAlong(sceneOf(sim, plan, shadows, lines[n], kUsualPlaces), lines[n].line, sum);
      seen[n] = slotsOf(plan, sum.radiance());
    }
  });
  std::vector<double> floors = plan.darkFloors();
  for (size_t s = 0; s < floors.size(); ++s) {
    double darkest = INFINITY;
    for (int k = 0; k < looked; ++k) {
      std::vector<double> frame;
      for (int n = k * each; n < (k + 1) * each; ++n) frame.push_back(seen[static_cast<size_t>(n)][s]);
      std::sort(frame.begin(), frame.end());
      darkest = std::min(darkest, frame[frame.size() * kBrightPercent / 100]);
    }
    floors[s] = std::max(floors[s], kDark * darkest);
  }
  return floors;
}

int airPlacesFor(const Simulation& sim, const NodesOfPlan& fine, SightRays& rays, double accuracy, const std::vector<double>& floor) {
  if (!fine.plan.terms.air || !sim.air->traits().variesAlongWay) return kTried[0];
  std::vector<SightRay> lines;
  const auto& extremes = rays.extremes();
  for (size_t n = 0; n < std::min(kLooked, extremes.size()); ++n) lines.push_back(extremes[n * extremes.size() / std::min(kLooked, extremes.size())]);
  for (size_t n = 0; n < kLooked; ++n) lines.push_back(rays.fromFilm());
  const Plan& plan = fine.plan;
  std::vector<std::vector<double>> all(lines.size()), slots(lines.size());
  const auto tellAll = [&](const std::function<void(size_t, std::span<const double>)>& take, int places) {
    onAllThreads(lines.size(), [&](const auto& next) {
      NodeSum sum(fine.spectra);
      for (size_t n = next(); n < lines.size(); n = next()) {
        sum.begin();
        radianceAlong({sim, plan.terms, plan.sunLegs.get(), *lines[n].state, {}, places}, lines[n].line, sum);
        take(n, sum.radiance());
      }
    });
  };
  tellAll(
      [&](size_t n, std::span<const double> found) {
        all[n].assign(found.begin(), found.end());
        slots[n] = slotsOf(plan, found);
      },
      0);
  // Differences are added without their signs: what one wavelength loses and another wins cancels in a channel, but not in a group that holds only one of them.
  const auto isEnough = [&](int places) {
    std::vector<char> missed(lines.size(), 0);
    tellAll(
        [&](size_t n, std::span<const double> found) {
          for (size_t s = 0; s < slots[n].size(); ++s) {
            double lost = 0.0;
            for (size_t i = 0; i < found.size(); ++i) lost += plan.weight[s][i] * std::abs(found[i] - all[n][i]);
            if (lost > budget::kAirPlaces.of(accuracy) * std::max(slots[n][s], floor[s])) missed[n] = 1;
          }
        },
        places);
    return std::none_of(missed.begin(), missed.end(), [](char m) { return m != 0; });
  };
  for (int places : kTried)
    if (isEnough(places)) return places;
  return kTried[std::size(kTried) - 1];
}

HeldLines::HeldLines(const Simulation& simulation, const NodesOfPlan& fine, std::vector<SightRay> lines, int places, std::vector<double> floor)
    : sim_(simulation), fine_(fine), lines_(std::move(lines)), places_(places), floor_(std::move(floor)) {}

std::vector<LineFigures> HeldLines::check(const NodesOfPlan& of) {
  const Plan &fine = fine_.plan, &plan = of.plan;
  const ShadowCaster shadows(sim_);
  const bool isKnown = !exact_.empty() || lines_.empty();
  exact_.resize(lines_.size());
  struct Sums {
    std::vector<double> planned, dropped;
  };
  std::vector<Sums> sums(lines_.size());
  onAllThreads(lines_.size(), [&](const auto& next) {
    std::vector<std::unique_ptr<NodeSum>> own;  // of the plan and, where that is not known, in full
    own.push_back(std::make_unique<NodeSum>(of.spectra));
    own.back()->keepParts();
    if (!isKnown) own.push_back(std::make_unique<NodeSum>(fine_.spectra));
    AllSums all(own);
    for (size_t n = next(); n < lines_.size(); n = next()) {
      const SightRay& ray = lines_[n];
      const RadianceScene scene = sceneOf(sim_, fine, shadows, ray, places_);
      for (auto& sum : own) sum->begin();
      radianceAlong(scene, ray.line, all);
      if (ray.lamp >= 0) lampAlong(scene, ray.line, static_cast<size_t>(ray.lamp), ray.pixel_sr, all);
      if (!isKnown) exact_[n] = slotsOf(fine, own.back()->radiance());
      sums[n] = {slotsOf(plan, own.front()->radiance()), droppedOf(plan, fine.terms, *own.front())};
    }
  });
  std::vector<LineFigures> figures(fine.weight.size());
  for (size_t s = 0; s < figures.size(); ++s) {
    LineFigures& f = figures[s];
    for (size_t n = 0; n < lines_.size(); ++n) {
      const double exact = exact_[n][s], size = std::max(std::abs(exact), floor_[s]), difference = std::abs(sums[n].planned[s] - exact);
      f.errors.push_back(size > 0.0 ? difference / size : difference > 0.0 ? INFINITY : 0.0);
      f.left.push_back(size > 0.0 ? std::abs(sums[n].dropped[s]) / size : 0.0);
      f.largest = std::max(f.largest, f.errors.back());
      f.dropped = std::max(f.dropped, f.left.back());
    }
  }
  return figures;
}

std::vector<LineFigures> checkLines(const Simulation& sim, const NodesOfPlan& plan, const NodesOfPlan& fine, const std::vector<SightRay>& lines, int places,
                                    const std::vector<double>& floor) {
  return HeldLines(sim, fine, lines, places, floor).check(plan);
}

Plan ofSlots(const Plan& plan, const std::vector<size_t>& slots) {
  Plan some = plan;
  some.nodes.clear(), some.blocks.clear(), some.weight.assign(slots.size(), {});
  some.slotCount = static_cast<int>(slots.size());
  for (const NodeBlock& b : plan.blocks) {
    NodeBlock own{some.nodeCount(), b.count, {}, b.lit};
    for (size_t k = 0; k < slots.size(); ++k)
      if (std::find(b.slots.begin(), b.slots.end(), static_cast<int>(slots[k])) != b.slots.end()) own.slots.push_back(static_cast<int>(k));
    if (own.slots.empty()) continue;
    for (int i = b.first; i < b.first + b.count; ++i) {
      some.nodes.push_back(plan.nodes[static_cast<size_t>(i)]);
      for (size_t k = 0; k < slots.size(); ++k) some.weight[k].push_back(plan.weight[slots[k]][static_cast<size_t>(i)]);
    }
    some.blocks.push_back(std::move(own));
  }
  const auto pick = [&](auto& of) {
    if (of.empty()) return;
    const auto all = of;
    of.clear();
    for (size_t s : slots) of.push_back(all[s]);
  };
  pick(some.predictedError), pick(some.parts), pick(some.fineCount), pick(some.surroundingsLoss), pick(some.streamsLoss);
  for (TermShare& term : some.shares) pick(term.share);
  return some;
}

Plan ofOutputs(const Plan& plan, size_t first, size_t count) {
  std::vector<size_t> slots;
  std::vector<int> slotOfOutput;
  for (size_t o = first; o < first + count; ++o) {
    const auto slot = static_cast<size_t>(plan.slotOfOutput[o]);
    const auto at = std::find(slots.begin(), slots.end(), slot);
    slotOfOutput.push_back(static_cast<int>(at - slots.begin()));
    if (at == slots.end()) slots.push_back(slot);
  }
  Plan some = ofSlots(plan, slots);
  some.slotOfOutput = std::move(slotOfOutput);
  return some;
}

}  // namespace pitviper
