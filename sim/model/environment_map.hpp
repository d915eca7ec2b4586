#pragma once
// Pictures of what shines on a scene from all around, as surroundings.
#include "sim/image/exr.hpp"
#include "sim/model/surroundings.hpp"

namespace pitviper {

/// How a picture covers all directions. LatitudeLongitude: rows from zenith to nadir, the middle column towards a heading, to the right by east round. Cube: a
/// row of six square faces: ahead, right, behind, left, up, down; seen from within, up at their tops (of `up`: behind, of `down`: ahead).
enum class MapLayout { LatitudeLongitude, Cube };

/// The direction that a place in a picture shows, (0, 0) its upper left corner and (1, 1) its lower right; axes of the scenario's frame (east, north, up).
/// heading_rad: of the middle column or of the first face, clockwise from north.
glm::dvec3 mapDirection(MapLayout layout, double across, double down, double heading_rad);
/// Solid angle of what lies around it [sr] by the share of the picture that it takes.
double mapSolidAngle(MapLayout layout, double across, double down);

/// Means of the layers over what lies around each entry of a grid: [entry][layer].
std::vector<std::vector<double>> layersOnGrid(const DirectionGrid& grid, const std::vector<const FloatLayer*>& layers, int width, int height, MapLayout layout,
                                              double heading_rad);

/// Spectra of red, green and blue of 1 under a light: (1, 1, 1) has the colour and the luminance of that light. Smooth reflectances like those of the three
/// primaries of a ColorChecker times the light, weighted; from 0.36 to 0.83 um, no data outside. Source: Durikovic and Kimura 2006, section 4.
/// x, y, z: the CIE 1931 functions. Throws std::invalid_argument where the light has no colour there.
std::array<Spectrum, 3> raisedPrimaries(const Spectrum& light, const Spectrum& x, const Spectrum& y, const Spectrum& z);

}  // namespace pitviper
