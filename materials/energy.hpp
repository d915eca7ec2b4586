#pragma once
// Whether a material reflects and emits no more than it receives.
#include <optional>
#include <span>

#include "sim/model/material.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

/// Where a material breaks the law, and by how much.
struct EnergyExcess {
  double sum = 0.0;  ///< reflectance + given emissivity
  double wavelength_um = 0.0;
  double viewAngle_rad = 0.0;
};

/// The law: sum over components of m_k D_k(lambda, theta_v) + m_E eps(lambda, theta_v) <= 1 + 1e-6 (rounding of the user's figures), with D
/// the directional-hemispherical reflectance and m the modifier textures, wherever the material has data. Source: Kirchhoff; PHYSICS 1.
/// Looked at: every wavelength at which a spectrum bends, the middles between and 65 over the range; every angle at which a table over the
/// view angle bends, every 2 deg, and every 0.5 deg beyond 80 deg; every texel. Textures of one size are taken texel by texel, textures
/// of several sizes on the lines of all their texels (a sum of bilinear functions is greatest on a corner); beyond 4e6 such corners, and
/// where thousands of wavelengths compete over millions of texels, it errs on the safe side.
std::optional<EnergyExcess> energyExcess(const Material& material, std::span<const Texture> textures);

}  // namespace pitviper
