#include "sim/plan/plan_fits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include "sim/parameters/on_threads.hpp"
#include "sim/plan/budget.hpp"
#include "sim/plan/kernel_family.hpp"
#include "sim/plan/plan_effort.hpp"

namespace pitviper {
namespace {

/// The most checks until one is passed, and how often a fit learns from lines that it is held against.
constexpr int kChecks = 6, kLearn = 4;
/// Where the products do not show what a line is off by, all products are fitted closer: by what is allowed over what was found, and a little more, but at most
/// to half.
constexpr double kTightened = 0.9, kLeastPart = 0.5;
/// An error of which learning leaves more than this part is none that groups could mend.
constexpr double kHopeless = 0.9;
/// At shorter wavelengths the air and the textures of usual scenes send no thermal light to speak of.
constexpr double kThermal_um = 1.2;

double cloudAmount(const Simulation& sim, size_t absorber) { return sim.air ? shellAmount(*sim.air, absorber) : 0.0; }

/// A group of a channel's fine wavelengths as a node of the scene.
SpectralNode nodeOf(const Simulation& sim, const ChannelFit& fit, const SpectralGroup& group) {
  const FineGrid& grid = fit.grid();
  SpectralNode node;
  node.absorption_per_m.assign(sim.materials.size(), 0.0);
  double turnedBy = 0.0, scattered = 0.0;
  std::array<double, kMostAirAmounts> turned{};  ///< on a way straight through clouds
  const bool hasClouds = sim.air && !sim.air->shells().empty();
  std::vector<AirNode> members;
  // What is scattered is averaged, not fitted: which absorber a fit puts extinction on is of no matter to transmittance, but would be here.
  for (const auto& [index, share] : group.members) {
    const AirNode& air = grid.air[static_cast<size_t>(index)];
    node.members.push_back({grid.wavelength_um[static_cast<size_t>(index)], share});
    if (hasClouds) members.push_back(air);
    node.air.source += share * air.source;
    for (size_t k = 0; k < kMostAirAmounts; ++k) {
      node.air.molecules[k] += share * air.molecules[k];
      node.air.haze[k] += share * air.haze[k];
      node.air.extinction[k] += share * air.extinction[k];  // of what is not fitted
      turnedBy += share * air.haze[k] * air.meanAsymmetry;
      if (hasClouds) turned[k] += share * turnedThrough(*sim.air, air, k);
      scattered += share * air.haze[k];
    }
  }
  node.air.meanAsymmetry = scattered > 0.0 ? turnedBy / scattered : 0.0;
  node.air.asymmetry.fill(node.air.meanAsymmetry);
  // Absorbers of a kind keep one asymmetry in common; without clouds there is one kind.
  for (const auto& kind : hasClouds ? particleKinds(members) : ParticleKinds()) {
    double byKind = 0.0, ofKind = 0.0;
    for (const auto& [index, share] : group.members)
      for (size_t k : kind) {
        const AirNode& air = grid.air[static_cast<size_t>(index)];
        byKind += share * air.haze[k] * air.asymmetry[k], ofKind += share * air.haze[k];
      }
    for (size_t k : kind) node.air.asymmetry[k] = ofKind > 0.0 ? byKind / ofKind : node.air.meanAsymmetry;
  }
  for (size_t a = 0; a < fit.absorbers().size(); ++a) {
    const auto k = static_cast<size_t>(fit.absorbers()[a]);
    if (k < kMostAirAmounts) {
      // Of a cloud that nothing is seen through a fit may say anything of its extinction; what it sends goes by what it turns.
      if (const double depth = cloudAmount(sim, k) * group.extinction[a]; depth > 0.0)
        node.air.haze[k] = std::min(turned[k] * depth / physics::oneMinusExp(depth), group.extinction[a]);
      node.air.extinction[k] = group.extinction[a];
    } else node.absorption_per_m[k - kMostAirAmounts] = group.extinction[a];
  }
  return node;
}

/// On as many threads as the machine has.
void forAll(const std::vector<size_t>& fits, const std::function<void(size_t)>& work) {
  onAllThreads(fits.size(), [&](const auto& next) {
    for (size_t k = next(); k < fits.size(); k = next()) work(fits[k]);
  });
}

/// Lines that no fit has seen.
std::vector<SightRay> secondLines(SightRays& rays, int count) {
  std::vector<SightRay> lines;
  for (int n = 0; n < count; ++n) lines.push_back(n % 4 != 0 ? rays.fromFilm() : rays.ofCombination());
  return lines;
}

/// The shortest wavelength at which a channel sees black bodies.
double shortestOf(const std::vector<const ChannelOutput*>& slots) {
  double shortest_um = INFINITY;
  for (const ChannelOutput* s : slots)
    if (s->kernel.supportHigh() > kThermal_um) shortest_um = std::min(shortest_um, std::max(s->kernel.supportLow(), kThermal_um));
  return shortest_um;
}

/// What of the accuracy light from all around and light scattered again leave to a slot.
double leftOf(const Plan& plan, size_t slot) {
  const auto lostBy = [&](const std::vector<double>& all, const Account& account) {
    return all.empty() ? 0.0 : std::min(all[slot], account.of(plan.accuracy));
  };
  return plan.accuracy - lostBy(plan.surroundingsLoss, budget::kSurroundings) - lostBy(plan.streamsLoss, budget::kStreams);
}

size_t mostOf(const std::vector<std::vector<size_t>>& families) {
  size_t most = 0;
  for (const auto& f : families) most = std::max(most, f.size());
  return most;
}

}  // namespace

void CheckedLines::add(const std::vector<SightRay>& more, const std::vector<LineFigures>& theirs) {
  addSome(more, theirs, [](const SightRay&) { return true; });
}

void CheckedLines::addSome(const std::vector<SightRay>& more, const std::vector<LineFigures>& theirs, const std::function<bool(const SightRay&)>& wanted) {
  figures.resize(theirs.size());
  for (size_t n = 0; n < more.size(); ++n) {
    if (!wanted(more[n])) continue;
    lines.push_back(more[n]);
    for (size_t s = 0; s < figures.size(); ++s) {
      if (theirs[s].errors.empty()) continue;
      LineFigures& f = figures[s];
      f.errors.push_back(theirs[s].errors[n]);
      f.left.push_back(theirs[s].left[n]);
      f.largest = std::max(f.largest, f.errors.back());
      f.dropped = std::max(f.dropped, f.left.back());
    }
  }
}

PlanFits::PlanFits(const Simulation& simulation, const Eye& eye, const Plan& plan, const std::vector<const ChannelOutput*>& slots, const NodesOfPlan& fine,
                   HeldLines& extremes, SightRays& rays, const std::vector<double>& floor, int airPlaces, int lastPlaces,
                   const std::function<void(double)>& tell)
    : sim_(simulation),
      fine_(fine),
      rays_(rays),
      floor_(floor),
      lastPlaces_(lastPlaces),
      tell_(tell),
      plan_(plan),
      slots_(kernelFamilies(slots)),
      sights_(simulation, plan_, rays, shortestOf(slots), airPlaces, mostOf(slots_)),
      extremes_(extremes),
      second_(simulation, fine, secondLines(rays, effortOf(plan.accuracy).second), lastPlaces, floor) {
  std::vector<size_t> all;
  for (const auto& family : slots_) {
    all.push_back(fits_.size());
    std::vector<const Spectrum*> kernels;
    double left = plan.accuracy;
    for (size_t s : family) kernels.push_back(&slots[s]->kernel), left = std::min(left, leftOf(plan, s));
    fits_.push_back(std::make_unique<ChannelFit>(simulation, kernels, left));
  }
  sights_.begin(effortOf(plan.accuracy).first, eye.camera ? eye.camera->learnt : std::vector<FilmPlace>());
  tell_(0.1);
  forAll(all, [&](size_t f) {
    std::vector<double> floors;
    for (size_t s : slots_[f]) floors.push_back(floor_[s]);
    fits_[f]->begin(sights_, std::move(floors));
  });
  hold(all);
}

std::vector<size_t> PlanFits::learn(const CheckedLines& checked, const std::vector<size_t>& slots, const std::vector<double>& allowed) {
  std::vector<size_t> fits, changed;
  for (size_t f = 0; f < fits_.size(); ++f)
    if (std::any_of(slots_[f].begin(), slots_[f].end(), [&](size_t s) { return std::find(slots.begin(), slots.end(), s) != slots.end(); })) fits.push_back(f);
  std::vector<std::vector<SpectralGroup>> before;
  for (size_t f : fits) before.push_back(fits_[f]->groups());
  teach(checked, fits, allowed);
  hold(fits);
  for (size_t k = 0; k < fits.size(); ++k)
    if (fits_[fits[k]]->groups() != before[k]) changed.insert(changed.end(), slots_[fits[k]].begin(), slots_[fits[k]].end());
  std::sort(changed.begin(), changed.end());
  return changed;
}

void PlanFits::teach(const CheckedLines& checked, const std::vector<size_t>& fits, const std::vector<double>& allowed) {
  std::set<size_t> missed;
  for (size_t f : fits)
    for (size_t s : slots_[f])
      for (size_t n = 0; n < checked.figures[s].errors.size(); ++n)
        if (checked.figures[s].errors[n] > std::min(budget::kLearnt.of(plan_.accuracy), kTightened * allowed[s]) ||
            checked.figures[s].left[n] > budget::kTerms.of(plan_.accuracy))
          missed.insert(n);
  const size_t first = sights_.size();
  for (size_t n : missed) sights_.add(checked.lines[n], true);
  forAll(fits, [&](size_t f) {
    double part = kTightened;
    for (size_t s : slots_[f]) part = std::min(part, kTightened * allowed[s] / std::max(checked.figures[s].largest, 1e-300));
    fits_[f]->learn(sights_, first, std::max(part, kLeastPart));
  });
}

/// Checks fits on new lines, and holds them against the equation on the second ones, until they are within the accuracy or enough was tried.
void PlanFits::hold(const std::vector<size_t>& fits) {
  std::vector<size_t> open = fits;
  std::vector<double> before(fits_.size(), INFINITY);
  std::vector<double> allowed;
  for (size_t s = 0; s < floor_.size(); ++s)
    allowed.push_back(budget::kHeld.share * (sim_.fields.empty() ? 1.0 : 1.0 - budget::kFields.share) * leftOf(plan_, s));
  for (int attempt = 0;; ++attempt) {
    for (int n = 0; n < kChecks && !open.empty(); ++n) {
      tell_(0.5 + 0.5 * (attempt + static_cast<double>(n) / kChecks) / (kLearn + 1));
      sights_.draw(effortOf(plan_.accuracy).check);
      forAll(open, [&](size_t f) { fits_[f]->check(sights_); });
      std::erase_if(open, [&](size_t f) { return fits_[f]->holds(); });
    }
    if (attempt == kLearn) return;
    takeNodes(plan_);
    const NodesOfPlan nodes(sim_, plan_, &fine_);
    CheckedLines seen;
    seen.add(extremes_.lines(), extremes_.check(nodes));
    seen.add(second_.lines(), second_.check(nodes));
    open.clear();
    for (size_t f : fits) {
      double largest = 0.0;
      bool isHeld = true;
      for (size_t s : slots_[f]) largest = std::max(largest, seen.figures[s].largest), isHeld &= seen.figures[s].largest <= allowed[s];
      if (isHeld || before[f] == 0.0) continue;
      if (largest > kHopeless * before[f]) {
        fits_[f]->goBack();
        before[f] = 0.0;
        continue;
      }
      before[f] = largest;
      open.push_back(f);
    }
    if (open.empty()) return;
    teach(seen, open, allowed);
  }
}

void PlanFits::takeNodes(Plan& plan) const {
  plan.nodes.clear();
  plan.blocks.clear();
  plan.shares.clear();
  for (int k = 0; k < kTermKinds; ++k) plan.shares.push_back({nameOf(static_cast<TermKind>(k)), std::vector<double>(floor_.size(), 0.0), true});
  plan.weight.assign(floor_.size(), {});
  plan.fineCount.assign(floor_.size(), 0);
  for (size_t f = 0; f < fits_.size(); ++f) {
    const ChannelFit& fit = *fits_[f];
    plan.blocks.push_back({plan.nodeCount(), static_cast<int>(fit.groups().size()), {slots_[f].begin(), slots_[f].end()}});
    for (size_t k = 0; k < slots_[f].size(); ++k) {
      const size_t s = slots_[f][k];
      plan.weight[s].assign(plan.nodes.size(), 0.0);
      for (const SpectralGroup& g : fit.groups()) plan.weight[s].push_back(fit.weightOf(g, k));
      plan.fineCount[s] = static_cast<int>(fit.grid().weight.size());
      for (size_t t = 0; t < fit.shares().size(); ++t) plan.shares[t].share[s] = fit.shares()[t];
    }
    for (const SpectralGroup& g : fit.groups()) plan.nodes.push_back(nodeOf(sim_, fit, g));
  }
  for (auto& w : plan.weight) w.resize(plan.nodes.size(), 0.0);
}

}  // namespace pitviper
