#pragma once
// What a plan chose, told to people and to programs.
#include <string>

#include "sim/plan/planner.hpp"

namespace pitviper {

/// One camera or probe of a scenario with its plan.
struct PlannedEye {
  std::string name;
  const std::vector<ChannelOutput>& outputs;
  const Plan& plan;
  double seconds = 0.0;          ///< that planning took
  double subpixels = 0.0;        ///< of a frame
  double framesPerSecond = 0.0;  ///< predicted; 0: not asked for
  double tableBytes = 0.0;       ///< of what the shading programs read of surfaces and media
  bool buffered = false;         ///< something transparent may be in view
  bool airTables = false;        ///< layered air: the GPU reads it from tables
  std::string limits;            ///< of the scenario, in words; empty: none
  const Camera* camera = nullptr;  ///< null: a probe
};

/// The name of each slot: the channels it feeds, "mw" or "mw+lw"; where a channel has several slots, with its quantities: "mw.radiance",
/// "mw.photons+mw.electrons".
std::vector<std::string> slotNames(const Plan& plan, const std::vector<ChannelOutput>& outputs);

/// Node evaluations of a pixel: each is a reading of the tables, an exponential and what light adds.
struct NodeCost {
  int lit = 0, unlit = 0;
};
NodeCost costOf(const Plan& plan);

/// A line of `plan` for each of some accuracies: what the budget buys there, and what a frame costs for it. The plan's own among them.
std::string ladderText(const std::vector<Plan>& plans, double asked, double subpixels);

/// Of the tables of surfaces and media that its shading programs read.
double shadingTableBytes(const Simulation& simulation, const Plan& plan);

std::string planText(const PlannedEye& eye);
/// One JSON object.
std::string planJson(const PlannedEye& eye);

}  // namespace pitviper
