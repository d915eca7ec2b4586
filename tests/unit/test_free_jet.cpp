// The free jet: fluxes along it, entrainment, decay and spread against published figures, limits, and the presets of engines.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "materials/fields/engine_presets.hpp"
#include "materials/fields/free_jet.hpp"

namespace pitviper::test {
namespace {

constexpr double kGas = 8.314462618, kPiHere = std::numbers::pi;

NozzleFlow airJet(double speed_m_s = 100.0) {
  NozzleFlow flow;
  flow.diameter_m = 1.0;
  flow.temperature_K = 288.15;
  flow.speed_m_s = speed_m_s;
  flow.gas.oxygen = 0.2095;
  flow.gas.co2 = 420e-6;
  // as dense and as warm as the air of CoFlow, argon included
  flow.gasMolarMass_kg_mol = 0.0289647;
  return flow;
}

NozzleFlow preset(const char* name, const CoFlow& around, double throttle = 1.0) { return *nozzleOf(*findEnginePreset(name), throttle, around); }

double molarMass(const NozzleFlow& n) { return n.gasMolarMass_kg_mol > 0.0 ? n.gasMolarMass_kg_mol : molarMass_kg_mol(n.gas); }
double gasShare(const NozzleFlow& n) { return 1.0 - n.sootMassFraction - n.aluminaMassFraction; }
double nozzleDensity(const NozzleFlow& n, const CoFlow& c) { return c.pressure_Pa * molarMass(n) / (gasShare(n) * kGas * n.temperature_K); }
double airMolarMass(const CoFlow& c) { return 0.0289647 + c.h2o * (0.0180153 - 0.0289647) + (c.co2 - 420e-6) * (0.0440095 - 0.0289647); }
double airDensity(const CoFlow& c) { return c.pressure_Pa * airMolarMass(c) / (kGas * c.temperature_K); }
double nozzleMass(const NozzleFlow& n, const CoFlow& c) { return 0.25 * kPiHere * n.diameter_m * n.diameter_m * nozzleDensity(n, c) * n.speed_m_s; }

// Integrals over the radius of what stateAt() says, by the trapezoidal rule: 3000 steps to where the wider Gaussian is exp(-25). Its error, from the kinks
// of the second derivative at the cores' borders, is of order (1/3000)^2.
struct Integrated {
  double momentum = 0.0, enthalpy = 0.0, mixture = 0.0, mass = 0.0, co2 = 0.0, alumina = 0.0, soot = 0.0;
};
Integrated integrated(const FreeJet& jet, const CoFlow& c, double x_m) {
  const JetConstants& k = jet.constants();
  const JetRow row = jet.at(x_m);
  const double outer_m = std::max(row.coreU_m, row.coreZ_m) + 5.0 * row.widthZ_m;
  constexpr int kSteps = 3000;
  Integrated sum;
  for (int i = 0; i <= kSteps; ++i) {
    const double r = outer_m * i / kSteps, weight = (i == kSteps ? 0.5 : 1.0) * 2.0 * kPiHere * r * outer_m / kSteps;
    const JetState s = jet.stateAt(x_m, r);
    const double cp = k.cp_J_kgK + k.cpExcess_J_kgK * s.mixture, flow = weight * s.density_kg_m3 * s.speed_m_s;
    const double total = cp * s.temperature_K + 0.5 * s.speed_m_s * s.speed_m_s, totalAir = k.cp_J_kgK * c.temperature_K + 0.5 * c.speed_m_s * c.speed_m_s;
    sum.momentum += flow * (s.speed_m_s - c.speed_m_s);
    sum.enthalpy += flow * (total - totalAir);
    sum.mixture += flow * s.mixture;
    sum.mass += flow;
    const double co2Air = c.co2 * 0.0440095 / airMolarMass(c);
    sum.co2 += weight * s.speed_m_s * (s.co2_Pa * 0.0440095 / (kGas * s.temperature_K) - s.density_kg_m3 * co2Air);
    sum.alumina += weight * s.speed_m_s * s.alumina_kg_m3;
    sum.soot += weight * s.speed_m_s * s.sootVolumeFraction * 1800.0;
  }
  return sum;
}

struct Case {
  std::string name;
  NozzleFlow nozzle;
  CoFlow around;
};
std::vector<Case> cases() {
  std::vector<Case> list;
  const CoFlow still, low{101325.0, 288.15, 200.0, 420e-6, 0.01}, high{26500.0, 223.25, 255.0, 420e-6, 0.0}, fast{26500.0, 223.25, 600.0, 420e-6, 0.0};
  list.push_back({"air in still air", airJet(), still});
  for (const char* name : {"turbofan_military", "turbofan_afterburner", "aluminised_motor", "double_base_motor"}) {
    list.push_back({std::string(name) + " in still air", preset(name, still), still});
    list.push_back({std::string(name) + " at 200 m/s", preset(name, low), low});
    list.push_back({std::string(name) + " at 10 km, 255 m/s", preset(name, high), high});
    list.push_back({std::string(name) + " at 10 km, 600 m/s", preset(name, fast), fast});
  }
  list.push_back({"turboshaft at 60 m/s", preset("turboshaft", still), {101325.0, 288.15, 60.0, 420e-6, 0.0}});
  NozzleFlow cold = airJet(300.0);
  cold.temperature_K = 120.0;
  list.push_back({"cold air in still air", cold, still});
  return list;
}

TEST(FreeJet, FluxesStayConstantAlongHundredDiameters) {
  double worstRow = 0.0, worstBetween = 0.0;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const FreeJet jet(c.nozzle, c.around, 100.0 * c.nozzle.diameter_m);
    ASSERT_FALSE(jet.isRaised());
    const double mass = nozzleMass(c.nozzle, c.around), u0 = c.nozzle.speed_m_s, u = c.around.speed_m_s;
    const JetConstants& k = jet.constants();
    const double nozzleCp = k.cp_J_kgK + k.cpExcess_J_kgK;
    const double excess = nozzleCp * c.nozzle.temperature_K + 0.5 * u0 * u0 - k.cp_J_kgK * c.around.temperature_K - 0.5 * u * u;
    const double co2 = c.nozzle.gas.co2 * 0.0440095 / molarMass(c.nozzle) * gasShare(c.nozzle) - c.around.co2 * 0.0440095 / airMolarMass(c.around);
    auto check = [&](double x_m, double tolerance, double& worst) {
      const Integrated got = integrated(jet, c.around, x_m);
      SCOPED_TRACE("x/d = " + std::to_string(x_m / c.nozzle.diameter_m));
      EXPECT_NEAR(got.momentum / (mass * (u0 - u)), 1.0, tolerance);
      EXPECT_NEAR(got.enthalpy / (mass * excess), 1.0, tolerance);
      EXPECT_NEAR(got.mixture / mass, 1.0, tolerance);
      if (c.nozzle.gas.co2 > 0.01) {
        EXPECT_NEAR(got.co2 / (mass * co2), 1.0, tolerance);
      }
      if (c.nozzle.aluminaMassFraction > 0.0) {
        EXPECT_NEAR(got.alumina / (mass * c.nozzle.aluminaMassFraction), 1.0, tolerance);
      }
      if (c.nozzle.sootMassFraction > 0.0) {
        EXPECT_NEAR(got.soot / (mass * c.nozzle.sootMassFraction), 1.0, tolerance);
      }
      worst = std::max(
          {worst, std::abs(got.momentum / (mass * (u0 - u)) - 1.0), std::abs(got.enthalpy / (mass * excess) - 1.0), std::abs(got.mixture / mass - 1.0)});
    };
    // At the rows: the aim. Between them straight lines over 8 % of a distance miss what bends like 1/x by (ln 1.08)^2/8 = 7e-4, a flux by up to twice that;
    // 1 % is asked for.
    for (const JetRow& row : jet.rows())
      if (row.x_m > 0.0) check(row.x_m, 1e-4, worstRow);
    for (int i = 1; i < 150; ++i) check(100.0 * c.nozzle.diameter_m * std::pow(i / 150.0, 2.0), 2e-3, worstBetween);
  }
  std::cout << "fluxes along 100 diameters: off by at most " << worstRow << " at rows, " << worstBetween << " between\n";
}

TEST(FreeJet, EntrainsAsRicouAndSpaldingMeasured) {
  for (const Case& c : cases()) {
    if (c.around.speed_m_s > 0.0 || c.nozzle.temperature_K < 200.0) continue;  // a dense jet's 20 diameters are 13 of those its start is counted in
    SCOPED_TRACE(c.name);
    const double d = c.nozzle.diameter_m;
    const FreeJet jet(c.nozzle, c.around, 100.0 * d);
    const double ratio = std::sqrt(airDensity(c.around) / nozzleDensity(c.nozzle, c.around));
    double worst = 0.0;
    for (double x = 20.0; x <= 100.0; x += 1.0) {
      const double published = 0.32 * x * ratio, got = integrated(jet, c.around, x * d).mass / nozzleMass(c.nozzle, c.around);
      EXPECT_NEAR(got / published, 1.0, 0.10) << "x/d = " << x;  // asked for
      worst = std::max(worst, std::abs(got / published - 1.0));
    }
    std::cout << c.name << ": entrained mass within " << 100.0 * worst << " % of 0.32 x/d sqrt(ratio), 20 to 100 diameters\n";
  }
}

// The start of entrainment: Hill (1972): a third of the full rate one diameter behind the nozzle, all of it from 13 on.
TEST(FreeJet, EntrainmentRisesAsHillMeasured) {
  const FreeJet jet(airJet(), {}, 40.0);
  auto rate = [&](double x) { return (jet.fluxes(x + 0.05).mass_kg_s - jet.fluxes(x - 0.05).mass_kg_s) / 0.1 / jet.fluxes(0.0).mixture_kg_s; };
  // 3 %: mass over a difference of a tenth of a diameter between rows 1e-4 true
  EXPECT_NEAR(rate(1.0) / 0.32, 1.0 / 3.0, 0.03);
  EXPECT_NEAR(rate(7.0) / 0.32, 2.0 / 3.0, 0.03);
  EXPECT_NEAR(rate(20.0) / 0.32, 1.0, 0.03);
}

TEST(FreeJet, DecaysAndSpreadsAsMeasuredWhereIsothermal) {
  const FreeJet jet(airJet(), {}, 100.0);
  auto inverse = [&](double x) { return 100.0 / jet.at(x).speed_m_s; };
  const double decay = 60.0 / (inverse(90.0) - inverse(30.0)), origin = 30.0 - decay * inverse(30.0);
  // Pope, Turbulent Flows, table 5.1: B = 6.06 (Panchapakesan and Lumley), 5.9 and 5.8 (Hussein, Capp and George, hot wires and laser; x0 = 4 d). A Gaussian
  // that carries Ricou and Spalding's mass has 2/0.32 = 6.25 exactly; 3 % above the first.
  EXPECT_NEAR(decay, 6.25, 0.02);
  EXPECT_GT(decay, 5.8 * 0.97);
  EXPECT_LT(decay, 6.06 * 1.035);
  EXPECT_GT(origin, 0.0);
  EXPECT_LT(origin, 4.0);
  // Half width: S = 0.096, 0.102, 0.094 in the same table; a Gaussian's is sqrt(ln 2) w.
  const double spread = std::sqrt(std::log(2.0)) * (jet.at(90.0).widthU_m - jet.at(30.0).widthU_m) / 60.0;
  EXPECT_GT(spread, 0.093);
  EXPECT_LT(spread, 0.103);
  // Mixture on the axis: 5.4 d/x (Becker, Hottel and Williams, J. Fluid Mech. 30 (1967) 285), 5.1 (Dowling and Dimotakis, J. Fluid Mech. 218 (1990) 109).
  const double mixing = 60.0 / (1.0 / jet.at(90.0).mixture - 1.0 / jet.at(30.0).mixture);
  EXPECT_GT(mixing, 5.1 * 0.97);
  EXPECT_LT(mixing, 5.4 * 1.03);
  // Widths far away: 1/sqrt(0.7) but for what is left of (1 - A_u).
  EXPECT_NEAR(jet.at(100.0).widthZ_m / jet.at(100.0).widthU_m, 1.0 / std::sqrt(0.7), 0.02);
  // Core: 4 to 7 diameters.
  const double core = jet.constants().coreLength_m;
  EXPECT_GT(core, 4.0);
  EXPECT_LT(core, 7.0);
  std::cout << "isothermal: B " << decay << ", origin " << origin << " d, spread " << spread << ", mixture " << mixing << " d/x, core " << core << " d\n";
}

// A uniform Gaussian jet has no freedom left: M/m0 = 2 u0/uc, J = rho pi w^2 uc^2/2. The core ends where M = 2 m0. At the nozzle: a core c and a layer of width
// w = 0.2 R have J = m0 u0: c^2 + c w sqrt(pi/2) + w^2/2 = R^2, and the mass c^2 + c w sqrt(pi) + w^2.
TEST(FreeJet, MeetsClosedFormsWhereIsothermal) {
  NozzleFlow slow = airJet(1.0);  // no warmth from friction
  const FreeJet jet(slow, {}, 100.0);
  const double w = 0.2, slope = w * std::sqrt(0.5 * kPiHere), core = 0.5 * (std::sqrt(slope * slope + 4.0 - 2.0 * w * w) - slope);
  const double layer = core * core + core * w * std::sqrt(kPiHere) + w * w - 1.0;
  EXPECT_NEAR(jet.at(0.0).coreU_m, 0.5 * core, 1e-4);
  EXPECT_NEAR(jet.fluxes(0.0).mass_kg_s / jet.fluxes(0.0).mixture_kg_s, 1.0 + layer, 1e-3);
  for (const JetRow& row : jet.rows()) {
    if (row.coreU_m > 0.0 || row.x_m < 6.0) continue;
    const double mass =
        layer + (row.x_m < 13.0 ? 1.0 + 0.32 * (5.0 * row.x_m / 18.0 + row.x_m * row.x_m / 36.0) : 1.0 + 0.32 * (13.0 * 23.0 / 36.0 + row.x_m - 13.0));
    // 1e-3: air at the nozzle is air without argon in its specific heat only; the kinetic 0.5 J/kg is 2e-6 of its enthalpy
    EXPECT_NEAR(row.speed_m_s * mass / 2.0, 1.0, 1e-3) << row.x_m;
    EXPECT_NEAR(row.widthU_m * row.speed_m_s * std::sqrt(2.0), 1.0, 1e-3) << row.x_m;
  }
  EXPECT_NEAR(jet.constants().coreLength_m, -5.0 + std::sqrt(25.0 + 36.0 * (1.0 - layer) / 0.32), 5e-3);
}

TEST(FreeJet, MixtureIsExcessSpeedAlongTheCore) {
  const CoFlow around{26500.0, 223.25, 300.0, 420e-6, 0.0};
  const FreeJet jet(preset("turbofan_afterburner", around), around, 10.0);
  int met = 0;
  for (const JetRow& row : jet.rows()) {
    if (row.coreU_m <= 0.0) continue;
    EXPECT_NEAR(row.shapeU, row.shapeZ, 1e-6) << row.x_m;  // Newton's 1e-9 of a flux, over the least share that a profile has of it
    ++met;
  }
  EXPECT_GT(met, 20);
}

TEST(FreeJet, IsTheNozzleAtTheNozzle) {
  const CoFlow around{101325.0, 288.15, 100.0, 420e-6, 0.01};
  const NozzleFlow nozzle = preset("turbofan_afterburner", around);
  const FreeJet jet(nozzle, around, 100.0 * nozzle.diameter_m);
  EXPECT_NEAR(jet.at(0.0).widthU_m, 0.1 * nozzle.diameter_m, 1e-9);
  for (double x : {0.0, 1e-6, 1e-3}) {
    const JetRow row = jet.at(x * nozzle.diameter_m);  // its core, and where the layer has fallen to exp(-25)
    EXPECT_GT(row.coreU_m, 0.4 * nozzle.diameter_m);
    const JetState in = jet.stateAt(row.x_m, 0.999 * std::min(row.coreU_m, row.coreZ_m)), out = jet.stateAt(row.x_m, row.coreZ_m + 5.0 * row.widthZ_m);
    EXPECT_NEAR(in.temperature_K / nozzle.temperature_K, 1.0, 1e-9);
    EXPECT_NEAR(in.speed_m_s / nozzle.speed_m_s, 1.0, 1e-9);
    EXPECT_NEAR(in.mixture, 1.0, 1e-9);
    EXPECT_NEAR(in.density_kg_m3 / nozzleDensity(nozzle, around), 1.0, 1e-9);
    EXPECT_NEAR(in.co2_Pa / (nozzle.gas.co2 * around.pressure_Pa), 1.0, 1e-9);
    EXPECT_NEAR(in.h2o_Pa / (nozzle.gas.h2o * around.pressure_Pa), 1.0, 1e-9);
    EXPECT_NEAR(in.co_Pa / (nozzle.gas.co * around.pressure_Pa), 1.0, 1e-9);
    EXPECT_NEAR(in.sootVolumeFraction * 1800.0 / (in.density_kg_m3 * nozzle.sootMassFraction), 1.0, 1e-9);
    EXPECT_NEAR(out.temperature_K, around.temperature_K, 1e-6);
    EXPECT_NEAR(out.speed_m_s, around.speed_m_s, 1e-6);
    EXPECT_NEAR(out.h2o_Pa / (around.h2o * around.pressure_Pa), 1.0, 1e-6);
    EXPECT_NEAR(out.density_kg_m3 / airDensity(around), 1.0, 1e-6);
  }
  EXPECT_NEAR(jet.stateAt(-1.0, 0.0).temperature_K, around.temperature_K, 1e-9);
  EXPECT_NEAR(jet.stateAt(101.0 * nozzle.diameter_m, 0.0).mixture, 0.0, 1e-12);
}

// Entrained mass in a flow along the jet: q^3/3 + q, q = sqrt(1 + U M/J), is a straight line in x once mixing has begun. Where the excess is small it is
// that of a wake: width ~ x^(1/3), excess speed ~ x^(-2/3) (Pope, 5.4.4).
TEST(FreeJet, MixesLessInAFlowAlongIt) {
  CoFlow around;
  around.speed_m_s = 300.0;
  const FreeJet jet(airJet(400.0), around, 4000.0), still(airJet(400.0), {}, 100.0);
  const double momentum = jet.fluxes(0.0).excessMomentum_N;
  const double slope = 0.32 * 0.5 * std::sqrt(kPiHere) * std::sqrt(airDensity(around) / momentum) * around.speed_m_s;
  const double layer = jet.fluxes(0.0).mass_kg_s - jet.fluxes(0.0).mixture_kg_s;
  auto course = [&](double x) {
    const double q = std::sqrt(1.0 + around.speed_m_s * (jet.fluxes(x).mass_kg_s - layer) / momentum);
    return q * q * q / 3.0 + q;
  };
  // Mixing has begun where M = 3.66 m0; between rows mass is 1e-3 true, q^3/3 + q too.
  ASSERT_GT(jet.fluxes(200.0).mass_kg_s, 3.66 * jet.fluxes(0.0).mass_kg_s);
  EXPECT_NEAR((course(2000.0) - course(200.0)) / (1800.0 * slope), 1.0, 3e-3);
  EXPECT_LT(jet.fluxes(50.0).mass_kg_s, 0.5 * still.fluxes(50.0).mass_kg_s);
  EXPECT_GT(jet.constants().coreLength_m, still.constants().coreLength_m);
  const JetRow near = jet.at(2000.0), far = jet.at(4000.0);
  // k = U M/J is some 70 there: g differs from its limit by 1/(2 k), the exponent by about as much.
  EXPECT_NEAR(std::log(far.widthU_m / near.widthU_m) / std::log(2.0), 1.0 / 3.0, 0.02);
  EXPECT_NEAR(std::log((far.speed_m_s - 300.0) / (near.speed_m_s - 300.0)) / std::log(2.0), -2.0 / 3.0, 0.04);
}

TEST(FreeJet, TemperatureOnTheAxisFallsOnceAndStaysAboveTheAir) {
  for (const Case& c : cases()) {
    if (c.nozzle.temperature_K < 400.0) continue;
    SCOPED_TRACE(c.name);
    const FreeJet jet(c.nozzle, c.around, 100.0 * c.nozzle.diameter_m);
    double last = c.nozzle.temperature_K, hottest = 0.0;
    bool falls = false;
    for (const JetRow& row : jet.rows()) {
      const double t = jet.stateAt(row.x_m, 0.0).temperature_K;
      EXPECT_GE(t, c.around.temperature_K);
      if (t < last - 1e-6) falls = true;
      EXPECT_FALSE(falls && t > last + 1e-6) << "rises again at " << row.x_m;
      last = t;
      for (int i = 0; i <= 40; ++i) {
        const double here = jet.stateAt(row.x_m, jet.mixtureRadius_m(row.x_m, 1e-4) * i / 40.0).temperature_K;
        EXPECT_GE(here, c.around.temperature_K - 1e-6);
        hottest = std::max(hottest, here);
      }
    }
    // Friction warms a fast jet's shoulder by up to (u0 - U)^2/8 over the specific heat (Crocco's relation, where Z = 1/2).
    const double speed = c.nozzle.speed_m_s - c.around.speed_m_s;
    EXPECT_LT(hottest, c.nozzle.temperature_K + speed * speed / 8.0 / jet.constants().cp_J_kgK);
  }
}

// The formulas beside JetConstants as a shader would write them, in single precision.
struct FloatState {
  float temperature, speed, density, co2, h2o, co, soot, alumina;
};
FloatState asAShader(const FreeJet& jet, float x, float r) {
  const JetConstants& k = jet.constants();
  auto f = [](double v) { return static_cast<float>(v); };
  const float place =
      x < f(k.coreLength_m) ? std::log(1.0f + x / f(k.rowScale_m)) / f(k.rowLogRatio) : f(k.coreRow) + std::log(x / f(k.coreLength_m)) / f(k.farLogRatio);
  int i = std::min(static_cast<int>(place), k.rowCount - 2);
  const auto rows = jet.rows();
  if (f(rows[static_cast<size_t>(i)].x_m) > x) --i;
  if (i + 2 < k.rowCount && f(rows[static_cast<size_t>(i) + 1].x_m) < x) ++i;
  const JetRow &a = rows[static_cast<size_t>(i)], &b = rows[static_cast<size_t>(i) + 1];
  const float part = (x - f(a.x_m)) / (f(b.x_m) - f(a.x_m));
  auto mix = [part](float from, float to) { return from + (to - from) * part; };
  const float shapeU = mix(f(a.shapeU), f(b.shapeU)), widthU = mix(f(a.widthU_m), f(b.widthU_m)), shapeZ = mix(f(a.shapeZ), f(b.shapeZ));
  const float widthZ = widthU * std::sqrt(1.0f + 0.428571f * (1.0f - 1.0f / (1.0f - std::min(shapeU, 0.0f))));
  auto profile = [&](float shape, float width) {
    const float s = std::max(r - f(k.radius_m) * std::max(shape, 0.0f), 0.0f);
    const float shoulder = s > 0.0f ? (width > 0.0f ? std::exp(-(s / width) * (s / width)) : 0.0f) : 1.0f;
    return shoulder / (1.0f - std::min(shape, 0.0f));
  };
  const float u = f(k.ambientSpeed_m_s) + f(k.excessSpeed_m_s) * profile(shapeU, widthU), z = profile(shapeZ, widthZ);
  const float ambient = f(k.ambientTemperature_K), still = f(k.ambientSpeed_m_s);
  const float t =
      ambient + (f(k.excessEnthalpy_J_kg) * z - f(k.cpExcess_J_kgK) * ambient * z - 0.5f * (u * u - still * still)) / (f(k.cp_J_kgK) + f(k.cpExcess_J_kgK) * z);
  const float n = f(k.moles_mol_kg) + f(k.molesExcess_mol_kg) * z, p = f(k.pressure_Pa), density = p / (8.314462618f * t * n);
  return {t,
          u,
          density,
          p * (f(k.co2_mol_kg) + f(k.co2Excess_mol_kg) * z) / n,
          p * (f(k.h2o_mol_kg) + f(k.h2oExcess_mol_kg) * z) / n,
          p * f(k.coExcess_mol_kg) * z / n,
          density * f(k.soot_m3_kg) * z,
          density * f(k.alumina) * z};
}

TEST(FreeJet, ConstantsAndRowsAreAllAShaderNeeds) {
  double worst = 0.0;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const FreeJet jet(c.nozzle, c.around, 100.0 * c.nozzle.diameter_m);
    for (int i = 0; i <= 100; ++i)
      for (int j = 0; j <= 20; ++j) {
        const float x = static_cast<float>(jet.length_m() * std::pow(i / 100.0, 3.0) * 0.9999);
        const float r = static_cast<float>(1.5 * jet.mixtureRadius_m(x, 0.5 * jet.at(x).mixture) * j / 20.0);
        const JetState s = jet.stateAt(x, r);
        const FloatState got = asAShader(jet, x, r);
        // 24 bits, an exponential of up to 5 widths, (r - c)/w with w a fiftieth of r near the nozzle: 1e-4 of each, of the partial pressures of a whole
        EXPECT_NEAR(got.temperature / s.temperature_K, 1.0, 1e-4);
        EXPECT_NEAR(got.speed, s.speed_m_s, 1e-4 * c.nozzle.speed_m_s);
        EXPECT_NEAR(got.density / s.density_kg_m3, 1.0, 1e-4);
        EXPECT_NEAR(got.co2, s.co2_Pa, 1e-4 * c.around.pressure_Pa * std::max(c.nozzle.gas.co2, 1e-3));
        EXPECT_NEAR(got.h2o, s.h2o_Pa, 1e-4 * c.around.pressure_Pa * std::max(c.nozzle.gas.h2o, 1e-3));
        EXPECT_NEAR(got.co, s.co_Pa, 1e-4 * c.around.pressure_Pa * std::max(c.nozzle.gas.co, 1e-3));
        EXPECT_NEAR(got.soot, s.sootVolumeFraction, 1e-4 * (jet.stateAt(0.0, 0.0).sootVolumeFraction + 1e-12));
        EXPECT_NEAR(got.alumina, s.alumina_kg_m3, 1e-4 * (jet.stateAt(0.0, 0.0).alumina_kg_m3 + 1e-9));
        worst = std::max(worst, std::abs(got.temperature / s.temperature_K - 1.0));
      }
  }
  std::cout << "single precision: temperature off by at most " << worst << "\n";
}

