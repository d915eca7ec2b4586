// Origin, time, air, background, sun and ambient light.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "atmosphere/homogeneous.hpp"
#include "atmosphere/layered.hpp"
#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/model/sky.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

/// Far below the end of a float, 3.4e38.
constexpr double kLargestFloatValue = 1e30;

/// What layered air is drawn with if nobody says; and the ends of what can be asked for: single precision and the tables' angles do 0.01 %.
constexpr double kUsualAccuracy = 0.01, kLeastAccuracy = 0.0005, kMostAccuracy = 0.2;

/// Of layered air: what its absorbers were fitted over is far within.
constexpr double kColdestAir_K = 100.0, kWarmestAir_K = 500.0;

/// Of limits: as far and as hot as a scenario's bodies can be.
constexpr double kFarthestRange_m = 1e9, kHottestBody_K = 1e5;

std::string libraryNames(const std::filesystem::path& folder, const std::string& word, std::string& nearest) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  nearest = nearestWord(word, names);
  std::string all;
  for (const auto& n : names) all += (all.empty() ? "" : ", ") + n;
  return all;
}

/// Two rising numbers above 0.
void readPair(const Record& r, const char* key, const char* unit, double most, const char* example, double& low, double& high) {
  if (!r.given(key)) return;
  const auto& ends = r.value(key).items;
  const std::string name = std::string(key) + " of limits", fix = "write '" + std::string(key) + ": " + example + "'";
  low = readNumber(ends[0], unit, name);
  high = readNumber(ends[1], unit, name);
  const std::string expected = "two rising values above 0, at most " + briefNumber(most) + " " + unit;
  for (const auto& [value, written] : {std::pair{low, ends[0]}, {high, ends[1]}})
    if (!(value > 0.0 && value <= most)) throw UserError(written.where, name + " has an end at " + written.text.substr(0, 40), expected, fix);
  if (!(low < high))
    throw UserError(r.where(key), name + " goes from " + ends[0].text.substr(0, 40) + " to " + ends[1].text.substr(0, 40), expected,
                    low > high ? "swap its ends" : fix);
}

}  // namespace

