// Smoke that bodies or places let out.
#include "scenarios/reader/smokes.hpp"

#include <cmath>

#include "materials/fields/smoke.hpp"
#include "materials/fields/smoke_types.hpp"
#include "scenarios/reader/builder.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/scene/placement.hpp"

namespace pitviper {
namespace {

std::vector<std::string> smokeNames() {
  std::vector<std::string> names;
  for (const SmokeType& t : smokeTypes()) names.emplace_back(t.name);
  return names;
}

}  // namespace

namespace tables {

const ParameterTable& smoke() {
  static const ParameterTable t = [] {
    std::string known;
    for (const SmokeType& type : smokeTypes()) known += (known.empty() ? "`" : "; `") + std::string(type.name) + "`: " + std::string(type.description);
    ParameterTable x{
        "smoke",
        "A trail of soft puffs from a body or a place: they drift with the wind, are carried on by what blew them out, rise while they are hot, grow and thin "
        "out. "
        "A command that moves the body leaves its trail where the scenario has it.",
        {required(text("name", "unique name")), text("smoke", "what it is made of, by name: " + known),
         within(spectrum("extinction", "m2/kg", "instead of a name: extinction per mass of particles"), 0.0, 1e6),
         within(spectrum("albedo", "", "with `extinction`: the part of it that scatters; 0 unless given"), 0.0, 1.0),
         within(spectrum("asymmetry", "", "with `albedo`: mean cosine of the angle that it turns light by; 0 unless given"), -0.99, 0.99),
         text("from", "name of the entity that lets it out; without it, it stands at its position"),
         required(
             within(course("rate", "kg/s", "mass of particles let out: a number, or a course over the scenario's time", &SmokeOptions::rate_kg_s), 0.0, 1e4)),
         within(number("begin", "s", "from then on; the first frame's time unless given", &SmokeOptions::begin_s), -kLongestTime_s, kLongestTime_s),
         within(number("end", "s", "until then; for as long as the scenario runs unless given", &SmokeOptions::end_s), -kLongestTime_s, kLongestTime_s),
         withDefault(within(number("radius", "m", "of the stream as it leaves", &SmokeOptions::radius_m), 0.005, 500.0), "0.2 m"),
         within(number("temperature", "K", "as it leaves: hot smoke rises and glows until it has mixed; that of the air unless given",
                       &SmokeOptions::temperature_K),
                0.0, 4000.0),
         withDefault(within(vector3("velocity", "m/s", "that it is blown out with, in the body's axes (x forward, y left, z up): exhaust goes to -x",
                                    &SmokeOptions::blown_m_s),
                            -4000.0, 4000.0),
                     "0, 0, 0 m/s"),
         withDefault(within(number("share", "", "of the body's velocity through the air that it leaves with", &SmokeOptions::share), 0.0, 1.0), "0.1"),
         withDefault(boolean("rise", "hot smoke rises", &SmokeOptions::rises), "true"),
         withDefault(within(number("dissipation", "m2/s3",
                                   "of the air's turbulence, which small puffs grow by: 1e-5 in a calm night, 1e-3 by day, 1e-2 in wind close to the ground",
                                   &SmokeOptions::dissipation_m2_s3),
                            0.0, 10.0),
                     "1e-3 m2/s3"),
         withDefault(within(number("diffusivity", "m2/s", "of the air, which large puffs grow by", &SmokeOptions::diffusivity_m2_s), 0.0, 1e3), "5 m2/s"),
         withDefault(within(above(number("lifetime", "s", "of a puff, over whose last part it fades", &SmokeOptions::lifetime_s), 0.0), 0.1, 1e5), "60 s"),
         withDefault(within(number("fade", "", "share of the lifetime that it fades over", &SmokeOptions::fadeShare), 0.0, 1.0), "40 %"),
         withDefault(integer("puffs", "at most; a trail that needs more gets longer ones", 8, 2000, &SmokeOptions::mostPuffs), "400")}};
    for (auto& own : positionParameters()) x.parameters.push_back(std::move(own));
    return x;
  }();
  return t;
}

}  // namespace tables

int Builder::fieldMaterial(const std::string& name, const std::string& source, const std::function<Medium()>& make) {
  const auto [at, fresh] = fieldMaterials_.try_emplace(name, static_cast<int>(simulation_.materials.size()));
  if (fresh) {
    auto m = std::make_shared<Material>();
    m->name = name;
    m->provenance = source;
    m->medium = make();
    simulation_.materials.push_back(std::move(m));
  }
  return at->second;
}

int Builder::smokeMaterial(const std::string& name, const Location& where) {
  const SmokeType* type = findSmokeType(name);
  if (!type) throw unknownWord(where, "there is no smoke", name, smokeNames(), "choose one; 'smokes:' takes an 'extinction' of its own too");
  return fieldMaterial("smoke " + name, std::string(type->source), [&] { return smokeGas(*type); });
}

double Builder::airWarmer_K() const {
  const double ground_K = simulation_.air ? simulation_.air->groundTemperature_K() : 0.0;
  return ground_K > 0.0 ? ground_K - standardAir(0.0).temperature_K : 0.0;
}

void Builder::readSmokes(const Record& scenario) {
  if (!scenario.given("smokes")) return;
  for (const Value& v : scenario.value("smokes").items) {
    const Record r(v, tables::smoke());
    checkUnique(r.value("name"), smokeNames_, "smoke");
    FieldBody body;
    body.name = r.text("name");
    body.where = r.where();

    const bool own = r.given("extinction");
    if (own == r.given("smoke"))
      throw UserError(own ? r.where("extinction") : r.where(), own ? "a smoke by name and by its extinction" : "a smoke of nothing",
                      "'smoke', or 'extinction' (with 'albedo' and 'asymmetry')", own ? "remove one" : "add 'smoke: white_phosphorus'");
    for (const auto& [key, needs] : {std::pair{"albedo", "extinction"}, std::pair{"asymmetry", "albedo"}})
      if (r.given(key) && !r.given(needs))
        throw UserError(r.where(key), std::string("'") + key + "' without '" + needs + "'", "both, or neither", std::string("add '") + needs + ":'");
    int material = -1;
    if (own) {
      Medium gas;
      const auto read = [&](const char* key, const char* unit, double low, double high) {
        return bounded(spectra_, r.value(key), unit, std::string(key) + " of smoke '" + body.name + "'", low, high);
      };
      gas.absorption_per_m = read("extinction", "m2/kg", 0.0, 1e6);
      if (r.given("albedo")) gas.albedo = read("albedo", "", 0.0, 1.0);
      if (r.given("asymmetry")) gas.asymmetry = read("asymmetry", "", -0.99, 0.99);
      material = fieldMaterial("smoke of '" + body.name + "'", "", [&] { return gas; });
    } else {
      material = smokeMaterial(r.text("smoke"), r.where("smoke"));
    }

    SmokeOptions o;
    o.begin_s = simulation_.time.start_s, o.end_s = kLongestTime_s;
    r.fill(o);
    if (!(o.end_s > o.begin_s))
      throw UserError(r.where(r.given("end") ? "end" : "begin"), "smoke that ends before it begins",
                      "an end after the begin, which is at " + briefNumber(o.begin_s) + " s", "exchange them");
    if (r.given("from")) {
      o.entity = entityNamed(r.value("from"));
      if (r.given("geodetic"))
        throw UserError(r.where("geodetic"), "a geodetic position of smoke that a body lets out", "'position' in the body's axes", "use 'position'");
      whileThere(o.entity, o.begin_s, o.end_s, r, "from", "smoke");  // a body that is not there lets nothing out
    } else if (!r.given("position") && !r.given("geodetic")) {
      throw UserError(r.where(), "smoke from nowhere", "'from' (an entity), or a 'position' or 'geodetic'", "add 'from: <entity>'");
    }
    o.position = readPosition(r, simulation_.frame).value_or(glm::dvec3(0.0));
    o.wind_m_s = simulation_.wind_m_s;
    o.airWarmer_K = airWarmer_K();
    body.gases = {{"smoke", {{300.0, material}}}};
    body.source = std::make_shared<SmokeSource>(o);
    simulation_.fields.push_back(std::move(body));
  }
}

}  // namespace pitviper
