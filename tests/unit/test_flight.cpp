// Flights against closed forms: air, gravity, drag, guidance, turns.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "sim/flight/ballistic.hpp"
#include "sim/flight/flight_error.hpp"
#include "sim/flight/flights.hpp"
#include "sim/flight/point_mass.hpp"
#include "sim/flight/recovery_temperature.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/flight/waypoint_flight.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/gravity.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/launch_along.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

FlightWorld uniformWorld(double density_kg_m3, double gravity_m_s2) {
  FlightWorld world;
  world.uniform = UniformEnvironment{density_kg_m3, 340.294, gravity_m_s2};
  world.coriolis = false;
  return world;
}

std::shared_ptr<const FlyingBody> bodyWithDrag(double mass_kg, double area_m2, double coefficient) {
  BallisticOptions o;
  o.mass_kg = mass_kg;
  o.area_m2 = area_m2;
  o.drag = {{0.0, coefficient}};
  return std::make_shared<Ballistic>(o);
}

/// Free of air and weight, without limits.
std::shared_ptr<const FlyingBody> freeBody() {
  PointMassOptions o;
  o.launchMass_kg = 100.0;
  return std::make_shared<PointMass>(o);
}

PointMotion straight(const glm::dvec3& from, const glm::dvec3& velocity) {
  return [=](double t) { return MovingPoint{from + t * velocity, velocity, glm::dvec3(0.0)}; };
}

TEST(StandardAtmosphere, TablesOfTheDocument) {
  // U.S. Standard Atmosphere, 1976, table I (geometric height): printed with as many digits as here, so half a unit of the last counts, and a whole one
  // for pressure, which others too find off by one at some heights (COESA.jl).
  struct Row {
    double height_m, temperature_K, pressure_Pa, density_kg_m3, sound_m_s, viscosity;
  };
  const std::vector<Row> rows = {{0, 288.150, 101325, 1.2250, 340.29, 1.7894e-5},        {1000, 281.651, 89876, 1.1117, 336.43, 1.7579e-5},
                                 {5000, 255.676, 54048, 0.73643, 320.55, 1.6282e-5},     {10000, 223.252, 26499, 0.41351, 299.53, 1.4577e-5},
                                 {15000, 216.650, 12111, 0.19476, 295.07, 1.4216e-5},    {20000, 216.650, 5529.3, 0.088910, 295.07, 1.4216e-5},
                                 {25000, 221.552, 2549.2, 0.040084, 298.39, 1.4484e-5},  {30000, 226.509, 1197.0, 0.018410, 301.71, 1.4753e-5},
                                 {40000, 250.350, 287.14, 3.9957e-3, 317.19, 1.6009e-5}, {50000, 270.650, 79.779, 1.0269e-3, 329.80, 1.7037e-5},
                                 {60000, 247.021, 21.958, 3.0968e-4, 315.07, 1.5837e-5}, {70000, 219.585, 5.2209, 8.2829e-5, 297.06, 1.4377e-5},
                                 {80000, 198.639, 1.0524, 1.8458e-5, 282.54, 1.3208e-5}};
  double worst = 0.0, pressure = 0.0;
  for (const Row& row : rows) {
    const StandardAir air = standardAir(row.height_m);
    const auto off = [&](double is, double printed) { worst = std::max(worst, std::abs(is / printed - 1.0)); };
    off(air.temperature_K, row.temperature_K);
    pressure = std::max(pressure, std::abs(air.pressure_Pa / row.pressure_Pa - 1.0));
    off(air.density_kg_m3, row.density_kg_m3);
    off(air.soundSpeed_m_s, row.sound_m_s);
    off(air.viscosity_Pa_s, row.viscosity);
  }
  bound("US Standard Atmosphere, 0 to 80 km, relative", worst, 5e-5, "table I of the document, five digits: half a unit of the last is 5e-5 at most");
  bound("US Standard Atmosphere, 0 to 80 km, pressure, relative", pressure, 1e-4, "table I, one unit of the fifth digit");
  // 86 km, where kinetic and molecular-scale temperature differ by 0.042 %.
  figure("density at 86 km [kg/m3]", standardAir(86000.0).density_kg_m3, 6.958e-6, 2e-4, "table I, four digits");
  figure("density at 100 km [kg/m3]", standardAir(100000.0).density_kg_m3, 5.604e-7, 0.04, "table I; held temperature above 86 km");
  figure("density at 120 km [kg/m3]", standardAir(120000.0).density_kg_m3, 2.222e-8, 0.25, "table I; held temperature above 86 km");
  EXPECT_EQ(standardAir(-9000.0).density_kg_m3, standardAir(-5000.0).density_kg_m3);
  EXPECT_GT(standardAir(-1000.0).pressure_Pa, 1.13e5);  // table I: 113930 Pa
}

TEST(RecoveryTemperature, FactorsAndTotalTemperature) {
  // Schlichting and Gersten, Boundary-Layer Theory: air has 0.84 to 0.85 laminar, 0.88 to 0.89 turbulent (measured on plates and cones).
  figure("recovery factor, laminar", recoveryFactor(BoundaryLayer::Laminar), 0.845, 0.006, "Schlichting and Gersten: 0.84 to 0.85");
  figure("recovery factor, turbulent", recoveryFactor(BoundaryLayer::Turbulent), 0.885, 0.01, "Schlichting and Gersten: 0.88 to 0.89");
  // NACA Report 1135, table I: T/T_t = 0.5556 at Mach 2.
  const double total = 216.65 / 0.5556;
  for (const auto layer : {BoundaryLayer::Laminar, BoundaryLayer::Turbulent})
    EXPECT_NEAR((recoveryTemperature_K(216.65, 2.0, layer) - 216.65) / (total - 216.65), recoveryFactor(layer), 2e-4);  // four printed digits
  EXPECT_EQ(recoveryTemperature_K(250.0, 0.0, BoundaryLayer::Turbulent), 250.0);
  EXPECT_NEAR(recoveryTemperatureAt_K(15000.0, 2.0 * 295.07, BoundaryLayer::Turbulent), recoveryTemperature_K(216.65, 2.0, BoundaryLayer::Turbulent), 0.01);
}

