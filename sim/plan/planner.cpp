#include "sim/plan/planner.hpp"

#include <algorithm>
#include <numeric>

#include "sim/plan/air_table_request.hpp"
#include "sim/plan/budget.hpp"
#include "sim/plan/line_check.hpp"
#include "sim/plan/measured_outputs.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/plan/plan_effort.hpp"
#include "sim/plan/plan_fits.hpp"
#include "sim/plan/plan_origin.hpp"
#include "sim/plan/streams_choice.hpp"
#include "sim/plan/surroundings_choice.hpp"

namespace pitviper {
namespace {

/// A plan that is off by more than was asked learns the lines that showed it and is measured on as many new ones: at most so many times.
constexpr int kAgain = 2;
/// Single precision on the GPU over a whole pixel: 2.8e-6 of a formula and 1e-5 of tables (tests/gpu/test_float_against_double.cpp), 5e-5 found in random
/// scenes.
constexpr double kPrecision = 6e-5;
/// Beyond this the air's own light is a hundred times what it scatters of the sun's.
constexpr double kSunlit_um = 6.0;
/// Streams by which lines are told before it is known how many the scene takes.
constexpr int kSketchStreams = 8;
/// Added to the seed, so that the last lines are neither those of the fit nor those of the measurement before.
constexpr unsigned long long kLastSeed = 0x9e3779b97f4a7c15u, kNextSeed = 0xd1b54a32d192ed03u, kSurroundingsSeed = 0x8cb92ba72f3d8dd7u;

void dropLights(Plan& plan) {
  plan.terms.lights = plan.terms.shadows = false;
  plan.lightCount = 0;
}

/// Leaves out of the programs what no channel would notice; reflected light of sun and lamps is left out channel by channel.
void dropTerms(Plan& plan, bool keepLights) {
  auto seen = [&](TermKind kind, size_t slot) { return plan.shares[static_cast<size_t>(kind)].share[slot] > budget::kTerms.of(plan.accuracy); };
  auto anywhere = [&](TermKind kind) {
    bool kept = false;
    for (size_t s = 0; s < static_cast<size_t>(plan.slotCount); ++s) kept |= seen(kind, s);
    return plan.shares[static_cast<size_t>(kind)].kept = kept;
  };
  for (int k = 0; k < kTermKinds; ++k) anywhere(static_cast<TermKind>(k));
  plan.terms.streams = plan.terms.streams > 0 && anywhere(TermKind::ScatteredAgain) ? plan.streams : 0;
  // In fog under a low sun all sunlight that is seen was scattered more than once.
  const bool isSunlitAgain = plan.terms.streams > 0 && std::any_of(plan.nodes.begin(), plan.nodes.end(), [](const SpectralNode& n) {
                               return std::any_of(n.members.begin(), n.members.end(), [](const auto& m) { return m.wavelength_um < kSunlit_um; });
                             });
  const bool isSunlit = anywhere(TermKind::ScatteredSun);
  plan.terms.scatteredSun = plan.terms.scatteredSun && (isSunlit || isSunlitAgain);
  plan.terms.ambient = plan.terms.ambient && anywhere(TermKind::Ambient);
  if (plan.terms.surroundings != 0) plan.terms = withSurroundings(plan.terms, plan.terms.ambient ? plan.surroundings : 0);
  for (NodeBlock& b : plan.blocks) {
    b.lit = keepLights;
    for (int s : b.slots) b.lit |= seen(TermKind::Sun, static_cast<size_t>(s)) || seen(TermKind::Lights, static_cast<size_t>(s));
  }
  if (std::none_of(plan.blocks.begin(), plan.blocks.end(), [](const NodeBlock& b) { return b.lit; })) dropLights(plan);
}

/// Whether lights stay whatever they add, as truth layers show the geometry of the first.
bool keepsLights(const Eye& eye) { return eye.camera && eye.camera->truth.solidAngles; }

/// Whether a plan that was read has at each node an absorption of every material of this scene.
bool suits(const Plan& plan, const Simulation& sim) {
  return std::all_of(plan.nodes.begin(), plan.nodes.end(), [&](const SpectralNode& n) { return n.absorption_per_m.size() == sim.materials.size(); });
}

/// Measures a plan on lines of sight that no fit has seen.
struct LastLook {
  const Simulation& sim;
  const Eye& eye;
  const NodesOfPlan& fine;
  SightRays& rays;
  const std::vector<double>& floor;
  int places;  ///< at which the air is looked at
  HeldLines& extremes;

