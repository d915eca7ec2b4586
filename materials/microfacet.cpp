// Facets of a substance given by its refractive index, bare or under thin films; what scatters beneath them; panes.
#include <algorithm>
#include <cmath>

#include "materials/facet_components.hpp"
#include "materials/reflection.hpp"

namespace pitviper {
namespace {

/// A layer's faces interfere by themselves where it is thinner: beyond, no channel of a sensor resolves its fringes.
constexpr double kCoherent_um = 10.0;
constexpr double kMostCoherent_um = 100.0, kMostThickness_um = 1e6;
constexpr size_t kMostLayers = 64;
/// Each takes some 50 ms to prepare.
constexpr double kMostFacets = 64.0;

std::vector<FilmSpec> readLayers(const ComponentRecord& r, const char* key, bool& statesUsed) {
  std::vector<FilmSpec> all;
  if (!r.record.given(key)) return all;
  const bool textured = r.record.given("film_thickness") && r.record.value("film_thickness").kind == Value::Kind::Map;
  for (const Value& value : r.record.value(key).items) {
    const Record own(value, filmLayerTable());
    FilmSpec film{readRefractiveIndex(own.value("index"), r.spectrumOf, r.substanceOf), 0.0, true, false};
    const bool given = own.given("thickness");
    if (!given) {
      if (!r.record.given("film_thickness"))
        throw UserError(value.where, "a layer without a thickness", "'thickness', or 'film_thickness' beside the layers (a number or a texture)", "add one");
      if (statesUsed) throw UserError(value.where, "a second layer without a thickness", "'film_thickness' stands for one", "give the others 'thickness'");
      statesUsed = true;
    }
    film.thickness_um = given ? own.number("thickness") : r.state;
    film.varies = !given && textured;
    film.coherent = own.given("coherent") ? own.boolean("coherent") : film.thickness_um <= kCoherent_um;
    if (film.coherent && film.thickness_um > kMostCoherent_um)
      throw UserError(own.where("coherent"), "a coherent layer of " + std::to_string(film.thickness_um) + " um", "up to 100 um",
                      "leave 'coherent' out: no sensor resolves its fringes");
    all.push_back(std::move(film));
  }
  return all;
}

/// Light scattered within is given back by n^2 of a substance that does not absorb.
void refuseDarkBinder(const FacetSpec& spec, const Location& where) {
  constexpr double kDark = 0.02;
  constexpr int kPlaces = 400;
  const double low = std::max(spec.beneath.validLow_um(), spec.pigment->validLow()), high = std::min(spec.beneath.validHigh_um(), spec.pigment->validHigh());
  for (int i = 0; low < high && i <= kPlaces; ++i) {
    const double w = std::clamp(low * std::pow(high / low, i / double(kPlaces)), low, high);
    const auto n = spec.beneath(w);
    if ((*spec.pigment)(w) > 0.0 && (n.imag() > kDark || n.real() < 1.0))
      throw UserError(where,
                      "a pigment within a substance that absorbs (n + ik = " + std::to_string(n.real()) + " + " + std::to_string(n.imag()) + "i at " +
                          std::to_string(w) + " um)",
                      "n of 1 or more and k up to 0.02 where the pigment is above 0", "let the pigment end there, or write 'pigment_is: apparent'");
  }
}

MadeReflection makeFacets(const ComponentRecord& r) {
  FacetSpec spec{{}, readRefractiveIndex(r.record.value("index"), r.spectrumOf, r.substanceOf), r.record.number("roughness"), {}, {}, false, {}, {}};
  bool statesUsed = false;
  spec.layers = readLayers(r, "layers", statesUsed);
  spec.back = readLayers(r, "back", statesUsed);
  if (r.record.given("film_thickness") && !statesUsed)
    throw UserError(r.record.where("film_thickness"), "a film thickness that no layer takes", "a layer without 'thickness'", "remove one or the other");
  spec.slopes = r.record.text("slopes") == "normal" ? Slopes::Normal : Slopes::Trowbridge;
  if (r.record.given("pigment")) spec.pigment = r.spectrum("pigment");
  spec.pigmentApparent = r.record.text("pigment_is") == "apparent";
  if (spec.pigment && !spec.pigmentApparent) refuseDarkBinder(spec, r.record.where("pigment"));
  if (r.record.given("thickness")) spec.paneThickness_um = r.record.number("thickness");
  if (!spec.back.empty() && !spec.paneThickness_um)
    throw UserError(r.record.where("back"), "films on the back of what is no pane", "'back' with 'thickness'", "add the pane's 'thickness', or remove it");
  if (spec.pigment && spec.paneThickness_um)
    throw UserError(r.record.where("thickness"), "a pane with a pigment: what scatters cannot be seen through here", "one of 'pigment' and 'thickness'",
                    "remove one");
  return facetComponents(std::move(spec), r.record.where());
}

}  // namespace

const ParameterTable& filmLayerTable() {
  static const ParameterTable t{"film layer",
                                "A plane layer of a stack, by its refractive index and thickness.",
                                {required(any("index", "its refractive index: a number, the name of a substance, or a map of n and k or a formula")),
                                 within(number("thickness", "um", "how thick it is; where it is left out, `film_thickness` holds"), 0, kMostThickness_um),
                                 boolean("coherent",
                                         "whether waves from its two faces interfere (up to 100 um), or their powers add; by itself: up to 10 um. Fringes "
                                         "closer together than 1 nm or 5 1/cm are averaged, and said to be")}};
  return t;
}

ReflectionModel microfacetModel() {
  return {
      "microfacet",
      "Facets that mirror, by Fresnel's formulas, bare or under thin films: polished and rough metals, glass, paint under its clear coat, coated panes. Light "
      "that several facets return is in it, so that what does not absorb loses nothing.",
      {required(any("index", "refractive index of the substance beneath the films: a number, the name of a substance, or a map of n and k or a formula")),
       required(within(number("roughness", "", "root of twice the facets' mean square slope along one direction: 0.005 polished, 0.3 matt"), 0.002, 1)),
       withDefault(choice("slopes", {"ggx", "normal"}, "how slopes are distributed: Trowbridge and Reitz's long tails, or normally"), "ggx"),
       list("layers", "films on it, from outside in", 0, kMostLayers),
       within(spectrum("pigment", "", "albedo of what scatters beneath the face, in a substance of real index"), 0, 1),
       withDefault(choice("pigment_is", {"body", "apparent"},
                          "what the albedo counts: each scattering from within, whose light the face returns in part, or all that comes out of what went in"),
                   "body"),
       within(number("thickness", "um", "of a pane: light goes through it to another face, powers added"), 0, 1e6),
       list("back", "films on the pane's other face, from the pane outwards", 0, kMostLayers)},
      {},
      [](const Record&) { return 1.0 / kMostFacets; },
      StateParameter{"film_thickness", "um", "of the layer that gives none", 0.0, kMostCoherent_um, 0.0, 33},
      {},
      makeFacets};
}

}  // namespace pitviper