TEST(Gravity, OfTheEllipsoid) {
  // WGS 84 (NGA.STND.0036): normal gravity at equator and pole; at 45 deg by the closed formula of Somigliana.
  const auto down = [](double latitude_deg, double height_m) {
    const LocalFrame frame({latitude_deg * kDegree, 0.3, height_m});
    return -normalGravity(frame, glm::dvec3(0.0)).z;
  };
  EXPECT_NEAR(down(0.0, 0.0), 9.7803253359, 1e-10);
  EXPECT_NEAR(down(90.0, 0.0), 9.8321849378, 1e-9);
  const double k = 0.00193185265241, e2 = 6.69437999014e-3;
  EXPECT_NEAR(down(45.0, 0.0), 9.7803253359 * (1.0 + 0.5 * k) / std::sqrt(1.0 - 0.5 * e2), 1e-9);
  // Free-air gradient at 45 deg: 3.0855e-6 1/s2 (Moritz, Geodetic Reference System 1980: 0.3086 mGal/m).
  EXPECT_NEAR((down(45.0, 0.0) - down(45.0, 1000.0)) / 1000.0, 3.086e-6, 2e-9);
  const glm::dvec3 spin = earthRotation(LocalFrame({30.0 * kDegree, 1.0, 0.0}));
  EXPECT_NEAR(glm::length(spin), 7.292115e-5, 1e-15);
  EXPECT_NEAR(spin.z / glm::length(spin), 0.5, 1e-12);
  EXPECT_NEAR(spin.x, 0.0, 1e-18);
}

TEST(Flight, DragAloneIsLogarithmic) {
  // x = (m/k) ln(1 + k v0 t/m), k = rho C_D A/2.
  const double m = 0.2, area = 2e-3, cd = 0.9, rho = 1.225, v0 = 300.0, k = 0.5 * rho * cd * area;
  FlightTask task;
  task.body = bodyWithDrag(m, area, cd);
  task.launch.velocity = {v0, 0.0, 0.0};
  task.duration_s = 4.0;
  task.stopAtGround = false;
  const FlightResult result = fly(task, uniformWorld(rho, 0.0));
  for (double t : {0.5, 1.0, 4.0})
    figure("way against drag after " + std::to_string(t).substr(0, 3) + " s [m]", result.trajectory.at(t).position.x, m / k * std::log1p(k * v0 * t / m), 1e-3,
           "(m/k) ln(1 + k v0 t/m)");
  figure("speed against drag after 4 s [m/s]", result.trajectory.velocityAt(4.0).x, v0 / (1.0 + k * v0 * 4.0 / m), 1e-3, "v0/(1 + k v0 t/m)");
}

TEST(Flight, FallFromRestIsHyperbolic) {
  const double m = 0.3, area = 5e-3, cd = 1.1, rho = 1.0, g = 9.81, vt = std::sqrt(2.0 * m * g / (rho * cd * area));
  FlightTask task;
  task.body = bodyWithDrag(m, area, cd);
  task.launch.position = {0.0, 0.0, 5000.0};
  task.duration_s = 60.0;
  const FlightResult result = fly(task, uniformWorld(rho, g));
  for (double t : {1.0, 3.0, 10.0}) {
    figure("speed of a fall after " + std::to_string(static_cast<int>(t)) + " s [m/s]", -result.trajectory.velocityAt(t).z, vt * std::tanh(g * t / vt), 1e-3,
           "v_t tanh(g t/v_t)");
    EXPECT_NEAR(5000.0 - result.trajectory.at(t).position.z, vt * vt / g * std::log(std::cosh(g * t / vt)), 1e-3 * vt * t);
  }
  figure("terminal speed [m/s]", -result.trajectory.velocityAt(59.0).z, vt, 1e-3, "sqrt(2 m g/(rho C_D A))");
}

TEST(Flight, TerminalSpeedFollowsMassAndAir) {
  // A flare that has burnt half its mass while its area grew threefold: slow changes, so that the fall is near its terminal speed at any time.
  BallisticOptions o;
  o.mass_kg = 0.25;
  o.burntShare = 0.5;
  o.burnTime_s = 20.0;
  o.area_m2 = 4e-3;
  o.drag = {{0.0, 1.0}};
  o.areaFactor = {{0.0, 1.0}, {10.0, 3.0}};
  FlightTask task;
  task.body = std::make_shared<Ballistic>(o);
  task.launch.position = {0.0, 0.0, 6000.0};
  task.duration_s = 60.0;
  FlightWorld world;
  world.wind = {{0.0, {10.0, -4.0, 0.0}}};
  world.coriolis = false;
  const FlightResult result = fly(task, world);
  const glm::dvec3 p = result.trajectory.at(50.0).position, v = result.trajectory.velocityAt(50.0);
  const double vt = std::sqrt(2.0 * 0.125 * 9.80 / (standardAir(p.z).density_kg_m3 * 0.012));
  // Air thickens by 1/8000 per metre: the speed lags by v_t^2/(2 g) x 1/16000 of itself, 2e-4 at 20 m/s; gravity is 9.78 to 9.80.
  figure("terminal speed of a burnt flare in thickening air [m/s]", -v.z, vt, 2e-3, "sqrt(2 m g/(rho C_D A)), lag of thickening air 2e-4, gravity 1e-3");
  EXPECT_NEAR(v.x, 10.0, 0.02);  // and it goes with the wind
  EXPECT_NEAR(v.y, -4.0, 0.02);
}

TEST(Flight, BallisticMassLaws) {
  BallisticOptions o;
  o.mass_kg = 0.4;
  o.burntShare = 0.8;
  o.ignition_s = 0.5;
  o.burnTime_s = 4.0;
  EXPECT_EQ(Ballistic(o).mass_kg(0.5), 0.4);
  EXPECT_NEAR(Ballistic(o).mass_kg(2.5), 0.4 * 0.6, 1e-15);
  EXPECT_NEAR(Ballistic(o).mass_kg(9.0), 0.08, 1e-15);
  o.burnExponent = 3.0;
  EXPECT_NEAR(Ballistic(o).mass_kg(2.5), 0.4 * (0.2 + 0.8 / 8.0), 1e-15);
  o.ballisticCoefficient_kg_m2 = 50.0;
  EXPECT_NEAR(Ballistic(o).dragArea_m2(0.0, 0.7), 0.4 / 50.0, 1e-15);
}

TEST(Flight, RocketEquation) {
  // Free of air and weight: dv = I_sp g0 ln(m0/m1) (Tsiolkovsky), whatever the course of thrust.
  PointMassOptions o;
  o.launchMass_kg = 85.0;
  o.thrust = {{0.2, 0.0}, {0.3, 18000.0}, {2.1, 15000.0}, {2.2, 3000.0}, {5.0, 2500.0}};
  o.specificImpulse_s = 240.0;
  const auto body = std::make_shared<PointMass>(o);
  const double impulse = 900.0 + 29700.0 + 900.0 + 7700.0;
  EXPECT_NEAR(body->totalImpulse_Ns(), impulse, 1e-9);
  EXPECT_NEAR(body->mass_kg(9.0), 85.0 - impulse / (240.0 * 9.80665), 1e-12);
  EXPECT_NEAR(body->mass_kg(0.25), 85.0 - 225.0 / (240.0 * 9.80665), 1e-12);
  FlightTask task;
  task.body = body;
  task.launch = launchAlong(0.0, {0.0, 0.0, 100.0}, 30.0 * kDegree, 40.0 * kDegree, 10.0);
  task.duration_s = 6.0;
  task.step_s = 0.007;  // meets none of the table's times
  const double gained = glm::length(fly(task, uniformWorld(0.0, 0.0)).trajectory.velocityAt(6.0)) - 10.0;
  // Thrust drops from 2500 N to 0 within a step: only steps that are cut there keep the order. 1e-9 of 1400 m/s is what order 4 leaves.
  figure("speed gained by a motor [m/s]", gained, 240.0 * 9.80665 * std::log(85.0 / body->mass_kg(9.0)), 1e-9, "Tsiolkovsky; steps cut at the table's times");
}

