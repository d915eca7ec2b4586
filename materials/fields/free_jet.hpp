#pragma once
// A round turbulent jet, matched in pressure to the air it leaves into, in a flow along it: the exhaust of an engine or of a motor.
//
// Mean profiles over radius r at a distance x from the nozzle:
//   u = U + (u0 - U) A_u F(r; c_u, w_u),   Z = A_z F(r; c_z, w_z),   F = 1 for r < c, exp(-((r - c)/w)^2) beyond
// u speed in the frame of the nozzle, U that of the flow around; Z mixture fraction: mass of what left the nozzle per mass. Either A = 1 (a core of
// radius c > 0) or c = 0 (a Gaussian whose centre has fallen). Mass fractions of species and total enthalpy are linear in Z (turbulent Lewis number 1,
// no reaction), so that the fluxes of every species and of excess enthalpy, kinetic included, stay constant with that of Z. Source: Pope, Turbulent
// Flows (2000), 5.2 (Gaussian-like self-similar profiles); conserved scalars: Kuo, Principles of Combustion, mixture fraction.
//
// Four conditions give c or A and w of both profiles at each x, over these very profiles with their density (radial quadrature):
//   excess momentum  J = int rho u (u - U) dA = m0 (u0 - U),   m0 nozzle mass flow
//   nozzle mass      int rho u Z dA = m0
//   width ratio      (w_z/w_u)^2 = 1 + (1/Sc_t - 1)(1 - A_u), Sc_t = 0.7. Far away 1/Sc_t: a self-similar jet of constant turbulent Schmidt number has
//                    Z ~ (u/uc)^Sc_t (Hinze, Turbulence (1975), 6-8; Pope 10.2: 0.7). Along the core 1: then mixture is excess speed over that of the
//                    nozzle (Crocco's relation), whatever the density, and both cores end together. Between them chosen: a ratio of 1.2 from the nozzle on
//                    would end the mixture's core first, and in a supersonic jet leave cold gas at full speed on the axis.
//   entrained mass   int rho (u - U) + rho U sqrt(F_u) dA = M(x) + ml, in still air the mass flow itself:
//                    dM/dx = 0.32 (sqrt(pi)/2) sqrt(rho_a J) g r,  M(0) = m0
//     ml: what the layer has that leaves the nozzle's lip: both profiles have the width w = 0.2 R there, and the core that carries J with it. Chosen: its
//        momentum thickness is 0.26 w = 0.05 R, more than a model nozzle's boundary layer (0.005 ... 0.02 R) and of the order of the cooled film along an
//        engine's liner; mixing from a sharp lip has that width 1.1 diameters behind it. At uniform density ml = 0.11 m0.
//     0.32: Ricou and Spalding, J. Fluid Mech. 11 (1961) 21-32: M/m0 = 0.32 (x/d) sqrt(rho_a/rho_0) in still air.
//     r: the start. Hill, J. Fluid Mech. 51 (1972) 773-779: a third of the full rate one diameter behind the nozzle, rising to it at 13; here a straight
//        line through these two, with d sqrt(rho_0/rho_a) for the diameter as in Ricou and Spalding: r = min(1, sqrt(25 + 36 m)/18), m = (M/m0 - 1)/0.32.
//        So in still air (M + ml)/m0 = 0.32 (x/d_e - 1.57) + 0.11 from x = 13 d_e on: 6.1 % below Ricou and Spalding's line at 20 d_e, 1.2 % at 100 d_e.
//     g: co-flow. The top hat of equal mass and momentum flux, whose excess speed is dU = J/M, widens as dB/dx ~ dU/(U + dU) (spreading hypothesis:
//        Chu, Lee and Chu, J. Hydraul. Eng. 125 (1999) 193-204; Lee and Chu, Turbulent Jets and Plumes (2003)). With J constant that is
//        g = 2 sqrt(1 + k)/(2 + k), k = U M / J: 1 in still air, width ~ x^(1/3) where the excess is small.
// sqrt(F) has the area of that top hat (2 pi w^2), which makes J = M dU hold exactly for a Gaussian of uniform density.
//
// Valid: subsonic and moderately supersonic jets, Reynolds numbers above some 10^4. Left out: shock cells and Mach disks of a nozzle that isn't matched,
// slower mixing at high convective Mach numbers (cold supersonic jets keep their core longer than here: Witze, AIAA J. 12 (1974) 417),
// burning of CO and H2 in air (rocket exhaust is hotter than here by that), buoyancy, turbulent fluctuation, particles that lag behind the gas.
#include <cstddef>
#include <span>
#include <vector>