TEST(FreeJet, SlowerThanTheAirIsRaisedToAFlowOfTheSameMass) {
  CoFlow around;
  around.speed_m_s = 250.0;
  for (double speed : {50.0, 250.0, 262.0}) {
    NozzleFlow nozzle = airJet(speed);
    nozzle.temperature_K = 700.0;
    const FreeJet jet(nozzle, around, 100.0);
    EXPECT_TRUE(jet.isRaised());
    EXPECT_NEAR(jet.stateAt(0.0, 0.0).speed_m_s, 262.5, 1e-9);
    EXPECT_NEAR(jet.fluxes(0.0).mixture_kg_s / nozzleMass(nozzle, around), 1.0, 1e-9);
    EXPECT_NEAR(integrated(jet, around, 90.0).mixture / nozzleMass(nozzle, around), 1.0, 2e-3);  // as along every jet
  }
  EXPECT_FALSE(FreeJet(airJet(263.0), around, 100.0).isRaised());
}

TEST(FreeJet, AnEqualOrColderOneHasAState) {
  NozzleFlow cold = airJet(20.0);
  cold.temperature_K = 200.0;
  for (const FreeJet& jet : {FreeJet(airJet(20.0), {}, 50.0), FreeJet(cold, {}, 50.0), FreeJet(cold, {101325.0, 288.15, 19.9, 0.0, 0.0}, 50.0)})
    for (double x = 0.0; x < 50.0; x += 0.7)
      for (double r = 0.0; r < 10.0; r += 0.3) {
        const JetState s = jet.stateAt(x, r);
        EXPECT_TRUE(s.temperature_K > 199.0 && s.temperature_K < 289.0) << s.temperature_K;
        EXPECT_TRUE(s.density_kg_m3 > 0.0 && s.mixture >= 0.0 && s.mixture <= 1.0);
      }
}

