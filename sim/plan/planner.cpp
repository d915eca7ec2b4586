#include "sim/plan/planner.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <future>
#include <memory>
#include <thread>

#include "sim/plan/channel_fit.hpp"
#include "sim/plan/line_check.hpp"
#include "sim/plan/plan_cache.hpp"

namespace pitviper {
namespace {

/// Lines of sight to fit to at first besides the extremes, and of each check; checks until one is passed, but no more than so many.
constexpr int kFirst = 240, kCheck = 360, kChecks = 6;
/// Lines as the film draws them that say what a plan is off by, seen by no fit; of at most 3/n of pixels more is to be expected with 95 %.
constexpr int kLast = 400;
/// Their largest error times this is predicted: a film of all pixels shows more than they do. A guess, not calibrated: on the scenes tried since it left
/// 1 of 20 cells at 1 % above what was predicted.
constexpr double kMargin = 1.5;
/// Lines on which fits are held against the equation before that, besides the extremes; what they may show of the accuracy; how often a fit is tightened.
constexpr int kSecond = 160, kTighter = 2;
constexpr double kHeld = 0.6;
constexpr unsigned long long kSecondSeed = 0xd1b54a32d192ed03u;
/// A term that is nowhere more than this part of the accuracy is dropped.
constexpr double kDropped = 0.05;
/// Single precision on the GPU over a whole pixel (tests/gpu/test_float_against_double.cpp: 2.8e-6, tables 1e-5).
constexpr double kPrecision = 2e-5;
/// Seeds of the last lines lie apart from those of the fit.
constexpr unsigned long long kLastSeed = 0x9e3779b97f4a7c15u;

/// What the tables of layered air add in a narrow field (bench --accuracy with 340 even samples), and besides in one of 40 degrees, growing with its
/// square (tests/gpu/test_layered_air_gpu.cpp); with twice the entries, below kFine, a quarter.
constexpr double kTables = 8e-4, kWideTables = 2.5e-3, kWide_rad = 0.7, kFine = 0.003;

double tableError(const Eye& eye, double accuracy) {
  const double field_rad = eye.camera ? 2.0 * std::atan(eye.camera->pinhole.tanY(0)) : kWide_rad, share = std::min(field_rad / kWide_rad, 1.0);
  return (kTables + kWideTables * share * share) * (accuracy < kFine ? 0.25 : 1.0);
}

/// A group of a channel's fine wavelengths as a node of the scene.
SpectralNode nodeOf(const Simulation& sim, const ChannelFit& fit, const SpectralGroup& group) {
  const FineGrid& grid = fit.grid();
  SpectralNode node;
  node.absorption_per_m.assign(sim.materials.size(), 0.0);
  double turned = 0.0, scattered = 0.0;
  // What is scattered is averaged, not fitted: which absorber a fit puts extinction on is of no matter to transmittance, but would be here.
  for (const auto& [index, share] : group.members) {
    const AirNode& air = grid.air[static_cast<size_t>(index)];
    node.members.push_back({grid.wavelength_um[static_cast<size_t>(index)], share});
    node.air.source += share * air.source;
    for (size_t k = 0; k < kMostAirAmounts; ++k) {
      node.air.molecules[k] += share * air.molecules[k];
      node.air.haze[k] += share * air.haze[k];
      node.air.extinction[k] += share * air.extinction[k];  // of what is not fitted
      turned += share * air.haze[k] * air.asymmetry;
      scattered += share * air.haze[k];
    }
  }
  node.air.asymmetry = scattered > 0.0 ? turned / scattered : 0.0;
  for (size_t a = 0; a < fit.absorbers().size(); ++a) {
    const auto k = static_cast<size_t>(fit.absorbers()[a]);
    if (k < kMostAirAmounts) node.air.extinction[k] = group.extinction[a];
    else node.absorption_per_m[k - kMostAirAmounts] = group.extinction[a];
  }
  return node;
}

/// On as many threads as the machine has.
void forAll(const std::vector<ChannelFit*>& fits, const std::function<void(ChannelFit&)>& work) {
  std::atomic<size_t> next{0};
  auto some = [&] {
    for (size_t s = next++; s < fits.size(); s = next++) work(*fits[s]);
  };
  std::vector<std::future<void>> others;
  for (unsigned t = 1; t < std::min<size_t>(std::thread::hardware_concurrency(), fits.size()); ++t) others.push_back(std::async(std::launch::async, some));
  some();
  for (auto& o : others) o.get();
}

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
  for (NodeBlock& b : plan.blocks) {
    b.lit = keepLights;
    for (int s : b.slots) b.lit |= seen(TermKind::Sun, static_cast<size_t>(s)) || seen(TermKind::Lights, static_cast<size_t>(s));
  }
  if (std::none_of(plan.blocks.begin(), plan.blocks.end(), [](const NodeBlock& b) { return b.lit; })) dropLights(plan);
}

/// The channels' groups as the plan's nodes.
void takeNodes(const Simulation& sim, const std::vector<std::unique_ptr<ChannelFit>>& fits, const Sights& sights, Plan& plan) {
  plan.nodes.clear();
  plan.blocks.clear();
  plan.weight.clear();
  plan.shares.clear();
  plan.fineCount.clear();
  for (int k = 0; k < kTermKinds; ++k) plan.shares.push_back({nameOf(static_cast<TermKind>(k)), {}, true});
  for (const auto& f : fits) {
    plan.blocks.push_back({plan.nodeCount(), static_cast<int>(f->groups().size()), {static_cast<int>(plan.blocks.size())}});
    for (const SpectralGroup& g : f->groups()) plan.nodes.push_back(nodeOf(sim, *f, g));
    plan.fineCount.push_back(static_cast<int>(f->grid().weight.size()));
    const auto shares = sights.shares(f->grid(), f->absorbers(), f->floor());
    for (size_t k = 0; k < shares.size(); ++k) plan.shares[k].share.push_back(shares[k]);
  }
  for (size_t s = 0; s < fits.size(); ++s) {
    std::vector<double> weights(plan.nodes.size(), 0.0);
    for (size_t g = 0; g < fits[s]->groups().size(); ++g) weights[static_cast<size_t>(plan.blocks[s].first) + g] = fits[s]->groups()[g].weight;
    plan.weight.push_back(std::move(weights));
  }
}

/// Groups of wavelengths for each channel, fitted to lines of sight as sums of products and then held against the equation itself, which products are
/// simpler than: a channel that does not hold there is fitted to half as much.
void chooseNodes(const Simulation& sim, const Eye& eye, const std::vector<const ChannelOutput*>& slots, const Plan& fine, Sights& sights, Plan& plan) {
  const double accuracy = plan.accuracy;
  std::vector<double> tolerance(slots.size(), accuracy);
  std::vector<std::unique_ptr<ChannelFit>> fits(slots.size());
  SightRays rays(sim, eye, static_cast<unsigned long long>(sim.seed) ^ kSecondSeed);
  std::vector<SightRay> lines = rays.extremes();
  for (int n = 0; n < kSecond; ++n) lines.push_back(n % 2 == 0 ? rays.fromFilm() : rays.ofCombination());
  sights.begin(kFirst, eye.camera ? eye.camera->learnt : std::vector<FilmPlace>());
  std::vector<double> floor;
  for (int attempt = 0;; ++attempt) {
    std::vector<ChannelFit*> fresh;
    for (size_t s = 0; s < slots.size(); ++s)
      if (!fits[s]) fresh.push_back((fits[s] = std::make_unique<ChannelFit>(sim, slots[s]->kernel, tolerance[s])).get());
    forAll(fresh, [&](ChannelFit& f) { f.begin(sights); });
    for (int n = 0; n < kChecks && !std::all_of(fresh.begin(), fresh.end(), [](const ChannelFit* f) { return f->holds(); }); ++n) {
      sights.draw(kCheck);
      forAll(fresh, [&](ChannelFit& f) {
        if (!f.holds()) f.check(sights);
      });
    }
    takeNodes(sim, fits, sights, plan);
    if (attempt == kTighter) return;
    const auto found = checkLines(sim, plan, fine, lines, rays.pixel_sr(), floor);
    bool all = true;
    for (size_t s = 0; s < slots.size(); ++s) {
      if (found[s].largest <= kHeld * accuracy) continue;
      all = false;
      tolerance[s] *= 0.5;
      fits[s].reset();
    }
    if (all) return;
  }
}

/// A plan that was made elsewhere has what drawing takes from it.
bool suits(const Plan& plan, const Simulation& sim) {
  return std::all_of(plan.nodes.begin(), plan.nodes.end(), [&](const SpectralNode& n) { return n.absorption_per_m.size() == sim.materials.size(); });
}

/// What it is off by, on lines that no fit has seen and at the extremes.
void predict(const Simulation& sim, const Eye& eye, const Plan& fine, Plan& plan) {
  SightRays rays(sim, eye, static_cast<unsigned long long>(sim.seed) ^ kLastSeed);
  std::vector<SightRay> last;
  for (int n = 0; n < kLast; ++n) last.push_back(rays.fromFilm());
  std::vector<double> floor;
  const auto found = checkLines(sim, plan, fine, last, rays.pixel_sr(), floor), extreme = checkLines(sim, plan, fine, rays.extremes(), rays.pixel_sr(), floor);
  const double tables = sim.path && sim.path->isLayered() ? tableError(eye, plan.accuracy) : 0.0;
  plan.lines = kLast;
  plan.parts.clear();
  plan.predictedError.clear();
  for (size_t s = 0; s < found.size(); ++s) {
    plan.parts.push_back({kMargin * found[s].largest, tables, found[s].dropped, kPrecision, extreme[s].largest});
    plan.predictedError.push_back(plan.parts.back().sum());
  }
}

}  // namespace

