#include "scenarios/view/surface_import.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "scenarios/import/material_import.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/view/library_lookup.hpp"
#include "scenarios/view/material_text.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

using OverWavelength = std::function<double(double wavelength_um)>;

/// Of each curve: three that share 1 are lowered by no more than their sum is above, and stay within kCurveTolerance.
constexpr double kFollowedWithin = 0.25 * kCurveTolerance;

/// What a material says, and what it means.
struct SaidMaterial {
  Value tree;
  std::filesystem::path base;
  std::shared_ptr<const Material> material;
};

/// Wavelengths from which functions are followed: their knots and a grid; between two of them as often halved as the middle is not on their line. Steps are
/// found so too.
class FollowedPlaces {
 public:
  FollowedPlaces(std::vector<double> knots, double low, double high) : places_(std::move(knots)) {
    constexpr int kGrid = 200;
    for (int i = 0; i <= kGrid; ++i) places_.push_back(std::clamp(low * std::pow(high / low, i / double(kGrid)), low, high));
    std::erase_if(places_, [&](double w) { return !(w >= low && w <= high); });
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  }
  std::shared_ptr<const EditedCurve> curve(CurveKind kind, const OverWavelength& f, double tolerance) const {
    std::vector<CurvePoint> found{{places_.front(), f(places_.front())}}, ahead;
    for (auto place = places_.rbegin(); place + 1 != places_.rend(); ++place) ahead.push_back({*place, f(*place)});
    constexpr double kNarrowest = 4e-6;
    constexpr std::size_t kMostFound = 50000;
    while (!ahead.empty()) {
      const CurvePoint a = found.back(), b = ahead.back();
      const double w = 0.5 * (a.wavelength_um + b.wavelength_um);
      if (b.wavelength_um - a.wavelength_um > kNarrowest * w && found.size() + ahead.size() < kMostFound) {
        const double middle = f(w);
        if (std::abs(middle - 0.5 * (a.value + b.value)) > 0.25 * tolerance) {
          ahead.push_back({w, middle});
          continue;
        }
      }
      found.push_back(b);
      ahead.pop_back();
    }
    Spectrum::Table t{{}, {}, Outside::Hold, axisOf(kind).name};
    for (const CurvePoint& p : found) t.wavelength_um.push_back(p.wavelength_um), t.value.push_back(p.value);
    return std::make_shared<const EditedCurve>(EditedCurve::of(Spectrum(std::move(t)), places_.front(), places_.back(), tolerance, axisOf(kind).bounds));
  }
  std::shared_ptr<const EditedCurve> curve(CurveKind kind, const OverWavelength& f) const { return curve(kind, f, kFollowedWithin); }
  double largest(const OverWavelength& f) const {
    double most = -INFINITY;
    for (double w : places_) most = std::max(most, f(w));
    return most;
  }

 private:
  std::vector<double> places_;
};

/// Where a material is told: where it has data, and no further than its spectra bend.
FollowedPlaces placesOf(const Material& m, double& low, double& high) {
  std::vector<double> knots = m.given ? m.given->knots_um() : std::vector<double>();
  for (const auto& r : m.reflections) {
    const auto own = r->knots_um();
    knots.insert(knots.end(), own.begin(), own.end());
  }
  std::sort(knots.begin(), knots.end());
  constexpr double kUsualLow_um = 0.3, kUsualHigh_um = 15.0;
  low = m.validLow_um(), high = m.validHigh_um();
  // Steps at the ends want a place beyond them.
  const auto steps = [&](double w, double beyond) { return w != beyond && m.reflectance(w, 0.0) != m.reflectance(beyond, 0.0); };
  if (low <= kShortestWavelength_um) {
    low = knots.empty() ? std::min(kUsualLow_um, high) : std::clamp(knots.front(), kShortestWavelength_um, high);
    if (const double beyond = std::max(low * (1.0 - 4e-6), kShortestWavelength_um); steps(low, beyond)) low = beyond;
  }
  if (high >= kLongestWavelength_um) {
    high = knots.empty() ? std::max(kUsualHigh_um, low) : std::clamp(knots.back(), low, kLongestWavelength_um);
    if (const double beyond = std::min(high * (1.0 + 4e-6), kLongestWavelength_um); steps(high, beyond)) high = beyond;
  }
  if (high <= low) high = std::min(2.0 * low, kLongestWavelength_um);
  return FollowedPlaces(std::move(knots), low, high);
}

