// Materials, their components, and textures.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "materials/energy.hpp"
#include "materials/reflection.hpp"
#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/image/png.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// As many as one YAML file can hold.
constexpr std::size_t kMostTableValues = 400000;
/// Two angles that both depend on the light: up to 1.4 s to integrate over the hemisphere. Others take 3 ms and, with the most entries,
/// half a second.
constexpr std::size_t kMostAnglePairs = 65536;
constexpr std::size_t kMostTables = 64, kMostTableWavelengths = 1024;
/// Each Phong lobe takes about 10 ms to integrate over the hemisphere.
constexpr std::size_t kMostLobes = 256;
constexpr std::size_t kMostMaterials = 4096;
/// 160 MB of texels.
constexpr std::size_t kMostTexels = 40000000;

Angle angleNamed(const std::string& word) {
  if (word == "incidence") return Angle::Incidence;
  if (word == "view") return Angle::View;
  if (word == "specular") return Angle::Specular;
  if (word == "half") return Angle::Half;
  return Angle::Difference;
}

std::string percentAt(double sum, double wavelength_um, double angle_rad) {
  char text[80];
  std::snprintf(text, sizeof text, "%.4g %% at %.4g um and %.0f deg from the normal", 100.0 * sum, wavelength_um, angle_rad * 180.0 / kPi);
  return text;
}

/// What a table holds, for its messages.
struct TableKind {
  const char* name;
  const char* range;
  double most;
};
constexpr TableKind kBrdf{"a BRDF", "at least 0 per steradian", INFINITY}, kEmissivity{"an emissivity", "0 to 1", 1.0},
    kTransmittance{"a transmittance", "0 to 1", 1.0};
std::string aTable(const TableKind& kind) { return std::string(kind.name) + " table"; }

/// values[angle 2][angle 1][wavelength], with a nesting level left out for each missing axis.
void flatten(const Value& v, const TableKind& kind, const std::vector<size_t>& extents, size_t level, std::vector<double>& into) {
  if (level == extents.size()) {
    const double x = readNumber(v, "", "a value of " + aTable(kind));
    if (!(x >= 0.0 && x <= kind.most))
      throw UserError(v.where, std::string(kind.name) + " value is " + (x < 0.0 ? "negative" : "above 1"), kind.range, "correct the table");
    into.push_back(x);
    return;
  }
  if (v.kind != Value::Kind::List || v.items.size() != extents[level])
    throw UserError(v.where, "a level of " + aTable(kind) + " has " + std::to_string(v.kind == Value::Kind::List ? v.items.size() : 0) + " entries",
                    std::to_string(extents[level]) + ", as its axis says", "fill the hole or change 'count'");
  for (const Value& item : v.items) flatten(item, kind, extents, level + 1, into);
}

/// Rising wavelengths [um] of a table.
std::vector<double> readWavelengths(const Value& list, const TableKind& kind) {
  std::vector<double> all;
  for (const Value& w : list.items) {
    const double x = onAxis(readNumber(w, "um", "wavelength"));
    if (x < kShortestWavelength_um || x > kLongestWavelength_um || (!all.empty() && x <= all.back()))
      throw UserError(w.where, "the wavelengths of " + aTable(kind) + " do not rise or leave the spectral axis", "rising, within 0.1 to 1000 um", "sort them");
    all.push_back(x);
  }
  return all;
}

AngleAxis readAxis(const Value& value) {
  const Record axis(value, tables::tableAxis());
  return {angleNamed(axis.text("angle")), static_cast<int>(axis.integer("count")), axis.number("last")};
}

std::vector<double> readValues(const Record& r, const TableKind& kind, const std::vector<size_t>& extents) {
  size_t total = 1;
  for (size_t e : extents) total *= e;
  if (total > kMostTableValues)
    throw UserError(r.where("values"), aTable(kind) + " of " + std::to_string(total) + " values", "at most " + std::to_string(kMostTableValues), "thin it out");
  std::vector<double> values;
  flatten(r.value("values"), kind, extents, 0, values);
  return values;
}