Plan planFor(const Simulation& sim, const Eye& eye) {
  const auto& outputs = eye.camera ? eye.camera->outputs : eye.probe->outputs;
  const SpectralSampling& sampling = eye.camera ? eye.camera->spectral : eye.probe->spectral;
  const Location& where = eye.camera ? eye.camera->where : eye.probe->where;
  Plan plan = makePlan(sim, outputs, sampling, where);
  // The truth layers show the first light's geometry.
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
  if (given && !(readPlanned(eye.camera->plan, plan) && suits(plan, sim)))
    throw UserError({eye.camera->planFile, 0, 0, -1}, "not a plan for camera '" + eye.camera->name + "' of this scenario",
                    "the plan that a run of it wrote, whole: the same channels and materials", "leave --plan out, or name the .plan file of such a run");
  if (!given && !readCachedPlan(key, plan)) {
    SpectralSampling exact;
    exact.reference = true;
    Plan fine = makePlan(sim, outputs, exact, where);
    fine.terms = all;
    if (plan.accuracy > 0.0) {
      std::vector<const ChannelOutput*> slots(static_cast<size_t>(plan.slotCount), nullptr);
      for (size_t o = 0; o < outputs.size(); ++o)
        if (!slots[static_cast<size_t>(plan.slotOfOutput[o])]) slots[static_cast<size_t>(plan.slotOfOutput[o])] = &outputs[o];
      Sights sights(sim, plan, eye, static_cast<unsigned long long>(sim.seed));
      chooseNodes(sim, eye, slots, fine, sights, plan);
      dropTerms(plan, keepLights);
    } else {
      for (const auto& w : fine.weight) plan.fineCount.push_back(static_cast<int>(std::count_if(w.begin(), w.end(), [](double v) { return v != 0.0; })));
    }
    predict(sim, eye, fine, plan);
    plan.terms = all;
    writeCachedPlan(key, plan);
  }
  if (plan.accuracy > 0.0) dropTerms(plan, keepLights);
  plan.fingerprint = planFingerprint(plan);
  return plan;
}

}  // namespace pitviper
