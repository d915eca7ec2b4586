#pragma once
// What a set of sensor outputs requires of a scene: which terms exist, at which wavelengths they are evaluated and with which
// weights they become channels. Here the nodes follow the user's `spectral` setting; planFor() (planner.hpp) chooses them for the
// scene and an accuracy.
#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/model/simulation.hpp"
#include "sim/model/spectral_node.hpp"
#include "sim/radiance/terms.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/sun_legs.hpp"

namespace pitviper {

/// Nodes that feed the same slots.
struct NodeBlock {
  int first = 0;
  int count = 0;
  std::vector<int> slots;
  bool lit = true;  ///< reflected light of the sun or of points matters in these channels
};

/// The greatest part of what channels see that a term makes up, over the lines of sight looked at.
struct TermShare {
  std::string term;
  std::vector<double> share;  ///< [slot]: relative to the pixel, as errors are
  bool kept = true;
};

/// What a channel's predicted error is made of, relative to the pixel.
struct PredictedParts {
  double wavelengths = 0.0;   ///< largest on lines that no fit has seen, times a margin
  double tables = 0.0;        ///< between entries of tables
  double dropped = 0.0;       ///< terms left out
  double precision = 0.0;     ///< single precision
  double surroundings = 0.0;  ///< ambient light by so many harmonics
  double streams = 0.0;       ///< light scattered again by so many streams
  double fields = 0.0;        ///< steps through plumes and clouds, and lines through pixels of them, at most
  double extremes = 0.0;      ///< of wavelengths, largest on the lines at the extremes; not in the sum
  double sum() const { return wavelengths + tables + dropped + precision + surroundings + streams + fields; }
};

/// Entries of the tables that the GPU reads air from; 0: none.
struct AirTableSize {
  int elevations = 0, ranges = 0;
  int azimuths = 1;        ///< of scattered sunlight
  double over = 0.0;       ///< range of the signed root of their sine that the elevations span, at places that stay; 0: what a view sees
  double across = 0.0;     ///< the same of azimuths: of their cosine times the sun's horizontal part
  double near_m = 0.0;     ///< ranges lie evenly up to about here, beyond in their logarithm; at most, and if 0, a thousandth of the farthest
  double same = 1.0;       ///< views share tables whose heights and suns lie within this of the usual steps (air_grid.cpp)
  double sunDepth = 10.0;  ///< of the air from the ground to the sun as the sunlight that gets through has it; the largest of all channels
  bool operator==(const AirTableSize&) const = default;
};

/// Part of the film's brightest (99th percentile) that an error is measured against where it is dark.
constexpr double kDark = 1e-3;
/// The percentile that planning takes in its place, on some hundred lines of sight: of what is bright on a hundredth of the film these lines may by chance meet
/// more than their share, and all else would then count as dark beside it.
constexpr std::size_t kBrightPercent = 97;
/// What counts as dark in any film [W/(m2 sr um)]: to a pixel of 1e-9 m2 sr a micrometre of it sends a photon in five hours.
constexpr double kDarkest = 1e-14;
/// What a pixel counts as at least where an error is relative to it. `bright`: what the bright pixels of the channel have; `kernel`: its integral over
/// wavelength, which is the sum of its weights.
inline double darkFloor(double bright, double kernel) { return std::max(kDark * bright, kDarkest * kernel); }

struct Plan {
  std::vector<SpectralNode> nodes;
  std::vector<NodeBlock> blocks;
  int slotCount = 0;
  std::vector<int> slotOfOutput;            ///< one per output
  std::vector<std::vector<double>> weight;  ///< [slot][node]
  AirTableSize air;
  double accuracy = 0.0;               ///< relative error asked for; 0: none was
  double textureAccuracy = 0.0;        ///< to which textures are read over what a pixel covers of them; 0: at single places
  std::vector<double> predictedError;  ///< [slot]: largest relative error expected; empty where nothing was measured
  std::vector<PredictedParts> parts;   ///< [slot]: what it is made of
  int lines = 0;                       ///< lines of sight it was measured on
  std::string fingerprint;             ///< of all that drawing takes from it
  std::vector<int> fineCount;          ///< [slot]: wavelengths of the reference
  std::vector<TermShare> shares;       ///< what was looked at to keep or drop terms; empty where no accuracy was asked for
  Terms terms;
  int surroundings = kMostHarmonicOrder;   ///< ambient light by direction, as Terms::surroundings has it
  std::vector<double> surroundingsLoss;    ///< [slot]: what that loses on the lines it was chosen on; empty: nobody has looked
  int streams = kUsualStreams;             ///< of light scattered again, as Terms::streams
  std::vector<double> streamsLoss;         ///< [slot]: what that loses; empty: nobody has looked
  int lightCount = 0;                      ///< point lights and, last, the sun
  std::shared_ptr<const SunLegs> sunLegs;  ///< layered air in sunlight

  int nodeCount() const { return static_cast<int>(nodes.size()); }
  int groupCount() const { return (slotCount + 3) / 4; }  ///< vec4 targets
  std::vector<double> darkFloors() const;                 ///< [slot]: darkFloor() of a film that is dark everywhere
};

/// The scene at one wavelength.
SpectralNode nodeAt(const Simulation& simulation, double wavelength_um);

/// A plan of fewer wavelengths: each block of single ones is cut into at most `most` stretches, and the middle wavelength of each has the weight of its stretch
/// in every slot.
Plan someWavelengths(const Plan& plan, int most);

/// Slots of one pass: four RGBA targets.
constexpr int kMostSlots = 16;

/// One output of each slot. Outputs with the same kernel share a slot, unless one is kept apart. `slotOfOutput`: of each output.
std::vector<const ChannelOutput*> differentKernels(std::span<const ChannelOutput> outputs, std::vector<int>* slotOfOutput = nullptr);

/// Outputs with the same kernel share a slot. Throws UserError where there are more than 16 kernels, a response is zero, or
/// the spectrum of a material, light, air or background does not cover a channel's band (naming both).
Plan makePlan(const Simulation& simulation, const std::vector<ChannelOutput>& outputs, const SpectralSampling& sampling, const Location& where);

}  // namespace pitviper
