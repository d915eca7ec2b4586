#pragma once
// Sunlight that level air over level ground passes on, scattered any number of times: photons that are followed back from where they are seen.
//
// Law: the radiance from a direction is the mean, over places where a line of sight may be scattered and over ways on from there, of the sunlight that comes
// straight to each place, times the phase function; ground reflects evenly to all sides. Each place lends its light to the way (next event estimation), ways
// that leave upwards are scattered before, with less weight. Source: Marchuk et al. 1980, The Monte Carlo Methods in Atmospheric Optics, chapters 2 and 4.
// Valid: layers that do not end sideways. The sun's own way may bend with the earth: its depths are given.
#include <glm/glm.hpp>
#include <random>
#include <vector>

namespace pitviper {

/// Air from the ground up.
struct WalkAir {
  std::vector<double> above;             ///< optical depth of all that lies above each edge of a layer, from the ground up: falling to 0
  std::vector<double> molecules;         ///< of each layer, the part of its extinction that molecules scatter ...
  std::vector<double> haze;              ///< ... and particles
  std::vector<double> cloud{};           ///< and those of a second kind; empty: there are none
  std::vector<double> sunlight;          ///< at each edge: share of the sun's irradiance that comes straight there
  std::vector<double> cloudAsymmetry{};  ///< of each layer
  double asymmetry = 0.0;                ///< of the particles (Henyey and Greenstein)
  double groundAlbedo = 0.0;
  glm::dvec3 toSun{0.0, 0.0, 1.0};  ///< z up
};

/// Numbers in [0, 1), the same on every machine.
using WalkDice = std::mt19937_64;
inline double unitOf(WalkDice& dice) { return static_cast<double>(dice() >> 11) * 0x1p-53; }

class PhotonWalk {
 public:
  explicit PhotonWalk(WalkAir air);
  /// What one way back from a place finds, for a sun of irradiance 1 [1/sr]: its mean over many is the radiance that comes to a place with so much depth above
  /// from a direction (towards where it comes from), without the sun itself.
  struct Found {
    double once = 0.0;    ///< scattered by air once, and nothing besides
    double again = 0.0;   ///< all the rest: scattered more often, or by the ground too
    double ground = 0.0;  ///< sent by the ground straight from the sun, unscattered
  };
  Found from(double depthAbove, const glm::dvec3& direction, WalkDice& dice) const;
  /// A direction that light seen from `direction` may have had before molecules or particles turned it.
  glm::dvec3 before(const glm::dvec3& direction, bool particles, WalkDice& dice) const { return before(direction, particles, air_.asymmetry, dice); }

  /// A direction over a plane, as often as light that comes evenly to its sides falls from there.
  static glm::dvec3 evenlySent(const glm::dvec3& normal, WalkDice& dice);

 private:
  static glm::dvec3 before(const glm::dvec3& direction, bool particles, double asymmetry, WalkDice& dice);
  std::size_t layerOf(double depthAbove) const;
  double sunAt(std::size_t layer, double depthAbove) const;
  WalkAir air_;
};

}  // namespace pitviper
