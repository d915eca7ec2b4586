#pragma once
// Which levels of temperature of a species a field needs: each is a material of the simulation, and costs the plan and every pixel.
#include "materials/fields/species.hpp"

namespace pitviper {

struct GasLevels {
  std::vector<std::size_t> level;  ///< of the table, rising
  /// Worst error, against all levels of the table, of what the thin gas of a jet sends more than the air in kLevelBands_um.
  double error = 0.0;
};

/// Bands that count [um].
constexpr double kLevelBands_um[][2] = {{2.5, 3.1}, {3.0, 5.0}, {4.1, 4.6}, {4.4, 5.0}, {8.0, 12.0}};
/// Of the spread over temperatures of a jet's gas; six to eight levels for an afterburner or a motor, all four of an engine without one.
constexpr double kLevelError = 0.007;

/// The fewest of the levels that range from low to high, its ends among them, whose error is below that.
GasLevels gasLevels(const SpeciesTable& table, double low_K, double high_K, double error = kLevelError);

}  // namespace pitviper
