#pragma once
// Trajectories that others have flown, from CSV files.
#include <filesystem>

#include "sim/parameters/error.hpp"
#include "sim/scene/geodesy.hpp"
#include "sim/scene/trajectory.hpp"

namespace pitviper {

/// A header of names with units at their ends, then rows of numbers; lines that begin with # are comments. Columns in any order:
///   time_s                                      rising, by a microsecond at least
/// and one set of positions:
///   x_m, y_m, z_m                               the scenario's east, north, up
///   north_m, east_m, down_m                     from the scenario's origin
///   latitude_deg, longitude_deg, height_m       WGS 84, above the ellipsoid
///   ecef_x_m, ecef_y_m, ecef_z_m                WGS 84
/// and an attitude or none (then along the path, wings level):
///   heading_deg, pitch_deg, roll_deg            clockwise from north, nose up, right wing down; from the north and horizon of the scenario's origin with the
///                                               first two sets, of the place itself with the others. Any number of turns: 359 and 361 are 2 deg apart, as are
///                                               359 and 1; between rows a body turns the shorter way, so that rows must not lie half a turn apart or more
///   qw, qx, qy, qz                              turns body axes (x forward, y left, z up) into the scenario's east, north, up
///   ned_qw, ned_qx, ned_qy, ned_qz              turns body axes (x forward, y right, z down) into the scenario's north, east, down
/// Position between rows: cubic Hermite with the slopes of parabolas through three rows; velocity is continuous, and exact for even acceleration.
/// `askedAt`: where the file was named. Bounds: 256 MB, a million rows, 1e9 m and 1e9 s.
/// Errors: UserError with file:line:col.
Trajectory readTrajectoryCsv(const std::filesystem::path& file, const LocalFrame& frame, AtEnd before = AtEnd::Hold, AtEnd after = AtEnd::Hold,
                             const Location& askedAt = {});

}  // namespace pitviper
