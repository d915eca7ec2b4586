#pragma once
// Directions around a place: rings above its horizon and below, closer together at the horizon, linear between.
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "sim/radiometry/harmonics.hpp"

namespace pitviper {

/// Where values stand. Ring 0 above is the horizon as the sky meets it, the last the zenith; behind them ring 0 below is the horizon as the ground meets it,
/// the last the nadir. Azimuths go counterclockwise, from x where nothing turns them, evenly.
struct DirectionGrid {
  int above = 25, below = 13, azimuths = 24;
  double turn_rad = 0.0;     ///< azimuth of the first entries
  double horizon_rad = 0.0;  ///< elevation of the horizon: at heights, below 0

  /// One on which degrees up to 4 are nearly linear between entries (4 deg at most in elevation, 7.5 deg in azimuth); its rings and azimuths have this one's
  /// among them.
  DirectionGrid finer() const;
  std::size_t size() const { return static_cast<std::size_t>((above + below) * azimuths); }
  double elevation_rad(int ring) const;
  glm::dvec3 direction(std::size_t entry) const;
  struct Reading {
    std::array<std::size_t, 4> at;
    std::array<double, 4> weight;  ///< of sum 1
  };
  Reading at(const glm::dvec3& direction) const;
  /// Places and solid angles [sr] of a rule for what is linear on the grid times what is smooth; of sum 4 pi within 1e-9.
  struct Sample {
    glm::dvec3 direction;
    double solidAngle;
    Reading reading;
  };
  /// `points` a side of each of its cells.
  std::vector<Sample> samples(int points) const;
  /// Harmonics of what is linear on it: [entry][l l + l + m], coefficients of a value of 1 at the entry.
  std::vector<Harmonics> harmonics() const;
};

}  // namespace pitviper
