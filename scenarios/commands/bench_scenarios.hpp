#pragma once
// The scenes that `bench` draws: a wall that fills the film, seen through air, and what is varied about it.
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// What the transparent layers before the wall do.
enum class LayerKind {
  Attenuating,  ///< let 0.8 through, emit nothing, no air anywhere
  Emitting,     ///< warm, in air
  Reflecting    ///< and lit
};

/// The defaults are the centre that one factor at a time departs from.
struct BenchSetting {
  int film_px = 256;
  int channels = 16, wavelengths = 16, lights = 1;
  int farLights = 0;         ///< further ones, a thousand kilometres away: they light every pixel by less than single precision can tell
  int overdraw = 1;          ///< plates behind one another, the visible one last in the file: the worst order
  int triangles = 2;         ///< of each plate, about
  int bodies = 0;            ///< spheres of 2000 triangles before the wall, in rows, each 15 pixels wide or less
  int layers = 0;            ///< transparent plates before the wall
  LayerKind layerKind = LayerKind::Emitting;
  bool air = true;
  RenderMode mode = RenderMode::Direct;
  std::string shading;  ///< as PITVIPER_SHADING; empty: what the machine chooses
};

Simulation benchSimulation(const BenchSetting& setting);

}  // namespace pitviper