std::string briefNumber(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

Builder::Builder(Simulation& simulation, std::filesystem::path base, Libraries libraries)
    : simulation_(simulation), base_(base), libraries_(libraries), spectra_([&] {
        SpectrumFiles files;
        files.base = std::move(base);
        files.library = {libraries.sensors};
        files.loadYaml = [](const std::filesystem::path& p, const Location& at) { return loadYaml(p, at); };
        return files;
      }()) {}

void Builder::checkUnique(const Value& name, std::map<std::string, Location>& names, const char* what) {
  const auto [at, fresh] = names.emplace(name.text, name.where);
  if (!fresh)
    throw UserError(name.where, std::string("a second ") + what + " is called '" + name.text.substr(0, 60) + "'",
                    "unique names (the first is at line " + std::to_string(at->second.line) + ")", "rename one");
  for (char c : name.text)
    if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'))
      throw UserError(name.where, std::string("the name of a ") + what + " holds the character '" + c + "'", "letters, digits, '_' and '-'", "rename it");
  if (name.text.size() > 64) throw UserError(name.where, std::string("the name of a ") + what + " is too long", "at most 64 characters", "shorten it");
}

Spectrum Builder::bounded(const SpectrumReader& spectra, const Value& value, std::string_view unit, std::string_view name, double low, double high,
                          Outside outside) {
  Spectrum s = spectra.read(value, unit, name, outside);
  const double from = std::max(s.validLow(), s.supportLow()), to = std::min(s.validHigh(), s.supportHigh());
  if (from > to) return s;  // no wavelength at which it says anything: whoever asks it for a band is told so
  const double least = s.minimum(from, to), most = s.maximum(from, to);
  // Products of allowed factors can still be beyond a float; such a maximum is infinite or, from 0 x infinity, none at all.
  if (!(least >= low && most <= std::min(high, kLargestFloatValue) && std::isfinite(least) && std::isfinite(most)))
    throw UserError(value.where, std::string(name) + " leaves its range: it goes from " + briefNumber(least) + " to " + briefNumber(most),
                    std::isfinite(high) ? "values from " + briefNumber(low) + " to " + briefNumber(high) : "values of at least 0, at most 1e30",
                    "correct its values");
  return s;
}

void Builder::readOrigin(const Record& scenario) {
  if (!scenario.given("origin")) return;
  const Record r(scenario.value("origin"), tables::origin());
  simulation_.frame = LocalFrame({r.number("latitude"), r.number("longitude"), r.number("height")});
}

void Builder::readTime(const Record& scenario) {
  Value empty;
  empty.kind = Value::Kind::Map;
  empty.where = scenario.where();
  const Record r(scenario.given("time") ? scenario.value("time") : empty, tables::time());
  simulation_.time = {r.number("start"), 1.0 / r.number("rate"), static_cast<int>(r.integer("frames"))};
}

void Builder::readLimits(const Record& scenario) {
  if (!scenario.given("limits")) return;
  const Record r(scenario.value("limits"), tables::limits());
  Limits& limits = simulation_.limits;
  readPair(r, "range", "m", kFarthestRange_m, "[100 m, 20 km]", limits.nearest_m, limits.farthest_m);
  readPair(r, "temperature", "K", kHottestBody_K, "[250 K, 900 K]", limits.coldest_K, limits.hottest_K);
  if (r.given("light")) limits.lightLevel = r.number("light");
  if (!limits.any())
    throw UserError(r.where(), "limits without any", "'range', 'temperature' or 'light'", "write 'limits: {range: [100 m, 20 km]}', or remove 'limits'");
}

void Builder::readAccuracy(const Record& scenario) {
  if (!scenario.given("accuracy")) {
    accuracy_.accuracy = simulation_.path->isLayered() || simulation_.path->isTabulated() ? kUsualAccuracy : 0.0;
    return;
  }
  const Value& v = scenario.value("accuracy");
  if (v.text == "reference") {
    accuracy_.reference = true;
    return;
  }
  const auto q = v.kind == Value::Kind::Scalar ? splitQuantity(v.text) : std::nullopt;
  const auto share = q && !q->unit.empty() ? convert(*q, "") : std::nullopt;
  if (!share || !(*share >= kLeastAccuracy && *share <= kMostAccuracy))
    throw UserError(v.where, "accuracy '" + v.text.substr(0, 40) + "' is neither a share nor 'reference'", "0.05 % to 20 %, or 'reference'",
                    "write 'accuracy: 1 %'");
  accuracy_.accuracy = *share;
}

void Builder::readAtmosphere(const Record& scenario) {
  simulation_.path = makeNoAir();
  const Value* value = scenario.find("atmosphere");
  if (!value || (value->kind == Value::Kind::Scalar && value->text == "none")) return;
  Value named;
  if (value->kind == Value::Kind::Scalar) {
    named.kind = Value::Kind::Map;
    named.where = value->where;
    named.entries = {{"library", *value}};
    named.keyPlaces = {value->where};
    value = &named;
  }
  const Record r(*value, tables::atmosphere());
  if (r.text("model") == "none" || readTabulatedAir(r)) return;
  if (r.given("library") && r.given("table")) throw UserError(r.where("table"), "the air has a library name and a table", "one of the two", "remove one");
  std::optional<AbsorberTable> table;
  HomogeneousAir air;
  bool have = false;
  auto take = [&](const Record& from, const SpectrumReader& spectra, const std::filesystem::path& folder) {
    if (from.given("table")) table = readAirTable(from, folder);
    if (from.given("extinction")) {
      air.extinction_per_m = bounded(spectra, from.value("extinction"), "1/m", "extinction", 0.0, INFINITY);
      have = true;
    }
    if (from.given("temperature")) air.temperature_K = from.number("temperature");
    if (from.given("radiance")) air.radiance = bounded(spectra, from.value("radiance"), "W/(m2 sr um)", "air radiance", 0.0, INFINITY);
    if (table && from.given("visibility")) table->setVisibility(1e-3 * from.number("visibility"));
    if (table && from.given("aerosol")) from.text("aerosol") == "none" ? table->removeAerosol() : table->restoreAerosol();
  };
  if (r.given("library")) {
    const std::string name = r.text("library");
    const auto file = libraries_.atmosphere / (name + ".yaml");
    std::error_code ignored;
    if (name.find('/') != std::string::npos || name.size() > 100 || !std::filesystem::is_regular_file(file, ignored)) {
      std::string near;
      const std::string all = libraryNames(libraries_.atmosphere, name, near);
      throw UserError(r.where("library"), "there is no library air '" + name.substr(0, 60) + "'", "one of " + all,
                      near.empty() ? "choose one" : "did you mean '" + near + "'?");
    }
    const Value tree = loadYaml(file, r.where("library"));
    take(Record(tree, tables::airLibrary()), spectra_.in(libraries_.atmosphere), libraries_.atmosphere);
  }
  take(r, spectra_, base_);
  if (table) {
    for (const char* key : {"extinction", "radiance", "top"})
      if (r.given(key))
        throw UserError(r.where(key), std::string("'") + key + "' is of homogeneous air, and this air is layered: its table has it",
                        "'visibility', 'aerosol' or 'temperature', or homogeneous air",
                        std::string("remove '") + key + "', or give an extinction instead of the library air");
    if (air.temperature_K) {
      if (!(*air.temperature_K >= kColdestAir_K && *air.temperature_K <= kWarmestAir_K))
        throw UserError(r.given("temperature") ? r.where("temperature") : r.where(), "layered air at " + briefNumber(*air.temperature_K) + " K",
                        briefNumber(kColdestAir_K) + " to " + briefNumber(kWarmestAir_K) + " K", "correct the temperature, or describe homogeneous air");
      table->setTemperature(*air.temperature_K);
    }
    simulation_.path = makeLayeredAir(std::move(*table));
    return;
  }
  for (const char* key : {"visibility", "aerosol"})
    if (r.given(key))
      throw UserError(r.where(key), std::string("'") + key + "' is of layered air, and this air is homogeneous", "a library air or a table",
                      std::string("remove '") + key + "'");
  if (!have)
    throw UserError(r.where(), "air without an extinction, a table or a library name", "'library', 'table', 'extinction', 'tape7' or 'csv'",
                    "add 'library: hazy_us76' or 'extinction: 0.2 /km'");
  if (r.given("top")) air.top_m = r.number("top");
  homogeneousAir_K_ = air.temperature_K;
  simulation_.path = makeHomogeneousAir(std::move(air));
}

AbsorberTable Builder::readAirTable(const Record& r, const std::filesystem::path& folder) const {
  const std::filesystem::path file = folder / r.text("table");
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw UserError(r.where("table"), "there is no file '" + file.string() + "'", "an air table, its path relative to this file", "check the path");
  return AbsorberTable::read(file);
}

/// A map with either temperature or radiance.
Spectrum Builder::blackOrGiven(const Record& r, const char* what) const {
  if (r.given("temperature") == r.given("radiance"))
    throw UserError(r.where(), std::string(what) + (r.given("radiance") ? " has a temperature and a radiance" : " has neither temperature nor radiance"),
                    "one of the two", r.given("radiance") ? "remove one" : "add 'temperature: 280 K'");
  if (r.given("temperature")) return Spectrum(Spectrum::BlackBody{r.number("temperature"), 1.0});
  return bounded(spectra_, r.value("radiance"), "W/(m2 sr um)", what, 0.0, INFINITY);
}

void Builder::readBackground(const Record& scenario) {
  if (!scenario.given("background")) return;
  simulation_.background = blackOrGiven(Record(scenario.value("background"), tables::background()), "background");
}

void Builder::readGround(const Record& scenario) {
  const bool given = scenario.given("ground");
  if (!given && !simulation_.path->isLayered()) return;
  Value none;
  none.kind = Value::Kind::Map;
  none.where = scenario.where();
  const Record r(given ? scenario.value("ground") : none, tables::ground());
  Surface ground;
  if (r.given("material")) {
    ground.material = materialNamed(r.value("material"));
    const Material& m = simulation_.materialOf(ground);
    if (m.isTransparent() || m.hasModifiers())
      throw UserError(r.where("material"), "the ground's material '" + m.name + "' is " + (m.isTransparent() ? "transparent" : "textured"),
                      "an opaque material without textures", "choose another, or lay a body over the ground");
  } else {
    ground.material = static_cast<int>(simulation_.materials.size());
    auto black = std::make_shared<Material>();
    black->name = "black ground";
    simulation_.materials.push_back(std::move(black));
  }
  const auto air = simulation_.path->stationsAt({0.0, 1.0, simulation_.frame.earthRadius_m()}, std::array{0.0});
  ground.temperature_K = r.given("temperature") ? r.number("temperature") : homogeneousAir_K_ ? *homogeneousAir_K_ : air.front().temperature_K;
  if (!r.given("temperature") && !(ground.temperature_K > 0.0))
    throw UserError(r.where(), "a ground without a temperature, under air that has none", "a temperature", "add 'temperature: 288 K'");
  simulation_.ground = ground;
}

void Builder::readAmbient(const Record& scenario) {
  if (!scenario.given("ambient")) return;
  const Record r(scenario.value("ambient"), tables::ambient());
  if (!r.given("from")) {
    simulation_.ambient = blackOrGiven(r, "ambient");
    return;
  }
  for (const char* key : {"temperature", "radiance"})
    if (r.given(key)) throw UserError(r.where(key), "ambient light from the sky has its own radiance", "'from' alone", std::string("remove '") + key + "'");
  if (!simulation_.path->isLayered())
    throw UserError(r.where("from"), "ambient light from the sky needs layered air", "a library air or a table under 'atmosphere'",
                    "add 'atmosphere: hazy_us76', or give a temperature or radiance");
  try {
    simulation_.ambient = meanSky(simulation_.path, simulation_.sun, simulation_.background, 0.0, simulation_.frame.earthRadius_m());
  } catch (const OutsideSpectrum& e) {
    throw UserError(r.where("from"), std::string("the sky needs the sun and the background wherever the air has data: ") + e.what(),
                    "spectra from 0.4 to 14.2 um", "extend the table, or declare 'outside: hold' or 'outside: zero' if that is true");
  }
}

void Builder::readSun(const Record& scenario) {
  if (!scenario.given("sun")) return;
  const Record r(scenario.value("sun"), tables::sun());
  if (r.given("irradiance") == r.given("temperature"))
    throw UserError(r.where(), r.given("irradiance") ? "the sun has an irradiance and a temperature" : "the sun has neither irradiance nor temperature",
                    "one of the two", r.given("irradiance") ? "remove one" : "add 'temperature: 5772 K'");
  Sun sun;
  const double a = r.number("azimuth"), e = r.number("elevation");
  sun.toSun = {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
  sun.irradiance = r.given("temperature") ? Spectrum(Spectrum::BlackBody{r.number("temperature"), r.number("solid_angle")})
                                          : bounded(spectra_, r.value("irradiance"), "W/(m2 um)", "sun irradiance", 0.0, INFINITY);
  simulation_.sun = std::move(sun);
}

}  // namespace pitviper
