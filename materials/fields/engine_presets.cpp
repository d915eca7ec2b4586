#include "materials/fields/engine_presets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kGasConstant = 8.314462618;
constexpr double kPoundForce_N = 4.4482216152605, kPound_kg = 0.45359237;
constexpr double kStandard_K = 288.15, kStandard_Pa = 101325.0;  // US Standard Atmosphere 1976
constexpr double kReference_K = 298.15;                          // of enthalpies and heating values
constexpr double kHeating_J_kg = 42.8e6, kHydrogenPerCarbon = 1.917, kFuelPerCarbon_kg = 0.0120107 + kHydrogenPerCarbon * 0.00100794;
constexpr double kAirCp = 1004.7, kAirExponent = 3.5;  // gamma = 1.4
constexpr double kLeastChamberRatio = 2.0;             // a throat is choked above 1.8 to 1.9

// lb/h of fuel per lbf (or hp) to kg/s.
constexpr double fuel_kg_s(double specific, double amount) { return specific * amount / 3600.0 * kPound_kg; }

// Chosen courses: a boost that ends near the speed flown at, a weak sustain, then coasting.
constexpr std::array<BurnPhase, 2> kBoostSustain{BurnPhase{3.0, 1.0}, BurnPhase{8.0, 0.25}};
constexpr std::array<BurnPhase, 1> kBoost{BurnPhase{5.0, 1.0}};

constexpr double kAlumina = 0.340, kAluminisedGas = 0.018688;

const std::array<EnginePreset, 7> kPresets{{
    {.name = "turbofan_military",
     .description = "Low-bypass fighter turbofan without afterburner, 49 kN",
     .source = "General Electric F404-GE-402 data sheet: 11,000 lbf, 0.81 lb/(lbf h), 146 lb/s of air. Soot 0.1 g/kg, CO 1 g/kg of fuel: chosen, soot within "
               "the 0.03-0.72 g/kg of all particles (PM2.5) behind airliners (Mazaheri, Johnson and Morawska, Environ. Sci. Technol. 43 (2009) 441). "
               "Efficiency: Mattingly, Elements of Gas Turbine Propulsion (1996), table 6-2. Idle: chosen",
     .thrust_N = 11000.0 * kPoundForce_N,
     .airFlow_kg_s = 146.0 * kPound_kg,
     .fuelFlow_kg_s = fuel_kg_s(0.81, 11000.0),
     .combustionEfficiency = 0.99,
     .sootPerFuel = 1e-4,
     .coPerFuel = 1e-3},
    {.name = "turbofan_afterburner",
     .description = "The same with full afterburner, 79 kN; at throttle 0 without",
     .source = "General Electric F404-GE-402 data sheet: 17,700 lbf, 1.74 lb/(lbf h), 146 lb/s of air. Soot 0.1 g/kg, CO 20 g/kg of fuel: chosen. Efficiency "
               "0.96: Mattingly (1996), table 6-2. Parts at throttle 0: of turbofan_military",
     .thrust_N = 17700.0 * kPoundForce_N,
     .airFlow_kg_s = 146.0 * kPound_kg,
     .fuelFlow_kg_s = fuel_kg_s(1.74, 17700.0),
     .combustionEfficiency = 0.96,
     .leastRise = 0.36,
     .leastPressure = 1.0,
     .leastFlow = 1.0,
     .sootPerFuel = 1e-4,
     .coPerFuel = 2e-2},
    {.name = "small_turbojet",
     .description = "Small turbojet of a trainer, a light attack aircraft or a large target, 12.7 kN",
     .source = "General Electric J85-GE-17A: 2,850 lbf (Smithsonian National Air and Space Museum, A19800072000), 0.97 lb/(lbf h), 44 lb/s of air (published "
               "for the J85). Soot 0.5 g/kg (an old, smoky combustor; within the range of Mazaheri 2009), CO 5 g/kg: chosen. Idle: chosen",
     .thrust_N = 2850.0 * kPoundForce_N,
     .airFlow_kg_s = 44.0 * kPound_kg,
     .fuelFlow_kg_s = fuel_kg_s(0.97, 2850.0),
     .combustionEfficiency = 0.98,
     .sootPerFuel = 5e-4,
     .coPerFuel = 5e-3},
    {.name = "turboshaft",
     .description = "Helicopter turboshaft, 1.2 MW, plain exhaust without suppressor",
     .source = "General Electric T700-GE-700: 1,622 shp; 0.46 lb/(shp h), 10 lb/s of air (published). Exit speed 120 m/s: chosen (exhaust of turboshafts "
               "leaves at 100 to 150 m/s: little thrust is left in it). Soot 0.1 g/kg, CO 2 g/kg: chosen. Idle: chosen",
     .airFlow_kg_s = 10.0 * kPound_kg,
     .fuelFlow_kg_s = fuel_kg_s(0.46, 1622.0),
     .shaftPower_W = 1622.0 * 745.69987,
     .exitSpeed_m_s = 120.0,
     .combustionEfficiency = 0.99,
     .leastRise = 0.6,
     .leastPressure = 0.3,
     .leastFlow = 0.5,
     .sootPerFuel = 1e-4,
     .coPerFuel = 2e-3},
    {.name = "aluminised_motor",
     .description = "Solid motor with aluminium (AP/Al/HTPB 68/18/14): white smoke of alumina, 12 kN for 3 s, 3 kN for 5 s, coast",
     .source = "Formulation and 5600-5800 F: Sutton and Biblarz (2010), table 13-1 (HTPB/AP/Al, 4-17 % metal, here 18 %). Composition, gamma and specific "
               "heat: element balance, see the header. Thrust and course: chosen, of an air-to-air missile's size. All aluminium burnt, no soot: chosen",
     .thrust_N = 12e3,
     .chamber = {3422.0, 7e6, 1.174, kAluminisedGas / (1.0 - kAlumina)},
     .gas = {.co2 = 0.007, .h2o = 0.077, .co = 0.283, .oxygen = 0.0},
     .gasMolarMass_kg_mol = kAluminisedGas,
     .specificHeat_J_kgK = 1565.0,
     .aluminaMassFraction = kAlumina,
     .burn = kBoostSustain},
    {.name = "reduced_smoke_motor",
     .description = "Solid motor without metal (AP/HTPB 86/14): HCl, which smokes in moist air only; 12 kN for 5 s, coast",
     .source = "Formulation: Sutton and Biblarz (2010), 13.1, reduced smoke. Composition, flame temperature, gamma and specific heat: element and enthalpy "
               "balance, see the header. Thrust and course: chosen. No soot: chosen",
     .thrust_N = 12e3,
     .chamber = {2996.0, 7e6, 1.228, 0.025058},
     .gas = {.co2 = 0.097, .h2o = 0.382, .co = 0.160, .oxygen = 0.0},
     .gasMolarMass_kg_mol = 0.025058,
     .specificHeat_J_kgK = 1490.0,
     .burn = kBoost},
    {.name = "double_base_motor",
     .description = "Smokeless solid motor, double base (nitrocellulose/nitroglycerine/triacetin 57/31/12); 12 kN for 3 s, 3 kN for 5 s, coast",
     .source = "Formulation: typical of Sutton and Biblarz (2010), 13.1, who give 4100 F (2530 K) for double base. Composition, flame temperature, gamma and "
               "specific heat: element and enthalpy balance, see the header. Thrust and course: chosen. No soot: chosen",
     .thrust_N = 12e3,
     .chamber = {2437.0, 7e6, 1.249, 0.024172},
     .gas = {.co2 = 0.121, .h2o = 0.234, .co = 0.401, .oxygen = 0.0},
     .gasMolarMass_kg_mol = 0.024172,
     .specificHeat_J_kgK = 1476.0,
     .burn = kBoostSustain},
}};

