#pragma once
// Air of constant properties, and none at all.
#include <limits>
#include <memory>
#include <optional>

#include "sim/model/atmosphere.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

struct HomogeneousAir {
  Spectrum extinction_per_m;
  std::optional<double> temperature_K;                     ///< the air emits as a black body of it does
  std::optional<Spectrum> radiance;                        ///< further source radiance, scattered sunlight for instance [W/(m2 sr um)]
  double top_m = std::numeric_limits<double>::infinity();  ///< height of its top above the earth (LocalFrame::height)
};

std::shared_ptr<const Atmosphere> makeHomogeneousAir(HomogeneousAir air);
std::shared_ptr<const Atmosphere> makeNoAir();

}  // namespace pitviper