std::string reflectionOf(const Value& component) {
  const Value* name = component.find("reflection");
  return name ? name->text : "";
}

const std::vector<Value>& componentsOf(const Value& tree) {
  static const std::vector<Value> none;
  const Value* list = tree.find("components");
  return list ? list->items : none;
}

bool allPlainComponents(const Value& tree) {
  const auto& all = componentsOf(tree);
  return !tree.find("temperatures") && std::all_of(all.begin(), all.end(), [](const Value& c) {
    const std::string kind = reflectionOf(c);
    return (kind == "lambertian" || kind == "phong" || kind == "spectral_phong") && !c.find("modifier");
  });
}

void addPlain(EditedSurface& s, const SaidMaterial& said, const Libraries& libraries, const FollowedPlaces& places) {
  struct Part {
    OverWavelength share, exponent;
  };
  std::vector<OverWavelength> diffuse;
  std::vector<Part> lobes;
  const SpectrumReader spectra = spectraIn(said.base, libraries);
  const auto& components = componentsOf(said.tree);
  for (std::size_t k = 0; k < components.size(); ++k) {
    const std::string kind = reflectionOf(components[k]);
    const auto& made = said.material->reflections[k];
    if (kind == "spectral_phong") {
      const auto of = [&](const char* key) { return spectra.read(*components[k].find(key), "", key); };
      diffuse.emplace_back(of("diffuse"));
      lobes.push_back({of("specular"), of("exponent")});
    } else if (kind == "phong") {
      lobes.push_back({[made](double w) { return made->hemispherical(w, 0.0); }, [n = made->lobe().exponent](double) { return n; }});
    } else {
      diffuse.emplace_back([made](double w) { return made->hemispherical(w, 0.0); });
    }
  }
  s.curve(CurveKind::Diffuse) = places.curve(CurveKind::Diffuse, [&](double w) {
    double sum = 0.0;
    for (const OverWavelength& f : diffuse) sum += f(w);
    return sum;
  });
  if (lobes.empty()) return;
  s.curve(CurveKind::Specular) = places.curve(CurveKind::Specular, [&](double w) {
    double sum = 0.0;
    for (const Part& lobe : lobes) sum += lobe.share(w);
    return sum;
  });
  const auto exponent = [&](double w) {
    double sum = 0.0, shares = 0.0;
    for (const Part& lobe : lobes) {
      // Where nothing is returned it does not matter.
      const double share = std::max(lobe.share(w), 1e-9);
      sum += share * lobe.exponent(w), shares += share;
    }
    return sum / shares;
  };
  const double largest = std::max(1.0, places.largest(exponent));
  s.curve(CurveKind::Exponent) = places.curve(CurveKind::Exponent, exponent, kFollowedWithin * largest);
  if (lobes.size() > 1) s.notes.emplace_back("its lobes are drawn as one: their reflectances together, their exponents by share");
  if (largest > axisOf(CurveKind::Exponent).bounds.highest)
    s.notes.push_back(print("an exponent of %.4g has become %.4g", largest, axisOf(CurveKind::Exponent).bounds.highest));
}

/// Facets under exactly one film, over a substrate that has a name.
bool hasOneFilm(const Value& tree) {
  const auto& all = componentsOf(tree);
  if (all.size() != 1 || reflectionOf(all[0]) != "microfacet" || tree.find("temperatures") || tree.find("transmission")) return false;
  for (const char* key : {"modifier", "back", "thickness"})
    if (all[0].find(key)) return false;
  const Value *index = all[0].find("index"), *layers = all[0].find("layers"), *driven = all[0].find("film_thickness");
  return index && index->kind == Value::Kind::Scalar && layers && layers->items.size() == 1 && (!driven || driven->kind == Value::Kind::Scalar);
}

