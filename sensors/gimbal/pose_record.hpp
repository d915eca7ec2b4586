#pragma once
// Where a camera was and looked, frame by frame: kept while something drives it, read back to replay it. A file of comma-separated values with full
// precision: what is read back is the same to the bit.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/scene/motion.hpp"

namespace pitviper {

/// What drives a gimbal.
enum class GimbalDriver {
  Truth,     ///< the target's true place
  Centroid,  ///< the plain tracker on its own pictures
  Commands,  ///< the user's program
  Poses,     ///< a record of poses that is replayed
};

/// As in frames' headers and files: "truth", "centroid", "commands", "poses".
const char* nameOf(GimbalDriver driver);
std::optional<GimbalDriver> gimbalDriverOf(std::string_view name);

struct PoseRow {
  double time_s = 0.0;
  std::int64_t frame = 0;
  Pose pose;                  ///< of the camera in the local frame, body axes; x along its true line of sight, with every error and jitter
  glm::dvec2 angle_rad{0.0};  ///< azimuth and elevation of the gimbal
  GimbalDriver driver = GimbalDriver::Truth;
  bool locked = false;  ///< Centroid: the target was in the last picture; else the demanded direction lies within the limits
};

/// "<camera>_poses.csv".
std::string posesFileName(std::string_view camera);
/// First line with its end, and a line of a row: time_s, frame, qw, qx, qy, qz (local from camera), x_m, y_m, z_m, azimuth_rad, elevation_rad, driver, locked
/// (0 or 1).
std::string posesHeader();
std::string poseLine(const PoseRow& row);

struct PoseRecord {
  std::string file;
  std::vector<PoseRow> rows;  ///< frames and times rise

  /// Errors: UserError at `where` for a frame that it does not hold.
  const PoseRow& ofFrame(std::int64_t frame, const Location& where = {}) const;
};

/// Errors: UserError with file:line:col for a file that cannot be read, another header, rows of other lengths, cells that are no finite numbers, a quaternion
/// whose length is not 1 within 1e-9, unknown drivers, frames or times that do not rise, no rows.
PoseRecord readPoses(const std::filesystem::path& file, const Location& askedAt = {});
/// The same from the text of a file.
PoseRecord posesOf(std::string_view text, const std::string& file);

}  // namespace pitviper