std::shared_ptr<const ReflectionComponent> readTable(const Record& r) {
  BrdfTable t;
  for (const char* key : {"wavelength", "values"})
    if (!r.given(key)) throw UserError(r.where(), std::string("a BRDF table without '") + key + "'", "'wavelength', 'angles' and 'values'", "add it");
  t.wavelength_um = readWavelengths(r.value("wavelength"), kBrdf);
  std::vector<size_t> extents{t.wavelength_um.size()};
  if (r.given("angles")) {
    size_t k = 0;
    for (const Value& a : r.value("angles").items) {
      t.axes[k] = readAxis(a);
      extents.insert(extents.begin(), static_cast<size_t>(t.axes[k++].count));
    }
    if (k == 2 && t.axes[0].angle == t.axes[1].angle) throw UserError(r.where("angles"), "both axes are the same angle", "two different angles", "change one");
  }
  const auto ofLight = [](const AngleAxis& a) { return a.angle != Angle::None && a.angle != Angle::View; };
  const auto pairs = static_cast<std::size_t>(t.axes[0].count) * static_cast<std::size_t>(t.axes[1].count);
  if (ofLight(t.axes[0]) && ofLight(t.axes[1]) && pairs > kMostAnglePairs)
    throw UserError(r.where("angles"), "a BRDF table over " + std::to_string(pairs) + " pairs of angles", "at most " + std::to_string(kMostAnglePairs),
                    "thin it out");
  t.values = readValues(r, kBrdf, extents);
  return makeTabulated(std::move(t));
}

ViewTable readViewTable(const Record& r, const TableKind& kind) {
  ViewTable t;
  t.wavelength_um = readWavelengths(r.value("wavelength"), kind);
  t.view = readAxis(r.value("angles").items.front());
  if (t.view.angle != Angle::View)
    throw UserError(r.where("angles"), aTable(kind) + " over an angle that is not the view angle", "'angles: [{angle: view, count: 3, last: 90 deg}]'",
                    "no light takes part in it: only 'view' is left");
  t.values = readValues(r, kind, {static_cast<size_t>(t.view.count), t.wavelength_um.size()});
  return t;
}

/// Rows [angle, factor].
void readAngular(const Value& rows, ViewSpectrum& v) {
  for (const Value& row : rows.items) {
    if (row.kind != Value::Kind::List || row.items.size() != 2) throw UserError(row.where, "not a row [angle, factor]", "[60 deg, 0.9]", "write two values");
    const double angle = readNumber(row.items[0], "rad", "view angle"), factor = readNumber(row.items[1], "", "factor");
    if (angle < 0.0 || angle > 1.5709 || factor < 0.0 || (!v.viewAngle_rad.empty() && angle <= v.viewAngle_rad.back()))
      throw UserError(row.where, "view angles must rise within 0 to 90 deg, factors must not be negative", "rising angles", "correct the row");
    v.viewAngle_rad.push_back(angle);
    v.factor.push_back(factor);
  }
}

}  // namespace

int Builder::readTexture(const Value& value, std::string_view unit, std::string_view name, double lowest, double highest) {
  const Record r(value, tables::texture());
  if (r.given("file") == r.given("rows"))
    throw UserError(r.where(), std::string("the texture of ") + std::string(name) + (r.given("file") ? " has a file and rows" : " has neither file nor rows"),
                    "one of the two", "add or remove one");
  Texture t;
  t.repeats = r.text("edges") == "repeat";
  for (const char* key : {"minimum", "maximum"})
    if (r.given("rows") && r.given(key)) throw UserError(r.where(key), std::string("a '") + key + "' beside rows", "rows carry their own values", "remove it");
  auto quantity = [&](const char* key, double otherwise) { return r.given(key) ? readNumber(r.value(key), unit, key) : otherwise; };
  if (r.given("file")) {
    if (!unit.empty() && !(r.given("minimum") && r.given("maximum")))
      throw UserError(r.where(), "a texture of " + std::string(name) + " without 'minimum' and 'maximum'",
                      "what black and white stand for, in " + std::string(unit), "add both");
    std::filesystem::path path = r.text("file");
    if (path.is_relative()) path = spectra_.files().base / path;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
      throw UserError(r.where("file"), "cannot read the file '" + path.string() + "'", "a grey PNG", "check the name; it is relative to the scenario's folder");
    const GreyImage image = readPngGrey(path);
    const double low = quantity("minimum", 0.0), high = quantity("maximum", 1.0);
    t.name = path.string();
    t.width = image.width;
    t.height = image.height;
    t.texels.resize(image.pixels.size());
    for (int y = 0; y < t.height; ++y)
      for (int x = 0; x < t.width; ++x)
        t.texels[static_cast<size_t>(t.height - 1 - y) * static_cast<size_t>(t.width) + static_cast<size_t>(x)] = static_cast<float>(
            low + (high - low) * static_cast<double>(image.pixels[static_cast<size_t>(y) * static_cast<size_t>(t.width) + static_cast<size_t>(x)]));
  } else {
    const auto& rows = r.value("rows").items;
    t.height = static_cast<int>(rows.size());
    t.width = rows.front().kind == Value::Kind::List ? static_cast<int>(rows.front().items.size()) : 0;
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
      asList(*row, "texture row");
      if (row->items.empty() || static_cast<int>(row->items.size()) != t.width || t.width > 16384)
        throw UserError(row->where, "a texture row has " + std::to_string(row->items.size()) + " entries",
                        "as many as the first row (" + std::to_string(t.width) + "), 1 to 16384", "make the rows equally long");
      for (const Value& x : row->items) t.texels.push_back(static_cast<float>(readNumber(x, unit, "texture value")));
    }
  }
  for (float x : t.texels)
    if (!(static_cast<double>(x) >= lowest && static_cast<double>(x) <= highest))
      throw UserError(r.where(), "the texture of " + std::string(name) + " holds " + briefNumber(static_cast<double>(x)),
                      briefNumber(lowest) + " to " + briefNumber(highest) + (unit.empty() ? "" : " " + std::string(unit)),
                      "correct its values, or 'minimum' and 'maximum'");
  std::size_t texels = t.texels.size();
  for (const Texture& other : simulation_.textures) texels += other.texels.size();
  if (texels > kMostTexels)
    throw UserError(r.where(), "the textures of this scenario have more than " + std::to_string(kMostTexels) + " pixels together", "fewer",
                    "make them smaller");
  simulation_.textures.push_back(std::move(t));
  return static_cast<int>(simulation_.textures.size()) - 1;
}

