#pragma once
// Lights under which a material is looked at by itself.
#include <string>
#include <vector>

#include "scenarios/reader/scenario_reader.hpp"

namespace pitviper {

struct Illuminant {
  std::string name;
  Spectrum irradiance;  ///< [W/(m2 um)] on a plane that faces it
};

/// Sun, D65, A and sodium, and of a scenario its own sun and lamps, these at 10 m.
std::vector<Illuminant> illuminantsOf(const Libraries& libraries, const Simulation* scenario);

}  // namespace pitviper
