#include "materials/fields/free_jet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kGasConstant = 8.314462618;  // J/(mol K), CODATA 2018
// IUPAC 2021 atomic weights; dry air with 420 ppm CO2: US Standard Atmosphere 1976.
constexpr double kCo2 = 0.0440095, kH2o = 0.0180153, kCo = 0.0280101, kN2 = 0.0280134, kO2 = 0.0319988, kDryAir = 0.0289647;
constexpr double kSootDensity_kg_m3 = 1800.0;  // Park, Kittelson, Zachariah and McMurry, J. Nanopart. Res. 6 (2004) 267: 1.78 g/cm3 of inherent density
constexpr double kSchmidt = 0.7;               // Pope, 10.2
constexpr double kEntrainment = 0.32;          // Ricou and Spalding
constexpr double kLip = 0.2;                   // of the radius: the shear layer's width at the nozzle
constexpr double kLeastExcess = 0.05;          // chosen, see the constructor
constexpr double kRowRatio = 1.08;             // 1 + a row's length over its distance: straight lines in it miss x^(2/3) by 0.0002
constexpr double kFirstRows = 0.5;             // nozzle diameters below which rows are about evenly spaced: a tenth of a core
constexpr double kFaint = 0.01, kLongest = 5000.0;

// H - H(298.15 K) [kJ/mol] of N2, O2, CO2, H2O, CO. NIST-JANAF.
constexpr std::array<double, 9> kTableTemperature_K{200.0, 298.15, 500.0, 700.0, 1000.0, 1500.0, 2000.0, 2500.0, 3000.0};
constexpr double kEnthalpy[5][9] = {{-2.857, 0.0, 5.911, 11.937, 21.463, 38.405, 56.137, 74.312, 92.715},
                                    {-2.868, 0.0, 6.084, 12.499, 22.703, 40.599, 59.175, 78.328, 98.013},
                                    {-3.414, 0.0, 8.305, 17.754, 33.397, 61.705, 91.439, 121.917, 152.852},
                                    {-3.282, 0.0, 6.925, 14.192, 26.000, 48.151, 72.790, 98.964, 126.549},
                                    {-2.858, 0.0, 5.931, 12.023, 21.690, 38.850, 56.744, 74.985, 93.504}};

double enthalpy_J_mol(const double (&table)[9], double temperature_K) {
  size_t i = 0;
  while (i + 2 < kTableTemperature_K.size() && temperature_K > kTableTemperature_K[i + 1]) ++i;
  const double part = (temperature_K - kTableTemperature_K[i]) / (kTableTemperature_K[i + 1] - kTableTemperature_K[i]);
  return 1e3 * (table[i] + part * (table[i + 1] - table[i]));
}

// Gauss-Legendre, 8 points on [-1, 1]: Abramowitz and Stegun, table 25.4.
constexpr std::array<double, 8> kNode{-0.960289856497536, -0.796666477413627, -0.525532409916329, -0.183434642495650,
                                      0.183434642495650,  0.525532409916329,  0.796666477413627,  0.960289856497536};
constexpr std::array<double, 8> kWeight{0.101228536290376, 0.222381034453374, 0.313706645877887, 0.362683783378362,
                                        0.362683783378362, 0.313706645877887, 0.222381034453374, 0.101228536290376};
// Panels of the shoulders, in velocity widths beyond the larger core. At 5.4 the mixture (up to 1/sqrt(0.7) wider) has fallen to exp(-20).
constexpr std::array<double, 6> kPanel{0.0, 0.7, 1.5, 2.4, 3.6, 5.4};

double coreOf(double shape) { return std::max(shape, 0.0); }
double amplitudeOf(double shape) { return shape < 0.0 ? 1.0 / (1.0 - shape) : 1.0; }
double widthRatioOf(double shapeU) { return std::sqrt(1.0 + (1.0 / kSchmidt - 1.0) * (1.0 - amplitudeOf(shapeU))); }

// Fluxes of momentum, mixture and mass per 2 pi R^2, and their derivatives by ln w, shapeU, shapeZ. Lengths in nozzle radii.
struct Integrals {
  std::array<double, 3> value{};
  std::array<std::array<double, 3>, 3> slope{};
};

