// Exhaust: jets of engines, motors and nozzles, and flows that a solver worked out.
#include "scenarios/reader/plumes.hpp"

#include <cmath>
#include <stdexcept>

#include "materials/fields/gas_levels.hpp"
#include "materials/fields/grid_field.hpp"
#include "materials/fields/jets.hpp"
#include "scenarios/reader/builder.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/scene/grid_import.hpp"
#include "sim/scene/mesh_axes.hpp"
#include "sim/scene/placement.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

std::vector<std::string> engineNames() {
  std::vector<std::string> names;
  for (const EnginePreset& p : enginePresets()) names.emplace_back(p.name);
  return names;
}

/// What a species is called among a field's gases.
const char* gasName(Species species) {
  switch (species) {
    case Species::CO2:
      return "CO2";
    case Species::H2O:
      return "H2O";
    case Species::CO:
      return "CO";
    case Species::Soot:
      return "soot";
    default:
      return "alumina";
  }
}

/// What leaves a nozzle that is written out. Errors: UserError for one that no species of ours leaves, or more than all.
NozzleFlow nozzleOf(const Record& r, double hottest_K) {
  NozzleFlow flow;
  r.fill(flow);
  if (flow.temperature_K > hottest_K)
    throw UserError(r.where("temperature"), "a nozzle of " + briefNumber(flow.temperature_K) + " K, hotter than the tables of its gases",
                    "at most " + briefNumber(hottest_K) + " K, where they end", "write the static temperature as it leaves, not that of the chamber");
  const Record s(r.value("species"), tables::plumeSpecies());
  s.fill(flow.gas);
  s.fill(flow);
  const double sum = flow.gas.co2 + flow.gas.h2o + flow.gas.co + flow.gas.oxygen;
  if (sum > 1.0) throw UserError(s.where(), "mole fractions that add up to " + briefNumber(sum), "at most 1: what is left is nitrogen", "lower them");
  if (flow.sootMassFraction + flow.aluminaMassFraction > 0.9)
    throw UserError(s.where(), "soot and alumina leave no gas", "together at most 0.9 of the mass", "lower them");
  if (!(sum - flow.gas.oxygen + flow.sootMassFraction + flow.aluminaMassFraction > 0.0))
    throw UserError(s.where(), "nothing in this exhaust emits", "at least one of co2, h2o, co, soot, alumina", "add 'co2: 0.05'");
  if (r.given("molecular_mass")) flow.gasMolarMass_kg_mol = 1e-3 * r.number("molecular_mass");
  return flow;
}

}  // namespace