void Builder::countTable(const Record& component) {
  brdfWavelengths_ += component.value("wavelength").items.size();
  if (++brdfTables_ > kMostTables || brdfWavelengths_ > kMostTableWavelengths)
    throw UserError(component.where(),
                    "more than " + std::to_string(kMostTables) + " BRDF tables, or " + std::to_string(kMostTableWavelengths) + " wavelengths in them together",
                    "fewer", "share materials, or thin the tables out");
}

ViewSpectrum Builder::readViewSpectrum(const Record& r, const char* what, const std::string& material, const SpectrumReader& spectra) {
  ViewSpectrum v;
  const std::string parent = std::string(what) == "emissivity" ? "an emission" : "a transmission", article = std::string(what) == "emissivity" ? "an " : "a ";
  const bool table = r.given("wavelength") || r.given("angles") || r.given("values");
  if (table == (r.given(what) || r.given("angular")))
    throw UserError(r.where(), table ? parent + " that is both a spectrum and a table" : parent + " without " + article + what,
                    std::string("'") + what + "' (and 'angular'), or 'wavelength', 'angles' and 'values'",
                    table ? "keep one of the two" : std::string("add '") + what + ": 0.9', a spectrum, or a table");
  if (table) {
    for (const char* key : {"wavelength", "angles", "values"})
      if (!r.given(key)) throw UserError(r.where(), article + what + " table without '" + key + "'", "'wavelength', 'angles' and 'values'", "add it");
    v.table = readViewTable(r, std::string(what) == "emissivity" ? kEmissivity : kTransmittance);
  } else if (!r.given(what)) {
    throw UserError(r.where(), parent + " with 'angular' but without '" + what + "'", "both", std::string("add '") + what + ": 0.9' or a spectrum");
  } else {
    v.spectrum = bounded(spectra, r.value(what), "", std::string(what) + " of material '" + material.substr(0, 60) + "'", 0.0, 1.0);
  }
  if (r.given("angular")) readAngular(r.value("angular"), v);
  if (r.given("modifier")) v.modifier = readTexture(r.value("modifier"), "", "a modifier", 0.0, 1.0);
  return v;
}

void Builder::readMedium(const Record& r, Material& m, const SpectrumReader& spectra) const {
  if (!r.given("absorption")) {
    if (r.given("radiance"))
      throw UserError(r.where("radiance"), "a material with 'radiance' that is no medium", "'absorption' beside it, or no 'radiance'",
                      "add 'absorption: 0.1 /m', or remove it");
    return;
  }
  for (const char* key : {"components", "emission", "transmission"})
    if (r.given(key))
      throw UserError(r.where(key), std::string("a medium with '") + key + "'", "a surface, or a medium ('absorption' and 'radiance')",
                      "remove it, or 'absorption'; a body with both is two entities");
  Medium medium;
  medium.absorption_per_m = bounded(spectra, r.value("absorption"), "1/m", "absorption coefficient of material '" + m.name.substr(0, 60) + "'", 0.0, 1e9);
  if (r.given("radiance"))
    medium.radiance = bounded(spectra, r.value("radiance"), "W/(m2 sr um)", "radiance of material '" + m.name.substr(0, 60) + "'", 0.0, INFINITY);
  m.medium = std::move(medium);
}