struct Point {
  double u, z, density, temperature;
};
Point pointOf(const JetConstants& k, double fu, double fz) {
  const double u = k.ambientSpeed_m_s + k.excessSpeed_m_s * fu, z = fz;
  const double cp = k.cp_J_kgK + k.cpExcess_J_kgK * z;
  const double t = k.ambientTemperature_K +
                   ((k.excessEnthalpy_J_kg - k.cpExcess_J_kgK * k.ambientTemperature_K) * z - 0.5 * k.excessSpeed_m_s * fu * (u + k.ambientSpeed_m_s)) / cp;
  return {u, z, k.pressure_Pa / (kGasConstant * t * (k.moles_mol_kg + k.molesExcess_mol_kg * z)), t};
}

Integrals integrate(const JetConstants& k, double width, double shapeU, double shapeZ) {
  Integrals sum;
  const double cu = coreOf(shapeU), cz = coreOf(shapeZ), au = amplitudeOf(shapeU), az = amplitudeOf(shapeZ);
  const double ratio = widthRatioOf(shapeU), wz = ratio * width, inner = std::min(cu, cz), outer = std::max(cu, cz);
  const double ratioSlope = shapeU < 0.0 ? -0.5 * (1.0 / kSchmidt - 1.0) * au * au / (ratio * ratio) : 0.0;  // d ln(ratio)/d shapeU
  const double ambient = k.ambientSpeed_m_s, excess = k.excessSpeed_m_s;
  if (inner > 0.0) {  // uniform; its size has no derivative, for at its border both sides agree
    const Point p = pointOf(k, 1.0, 1.0);
    const double area = 0.5 * inner * inner;
    sum.value = {p.density * p.u * (p.u - ambient) * area, p.density * p.u * area, p.density * p.u * area};
  }
  auto panel = [&](double from, double to) {
    const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
    for (size_t i = 0; i < kNode.size(); ++i) {
      const double r = middle + half * kNode[i], weight = kWeight[i] * half * r;
      const double etaU = std::max(r - cu, 0.0) / width, etaZ = std::max(r - cz, 0.0) / wz;
      const double fu = std::exp(-etaU * etaU), fz = std::exp(-etaZ * etaZ), rootF = std::sqrt(fu);
      const Point p = pointOf(k, au * fu, az * fz);
      const double du = p.u - ambient, cp = k.cp_J_kgK + k.cpExcess_J_kgK * p.z, moles = k.moles_mol_kg + k.molesExcess_mol_kg * p.z;
      const double momentum = p.u * du, mixture = p.u * p.z, mass = du + ambient * rootF;
      const double w = weight * p.density;
      sum.value[0] += w * momentum;
      sum.value[1] += w * mixture;
      sum.value[2] += w * mass;
      // d ln density = -dT/T - dn/n, dT = ((excess enthalpy - cpExcess (T - ...)) dZ - u du)/cp
      const double byZ = -(k.excessEnthalpy_J_kg - k.cpExcess_J_kgK * p.temperature) / (cp * p.temperature) - k.molesExcess_mol_kg / moles;
      const double byU = p.u / (cp * p.temperature);
      const double slopeU[3] = {excess * au * fu * 2.0 * etaU * etaU, excess * (shapeU > 0.0 ? 2.0 * etaU / width * fu : au * au * fu), 0.0};
      const double slopeZ[3] = {az * fz * 2.0 * etaZ * etaZ, az * fz * 2.0 * etaZ * etaZ * ratioSlope, shapeZ > 0.0 ? 2.0 * etaZ / wz * fz : az * az * fz};
      const double slopeRoot[3] = {rootF * etaU * etaU, shapeU > 0.0 ? rootF * etaU / width : 0.0, 0.0};
      for (size_t j = 0; j < 3; ++j) {
        const double density = byZ * slopeZ[j] + byU * slopeU[j];
        sum.slope[0][j] += w * (momentum * density + (p.u + du) * slopeU[j]);
        sum.slope[1][j] += w * (mixture * density + p.z * slopeU[j] + p.u * slopeZ[j]);
        sum.slope[2][j] += w * (mass * density + slopeU[j] + ambient * slopeRoot[j]);
      }
    }
  };
  if (outer > inner) panel(inner, outer);
  for (size_t i = 0; i + 1 < kPanel.size(); ++i) panel(outer + kPanel[i] * width, outer + kPanel[i + 1] * width);
  return sum;
}

