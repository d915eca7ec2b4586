#pragma once
// Colours of pictures from CIE 1931 tristimulus values.
#include <glm/glm.hpp>
#include <vector>

#include "sim/image/picture.hpp"

namespace pitviper {

/// Linear sRGB of XYZ relative to a white of Y = 1: (0.9505, 1, 1.089) is (1, 1, 1). Components leave 0 to 1 where no screen shows the colour.
/// Source: IEC 61966-2-1:1999; equation 12 of Durikovic and Kimura (2007).
glm::dvec3 linearSrgb(const glm::dvec3& xyz);

/// 0..1 as a screen's 8 bits, by sRGB's curve; cut at its ends.
Rgb8 srgbPixel(const glm::dvec3& linear);

/// A picture of pixels in cd/m2, `white` of them the screen's. Nothing is adapted: what is lit by an orange lamp is orange.
std::vector<Rgb8> srgbPixels(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z, double white);

/// The largest of each pixel's linear components [cd/m2].
std::vector<float> strongestPrimary(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z);

}  // namespace pitviper