/// Index and absorption of a film. Wherever it is known.
void addIndex(EditedSurface& s, const RefractiveIndex& index) {
  const double low = std::max(index.validLow_um(), kShortestWavelength_um), high = std::min(index.validHigh_um(), kLongestWavelength_um);
  const FollowedPlaces places(index.knots_um(), low, high);
  s.curve(CurveKind::FilmIndex) = places.curve(CurveKind::FilmIndex, [&](double w) { return index(w).real(); });
  s.curve(CurveKind::FilmAbsorption) = places.curve(CurveKind::FilmAbsorption, [&](double w) { return index(w).imag(); });
}

void addOneFilm(EditedSurface& s, const SaidMaterial& said, const Libraries& libraries, const FollowedPlaces& places) {
  const Value& component = componentsOf(said.tree)[0];
  static const ParameterTable table = componentTable(*reflectionModels().named("microfacet"));
  const Record r(component, table), layer(r.value("layers").items[0], filmLayerTable());
  const SpectrumReader spectra = spectraIn(said.base, libraries);
  EditedFilm film;
  film.thickness_um = layer.given("thickness") ? layer.number("thickness") : readNumber(r.value("film_thickness"), "um", "film_thickness");
  film.substrate = r.value("index").text;
  film.roughness = r.number("roughness");
  film.normalSlopes = r.text("slopes") == "normal";
  if (layer.given("coherent")) film.coherent = layer.boolean("coherent");
  addIndex(s, readRefractiveIndex(
                  layer.value("index"), [&](const Value& v, const Parameter& p) { return spectra.read(v, p.unit, p.key); },
                  [&](const std::string& name, const Location& at) { return substanceTree(name, at, libraries); }));
  OverWavelength pigment = [](double) { return 0.0; };
  if (r.given("pigment")) {
    pigment = spectra.read(r.value("pigment"), "", "pigment");
    const bool number = film.substrate.find_first_not_of("0123456789.") == std::string::npos;
    film.pigmentApparent = r.text("pigment_is") == "apparent" || !number;
    if (!number && r.text("pigment_is") == "body")
      s.notes.emplace_back("what scatters beneath is counted by all that comes out of what goes in, not by the scattering");
  }
  s.curve(CurveKind::Diffuse) = places.curve(CurveKind::Diffuse, pigment);
  if (said.material->given) s.notes.emplace_back("its given emissivity is left out: under a film it is 1 - reflectance");
  s.film = std::move(film);
}

void addEmissivity(EditedSurface& s, const Material& m, const FollowedPlaces& places) {
  if (!m.given) return;
  s.curve(CurveKind::Emissivity) = places.curve(CurveKind::Emissivity, [&](double w) { return m.given->at(w, 0.0); });
  if (m.given->varies()) s.notes.emplace_back("its emissivity is that at normal view");
  if (m.given->modifier >= 0) s.notes.emplace_back("the texture of its emissivity is left out");
}

EditedSurface surfaceOf(const SaidMaterial& said, const std::string& name, const Libraries& libraries) {
  const Material& m = *said.material;
  if (m.medium) throw UserError(said.tree.where, "'" + name.substr(0, 60) + "' is a medium", "a surface", "choose another");
  EditedSurface s;
  s.name = name;
  if (const Value* text = said.tree.find("description")) s.description = text->text;
  if (const Value* text = said.tree.find("source")) s.source = text->text;
  double low = 0.0, high = 0.0;
  const FollowedPlaces places = placesOf(m, low, high);
  if (hasOneFilm(said.tree)) {
    addOneFilm(s, said, libraries, places);
  } else if (allPlainComponents(said.tree)) {
    addPlain(s, said, libraries, places);
  } else {
    s.curve(CurveKind::Diffuse) = places.curve(CurveKind::Diffuse, [&](double w) { return m.reflectance(w, 0.0); });
    s.notes.emplace_back("its reflection is of a kind without curves: what it reflects at normal view is drawn, alike in all directions");
    if (std::any_of(m.modifiers.begin(), m.modifiers.end(), [](int k) { return k >= 0; })) s.notes.emplace_back("its textures are left out");
    if (m.states) s.notes.push_back(m.states->texture < 0 ? "it is that of its lowest temperature" : "it is that of the least that its texture says");
  }
  if (!s.film) addEmissivity(s, m, places);
  if (m.transmission) s.notes.emplace_back("what goes through it is left out");
  const bool known = m.validLow_um() > kShortestWavelength_um || m.validHigh_um() < kLongestWavelength_um;
  if (known && !s.film) s.notes.push_back(print("it is known from %.4g to %.4g um: beyond, the curves are held", m.validLow_um(), m.validHigh_um()));
  return s;
}