using Unknowns = std::array<double, 3>;  // ln(width in radii), shapeU, shapeZ

std::array<double, 3> residuals(const Integrals& sum, const std::array<double, 3>& target) {
  return {sum.value[0] / target[0] - 1.0, sum.value[1] / target[1] - 1.0, sum.value[2] / target[2] - 1.0};
}
double largest(const std::array<double, 3>& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

// Newton's method with steps cut until the residual falls. False where it doesn't get there.
bool solve(const JetConstants& k, const std::array<double, 3>& target, Unknowns& unknowns) {
  constexpr double kEnough = 1e-9;  // of a flux: far below the 1e-4 aimed at, above rounding
  Integrals sum = integrate(k, std::exp(unknowns[0]), unknowns[1], unknowns[2]);
  std::array<double, 3> miss = residuals(sum, target);
  for (int round = 0; round < 40; ++round) {
    if (!std::isfinite(largest(miss))) return false;
    if (largest(miss) < kEnough) return true;
    double m[3][4];
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) m[i][j] = sum.slope[i][j] / target[i];
      m[i][3] = -miss[i];
    }
    for (size_t c = 0; c < 3; ++c) {  // elimination with pivots
      size_t pivot = c;
      for (size_t i = c + 1; i < 3; ++i)
        if (std::abs(m[i][c]) > std::abs(m[pivot][c])) pivot = i;
      std::swap(m[c], m[pivot]);
      if (!(std::abs(m[c][c]) > 0.0)) return false;
      for (size_t i = 0; i < 3; ++i)
        if (i != c)
          for (size_t j = 4; j-- > c;) m[i][j] -= m[i][c] / m[c][c] * m[c][j];
    }
    Unknowns step{m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
    // Never leap: half an e-fold of the width, half a radius of a core, half of 1/A.
    double part = 0.5 / std::max(0.5, std::abs(step[0]));
    for (size_t j = 1; j < 3; ++j) part = std::min(part, 0.5 * std::max(1.0, 1.0 - unknowns[j]) / std::max(1e-300, std::abs(step[j])));
    bool better = false;
    for (int halving = 0; halving < 12 && !better; ++halving, part *= 0.5) {
      Unknowns next = unknowns;
      for (size_t j = 0; j < 3; ++j) next[j] += part * step[j];
      next[1] = std::min(next[1], 1.0);
      next[2] = std::min(next[2], 1.0);
      const Integrals there = integrate(k, std::exp(next[0]), next[1], next[2]);
      const auto thereMiss = residuals(there, target);
      if (std::isfinite(largest(thereMiss)) && largest(thereMiss) < largest(miss)) {
        unknowns = next;
        sum = there;
        miss = thereMiss;
        better = true;
      }
    }
    if (!better) return largest(miss) < 1e-6;
  }
  return largest(miss) < 1e-6;
}

JetRow filled(const JetConstants& k, double x_m, double shapeU, double widthU_m, double shapeZ) {
  return {x_m,
          shapeU,
          widthU_m,
          shapeZ,
          widthRatioOf(shapeU) * widthU_m,
          k.radius_m * coreOf(shapeU),
          k.radius_m * coreOf(shapeZ),
          k.ambientSpeed_m_s + k.excessSpeed_m_s * amplitudeOf(shapeU),
          amplitudeOf(shapeZ)};
}

void need(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(std::string("free jet: ") + what);
}

}  // namespace

double meanSpecificHeat_J_kgK(const GasFractions& gas, double first_K, double second_K) {
  const double share[5] = {1.0 - gas.co2 - gas.h2o - gas.co - gas.oxygen, gas.oxygen, gas.co2, gas.h2o, gas.co};
  // Equally warm: the slope over 1 K.
  const double low = std::clamp(std::min(first_K, second_K), 200.0, 2999.0), high = std::clamp(std::max(first_K, second_K), low + 1.0, 3000.0);
  double sum = 0.0;
  for (size_t i = 0; i < 5; ++i) sum += share[i] * (enthalpy_J_mol(kEnthalpy[i], high) - enthalpy_J_mol(kEnthalpy[i], low));
  return sum / (high - low) / molarMass_kg_mol(gas);
}

double molarMass_kg_mol(const GasFractions& gas) {
  return gas.co2 * kCo2 + gas.h2o * kH2o + gas.co * kCo + gas.oxygen * kO2 + (1.0 - gas.co2 - gas.h2o - gas.co - gas.oxygen) * kN2;
}

