// Flares that entities eject: each is a light, a burning cloud and, of most types, smoke.
#include "scenarios/reader/flares.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <list>
#include <mutex>
#include <optional>

#include "materials/fields/flares.hpp"
#include "materials/fields/smoke.hpp"
#include "scenarios/reader/builder.hpp"
#include "sim/flight/flight_error.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/placement.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// Seconds that a flare's smoke is seen, and how it leaves: warm, and slower than the flare by what the air has taken of it. Chosen.
constexpr double kSmokeLifetime_s = 30.0, kSmoke_K = 450.0, kSmokeShare = 0.3, kOfCloud = 0.6;
constexpr int kSmokePuffs = 150;
/// As many as lights of a scenario.
constexpr std::size_t kMostFlares = 1024;

std::vector<std::string> flareNames() {
  std::vector<std::string> names;
  for (const FlareType& t : flareTypes()) names.emplace_back(t.name);
  return names;
}

/// Unit vector in body axes.
glm::dvec3 readDirection(const Record& r) {
  if (!r.given("direction")) return {0.0, 0.0, -1.0};
  const Value& v = r.value("direction");
  if (v.kind == Value::Kind::Map) {
    const Record angles(v, tables::flareDirection());
    const double azimuth = angles.number("azimuth"), elevation = angles.number("elevation");
    return {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  }
  const glm::dvec3 d = readVector(v, "", "direction");
  const double length = glm::length(d);
  if (!(length > 0.0) || !std::isfinite(length))
    throw UserError(v.where, "a direction of no length", "three numbers that are not all 0, in body axes (x forward, y left, z up)", "'[0, 0, -1]' is down");
  return d / length;
}

/// When it is ejected; none: when a command says so.
std::optional<double> readEjection(const Value& v) {
  if (v.kind == Value::Kind::Scalar && v.text == "on_command") return {};
  const double time_s = readNumber(v, "s", "time");
  if (!(std::abs(time_s) <= kLongestTime_s))
    throw UserError(v.where, "time is out of range (" + v.text.substr(0, 40) + ")", "-1e+09 to 1e+09 s, or 'on_command'", "correct it");
  return time_s;
}

/// Commands are carried out for every picture anew: the flights of the last few times that they eject it are kept.
auto keepingLast(std::function<Ejected(double, const Pose&, const glm::dvec3&)> fly) {
  struct Flight {
    double time_s = 0.0;
    Pose carrier;
    glm::dvec3 velocity{0.0};
    std::shared_ptr<const Ejected> flown;
  };
  struct Kept {
    std::mutex mutex;
    std::list<Flight> flights;
  };
  return [fly = std::move(fly), kept = std::make_shared<Kept>()](double time_s, const Pose& carrier,
                                                                 const glm::dvec3& velocity) -> std::shared_ptr<const Ejected> {
    constexpr std::size_t kMost = 8;
    const std::lock_guard lock(kept->mutex);
    for (const Flight& f : kept->flights)
      if (f.time_s == time_s && f.carrier.position == carrier.position && f.carrier.orientation == carrier.orientation && f.velocity == velocity)
        return f.flown;
    std::shared_ptr<const Ejected> flown;
    try {
      flown = std::make_shared<const Ejected>(fly(time_s, carrier, velocity));
    } catch (const FlightError&) {  // no drag takes such a speed in steps that it flies in: it is gone
    }
    kept->flights.push_front({time_s, carrier, velocity, flown});
    if (kept->flights.size() > kMost) kept->flights.pop_back();
    return flown;
  };
}

}  // namespace

