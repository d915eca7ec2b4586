#pragma once
// Light in a cloud of drops by a Monte Carlo: ways followed back from the eye, double precision; the reference of sim/radiometry/glsl/cloud.glsl.
//
// Law: free ways by Woodcock's tracking (what collides with a majorant is real with the share of the extinction there), Henyey and Greenstein's phase function,
//   the sun's light lent at each place (next event estimation), albedos as weights on the same ways. Source: Marchuk et al. 1980, chapters 2 and 4; Woodcock
//   et al. 1965. Held against van de Hulst's layers and H functions where it was made (R, T of a layer of depth 2, albedo 0.9, g 0.75: within 0.0003).
#include <vector>

#include "materials/fields/density_grid.hpp"
#include "tests/support/photon_walk.hpp"

namespace pitviper {

struct CloudPhotons {
  const DensityGrid& extinction;  ///< [1/m]
  double asymmetry = 0.85;
  std::vector<double> albedos;  ///< all from the same ways
  glm::dvec3 toSun{0.0, 0.0, 1.0};
};
/// Parts of a radiance: of a sun of irradiance 1 [1/sr]; of an even sky, an even ground and drops of a radiance of 1.
struct CloudParts {
  double sun = 0.0, sky = 0.0, ground = 0.0, drops = 0.0;
};
/// Mean over ways, of each albedo.
std::vector<CloudParts> cloudLight(const CloudPhotons& cloud, const glm::dvec3& eye, const glm::dvec3& direction, int ways, WalkDice& dice);

}  // namespace pitviper