TEST(FreeJet, ReachIsWhereTheExcessHasFallenToItsPart) {
  const CoFlow around{101325.0, 288.15, 200.0, 420e-6, 0.0};
  const NozzleFlow nozzle = preset("turbofan_afterburner", around);
  const FreeJet jet(nozzle, around, 60.0);
  const double excess = nozzle.temperature_K - around.temperature_K;
  for (double x : {0.5, 2.0, 10.0, 40.0}) {
    const double reach = jet.reach_m(x, 0.05);
    ASSERT_GT(reach, 0.0);
    EXPECT_NEAR(jet.stateAt(x, reach).temperature_K - around.temperature_K, 0.05 * excess, 1e-3 * excess);
    for (double factor : {1.01, 1.2, 2.0}) EXPECT_LT(jet.stateAt(x, factor * reach).temperature_K - around.temperature_K, 0.05 * excess);
    EXPECT_NEAR(jet.stateAt(x, jet.mixtureRadius_m(x, 0.01)).mixture, 0.01, 1e-9);
  }
  EXPECT_EQ(jet.reach_m(60.0, 0.9), 0.0);
  EXPECT_GT(FreeJet(airJet(20.0), {}, 50.0).reach_m(10.0), 0.5);
}

TEST(FreeJet, EndsWhereItNoLongerMatters) {
  const CoFlow around{26500.0, 223.25, 255.0, 420e-6, 0.0};
  const FreeJet jet(preset("turbofan_military", around), around);
  EXPECT_LT(jet.at(jet.length_m()).mixture, 0.01);
  EXPECT_GT(jet.at(0.9 * jet.length_m()).mixture, 0.01);  // rows are 8 % apart
}

