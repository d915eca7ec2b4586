#pragma once
// The eye that `eye: true` gives a camera, for pictures without one; and whether two materials look alike to it.
#include <glm/glm.hpp>

#include "scenarios/reader/scenario_reader.hpp"
#include "scenarios/view/sphere_picture.hpp"

namespace pitviper {

/// X, Y, Z [cd/m2] of the CIE 1931 observer, from the library's curves. UserError where the library has none.
std::vector<SphereChannel> eyeChannels(const Libraries& libraries);

/// X, Y, Z of a material lit at 45 degrees and seen along its normal, relative to a white (an ideal diffuse reflector) of Y = 1. `light`: its spectrum, of any
/// size. `eye`: eyeChannels(). Textures and states as in SpherePicture. Source: CIE 15:2018 (45:0 geometry, reflectance factor). UserError
/// where the material has no data that the eye needs, or the light none that it sees.
glm::dvec3 xyzOf(const Material& material, const Spectrum& light, const std::vector<SphereChannel>& eye);

/// The same of the white.
glm::dvec3 whiteOf(const Spectrum& light, const std::vector<SphereChannel>& eye);

/// CIE 1976 L*a*b* of X, Y, Z, and the distance of two colours in it; 1 is about what an eye tells apart side by side. Source: CIE 15:2018.
glm::dvec3 labOf(const glm::dvec3& xyz, const glm::dvec3& white);
double colourDifference(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& white);

}  // namespace pitviper
