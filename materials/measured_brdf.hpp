#pragma once
// BRDFs of isotropic surfaces over three angles, as measured: made alike both ways, their holes filled or refused, brought to tables over two angles by
// azimuth.
#include <string>
#include <vector>

#include "materials/brdf_table.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {

/// What the three angles are.
enum class MeasuredAngles {
  Directions,  ///< incidence, view, and the azimuth between light and viewer about the normal: 0 on the same side, 180 deg opposite
  Half,        ///< half vector to normal, light to half vector, and the light's azimuth about the half vector from the plane of half vector and normal
  HalfRoot     ///< the same, the first as Angle::HalfRoot
};

/// At every crossing of rising wavelengths and angles; NaN: not measured.
struct MeasuredGrid {
  MeasuredAngles kind = MeasuredAngles::Directions;
  std::vector<double> wavelength_um, angle1_rad, angle2_rad, azimuth_rad;
  std::vector<double> values;  ///< [1/sr], [azimuth][angle 2][angle 1][wavelength]
  double mostHoles = 0.0;      ///< so large a share of what both directions can see may be missing
  /// Entries of the two axes; 0: as many as have all of its angles on an even grid.
  std::array<int, 2> entries{};
};

struct MeasuredBrdf {
  std::vector<BrdfTable> parts;  ///< by azimuth, evenly from 0 to `last_rad`
  double last_rad = 0.0;
  std::vector<ViewAlbedo> albedos;  ///< of the parts
  std::vector<std::string> notes;   ///< what was changed, and by how much
};

/// The shares of azimuths, 1 in all.
Lobe azimuthLobe(const MeasuredBrdf& brdf, MeasuredAngles kind, std::size_t part);
double azimuthLobeAt(MeasuredAngles kind, const Lobe& lobe, const glm::dvec3& light, const glm::dvec3& view);

/// Alike both ways and in a mirror; at up to `mostAzimuths` azimuths, as few as keep it to 0.3 % rms of flux; no view returning more than it receives.
/// UserError at `where`: more holes than allowed, angles on no even grid, a change of more than 10 % for either law.
MeasuredBrdf measuredBrdf(MeasuredGrid grid, int mostAzimuths, const Location& where);

}  // namespace pitviper