TEST(Flight, OrderIsFour) {
  // A smooth flight with all that acts: halving the step divides the error by 2^4 (Richardson), within what the next order adds at these steps.
  FlightTask task;
  PointMassOptions o;
  o.launchMass_kg = 50.0;
  o.referenceArea_m2 = 0.02;
  o.drag = {{0.0, 0.4}};
  task.body = std::make_shared<PointMass>(o);
  task.launch = launchAlong(0.0, {0.0, 0.0, 1000.0}, 60.0 * kDegree, 30.0 * kDegree, 600.0);
  task.duration_s = 16.0;
  FlightWorld world;
  world.frame = LocalFrame({50.0 * kDegree, 0.0, 0.0});
  const auto endWith = [&](double step) {
    task.step_s = step;
    return fly(task, world).trajectory.at(16.0).position;
  };
  const glm::dvec3 truth = endWith(1.0 / 64.0);
  const double coarse = glm::length(endWith(1.0) - truth), middle = glm::length(endWith(0.5) - truth), fine = glm::length(endWith(0.25) - truth);
  figure("error by halving the step from 1 s", coarse / middle, 16.0, 0.15, "Runge-Kutta of order 4; next order at k v h/m = 0.06");
  figure("error by halving the step from 0.5 s", middle / fine, 16.0, 0.08, "Runge-Kutta of order 4");
  bound("error of a flight of 16 s with steps of 5 ms, from those of 0.25 s [m]", fine * std::pow(0.005 / 0.25, 4), 1e-8, "order 4");
}

TEST(Flight, CoriolisDeflectsAFall) {
  // Eastwards by w g t^3 cos(latitude)/3 (Landau and Lifshitz, Mechanics, section 39), to first order in w: the next is w t = 1e-3 of it.
  const double latitude = 40.0 * kDegree, g = 9.81;
  FlightWorld world = uniformWorld(0.0, g);
  world.frame = LocalFrame({latitude, 0.5, 0.0});
  world.coriolis = true;
  FlightTask task;
  task.body = freeBody();
  task.launch.position = {0.0, 0.0, 1000.0};
  const FlightResult result = fly(task, world);
  const double t = std::sqrt(2.0 * 1000.0 / g);
  EXPECT_EQ(result.end, FlightEnd::Ground);
  figure("time of a fall of 1 km [s]", result.trajectory.end_s(), t, 1e-6, "sqrt(2 h/g); 2 w v_east adds under 1e-6");
  figure("deflection of a fall of 1 km [m]", result.trajectory.at(result.trajectory.end_s()).position.x, 7.292115e-5 * g * t * t * t * std::cos(latitude) / 3.0,
         1e-3, "w g t^3 cos(lat)/3");
}

TEST(Flight, GroundIsMetWithinAStep) {
  FlightTask task;
  task.body = freeBody();
  task.launch = launchAlong(3.0, {0.0, 0.0, 0.0}, 0.0, 45.0 * kDegree, 200.0);
  task.step_s = 0.05;
  const FlightResult result = fly(task, uniformWorld(0.0, 9.81));
  const double t = 2.0 * 200.0 * std::sqrt(0.5) / 9.81;
  EXPECT_EQ(result.end, FlightEnd::Ground);
  EXPECT_NEAR(result.trajectory.end_s(), 3.0 + t, 1e-9);  // a parabola: the cubic through a step's ends is it
  EXPECT_NEAR(result.trajectory.at(3.0 + t).position.y, 200.0 * 200.0 / 9.81, 1e-6);
  EXPECT_FALSE(result.trajectory.presentAt(2.9));
}

TEST(Flight, StepsAndPointsKeptAreIndependent) {
  FlightTask task;
  task.body = bodyWithDrag(0.2, 2e-3, 0.9);
  task.launch = launchAlong(0.0, {0.0, 0.0, 500.0}, 1.0, 0.3, 250.0);
  task.duration_s = 5.0;
  const FlightWorld world;
  const Trajectory all = fly(task, world).trajectory;
  task.keepEvery = 16;
  const Trajectory some = fly(task, world).trajectory;
  EXPECT_EQ(all.points().size(), 1001u);
  EXPECT_EQ(some.points().size(), 64u);  // the first, 62 multiples of 16 up to 992, the last
  double worst = 0.0;
  for (double t = 0.0; t <= 5.0; t += 0.0031) worst = std::max(worst, glm::length(all.at(t).position - some.at(t).position));
  // h^6/46080 of the sixth derivative: v (k v/m)^5 x 120 with k v/m = 1.4 1/s is 1.6e5 m/s^6 at the begin.
  bound("one point in 16 of a flare's flight [m]", worst, std::pow(0.08, 6) / 46080.0 * 1.6e5, "quintic Hermite over 80 ms");
}

TEST(Flight, LaunchesAreWhatTheySay) {
  const Launch along = launchAlong(1.0, {1.0, 2.0, 3.0}, 90.0 * kDegree, 30.0 * kDegree, 100.0);
  EXPECT_LT(glm::length(along.velocity - glm::dvec3(100.0 * std::cos(30.0 * kDegree), 0.0, 50.0)), 1e-12);
  const Pose parent{{10.0, 20.0, 30.0}, orientationFrom({0.0, 0.0, 0.0})};  // northwards
  const Launch from = launchFrom(2.0, parent, {0.0, 250.0, 0.0}, {-1.0, 0.5, -0.2}, {0.0, -30.0, -10.0});
  EXPECT_LT(glm::length(from.position - glm::dvec3(9.5, 19.0, 29.8)), 1e-12);
  EXPECT_LT(glm::length(from.velocity - glm::dvec3(30.0, 250.0, -10.0)), 1e-12);
}