TEST(FreeJet, RefusesWhatIsNoJet) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  auto refuses = [](auto change) {
    NozzleFlow nozzle = airJet();
    CoFlow around;
    double length = 10.0;
    change(nozzle, around, length);
    EXPECT_THROW(FreeJet(nozzle, around, length), std::invalid_argument);
  };
  for (double bad : {0.0, -1.0, nan}) {
    refuses([bad](NozzleFlow& n, CoFlow&, double&) { n.diameter_m = bad; });
    refuses([bad](NozzleFlow& n, CoFlow&, double&) { n.temperature_K = bad; });
    refuses([bad](NozzleFlow& n, CoFlow&, double&) { n.speed_m_s = bad; });
    refuses([bad](NozzleFlow&, CoFlow& c, double&) { c.pressure_Pa = bad; });
    refuses([bad](NozzleFlow&, CoFlow& c, double&) { c.temperature_K = bad; });
    refuses([bad](NozzleFlow&, CoFlow&, double& l) { l = bad; });
  }
  refuses([](NozzleFlow&, CoFlow& c, double&) { c.speed_m_s = -1.0; });
  refuses([](NozzleFlow& n, CoFlow&, double&) { n.gas.co2 = 0.9; });
  refuses([](NozzleFlow& n, CoFlow&, double&) { n.gas.h2o = -0.1; });
  refuses([](NozzleFlow& n, CoFlow&, double&) { n.aluminaMassFraction = 1.0; });
  refuses([nan](NozzleFlow& n, CoFlow&, double&) { n.sootMassFraction = nan; });
  refuses([nan](NozzleFlow& n, CoFlow&, double&) { n.specificHeat_J_kgK = nan; });
}