namespace tables {

const ParameterTable& plume() {
  static const ParameterTable t = [] {
    std::string known;
    for (const EnginePreset& p : enginePresets()) known += (known.empty() ? "`" : "; `") + std::string(p.name) + "`: " + std::string(p.description);
    ParameterTable x{
        "plume",
        "Exhaust that emits and absorbs: turbulent free jets, matched to the air of the standard atmosphere at their height, drawn out by the flow past them. "
        "`engine`, `nozzle` or `grid`.",
        {required(text("name", "unique name")), text("on", "name of the entity whose nozzles these are; without it they stand in the local frame"),
         list("nozzles", "positions of several equal nozzles, instead of `position`", 1, JetsSource::kMostNozzles),
         withDefault(
             within(vector3("direction", "", "of the exhaust in the body's axes (x forward, y left, z up; without `on`: east, north, up); of any length",
                            &JetsSetup::direction),
                    -1e3, 1e3),
             "-1, 0, 0"),
         text("engine", "what leaves each nozzle, by name: " + known), map("nozzle", "what leaves each nozzle, written out"),
         map("grid", "instead of jets: a flow from a file"),
         withDefault(within(course("throttle", "",
                                   "0 to 1, or a course over the scenario's time. An engine idles at 0 (with afterburner: flies without it); a motor's is that "
                                   "of its own burn times this; of a written nozzle it is the part of its mass flow. At 0 a motor and a nozzle are out",
                                   &JetsSetup::throttle),
                            0.0, 1.0),
                     "1"),
         within(number("begin", "s",
                       "of a motor's burn and of what an engine gives; it comes within a tenth of a second. Without it a motor is lit as its body "
                       "comes, or at 0 s, and all others always run",
                       &Lifetime::begin_s),
                -kLongestTime_s, kLongestTime_s),
         within(number("end", "s", "it is gone a tenth of a second later", &Lifetime::end_s), -kLongestTime_s, kLongestTime_s),
         within(above(number("length", "m",
                             "that is drawn, at most, fading over its last fifth; unless given 200 diameters of its nozzle, or to where 1 % of it "
                             "is exhaust",
                             &JetsSetup::length_m),
                      0.0),
                0.01, 1e5)}};
    for (auto& own : positionParameters()) x.parameters.insert(x.parameters.begin() + 2, std::move(own));
    return x;
  }();
  return t;
}

const ParameterTable& plumeNozzle() {
  static const ParameterTable t{
      "nozzle",
      "What leaves a nozzle, at the pressure of the air around it.",
      {required(within(number("diameter", "m", "of the stream", &NozzleFlow::diameter_m), 1e-3, 100.0)),
       required(within(number("temperature", "K", "static, as it leaves", &NozzleFlow::temperature_K), 200.0, 1e4)),
       required(within(number("speed", "m/s", "against the nozzle", &NozzleFlow::speed_m_s), 1.0, 6000.0)), required(map("species", "what of it emits")),
       within(number("molecular_mass", "", "relative, of its gas (air: 28.96); of its species and nitrogen unless given"), 2.0, 200.0),
       within(number("specific_heat", "J/(kg K)", "of all that leaves, between the air's temperature and its own; of its gas unless given",
                     &NozzleFlow::specificHeat_J_kgK),
              100.0, 1e4)}};
  return t;
}

const ParameterTable& plumeGrid() {
  static const ParameterTable t{
      "grid",
      "A flow on a regular grid, from a file: it emits and absorbs by its temperature and gases, linear between nodes, and ends at the grid's border. It moves "
      "with "
      "the body it is `on`, does not change, and is there from `begin` to `end`.",
      {required(text("file", ".vti (VTK image data) or .vdb (OpenVDB)")),
       withDefault(within(number("unit", "m", "length of one unit of the file"), 1e-9, 1e9), "1 m"),
       withDefault(choice("forward", {"+x", "-x", "+y", "-y", "+z", "-z"}, "where the body's nose points in the axes of the file"), "+x"),
       withDefault(choice("up", {"+x", "-x", "+y", "-y", "+z", "-z"}, "where its upper side points"), "+z"), required(map("arrays", "names of its arrays")),
       withDefault(choice("gases", {"mole_fraction", "partial_pressure"}, "what arrays of gases hold: parts of `pressure`, or Pa"), "mole_fraction"),
       withDefault(within(number("pressure", "Pa", "of the gas, where fractions are given"), 0.0, 1e8), "101325 Pa"),
       withDefault(within(number("air_co2", "", "mole fraction in the air around, which the atmosphere has already: taken off"), 0.0, 1.0), "0.00042"),
       withDefault(within(number("air_h2o", "", "the same of water vapour"), 0.0, 1.0), "0")}};
  return t;
}

const ParameterTable& plumeArrays() {
  static const ParameterTable t{"arrays",
                                "Names of arrays in a grid's file; at least one gas.",
                                {required(text("temperature", "in K")), text("co2", "carbon dioxide"), text("h2o", "water vapour"),
                                 text("co", "carbon monoxide"), text("soot", "volume fraction"), text("alumina", "mass in a volume, kg/m3")}};
  return t;
}

const ParameterTable& plumeSpecies() {
  static const ParameterTable t{"species",
                                "Of a nozzle's exhaust. What is left of the gas is nitrogen.",
                                {within(number("co2", "", "mole fraction of its gas", &GasFractions::co2), 0.0, 1.0),
                                 within(number("h2o", "", "mole fraction of its gas", &GasFractions::h2o), 0.0, 1.0),
                                 within(number("co", "", "mole fraction of its gas", &GasFractions::co), 0.0, 1.0),
                                 within(number("oxygen", "", "mole fraction of its gas; it doesn't emit", &GasFractions::oxygen), 0.0, 1.0),
                                 within(number("soot", "", "part of all its mass", &NozzleFlow::sootMassFraction), 0.0, 0.9),
                                 within(number("alumina", "", "part of all its mass", &NozzleFlow::aluminaMassFraction), 0.0, 0.9)}};
  return t;
}

}  // namespace tables

FieldGas Builder::gasOf(Species species, double low_K, double high_K) {
  const auto [known, fresh] = gases_.try_emplace({static_cast<double>(species), low_K, high_K});
  FieldGas& gas = known->second;
  if (!fresh) return gas;
  const SpeciesTable& table = speciesTable(species, libraries_.materials);
  gas.name = gasName(species);
  for (const std::size_t level : gasLevels(table, low_K, high_K).level) {
    const double temperature_K = table.temperature_K[level];
    gas.levels.push_back({temperature_K, fieldMaterial(table.name + " at " + briefNumber(temperature_K) + " K", table.source, [&] {
                            Medium m;
                            m.absorption_per_m = table.absorption[level];
                            return m;
                          })});
  }
  return gas;
}

