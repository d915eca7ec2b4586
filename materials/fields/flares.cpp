#include "materials/fields/flares.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/flight/ballistic.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/model/medium.hpp"
#include "sim/model/simulation.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kSeaLevel_Pa = 101325.0;
/// Of the flight: a tenth of the time over which drag takes its speed, which leaves 1e-5 of it at the fourth order; 4 ms at most. Points of its path at every
/// fourth, 20 ms apart at most, 20000 at most (2 MB).
constexpr double kOfDrag = 0.1, kStep_s = 0.004, kLeastStep_s = 1e-5;
constexpr double kBetweenPoints_s = 0.02, kStepsToPoint = 4.0, kMostPoints = 20000.0;
constexpr double kDensest_kg_m3 = 1.3;
constexpr double kInTail = 6.0;       ///< puffs
constexpr double kLeastLevel = 1e-4;  ///< of what it sends: below it isn't there
/// Column of a puff's kernel through its middle: C 32/35 M/R^2.
constexpr double kMiddle = kPuffNorm * 32.0 / 35.0;

double smooth(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

Spectrum emissivityOf(const FlareType& type) {
  Spectrum::Table table;
  for (const auto& [wavelength, value] : type.emissivity) {
    table.wavelength_um.push_back(wavelength);
    table.value.push_back(value);
  }
  table.outside = Outside::Hold;
  table.name = "flare " + std::string(type.name);
  return Spectrum(std::move(table));
}

}  // namespace

double flareArea_m2(const FlareType& type) {
  return type.intensity_W_sr / (emissivityOf(type) * Spectrum(Spectrum::BlackBody{type.temperature_K, 1.0})).integral(3.0, 5.0);
}

Spectrum flareIntensity(const FlareType& type) { return emissivityOf(type) * Spectrum(Spectrum::BlackBody{type.temperature_K, flareArea_m2(type)}); }

double areaOf_m2(const Spectrum& intensity, double temperature_K) {
  const double low = std::max(1.0, intensity.validLow()), high = std::min(14.0, intensity.validHigh());
  if (!(high > low)) return 0.0;
  return intensity.integral(low, high) / Spectrum(Spectrum::BlackBody{temperature_K, 1.0}).integral(low, high);
}

double flareBurn(const FlareType& type, double t) {
  if (!(t > 0.0 && t < type.burn_s)) return 0.0;
  const double rise = type.rise_s > 0.0 ? smooth(t / type.rise_s) : 1.0;
  return rise * (type.fall_s > 0.0 ? smooth((type.burn_s - t) / type.fall_s) : 1.0);
}

double flareInWind(const FlareType& type, double airspeed_m_s) {
  return type.stillShare + (1.0 - type.stillShare) * std::exp(-airspeed_m_s / type.speedScale_m_s);
}

double flareAtPressure(const FlareType& type, double pressure_Pa) { return std::pow(pressure_Pa / kSeaLevel_Pa, type.pressureExponent); }

