#include "scenarios/view/edited_surface.hpp"

#include <algorithm>
#include <cctype>

#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "scenarios/import/import_yaml.hpp"
#include "scenarios/view/edited_lobe.hpp"
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

/// Where a mistake in a film is.
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
Value filmComponent(const EditedSurface& s) {
  const EditedFilm& film = *s.film;
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

void addFilmFacets(Material& m, const EditedSurface& s, const Libraries& libraries) {
  refuseSubstrateWord(s.film->substrate);
  const ReflectionModel& model = *reflectionModels().named("microfacet");
  static const ParameterTable table = componentTable(model);
  const Value component = filmComponent(s);
  const Record record(component, table);
  const auto spectrumOf = [&](const Value& v, const Parameter& p) {
    if (v.text != "curve") return spectraIn(libraries.materials, libraries).read(v, p.unit, p.key);  // of a substance
    return s.curve(p.key == "n" ? CurveKind::FilmIndex : p.key == "k" ? CurveKind::FilmAbsorption : CurveKind::Diffuse)->spectrum();
  };
  const MadeReflection made =
      componentMaker(model, record, spectrumOf, [&](const std::string& name, const Location& at) { return substanceTree(name, at, libraries); }, {})(0.0);
  for (const auto& c : made.components) m.reflections.push_back(c);
  m.notes = made.notes;
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
  auto m = std::make_shared<Material>();
  m->name = s.name;
  m->provenance = s.source;
  const auto spectrum = [&](CurveKind kind) { return s.curve(kind)->spectrum(); };
  if (s.film) addFilmFacets(*m, s, libraries);
  else if (isZeroCurve(*s.curve(CurveKind::Specular))) m->reflections.push_back(makeLambertian(spectrum(CurveKind::Diffuse)));
  else m->reflections.push_back(makeEditedPhong(spectrum(CurveKind::Diffuse), spectrum(CurveKind::Specular), spectrum(CurveKind::Exponent)));
  m->modifiers.assign(m->reflections.size(), -1);
  if (!s.film && s.curve(CurveKind::Emissivity)) m->given.emplace().spectrum = spectrum(CurveKind::Emissivity);
  return m;
}

}  // namespace pitviper
