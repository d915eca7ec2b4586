#pragma once
// Light in plane layers told finely from a solution by few streams: its source function is smooth, so radiance by it has more digits than the streams
// themselves.
//
// Law: the formal solution with sources w/(4 pi) integral of P (I + sun) and (1 - w) B, I of the few streams' moments, at more directions; of that the moments
// anew,
//   to higher degrees. The sun's own light is turned by the whole phase function, its forward peak included.
// Source: Chandrasekhar 1960, chapter I (formal solution); Stamnes et al. 1988, Appl. Opt. 27, 2502 (iteration of the source function).
// Errors: tests/physics/test_diffuse_light.cpp.
#include "sim/radiance/adding_doubling.hpp"

namespace pitviper {

struct FineDirections {
  int hemisphere = 16;  ///< Gauss points of each
  int degree = 16;      ///< moments l below this are told
  int azimuths = 12;
  int passes = 1;  ///< each takes the moments of the one before
};

/// `coarse`: lightIn() of the same layers. The layers' moments: as many as are known, l below 40 are used. Moments alone are told.
LayerLight finer(const PlaneLayers& layers, const LayerLight& coarse, const FineDirections& directions);

}  // namespace pitviper
