#pragma once
// The sky as a surface on the ground sees it.
#include <optional>

#include "sim/model/atmosphere.hpp"
#include "sim/model/material.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

/// Cosine-weighted mean of the radiance of the sky's dome at a height [W/(m2 sr um)]: the uniform sky with the same irradiance on level ground. The
/// air's emission, sunlight it scatters (any number of times), and what lies behind it, seen through it; without the sun's disc. At the air's own knots of
/// wavelength. Gauss rule of 6 elevations, 6 azimuths: within 2 % of finer ones (tests/unit/test_air.cpp).
Spectrum meanSky(const std::shared_ptr<const Atmosphere>& path, const std::optional<Sun>& sun, const Spectrum& background,
                 const std::shared_ptr<const Material>& ground, double ground_K, double height_m, double earthRadius_m);

}  // namespace pitviper