// Mole fractions after complete combustion of `fuel` per mass of air, but for the CO given.
GasFractions exhaust(double fuel, double coPerFuel, const CoFlow& around) {
  const double air = 1.0 / molarMass_kg_mol({around.co2, around.h2o, 0.0, 0.2095 * (1.0 - around.h2o)});  // mol/kg
  const double carbon = fuel / kFuelPerCarbon_kg, co = coPerFuel * fuel / 0.0280101;
  const double co2 = around.co2 * air + carbon - co, h2o = around.h2o * air + 0.5 * kHydrogenPerCarbon * carbon;
  const double oxygenIn = 0.2095 * (1.0 - around.h2o) * air;
  const double oxygen = std::max(0.0, oxygenIn - carbon * (1.0 + 0.25 * kHydrogenPerCarbon) + 0.5 * co);
  const double nitrogen = air * (1.0 - around.co2 - around.h2o) - oxygenIn;
  const double all = co2 + h2o + co + oxygen + nitrogen;
  return {co2 / all, h2o / all, co / all, oxygen / all};
}

// Temperature at which the enthalpy above 298.15 K is what is given; a few rounds, for the mean specific heat changes slowly.
double temperatureOf(const GasFractions& gas, double enthalpy_J_kg) {
  double t = kReference_K + enthalpy_J_kg / 1100.0;
  for (int round = 0; round < 30; ++round) t = kReference_K + enthalpy_J_kg / meanSpecificHeat_J_kgK(gas, kReference_K, t);
  return t;
}

// Of an engine at sea level, at rest, at throttle 1.
struct Bench {
  double fuelAir, total_K, pressureRatio;
};
Bench benchOf(const EnginePreset& p) {
  const CoFlow standard;
  const double fuelAir = p.fuelFlow_kg_s / p.airFlow_kg_s;
  const GasFractions gas = exhaust(fuelAir, p.coPerFuel, standard);
  const double enthalpy =
      (kAirCp * (kStandard_K - kReference_K) + fuelAir * p.combustionEfficiency * kHeating_J_kg - p.shaftPower_W / p.airFlow_kg_s) / (1.0 + fuelAir);
  const double total_K = temperatureOf(gas, enthalpy);
  const double speed_m_s = p.exitSpeed_m_s > 0.0 ? p.exitSpeed_m_s : p.thrust_N / (p.airFlow_kg_s + p.fuelFlow_kg_s);
  double exit_K = total_K, cp = 0.0;
  for (int round = 0; round < 30; ++round) {
    cp = meanSpecificHeat_J_kgK(gas, exit_K, total_K);
    exit_K = total_K - 0.5 * speed_m_s * speed_m_s / cp;
  }
  return {fuelAir, total_K, std::pow(total_K / exit_K, cp * molarMass_kg_mol(gas) / kGasConstant)};
}

