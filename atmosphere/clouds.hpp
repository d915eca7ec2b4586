#pragma once
// Layers of cloud over all of the sky, and rain and snow below them, as particles of layered air.
//
// Law: a cloud lies evenly between its base and its top, of drops or crystals of one distribution of sizes around an effective radius.
//   Rain of R mm/h: drops N0 exp(-L D), N0 = 8000 /(m3 mm), L = 4.1 R^-0.21 /mm: extinction 0.365 R^0.63 /km, effective radius 1.5 / L.
//   Snow of R mm/h of water: R / (1 m/s) of ice in the air, of crystals of 0.15 mm: extinction 3.0 R /km, 1.3 km of visibility at 1 mm/h.
// Source: heights and extinctions of clouds chosen after MODTRAN's (Berk et al., MODTRAN user's manual, water clouds and cirrus; not compared with a print);
//   effective radii after Hess, Koepke and Schult 1998, Bull. Am. Met. Soc. 79, 831; J. S. Marshall and W. M. Palmer 1948, J. Meteor. 5, 165; of snow the
//   figures are chosen, among the visibilities that Rasmussen et al. 1999, J. Appl. Meteor. 38, 1542 report.
// Valid: layers without edges to the side. What rain turns by less than a pixel still counts as lost to a picture.
#include <vector>

#include "atmosphere/absorber_table.hpp"
#include "atmosphere/models.hpp"

namespace pitviper {

/// Keys of an entry of `clouds`.
const ParameterTable& cloudTable();
/// Those of layered air that this room reads.
std::vector<Parameter> cloudParameters();
/// What they ask for, cloud by cloud. Errors: UserError at what no cloud has.
void addClouds(const AirRecord& air, AbsorberTable& table);

}  // namespace pitviper