FlareFlight flyFlare(const FlareType& type, const Launch& launch, const FlightWorld& world) {
  BallisticOptions body;
  body.mass_kg = type.mass_kg;
  body.burntShare = type.burntShare;
  body.ignition_s = type.ignition_s;
  body.burnTime_s = type.burn_s;
  body.burnExponent = type.burnExponent;
  body.area_m2 = type.dragArea_m2;
  body.drag = {{0.0, 1.0}};  // the area is the coefficient's too
  FlightTask task;
  task.launch = launch;
  task.body = std::make_shared<Ballistic>(body);
  task.duration_s = type.ignition_s + type.burn_s;
  const double speed = glm::length(launch.velocity - airIn(world, launch.position).wind_m_s),
               braked_per_s = kDensest_kg_m3 * speed * type.dragArea_m2 / type.mass_kg;
  task.step_s = std::clamp(braked_per_s > 0.0 ? kOfDrag / braked_per_s : kStep_s, kLeastStep_s, kStep_s);
  const double apart_s = std::max(std::min(kStepsToPoint * task.step_s, kBetweenPoints_s), task.duration_s / kMostPoints);
  task.keepEvery = std::max(1, static_cast<int>(std::lround(apart_s / task.step_s)));
  task.stopAtGround = heightIn(world, launch.position) > world.groundHeight_m;
  task.after = AtEnd::Hold;  // burns on where it fell
  FlareFlight flown{fly(task, world).trajectory, {}, launch.time_s + type.ignition_s, launch.time_s + type.ignition_s + type.burn_s};

  // 2 ms while it rises, as linear as a cubic of 60 ms or more is within 0.1 %; then as the path.
  std::vector<TimeCourse::Point> level;
  const double fine_s = std::min(type.rise_s / 30.0, kBetweenPoints_s);
  for (double t = flown.lit_s; t < flown.out_s - 1e-6; t += t < flown.lit_s + type.rise_s && fine_s > 0.0 ? fine_s : kBetweenPoints_s) {
    const glm::dvec3 at = flown.path.at(t).position;
    const AirHere air = airIn(world, at);
    const double pressure = world.uniform ? kSeaLevel_Pa : standardAir(heightIn(world, at)).pressure_Pa;
    level.push_back(
        {t, flareBurn(type, t - flown.lit_s) * flareInWind(type, glm::length(flown.path.velocityAt(t) - air.wind_m_s)) * flareAtPressure(type, pressure)});
  }
  level.push_back({flown.out_s, 0.0});
  flown.level = TimeCourse(std::move(level), TimeCourse::Interpolation::Linear, TimeCourse::Outside::Zero);
  return flown;
}

double puffOpacity(double depth) {
  // The series, in which terms grow to d^d/d! before they fall: as exp(d), which costs digits. Beyond 12 the rest is the asymptotic gamma function:
  // int_0^1 y exp(-d y^7) dy = d^(-2/7) Gamma(2/7)/7, to exp(-12).
  if (depth > 12.0) return 1.0 - 2.0 * std::tgamma(2.0 / 7.0) / 7.0 * std::pow(depth, -2.0 / 7.0);
  double sum = 0.0, term = 1.0;
  for (int k = 1; k < 200; ++k) {
    term *= -depth / k;
    sum -= term / (7.0 * k + 2.0);
    if (std::abs(term) < 1e-17) break;
  }
  return 2.0 * sum;
}

double areaFromTheSide_m2(std::span<const Puff> puffs) {
  const glm::dvec3 axis = puffs.front().axis, from = puffs.front().centre;
  double low = INFINITY, high = -INFINITY, radius = 0.0;
  for (const Puff& p : puffs) {
    const double x = glm::dot(p.centre - from, axis);
    low = std::min(low, x - p.length_m());
    high = std::max(high, x + p.length_m());
    radius = std::max(radius, p.radius_m);
  }
  // Even steps: what is added up has three derivatives and is 0 at the edges, so that 24 across the least puff leave 1e-5.
  constexpr double kAcross = 24.0;
  double least = INFINITY;
  for (const Puff& p : puffs) least = std::min({least, p.radius_m, p.length_m()});
  const int along = static_cast<int>(std::clamp(std::ceil(kAcross * 0.5 * (high - low) / least), kAcross, 512.0)), across = static_cast<int>(kAcross);
  const double dx = (high - low) / along, db = radius / across;
  double sum = 0.0;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const double x = low + (i + 0.5) * dx, b = (j + 0.5) * db;
      double depth = 0.0;
      for (const Puff& p : puffs) {
        const double u = (x - glm::dot(p.centre - from, axis)) / p.length_m(), v = b / p.radius_m, left = 1.0 - u * u - v * v;
        if (left > 0.0) depth += kMiddle * p.amount[0] / (p.radius_m * p.length_m()) * left * left * left * std::sqrt(left);
      }
      sum -= std::expm1(-depth);
    }
  return 2.0 * sum * dx * db;
}