  /// Measures some slots on such lines and at the extremes, and writes what all but tables lose into the parts of the plan. Returns the lines, with figures of
  /// these slots alone.
  CheckedLines tell(unsigned long long seed, const std::vector<size_t>& slots, Plan& plan) const {
    rays.reseed(seed);
    const PlanEffort& effort = effortOf(plan.accuracy);
    CheckedLines last;
    const Plan some = ofSlots(plan, slots), fineSome = ofSlots(fine.plan, slots);
    const NodesOfPlan planned(sim, some, &fine), exact(sim, fineSome, &fine);
    std::vector<double> ownFloor;
    for (size_t s : slots) ownFloor.push_back(floor[s]);
    const auto look = [&](std::vector<SightRay> lines) {
      std::vector<LineFigures> figures(floor.size());
      std::vector<LineFigures> own = checkLines(sim, planned, exact, lines, places, ownFloor);
      for (size_t k = 0; k < slots.size(); ++k) figures[slots[k]] = std::move(own[k]);
      last.add(lines, figures);
    };
    look(rays.overFilm(effort.last));
    // Small bodies, glints and lamps lie in pixels, but seldom in their middles.
    look(rays.ofSmallBodies(effort.lastSmall));
    const NodesOfPlan all(sim, plan, &fine);
    const std::vector<LineFigures> extreme = extremes.check(all);
    last.addSome(extremes.lines(), extreme, [](const SightRay& r) { return r.glints || r.lamp >= 0; });
    plan.lines = effort.last;
    plan.parts.resize(floor.size());
    const double lamps = sim.lights.empty() ? 0.0 : (budget::kLamps.share + (plan.terms.shadows ? budget::kLampShadows.share : 0.0)) * plan.accuracy;
    for (size_t s : slots)
      plan.parts[s] = {effort.margin * last.figures[s].largest,
                       plan.parts[s].tables,
                       last.figures[s].dropped + lamps,
                       kPrecision,
                       plan.surroundingsLoss.empty() ? 0.0 : plan.surroundingsLoss[s],
                       plan.streamsLoss.empty() ? 0.0 : plan.streamsLoss[s],
                       sim.fields.empty() ? 0.0 : budget::kFields.of(plan.accuracy),
                       extreme[s].largest};
    return last;
  }