TEST(FreeJet, TimeOfASolution) {
  const CoFlow around{26500.0, 223.25, 255.0, 420e-6, 0.0};
  const NozzleFlow nozzle = preset("turbofan_afterburner", around);
  constexpr int kTimes = 50;
  size_t rows = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kTimes; ++i) rows += FreeJet(nozzle, around, 100.0 * nozzle.diameter_m).rows().size();
  const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / kTimes;
  std::cout << rows / kTimes << " rows in " << ms << " ms\n";
}

// NACA Report 1135, table II: M = 3, gamma 1.4: p/pt = 0.02722, T/Tt = 0.35714.
TEST(ExpandedNozzle, IsIsentropic) {
  const ExpandedFlow flow = expandedNozzle({1000.0, 1e6, 1.4, 0.029}, 0.02722e6);
  EXPECT_NEAR(flow.temperature_K, 357.14, 0.02);  // four digits of the pressure
  EXPECT_NEAR(flow.speed_m_s / std::sqrt(1.4 * kGas / 0.029 * flow.temperature_K), 3.0, 3e-4);
  EXPECT_NEAR(flow.density_kg_m3, 0.02722e6 * 0.029 / (kGas * flow.temperature_K), 1e-9);
  EXPECT_THROW(expandedNozzle({1000.0, 1e5, 1.4, 0.029}, 1e5), std::invalid_argument);
  EXPECT_THROW(expandedNozzle({1000.0, 1e6, 1.0, 0.029}, 1e5), std::invalid_argument);
}