FlareCloud::FlareCloud(FlareCloudOptions options) : options_(std::move(options)) {
  if (options_.store < 0 && (!options_.path || options_.level.empty())) throw std::invalid_argument("a flare without a path or a level");
  if (!(options_.area_m2 > 0.0 && options_.depth > 0.0)) throw std::invalid_argument("a flare without an area or a depth");
  radius_m_ = std::sqrt(options_.area_m2 / (kPi * puffOpacity(options_.depth)));
}

std::shared_ptr<const FieldState> FlareCloud::at(const FieldWorld& world) const {
  FlareCloudOptions o = options_;
  if (o.store >= 0) {
    const auto flies = world.ejected ? world.ejected(o.store) : nullptr;
    if (!flies) return nullptr;
    o.path = flies->path;
    o.level = flies->level;
    o.lit_s = flies->lit_s;
  }
  const double level = o.level.at(world.time_s);
  if (!(level > kLeastLevel)) return nullptr;
  const Pose pose = o.path->at(world.time_s);
  const glm::dvec3 throughAir = o.path->velocityAt(world.time_s) - o.wind_m_s;
  const double speed = glm::length(throughAir), radius = radius_m_ * std::pow(level, 0.25) + o.spread_m_s * (world.time_s - o.lit_s);
  // Cross-section as at level 1 standing still, with the flame's area.
  const double crossSection_m2 = o.depth * radius_m_ * radius_m_ / kMiddle * std::sqrt(level), tail = speed * o.glow_s;
  const double height_m = world.simulation ? world.simulation->frame.altitude(pose.position) : pose.position.z;
  Puff puff;
  puff.temperature_K = standardAir(height_m).temperature_K + o.airWarmer_K;
  puff.centre = pose.position;
  puff.radius_m = radius;
  puff.amount[0] = crossSection_m2;
  std::vector<Puff> puffs;
  if (tail < 0.02 * radius) {  // 2 % of its radius: not seen
    puffs = {puff};
  } else {
    puff.axis = -throughAir / speed;
    puff.amount[0] = crossSection_m2 / kInTail;
    for (double k = 0.5; k < kInTail; k += 1.0) {  // the middles of equal shares of exp(-x/tail)
      const double left = 1.0 - k / kInTail, x = -tail * std::log(left), apart = tail / (kInTail * left);
      puff.centre = pose.position + x * puff.axis;
      puff.radius_m = radius * (1.0 + 0.15 * x / tail);                                                 // mixes as it falls behind
      puff.halfLength_m = std::clamp(2.0 * apart, puff.radius_m, std::max(puff.radius_m, x + radius));  // none reaches ahead of the first
      puffs.push_back(puff);
    }
  }
  const double area = areaFromTheSide_m2(puffs);
  for (Puff& p : puffs) p.gain = level / area;
  auto state = std::make_shared<PuffsState>(std::move(puffs));
  state->source = pose.position - state->origin;
  return state;
}

void FlareCloud::addTo(Fingerprint& f) const {
  const auto& [store, path, level, area_m2, depth, glow_s, spread_m_s, lit_s, wind_m_s, airWarmer_K] = options_;
  f.add("flare").add(store).add(area_m2).add(depth).add(glow_s).add(spread_m_s).add(lit_s).add(wind_m_s).add(airWarmer_K);
  pitviper::addTo(f, level);
  if (path) path->addTo(f);
}

glm::dvec2 FlareCloud::temperatures_K() const {
  return {187.0 + std::min(options_.airWarmer_K, 0.0), 320.7 + std::max(options_.airWarmer_K, 0.0)};  // of the standard atmosphere
}

Medium flareGas(const Spectrum& intensity) {
  Medium gas;
  gas.absorption_per_m = Spectrum(1.0);
  gas.radiance = intensity;
  return gas;
}

}  // namespace pitviper
