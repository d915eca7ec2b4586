#pragma once
// What of a run is drawn of its trajectories.
#include <string>
#include <vector>

#include "scenarios/commands/trajectory_picture.hpp"
#include "sim/run/encounters.hpp"
#include "sim/run/history.hpp"

namespace pitviper {

/// Paths of all that has rows in the history, of cameras unless a body carries them; bodies that stand and are looked at or flown at; the closest approaches
/// that lie within the run; lines of sight at the nearest of these, else at the last tick.
FlownScene flownScene(const Simulation& simulation, const History& history, const std::vector<Encounter>& encounters, const std::string& title);

}  // namespace pitviper