// Air: h(1000 K) - h(298.15 K) = 747.9 kJ/kg (Keenan, Chao and Kaye, Gas Tables). 1 %: argon counts as nitrogen here.
TEST(MeanSpecificHeat, IsThatOfGasTables) {
  const GasFractions air{420e-6, 0.0, 0.0, 0.2095};
  EXPECT_NEAR(meanSpecificHeat_J_kgK(air, 298.15, 1000.0), 747.9e3 / 701.85, 0.01 * 1065.0);
  EXPECT_NEAR(meanSpecificHeat_J_kgK(air, 288.15, 288.15), 1005.0, 0.01 * 1005.0);
  // Steam at 1000 K: 41.27 J/(mol K) (JANAF); of the piece from 700 to 1000 K: its mean, 39.36
  EXPECT_NEAR(meanSpecificHeat_J_kgK({0.0, 1.0, 0.0, 0.0}, 700.0, 1000.0) * 0.0180153, 39.36, 0.01);
}

TEST(EnginePresets, GiveBackWhatTheirMakersPublish) {
  const CoFlow bed;
  for (const EnginePreset& p : enginePresets()) {
    SCOPED_TRACE(p.name);
    EXPECT_FALSE(p.source.empty());
    const NozzleFlow n = *nozzleOf(p, 1.0, bed);
    const double mass = nozzleMass(n, bed);
    if (p.thrust_N > 0.0) {
      EXPECT_NEAR(mass * n.speed_m_s / p.thrust_N, 1.0, 2e-3);  // mean molar masses agree to 1e-3
    }
    if (!p.breathesAir()) continue;
    EXPECT_NEAR(mass / (p.airFlow_kg_s + p.fuelFlow_kg_s), 1.0, 2e-3);
    // Carbon of the fuel leaves in CO2 and CO; that of the air with it.
    const double carbon = mass * gasShare(n) / molarMass(n) * (n.gas.co2 + n.gas.co);
    const double fuel = p.fuelFlow_kg_s / (0.0120107 + 1.917 * 0.00100794), air = p.airFlow_kg_s * 420e-6 / 0.02885;
    EXPECT_NEAR(carbon / (fuel + air), 1.0, 2e-3);
    EXPECT_NEAR((n.gas.h2o * 2.0) / ((n.gas.co2 + n.gas.co) * fuel / (fuel + air) * 1.917), 1.0, 2e-3);
    EXPECT_GT(n.gas.oxygen, 0.0);  // all are lean
  }
  // Exhaust gas temperatures as published: J85 at military power 950 K (its limit near 680 C), T700 near 830 K; the mean of ours within 5 %.
  const NozzleFlow jet = preset("small_turbojet", bed), shaft = preset("turboshaft", bed);
  auto total = [](const NozzleFlow& n) { return n.temperature_K + 0.5 * n.speed_m_s * n.speed_m_s / meanSpecificHeat_J_kgK(n.gas, n.temperature_K, 1000.0); };
  EXPECT_NEAR(total(jet), 950.0, 0.05 * 950.0);
  EXPECT_NEAR(total(shaft), 830.0, 0.05 * 830.0);
  // Without its afterburner an engine is the one without.
  const NozzleFlow dry = preset("turbofan_military", bed), unlit = preset("turbofan_afterburner", bed, 0.0);
  EXPECT_NEAR(unlit.temperature_K / dry.temperature_K, 1.0, 0.03);  // parts of two digits
  EXPECT_NEAR(unlit.speed_m_s / dry.speed_m_s, 1.0, 0.03);
  // Specific impulse, 7 MPa to 0.1: 260-265 s with aluminium, 220-230 s double base (Sutton and Biblarz, table 13-1). 5 %: frozen composition.
  EXPECT_NEAR(preset("aluminised_motor", bed).speed_m_s / 9.80665, 262.0, 0.05 * 262.0);
  EXPECT_NEAR(preset("double_base_motor", bed).speed_m_s / 9.80665, 225.0, 0.05 * 225.0);
}