JetState jetState(const JetConstants& k, const JetRow& row, double r_m) {
  auto profile = [&](double shape, double width_m) {
    const double beyond_m = r_m - k.radius_m * coreOf(shape);
    if (beyond_m <= 0.0) return amplitudeOf(shape);
    return width_m > 0.0 ? amplitudeOf(shape) * std::exp(-(beyond_m / width_m) * (beyond_m / width_m)) : 0.0;
  };
  const Point p = pointOf(k, profile(row.shapeU, row.widthU_m), profile(row.shapeZ, row.widthZ_m));
  const double perMole = k.pressure_Pa / (k.moles_mol_kg + k.molesExcess_mol_kg * p.z);
  return {p.temperature,
          p.u,
          p.z,
          p.density,
          perMole * (k.co2_mol_kg + k.co2Excess_mol_kg * p.z),
          perMole * (k.h2o_mol_kg + k.h2oExcess_mol_kg * p.z),
          perMole * k.coExcess_mol_kg * p.z,
          p.density * k.soot_m3_kg * p.z,
          p.density * k.alumina * p.z};
}

FreeJet::FreeJet(const NozzleFlow& nozzle, const CoFlow& around) {
  prepare(nozzle, around);
  march(0.0);
}

FreeJet::FreeJet(const NozzleFlow& nozzle, const CoFlow& around, double length_m) {
  need(std::isfinite(length_m) && length_m > 0.0, "its length must be above 0");
  prepare(nozzle, around);
  march(length_m);
}

void FreeJet::prepare(const NozzleFlow& nozzle, const CoFlow& around) {
  auto above = [](double v) { return std::isfinite(v) && v > 0.0; };
  auto share = [](double v) { return v >= 0.0 && v <= 1.0; };
  need(above(nozzle.diameter_m), "the nozzle's diameter must be above 0");
  need(std::isfinite(nozzle.temperature_K) && nozzle.temperature_K >= 10.0 && std::isfinite(around.temperature_K) && around.temperature_K >= 10.0,
       "temperatures must be at least 10 K");
  need(above(nozzle.speed_m_s), "nothing leaves the nozzle: its speed must be above 0");
  need(above(around.pressure_Pa), "the pressure must be above 0");
  need(std::isfinite(around.speed_m_s) && around.speed_m_s >= 0.0,
       "the speed of the flow around must not be below 0: these profiles know no flow against the jet");
  need(share(nozzle.gas.co2) && share(nozzle.gas.h2o) && share(nozzle.gas.co) && share(nozzle.gas.oxygen), "mole fractions lie between 0 and 1");
  need(nozzle.gas.co2 + nozzle.gas.h2o + nozzle.gas.co + nozzle.gas.oxygen <= 1.0 + 1e-9, "mole fractions at the nozzle add up to more than 1");
  need(share(around.co2) && share(around.h2o) && around.co2 + around.h2o < 1.0, "mole fractions of the air lie between 0 and 1");
  need(share(nozzle.sootMassFraction) && share(nozzle.aluminaMassFraction) && nozzle.sootMassFraction + nozzle.aluminaMassFraction < 0.99,
       "soot and alumina leave no gas");
  need(nozzle.gasMolarMass_kg_mol == 0.0 || above(nozzle.gasMolarMass_kg_mol), "the molar mass must be above 0");
  need(nozzle.specificHeat_J_kgK == 0.0 || above(nozzle.specificHeat_J_kgK), "the specific heat must be above 0");

  JetConstants& k = constants_;
  const double temperature_K = nozzle.temperature_K, air_K = around.temperature_K, flight_m_s = around.speed_m_s;
  const double speed_m_s = std::max(nozzle.speed_m_s, (1.0 + kLeastExcess) * flight_m_s);
  raised_ = speed_m_s > nozzle.speed_m_s;
  k.radius_m = 0.5 * nozzle.diameter_m * std::sqrt(nozzle.speed_m_s / speed_m_s);
  k.ambientSpeed_m_s = flight_m_s;
  k.excessSpeed_m_s = speed_m_s - flight_m_s;
  k.ambientTemperature_K = air_K;
  k.pressure_Pa = around.pressure_Pa;

  const double gasShare = 1.0 - nozzle.sootMassFraction - nozzle.aluminaMassFraction;
  const double nozzleMoles = gasShare / (nozzle.gasMolarMass_kg_mol > 0.0 ? nozzle.gasMolarMass_kg_mol : molarMass_kg_mol(nozzle.gas));
  k.moles_mol_kg = 1.0 / (kDryAir + around.h2o * (kH2o - kDryAir) + (around.co2 - 420e-6) * (kCo2 - kDryAir));
  k.molesExcess_mol_kg = nozzleMoles - k.moles_mol_kg;
  k.co2_mol_kg = around.co2 * k.moles_mol_kg;
  k.h2o_mol_kg = around.h2o * k.moles_mol_kg;
  k.co2Excess_mol_kg = nozzle.gas.co2 * nozzleMoles - k.co2_mol_kg;
  k.h2oExcess_mol_kg = nozzle.gas.h2o * nozzleMoles - k.h2o_mol_kg;
  k.coExcess_mol_kg = nozzle.gas.co * nozzleMoles;
  k.soot_m3_kg = nozzle.sootMassFraction / kSootDensity_kg_m3;
  k.alumina = nozzle.aluminaMassFraction;

  // A constant specific heat for each of the two: the nozzle's over the whole way from air to exit, so that its enthalpy is right; air's over the half of
  // it, up to which most of it is warmed.
  const GasFractions air{around.co2, around.h2o, 0.0, 0.2095 * (1.0 - around.h2o)};
  k.cp_J_kgK = meanSpecificHeat_J_kgK(air, air_K, 0.5 * (air_K + temperature_K));
  const double nozzleCp = nozzle.specificHeat_J_kgK > 0.0 ? nozzle.specificHeat_J_kgK : meanSpecificHeat_J_kgK(nozzle.gas, air_K, temperature_K);
  k.cpExcess_J_kgK = nozzleCp - k.cp_J_kgK;
  k.excessEnthalpy_J_kg = nozzleCp * temperature_K + 0.5 * speed_m_s * speed_m_s - k.cp_J_kgK * air_K - 0.5 * flight_m_s * flight_m_s;

  const Point leaving = pointOf(k, 1.0, 1.0), still = pointOf(k, 0.0, 0.0);
  massFlow_kg_s_ = kPi * k.radius_m * k.radius_m * leaving.density * speed_m_s;
  momentum_N_ = massFlow_kg_s_ * k.excessSpeed_m_s;
  ambientDensity_kg_m3_ = still.density;
  nozzleTemperature_K_ = temperature_K;
}