namespace pitviper {

/// Mole fractions of a gas; what is left is nitrogen.
struct GasFractions {
  double co2 = 0.0, h2o = 0.0, co = 0.0, oxygen = 0.0;
};
/// Specific heat at constant pressure, the mean between two temperatures [J/(kg K)]. Enthalpies: Chase, NIST-JANAF Thermochemical Tables (1998), taken as
/// straight between 200, 298.15, 500, 700, 1000, 1500 ... 3000 K (error of the mean below 1 %; held outside).
double meanSpecificHeat_J_kgK(const GasFractions& gas, double first_K, double second_K);
/// [kg/mol]
double molarMass_kg_mol(const GasFractions& gas);

/// What leaves the nozzle, at the pressure of the air around.
struct NozzleFlow {
  double diameter_m = 0.0;
  double temperature_K = 0.0;  ///< static
  double speed_m_s = 0.0;      ///< against the nozzle
  GasFractions gas{};
  double gasMolarMass_kg_mol = 0.0;  ///< 0: of `gas`
  double specificHeat_J_kgK = 0.0;   ///< of all that leaves, mean between ambient and exit temperature; 0: of `gas`
  double sootMassFraction = 0.0;     ///< of all that leaves
  double aluminaMassFraction = 0.0;  ///< of all that leaves; particles at temperature and speed of the gas
};

/// Air around, and its speed past the nozzle along the jet: the speed of flight.
struct CoFlow {
  double pressure_Pa = 101325.0;
  double temperature_K = 288.15;
  double speed_m_s = 0.0;
  double co2 = 420e-6, h2o = 0.0;  ///< mole fractions
};

/// Profiles at one distance. The first four numbers tell all; between rows they are straight lines in x (1/A_u and 1/A_z are nearly that in a jet).
/// c = R max(shape, 0), A = 1/(1 - min(shape, 0)), R the nozzle's radius.
struct JetRow {
  double x_m = 0.0;
  double shapeU = 1.0, widthU_m = 0.0, shapeZ = 1.0;
  double widthZ_m = 0.0;
  double coreU_m = 0.0, coreZ_m = 0.0;
  double speed_m_s = 0.0;  ///< on the axis
  double mixture = 1.0;    ///< on the axis
};

/// All that a program needs beside the rows:
///   i = int(x < coreLength ? log(1 + x/rowScale)/rowLogRatio : coreRow + log(x/coreLength)/farLogRatio), at most rowCount - 2
///   (a step down while row[i].x > x, or up while row[i + 1].x < x, takes rounding away)
///   (shapeU, widthU, shapeZ) = mix(row[i], row[i + 1], (x - row[i].x)/(row[i + 1].x - row[i].x))
///   widthZ = widthU sqrt(1 + 0.428571 (1 - 1/(1 - min(shapeU, 0))))
///   F(shape, w, r): c = radius max(shape, 0); s = max(r - c, 0); f = s > 0 ? (w > 0 ? exp(-(s/w)^2) : 0) : 1; f/(1 - min(shape, 0))
///   u = ambientSpeed + excessSpeed F(shapeU, widthU, r);  Z = F(shapeZ, widthZ, r)
///   T = ambientTemperature + (excessEnthalpy Z - cpExcess ambientTemperature Z - (u^2 - ambientSpeed^2)/2)/(cp + cpExcess Z)
///   n = moles + molesExcess Z [mol gas/kg];  density = pressure/(8.314462618 T n)
///   p_CO2 = pressure (co2 + co2Excess Z)/n, likewise H2O and CO;  soot volume fraction = density soot Z;  alumina [kg/m3] = density alumina Z
/// (T is (h0_a + excessEnthalpy Z - u^2/2)/(cp + cpExcess Z) with h0_a = cp T_a + U^2/2, written so that single precision keeps it).
struct JetConstants {
  double radius_m = 0.0;
  double ambientSpeed_m_s = 0.0, excessSpeed_m_s = 0.0;
  double ambientTemperature_K = 0.0, excessEnthalpy_J_kg = 0.0;  ///< total enthalpy of what leaves the nozzle less that of the air
  double cp_J_kgK = 0.0, cpExcess_J_kgK = 0.0;
  double moles_mol_kg = 0.0, molesExcess_mol_kg = 0.0;
  double co2_mol_kg = 0.0, co2Excess_mol_kg = 0.0, h2o_mol_kg = 0.0, h2oExcess_mol_kg = 0.0, coExcess_mol_kg = 0.0;
  double soot_m3_kg = 0.0;  ///< volume of soot per mass of what left the nozzle
  double alumina = 0.0;     ///< mass of alumina per mass of what left the nozzle
  double pressure_Pa = 0.0;
  double rowScale_m = 0.0, rowLogRatio = 0.0, farLogRatio = 0.0;
  double coreLength_m = 0.0;  ///< where the core of undisturbed speed ends; the length where it doesn't
  double length_m = 0.0;
  int coreRow = 0, rowCount = 0;
};

struct JetState {
  double temperature_K = 0.0, speed_m_s = 0.0, mixture = 0.0, density_kg_m3 = 0.0;
  double co2_Pa = 0.0, h2o_Pa = 0.0, co_Pa = 0.0;  ///< partial pressures
  double sootVolumeFraction = 0.0, alumina_kg_m3 = 0.0;
};
/// The formulas of JetConstants, in double.
JetState jetState(const JetConstants& constants, const JetRow& row, double r_m);

struct JetFluxes {
  double excessMomentum_N = 0.0;
  double excessEnthalpy_W = 0.0;  ///< total, kinetic included
  double mixture_kg_s = 0.0;      ///< of what left the nozzle; a species' is this times its mass fraction there
  double mass_kg_s = 0.0;         ///< M above: in still air all mass that flows
};

class FreeJet {
 public:
  /// As long as it matters: to where 1 % of what flows on the axis came from the nozzle (some 10 K above a 1300 K exhaust's air), at most 5000 diameters.
  FreeJet(const NozzleFlow& nozzle, const CoFlow& around);
  /// std::invalid_argument: a figure that is no number, a diameter, temperature, pressure, speed or length that is not above zero (a nozzle that
  /// nothing leaves has no jet), fractions below 0 or together above 1, temperatures below 10 K.
  /// std::runtime_error: no profiles of this kind carry these fluxes (not met in the tests' range).
  ///
  /// A jet slower than 1.05 U would have next to no or negative excess momentum: a wake, for which these laws have no answer. It is then taken to leave
  /// at 1.05 U through a nozzle as much narrower as keeps its mass flow (isRaised()); 5 % is chosen: about what boundary layers of nozzle and body,
  /// left out here, would mix at.
  FreeJet(const NozzleFlow& nozzle, const CoFlow& around, double length_m);

