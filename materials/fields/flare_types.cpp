// Flares by name.
#include <algorithm>

#include "materials/fields/flares.hpp"

namespace pitviper {
namespace {

using Point = std::array<double, 2>;

constexpr Point kGrey[] = {{0.3, 0.8}, {30.0, 0.8}};
/// CO2 from 4.15 to 4.75 um, CO and its wing to 4.95, H2O and CO2 from 2.6 to 3.0 um and H2O at 1.9 um, over a thin grey floor of particles.
constexpr Point kBands[] = {{0.3, 0.02},  {1.75, 0.02}, {1.85, 0.04}, {1.95, 0.04}, {2.05, 0.02}, {2.5, 0.02}, {2.65, 0.08},
                            {2.95, 0.08}, {3.1, 0.02},  {4.1, 0.03},  {4.2, 1.0},   {4.7, 1.0},   {4.8, 0.3},  {4.95, 0.1},
                            {5.2, 0.03},  {14.0, 0.03}, {14.3, 0.3},  {15.7, 0.3},  {16.0, 0.03}, {30.0, 0.03}};
constexpr Point kFoil[] = {{0.3, 0.7}, {30.0, 0.7}};

const FlareType kTypes[] = {
    {.name = "mtv",
     .description = "magnesium, Teflon and Viton: a grey flame of about 2000 K, white smoke; a payload of the class 1 x 1 x 8 inch",
     .source = "Published, as orders: a grey flame of some 2000 K and an emissivity near 0.8, ratio of bands close to a black body's, some 0.1 kJ/(g sr) from "
               "3 to 5 um, rise "
               "within some 0.1 s, burning for 3 to 5 s (E.-C. Koch, Propellants Explos. Pyrotech. 26 (2001) 3 and 31 (2006) 3; Metal-Fluorocarbon Based "
               "Energetic Materials "
               "(2012); N. Brune, Expendable Decoys, in The Infrared and Electro-Optical Systems Handbook vol. 7 (1993)); with 40 to 50 g/s that is 5 kW/sr. "
               "Chosen: losses in the "
               "windstream and at height, drag of a tumbling stick (coefficient 1, mean projected area), even burning, tail, depth.",
     .temperature_K = 2000.0,
     .emissivity = kGrey,
     .intensity_W_sr = 5000.0,
     .ignition_s = 0.03,
     .rise_s = 0.12,
     .burn_s = 4.0,
     .fall_s = 0.8,
     .stillShare = 0.25,
     .speedScale_m_s = 90.0,
     .pressureExponent = 0.35,
     .mass_kg = 0.2,
     .burntShare = 0.8,
     .dragArea_m2 = 5.5e-3,
     .depth = 3.0,
     .glow_s = 8e-3,
     .smoke = "mtv",
     .smokeYield = 0.8},
    {.name = "spectrally_matched",
     .description = "burns to hot CO2, CO and water with few particles: from 3 to 5 um several times what it sends from 2 to 3 um, as jets do",
     .source = "Published, as orders: several times as much from 3.5 to 4.8 um as from 2 to 3 um, at a third of the intensity of MTV of equal mass or less "
               "(E.-C. Koch, Propellants "
               "Explos. Pyrotech. 31 (2006) 3; Metal-Fluorocarbon Based Energetic Materials (2012); N. Brune in Handbook vol. 7 (1993)). Places of bands: "
               "those of CO2, CO and H2O, "
               "hot. Chosen: emissivities of bands and floor, 1.5 kW/sr, times, losses, drag as of a stick of its mass.",
     .temperature_K = 1900.0,
     .emissivity = kBands,
     .intensity_W_sr = 1500.0,
     .ignition_s = 0.03,
     .rise_s = 0.15,
     .burn_s = 3.5,
     .fall_s = 0.8,
     .stillShare = 0.35,
     .speedScale_m_s = 110.0,
     .pressureExponent = 0.5,
     .mass_kg = 0.25,
     .burntShare = 0.85,
     .dragArea_m2 = 6e-3,
     .depth = 2.5,
     .glow_s = 10e-3,
     .smoke = "soot",
     .smokeYield = 0.02},
    {.name = "pyrophoric",
     .description = "a cloud of thin iron foils that glow in air without a flame: warm grey radiation, next to invisible, stops behind the aircraft at once",
     .source =
         "Published, as orders: foils of porous iron glow at 900 to 1100 K for some seconds, no visible flame, little smoke (E.-C. Koch, Propellants Explos. "
         "Pyrotech. 31 (2006) 3; "
         "N. Brune in Handbook vol. 7 (1993)). Chosen: 1050 K, emissivity 0.7, 1.2 kW/sr, times, losses, spread of the foils, drag area of some 50 foils.",
     .temperature_K = 1050.0,
     .emissivity = kFoil,
     .intensity_W_sr = 1200.0,
     .ignition_s = 0.0,
     .rise_s = 0.35,
     .burn_s = 3.5,
     .fall_s = 2.8,
     .stillShare = 0.5,
     .speedScale_m_s = 150.0,
     .pressureExponent = 1.0,
     .mass_kg = 0.15,
     .burntShare = 0.0,
     .dragArea_m2 = 0.1,
     .depth = 0.6,
     .glow_s = 30e-3,
     .spread_m_s = 0.8}};

}  // namespace

std::span<const FlareType> flareTypes() { return kTypes; }

const FlareType* findFlareType(std::string_view name) {
  const auto found = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const FlareType& t) { return t.name == name; });
  return found == std::end(kTypes) ? nullptr : &*found;
}

}  // namespace pitviper