void FreeJet::march(double length_m) {
  JetConstants& k = constants_;
  const bool asFarAsItMatters = !(length_m > 0.0);
  const double longest_m = asFarAsItMatters ? kLongest * 2.0 * k.radius_m : length_m;
  k.rowScale_m = kFirstRows * 2.0 * k.radius_m;
  k.rowLogRatio = k.farLogRatio = std::log(kRowRatio);
  const double scale = 2.0 * kPi * k.radius_m * k.radius_m;
  const double rate = kEntrainment * 0.5 * std::sqrt(kPi) * std::sqrt(ambientDensity_kg_m3_ * momentum_N_);
  auto entrainment = [&](double mass) {
    const double co = k.ambientSpeed_m_s * mass / momentum_N_;
    const double start = std::min(1.0, std::sqrt(25.0 + 36.0 * std::max(0.0, mass / massFlow_kg_s_ - 1.0) / kEntrainment) / 18.0);
    return rate * 2.0 * std::sqrt(1.0 + co) / (2.0 + co) * start;
  };
  // Runge and Kutta's fourth order over a tenth of a distance or less: its error is far below that of the law.
  auto advance = [&](double mass, double dx) {
    constexpr int kSteps = 4;
    const double h = dx / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double a = entrainment(mass), b = entrainment(mass + 0.5 * h * a), c = entrainment(mass + 0.5 * h * b), d = entrainment(mass + h * c);
      mass += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    return mass;
  };

  // The nozzle's own layer: both profiles are one there, so that momentum alone gives the core.
  Unknowns now{std::log(kLip), 1.0, 1.0};
  Integrals own = integrate(k, kLip, now[1], now[2]);
  for (int round = 0; round < 40 && std::abs(own.value[0] * scale / momentum_N_ - 1.0) > 1e-13; ++round) {
    now[1] -= (own.value[0] - momentum_N_ / scale) / (own.slope[0][1] + own.slope[0][2]);
    now[2] = now[1];
    own = integrate(k, kLip, now[1], now[2]);
  }
  const double layer = own.value[2] * scale - massFlow_kg_s_;
  double mass = massFlow_kg_s_, x = 0.0, lastX = 0.0;  // mass: without that layer's
  Unknowns last = now;
  // To a distance, in one step or, where Newton's method loses its way, in two.
  auto step = [&](auto&& self, double to, int depth) -> void {
    const double there = advance(mass, to - x);
    Unknowns guess = now;
    if (x > lastX) {
      const double part = (to - x) / (x - lastX);
      const double w = std::exp(now[0]), lastW = std::exp(last[0]);
      guess = {std::log(std::max(0.5 * w, w + part * (w - lastW))), now[1] + part * (now[1] - last[1]), now[2] + part * (now[2] - last[2])};
    }
    Unknowns found = guess;
    if (!solve(k, {momentum_N_ / scale, massFlow_kg_s_ / scale, (there + layer) / scale}, found)) {
      if (depth >= 8) throw std::runtime_error("free jet: no such profiles carry its fluxes at x = " + std::to_string(to) + " m");
      const double half = x + 0.5 * (to - x);
      self(self, half, depth + 1);
      self(self, to, depth + 1);
      return;
    }
    last = now;
    lastX = x;
    now = found;
    x = to;
    mass = there;
  };
  // The core's end, where the profiles' course has a kink, gets a row of its own. Both cores end there, and the mixture is the excess speed up to there,
  // so that momentum alone gives the width, that the mass, and that the distance from the last row.
  auto coreEnd = [&](double fromMass, double fromX, double logWidth) {
    Integrals sum;
    for (int round = 0; round < 40; ++round) {
      sum = integrate(k, std::exp(logWidth), 0.0, 0.0);
      const double miss = sum.value[0] * scale / momentum_N_ - 1.0;
      if (std::abs(miss) < 1e-12) break;
      logWidth -= std::clamp(miss * momentum_N_ / (scale * sum.slope[0][0]), -0.5, 0.5);
    }
    constexpr int kSteps = 8;  // Simpson's rule for dx = dM/(dM/dx)
    const double h = (sum.value[2] * scale - layer - fromMass) / kSteps;
    double distance = 0.0;
    for (int i = 0; i < kSteps; ++i)
      distance += h / 6.0 * (1.0 / entrainment(fromMass + i * h) + 4.0 / entrainment(fromMass + (i + 0.5) * h) + 1.0 / entrainment(fromMass + (i + 1) * h));
    now = {logWidth, 0.0, 0.0};
    last = now;
    lastX = x = fromX + distance;
    mass = sum.value[2] * scale - layer;
  };
  auto keep = [&] { rows_.push_back(filled(k, x, now[1], k.radius_m * std::exp(now[0]), now[2])); };

  rows_.clear();
  rows_.reserve(160);
  keep();
  bool core = true;
  while (core && x < longest_m) {
    double to = k.rowScale_m * std::expm1(static_cast<double>(rows_.size()) * k.rowLogRatio);
    if (to > longest_m * (1.0 - 1e-3)) to = longest_m;  // no sliver of a row
    const Unknowns before = now;
    const double beforeMass = mass, beforeX = x;
    step(step, to, 0);
    if (now[1] < 0.0) {
      core = false;
      coreEnd(beforeMass, beforeX, before[0]);
    }
    keep();
  }
  k.coreRow = static_cast<int>(rows_.size()) - 1;
  k.coreLength_m = rows_.back().x_m;
  if (!core && k.coreLength_m < longest_m) {
    const double logs = std::log(longest_m / k.coreLength_m);
    const int count = std::max(1, static_cast<int>(std::ceil(logs / k.farLogRatio)));
    k.farLogRatio = logs / count;
    for (int i = 1; i <= count && !(asFarAsItMatters && rows_.back().mixture < kFaint); ++i) {
      step(step, i == count ? longest_m : k.coreLength_m * std::exp(i * k.farLogRatio), 0);
      keep();
    }
  }
  k.length_m = rows_.back().x_m;
  k.rowCount = static_cast<int>(rows_.size());
}

