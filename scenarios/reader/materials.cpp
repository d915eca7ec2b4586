// Materials, their components, and textures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "materials/angle_tables.hpp"
#include "materials/energy.hpp"
#include "materials/models.hpp"
#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/image/exr.hpp"
#include "sim/image/png.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kMostMaterials = 4096;
/// 160 MB of texels.
constexpr std::size_t kMostTexels = 40000000;

std::string percentAt(double sum, double wavelength_um, double angle_rad) {
  return print("%.4g %% at %.4g um and %.0f deg from the normal", 100.0 * sum, wavelength_um, angle_rad * 180.0 / kPi);
}

constexpr AngleTableKind kEmissivity{"an emissivity", "0 to 1", 1.0}, kTransmittance{"a transmittance", "0 to 1", 1.0};

ViewTable readViewTable(const Record& r, const AngleTableKind& kind) {
  ViewTable t;
  t.wavelength_um = readTableWavelengths(r.value("wavelength"), kind);
  t.view = readAngleAxis(r.value("angles").items.front());
  if (t.view.angle != Angle::View)
    throw UserError(r.where("angles"), aTable(kind) + " over an angle that is not the view angle", "'angles: [{angle: view, count: 3, last: 90 deg}]'",
                    "no light takes part in it: only 'view' is left");
  t.values = readTableValues(r, kind, {static_cast<size_t>(t.view.count), t.wavelength_um.size()});
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
  std::filesystem::path path = r.given("file") ? std::filesystem::path(r.text("file")) : std::filesystem::path();
  if (path.is_relative() && !path.empty()) path = spectra_.files().base / path;
  const bool exr = path.extension() == ".exr";
  std::error_code ignored;
  if (!path.empty() && !std::filesystem::is_regular_file(path, ignored))
    throw UserError(r.where("file"), "cannot read the file '" + path.string() + "'", "a grey PNG or an EXR",
                    "check the name; it is relative to the scenario's folder");
  for (const char* key : {"minimum", "maximum"})
    if (exr && r.given(key)) throw UserError(r.where(key), std::string("a '") + key + "' of an EXR file", "its own values", "remove it");
  if (r.given("layer") && !exr) throw UserError(r.where("layer"), "a 'layer' of what is no EXR file", "an EXR file", "remove it");
  if (exr) {
    const ExrImage image = readExr(path);
    const FloatLayer* layer = r.given("layer") ? image.find(r.text("layer")) : image.layers.size() == 1 ? &image.layers.front() : nullptr;
    if (!layer) {
      std::vector<std::string> names;
      for (const FloatLayer& l : image.layers) names.push_back(l.name);
      if (r.given("layer")) throw unknownWord(r.where("layer"), "the file has no layer", r.text("layer"), names);
      throw UserError(r.where("file"), "an EXR file of " + std::to_string(names.size()) + " layers", "'layer: ...', one of " + listed(names), "add it");
    }
    if (image.held && !unit.empty())
      throw UserError(r.where("file"),
                      "'" + path.string() + "' has only a part of its picture, columns " + std::to_string(image.held->left) + " to " +
                          std::to_string(image.held->right - 1) + " and rows " + std::to_string(image.held->top) + " to " +
                          std::to_string(image.held->bottom - 1) + " of " + std::to_string(image.width) + " x " + std::to_string(image.height),
                      "a value of " + std::string(name) + " everywhere: the data window as large as the display window",
                      "write the whole picture, or make the display window that of the data");
    t.name = path.string();
    t.width = image.width;
    t.height = image.height;
    t.texels.reserve(layer->pixels.size());
    // Row 0 of a texture is its lowest.
    for (int y = t.height - 1; y >= 0; --y)
      t.texels.insert(t.texels.end(), layer->pixels.begin() + static_cast<std::ptrdiff_t>(y) * t.width,
                      layer->pixels.begin() + static_cast<std::ptrdiff_t>(y + 1) * t.width);
  } else if (r.given("file")) {
    if (!unit.empty() && !(r.given("minimum") && r.given("maximum")))
      throw UserError(r.where(), "a texture of " + std::string(name) + " without 'minimum' and 'maximum'",
                      "what black and white stand for, in " + std::string(unit), "add both");
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
  const auto wrong =
      std::find_if(t.texels.begin(), t.texels.end(), [&](float x) { return !(static_cast<double>(x) >= lowest && static_cast<double>(x) <= highest); });
  if (const auto at = static_cast<int>(wrong - t.texels.begin()); wrong != t.texels.end())
    throw UserError(r.where(),
                    "the texture of " + std::string(name) + " holds " + briefNumber(static_cast<double>(*wrong)) + " at column " +
                        std::to_string(at % t.width) + ", row " + std::to_string(t.height - 1 - at / t.width),
                    briefNumber(lowest) + " to " + briefNumber(highest) + (unit.empty() ? "" : " " + std::string(unit)),
                    "correct its values, or 'minimum' and 'maximum'");
  std::size_t texels = t.texels.size();
  for (const Texture& other : simulation_.textures) texels += other.texels.size();
  if (texels > kMostTexels)
    throw UserError(r.where(), "the textures of this scenario have more than " + std::to_string(kMostTexels) + " pixels together", "fewer",
                    "make them smaller");
  if (unit != "m") makeLevels(t, unit == "K");  // heights become a mesh
  simulation_.textures.push_back(std::move(t));
  return static_cast<int>(simulation_.textures.size()) - 1;
}

void Builder::readComponent(const Value& value, const SpectrumReader& spectra, Material& m, std::vector<std::shared_ptr<const Material>>& entries) {
  static const ParameterTable any = anyComponentTable();
  const ReflectionModel& model = *reflectionModels().named(Record(value, any).text("reflection"));
  const ParameterTable& table = componentTables_.try_emplace(model.name, componentTable(model)).first->second;
  const Record record(value, table);
  if (model.share && (componentShares_[model.name] += model.share(record)) > 1.0 + 1e-9)
    throw UserError(record.where(), "more components of the kind '" + model.name + "' than a scenario may hold", "fewer, or smaller ones",
                    "give alike materials one name under 'materials:', or thin their tables out");
  const ComponentMaker make = componentMaker(
      model, record,
      // Kept by what is made; `m` is not.
      [spectra, name = m.name.substr(0, 60)](const Value& v, const Parameter& p) {
        return bounded(spectra, v, p.unit, p.key + " of material '" + name + "'", p.minimum, p.maximum);
      },
      [this](const std::string& name, const Location& asked) { return substanceNamed(name, asked); }, spectra.files().base);
  const Value* modifier = value.find("modifier");
  const int texture = modifier ? readTexture(*modifier, "", "a modifier", 0.0, 1.0) : -1;
  const Value* state = model.state ? value.find(model.state->key) : nullptr;
  const bool textured = state && state->kind == Value::Kind::Map;
  const auto addTo = [&](Material& to, double number) {
    const MadeReflection made = make(number);
    for (const auto& component : made.components) to.reflections.push_back(component), to.modifiers.push_back(texture);
    to.notes.insert(to.notes.end(), made.notes.begin(), made.notes.end());
    if (!made.transmission) return;
    if (to.transmission)
      throw UserError(record.where(), "a second component of material '" + m.name.substr(0, 60) + "' lets light through", "one pane", "remove one");
    if (textured)
      throw UserError(state->where, "a pane whose '" + model.state->key + "' is a texture", "a number, or a body that is not transparent",
                      "several panes of different thickness do the same");
    to.transmission.emplace().model = made.transmission;
    to.transmission->modifier = texture;
  };
  const auto add = [&](const std::function<double(size_t)>& stateOf) {
    addTo(m, stateOf(0));
    for (size_t k = 0; k < entries.size(); ++k) {
      auto entry = std::make_shared<Material>(*entries[k]);
      addTo(*entry, stateOf(k));
      entries[k] = std::move(entry);
    }
  };
  if (!textured) {
    double number = model.state ? model.state->usual : 0.0;
    if (state) number = readNumber(*state, model.state->unit, model.state->key);
    if (state && !(number >= model.state->low && number <= model.state->high))
      throw UserError(state->where, "'" + model.state->key + "' is " + briefNumber(number),
                      briefNumber(model.state->low) + " to " + briefNumber(model.state->high), "change it");
    return add([number](size_t) { return number; });
  }
  if (m.states)
    throw UserError(state->where, "a second texture drives material '" + m.name.substr(0, 60) + "'", "one component whose state is a texture",
                    "give the others a number");
  MaterialStates states;
  states.texture = readTexture(*state, model.state->unit, model.state->key, model.state->low, model.state->high);
  const auto& texels = simulation_.textures[static_cast<size_t>(states.texture)].texels;
  const auto [low, high] = std::minmax_element(texels.begin(), texels.end());
  states.low = static_cast<double>(*low);
  // A texture of one value is a number: an end beside it that nothing reaches.
  states.high = *high > *low ? static_cast<double>(*high) : states.low + std::max(1e-6 * std::abs(states.low), 1e-9);
  constexpr double kMostStates = 129.0;
  const double wanted = std::ceil((states.high - states.low) * make(states.low).statesPerUnit) + 1.0;
  if (wanted > kMostStates)
    throw UserError(state->where,
                    "a texture of '" + model.state->key + "' from " + briefNumber(states.low) + " to " + briefNumber(states.high) + " " + model.state->unit +
                        ", which takes " + briefNumber(wanted) + " states to see each fringe",
                    "a range that " + briefNumber(kMostStates) + " states resolve", "split the surface into parts of smaller ranges");
  // The components before it are the same in all of its states.
  entries.assign(static_cast<size_t>(std::max(wanted, static_cast<double>(model.state->entries))), std::make_shared<const Material>(m));
  const double last = static_cast<double>(entries.size() - 1);
  m.states = states;
  add([&](size_t k) { return states.low + (states.high - states.low) * static_cast<double>(k) / last; });
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

Medium Builder::readMedium(const MediumModel& model, const Record& r, const std::string& material, const SpectrumReader& spectra) const {
  const auto read = spectraOf(model.parameters, r, [&](const Value& v, const Parameter& p) {
    return bounded(spectra, v, p.unit, p.key + " of material '" + material.substr(0, 60) + "'", p.minimum, p.maximum);
  });
  return model.make({r, read});
}

std::shared_ptr<const Material> Builder::readMaterialFile(const Value& value, const std::string& name) {
  const Record r(value, tables::material());
  const Location& where = r.where("file");
  if (value.entries.size() > 1) throw UserError(where, "a material of a file and of its own at once", "'file' alone", "move the other keys into the file");
  std::filesystem::path path = r.text("file");
  if (path.is_relative()) path = spectra_.files().base / path;
  const Value tree = loadYaml(path, where);
  if (tree.kind == Value::Kind::Map && tree.find("file"))
    throw UserError(tree.where, "a material's file that names another", "the material itself", "name that file instead");
  // What it names is relative to it.
  const SpectrumReader before = std::exchange(spectra_, spectra_.in(path.parent_path()));
  auto material = readMaterial(tree, name, spectra_);
  spectra_ = before;
  return material;
}

std::shared_ptr<const Material> Builder::readMaterial(const Value& value, const std::string& name, const SpectrumReader& spectra) {
  if (value.kind == Value::Kind::Map && value.find("file")) return readMaterialFile(value, name);
  const MediumModel* medium = tables::mediumOf(value);
  const ParameterTable table = medium ? tables::medium(*medium) : tables::material();
  const Record r(value, table);
  if (simulation_.materials.size() >= kMostMaterials)
    throw UserError(value.where, "more than " + std::to_string(kMostMaterials) + " materials", "fewer",
                    "give alike materials a name under 'materials:' and use it more than once");
  auto m = std::make_shared<Material>();
  m->name = name;
  m->where = value.where;
  if (r.given("source")) m->provenance = r.text("source");
  if (medium) {
    m->medium = readMedium(*medium, r, name, spectra);
    return m;
  }
  std::vector<std::shared_ptr<const Material>> entries;
  if (r.given("components"))
    for (const Value& c : r.value("components").items) readComponent(c, spectra, *m, entries);
  if (r.given("temperatures")) {
    for (const char* key : {"components", "emission", "transmission"})
      if (r.given(key)) throw UserError(r.where(key), std::string("'") + key + "' beside 'temperatures'", "one of them", "remove it");
    readTemperatureStates(r.value("temperatures"), spectra, *m);
    entries = m->states->entries;
  }
  if (r.given("emission")) m->given = readViewSpectrum(Record(r.value("emission"), tables::emission()), "emissivity", name, spectra);
  if (r.given("transmission") && m->transmission)
    throw UserError(r.where("transmission"), "a 'transmission' beside a pane that has its own", "one of them", "remove one");
  if (r.given("transmission")) m->transmission = readViewSpectrum(Record(r.value("transmission"), tables::transmission()), "transmittance", name, spectra);
  for (auto& e : entries) {
    auto entry = std::make_shared<Material>(*e);
    entry->given = m->given;
    if (r.given("transmission")) entry->transmission = m->transmission;
    e = std::move(entry);
  }
  if (m->states) m->states->entries = entries;
  else entries = {m};
  for (const auto& entry : entries)
    if (const auto excess = energyExcess(*entry, simulation_.textures))
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

Value Builder::substanceNamed(const std::string& name, const Location& asked) const {
  const auto folder = libraries_.materials.parent_path() / "substances", file = folder / (name + ".yaml");
  std::error_code ignored;
  if (name.find('/') == std::string::npos && name.size() <= 100 && std::filesystem::is_regular_file(file, ignored)) return loadYaml(file, asked);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  throw unknownWord(asked, "there is no substance", name, names, "write its index: a number, or a map with n and k or a formula");
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
    throw unknownWord(asked.where, "there is no material", name, names, "define it under 'materials:'");
  }
  const Value tree = loadYaml(file, asked.where);
  simulation_.materials.push_back(readMaterial(tree, name, spectra_.in(libraries_.materials)));
  return materialIndex_[name] = static_cast<int>(simulation_.materials.size()) - 1;
}

}  // namespace pitviper
