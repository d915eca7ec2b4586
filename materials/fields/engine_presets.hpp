#pragma once
// Engines and motors by name: what leaves their nozzles at a throttle, a height and a speed of flight.
//
// Engines that breathe air are told by what their makers publish for a test bed at sea level: air flow, fuel flow, thrust, shaft power. The rest follows:
//   composition   complete combustion of CH1.917 (mean of Jet A, C12H23; Edwards and Maurice, J. Propul. Power 17 (2001) 461) in the air swallowed
//   exit speed    thrust over mass flow: all expanded to ambient pressure (Hill and Peterson, Mechanics and Thermodynamics of Propulsion (1992), eq. 5.2)
//   total temp.   enthalpy of the air + 42.8 MJ/kg of the fuel (ASTM D1655, least) x efficiency - shaft power; core and bypass fully mixed
//   exit temp.    total less kinetic enthalpy;  pressure ratio of the nozzle: isentropic between the two
//   diameter      mass flow over density and speed: of the stream at ambient pressure, not of the metal
// In flight, with T2, p2 total temperature and pressure before the engine (full recovery) and theta = T2/288.15 K:
//   theta <= 1: total temperature of the exhaust ~ theta, nozzle pressure over p2 kept, mass flow ~ p2/sqrt(T2) (equal corrected speed);
//   theta > 1: total temperature kept, (nozzle pressure/p2 - 1) ~ 1/theta. Both as Mattingly, Heiser and Pratt, Aircraft Engine Design (2002), app. D, with
//   the break at 1; the 1/theta, a constant rise of enthalpy in the compressor to first order, is chosen.
// Throttle 0 ... 1: the rise of total temperature, nozzle pressure ratio - 1 and corrected air flow each go as straight lines from the preset's part at 0
// (idle; for an afterburner its engine without) to 1; fuel flow ~ rise of temperature x air flow. Chosen, as are the parts at idle.
//
// Motors: chamber pressure and mass flow ~ throttle (choked throat), temperature kept, expanded to ambient pressure. Below twice the ambient pressure in
// the chamber nothing is drawn (the throat isn't choked: a motor dying out). Compositions: element balance of the formulation with CO + H2O = CO2 + H2 at
// equilibrium at chamber temperature (constants: NIST-JANAF), frozen from there (Sutton and Biblarz, Rocket Propulsion Elements (2010), 5.3), no
// dissociation. Chamber 7 MPa: their standard (1000 psia).
#include <optional>
#include <span>
#include <string_view>

#include "materials/fields/free_jet.hpp"

namespace pitviper {

struct BurnPhase {
  double end_s = 0.0;  ///< since ignition
  double throttle = 0.0;
};

struct EnginePreset {
  std::string_view name, description, source;
  // Both. Thrust of a motor: at throttle 1, expanded to 101325 Pa.
  double thrust_N = 0.0;
  // Breathes air, where above 0: at sea level, at rest, throttle 1.
  double airFlow_kg_s = 0.0, fuelFlow_kg_s = 0.0, shaftPower_W = 0.0;
  double exitSpeed_m_s = 0.0;  ///< 0: thrust over mass flow
  double combustionEfficiency = 1.0;
  double leastRise = 0.4, leastPressure = 0.05, leastFlow = 0.3;  ///< parts at throttle 0
  double sootPerFuel = 0.0, coPerFuel = 0.0;                      ///< kg per kg of fuel
  // Motor.
  Chamber chamber{};
  GasFractions gas{};
  double gasMolarMass_kg_mol = 0.0, specificHeat_J_kgK = 0.0;
  double sootMassFraction = 0.0, aluminaMassFraction = 0.0;
  std::span<const BurnPhase> burn{};  ///< then it coasts; empty for engines

  bool breathesAir() const { return airFlow_kg_s > 0.0; }
};

std::span<const EnginePreset> enginePresets();
/// Null where there is none of that name.
const EnginePreset* findEnginePreset(std::string_view name);

/// What leaves the nozzle; nothing where the motor is out. std::invalid_argument: a throttle outside 0 ... 1.
std::optional<NozzleFlow> nozzleOf(const EnginePreset& preset, double throttle, const CoFlow& around);
/// A motor's throttle since ignition: 0 before and after the burn. 1 for engines.
double burnThrottle(const EnginePreset& preset, double sinceIgnition_s);

}  // namespace pitviper