// The elements of the formulation are in the gas: carbon and oxygen, H2O + CO + 2 CO2 of the one, CO + CO2 of the other, alumina's taken away.
TEST(EnginePresets, MotorsBurnWhatTheyAreMadeOf) {
  struct Part {
    double mass, molarMass, carbon, oxygen;
  };
  auto ratio = [](const std::vector<Part>& parts, double alumina) {
    double carbon = 0.0, oxygen = -3.0 * alumina / 0.101961;
    for (const Part& p : parts) {
      carbon += p.mass / p.molarMass * p.carbon;
      oxygen += p.mass / p.molarMass * p.oxygen;
    }
    return oxygen / carbon;
  };
  auto ofGas = [](const char* name) {
    const GasFractions& g = findEnginePreset(name)->gas;
    return (2.0 * g.co2 + g.co + g.h2o) / (g.co2 + g.co);
  };
  const Part perchlorate{0.68, 0.11749, 0.0, 4.0}, binder{0.14, 0.09968, 7.3, 0.06};
  // three digits of the fractions
  EXPECT_NEAR(ofGas("aluminised_motor"), ratio({perchlorate, binder}, 0.18 / 0.0269815 / 2.0 * 0.101961), 0.01);
  EXPECT_NEAR(ofGas("reduced_smoke_motor"), ratio({{0.86, 0.11749, 0.0, 4.0}, binder}, 0.0), 0.02);
  EXPECT_NEAR(ofGas("double_base_motor"), ratio({{0.57, 0.27243, 6.0, 9.902}, {0.31, 0.22709, 3.0, 9.0}, {0.12, 0.21820, 9.0, 6.0}}, 0.0), 0.01);
}