NozzleFlow ofEngine(const EnginePreset& p, double throttle, const CoFlow& around) {
  const Bench bench = benchOf(p);
  auto line = [throttle](double least) { return least + (1.0 - least) * throttle; };
  const double inlet_K = around.temperature_K + 0.5 * around.speed_m_s * around.speed_m_s / kAirCp;
  const double inlet_Pa = around.pressure_Pa * std::pow(inlet_K / around.temperature_K, kAirExponent);
  const double theta = inlet_K / kStandard_K;
  const double benchRise_K = bench.total_K - kStandard_K;
  // So fast that the air comes in as hot as the exhaust may be: no fuel, a tenth of the rise left to make it a flow.
  const double fullRise_K = std::max(bench.total_K * std::min(theta, 1.0) - inlet_K, 0.1 * benchRise_K);
  const double rise_K = fullRise_K * line(p.leastRise), total_K = inlet_K + rise_K;
  const double ratio = (1.0 + (bench.pressureRatio - 1.0) * line(p.leastPressure) / std::max(theta, 1.0)) * inlet_Pa / around.pressure_Pa;
  const double fuelAir = bench.fuelAir * rise_K / benchRise_K;

  NozzleFlow flow;
  flow.gas = exhaust(fuelAir, p.coPerFuel, around);
  const double molarMass = molarMass_kg_mol(flow.gas);
  double exit_K = total_K, cp = 0.0;
  for (int round = 0; round < 30; ++round) {
    cp = meanSpecificHeat_J_kgK(flow.gas, exit_K, total_K);
    exit_K = total_K * std::pow(ratio, -kGasConstant / (molarMass * cp));
  }
  flow.temperature_K = exit_K;
  flow.speed_m_s = std::sqrt(2.0 * cp * (total_K - exit_K));
  const double mass_kg_s = p.airFlow_kg_s * line(p.leastFlow) * inlet_Pa / kStandard_Pa / std::sqrt(theta) * (1.0 + fuelAir);
  const double density = around.pressure_Pa * molarMass / (kGasConstant * exit_K);
  flow.diameter_m = std::sqrt(4.0 / kPi * mass_kg_s / (density * flow.speed_m_s));
  flow.sootMassFraction = p.sootPerFuel * fuelAir / (1.0 + fuelAir);
  return flow;
}

}  // namespace

std::span<const EnginePreset> enginePresets() { return kPresets; }

const EnginePreset* findEnginePreset(std::string_view name) {
  const auto found = std::find_if(kPresets.begin(), kPresets.end(), [name](const EnginePreset& p) { return p.name == name; });
  return found == kPresets.end() ? nullptr : &*found;
}

std::optional<NozzleFlow> nozzleOf(const EnginePreset& p, double throttle, const CoFlow& around) {
  if (!(throttle >= 0.0 && throttle <= 1.0)) throw std::invalid_argument("engine preset: a throttle lies between 0 and 1");
  if (p.breathesAir()) return ofEngine(p, throttle, around);
  Chamber chamber = p.chamber;
  chamber.pressure_Pa *= throttle;
  if (!(chamber.pressure_Pa > kLeastChamberRatio * around.pressure_Pa)) return std::nullopt;
  const double mass_kg_s = throttle * p.thrust_N / expandedNozzle(p.chamber, kStandard_Pa).speed_m_s;
  const ExpandedFlow exit = expandedNozzle(chamber, around.pressure_Pa);
  NozzleFlow flow;
  flow.diameter_m = std::sqrt(4.0 / kPi * mass_kg_s / (exit.density_kg_m3 * exit.speed_m_s));
  flow.temperature_K = exit.temperature_K;
  flow.speed_m_s = exit.speed_m_s;
  flow.gas = p.gas;
  flow.gasMolarMass_kg_mol = p.gasMolarMass_kg_mol;
  flow.specificHeat_J_kgK = p.specificHeat_J_kgK;
  flow.sootMassFraction = p.sootMassFraction;
  flow.aluminaMassFraction = p.aluminaMassFraction;
  return flow;
}

double burnThrottle(const EnginePreset& p, double sinceIgnition_s) {
  if (p.burn.empty()) return 1.0;
  if (!(sinceIgnition_s >= 0.0)) return 0.0;
  for (const BurnPhase& phase : p.burn)
    if (sinceIgnition_s < phase.end_s) return phase.throttle;
  return 0.0;
}

}  // namespace pitviper
