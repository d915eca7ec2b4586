#include "sim/frame/lost_wavelengths.hpp"

#include <algorithm>
#include <cmath>

#include "sim/frame/truth_work.hpp"
#include "sim/plan/sights.hpp"

namespace pitviper {
namespace {

/// With so many, contrasts of a jet at 24 places are off by a quarter of a percent (RMS) where a plan of 1 % alone leaves 4.6 %.
constexpr int kShares = 8;

/// How many steradians of a stratum's line lose as much in a slot as all its lines: by their contrast, where the line has as much of it as they.
double lineOf(const Stratum& stratum, std::size_t slot) {
  const double lines = stratum.contrast[slot] / stratum.line->contrast[slot];
  return std::isfinite(lines) ? std::clamp(lines, 0.0, 2.0 * stratum.sr) : stratum.sr;
}

}  // namespace

LostWavelengths::LostWavelengths(const Simulation& simulation, const Camera& camera, std::span<const ChannelOutput> measured, const Plan& plan,
                                 const std::shared_ptr<const NodeSpectra>& spectra)
    : simulation_(simulation), camera_(camera), measured_(measured), plan_(plan), spectra_(spectra) {}

const LostWavelengths::Fine& LostWavelengths::fine() const {
  if (!fine_) {
    SpectralSampling every;
    every.reference = true;
    auto made = std::make_unique<Fine>(Fine{makePlan(simulation_, {measured_.begin(), measured_.end()}, every, camera_.where), nullptr});
    // All terms, as one that no pixel would notice may be much of a contrast; but told as the plan tells them.
    Terms& terms = made->plan.terms;
    terms = withSurroundings(terms, terms.surroundings != 0 ? plan_.surroundings : 0);
    terms.streams = plan_.terms.streams;
    made->spectra = std::make_shared<const NodeSpectra>(simulation_, made->plan.nodes, terms);
    fine_ = std::move(made);
  }
  return *fine_;
}

void LostWavelengths::addTo(std::initializer_list<std::vector<double>*> quantities, const std::vector<TargetLine>& lines, const SumsOfLine& sums) const {
  const std::vector<Stratum> strata = strataOf(lines, kShares);
  if (camera_.spectral.reference || strata.empty()) return;
  const Fine& every = fine();
  std::vector<std::vector<double>> planned(strata.size()), exact = planned;
  eachPiece(static_cast<int>(strata.size()), [&](int stratum) {
    const auto k = static_cast<std::size_t>(stratum);
    planned[k] = sums(strata[k].line->at, plan_, spectra_);
    exact[k] = sums(strata[k].line->at, every.plan, every.spectra);
  });
  std::vector<int> slotOf(static_cast<std::size_t>(plan_.slotCount), -1);
  for (std::size_t o = 0; o < measured_.size(); ++o) slotOf[static_cast<std::size_t>(plan_.slotOfOutput[o])] = every.plan.slotOfOutput[o];
  std::size_t from = 0, fromFine = 0;
  for (std::vector<double>* quantity : quantities) {
    for (std::size_t s = 0; s < slotOf.size(); ++s)
      for (std::size_t k = 0; slotOf[s] >= 0 && k < strata.size(); ++k)
        (*quantity)[s] += lineOf(strata[k], s) * (exact[k][fromFine + static_cast<std::size_t>(slotOf[s])] - planned[k][from + s]);
    from += slotOf.size();
    fromFine += static_cast<std::size_t>(every.plan.slotCount);
  }
}

}  // namespace pitviper
