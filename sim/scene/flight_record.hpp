#pragma once
// What is kept of a flight for those who tell of it: reports, histories, pictures.
#include <optional>
#include <string>

#include "sim/scene/trajectory.hpp"

namespace pitviper {

struct FlightRecord {
  std::string model;      ///< as the scenario has it: "missile", "ballistic", "route", "csv"
  Trajectory trajectory;  ///< local frame, also of what was launched from a carrier
  std::string end;        ///< why it ended: "duration", "ground", "closest approach", "end of path"
  std::string target;     ///< name of the entity that it flew at; empty: none
  /// To the target, of the whole flight.
  struct Closest {
    double time_s = 0.0, distance_m = 0.0;
  };
  std::optional<Closest> closest;
};

}  // namespace pitviper
