#pragma once
// Records of what points cameras: given with --poses, and left by runs.
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/commands/run_notes.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// Of each CAMERA_poses.csv its camera looks where that says. Errors: UserError.
void replayPoses(const std::vector<std::string>& files, Simulation& simulation);
/// Whether a run leaves a record of it: something points it that is no record.
bool leavesPoses(const Camera& camera);
std::filesystem::path posesFileIn(const std::filesystem::path& folder, const Camera& camera);
/// `text`: header and lines. One of the same scenario that begins so and goes on is left as it is: a run of the first frames says nothing new.
void writePoses(const std::filesystem::path& folder, const Simulation& simulation, const Camera& camera, const std::string& text, const MayReplace& mayReplace);
/// One line for each camera that has to see frames which are not asked for.
void notePointing(const Simulation& simulation, int firstFrame, Notes& notes);

}  // namespace pitviper
