#include "scenarios/commands/pose_files.hpp"

#include <algorithm>

#include "sensors/gimbal/gimbal_choice.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

void replayPoses(const std::vector<std::string>& files, Simulation& sim) {
  std::vector<std::string> names;
  for (const Camera& c : sim.cameras) names.push_back(posesFileName(c.name));
  for (const std::string& file : files) {
    const Location where{"--poses " + file, 0, 0, -1};
    const std::string name = std::filesystem::path(file).filename().string();
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw unknownWord(where, "poses of no camera of this scenario:", name, names, "name the file that a run wrote, CAMERA_poses.csv");
    Camera& camera = sim.cameras[static_cast<std::size_t>(at - names.begin())];
    if (camera.follower && !leavesPoses(camera)) throw UserError(where, "poses of camera '" + camera.name + "' twice", "one record a camera", "remove one");
    camera.follower = replayChoice(std::make_shared<const PoseRecord>(readPoses(file, where)), camera);
  }
}

bool leavesPoses(const Camera& camera) { return camera.follower && camera.follower->driver != nameOf(GimbalDriver::Poses); }

std::filesystem::path posesFileIn(const std::filesystem::path& folder, const Camera& camera) { return folder / posesFileName(camera.name); }

void writePoses(const std::filesystem::path& folder, const Simulation& sim, const Camera& camera, const std::string& text, const MayReplace& mayReplace) {
  const std::filesystem::path file = posesFileIn(folder, camera);
  const std::string whole = tableMark(sim) + text;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) {
    try {
      if (readWholeFile(file, {}).starts_with(whole)) return;
    } catch (const UserError&) {
      // Too large or not to be read: whether it may be replaced is said below.
    }
  }
  writeFileAtomically(file, whole, mayReplace);
}

void notePointing(const Simulation& sim, int first, Notes& notes) {
  for (const Camera& c : sim.cameras)
    if (first > 0 && c.follower && c.follower->output)
      notes.say("camera " + c.name + ": its gimbal follows its own pictures, so that frames 0 to " + std::to_string(first - 1) +
                " are drawn first and left out; --poses " + posesFileName(c.name) + " of another run spares them");
}

}  // namespace pitviper