JetRow FreeJet::at(double x_m) const {
  const JetConstants& k = constants_;
  const double x = std::clamp(x_m, 0.0, k.length_m);
  const double place = x < k.coreLength_m ? std::log1p(x / k.rowScale_m) / k.rowLogRatio : k.coreRow + std::log(x / k.coreLength_m) / k.farLogRatio;
  size_t i = std::min(static_cast<size_t>(std::max(0.0, place)), rows_.size() - 2);
  while (i > 0 && x < rows_[i].x_m) --i;  // rounding, and the short row before the core's end
  while (i + 2 < rows_.size() && x > rows_[i + 1].x_m) ++i;
  const JetRow &a = rows_[i], &b = rows_[i + 1];
  const double part = (x - a.x_m) / (b.x_m - a.x_m);
  auto mix = [part](double from, double to) { return from + part * (to - from); };
  return filled(k, x, mix(a.shapeU, b.shapeU), mix(a.widthU_m, b.widthU_m), mix(a.shapeZ, b.shapeZ));
}

JetState FreeJet::stateAt(double x_m, double r_m) const {
  if (x_m >= 0.0 && x_m <= constants_.length_m) return jetState(constants_, at(x_m), std::abs(r_m));
  const double far_m = 1e3 * (rows_.back().widthZ_m + constants_.radius_m);  // both profiles are 0 there
  return jetState(constants_, rows_.back(), far_m);
}