std::shared_ptr<const Material> Builder::readMaterial(const Value& value, const std::string& name, const SpectrumReader& spectra) {
  const Record r(value, tables::material());
  if (simulation_.materials.size() >= kMostMaterials)
    throw UserError(value.where, "more than " + std::to_string(kMostMaterials) + " materials", "fewer",
                    "give alike materials a name under 'materials:' and use it more than once");
  auto m = std::make_shared<Material>();
  m->name = name;
  m->where = value.where;
  if (r.given("source")) m->provenance = r.text("source");
  auto fraction = [&](const Value& v, const char* what) {
    return bounded(spectra, v, "", std::string(what) + " of material '" + name.substr(0, 60) + "'", 0.0, 1.0);
  };
  if (r.given("components"))
    for (const Value& c : r.value("components").items) {
      const Record k(c, tables::component());
      const std::string kind = k.text("reflection");
      if (kind != "table" && !k.given("reflectance"))
        throw UserError(k.where(), "a " + kind + " component without a reflectance", "'reflectance: 0.3' or a spectrum", "add it");
      if (kind == "phong" && !k.given("exponent")) throw UserError(k.where(), "a phong component without an exponent", "'exponent: 50'", "add it");
      if (kind == "table") {
        m->reflections.push_back(readTable(k));
        countTable(k);
      } else if (kind == "phong" && ++phongLobes_ > kMostLobes)
        throw UserError(k.where(), "more than " + std::to_string(kMostLobes) + " Phong lobes in the scenario", "fewer",
                        "give alike materials one name under 'materials:'");
      else if (kind == "phong") m->reflections.push_back(makePhong(fraction(k.value("reflectance"), "reflectance"), k.number("exponent")));
      else m->reflections.push_back(makeLambertian(fraction(k.value("reflectance"), "reflectance")));
      m->modifiers.push_back(k.given("modifier") ? readTexture(k.value("modifier"), "", "a modifier", 0.0, 1.0) : -1);
    }
  if (r.given("emission")) m->given = readViewSpectrum(Record(r.value("emission"), tables::emission()), "emissivity", name, spectra);
  if (r.given("transmission")) m->transmission = readViewSpectrum(Record(r.value("transmission"), tables::transmission()), "transmittance", name, spectra);
  readMedium(r, *m, spectra);
  if (const auto excess = energyExcess(*m, simulation_.textures))
    throw UserError(value.where,
                    "material '" + name + "' reflects" +
                        (m->transmission ? m->given ? ", transmits and emits" : " and transmits"
                         : m->given      ? " and emits"
                                         : "") +
                        " more than it receives (" + percentAt(excess->sum, excess->wavelength_um, excess->viewAngle_rad) + ")",
                    std::string(m->given || m->transmission ? "reflectance" : "the sum of its reflectances") + (m->transmission ? " + transmittance" : "") +
                        (m->given ? " + emissivity" : "") + " <= 1, at every wavelength, view angle and texel",
                    "lower a component");
  return m;
}

void Builder::readMaterials(const Record& scenario) {
  if (!scenario.given("materials")) return;
  const Value& map = scenario.value("materials");
  for (size_t i = 0; i < map.entries.size(); ++i) {
    const auto& [name, value] = map.entries[i];
    if (!materialValues_.emplace(name, &value).second)
      throw UserError(map.keyPlaces[i], "a second material is called '" + name.substr(0, 60) + "'", "unique names", "rename one");
    // Built even where no entity uses it: its mistakes are mistakes all the same.
    materialIndex_[name] = static_cast<int>(simulation_.materials.size());
    simulation_.materials.push_back(readMaterial(value, name, spectra_));
  }
}

int Builder::materialNamed(const Value& asked) {
  if (asked.kind == Value::Kind::Map) {
    simulation_.materials.push_back(readMaterial(asked, "at line " + std::to_string(asked.where.line), spectra_));
    return static_cast<int>(simulation_.materials.size()) - 1;
  }
  const std::string name = readText(asked, "material");
  if (const auto known = materialIndex_.find(name); known != materialIndex_.end()) return known->second;
  const auto file = libraries_.materials / (name + ".yaml");
  std::error_code ignored;
  if (name.find('/') != std::string::npos || name.size() > 100 || !std::filesystem::is_regular_file(file, ignored)) {
    std::vector<std::string> names;
    for (const auto& [n, i] : materialIndex_) names.push_back(n);
    for (const auto& entry : std::filesystem::directory_iterator(libraries_.materials, ignored))
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const std::string near = nearestWord(name, names);
    std::string all;
    for (const auto& n : names) all += (all.empty() ? "" : ", ") + n;
    throw UserError(asked.where, "there is no material '" + name.substr(0, 60) + "'", "one of " + all,
                    near.empty() ? "define it under 'materials:'" : "did you mean '" + near + "'?");
  }
  const Value tree = loadYaml(file, asked.where);
  simulation_.materials.push_back(readMaterial(tree, name, spectra_.in(libraries_.materials)));
  return materialIndex_[name] = static_cast<int>(simulation_.materials.size()) - 1;
}

}  // namespace pitviper