  std::span<const JetRow> rows() const { return rows_; }
  const JetConstants& constants() const { return constants_; }
  double length_m() const { return constants_.length_m; }
  bool isRaised() const { return raised_; }
  /// The row at a distance; held before the nozzle and beyond the length.
  JetRow at(double x_m) const;
  /// Before the nozzle and beyond the length: the air around.
  JetState stateAt(double x_m, double r_m) const;
  /// Largest radius where |T - T_a| is at least `part` of |T0 - T_a|; 0 where there is none. Where exhaust and air are equally warm (to 1 K): of the mixture.
  double reach_m(double x_m, double part = 0.01) const;
  /// Largest radius where the mixture fraction is at least `mixture`; 0 where there is none.
  double mixtureRadius_m(double x_m, double mixture) const;
  JetFluxes fluxes(double x_m) const;

 private:
  void prepare(const NozzleFlow& nozzle, const CoFlow& around);
  void march(double length_m);
  JetConstants constants_;
  double massFlow_kg_s_ = 0.0, momentum_N_ = 0.0, ambientDensity_kg_m3_ = 0.0, nozzleTemperature_K_ = 0.0;
  bool raised_ = false;
  std::vector<JetRow> rows_;
};

/// Gas in a rocket's chamber.
struct Chamber {
  double temperature_K = 0.0, pressure_Pa = 0.0;
  double gamma = 0.0;             ///< of all that leaves, particles included
  double molarMass_kg_mol = 0.0;  ///< mass of all that leaves per mole of gas
};
struct ExpandedFlow {
  double temperature_K = 0.0, speed_m_s = 0.0, density_kg_m3 = 0.0;
};
/// Isentropic expansion to a pressure: T = Tc (p/pc)^((g-1)/g), u = sqrt(2 g/(g-1) R Tc/W (1 - (p/pc)^((g-1)/g))).
/// Source: Sutton and Biblarz, Rocket Propulsion Elements (2010), eq. 3-7 and 3-15. Composition and g frozen, no losses. std::invalid_argument: a
/// chamber pressure not above the ambient one, a figure that is not above zero, g <= 1.
ExpandedFlow expandedNozzle(const Chamber& chamber, double ambientPressure_Pa);

}  // namespace pitviper
