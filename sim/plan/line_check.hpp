#pragma once
// What a plan's wavelengths are off by on lines of sight: its nodes against the fine grid, both summed by the radiance equation in double precision.
#include <span>
#include <vector>

#include "sim/plan/plan.hpp"
#include "sim/plan/plan_effort.hpp"
#include "sim/plan/sight_rays.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/radiance/shadow_rays.hpp"

namespace pitviper {

/// Of one channel, relative to max(|L|, floor).
struct LineFigures {
  double largest = 0.0;
  double dropped = 0.0;        ///< the most that terms make up which the plan leaves out
  std::vector<double> errors;  ///< of each line
  std::vector<double> left;    ///< of each line: what terms make up which the plan leaves out
};

/// A plan with the spectra that lines have in common at its nodes. All must outlive it. `parts`: all wavelengths that it is made of, or null.
struct NodesOfPlan {
  NodesOfPlan(const Simulation& simulation, const Plan& of, const NodesOfPlan* parts = nullptr)
      : plan(of), spectra(simulation, of.nodes, of.terms, parts ? &parts->spectra : nullptr) {}
  const Plan& plan;
  NodeSpectra spectra;
};

/// Places at which a line's air is looked at unless an accuracy says how many.
constexpr int kUsualPlaces = 24;

/// The least that a line counts as where an error is relative to it, per slot: 1e-3 of a high percentile of what the film sees in the darkest of its frames,
/// but at least kDarkest.
std::vector<double> filmFloors(const Simulation& simulation, const NodesOfPlan& fine, SightRays& rays, const PlanEffort& effort = kUsualEffort);

/// The fewest places at which the air of a line may be looked at for every channel to keep budget::kAirPlaces, found on some lines of the film and of the
/// extremes: short waves see the air bend where long ones don't.
int airPlacesFor(const Simulation& simulation, const NodesOfPlan& fine, SightRays& rays, double accuracy, const std::vector<double>& floor);

/// Lines that plans are held against: what all wavelengths give of them is told once. Terms are those of `fine`; a plan may leave kinds of terms out, all of
/// them or by node.
class HeldLines {
 public:
  /// Simulation and `fine` must outlive it. `fine`: makePlan() with reference sampling, of the same outputs. `floor`: filmFloors(). `places`: at which the air
  /// is looked at, alike on both sides, so that only wavelengths differ.
  HeldLines(const Simulation& simulation, const NodesOfPlan& fine, std::vector<SightRay> lines, int places, std::vector<double> floor);
  const std::vector<SightRay>& lines() const { return lines_; }
  /// One per slot.
  std::vector<LineFigures> check(const NodesOfPlan& plan);

 private:
  const Simulation& sim_;
  const NodesOfPlan& fine_;
  std::vector<SightRay> lines_;
  int places_;
  std::vector<double> floor_;
  std::vector<std::vector<double>> exact_;  ///< [line][slot]; empty: not told yet
};

/// HeldLines::check() of lines that are asked for once.
std::vector<LineFigures> checkLines(const Simulation& simulation, const NodesOfPlan& plan, const NodesOfPlan& fine, const std::vector<SightRay>& lines,
                                    int places, const std::vector<double>& floor);

/// The part of a plan that belongs to some slots: their nodes, weights and figures.
Plan ofSlots(const Plan& plan, const std::vector<size_t>& slots);
/// The part of a plan that belongs to `count` outputs from `first` on.
Plan ofOutputs(const Plan& plan, size_t first, size_t count);

/// Per slot, a sum over nodes.
std::vector<double> slotsOf(const Plan& plan, std::span<const double> radiance);

/// The scene as a line of sight is told of it, with so many places of the air.
RadianceScene sceneOf(const Simulation& simulation, const Plan& fine, const ShadowCaster& shadows, const SightRay& ray, int places);

}  // namespace pitviper