double FreeJet::mixtureRadius_m(double x_m, double mixture) const {
  const JetRow row = at(x_m);
  if (!(mixture > 0.0) || mixture > row.mixture) return 0.0;
  return row.coreZ_m + row.widthZ_m * std::sqrt(std::log(row.mixture / mixture));
}

double FreeJet::reach_m(double x_m, double part) const {
  const double excess_K = std::abs(nozzleTemperature_K_ - constants_.ambientTemperature_K);
  if (excess_K < 1.0) return mixtureRadius_m(x_m, part);
  const JetRow row = at(x_m);
  const double least_K = part * excess_K;
  auto warm = [&](double r_m) { return std::abs(jetState(constants_, row, r_m).temperature_K - constants_.ambientTemperature_K) >= least_K; };
  // Inwards from where the excess enthalpy of even a supersonic jet is faint, then between two steps.
  constexpr int kSteps = 96;
  const double outer_m = std::max(row.coreU_m, row.coreZ_m) + 4.0 * row.widthZ_m;
  for (int i = kSteps; i > 0; --i) {
    double low = outer_m * (i - 1) / kSteps, high = outer_m * i / kSteps;
    if (!warm(low)) continue;
    for (int round = 0; round < 30; ++round) {
      const double middle = 0.5 * (low + high);
      if (warm(middle)) low = middle;
      else high = middle;
    }
    return low;
  }
  return 0.0;
}

JetFluxes FreeJet::fluxes(double x_m) const {
  const JetRow row = at(x_m);
  const Integrals sum = integrate(constants_, row.widthU_m / constants_.radius_m, row.shapeU, row.shapeZ);
  const double scale = 2.0 * kPi * constants_.radius_m * constants_.radius_m;
  return {scale * sum.value[0], scale * sum.value[1] * constants_.excessEnthalpy_J_kg, scale * sum.value[1], scale * sum.value[2]};
}

ExpandedFlow expandedNozzle(const Chamber& chamber, double ambientPressure_Pa) {
  need(chamber.temperature_K > 0.0 && chamber.molarMass_kg_mol > 0.0 && ambientPressure_Pa > 0.0, "the chamber's figures must be above 0");
  need(chamber.gamma > 1.0, "gamma must be above 1");
  need(chamber.pressure_Pa > ambientPressure_Pa, "the chamber's pressure must be above that of the air");
  const double exponent = (chamber.gamma - 1.0) / chamber.gamma;
  const double ratio = std::pow(ambientPressure_Pa / chamber.pressure_Pa, exponent);
  const double temperature_K = chamber.temperature_K * ratio;
  return {temperature_K, std::sqrt(2.0 / exponent * kGasConstant * chamber.temperature_K / chamber.molarMass_kg_mol * (1.0 - ratio)),
          ambientPressure_Pa * chamber.molarMass_kg_mol / (kGasConstant * temperature_K)};
}

}  // namespace pitviper