void Builder::whileThere(int entity, double& begin_s, double& end_s, const Record& r, const char* key, const char* shouldDo) const {
  if (entity >= 0) {
    const Lifetime there = lifetimeOf(simulation_, entity);
    begin_s = std::max(begin_s, there.begin_s), end_s = std::min(end_s, there.end_s);
  }
  if (!(end_s > begin_s))
    throw UserError(r.where(key), "'" + r.text(key).substr(0, 60) + "' isn't there while it should " + shouldDo, "times within its lifetime",
                    "change 'begin' and 'end', here or there");
}

void Builder::readJets(const Record& r, FieldBody& body) {
  const double hottest_K = speciesTable(Species::CO2, libraries_.materials).temperature_K.back();
  JetsSetup setup;
  if (r.given("engine")) {
    setup.engine = findEnginePreset(r.text("engine"));
    if (!setup.engine) throw unknownWord(r.where("engine"), "there is no engine", r.text("engine"), engineNames(), "or write 'nozzle' out");
  } else {
    setup.nozzle = nozzleOf(Record(r.value("nozzle"), tables::plumeNozzle()), hottest_K);
  }
  if (r.given("on")) setup.entity = entityNamed(r.value("on"));
  if (r.given("nozzles")) {
    for (const char* key : {"position", "geodetic"})
      if (r.given(key)) throw UserError(r.where(key), std::string("'nozzles' and a '") + key + "'", "one of the two", "remove one");
    setup.nozzles.clear();
    for (const Value& place : r.value("nozzles").items) setup.nozzles.push_back(readVector(place, "m", "the position of a nozzle"));
  } else {
    setup.nozzles = {readPosition(r, simulation_.frame).value_or(glm::dvec3(0.0))};
  }
  r.fill(setup);
  if (!(glm::length(setup.direction) > 1e-9))
    throw UserError(r.where("direction"), "an exhaust without a direction", "three numbers that are not all 0", "write 'direction: [-1, 0, 0]'");
  r.fill(setup.life);
  whileThere(setup.entity, setup.life.begin_s, setup.life.end_s, r, "on",
             "have a plume");  // a body that is not there has no exhaust; a motor is lit as its body comes
  setup.airWarmer_K = airWarmer_K();

  const auto source = std::make_shared<const JetsSource>(setup);
  try {  // at full throttle into still air: what is wrong with its figures shows now
    source->stateOf(JetsSource::Conditions{2000, 0, 0, 256});
  } catch (const std::exception& wrong) {
    throw UserError(r.given("nozzle") ? r.where("nozzle") : r.where(), std::string("this nozzle has no jet (") + wrong.what() + ")",
                    "figures of a jet into still air", "correct them");
  }
  const glm::dvec2 range_K = source->temperatures_K();
  for (const Species species : setup.species()) body.gases.push_back(gasOf(species, range_K.x, range_K.y));
  body.source = source;
}

