#include "scenarios/view/edited_surface.hpp"

#include <algorithm>
#include <cctype>
#include <map>

#include "materials/models.hpp"
#include "scenarios/import/import_yaml.hpp"
#include "scenarios/view/library_lookup.hpp"

namespace pitviper {
namespace {

bool isZeroCurve(const EditedCurve& curve) {
  return std::all_of(curve.points().begin(), curve.points().end(), [](const CurvePoint& p) { return p.value == 0.0; });
}

std::string filmThicknessText(const EditedFilm& film) { return exactNumber(tidy(film.thickness_um)) + " um"; }

/// It stands in text as it is.
void refuseSubstrateWord(const std::string& word) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '+'; };
  if (word.empty() || !std::all_of(word.begin(), word.end(), plain))
    throw UserError({"film", 0, 0, -1}, "a substrate called '" + word.substr(0, 60) + "'", "the name of a substance, or a number",
                    "choose one of materials/substances");
}

/// Where a mistake is: only films have any.
const Location kInFilm{"film", 0, 0, -1};

Value scalarOf(std::string text) {
  Value v;
  v.where = kInFilm;
  v.kind = Value::Kind::Scalar;
  v.text = std::move(text);
  return v;
}

Value treeOf(std::vector<std::pair<std::string, Value>> entries) {
  Value v;
  v.kind = Value::Kind::Map;
  v.where = kInFilm;
  v.keyPlaces.assign(entries.size(), kInFilm);
  v.entries = std::move(entries);
  return v;
}

/// The component of the text as a tree whose spectra are words: read as any other, without their rows going through text.
Value componentOf(const EditedSurface& s) {
  if (!s.film && isZeroCurve(*s.curve(CurveKind::Specular))) return treeOf({{"reflection", scalarOf("lambertian")}, {"reflectance", scalarOf("curve")}});
  if (!s.film)
    return treeOf(
        {{"reflection", scalarOf("spectral_phong")}, {"diffuse", scalarOf("curve")}, {"specular", scalarOf("curve")}, {"exponent", scalarOf("curve")}});
  const EditedFilm& film = *s.film;
  refuseSubstrateWord(film.substrate);
  std::vector<std::pair<std::string, Value>> layer{{"index", treeOf({{"n", scalarOf("curve")}, {"k", scalarOf("curve")}})},
                                                   {"thickness", scalarOf(filmThicknessText(film))}};
  if (film.coherent) layer.emplace_back("coherent", scalarOf(*film.coherent ? "true" : "false"));
  Value layers;
  layers.kind = Value::Kind::List;
  layers.items.push_back(treeOf(std::move(layer)));
  std::vector<std::pair<std::string, Value>> all{{"reflection", scalarOf("microfacet")},
                                                 {"index", scalarOf(film.substrate)},
                                                 {"roughness", scalarOf(exactNumber(tidy(film.roughness)))},
                                                 {"slopes", scalarOf(film.normalSlopes ? "normal" : "ggx")},
                                                 {"layers", layers}};
  if (!isZeroCurve(*s.curve(CurveKind::Diffuse))) {
    all.emplace_back("pigment", scalarOf("curve"));
    all.emplace_back("pigment_is", scalarOf(film.pigmentApparent ? "apparent" : "body"));
  }
  return treeOf(std::move(all));
}

CurveKind kindOf(const std::string& key) {
  static const std::map<std::string, CurveKind> others{
      {"specular", CurveKind::Specular}, {"exponent", CurveKind::Exponent}, {"n", CurveKind::FilmIndex}, {"k", CurveKind::FilmAbsorption}};
  const auto found = others.find(key);
  return found != others.end() ? found->second : CurveKind::Diffuse;
}

}  // namespace

const CurveAxis& axisOf(CurveKind kind) {
  static const std::array<CurveAxis, kAllCurves.size()> all{CurveAxis{"diffuse", "reflectance alike in all directions", {0.0, 1.0}},
                                                            CurveAxis{"specular", "reflectance of the lobe, at normal view", {0.0, 1.0}},
                                                            CurveAxis{"exponent", "of the lobe: the greater, the narrower", {0.0, 1e5}, true},
                                                            CurveAxis{"emissivity", "given instead of 1 - reflectance", {0.0, 1.0}},
                                                            CurveAxis{"film_index", "refractive index n of the film", {0.01, 20.0}},
                                                            CurveAxis{"film_absorption", "imaginary part k of the film's index", {0.0, 100.0}}};
  return all[static_cast<std::size_t>(kind)];
}

