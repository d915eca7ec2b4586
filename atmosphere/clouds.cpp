#include "atmosphere/clouds.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr const char *kDrops = "water_drops", *kCrystals = "ice_crystals";
/// Thinner ones than this have no inside.
constexpr double kThinnest_m = 10.0;
/// Where no cloud says how high rain and snow begin.
constexpr double kRainTop_m = 3000.0;
constexpr double kSnowRadius_um = 150.0, kSnowFall_m_s = 1.0, kIce_kg_m3 = 917.0;

struct CloudType {
  const char* name;
  const char* particles;
  double base_m, top_m, perKm, radius_um;
};
constexpr CloudType kTypes[] = {
    {"stratus", kDrops, 330.0, 1000.0, 56.9, 7.3},       {"stratocumulus", kDrops, 660.0, 2000.0, 38.7, 11.3},
    {"nimbostratus", kDrops, 160.0, 660.0, 92.0, 10.0},  {"altostratus", kDrops, 2400.0, 3000.0, 128.1, 10.0},
    {"cirrus", kCrystals, 10000.0, 11000.0, 0.14, 30.0},
};

std::vector<std::string> typeNames() {
  std::vector<std::string> all;
  for (const CloudType& t : kTypes) all.push_back(t.name);
  return all;
}

ParticleLayer cloudOf(const Record& r, const std::filesystem::path& library) {
  const std::string name = r.text("type");
  const CloudType& type = *std::find_if(std::begin(kTypes), std::end(kTypes), [&](const CloudType& t) { return t.name == name; });
  const auto given = [&](const char* key, double usual) { return r.given(key) ? r.number(key) : usual; };
  ParticleLayer own;
  own.low_m = given("base", type.base_m);
  // One that is moved is as deep as before.
  own.high_m = given("top", own.low_m + type.top_m - type.base_m);
  if (!(own.high_m >= own.low_m + kThinnest_m))
    throw UserError(r.given("top") ? r.where("top") : r.where("base"), print("a cloud from %g m to %g m", own.low_m, own.high_m),
                    "a top at least 10 m above its base",
                    r.given("base") ? "raise the top or lower the base" : print("raise the top, or add 'base', which is %g m of %s", type.base_m, type.name));
  const double thickness_km = 1e-3 * (own.high_m - own.low_m);
  own.perKm = r.given("optical_depth") ? r.number("optical_depth") / thickness_km : type.perKm;
  own.optics = dropsOf(type.particles, 1e6 * given("radius", 1e-6 * type.radius_um), library, r.where());
  return own;
}

}  // namespace

const ParameterTable& cloudTable() {
  static const ParameterTable t{
      "atmosphere: layered: cloud",
      "A layer of cloud over all of the sky. What is not given is the type's.",
      {required(choice("type", typeNames(),
                       "stratus 0.33 to 1 km, optical depth 38; stratocumulus 0.66 to 2 km, 52; nimbostratus 0.16 to 0.66 km, 46; altostratus 2.4 to 3 km, 77; "
                       "cirrus, of ice, 10 to 11 km, 0.14")),
       within(number("base", "m", "above the ground"), 0, 20e3), within(number("top", "m", "above the ground; as deep as the type unless given"), 0, 20e3),
       within(number("optical_depth", "", "from top to base at 0.55 um"), 1e-4, 1000),
       within(number("radius", "m", "effective radius of drops or crystals, the mean by area: 2 to 50 um of drops, 5 to 1000 um of crystals are usual"), 2e-6,
              1e-3)}};
  return t;
}

std::vector<Parameter> cloudParameters() {
  return {list("clouds", "layers of cloud, `atmosphere: layered: cloud`; of up to four kinds or radii, rain and snow among them", 0, 16),
          within(number("rain", "m/s", "rain, such as 5 mm/h, from the lowest cloud down, or from 3 km where there is none"), 0, 1e-4),
          within(number("snow", "m/s", "the same of snow, by the water in it"), 0, 1e-5)};
}

void addClouds(const AirRecord& air, AbsorberTable& table) {
  const Record& r = air.record;
  double lowest_m = INFINITY;
  if (r.given("clouds"))
    for (const Value& entry : r.value("clouds").items) {
      const Record own(entry, cloudTable());
      const ParticleLayer cloud = cloudOf(own, air.library);
      lowest_m = std::min(lowest_m, cloud.low_m);
      if (!(cloud.high_m < table.top_m()))
        throw UserError(own.where(), print("a cloud up to %g m in air that ends at %g m", cloud.high_m, table.top_m()), "a top within the air",
                        "lower the cloud");
      table.addLayer(cloud, own.where());
    }
  const double top_m = lowest_m < INFINITY ? lowest_m : kRainTop_m;
  const auto fall = [&](const char* key, const char* particles, double radius_um, double perKm) {
    if (!(top_m >= kThinnest_m))
      throw UserError(r.where(key), std::string("'") + key + "' out of a cloud that lies on the ground", "a cloud with a base above 10 m", "raise its base");
    table.addLayer({dropsOf(particles, radius_um, air.library, r.where(key)), 0.0, top_m, perKm}, r.where(key));
  };
  constexpr double kPerHour = 3.6e6;  // mm/h of 1 m/s
  if (r.given("rain") && r.number("rain") > 0.0) {
    const double rate = kPerHour * r.number("rain"), perMm = 4.1 * std::pow(rate, -0.21);
    fall("rain", kDrops, 1500.0 / perMm, 0.365 * std::pow(rate, 0.63));
  }
  if (r.given("snow") && r.number("snow") > 0.0)
    fall("snow", kCrystals, kSnowRadius_um, 1e3 * 1.5 * 1e3 * r.number("snow") / kSnowFall_m_s / (kIce_kg_m3 * 1e-6 * kSnowRadius_um));
}

}  // namespace pitviper
