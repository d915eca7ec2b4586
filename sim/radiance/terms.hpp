#pragma once
// Which terms of the radiance equation a scene has.
#include <set>
#include <string>
#include <utility>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// Terms of the radiance equation that a kind of surfaces has.
struct SurfaceTerms {
  bool any = false;       ///< there are such surfaces
  bool reflects = false;  ///< light that falls on them
  bool emits = false;
  bool angular = false;  ///< tables over angles, or an emissivity or transmittance that changes with view angle
  bool modifiers = false;
  bool temperatureTextures = false;
  bool surroundings = false;                            ///< they reflect light that is not the same from all around
  std::set<std::pair<std::string, std::string>> lobes;  ///< shader file and function of each angular lobe
  /// Emission is a product of averages over a group of wavelengths; else the average of a product, one row of a table.
  bool isGeneral() const { return angular || modifiers || temperatureTextures || surroundings; }
};

/// Streams of light in the air (sim/radiance/adding_doubling.hpp) where no accuracy says how many, and of the reference.
constexpr int kUsualStreams = 8, kFinestStreams = 16;

/// Terms of the radiance equation that a scene has.
struct Terms {
  static constexpr int kWhole = -1;
  bool air = false;           ///< extinction and path radiance
  bool scatteredSun = false;  ///< sunlight that the air scatters once, and the sky's by it
  int streams = 0;            ///< of light that the air scatters any number of times, thermal light too (sim/radiance/diffuse_light.hpp); 0: left out
  bool lights = false;        ///< point lights or the sun
  bool ambient = false;
  int surroundings = 0;       ///< ambient light by direction, by harmonics of degrees up to this; kWhole: in full; 0: its mean, a uniform dome
  bool shadows = false;       ///< of the lights
  SurfaceTerms solid, layer;  ///< opaque and transparent surfaces
  bool media = false;         ///< bodies filled with an emitting medium
  bool fields = false;        ///< media that vary through their bodies
};

/// The same with the surroundings up to another degree.
Terms withSurroundings(Terms terms, int degree);

Terms termsOf(const Simulation& simulation);

}  // namespace pitviper