TEST(Flight, LimitsOfLiftAreKeptAndBodiesBank) {
  PointMassOptions o;
  o.launchMass_kg = 100.0;
  o.referenceArea_m2 = 0.05;
  o.mostLateral_g = 20.0;
  o.mostLiftCoefficient = 4.0;
  FlightTask task;
  task.body = std::make_shared<PointMass>(o);
  task.launch.velocity = {0.0, 300.0, 0.0};
  task.launch.position = {0.0, 0.0, 1000.0};
  task.guidance = GuidanceOptions{};
  task.guidance->law = GuidanceLaw::Pursuit;
  task.guidance->pursuitGain_per_s = 100.0;  // asks for far more than there is
  task.guidance->gravityCompensation = false;
  task.target = straight({1e6, 0.0, 1000.0}, glm::dvec3(0.0));  // due east, where it is going north
  task.duration_s = 0.5;
  const auto lateral = [&](double density) {
    const Trajectory path = fly(task, uniformWorld(density, 0.0)).trajectory;
    const glm::dvec3 v = path.velocityAt(0.25), z = path.at(0.25).orientation * glm::dvec3(0, 0, 1);
    // Body z along lift, with a tenth of g of up beside it.
    const double size = glm::length(path.accelerationAt(0.25));
    EXPECT_NEAR(std::atan2(z.z, glm::dot(z, glm::normalize(glm::cross(v, glm::dvec3(0, 0, 1))))), std::atan2(0.980665, size), 1e-6);
    return size;
  };
  figure("lateral acceleration by structure [m/s2]", lateral(4.0), 20.0 * 9.80665, 1e-9, "the limit");
  figure("lateral acceleration by lift [m/s2]", lateral(0.2), 0.5 * 0.2 * 300.0 * 300.0 * 0.05 * 4.0 / 100.0, 1e-6, "q S C_L/m");
}

TEST(Flight, LagIsOfFirstOrder) {
  // A pursuer that is asked for a constant acceleration flies a (1 - exp(-t/tau)).
  FlightTask task;
  PointMassOptions o;
  o.launchMass_kg = 100.0;
  task.body = std::make_shared<PointMass>(o);
  task.launch.velocity = {0.0, 1000.0, 0.0};
  task.guidance = GuidanceOptions{};
  task.guidance->law = GuidanceLaw::Pursuit;
  task.guidance->pursuitGain_per_s = 100.0;
  task.guidance->gravityCompensation = false;
  task.guidance->most_g = 2.0;
  task.guidance->timeConstant_s = 0.3;
  task.guidance->begin_s = 0.1234;  // within a step
  task.target = straight({1e7, 0.0, 0.0}, glm::dvec3(0.0));
  task.duration_s = 1.0;
  task.stopAtGround = false;
  const Trajectory path = fly(task, uniformWorld(0.0, 0.0)).trajectory;
  EXPECT_EQ(path.accelerationAt(0.1), glm::dvec3(0.0));
  for (double t : {0.2, 0.4, 1.0})
    // The command turns with the velocity by a t/v = 2 %, whose projections matter by its square; points stand 5 ms apart about the corner at the begin.
    EXPECT_NEAR(glm::length(path.accelerationAt(t)), 2.0 * 9.80665 * -std::expm1(-(t - 0.1234) / 0.3), 2e-3 * 2.0 * 9.80665) << t;
}

/// Distance at which two would pass, both going on with the velocities they have [m]; that of now where they open.
double zeroEffortMiss_m(const MovingPoint& own, const MovingPoint& target) {
  const glm::dvec3 r = target.position - own.position, v = target.velocity - own.velocity;
  const double closing = -glm::dot(r, v), speed2 = glm::dot(v, v);
  return closing > 0.0 ? glm::length(r + v * (closing / speed2)) : glm::length(r);
}

class LinearProportionalNavigation : public ::testing::TestWithParam<std::tuple<double, GuidanceLaw>> {};

