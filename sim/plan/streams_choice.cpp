#include "sim/plan/streams_choice.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/on_threads.hpp"
#include "sim/plan/budget.hpp"
#include "sim/plan/plan_effort.hpp"

namespace pitviper {
namespace {

/// Streams that are tried, and those they are held against: tests/physics/test_diffuse_light.cpp has what these lose.
constexpr int kTried[] = {8, 12}, kExact = kFinestStreams;
/// Wavelengths of each channel that lines are told by: light scattered again changes evenly with wavelength.
constexpr int kWavelengths = 2;
/// What is found on some lines and wavelengths, times this, is the loss predicted.
constexpr double kMargin = 1.5;

/// Of each line, per slot: all of it, and light scattered again.
struct Told {
  std::vector<double> all, again;
};

std::vector<Told> tell(const Simulation& sim, const Plan& few, const std::vector<SightRay>& lines, const ShadowCaster& shadows, int streams) {
  Plan own = few;
  own.terms.streams = streams;
  const NodesOfPlan nodes(sim, own);
  std::vector<Told> told(lines.size());
  onAllThreads(lines.size(), [&](const auto& next) {
    NodeSum sum(nodes.spectra);
    sum.keepParts();
    for (size_t n = next(); n < lines.size(); n = next()) {
      sum.begin();
      radianceAlong(sceneOf(sim, own, shadows, lines[n], kUsualPlaces), lines[n].line, sum);
      told[n] = {slotsOf(own, sum.radiance()), slotsOf(own, sum.part(TermKind::ScatteredAgain))};
    }
  });
  return told;
}

}  // namespace

void chooseStreams(const Simulation& sim, const Plan& fine, SightRays& rays, const std::vector<double>& floor, Plan& plan) {
  plan.streams = 0;
  plan.streamsLoss.assign(floor.size(), 0.0);
  if (fine.terms.streams == 0) return;
  Plan few = someWavelengths(fine, kWavelengths);
  few.terms = withSurroundings(few.terms, 0);  // as dear as it is alike by all
  const int count = effortOf(plan.accuracy).around / 2;
  std::vector<SightRay> lines = rays.overFilm(count);
  for (int n = 0; n < count / 4; ++n) lines.push_back(rays.ofCombination());
  const ShadowCaster shadows(sim);
  const std::vector<Told> exact = tell(sim, few, lines, shadows, kExact);
  /// The most that something is of a line, per slot.
  const auto most = [&](const auto& differenceOf) {
    std::vector<double> all(floor.size(), 0.0);
    for (size_t n = 0; n < lines.size(); ++n)
      for (size_t s = 0; s < all.size(); ++s)
        if (const double size = std::max(std::abs(exact[n].all[s]), floor[s]); size > 0.0) all[s] = std::max(all[s], std::abs(differenceOf(n, s)) / size);
    return all;
  };
  const auto largest = [](const std::vector<double>& all) { return all.empty() ? 0.0 : *std::max_element(all.begin(), all.end()); };
  const double accuracy = plan.accuracy > 0.0 ? plan.accuracy : kUsualAccuracy;
  plan.streamsLoss = most([&](size_t n, size_t s) { return exact[n].again[s]; });
  if (plan.accuracy > 0.0 && largest(plan.streamsLoss) <= budget::kTerms.of(accuracy)) return;
  for (const int streams : kTried) {
    const std::vector<Told> told = tell(sim, few, lines, shadows, streams);
    plan.streams = streams;
    plan.streamsLoss = most([&](size_t n, size_t s) { return kMargin * (told[n].all[s] - exact[n].all[s]); });
    if (largest(plan.streamsLoss) <= budget::kStreams.of(accuracy)) return;
  }
  // Of these, about what as many more streams would change.
  plan.streams = kExact;
  for (double& l : plan.streamsLoss) l *= 0.5;
}

}  // namespace pitviper