EditedSurface::EditedSurface() {
  const auto flat = [&](CurveKind kind, double value) {
    curve(kind) = std::make_shared<const EditedCurve>(std::vector<CurvePoint>{{0.3, value}, {15.0, value}}, false, axisOf(kind).bounds);
  };
  flat(CurveKind::Diffuse, 0.3);
  flat(CurveKind::Specular, 0.0);
  flat(CurveKind::Exponent, 20.0);
  flat(CurveKind::FilmIndex, 2.3);
  flat(CurveKind::FilmAbsorption, 0.0);
}

bool EditedSurface::inForce(CurveKind kind) const {
  switch (kind) {
    case CurveKind::Diffuse:
      return true;
    case CurveKind::Specular:
    case CurveKind::Exponent:
      return !film;
    case CurveKind::Emissivity:
      return !film && curve(kind);
    case CurveKind::FilmIndex:
    case CurveKind::FilmAbsorption:
      return film.has_value();
  }
  return false;
}

bool EditedSurface::operator==(const EditedSurface& other) const {
  const auto same = [](const auto& a, const auto& b) { return a == b || (a && b && *a == *b); };
  return name == other.name && description == other.description && source == other.source && notes == other.notes && film == other.film &&
         std::equal(curves.begin(), curves.end(), other.curves.begin(), same);
}

std::string materialText(const EditedSurface& s, const std::string& description, const std::string& source) {
  std::string out;
  if (!description.empty()) out += "description: " + quotedText(description) + "\n";
  if (!source.empty()) out += "source: " + quotedText(source) + "\n";
  out += "components:\n";
  const auto curve = [&](const std::string& key, CurveKind kind) {
    std::string text = s.curve(kind)->yaml();
    // Rows on lines of their own stand right of their key.
    const std::size_t indent = key.find_first_not_of(' ');
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) text.insert(at + 1, indent, ' ');
    return key + ": " + text + "\n";
  };
  if (s.film) {
    const EditedFilm& film = *s.film;
    refuseSubstrateWord(film.substrate);
    out += "  - reflection: microfacet\n    index: " + film.substrate + "\n    roughness: " + exactNumber(tidy(film.roughness)) + "\n";
    if (film.normalSlopes) out += "    slopes: normal\n";
    if (!isZeroCurve(*s.curve(CurveKind::Diffuse)))
      out += curve("    pigment", CurveKind::Diffuse) + "    pigment_is: " + (film.pigmentApparent ? "apparent" : "body") + "\n";
    out += "    layers:\n      - index:\n" + curve("          n", CurveKind::FilmIndex) + curve("          k", CurveKind::FilmAbsorption) +
           "        thickness: " + filmThicknessText(film) + "\n";
    if (film.coherent) out += std::string("        coherent: ") + (*film.coherent ? "true" : "false") + "\n";
    return out;
  }
  if (isZeroCurve(*s.curve(CurveKind::Specular))) out += "  - reflection: lambertian\n" + curve("    reflectance", CurveKind::Diffuse);
  else
    out += "  - reflection: spectral_phong\n" + curve("    diffuse", CurveKind::Diffuse) + curve("    specular", CurveKind::Specular) +
           curve("    exponent", CurveKind::Exponent);
  if (s.curve(CurveKind::Emissivity)) out += "emission:\n" + curve("  emissivity", CurveKind::Emissivity);
  return out;
}

std::shared_ptr<const Material> madeMaterial(const EditedSurface& s, const Libraries& libraries) {
  const Value component = componentOf(s);
  const ReflectionModel& model = *reflectionModels().named(component.entries.front().second.text);
  const ParameterTable table = componentTable(model);
  const Record record(component, table);
  const auto spectrumOf = [&](const Value& v, const Parameter& p) {
    if (v.text != "curve") return spectraIn(libraries.materials, libraries).read(v, p.unit, p.key);  // of a substance
    return s.curve(kindOf(p.key))->spectrum();
  };
  MadeReflection made =
      componentMaker(model, record, spectrumOf, [&](const std::string& name, const Location& at) { return substanceTree(name, at, libraries); }, {})(0.0);
  auto m = std::make_shared<Material>();
  m->name = s.name;
  m->provenance = s.source;
  m->notes = std::move(made.notes);
  m->modifiers.assign(made.components.size(), -1);
  m->reflections.assign(made.components.begin(), made.components.end());
  if (!s.film && s.curve(CurveKind::Emissivity)) m->given.emplace().spectrum = s.curve(CurveKind::Emissivity)->spectrum();
  return m;
}

}  // namespace pitviper
