// Cumulus clouds: one, or a field of them.
#include "scenarios/reader/cumuli.hpp"

#include "atmosphere/aerosol_types.hpp"
#include "materials/fields/cloud_field.hpp"
#include "scenarios/reader/builder.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/scene/placement.hpp"

namespace pitviper {
namespace {

/// Clouds and nodes of a scenario at most: a node has 48 bytes, here and on the GPU.
constexpr std::size_t kMostClouds = 128;
constexpr double kMostNodes = 12e6;
/// Nodes across of what is narrower than the widest, at least.
constexpr int kFewestNodes = 16;

struct CumulusEntry {
  double width_m = 1500.0, depth_m = 0.0, roughness = 0.5, radius_m = 10e-6, opticalDepth = 0.0, temperature_K = 0.0;
  long long seed = 1;
  int resolution = 48;
};

}  // namespace

namespace tables {

const ParameterTable& cumulus() {
  static const ParameterTable t = [] {
    ParameterTable x{
        "cloud",
        "A cumulus cloud, or with `field` several: drops of water, lit by the sun, by the sky and by the ground (`ambient`). It stands still.",
        {required(text("name", "unique name")), withDefault(within(number("width", "m", "across its base", &CumulusEntry::width_m), 50.0, 6000.0), "1500 m"),
         within(number("depth", "m", "from its base to its top; 0.7 of its width, 2 km at most, unless given", &CumulusEntry::depth_m), 30.0, 6000.0),
         withDefault(integer("seed", "of its shape: another number is another cloud", 0, 1000000, &CumulusEntry::seed), "1"),
         withDefault(within(number("roughness", "", "0 smooth, 1 ragged", &CumulusEntry::roughness), 0.0, 1.0), "0.5"),
         withDefault(within(number("radius", "m", "effective, of its drops: by it their optics are found", &CumulusEntry::radius_m), 2e-6, 50e-6), "10 um"),
         within(number("optical_depth", "", "the largest vertical one, at 0.55 um; as much as adiabatic water makes of its shape unless given",
                       &CumulusEntry::opticalDepth),
                0.01, 500.0),
         within(number("temperature", "K", "of the drops at the base, from where it falls by 6.5 K/km; that of the air unless given",
                       &CumulusEntry::temperature_K),
                180.0, 330.0),
         withDefault(integer("resolution", "nodes of its grid across", kFewestNodes, 128, &CumulusEntry::resolution), "48"),
         map("field", "many of them around `position`, instead of `width` and `depth`")}};
    for (auto& own : positionParameters()) x.parameters.push_back(std::move(own));
    return x;
  }();
  return t;
}

const ParameterTable& cumulusFieldTable() {
  static const ParameterTable t{
      "cloud: field",
      "Clouds scattered over a square whose sides run east and north, their widths distributed as those of fair weather cumulus: many small ones, few large.",
      {required(within(number("cover", "", "share of the square that they cover, as seen from above", &CumulusFieldOptions::cover), 0.01, 0.6)),
       withDefault(within(number("side", "m", "of the square", &CumulusFieldOptions::side_m), 500.0, 50000.0), "10 km"),
       withDefault(within(number("narrowest", "m", "width", &CumulusFieldOptions::narrowest_m), 50.0, 5000.0), "400 m"),
       withDefault(within(number("widest", "m", "width", &CumulusFieldOptions::widest_m), 50.0, 6000.0), "2500 m"),
       withDefault(integer("shapes", "different clouds: each stands in several places", 1, 16, &CumulusFieldOptions::shapes), "6"),
       withDefault(integer("most", "clouds at most", 1, static_cast<long long>(kMostClouds), &CumulusFieldOptions::most), "48")}};
  return t;
}

}  // namespace tables

double Builder::airAt_K(const glm::dvec3& place) const {
  if (simulation_.air && simulation_.air->traits().variesAlongWay) {
    const double range[] = {0.0, 1.0};
    const auto stations = simulation_.air->stationsAt({simulation_.frame.height(place), 1.0, simulation_.frame.earthRadius_m()}, range);
    if (!stations.empty() && stations.front().temperature_K > 0.0) return stations.front().temperature_K;
  }
  return standardAir(simulation_.frame.altitude(place)).temperature_K + airWarmer_K();
}

void Builder::readCumuli(const Record& scenario) {
  if (!scenario.given("clouds")) return;
  constexpr double kLapse_K_m = 0.0065, kAspect = 0.7, kDeepest_m = 2000.0;
  const auto clouds = std::make_shared<CloudSet>(simulation_.sun ? std::optional(simulation_.sun->toSun) : std::nullopt, simulation_.shadows);
  double nodes = 0.0;
  for (const Value& v : scenario.value("clouds").items) {
    const Record r(v, tables::cumulus());
    checkUnique(r.value("name"), smokeNames_, "cloud, plume or smoke");
    CumulusEntry entry;
    r.fill(entry);
    const auto base = readPosition(r, simulation_.frame);
    if (!base) throw UserError(r.where(), "a cloud nowhere", "'position' or 'geodetic': the middle of its base", "add 'position: [0 m, 3000 m, 1000 m]'");

    CumulusField field;
    if (r.given("field")) {
      for (const char* key : {"width", "depth", "optical_depth"})
        if (r.given(key))
          throw UserError(r.where(key), std::string("'") + key + "' of a field of clouds", "'narrowest' and 'widest' under 'field'", "remove it");
      const Record f(r.value("field"), tables::cumulusFieldTable());
      CumulusFieldOptions o;
      f.fill(o);
      if (!(o.widest_m >= o.narrowest_m))
        throw UserError(f.where(f.given("widest") ? "widest" : "narrowest"), "clouds whose widest is narrower than the narrowest",
                        "'widest' at least " + briefNumber(o.narrowest_m) + " m", "exchange them");
      if (!(o.side_m >= o.widest_m))
        throw UserError(f.where(f.given("side") ? "side" : "widest"), "clouds wider than the square they stand in",
                        "'side' at least " + briefNumber(o.widest_m) + " m", "widen the square or narrow the clouds");
      o.roughness = entry.roughness, o.seed = static_cast<std::uint32_t>(entry.seed);
      field = cumulusField(o);
      if (field.clouds.empty())
        throw UserError(f.where("cover"), "so little cover that no cloud stands in it", "more of it", "raise 'cover', or narrow the clouds");
    } else {
      const double deep_m = r.given("depth") ? entry.depth_m : std::min(kAspect * entry.width_m, kDeepest_m);
      field.shapes.push_back({entry.width_m, deep_m, entry.roughness, static_cast<std::uint32_t>(entry.seed)});
      field.clouds.push_back({0, {0.0, 0.0}});
    }

    // Sky and ground are those of one height for all clouds of an entry: they share a gas, and what shines on it goes with it.
    double depth_m = 0.0;
    for (const CumulusShapeOptions& shape : field.shapes) depth_m += shape.depth_m / static_cast<double>(field.shapes.size());
    const double middle_m = simulation_.frame.height(*base + glm::dvec3(0.0, 0.0, 0.5 * depth_m));
    const AerosolOptics drops = dropsOf("water_drops", 1e6 * entry.radius_m, libraries_.atmosphere, r.where(r.given("radius") ? "radius" : "name"));
    const DropOptics optics{drops.wavelength_um, drops.extinction, drops.albedo, drops.asymmetry};
    const int material = fieldMaterial("drops of " + briefNumber(1e6 * entry.radius_m) + " um at " + briefNumber(middle_m) + " m",
                                       "water drops by Mie (atmosphere/library/aerosols/water_drops.csv)", [&] { return cloudGas(optics); });
    const Droplets droplets = dropletsOf(optics, middle_m);
    double widest_m = 0.0;
    for (const CumulusShapeOptions& s : field.shapes) widest_m = std::max(widest_m, s.width_m);
    std::vector<std::shared_ptr<const CloudBody>> bodies;
    for (const CumulusShapeOptions& s : field.shapes) {
      CloudBodyOptions o{s, std::max(static_cast<int>(std::lround(entry.resolution * std::sqrt(s.width_m / widest_m))), kFewestNodes), entry.opticalDepth};
      const double base_K = airAt_K(*base);
      o.base_K = r.given("temperature") ? entry.temperature_K : base_K;
      o.lapse_K_m = r.given("temperature") ? kLapse_K_m : (base_K - airAt_K(*base + glm::dvec3(0.0, 0.0, s.depth_m))) / s.depth_m;
      bodies.push_back(std::make_shared<const CloudBody>(o));
    }
    for (std::size_t k = 0; k < field.clouds.size(); ++k) {
      const CumulusField::Place& c = field.clouds[k];
      const auto shape = static_cast<std::size_t>(c.shape);
      const glm::ivec3 n = bodies[shape]->frame().nodes;
      nodes += static_cast<double>(n.x) * n.y * n.z;
      if (clouds->size() >= kMostClouds || nodes > kMostNodes)
        throw UserError(r.where(), "more clouds than a scenario may hold",
                        std::to_string(kMostClouds) + " clouds of " + briefNumber(kMostNodes) + " nodes in all", "lower 'resolution', 'most' or 'cover'");
      FieldBody body;
      body.name = r.text("name") + (r.given("field") ? " " + std::to_string(k + 1) : "");
      body.where = r.where();
      body.gases = {{"drops", {{300.0, material}}}};
      body.source = std::make_shared<CloudSource>(clouds, clouds->add(bodies[shape], *base + glm::dvec3(c.at, 0.0)), droplets);
      simulation_.fields.push_back(std::move(body));
      clouds->material = material;
    }
  }
  if (simulation_.shadows && simulation_.sun && simulation_.sun->toSun.z > 0.0) simulation_.sunShade = clouds;
}

}  // namespace pitviper