/// Of optical constants: a polished face at normal view, and what a film of it would have.
EditedSurface polishedFace(const Value& tree, const std::string& name) {
  const SpectrumReader reader{SpectrumFiles{}};
  const RefractiveIndex index = readRefractiveIndex(*tree.find("index"), [&](const Value& v, const Parameter& p) { return reader.read(v, p.unit, p.key); }, {});
  EditedSurface s;
  s.name = name;
  if (const Value* text = tree.find("description")) s.description = text->text;
  if (const Value* text = tree.find("source")) s.source = text->text;
  addIndex(s, index);
  const double low = std::max(index.validLow_um(), kShortestWavelength_um), high = std::min(index.validHigh_um(), kLongestWavelength_um);
  s.curve(CurveKind::Diffuse) =
      FollowedPlaces(index.knots_um(), low, high).curve(CurveKind::Diffuse, [&](double w) { return std::norm((index(w) - 1.0) / (index(w) + 1.0)); });
  s.notes.emplace_back("optical constants: what a polished face reflects at normal view is drawn, alike in all directions; a film has its index");
  s.notes.push_back(print("it is known from %.4g to %.4g um: beyond, the curves are held", low, high));
  return s;
}

std::vector<std::string> stemsIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

EditedSurface surfaceNamed(const std::string& word, const Libraries& libraries) {
  std::filesystem::path file = word;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    file = libraries.materials / (word + ".yaml");
    if (word.find('/') != std::string::npos || word.size() > 100 || !std::filesystem::is_regular_file(file, ignored)) {
      throw unknownWord({word, 0, 0, -1}, "there is no material and no file", word, stemsIn(libraries.materials), "check the name");
    }
  } else if (const auto imported = importedMaterial(file)) {
    SaidMaterial said{parseYaml(imported->yaml, file.string() + " as YAML"), file.parent_path(), nullptr};
    EditedSurface s;
    if (said.tree.find("index")) {
      s = polishedFace(said.tree, file.stem().string());
    } else {
      said.material = readMaterialText(imported->yaml, said.base, libraries);
      s = surfaceOf(said, file.stem().string(), libraries);
    }
    s.notes.insert(s.notes.begin(), imported->notes.begin(), imported->notes.end());
    return s;
  }
  return surfaceOf({loadYaml(file, {file.string(), 0, 0, -1}), file.parent_path(), readMaterialFile(file, libraries)}, file.stem().string(), libraries);
}

EditedSurface surfaceWithin(const std::filesystem::path& scenario, const std::string& name, const std::shared_ptr<const Material>& material,
                            const Libraries& libraries) {
  const Value tree = loadYaml(scenario, {scenario.string(), 0, 0, -1});
  const Value* all = tree.find("materials");
  const Value* said = all ? all->find(name) : nullptr;
  const Value* file = said ? said->find("file") : nullptr;
  const std::filesystem::path base = scenario.parent_path();
  if (file) return surfaceOf({loadYaml(base / file->text, file->where), (base / file->text).parent_path(), material}, name, libraries);
  if (said) return surfaceOf({*said, base, material}, name, libraries);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(libraries.materials / (name + ".yaml"), ignored)) return surfaceNamed(name, libraries);
  Value elsewhere;
  elsewhere.kind = Value::Kind::Map;
  return surfaceOf({elsewhere, base, material}, name, libraries);
}

std::vector<std::string> libraryMaterials(const Libraries& libraries) { return stemsIn(libraries.materials); }

std::vector<std::string> librarySubstances(const Libraries& libraries) { return stemsIn(libraries.materials.parent_path() / "substances"); }

}  // namespace pitviper
