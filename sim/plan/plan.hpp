#pragma once
// What a set of sensor outputs requires of a scene: which terms exist, at which wavelengths they are evaluated and with which
// weights they become channels. Here the nodes follow the user's `spectral` setting; a planner that chooses them for the
// scene and an accuracy replaces makePlan() and nothing else.
#include <memory>
#include <string>
#include <vector>

#include "sim/model/simulation.hpp"
#include "sim/model/spectral_node.hpp"
#include "sim/model/sun_legs.hpp"

namespace pitviper {

/// Nodes that feed the same slots.
struct NodeBlock {
  int first = 0;
  int count = 0;
  std::vector<int> slots;
};

/// Terms of the radiance equation that a kind of surfaces has.
struct SurfaceTerms {
  bool any = false;       ///< there are such surfaces
  bool reflects = false;  ///< light that falls on them
  bool emits = false;
  bool angular = false;  ///< tables over angles, or an emissivity or transmittance that changes with view angle
  bool modifiers = false;
  bool temperatureTextures = false;
  std::string lobeFile;  ///< shader file of the angular lobes, or empty
  bool isGeneral() const { return angular || modifiers || temperatureTextures; }
};

/// Terms of the radiance equation that this scene has.
struct Terms {
  bool air = false;           ///< extinction and path radiance
  bool scatteredSun = false;  ///< sunlight that the air scatters, and the sky's by it
  bool lights = false;        ///< point lights or the sun
  bool ambient = false;
  bool shadows = false;       ///< of the lights
  SurfaceTerms solid, layer;  ///< opaque and transparent surfaces
  bool media = false;         ///< bodies filled with an emitting medium
};

/// Entries of layered air's tables for a view (sim/render/air_tables). Linear between: their error falls with the square of both.
struct AirGrid {
  int elevations = 33, ranges = 96;
};

struct Plan {
  std::vector<SpectralNode> nodes;
  std::vector<NodeBlock> blocks;
  int slotCount = 0;
  std::vector<int> slotOfOutput;            ///< one per output
  std::vector<std::vector<double>> weight;  ///< [slot][node]
  std::vector<double> predictedError;       ///< [slot]: largest relative error expected; empty where none was asked for
  AirGrid airGrid;
  Terms terms;
  int lightCount = 0;                      ///< point lights and, last, the sun
  std::shared_ptr<const SunLegs> sunLegs;  ///< layered air in sunlight

  int nodeCount() const { return static_cast<int>(nodes.size()); }
  int groupCount() const { return (slotCount + 3) / 4; }  ///< vec4 targets
};

/// The scene at one wavelength.
SpectralNode nodeAt(const Simulation& simulation, double wavelength_um);

/// Slots of one pass: four RGBA targets.
constexpr int kMostSlots = 16;

/// Outputs with the same kernel share a slot. Throws UserError where there are more than 16 kernels, a response is zero, or
/// the spectrum of a material, light, air or background does not cover a channel's band (naming both).
Plan makePlan(const Simulation& simulation, const std::vector<ChannelOutput>& outputs, const SpectralSampling& sampling, const Location& where);

}  // namespace pitviper
