#pragma once
// Where the tables of layered air have entries for a view. A function of view and scene alone, so that frames are the same whatever was drawn before them:
// what a view needs is widened to fixed steps, and views with the same steps have the same tables.
#include <vector>

#include "sim/plan/plan.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

/// Elevations lie evenly in the signed root of their sine: near the horizon a small step crosses much air.
double spreadOf(double sine);

/// What the entries of a table's rows are, whatever rows there are.
struct AirPlaces {
  double height_m = 0.0, highest_m = 0.0;  ///< of the eye that they are for, and the highest of the eyes that use them
  double sunSine = 0.0;                    ///< of the sun's elevation
  double farthest_m = 0.0;                 ///< of what is in the scene
  double scale_m = 0.0;                    ///< ranges lie evenly in ln(1 + range / scale)
  int ranges = 0;
  double step = 0.0, stepAcross = 0.0;  ///< of elevations; of azimuths, 0 where there is one
  bool operator==(const AirPlaces&) const = default;
};

struct AirGrid {
  AirPlaces places;
  double low = 0.0, high = 0.0;          ///< sines of elevation that it holds
  double first = 0.0;                    ///< elevation, as spreadOf() has it
  double firstAcross = 0.0;              ///< cosine of the azimuth to the sun times the sun's horizontal part
  double viewLow = 0.0, viewHigh = 0.0;  ///< the same, of all that the view sees
  int azimuths = 1, elevations = 0;

  double sineAt(int elevation) const;
  double acrossAt(int azimuth) const;
  double entriesPerLog() const;
  /// Of a ray that meets the air after so many metres: the table's entries, places on the way to space that it has none for, space.
  std::vector<double> rangesFrom(double entry_m) const;
  /// Sine of the elevation at which the sphere of the earth begins.
  double horizon(double earthRadius_m) const;
  /// The lowest, of the highest eye.
  double lowestHorizon(double earthRadius_m) const;
  bool operator==(const AirGrid&) const = default;
};

/// Optical depth of the air on the way from the ground to the sun, per slot: the mean over the sunlight that gets through.
std::vector<double> depthsToSun(const Simulation& simulation, const Plan& plan);

/// How much of spreadOf() a view sees, and of cosines of the azimuth to the sun times the sun's horizontal part.
std::pair<double, double> widthsOf(const Simulation& simulation, const View& view);

/// Tables at two heights of the eye that stay the same while it moves between them: what air holds and sends bends little with the height, so they are mixed.
struct AirGrids {
  AirGrid below, above;  ///< alike but for the height
  double share = 0.0;    ///< of the one above
  bool operator==(const AirGrids&) const = default;
};

/// The grids of a view. `state`: for how far things are.
AirGrids airGrids(const Simulation& simulation, const Plan& plan, const AirTableSize& size, const View& view, const WorldState& state);

/// Whether tables made for a view from the same place hold all that a narrower one sees (zoomed views of small bodies).
bool holds(const AirGrid& grid, const Simulation& simulation, const Plan& plan, const View& narrower, const WorldState& state);

}  // namespace pitviper