  /// Tables of the air, as large as the accuracy needs, and what they lose.
  void makeTables(Plan& plan) const {
    std::vector<double> lost;
    if (plan.terms.air) lost = sim.air->planTables({sim, plan, eye.camera, &rays, &floor});
    for (size_t s = 0; s < plan.parts.size(); ++s) plan.parts[s].tables = lost.empty() ? 0.0 : lost[s];
  }
};

/// Of each slot, the output it is of.
std::vector<const ChannelOutput*> slotsOf(const Plan& plan, const std::vector<ChannelOutput>& outputs) {
  std::vector<const ChannelOutput*> slots(static_cast<size_t>(plan.slotCount), nullptr);
  for (size_t o = 0; o < outputs.size(); ++o)
    if (!slots[static_cast<size_t>(plan.slotOfOutput[o])]) slots[static_cast<size_t>(plan.slotOfOutput[o])] = &outputs[o];
  return slots;
}

std::vector<size_t> allOf(const Plan& plan) {
  std::vector<size_t> all(static_cast<size_t>(plan.slotCount));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Whether two plans leave the same terms out.
bool dropAlike(const Plan& a, const Plan& b) {
  const auto same = [](const auto& x, const auto& y, auto is) { return std::equal(x.begin(), x.end(), y.begin(), y.end(), is); };
  return a.terms.ambient == b.terms.ambient && a.terms.scatteredSun == b.terms.scatteredSun && a.terms.streams == b.terms.streams &&
         a.terms.lights == b.terms.lights && same(a.shares, b.shares, [](const TermShare& x, const TermShare& y) { return x.kept == y.kept; }) &&
         same(a.blocks, b.blocks, [](const NodeBlock& x, const NodeBlock& y) { return x.lit == y.lit; });
}

/// Of an accuracy. Tables and harmonics count up to their accounts only, as finer groups would not mend what they lose beyond. `isOld`: tables are made anew.
double leftForWavelengths(const PredictedParts& p, double accuracy, bool isOld) {
  return (isOld ? 1.0 - budget::kTablesAnew.share : 1.0) * accuracy - std::min(p.tables, budget::kTables.of(accuracy)) -
         std::min(p.surroundings, budget::kSurroundings.of(accuracy)) - std::min(p.streams, budget::kStreams.of(accuracy)) - p.dropped - p.precision - p.fields;
}

/// Groups of wavelengths within plan.accuracy, terms that nobody would notice left out, and what all that is off by.
void fitPlan(const Simulation& sim, const Eye& eye, const std::vector<ChannelOutput>& outputs, const NodesOfPlan& fine, int airPlaces, bool keepLights,
             SightRays& rays, const std::vector<double>& floor, Plan& plan, const PlanProgress& progress) {
  // Parts of the work, for the progress that is told: fits until `to`, then the last lines and tables; what is done again comes out of that.
  double from = 0.05, to = 0.6;
  const auto tell = [&](double share) {
    if (progress) progress(share);
  };
  const std::function<void(double)> tellFits = [&](double part) { tell(from + (to - from) * part); };
  tell(0.02);
  const int lastPlaces = std::max(airPlaces, kUsualPlaces);
  // Fits and what they are held against tell light from all around alike.
  plan.terms = withSurroundings(plan.terms, fine.plan.terms.surroundings);
  plan.terms.streams = fine.plan.terms.streams;
  const Terms all = plan.terms;
  const int lights = plan.lightCount;
  HeldLines extremes(sim, fine, rays.extremes(), lastPlaces, floor);
  const LastLook last{sim, eye, fine, rays, floor, lastPlaces, extremes};
  PlanFits fits(sim, eye, plan, slotsOf(plan, outputs), fine, extremes, rays, floor, airPlaces, lastPlaces, tellFits);
  // Lines of another batch are new to every fit.
  unsigned long long batch = kLastSeed;
  std::vector<size_t> changed = allOf(plan);
  for (int attempt = 0;; ++attempt, batch ^= kNextSeed * static_cast<unsigned long long>(attempt)) {
    tell(to);
    const Plan before = plan;
    fits.takeNodes(plan);
    plan.terms = all;
    plan.lightCount = lights;
    dropTerms(plan, keepLights);
    if (attempt == 0 || !dropAlike(before, plan)) changed = allOf(plan);
    const CheckedLines seen = last.tell(static_cast<unsigned long long>(sim.seed) ^ batch, changed, plan);
    if (attempt == 0) last.makeTables(plan);
    std::vector<double> allowed;
    std::vector<size_t> missed;
    for (size_t s = 0; s < plan.parts.size(); ++s) {
      const PredictedParts& p = plan.parts[s];
      // The groups of this slot have changed since tables were made.
      const bool isOld = attempt > 0 && std::find(changed.begin(), changed.end(), s) != changed.end();
      const double left = leftForWavelengths(p, plan.accuracy, isOld);
      allowed.push_back(std::max(left, 0.0) / effortOf(plan.accuracy).margin);
      if (p.wavelengths > left) missed.push_back(s);
    }
    from = 0.75, to = 0.9;
    // After kAgain attempts fits look at the air in more places: what is still missed may lie between those they had.
    const bool isLast = missed.empty() || attempt == 2 * kAgain;
    if (!isLast) {
      if (attempt == kAgain) fits.lookCloser();
      changed = fits.learn(seen, missed, allowed);
    }
    if (!isLast && !changed.empty()) continue;
    if (attempt > 0) last.makeTables(plan);
    break;
  }
  plan.predictedError.clear();
  for (const PredictedParts& p : plan.parts) plan.predictedError.push_back(p.sum());
}

/// Takes an earlier plan over, where what it loses on lines that no fit has seen is within the accuracy asked for here too; else `plan` stays as it is.
bool stillHolds(const Simulation& sim, const Eye& eye, const std::vector<ChannelOutput>& outputs, const Plan& earlier, Plan& plan,
                const PlanProgress& progress) {
  Plan again = plan;
  if (!readPlanned(writePlanned(earlier), again) || !suits(again, sim) || again.slotCount != plan.slotCount || earlier.accuracy > plan.accuracy) return false;
  const auto tell = [&](double share) {
    if (progress) progress(share);
  };
  tell(0.05);
  SpectralSampling exact;
  exact.reference = true;
  Plan fine = makePlan(sim, outputs, exact, eye.camera->where);
  fine.terms = withSurroundings(plan.terms, plan.terms.surroundings != 0 ? again.surroundings : 0);
  if (fine.terms.streams > 0) fine.terms.streams = again.streams;
  const auto seed = static_cast<unsigned long long>(sim.seed);
  SightRays rays(sim, eye, seed ^ kSurroundingsSeed);
  const PlanEffort& effort = effortOf(plan.accuracy);
  const Plan some = someWavelengths(fine, effort.lookedAt);
  const NodesOfPlan whole(sim, some);
  const std::vector<double> floor = filmFloors(sim, whole, rays, effort);
  rays.reseed(seed);
  const NodesOfPlan exactNodes(sim, fine);
  tell(0.3);
  HeldLines extremes(sim, exactNodes, rays.extremes(), kUsualPlaces, floor);
  again.terms = withSurroundings(again.terms, fine.terms.surroundings);
  again.terms.streams = fine.terms.streams;
  dropTerms(again, keepsLights(eye));
  LastLook{sim, eye, exactNodes, rays, floor, kUsualPlaces, extremes}.tell(seed ^ kLastSeed, allOf(again), again);
  again.predictedError.clear();
  for (const PredictedParts& p : again.parts) {
    if (p.wavelengths > leftForWavelengths(p, plan.accuracy, false)) return false;
    again.predictedError.push_back(p.sum());
  }
  plan = std::move(again);
  return true;
}

/// The plan with all its terms, also those that finished() drops as no channel would notice them.
Plan planOf(const Simulation& sim, const Eye& eye, const std::vector<ChannelOutput>& outputs, const PlanProgress& progress, Foretold error,
            const Plan* earlier) {
  const SpectralSampling& sampling = eye.camera ? eye.camera->spectral : eye.probe->spectral;
  const Location& where = eye.camera ? eye.camera->where : eye.probe->where;
  Plan plan = makePlan(sim, outputs, sampling, where);
  plan.textureAccuracy = eye.camera ? eye.camera->textureAccuracy : sampling.reference ? kFinestTextures : sampling.accuracy;
  const bool keepLights = keepsLights(eye);
  if (!keepLights && !plan.terms.solid.reflects && !plan.terms.layer.reflects) dropLights(plan);
  if (sampling.reference || sampling.shared) return plan;
  plan.accuracy = sampling.accuracy;

  const bool isTold = plan.accuracy > 0.0 || error == Foretold::Always;
  const ContentKey key = planKey(sim, eye, isTold);
  const Terms all = plan.terms;
  const bool given = eye.camera && !eye.camera->plan.empty();
  if (given) {
    refuseForeignPlan(sim, *eye.camera);
    if (!(readPlanned(withoutOrigin(eye.camera->plan), plan) && suits(plan, sim)))
      throw UserError({eye.camera->planFile, 0, 0, -1}, "a damaged plan", "the plan that a run of this scenario wrote, whole",
                      "leave --plan out, or name the .plan file of such a run");
  }
  if (!given && !readCachedPlan(key, plan)) {
    if (earlier && plan.accuracy > 0.0 && stillHolds(sim, eye, outputs, *earlier, plan, progress)) {
      plan.terms = all;
      writeCachedPlan(key, plan);
      if (progress) progress(1.0);
      return plan;
    }
    SpectralSampling exact;
    exact.reference = true;
    Plan fine = makePlan(sim, outputs, exact, where);
    fine.terms = withSurroundings(all, all.surroundings != 0 ? Terms::kWhole : 0);
    const auto seed = static_cast<unsigned long long>(sim.seed);
    SightRays rays(sim, eye, seed ^ kSurroundingsSeed);
    const PlanEffort& effort = effortOf(plan.accuracy);
    if (fine.terms.streams > 0) fine.terms.streams = kSketchStreams;
    const Plan some = someWavelengths(fine, effort.lookedAt);
    const NodesOfPlan whole(sim, some);
    const std::vector<double> floor = filmFloors(sim, whole, rays, effort);
    chooseStreams(sim, fine, rays, floor, plan);
    fine.terms.streams = fine.terms.streams > 0 ? plan.streams : 0;
    chooseSurroundings(sim, whole, rays, floor, plan);
    fine.terms = withSurroundings(fine.terms, plan.terms.surroundings != 0 ? plan.surroundings : 0);
    rays.reseed(seed);
    const NodesOfPlan exactNodes(sim, fine);
    if (!isTold) {
      HeldLines none(sim, exactNodes, {}, kUsualPlaces, floor);
      plan.parts.resize(floor.size());
      LastLook{sim, eye, exactNodes, rays, floor, kUsualPlaces, none}.makeTables(plan);
      plan.parts.clear();
    } else if (plan.accuracy > 0.0) {
      fitPlan(sim, eye, outputs, exactNodes, airPlacesFor(sim, whole, rays, plan.accuracy, floor), keepLights, rays, floor, plan, progress);
    } else {
      for (const auto& w : fine.weight) plan.fineCount.push_back(static_cast<int>(std::count_if(w.begin(), w.end(), [](double v) { return v != 0.0; })));
      HeldLines extremes(sim, exactNodes, rays.extremes(), kUsualPlaces, floor);
      const LastLook last{sim, eye, exactNodes, rays, floor, kUsualPlaces, extremes};
      last.tell(seed ^ kLastSeed, allOf(plan), plan);
      last.makeTables(plan);
      for (const PredictedParts& p : plan.parts) plan.predictedError.push_back(p.sum());
    }
    plan.terms = all;
    writeCachedPlan(key, plan);
  }
  if (progress) progress(1.0);
  return plan;
}

Plan finished(Plan plan, const Eye& eye) {
  if (plan.terms.streams > 0) plan.terms.streams = plan.streams;
  if (plan.accuracy > 0.0) dropTerms(plan, keepsLights(eye));
  plan.fingerprint = planFingerprint(plan);
  return plan;
}

std::vector<ChannelOutput> joined(std::vector<ChannelOutput> all, const std::vector<ChannelOutput>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

Plan planFor(const Simulation& sim, const Eye& eye, const PlanProgress& progress, Foretold error, const Plan* earlier) {
  const auto [drawn, measured] = plannedOutputs(sim, eye);
  // An earlier one is of what is drawn alone.
  return finished(ofOutputs(planOf(sim, eye, joined(drawn, measured), progress, error, measured.empty() ? earlier : nullptr), 0, drawn.size()), eye);
}

bool isPlanKnown(const Simulation& sim, const Camera& camera) {
  const Eye eye{&camera, nullptr};
  const auto [drawn, measured] = plannedOutputs(sim, eye);
  Plan plan = makePlan(sim, joined(drawn, measured), camera.spectral, camera.where);
  plan.accuracy = camera.spectral.accuracy;
  return readCachedPlan(planKey(sim, eye, true), plan);
}

Plan measuredPlanFor(const Simulation& sim, const Camera& camera) {
  const auto [drawn, measured] = plannedOutputs(sim, {&camera, nullptr});
  if (!measured.empty()) {
    const Eye eye{&camera, nullptr};
    return finished(ofOutputs(planOf(sim, eye, joined(drawn, measured), {}, Foretold::IfChosen, nullptr), drawn.size(), measured.size()), eye);
  }
  Camera own = camera;
  own.outputs = measuredOutputs(sim, camera);
  own.plan.clear();
  own.truth = {};
  return planFor(sim, {&own, nullptr});
}

}  // namespace pitviper