namespace tables {

const ParameterTable& flare() {
  static const ParameterTable t = [] {
    std::string known;
    for (const FlareType& type : flareTypes()) known += (known.empty() ? "`" : "; `") + std::string(type.name) + "`: " + std::string(type.description);
    return ParameterTable{
        "flare",
        "A decoy: it flies on with its carrier's velocity and that of its ejection, slowed down by drag as it burns away, and falls; it shines weaker in a "
        "fast "
        "stream of air and at height. It lights what is near it, as a light of its name, which cameras can look at; is seen as a burning cloud; and leaves "
        "smoke.",
        {required(text("name", "unique among lights")), required(choice("type", flareNames(), known)),
         text("from", "name of the entity that ejects it, as the scenario moves it; without it, it starts from its position at rest"),
         required(any("time", "of ejection [s]; or `on_command`: it is aboard until `command: eject` ejects it")),
         within(vector3("position", "m", "in the entity's body axes (x forward, y left, z up), [0, 0, 0] unless given; without `from` east, north, up"),
                -kFarthest_m, kFarthest_m),
         any("direction", "of ejection in the same axes: [x, y, z], or {azimuth, elevation}; down unless given"),
         withDefault(within(number("speed", "m/s", "of ejection"), 0.0, 500.0), "30 m/s"),
         map("sequence", "several of them, one after the other; they are called `<name>_0`, `<name>_1`, ..."),
         withDefault(within(number("intensity", "", "factor on the type's intensity; the cloud's area goes with it"), 1e-3, 1e3), "1"),
         atLeast(spectrum("spectrum", "W/(sr um)", "instead of the type's spectrum: radiant intensity standing still at sea level"), 0.0),
         within(above(number("burn_time", "s", "instead of the type's"), 0.0), 0.05, 600.0),
         within(above(number("mass", "kg", "instead of the type's", &FlareType::mass_kg), 0.0), 1e-3, 100.0),
         within(number("drag_area", "m2", "instead of the type's: drag coefficient times area", &FlareType::dragArea_m2), 0.0, 10.0),
         any("smoke", "`true`: as its type has it; `false`: none; or a smoke's name"), withDefault(boolean("light", "lights what is near it"), "true")}};
  }();
  return t;
}

const ParameterTable& flareDirection() {
  static const ParameterTable t{
      "direction of a flare",
      "In the axes of what ejects it.",
      {withDefault(within(number("azimuth", "rad", "clockwise from forward, seen from above: 90 deg is right"), -2 * kPi, 2 * kPi), "0 deg"),
       withDefault(within(number("elevation", "rad", "-90 deg is down"), -kPi / 2, kPi / 2), "-90 deg")}};
  return t;
}

const ParameterTable& flareSequence() {
  static const ParameterTable t{"sequence of flares",
                                "",
                                {required(integer("count", "how many", 1, 256)),
                                 within(number("interval", "s", "from each to the next; where commands eject them each is told by itself"), 0.0, 3600.0),
                                 withDefault(boolean("alternate", "every second goes to the other side: y of position and direction change sign"), "false")}};
  return t;
}

}  // namespace tables