void Builder::readGrid(const Record& r, FieldBody& body) {
  for (const char* key : {"nozzles", "direction", "throttle", "length"})
    if (r.given(key)) throw UserError(r.where(key), std::string("'") + key + "' of a grid", "of a grid: 'on', 'position', 'begin' and 'end'", "remove it");
  const Record g(r.value("grid"), tables::plumeGrid());
  const Record names(g.value("arrays"), tables::plumeArrays());
  struct Wanted {
    Species species;
    const char* key;
    double most;
  };
  const bool fractions = g.text("gases") == "mole_fraction";
  const double most = fractions ? 1.0 : 1e8;
  std::vector<Wanted> gases;
  std::vector<std::string> arrays{names.text("temperature")};
  for (const Wanted& w : {Wanted{Species::CO2, "co2", most},
                          {Species::H2O, "h2o", most},
                          {Species::CO, "co", most},
                          {Species::Soot, "soot", 1.0},
                          {Species::Alumina, "alumina", 1e4}})
    if (names.given(w.key)) {
      gases.push_back(w);
      arrays.push_back(names.text(w.key));
    }
  if (gases.empty())
    throw UserError(names.where(), "a grid of nothing that emits", "the array of at least one of co2, h2o, co, soot, alumina", "add 'co2: <its name>'");
  std::filesystem::path file = g.text("file");
  if (file.is_relative()) file = spectra_.files().base / file;
  const GridData data = importGrid(file, arrays, g.where("file"));
  const Location in{file.string()};
  const auto refuse = [&](std::size_t array, std::size_t node, const std::string& wrong, const std::string& expected) {
    throw UserError(in,
                    "array '" + arrays[array].substr(0, 60) + "' is " + briefNumber(static_cast<double>(data.arrays[array].values[node])) + wrong + " at " +
                        gridIndex(data, node),
                    expected, "correct the file, or the name under 'arrays'");
  };

  const double hottest_K = speciesTable(Species::CO2, libraries_.materials).temperature_K.back();
  auto flow = std::make_shared<GridFlow>();
  flow->nodes = data.nodes;
  flow->first = data.origin * g.number("unit");
  flow->spacing = data.spacing * g.number("unit");
  flow->temperature_K = data.arrays[0].values;
  for (std::size_t n = 0; n < flow->temperature_K.size(); ++n)
    if (const double t = static_cast<double>(flow->temperature_K[n]); t < 50.0 || t > hottest_K)
      refuse(0, n, " K", "50 to " + briefNumber(hottest_K) + " K, where the tables of gases end");
  for (std::size_t i = 0; i < gases.size(); ++i) {
    const Wanted& w = gases[i];
    const bool gas = w.species == Species::CO2 || w.species == Species::H2O || w.species == Species::CO;
    const double scale = !gas ? 1.0 : (fractions ? g.number("pressure") : 1.0) / 101325.0;
    const double air = w.species == Species::CO2 ? g.number("air_co2") : w.species == Species::H2O ? g.number("air_h2o") : 0.0;
    const double taken = fractions ? air : air * g.number("pressure");
    std::vector<float> values = data.arrays[i + 1].values;
    for (std::size_t n = 0; n < values.size(); ++n) {
      const double v = static_cast<double>(values[n]);
      if (v < 0.0 || v > w.most) refuse(i + 1, n, "", "0 to " + briefNumber(w.most));
      values[n] = static_cast<float>(std::max(v - taken, 0.0) * scale);
    }
    flow->perMetre.push_back(std::move(values));
  }

  GridSetup setup;
  setup.flow = flow;
  if (r.given("on")) setup.entity = entityNamed(r.value("on"));
  setup.position = readPosition(r, simulation_.frame).value_or(glm::dvec3(0.0));
  const glm::dvec3 forward(*axisNamed(g.text("forward"))), up(*axisNamed(g.text("up")));
  if (std::abs(glm::dot(forward, up)) > 0.5)
    throw UserError(g.where(g.given("up") ? "up" : "forward"), "a grid's 'forward' and 'up' point along the same axis", "two at right angles", "change one");
  setup.bodyFromGrid = glm::transpose(glm::dmat3(forward, glm::cross(up, forward), up));
  r.fill(setup.life);
  whileThere(setup.entity, setup.life.begin_s, setup.life.end_s, r, "on", "have a plume");
  const auto source = std::make_shared<const GridSource>(setup);
  const glm::dvec2 range_K = source->temperatures_K();
  for (const Wanted& w : gases) body.gases.push_back(gasOf(w.species, range_K.x, range_K.y));
  body.source = source;
}

void Builder::readPlumes(const Record& scenario) {
  if (!scenario.given("plumes")) return;
  for (const Value& v : scenario.value("plumes").items) {
    const Record r(v, tables::plume());
    checkUnique(r.value("name"), smokeNames_, "plume or smoke");
    const int kinds = r.given("engine") + r.given("nozzle") + r.given("grid");
    if (kinds == 0)
      throw UserError(r.where(), "a plume without a nozzle", "'engine' (by name), 'nozzle' (written out) or 'grid' (from a file)",
                      "add 'engine: turbofan_military', or 'nozzle: {diameter: 0.5 m, temperature: 900 K, speed: 400 m/s, species: {co2: 0.03, h2o: 0.03}}'");
    if (kinds > 1)
      throw UserError(r.where(r.given("grid") ? "grid" : "nozzle"), "a plume of several kinds", "one of 'engine', 'nozzle' and 'grid'", "remove the others");
    if (r.given("on") && r.given("geodetic"))
      throw UserError(r.where("geodetic"), "a geodetic position of a plume on a body", "'position' in the body's axes", "use 'position'");
    if (!r.given("on") && !r.given("position") && !r.given("geodetic") && !r.given("nozzles"))
      throw UserError(r.where(), "a plume from nowhere", "'on' (an entity), or a 'position' or 'geodetic'", "add 'on: <entity>'");
    if (r.given("begin") && r.given("end") && !(r.number("end") > r.number("begin")))
      throw UserError(r.where("end"), "a plume that ends before it begins", "an end after the begin", "exchange them");
    FieldBody body;
    body.name = r.text("name");
    body.where = r.where();
    if (r.given("grid")) readGrid(r, body);
    else readJets(r, body);
    simulation_.fields.push_back(std::move(body));
  }
}

}  // namespace pitviper
