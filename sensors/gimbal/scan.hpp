#pragma once
// Scans: where a pattern has turned the line of sight at a time, as a function of time alone. Offsets (left, up) in the line's own axes [rad].
#include <glm/glm.hpp>

namespace pitviper {

struct Scan {
  enum class Kind { None, Raster, Spiral, Conical, Rosette };
  /// Optics: a mirror or prism turns the line of sight behind the gimbal, whose limits it does not know. Gimbal: the pattern is demanded of the gimbal.
  enum class By { Optics, Gimbal };
  Kind kind = Kind::None;
  By by = By::Optics;
  double width_rad = 0.0, height_rad = 0.0;  ///< Raster: the field
  int lines = 1;                             ///< Raster
  double lineRate_Hz = 0.0;                  ///< Raster: lines a second, each with its flyback
  double flyback = 0.0;                      ///< Raster: share of a line's time in which the beam goes back, 0 <= flyback < 1
  double radius_rad = 0.0;                   ///< Spiral, Conical, Rosette: of the whole pattern
  double frequency_Hz = 0.0;                 ///< Spiral, Conical: turns a second; Rosette: of the first element
  double secondFrequency_Hz = 0.0;           ///< Rosette: of the second element, which turns the other way
  double turns = 1.0;                        ///< Spiral: from the centre to the edge
  double phase_rad = 0.0;                    ///< Conical: at time 0
};

/// Raster: from left to right at an even rate, lines from the top one down, each in the middle of its height_rad / lines; in the flyback evenly to the start
/// of the next line, after the last one to the first.
/// Spiral (Archimedean): radius and angle grow evenly, r = R turn / turns; from the edge back to the centre as it came, so that nothing jumps.
/// Conical: a circle.
/// Rosette: two elements of R/2 each that turn against one another, x + i y = R/2 (exp(2 pi i f1 t) + exp(-2 pi i f2 t)), hence
/// |r| = R |cos(pi (f1 + f2) t)|. Source: S. G. Jahng et al., "Dynamic simulation of the rosette scanning infrared seeker and an infrared
/// counter-countermeasure using the moment technique", Opt. Eng. 38, 921 (1999).
glm::dvec2 scanAt(const Scan& scan, double time_s);

/// Errors: std::invalid_argument for what scanAt() cannot do: sizes and rates that are not positive, no lines, a flyback outside [0, 1).
void requireSound(const Scan& scan);

}  // namespace pitviper
