#pragma once
// How closely what flies passed what it flew at.
#include <string>
#include <vector>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// Of one body or camera and another body, as the scenario moves them; commands have no part in it.
struct Encounter {
  std::string body, target;
  std::string kind;  ///< "flight": a body and what it was guided to; "camera": a camera and what it looks at
  double time_s = 0.0, distance_m = 0.0;
  bool passed = false;  ///< it came nearer before and went away after; else the least of the time looked at, at one of its ends
  glm::dvec3 at{0.0}, targetAt{0.0};
  double relativeSpeed_m_s = 0.0, speed_m_s = 0.0, targetSpeed_m_s = 0.0;
  /// Between the target's nose and the direction that the body comes from relative to it (at a closest approach the line to it lies across): 0 head-on, pi from
  /// behind. Of a camera the direction that it is in.
  double aspect_rad = 0.0;
  std::string end;  ///< why the flight ended
};

/// Those of all flights with a target, over the whole flight, whatever part of it was drawn; and of cameras and the bodies they look at, from begin to end,
/// unless neither moves or the camera is carried by a body that flies at the same target. Nearest within a step, by the cubic through its ends (sim/flight).
std::vector<Encounter> encountersOf(const Simulation& simulation, double begin_s, double end_s);

/// As comma-separated values: the first line names columns and units.
std::string encountersText(const std::vector<Encounter>& encounters);

}  // namespace pitviper
