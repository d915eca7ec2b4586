#pragma once
// Rows of the tables of layered air: what one line of sight has before it and sends, range by range, in double precision.
#include <span>

#include "atmosphere/layered_grid.hpp"
#include "sim/radiance/node_air.hpp"
#include "sim/radiance/sunlit_air.hpp"

namespace pitviper {

/// A line of sight of a table.
struct AirLine {
  double sine = 0.0;          ///< of its elevation
  double across = 0.0;        ///< as AirGrid::firstAcross
  bool meetsHorizon = false;  ///< the next row above is over the horizon: towards space it has what the horizon has
  bool reachesSpace = true;   ///< false: nothing is asked of it beyond the grid's ranges, its last entry says nothing
};

/// Of lines of the same elevation one after the other, all but what depends on the azimuth.
struct SameElevation {
  SameWay sent, onHorizon;
};

/// Entries by range.
struct AirRow {
  std::vector<float> amounts;  ///< [range][4 x vectors]: ln of the mean per km; at the first the density there, to space of all
  std::vector<float>
      radiance;  ///< [range][part][value]: emission less that of air of one temperature; scattered by molecules, by haze, and by haze again for phases of 1/sr
};

class AirRows {
 public:
  /// `perChannel`: values are of channels (direct mode), else of nodes. Both must outlive it.
  AirRows(const Simulation& simulation, const Plan& plan, bool perChannel);
  /// Rows are of this grid from here on.
  void begin(const AirGrid& grid);
  /// An entry for each of the grid's ranges, space last. May be called from several threads at once, as may the others.
  AirRow at(const AirLine& line, SameElevation* known = nullptr) const;
  /// Of ranges rising from stationsOf().front() on [m].
  AirRow at(const AirLine& line, std::span<const double> ranges_m, SameElevation* known = nullptr) const;
  /// The ranges that at(line) looks at [m]: from where the air begins, as far as space.
  std::vector<double> stationsOf(const AirLine& line) const { return grid_.rangesFrom(entryOf(line.sine)); }
  double cosScatterOf(const AirLine& line) const;

  int vectors() const { return vectors_; }  ///< four absorbers each
  int values() const { return values_; }
  int parts() const { return parts_; }
  int columns() const { return grid_.places.ranges + 1; }
  /// Per node: radiance of a black body of the air's temperature at the camera.
  const std::vector<double>& black() const { return black_; }
  /// Of haze, per value; padded to vec4.
  const std::vector<double>& asymmetries() const { return asymmetry_; }

 private:
  NodeRadiance sentAlong(const SunlitAir& line, SameWay* known) const;
  void writeRadiance(const NodeRadiance& sent, std::span<const size_t> asked, double cosScatter, AirRow& row) const;
  double entryOf(double sine) const;
  std::vector<double> asymmetriesOf() const;
  const Simulation& simulation_;
  const Plan& plan_;
  bool perChannel_;
  int vectors_ = 1, values_ = 0, parts_ = 1;
  NodeAir air_;
  std::vector<double> sunIrradiance_;  ///< per node
  std::vector<double> asymmetry_, black_;
  AirGrid grid_;
};

}  // namespace pitviper