TEST(EnginePresets, FollowThrottleHeightAndFlight) {
  const CoFlow bed, high{26500.0, 223.25, 255.0, 420e-6, 0.0};
  for (const EnginePreset& p : enginePresets()) {
    SCOPED_TRACE(p.name);
    double lastThrust = 0.0;
    for (double throttle : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const auto n = nozzleOf(p, throttle, bed);
      if (!n) {
        EXPECT_FALSE(p.breathesAir());
        EXPECT_EQ(throttle, 0.0);
        continue;
      }
      const double thrust = nozzleMass(*n, bed) * n->speed_m_s;
      EXPECT_GT(thrust, lastThrust);
      lastThrust = thrust;
      EXPECT_NO_THROW(FreeJet(*n, bed, 100.0 * n->diameter_m));
    }
    EXPECT_THROW(nozzleOf(p, 1.1, bed), std::invalid_argument);
    EXPECT_THROW(nozzleOf(p, std::numeric_limits<double>::quiet_NaN(), bed), std::invalid_argument);
    // Thinner air, more expansion: colder and faster, of a motor; an engine's mass flow goes with p2/sqrt(T2).
    const NozzleFlow below = preset(p.name.data(), bed), above = preset(p.name.data(), high);
    EXPECT_LT(above.temperature_K, below.temperature_K);
    EXPECT_GT(above.speed_m_s, below.speed_m_s);
    if (p.breathesAir()) {
      const double inlet_K = 223.25 + 0.5 * 255.0 * 255.0 / 1004.7, inlet_Pa = 26500.0 * std::pow(inlet_K / 223.25, 3.5);
      // 1 %: the fuel in the mass flow, which changes with T2
      EXPECT_NEAR(nozzleMass(above, high) / nozzleMass(below, bed), inlet_Pa / 101325.0 / std::sqrt(inlet_K / 288.15), 0.01);
    } else {
      EXPECT_NEAR(nozzleMass(above, high) / nozzleMass(below, bed), 1.0, 1e-3);
    }
  }
  EXPECT_EQ(findEnginePreset("warp_drive"), nullptr);
  const EnginePreset& motor = *findEnginePreset("aluminised_motor");
  EXPECT_EQ(burnThrottle(motor, -0.1), 0.0);
  EXPECT_EQ(burnThrottle(motor, 1.0), 1.0);
  EXPECT_EQ(burnThrottle(motor, 4.0), 0.25);
  EXPECT_EQ(burnThrottle(motor, 9.0), 0.0);
  EXPECT_EQ(burnThrottle(*findEnginePreset("turboshaft"), 1e3), 1.0);
}

}  // namespace
}  // namespace pitviper::test
