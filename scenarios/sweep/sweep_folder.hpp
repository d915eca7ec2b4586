#pragma once
// Where a sweep puts what it finds: FOLDER/sweep.sqlite, sweep.csv, sweep.html, frames/, what sinks make of these, parts/ on a cluster.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/sweep/part_choice.hpp"
#include "scenarios/sweep/sweep_file.hpp"
#include "scenarios/sweep/sweep_identity.hpp"
#include "scenarios/sweep/sweep_store.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// What its results are known by: its file, and the scenario with all that it is made of.
SweepIdentity identityOf(const Sweep& sweep, const Simulation& simulation);

/// Whether frames of samples are kept: because they are asked for, or sinks are to have them.
bool keepsFrames(const Sweep& sweep);
std::filesystem::path frameFileOf(const std::filesystem::path& folder, const std::string& camera, int sample);

/// Samples of a sweep that a store does not have, of those of a part.
std::vector<const Sample*> missingSamples(const Sweep& sweep, const SweepStore& store, const PartChoice& part);

/// Writes the table and the page of all that is stored.
void writeResults(const std::filesystem::path& folder, const Sweep& sweep, const SweepStore& store);

/// Gives kept frames to the sweep's sinks, by sample and camera. `progress`: with the share that is done. Errors: UserError where a frame is not there.
void feedSinks(const std::filesystem::path& folder, const Sweep& sweep, const SweepStore& store, const Simulation& simulation,
               const std::function<void(double share)>& progress);

}  // namespace pitviper
