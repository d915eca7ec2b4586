#include "sim/plan/planner.hpp"

#include <algorithm>
#include <cmath>

#include "sim/plan/air_table_request.hpp"
#include "sim/plan/line_check.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/plan/plan_fits.hpp"
#include "sim/plan/plan_origin.hpp"

namespace pitviper {
namespace {

/// Lines as the film draws them that say what a plan is off by, seen by no fit; of at most 3/n of pixels more is to be expected with 95 %.
constexpr int kLast = 1000;
/// And of small bodies, which have views of their own in the film's pixels.
constexpr int kLastSmall = 300;
/// Their largest error times this is predicted: a film of all pixels shows more than they do. Of 235 cells of random scenes (seeds 6001 to 6099) two were
/// found above with 2 or with 1.5, one with 2.5: at 2 a margin of a third to spare.
constexpr double kMargin = 2.0;
/// A plan that shows more on them than was asked learns them, and is told anew by as many others: so often.
constexpr int kAgain = 2;
/// Of what tables lose, no more than this of the accuracy is made up for by wavelengths.
constexpr double kMended = 0.3;
/// A term that is nowhere more than this part of the accuracy is dropped.
constexpr double kDropped = 0.05;
/// Single precision on the GPU over a whole pixel: 2.8e-6 of a formula and 1e-5 of tables (tests/gpu/test_float_against_double.cpp), 5e-5 found in random
/// scenes.
constexpr double kPrecision = 6e-5;
/// Of the accuracy, the part that ambient light may lose by being told with fewer harmonics, on the largest of so many lines of the film, and half as many of
/// small bodies. It changes evenly over surfaces, and needs no margin.
constexpr double kSurroundingsShare = 0.4, kNoWorse = 1.1;
constexpr int kSurroundingsLines = 240;
/// Seeds of the last lines lie apart from those of the fit, and of the last ones before.
constexpr unsigned long long kLastSeed = 0x9e3779b97f4a7c15u, kNextSeed = 0xd1b54a32d192ed03u, kSurroundingsSeed = 0x8cb92ba72f3d8dd7u;

void dropLights(Plan& plan) {
  plan.terms.lights = plan.terms.shadows = false;
  plan.lightCount = 0;
}

/// What is nowhere seen in any channel has no place in the programs; sunlight and lamps also by channel.
void dropTerms(Plan& plan, bool keepLights) {
  auto seen = [&](TermKind kind, size_t slot) { return plan.shares[static_cast<size_t>(kind)].share[slot] > kDropped * plan.accuracy; };
  auto anywhere = [&](TermKind kind) {
    bool kept = false;
    for (size_t s = 0; s < static_cast<size_t>(plan.slotCount); ++s) kept |= seen(kind, s);
    return plan.shares[static_cast<size_t>(kind)].kept = kept;
  };
  for (int k = 0; k < kTermKinds; ++k) anywhere(static_cast<TermKind>(k));
  plan.terms.scatteredSun = plan.terms.scatteredSun && anywhere(TermKind::ScatteredSun);
  plan.terms.ambient = plan.terms.ambient && anywhere(TermKind::Ambient);
  if (plan.terms.surroundings != 0) plan.terms = withSurroundings(plan.terms, plan.terms.ambient ? plan.surroundings : 0);
  for (NodeBlock& b : plan.blocks) {
    b.lit = keepLights;
    for (int s : b.slots) b.lit |= seen(TermKind::Sun, static_cast<size_t>(s)) || seen(TermKind::Lights, static_cast<size_t>(s));
  }
  if (std::none_of(plan.blocks.begin(), plan.blocks.end(), [](const NodeBlock& b) { return b.lit; })) dropLights(plan);
}

/// A plan that was made elsewhere has what drawing takes from it.
bool suits(const Plan& plan, const Simulation& sim) {
  return std::all_of(plan.nodes.begin(), plan.nodes.end(), [&](const SpectralNode& n) { return n.absorption_per_m.size() == sim.materials.size(); });
}

/// Tables of the air, as large as the accuracy needs; what they lose, per slot.
std::vector<double> planTables(const Simulation& sim, const Eye& eye, SightRays& rays, const std::vector<double>& floor, Plan& plan) {
  std::vector<double> lost;
  if (plan.terms.air) lost = sim.air->planTables({sim, plan, eye.camera, &rays, &floor});
  return lost.empty() ? std::vector<double>(plan.weight.size(), 0.0) : lost;
}

/// What it is off by, on lines that no fit has seen and at the extremes.
CheckedLines predict(const Simulation& sim, const Eye& eye, const NodesOfPlan& fine, SightRays& rays, const std::vector<double>& floor, int airPlaces,
                     unsigned long long seed, Plan& plan) {
  rays.reseed(seed);
  CheckedLines last;
  last.lines = rays.overFilm(kLast);
  const NodesOfPlan planned(sim, plan);
  last.figures = checkLines(sim, planned, fine, last.lines, airPlaces, floor);
  // What middles of pixels miss and pixels hold: small bodies, glints, which are small, and lamps.
  std::vector<SightRay> small = rays.ofSmallBodies(kLastSmall);
  std::copy_if(rays.extremes().begin(), rays.extremes().end(), std::back_inserter(small), [](const SightRay& r) { return r.glints || r.lamp >= 0; });
  last.add(small, checkLines(sim, planned, fine, small, airPlaces, floor));
  const auto& found = last.figures;
  const auto extreme = checkLines(sim, planned, fine, rays.extremes(), airPlaces, floor);
  const std::vector<double> tables = planTables(sim, eye, rays, floor, plan);
  plan.lines = kLast;
  plan.parts.clear();
  plan.predictedError.clear();
  const double lamps = sim.lights.empty() ? 0.0 : (kLampShare + (plan.terms.shadows ? kShadowShare : 0.0)) * plan.accuracy;
  const double thin = plan.terms.air ? kThinShare * plan.accuracy : 0.0;
  for (size_t s = 0; s < found.size(); ++s) {
    plan.parts.push_back({kMargin * found[s].largest, tables[s], found[s].dropped + lamps + thin, kPrecision,
                          plan.surroundingsLoss.empty() ? 0.0 : plan.surroundingsLoss[s], extreme[s].largest});
    plan.predictedError.push_back(plan.parts.back().sum());
  }
  return last;
}

/// Ambient light by direction costs: the fewest harmonics, or none but the mean, that lose no more than a part of the accuracy; else as many as there are.
/// Returns the fine wavelengths with as many.
std::unique_ptr<const Plan> chooseSurroundings(const Simulation& sim, const NodesOfPlan& fine, SightRays& rays, Plan& plan) {
  auto chosen = std::make_unique<Plan>(fine.plan);
  if (plan.terms.surroundings == 0) return chosen;
  const std::vector<double> floor = filmFloors(sim, fine, rays);
  std::vector<SightRay> lines = rays.overFilm(kSurroundingsLines);
  for (SightRay& ray : rays.ofSmallBodies(kSurroundingsLines / 2)) lines.push_back(std::move(ray));
  for (int n = 0; n < kSurroundingsLines / 2; ++n) lines.push_back(rays.ofCombination());  // a canopy may be few pixels
  struct Tried {
    int degree;
    std::vector<double> loss;
    double largest;
  };
  std::vector<Tried> all;
  const auto look = [&](std::initializer_list<int> degrees) {
    std::vector<Plan> plans;
    std::vector<std::unique_ptr<NodesOfPlan>> nodes;
    std::vector<const NodesOfPlan*> each;
    plans.reserve(degrees.size());
    for (const int degree : degrees) {
      plans.push_back(fine.plan);
      plans.back().terms = withSurroundings(fine.plan.terms, degree);
      nodes.push_back(std::make_unique<NodesOfPlan>(sim, plans.back()));
      each.push_back(nodes.back().get());
    }
    const auto found = checkLines(sim, each, fine, lines, kUsualPlaces, floor);
    for (size_t d = 0; d < degrees.size(); ++d) {
      all.push_back({degrees.begin()[d], {}, 0.0});
      for (const LineFigures& f : found[d]) all.back().loss.push_back(f.largest), all.back().largest = std::max(all.back().largest, f.largest);
    }
  };
  const auto isEnough = [&](const Tried& t) { return t.largest <= kSurroundingsShare * plan.accuracy; };
  if (plan.accuracy > 0.0) look({0, 2});
  if (std::none_of(all.begin(), all.end(), isEnough)) look({3, kMostHarmonicOrder});
  // Where none is good enough, more must be worth it.
  double least = INFINITY;
  for (const Tried& t : all) least = std::min(least, t.largest);
  const Tried& taken = *std::find_if(all.begin(), all.end(), [&](const Tried& t) { return isEnough(t) || t.largest <= kNoWorse * least; });
  plan.surroundings = taken.degree;
  plan.surroundingsLoss = taken.loss;
  chosen->terms = withSurroundings(fine.plan.terms, taken.degree);
  return chosen;
}

/// Of each slot, the output it is of.
std::vector<const ChannelOutput*> slotsOf(const Plan& plan, const std::vector<ChannelOutput>& outputs) {
  std::vector<const ChannelOutput*> slots(static_cast<size_t>(plan.slotCount), nullptr);
  for (size_t o = 0; o < outputs.size(); ++o)
    if (!slots[static_cast<size_t>(plan.slotOfOutput[o])]) slots[static_cast<size_t>(plan.slotOfOutput[o])] = &outputs[o];
  return slots;
}

/// Groups of wavelengths within plan.accuracy, terms that nobody would notice left out, and what all that is off by.
void fitPlan(const Simulation& sim, const Eye& eye, const std::vector<ChannelOutput>& outputs, const NodesOfPlan& fine, bool keepLights, SightRays& rays,
             Plan& plan, const PlanProgress& progress) {
  // Fits take most of the time, the last lines and tables the rest; what is done again comes out of that.
  double from = 0.05, to = 0.6;
  const auto tell = [&](double share) {
    if (progress) progress(share);
  };
  const std::function<void(double)> tellFits = [&](double part) { tell(from + (to - from) * part); };
  tell(0.02);
  const std::vector<double> floor = filmFloors(sim, fine, rays);
  const int airPlaces = airPlacesFor(sim, fine, rays, plan.accuracy, floor), lastPlaces = std::max(airPlaces, kUsualPlaces);
  // Fits and what they are held against tell light from all around alike.
  plan.terms = withSurroundings(plan.terms, fine.plan.terms.surroundings);
  const Terms all = plan.terms;
  const int lights = plan.lightCount;
  const auto seed = static_cast<unsigned long long>(sim.seed);
  unsigned long long batch = kLastSeed;  // lines of another are new to every fit
  // True where it holds on lines that no fit has seen, or all was tried.
  const auto fitWith = [&](int places) {
    PlanFits fits(sim, eye, plan, slotsOf(plan, outputs), fine, rays, floor, places, tellFits);
    for (int attempt = 0;; ++attempt, batch ^= kNextSeed * static_cast<unsigned long long>(attempt)) {
      tell(to);
      fits.takeNodes(plan);
      plan.terms = all;
      plan.lightCount = lights;
      dropTerms(plan, keepLights);
      const CheckedLines last = predict(sim, eye, fine, rays, floor, lastPlaces, seed ^ batch, plan);
      std::vector<size_t> missed;
      for (size_t s = 0; s < plan.parts.size(); ++s)
        // Finer groups help neither tables nor harmonics beyond what those may lose.
        if (const PredictedParts& p = plan.parts[s]; p.sum() - p.tables - p.surroundings > plan.accuracy - std::min(p.tables, kMended * plan.accuracy) -
                                                                                               std::min(p.surroundings, kSurroundingsShare * plan.accuracy))
          missed.push_back(s);
      from = 0.75, to = 0.9;
      if (missed.empty()) return true;
      if (attempt == kAgain) return false;
      fits.learn(last, missed);
    }
  };
  // What is still missed may lie between the places where fits look at the air.
  if (!fitWith(airPlaces) && airPlaces < lastPlaces) {
    plan.terms = all;
    plan.lightCount = lights;
    batch = ~kLastSeed;
    fitWith(lastPlaces);
  }
}

}  // namespace

Plan planFor(const Simulation& sim, const Eye& eye, const PlanProgress& progress) {
  const auto& outputs = eye.camera ? eye.camera->outputs : eye.probe->outputs;
  const SpectralSampling& sampling = eye.camera ? eye.camera->spectral : eye.probe->spectral;
  const Location& where = eye.camera ? eye.camera->where : eye.probe->where;
  Plan plan = makePlan(sim, outputs, sampling, where);
  // The truth layers show the first light's geometry.
  plan.textureAccuracy = eye.camera ? eye.camera->textureAccuracy : sampling.reference ? kFinestTextures : sampling.accuracy;
  const bool keepLights = eye.camera && eye.camera->truth.solidAngles;
  if (!keepLights && !plan.terms.solid.reflects && !plan.terms.layer.reflects) dropLights(plan);
  if (sampling.reference || sampling.shared) {
    plan.fingerprint = planFingerprint(plan);
    return plan;
  }
  plan.accuracy = sampling.accuracy;

  const ContentKey key = planKey(sim, eye);
  const Terms all = plan.terms;
  const bool given = eye.camera && !eye.camera->plan.empty();
  if (given) {
    refuseForeignPlan(sim, *eye.camera);
    if (!(readPlanned(withoutOrigin(eye.camera->plan), plan) && suits(plan, sim)))
      throw UserError({eye.camera->planFile, 0, 0, -1}, "a damaged plan", "the plan that a run of this scenario wrote, whole",
                      "leave --plan out, or name the .plan file of such a run");
  }
  if (!given && !readCachedPlan(key, plan)) {
    SpectralSampling exact;
    exact.reference = true;
    Plan fine = makePlan(sim, outputs, exact, where);
    fine.terms = withSurroundings(all, all.surroundings != 0 ? Terms::kWhole : 0);
    const auto seed = static_cast<unsigned long long>(sim.seed);
    SightRays looks(sim, eye, seed ^ kSurroundingsSeed);
    const auto chosen = chooseSurroundings(sim, NodesOfPlan(sim, fine), looks, plan);
    SightRays rays(sim, eye, seed);
    const NodesOfPlan exactNodes(sim, *chosen);
    if (plan.accuracy > 0.0) {
      fitPlan(sim, eye, outputs, exactNodes, keepLights, rays, plan, progress);
    } else {
      for (const auto& w : fine.weight) plan.fineCount.push_back(static_cast<int>(std::count_if(w.begin(), w.end(), [](double v) { return v != 0.0; })));
      predict(sim, eye, exactNodes, rays, filmFloors(sim, exactNodes, rays), kUsualPlaces, seed ^ kLastSeed, plan);
    }
    plan.terms = all;
    writeCachedPlan(key, plan);
  }
  if (plan.accuracy > 0.0) dropTerms(plan, keepLights);
  plan.fingerprint = planFingerprint(plan);
  if (progress) progress(1.0);
  return plan;
}

}  // namespace pitviper