TEST_P(LinearProportionalNavigation, HeadingErrorIsTakenOutAsTheClosedFormSays) {
  // Zarchan, Tactical and Strategic Missile Guidance, ch. 2: for a heading error HE, n_c = -V_M HE N' (1 - t/t_F)^(N'-2)/t_F, and the zero-effort miss falls
  // as V_M HE t_F (1 - t/t_F)^N'. Head-on; pure navigation has N' = N V_M/V_c.
  const auto [effective, law] = GetParam();
  const double vM = 914.4, vT = 304.8, tF = 10.0, error = 1.0 * kDegree;
  const double closing = vM * std::cos(error) + vT;
  FlightTask task;
  task.body = freeBody();
  task.launch.velocity = vM * glm::dvec3(std::cos(error), std::sin(error), 0.0);
  task.target = straight({closing * tF, 0.0, 0.0}, {-vT, 0.0, 0.0});
  task.guidance = GuidanceOptions{};
  task.guidance->law = law;
  task.guidance->navigationConstant = law == GuidanceLaw::TrueProportional ? effective : effective * closing / vM;
  task.guidance->blindRange_m = 0.1;
  task.stopAtGround = false;
  const FlightResult result = fly(task, uniformWorld(0.0, 0.0));
  const double peak = vM * error * effective / tF, miss = vM * error * tF;
  double acceleration = 0.0, zeroEffort = 0.0;
  for (double t = 0.0; t <= 0.995 * tF; t += 0.05) {
    const MovingPoint own{result.trajectory.at(t).position, result.trajectory.velocityAt(t), {}};
    acceleration = std::max(acceleration, std::abs(result.trajectory.accelerationAt(t).y + peak * std::pow(1.0 - t / tF, effective - 2.0)));
    zeroEffort = std::max(zeroEffort, std::abs(zeroEffortMiss_m(own, task.target(t)) - miss * std::pow(1.0 - t / tF, effective)));
  }
  const std::string name =
      std::string(law == GuidanceLaw::TrueProportional ? "true" : "pure") + " navigation, N' " + std::to_string(static_cast<int>(effective));
  bound(name + ", lateral acceleration, of its peak", acceleration / peak, 0.01, "linear theory; 1 deg is 0.017 rad, whose square and closing speed matter");
  bound(name + ", zero-effort miss, of its peak", zeroEffort / miss, 0.01, "linear theory");
  ASSERT_TRUE(result.closest);
  EXPECT_EQ(result.end, FlightEnd::ClosestApproach);
  EXPECT_LT(result.closest->distance_m, 0.02);
  EXPECT_NEAR(result.closest->time_s, tF, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Zarchan, LinearProportionalNavigation,
                         ::testing::Combine(::testing::Values(3.0, 4.0, 5.0), ::testing::Values(GuidanceLaw::TrueProportional, GuidanceLaw::PureProportional)));

/// The published two-dimensional engagement, in feet, written here from its equations alone. Source: Zarchan, Tactical and Strategic Missile Guidance, ch. 2,
/// listing of the "two-dimensional tactical missile-target engagement simulation": second-order Runge-Kutta, steps of 0.01 s, 0.0002 s within 1000 ft.
struct PublishedEngagement {
  double headingError_rad = 0.0, turn_ft_s2 = 0.0, constant = 4.0;
  double beta = 0.0;
  std::vector<std::array<double, 2>> command = {};  ///< time [s], n_c [ft/s2]
  double end_s = 0.0, miss_ft = 0.0, endSpeed_ft_s = 0.0;

  struct Rates {
    double rt1, rt2, rm1, rm2, vm1, vm2, beta;
  };
  void run() {
    const double vt = 1000.0, vm = 3000.0;
    Rates x{40000.0, 10000.0, 0.0, 10000.0, 0.0, 0.0, beta};
    const double sight = std::atan2(x.rt2 - x.rm2, x.rt1 - x.rm1), lead = std::asin(vt * std::sin(beta + sight) / vm), way = sight + lead + headingError_rad;
    x.vm1 = vm * std::cos(way), x.vm2 = vm * std::sin(way);
    double t = 0.0, range = 0.0, closing = 1.0, n = 0.0;
    const auto rates = [&](const Rates& s) {
      const double vt1 = -vt * std::cos(s.beta), vt2 = vt * std::sin(s.beta), r1 = s.rt1 - s.rm1, r2 = s.rt2 - s.rm2, v1 = vt1 - s.vm1, v2 = vt2 - s.vm2;
      range = std::hypot(r1, r2);
      closing = -(r1 * v1 + r2 * v2) / range;
      const double lambda = std::atan2(r2, r1), turning = (r1 * v2 - r2 * v1) / (range * range);
      n = constant * closing * turning;
      return Rates{vt1, vt2, s.vm1, s.vm2, -n * std::sin(lambda), n * std::cos(lambda), turn_ft_s2 / vt};
    };
    const auto plus = [](const Rates& s, const Rates& d, double h) {
      return Rates{s.rt1 + h * d.rt1, s.rt2 + h * d.rt2, s.rm1 + h * d.rm1, s.rm2 + h * d.rm2, s.vm1 + h * d.vm1, s.vm2 + h * d.vm2, s.beta + h * d.beta};
    };
    for (rates(x); closing >= 0.0;) {
      const double h = range < 1000.0 ? 0.0002 : 0.01;
      const Rates first = rates(x);
      command.push_back({t, n});
      const Rates euler = plus(x, first, h), second = rates(euler), end = plus(euler, second, h);
      x = {0.5 * (x.rt1 + end.rt1), 0.5 * (x.rt2 + end.rt2), 0.5 * (x.rm1 + end.rm1),  0.5 * (x.rm2 + end.rm2),
           0.5 * (x.vm1 + end.vm1), 0.5 * (x.vm2 + end.vm2), 0.5 * (x.beta + end.beta)};
      t += h;
      rates(x);
    }
    end_s = t, miss_ft = range, endSpeed_ft_s = std::hypot(x.vm1, x.vm2);
  }
};

// The published engagement against the flown one: accelerations over time, time of interception, miss and speed at the end.
TEST(Guidance, TrueNavigationIsThePublishedEngagement) {
  constexpr double kFoot = 0.3048, kVt = 1000.0 * kFoot;
  struct Case {
    double headingError_deg, turn_g, constant, beta_deg;
  };
  for (const Case& c :
       {Case{-20.0, 0.0, 4.0, 0.0}, Case{0.0, 3.0, 4.0, 0.0}, Case{-20.0, 0.0, 3.0, 0.0}, Case{-20.0, 3.0, 5.0, 0.0}, Case{15.0, -2.0, 4.0, 30.0}}) {
    const double turn_ft_s2 = c.turn_g * 32.2, beta = c.beta_deg * kDegree, rate = turn_ft_s2 / 1000.0;
    PublishedEngagement published{c.headingError_deg * kDegree, turn_ft_s2, c.constant, beta};
    published.run();
    const double lead = std::asin(std::sin(beta) / 3.0), way = lead + c.headingError_deg * kDegree;
    FlightTask task;
    task.body = freeBody();
    const glm::dvec3 ahead(std::cos(way), 0.0, std::sin(way));
    task.launch = {0.0, {0.0, 0.0, 10000.0 * kFoot}, 3000.0 * kFoot * ahead, ahead};
    task.duration_s = 20.0;
    task.step_s = 0.005;
    task.stopAtGround = false;
    task.stopAtClosestApproach = true;
    task.stopWithin_m = 1000.0;
    task.guidance = GuidanceOptions{};
    task.guidance->navigationConstant = c.constant;
    task.guidance->gravityCompensation = false;
    task.guidance->blindRange_m = 1e-3;
    task.target = [=](double t) {
      const double b = beta + rate * t;
      const glm::dvec3 from(40000.0 * kFoot, 0.0, 10000.0 * kFoot);
      // The integral of V (-cos b, sin b).
      const glm::dvec2 gone = rate != 0.0 ? kVt / rate * glm::dvec2(-(std::sin(b) - std::sin(beta)), -(std::cos(b) - std::cos(beta)))
                                          : kVt * t * glm::dvec2(-std::cos(beta), std::sin(beta));
      return MovingPoint{from + glm::dvec3(gone.x, 0.0, gone.y), kVt * glm::dvec3(-std::cos(b), 0.0, std::sin(b)), glm::dvec3(0.0)};
    };
    const FlightResult flown = fly(task, uniformWorld(0.0, 0.0));
    const std::string what = "heading error " + std::to_string(static_cast<int>(c.headingError_deg)) + " deg, target " +
                             std::to_string(static_cast<int>(c.turn_g)) + " g, N' " + std::to_string(static_cast<int>(c.constant));
    double worst = 0.0, most = 0.0;
    for (const auto& [t, n] : published.command) most = std::max(most, t < published.end_s - 0.5 ? std::abs(n) : 0.0);
    for (std::size_t k = 0; k < published.command.size(); k += 10) {
      const auto& [t, n] = published.command[k];
      if (t >= published.end_s - 0.5) break;
      worst = std::max(worst, std::abs(glm::length(flown.trajectory.accelerationAt(t)) - std::abs(n) * kFoot) / (most * kFoot));
    }
    bound("acceleration against the published listing, " + what + ", of the largest", worst, 1e-3,
          "the listing's steps of second order; the last half second, where both end, left out");
    ASSERT_TRUE(flown.closest);
    figure("time of interception, " + what + " [s]", flown.closest->time_s, published.end_s, 1e-4,
           "the listing ends within a step of 0.2 ms, and is of second order");
    EXPECT_LT(flown.closest->distance_m, 0.3) << what;
    EXPECT_LT(published.miss_ft * kFoot, 0.3) << what;
    figure("speed at interception, " + what + " [ft/s]", glm::length(flown.trajectory.velocityAt(flown.closest->time_s - 1e-3)) / kFoot,
           published.endSpeed_ft_s, 1e-3, "as the accelerations");
  }
  // n_c at launch by hand: N' (V_T + V_M cos HE) V_M sin(-HE) / R.
  PublishedEngagement first{-20.0 * kDegree, 0.0, 4.0, 0.0};
  first.run();
  figure("the listing's first command [g]", first.command.front()[1] / 32.2,
         4.0 * (1000.0 + 3000.0 * std::cos(20.0 * kDegree)) * 3000.0 * std::sin(20.0 * kDegree) / 40000.0 / 32.2, 1e-9, "N' Vc lambda-dot");
}

TEST(Guidance, PursuitTakesTheTimeOfItsClosedForm) {
  // Curve of pursuit: T = r0 (V + v cos f)/(V^2 - v^2), f between the line of sight and the target's velocity at the begin (Shneydor, ch. 3).
  const double own = 300.0, fled = 200.0, r0 = 3000.0;
  for (double f : {0.0, 60.0 * kDegree, 120.0 * kDegree}) {
    FlightTask task;
    task.body = freeBody();
    task.launch.velocity = {own, 0.0, 0.0};
    task.target = straight({r0, 0.0, 0.0}, fled * glm::dvec3(std::cos(f), std::sin(f), 0.0));
    task.guidance = GuidanceOptions{};
    task.guidance->law = GuidanceLaw::Pursuit;
    task.stopAtGround = false;
    const FlightResult result = fly(task, uniformWorld(0.0, 0.0));
    ASSERT_TRUE(result.closest);
    EXPECT_EQ(result.end, FlightEnd::ClosestApproach);
    // Within the blind range of 5 m it no longer turns: 5 m at 100 m/s.
    figure("pursuit, aspect " + std::to_string(std::lround(f / kDegree)) + " deg [s]", result.closest->time_s,
           r0 * (own + fled * std::cos(f)) / (own * own - fled * fled), 2e-3, "curve of pursuit; blind for the last 5 m");
  }
}

TEST(Guidance, CommandsAreBoundedAndWeightIsCarried) {
  GuidanceOptions o;
  const MovingPoint own{{0, 0, 0}, {0, 500, 0}, {}}, target{{100, 5000, 0}, {200, 0, 0}, {}};
  const glm::dvec3 g(0.0, 0.0, -9.81), with = guidanceCommand(o, own, target, g);
  o.gravityCompensation = false;
  EXPECT_LT(glm::length(with - guidanceCommand(o, own, target, g) - glm::dvec3(0, 0, 9.81)), 1e-12);
  o.most_g = 1.5;
  EXPECT_NEAR(glm::length(guidanceCommand(o, own, target, g)), 1.5 * 9.80665, 1e-9);
  o.blindRange_m = 1e4;
  EXPECT_EQ(guidanceCommand(o, own, target, g), glm::dvec3(0.0));
  o = {};
  o.gravityCompensation = false;
  EXPECT_EQ(guidanceCommand(o, own, {{0, -5000, 100}, {0, -900, 50}, {}}, g), glm::dvec3(0.0)) << "a target that opens";
}

TEST(ClosestApproach, OfStraightPathsIsTheClosedForm) {
  const PointMotion a = straight({0, 0, 0}, {700, 10, 0}), b = straight({4000, 3, 20}, {-300, 0, -5});
  const glm::dvec3 r(4000, 3, 20), v(-1000, -10, -5);
  const double t = -glm::dot(r, v) / glm::dot(v, v);
  const ClosestApproach found = closestApproach(a, b, 0.0, 10.0, 0.37);
  EXPECT_NEAR(found.time_s, t, 1e-12);
  EXPECT_NEAR(found.distance_m, glm::length(r + t * v), 1e-9);
  EXPECT_NEAR(closestApproach(a, b, 5.0, 7.0, 0.3).time_s, 5.0, 0.0) << "where they only part, the begin";
}

TEST(ClosestApproach, HardlyDependsOnTheStep) {
  // A missile with motor, drag, limits and lag against an aircraft that turns hard: a miss, and a hit.
  const LocalFrame frame({45.0 * kDegree, 8.0 * kDegree, 300.0});
  FlightWorld world;
  world.frame = frame;
  world.wind = {{0.0, {5.0, 0.0, 0.0}}, {10000.0, {25.0, 10.0, 0.0}}};
  const std::vector<FlightWaypoint> path = {
      {{4000, -3000, 3000}, 250, {}}, {{4500, 500, 3000}, 250, {}}, {{1000, 4000, 3300}, 230, {}}, {{-6000, 4000, 3500}, 260, {}}};
  WaypointFlightOptions turns;
  turns.mostLateral_g = 7.0;
  PointMassOptions o;
  o.launchMass_kg = 85.0;
  o.thrust = {{0.0, 0.0}, {0.1, 17000.0}, {2.0, 16000.0}, {2.1, 0.0}};
  o.propellantMass_kg = 27.0;
  o.referenceArea_m2 = 0.0127;
  o.drag = {{0.0, 0.35}, {0.9, 0.4}, {1.15, 0.75}, {2.0, 0.6}, {3.0, 0.5}};
  o.mostLateral_g = 30.0;
  o.mostLiftCoefficient = 12.0;
  FlightTask task;
  task.body = std::make_shared<PointMass>(o);
  task.launch = launchAlong(4.0, {0.0, -2000.0, 3000.0}, 45.0 * kDegree, 2.0 * kDegree, 250.0);
  task.target = motionOf(flyWaypoints(path, turns, frame));
  task.guidance = GuidanceOptions{};
  task.guidance->begin_s = 0.3;
  for (double lag : {0.1, 0.6}) {
    task.guidance->timeConstant_s = lag;
    const auto closest = [&](double step) {
      task.step_s = step;
      const FlightResult result = fly(task, world);
      EXPECT_EQ(result.end, FlightEnd::ClosestApproach);
      return *result.closest;
    };
    const ClosestApproach coarse = closest(0.01), fine = closest(0.005), finest = closest(0.0025);
    const std::string name = "closest approach with a lag of " + std::to_string(lag).substr(0, 3) + " s";
    bound(name + " of " + std::to_string(coarse.distance_m) + " m, step from 10 to 5 ms [m]", std::abs(coarse.distance_m - fine.distance_m),
          std::max(0.01, 0.01 * fine.distance_m), "1 cm or 1 %");
    bound(name + ", step from 5 to 2.5 ms [m]", std::abs(fine.distance_m - finest.distance_m), std::max(0.01, 0.01 * finest.distance_m), "1 cm or 1 %");
    EXPECT_NEAR(coarse.time_s, finest.time_s, 1e-4);
    // The same by looking at both paths afterwards.
    const ClosestApproach seen = closestApproach(motionOf(fly(task, world).trajectory), task.target, 4.0, finest.time_s, 0.01);
    EXPECT_NEAR(seen.distance_m, finest.distance_m, 1e-6);
  }
}

TEST(Waypoints, TurnsAreArcsWithTheirBank) {
  const double v = 200.0, n = 4.0, radius = v * v / (n * 9.80665);
  const std::vector<FlightWaypoint> path = {{{0, 0, 1000}, v, {}}, {{0, 5000, 1000}, v, {}}, {{4000, 5000, 1000}, v, {}}};
  WaypointFlightOptions o;
  o.begin_s = 7.0;
  o.mostLateral_g = n;
  o.followEarth = false;
  const Trajectory flight = flyWaypoints(path, o, LocalFrame());
  const double arrives = 7.0 + (5000.0 - radius) / v, arc = radius * 0.5 * kPi / v;
  EXPECT_NEAR(flight.begin_s(), 7.0, 0.0);
  EXPECT_NEAR(flight.end_s(), arrives + arc + (4000.0 - radius) / v, 1e-9);
  const glm::dvec3 centre(radius, 5000.0 - radius, 1000.0);
  double off = 0.0, speed = 0.0;
  for (double t = arrives; t <= arrives + arc; t += 0.0037) {
    off = std::max(off, std::abs(glm::length(flight.at(t).position - centre) - radius));
    speed = std::max(speed, std::abs(glm::length(flight.velocityAt(t)) / v - 1.0));
  }
  // At the joints acceleration is the mean of 0 and 4 g: 20 m/s2 off over h^2 x 0.0173 (the largest of s^2 (1 - s)^3/2) at 20 ms, 1.4e-4 m.
  bound("turn of 4 g at 200 m/s, off its circle [m]", off, 1.5e-4, "acceleration at joints is the mean of both sides");
  bound("turn of 4 g at 200 m/s, speed, relative", speed, 8e-7,
        "the same: 20 m/s2 x h x 0.1 (slope of s^2 (1 - s)^3/2), across a path that turns by 4 mrad in a step");
  const double middle = arrives + 0.5 * arc;
  figure("lateral acceleration of a turn [m/s2]", glm::length(flight.accelerationAt(middle)), n * 9.80665, 1e-6, "v^2/R");
  const glm::dvec3 left = flight.at(middle).orientation * glm::dvec3(0, 1, 0);
  figure("bank of a turn of 4 g [deg]", std::asin(left.z) / kDegree, std::atan(n) / kDegree, 1e-6, "tan(bank) = a/g; to the right, so the left wing rises");
  EXPECT_NEAR((flight.at(8.0).orientation * glm::dvec3(0, 1, 0)).z, 0.0, 1e-12) << "level on legs";
  // It rolls in over a second: half way as the turn begins.
  EXPECT_NEAR(std::asin((flight.at(arrives).orientation * glm::dvec3(0, 1, 0)).z), 0.5 * std::atan(n), 1e-3);
}

TEST(Waypoints, SpeedsAreMetAndClimbsAreStraight) {
  const std::vector<FlightWaypoint> path = {{{0, 0, 100}, 0.0, {}}, {{0, 2000, 100}, 100.0, {}}, {{0, 4000, 600}, 150.0, 2.0}, {{3000, 6000, 600}, 120.0, {}}};
  WaypointFlightOptions o;
  o.followEarth = false;
  const Trajectory flight = flyWaypoints(path, o, LocalFrame());
  EXPECT_EQ(glm::length(flight.velocityAt(0.0)), 0.0);
  EXPECT_NEAR(glm::length(flight.velocityAt(flight.end_s())), 120.0, 1e-9);
  EXPECT_LT(glm::length(flight.at(flight.end_s()).position - path.back().position), 1e-9);
  EXPECT_GT((flight.at(0.0).orientation * glm::dvec3(1, 0, 0)).y, 1.0 - 1e-12) << "at rest it points where it will go";
  // From rest: v^2 = 2 a s up to where the turn into the climb begins.
  const double r = 100.0 * 100.0 / (5.0 * 9.80665), before = 2000.0 - r * std::tan(0.5 * std::atan2(500.0, 2000.0)), a = 100.0 * 100.0 / (2.0 * before);
  EXPECT_NEAR(flight.at(10.0).position.y, 0.5 * a * 100.0, 1e-6);
  double most = 0.0;
  for (const auto& p : flight.points()) most = std::max(most, glm::length(p.acceleration));
  EXPECT_LE(most, 5.0 * 9.80665 * (1.0 + 1e-9));
}

TEST(Waypoints, LevelMeansLevelOverTheEarth) {
  const LocalFrame frame({-20.0 * kDegree, 140.0 * kDegree, 50.0});
  const auto above = [&](double east, double north, double height) {
    const double r = frame.earthRadius_m(), angle = std::hypot(east, north) / r;
    const glm::dvec3 out = glm::normalize(glm::dvec3(east, north, 0.0));
    return (r + height) * (std::sin(angle) * out + glm::dvec3(0.0, 0.0, std::cos(angle))) - glm::dvec3(0.0, 0.0, r + 50.0);
  };
  const std::vector<FlightWaypoint> path = {{above(-80e3, 5e3, 9000), 250, {}}, {above(60e3, 10e3, 9000), 250, {}}, {above(70e3, 90e3, 9000), 250, {}}};
  const Trajectory flight = flyWaypoints(path, WaypointFlightOptions{}, frame);
  double height = 0.0, speed = 0.0, straightness = 0.0;
  const double r = frame.earthRadius_m();
  for (const auto& p : flight.points()) {
    height = std::max(height, std::abs(frame.height(p.position) - 9000.0));
    speed = std::max(speed, std::abs(glm::length(p.velocity) / 250.0 - 1.0));
    if (p.time_s < 300.0) straightness = std::max(straightness, std::abs(glm::length(p.acceleration) - 250.0 * 250.0 / (r + 9000.0)));
  }
  bound("level flight of 220 km, height [m]", height, 1e-6, "a great circle on the sphere of the frame; rounding of 6e6 m");
  bound("level flight of 220 km, speed, relative", speed, 114e3 * 114e3 / (6.0 * r * r), "d^2/(6 R^2) at 114 km, as the map has it");
  bound("level flight of 220 km, acceleration beside v^2/r [m/s2]", straightness, 1e-6, "bends down with the earth; speed as above, squared, of 0.01 m/s2");
  // Velocities are the path's own: differences of positions over 2 ms.
  for (double t : {100.0, 400.0, 700.0}) {
    const glm::dvec3 moved = (flight.at(t + 1e-3).position - flight.at(t - 1e-3).position) / 2e-3;
    EXPECT_LT(glm::length(moved - flight.velocityAt(t)), 1e-5) << t;  // rounding of 1e5 m over 2 ms, 1e-8, and the third derivative's 1e-6
  }
}

TEST(Waypoints, WhatNeedsMoreIsRefusedWithItsNumbers) {
  using Reason = WaypointRefusal::Reason;
  WaypointFlightOptions o;
  o.followEarth = false;
  const auto refusal = [&](const std::vector<FlightWaypoint>& path) -> WaypointRefusal {
    try {
      flyWaypoints(path, o, LocalFrame());
    } catch (const WaypointRefusal& r) {
      return r;
    }
    return WaypointRefusal(Reason::Option, 99, 0.0, 0.0, "none");
  };
  // A right angle at 200 m/s in legs of 500 m: radius 500 m at most, so 40000/500/9.80665 = 8.16 g.
  const WaypointRefusal tight = refusal({{{0, 0, 0}, 200, {}}, {{0, 500, 0}, 200, {}}, {{900, 500, 0}, 200, {}}});
  EXPECT_EQ(tight.reason, Reason::TurnTooTight);
  EXPECT_EQ(tight.waypoint, 1u);
  EXPECT_NEAR(tight.needed_g, 200.0 * 200.0 / 500.0 / 9.80665, 1e-9);
  EXPECT_EQ(tight.allowed_g, 5.0);
  EXPECT_NE(std::string(tight.what()).find("waypoint 2 needs a turn of 8.16 g"), std::string::npos) << tight.what();
  // What it says suffices, suffices.
  o.mostLateral_g = tight.needed_g * (1.0 + 1e-12);
  EXPECT_NO_THROW(flyWaypoints(std::vector<FlightWaypoint>{{{0, 0, 0}, 200, {}}, {{0, 500, 0}, 200, {}}, {{900, 500, 0}, 200, {}}}, o, LocalFrame()));
  o.mostLateral_g = 5.0;
  EXPECT_EQ(refusal({{{0, 0, 0}, 200, {}}, {{0, 500, 0}, 200, {}}, {{0, 100, 0}, 200, {}}}).reason, Reason::TurnsBack);
  EXPECT_EQ(refusal({{{0, 0, 0}, 200, {}}, {{0, 0, 0}, 200, {}}}).reason, Reason::SamePlace);
  EXPECT_EQ(refusal({{{0, 0, 0}, 200, {}}}).reason, Reason::FewPoints);
  EXPECT_EQ(refusal({{{0, 0, 0}, 0, {}}, {{0, 500, 0}, 0, {}}}).reason, Reason::NoSpeed);
  EXPECT_EQ(refusal({{{0, 0, 0}, 200, {}}, {{0, 9e3, 0}, 200, 6.0}, {{9e3, 9e3, 0}, 200, {}}}).reason, Reason::TurnAboveLimit);
  const WaypointRefusal push = refusal({{{0, 0, 0}, 100, {}}, {{0, 500, 0}, 300, {}}});
  EXPECT_EQ(push.reason, Reason::SpeedChange);
  EXPECT_NEAR(push.needed_g, (300.0 * 300.0 - 100.0 * 100.0) / 1000.0 / 9.80665, 1e-9);
}

TEST(Flight, WhatCannotFlyIsRefusedByName) {
  const auto option = [](const std::function<void()>& f) -> std::string {
    try {
      f();
    } catch (const FlightError& e) {
      return e.option + (e.item ? " " + std::to_string(*e.item) : "");
    }
    return "";
  };
  const auto point = [&](const std::function<void(PointMassOptions&)>& change) {
    PointMassOptions o;
    o.launchMass_kg = 10.0;
    change(o);
    return option([&] { PointMass{o}; });
  };
  EXPECT_EQ(point([](auto&) {}), "");
  EXPECT_EQ(point([](auto& o) { o.launchMass_kg = 0.0; }), "mass");
  EXPECT_EQ(point([](auto& o) { o.propellantMass_kg = 10.0; }), "propellant");
  EXPECT_EQ(point([](auto& o) { o.propellantMass_kg = 1.0; }), "propellant") << "propellant without thrust";
  EXPECT_EQ(point([](auto& o) { o.thrust = {{0, 1}, {2, 3}, {1, 4}}; }), "thrust 2");
  EXPECT_EQ(point([](auto& o) { o.drag = {{0, 0.4}, {1, -0.1}}; }), "drag 1");
  EXPECT_EQ(point([](auto& o) { o.drag = {{0, std::nan("")}}; }), "drag 0");
  const auto flare = [&](const std::function<void(BallisticOptions&)>& change) {
    BallisticOptions o;
    o.mass_kg = 0.2;
    change(o);
    return option([&] { Ballistic{o}; });
  };
  EXPECT_EQ(flare([](auto& o) { o.burntShare = 1.0; }), "burnt_share");
  EXPECT_EQ(flare([](auto& o) { o.burntShare = 0.5; }), "burn_time");
  EXPECT_EQ(flare([](auto& o) { o.ballisticCoefficient_kg_m2 = 40.0, o.area_m2 = 1.0; }), "ballistic_coefficient");
  const auto flight = [&](const std::function<void(FlightTask&, FlightWorld&)>& change) {
    FlightTask task;
    task.body = freeBody();
    FlightWorld world;
    change(task, world);
    return option([&] { fly(task, world); });
  };
  EXPECT_EQ(flight([](auto& t, auto&) { t.step_s = 0.0; }), "step");
  EXPECT_EQ(flight([](auto& t, auto&) { t.duration_s = 1e9; }), "step");
  EXPECT_EQ(flight([](auto& t, auto&) { t.duration_s = 9e3; }), "duration");
  EXPECT_EQ(flight([](auto& t, auto&) { t.guidance = GuidanceOptions{}; }), "guidance");
  EXPECT_EQ(flight([](auto& t, auto&) {
              t.guidance = GuidanceOptions{}, t.target = straight({1, 2, 3}, {}), t.guidance->timeConstant_s = 1e-3;
            }),
            "time_constant");
  EXPECT_EQ(flight([](auto&, auto& w) { w.wind = {{100.0, {}}, {50.0, {}}}; }), "wind 1");
  EXPECT_EQ(flight([](auto& t, auto&) {
              t.body = bodyWithDrag(1e-9, 10.0, 2.0), t.launch.velocity = {300, 0, 0}, t.launch.position.z = 100.0;
            }),
            "step")
      << "a step far beyond stability";
}

}  // namespace
}  // namespace pitviper::test