void Builder::readFlares(const Record& scenario) {
  if (!scenario.given("flares")) return;
  std::size_t all = 0;
  for (const Value& v : scenario.value("flares").items) {
    const Record r(v, tables::flare());
    FlareType type = *findFlareType(r.text("type"));
    const bool several = r.given("sequence");
    if (several) checkUnique(r.value("name"), smokeNames_, "flare");  // its lights are called otherwise
    if (r.given("burn_time")) {
      const double factor = r.number("burn_time") / type.burn_s;
      type.burn_s *= factor;
      type.rise_s *= std::min(factor, 1.0);
      type.fall_s *= std::min(factor, 1.0);
    }
    r.fill(type);

    const std::string name = r.text("name");
    const double factor = r.number("intensity");
    Spectrum intensity = flareIntensity(type);
    double area = factor * flareArea_m2(type);
    if (r.given("spectrum")) {
      intensity = bounded(spectra_, r.value("spectrum"), "W/(sr um)", "spectrum of flare '" + name.substr(0, 60) + "'", 0.0, 1e12);
      area = factor * areaOf_m2(intensity, type.temperature_K);
      if (!(area > 0.0))
        throw UserError(r.where("spectrum"), "a flare's spectrum of nothing from 1 to 14 um", "one that has something there: the cloud's size follows from it",
                        "widen its table, or take a light for a lamp");
    }
    intensity = intensity * factor;
    const bool own = r.given("spectrum") || factor != 1.0;
    const int gas =
        fieldMaterial(own ? "flare '" + name + "'" : "flare " + std::string(type.name), std::string(type.source), [&] { return flareGas(intensity); });

    std::string smoke(type.smoke);
    double yield = type.smokeYield;
    if (const Value* asked = r.find("smoke")) {
      const std::string word = readText(*asked, "smoke");
      if (word == "false") smoke.clear();
      else if (word != "true") {
        smoke = word;
        yield = std::max(yield, type.smoke.empty() ? 0.8 : 0.0);
      } else if (smoke.empty())
        throw UserError(asked->where, "a flare of the type '" + std::string(type.name) + "' leaves no smoke to speak of", "'false', or a smoke's name",
                        "remove it");
    }
    const int smokeIs = smoke.empty() ? -1 : smokeMaterial(smoke, r.where("smoke"));

    const int carrier = r.given("from") ? entityNamed(r.value("from")) : -1;
    if (carrier < 0 && !r.given("position")) throw UserError(r.where(), "a flare from nowhere", "'from' (an entity), or a 'position'", "add 'from: <entity>'");
    const std::optional<double> firstAt_s = readEjection(r.value("time"));
    const bool onCommand = !firstAt_s;
    int count = 1;
    double interval_s = 0.0;
    bool alternate = false;
    if (several) {
      const Record sequence(r.value("sequence"), tables::flareSequence());
      count = static_cast<int>(sequence.integer("count"));
      if (onCommand && sequence.given("interval"))
        throw UserError(sequence.where("interval"), "an interval between flares that commands eject", "each ejected by its own command", "remove it");
      if (!onCommand && !sequence.given("interval"))
        throw UserError(sequence.where(), "a sequence without an interval", "the time from each to the next", "add 'interval: 0.2 s'");
      interval_s = onCommand ? 0.0 : sequence.number("interval");
      alternate = sequence.boolean("alternate");
    }
    const glm::dvec3 direction = readDirection(r), position = r.given("position") ? r.vector("position") : glm::dvec3(0.0);
    all += static_cast<std::size_t>(count);
    if (all > kMostFlares)
      throw UserError(r.where(several ? "sequence" : "name"), "more than " + std::to_string(kMostFlares) + " flares with these", "fewer", "lower 'count'");
    for (int k = 0; k < count; ++k) {
      const double time_s = firstAt_s.value_or(0.0) + k * interval_s;
      const glm::dvec3 side(1.0, alternate && k % 2 == 1 ? -1.0 : 1.0, 1.0);
      Value called = r.value("name");
      if (several) called.text += "_" + std::to_string(k);
      checkUnique(called, lightNames_, "light");
      Pose pose;
      glm::dvec3 velocity(0.0);
      if (carrier >= 0 && !onCommand) {
        if (!advance(simulation_, time_s).isThere(static_cast<std::size_t>(carrier)))
          throw UserError(r.where("from"),
                          "'" + r.text("from").substr(0, 60) + "' isn't there at " + briefNumber(time_s) + " s, when it should eject '" + called.text + "'",
                          "a time within its lifetime", "change 'time'");
        pose = poseOf(simulation_, carrier, time_s);
        velocity = velocityOf(simulation_, carrier, time_s);
      }
      FlightWorld world;
      world.frame = simulation_.frame;
      world.groundHeight_m = simulation_.frame.ground_m();
      world.coriolis = hasOrigin_;
      if (glm::length(simulation_.wind_m_s) > 0.0) world.wind = {{0.0, simulation_.wind_m_s}};
      const auto flyFrom = [type, world, from = side * position, push = r.number("speed") * (side * direction)](double at_s, const Pose& carriersPose,
                                                                                                                const glm::dvec3& itsVelocity) {
        FlareFlight flown = flyFlare(type, launchFrom(at_s, carriersPose, itsVelocity, from, push), world);
        return Ejected{std::make_shared<const Trajectory>(std::move(flown.path)), std::move(flown.level), flown.lit_s, flown.out_s};
      };
      Ejected flown;
      try {
        flown = flyFrom(time_s, pose, velocity);
      } catch (const FlightError& e) {
        throw UserError(r.where(), "flare '" + called.text + "' cannot fly: " + e.wrong, "drag that takes its speed in a millisecond or more",
                        "raise 'mass', or lower 'drag_area' or 'burn_time'");
      }
      const int store = onCommand ? static_cast<int>(simulation_.stores.size()) : -1;
      if (onCommand) {
        simulation_.stores.push_back({called.text, carrier, keepingLast(flyFrom), type.ignition_s, type.ignition_s + type.burn_s});
        flown = {};
      }

      FlareCloudOptions cloud;
      cloud.store = store;
      cloud.path = flown.path;
      cloud.level = flown.level;
      cloud.area_m2 = area;
      cloud.depth = type.depth;
      cloud.glow_s = type.glow_s;
      cloud.spread_m_s = type.spread_m_s;
      cloud.lit_s = flown.lit_s;
      cloud.wind_m_s = simulation_.wind_m_s;
      cloud.airWarmer_K = airWarmer_K();
      const auto source = std::make_shared<FlareCloud>(cloud);
      simulation_.fields.push_back({called.text, r.where(), {{"burning cloud", {{300.0, gas}}}}, source});

      if (r.boolean("light")) {
        PointLight light;
        light.name = called.text;
        light.intensity = intensity;
        light.radius_m = std::sqrt(area / kPi);
        light.visible = false;  // its cloud is
        light.store = store;
        if (!onCommand) {
          light.mount.motion = Motion(*flown.path);
          light.level = flown.level;
          light.lifetime = {flown.lit_s, flown.out_s};
        }
        simulation_.lights.push_back(std::move(light));
      }

      if (smokeIs < 0 || !(yield > 0.0)) continue;
      SmokeOptions o;
      o.store = store;
      o.path = flown.path;
      o.begin_s = flown.lit_s;
      o.end_s = flown.out_s;
      const double burnt = type.burntShare > 0.0 ? type.burntShare : 1.0;
      o.rate_kg_s = TimeCourse(type.mass_kg * burnt * yield / type.burn_s);
      o.radius_m = kOfCloud * source->radius_m();
      o.temperature_K = kSmoke_K;
      o.share = kSmokeShare;
      o.lifetime_s = kSmokeLifetime_s;
      o.mostPuffs = kSmokePuffs;
      o.wind_m_s = simulation_.wind_m_s;
      o.airWarmer_K = airWarmer_K();
      simulation_.fields.push_back({called.text + " smoke", r.where(), {{"smoke", {{300.0, smokeIs}}}}, std::make_shared<SmokeSource>(o)});
    }
  }
}

}  // namespace pitviper
