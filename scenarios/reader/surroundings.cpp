// Origin, time, air, background, sun and ambient light.
#include <cmath>

#include "atmosphere/homogeneous.hpp"
#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"

namespace pitviper {
namespace {

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

}  // namespace

Builder::Builder(Simulation& simulation, std::filesystem::path base, Libraries libraries)
    : simulation_(simulation), libraries_(libraries), spectra_([&] {
        SpectrumFiles files;
        files.base = std::move(base);
        files.library = {libraries.sensors};
        files.loadYaml = [](const std::filesystem::path& p, const Location& at) { return loadYaml(p, at); };
        return files;
      }()) {}

void Builder::checkUnique(const Value& name, std::map<std::string, Location>& names, const char* what) {
  const auto [at, fresh] = names.emplace(name.text, name.where);
  if (!fresh)
    throw UserError(name.where, std::string("a second ") + what + " is called '" + name.text.substr(0, 60) + "'", "unique names (the first is at line " + std::to_string(at->second.line) + ")", "rename one");
  for (char c : name.text)
    if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'))
      throw UserError(name.where, std::string("the name of a ") + what + " holds the character '" + c + "'", "letters, digits, '_' and '-'", "rename it");
  if (name.text.size() > 64) throw UserError(name.where, std::string("the name of a ") + what + " is too long", "at most 64 characters", "shorten it");
}

Spectrum Builder::bounded(const Value& value, std::string_view unit, std::string_view name, double low, double high, Outside outside) {
  const Spectrum s = spectra_.read(value, unit, name, outside);
  const double from = std::max(s.validLow(), s.supportLow()), to = std::min(s.validHigh(), s.supportHigh());
  if (from <= to && (s.minimum(from, to) < low || s.maximum(from, to) > high))
    throw UserError(value.where, std::string(name) + " leaves its range (" + std::to_string(s.minimum(from, to)) + " to " + std::to_string(s.maximum(from, to)) + ")",
                    std::isfinite(high) ? "values from " + std::to_string(low) + " to " + std::to_string(high) : "values of at least 0", "correct its values");
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
  if (r.text("model") == "none") return;
  HomogeneousAir air;
  bool have = false;
  auto take = [&](const Record& from, const SpectrumReader& spectra) {
    if (from.given("extinction")) {
      air.extinction_per_m = spectra.read(from.value("extinction"), "1/m", "extinction");
      const Spectrum& s = air.extinction_per_m;
      if (s.minimum(std::max(s.validLow(), s.supportLow()), std::min(s.validHigh(), s.supportHigh())) < 0.0)
        throw UserError(from.where("extinction"), "extinction is negative somewhere", "at least 0 /km", "correct its values");
      have = true;
    }
    if (from.given("temperature")) air.temperature_K = from.number("temperature");
    if (from.given("radiance")) air.radiance = spectra.read(from.value("radiance"), "W/(m2 sr um)", "air radiance");
  };
  if (r.given("library")) {
    const std::string name = r.text("library");
    const auto file = libraries_.atmosphere / (name + ".yaml");
    std::error_code ignored;
    if (name.find('/') != std::string::npos || name.size() > 100 || !std::filesystem::is_regular_file(file, ignored)) {
      std::string near;
      const std::string all = libraryNames(libraries_.atmosphere, name, near);
      throw UserError(r.where("library"), "there is no library air '" + name.substr(0, 60) + "'", "one of " + all, near.empty() ? "choose one" : "did you mean '" + near + "'?");
    }
    const Value tree = loadYaml(file, r.where("library"));
    take(Record(tree, tables::airLibrary()), spectra_.in(libraries_.atmosphere));
  }
  take(r, spectra_);
  if (!have) throw UserError(r.where(), "homogeneous air without an extinction", "'extinction' or 'library'", "add 'extinction: 0.2 /km' or 'library: hazy_us76'");
  if (r.given("top")) air.top_m = r.number("top");
  simulation_.path = makeHomogeneousAir(std::move(air));
}

namespace {
/// A map with either temperature or radiance.
Spectrum blackOrGiven(const Record& r, const SpectrumReader& spectra, const char* what) {
  if (r.given("temperature") == r.given("radiance"))
    throw UserError(r.where(), std::string(what) + (r.given("radiance") ? " has a temperature and a radiance" : " has neither temperature nor radiance"), "one of the two",
                    r.given("radiance") ? "remove one" : "add 'temperature: 280 K'");
  if (r.given("temperature")) return Spectrum(Spectrum::BlackBody{r.number("temperature"), 1.0});
  return spectra.read(r.value("radiance"), "W/(m2 sr um)", what);
}
}  // namespace

void Builder::readBackground(const Record& scenario) {
  if (!scenario.given("background")) return;
  simulation_.background = blackOrGiven(Record(scenario.value("background"), tables::background()), spectra_, "background");
}

void Builder::readAmbient(const Record& scenario) {
  if (!scenario.given("ambient")) return;
  simulation_.ambient = blackOrGiven(Record(scenario.value("ambient"), tables::ambient()), spectra_, "ambient");
}

void Builder::readSun(const Record& scenario) {
  if (!scenario.given("sun")) return;
  const Record r(scenario.value("sun"), tables::sun());
  if (r.given("irradiance") == r.given("temperature"))
    throw UserError(r.where(), r.given("irradiance") ? "the sun has an irradiance and a temperature" : "the sun has neither irradiance nor temperature", "one of the two",
                    r.given("irradiance") ? "remove one" : "add 'temperature: 5772 K'");
  Sun sun;
  const double a = r.number("azimuth"), e = r.number("elevation");
  sun.toSun = {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
  sun.irradiance = r.given("temperature") ? Spectrum(Spectrum::BlackBody{r.number("temperature"), r.number("solid_angle")})
                                          : spectra_.read(r.value("irradiance"), "W/(m2 um)", "sun irradiance");
  simulation_.sun = std::move(sun);
}

}  // namespace pitviper
