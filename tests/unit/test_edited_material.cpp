// Materials under a hand: energy holds whatever is dragged, steps are taken back exactly, and the text means what is seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "materials/energy.hpp"
#include "scenarios/view/edited_material.hpp"
#include "scenarios/view/material_text.hpp"
#include "scenarios/view/surface_import.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

const Libraries& editLibraries() {
  static const Libraries all = findLibraries();
  return all;
}

/// Greatest sum of what shares 1, wherever one of them bends.
double mostSharedOf(const EditedMaterial& m) {
  using enum CurveKind;
  std::vector<const EditedCurve*> all;
  for (CurveKind kind : {Diffuse, Specular, Emissivity})
    if (m.has(kind)) all.push_back(&m.curve(kind));
  double most = 0.0;
  for (const EditedCurve* own : all)
    for (double w : own->table().wavelength_um) {
      double sum = 0.0;
      for (const EditedCurve* curve : all) sum += curve->at(w);
      most = std::max(most, sum);
    }
  return most;
}

bool inUnitRange(const EditedCurve& curve) {
  return std::all_of(curve.points().begin(), curve.points().end(), [](const CurvePoint& p) { return p.value >= 0.0 && p.value <= 1.0; });
}

/// One of all that a hand can do to curves.
void editAtRandom(EditedMaterial& m, std::mt19937& random) {
  using enum CurveKind;
  std::uniform_real_distribution<double> any(0.0, 1.0);
  const CurveKind kind = kAllCurves[static_cast<std::size_t>(any(random) * 4.0)];
  const CurveBounds& bounds = axisOf(kind).bounds;
  const double w = 0.4 * std::pow(30.0, any(random)), value = bounds.lowest + (1.4 * any(random) - 0.2) * (bounds.highest - bounds.lowest);
  const auto points = m.has(kind) ? m.curve(kind).points().size() : 0u;
  const auto i = static_cast<std::size_t>(any(random) * static_cast<double>(points));
  const double what = any(random);
  if (what < 0.02) m.giveEmissivity(!m.has(Emissivity));
  else if (what < 0.06) m.setSmooth(kind, any(random) < 0.5);
  else if (what < 0.08) m.setCurve(kind == Emissivity ? Specular : kind, EditedCurve({{0.5, any(random)}, {w + 1.0, any(random)}}, what < 0.07, bounds));
  else if (what < 0.25 && points < 14) m.addPoint(kind, w, value);
  else if (what < 0.40) m.removePoint(kind, i);
  else m.movePoint(kind, i, w, value);
}

TEST(EditedMaterial, EnergyHoldsUnderTenThousandEdits) {
  using enum CurveKind;
  std::mt19937 random(2024);
  EditedMaterial m({}, editLibraries());
  double most = 0.0;
  int atTheCeiling = 0;
  for (int k = 0; k < 10000; ++k) {
    editAtRandom(m, random);
    const double sum = mostSharedOf(m);
    most = std::max(most, sum);
    if (sum > 1.0 - 1e-6) ++atTheCeiling;
    for (CurveKind kind : {Diffuse, Specular, Emissivity}) ASSERT_TRUE(!m.has(kind) || inUnitRange(m.curve(kind)));
    // As the reader would look at it.
    if (k % 1000 == 999) {
      EXPECT_FALSE(energyExcess(*m.material(), {}));
    }
  }
  bound("diffuse + specular + given emissivity after each of 10 000 edits, at most", most, 1.0 + 1e-11, "twelve digits of three numbers");
  EXPECT_GT(atTheCeiling, 1000);  // or it would not have been tried
  EXPECT_NO_THROW(readMaterialText(m.yaml(), ".", editLibraries()));
}

TEST(EditedMaterial, TheDraggedCurveYields) {
  using enum CurveKind;
  EditedMaterial m({}, editLibraries());
  m.setCurve(Diffuse, EditedCurve({{0.4, 0.2}, {0.8, 0.6}}));
  m.setCurve(Specular, EditedCurve({{0.4, 0.3}, {0.6, 0.3}, {0.8, 0.3}}));
  const EditedCurve diffuse = m.curve(Diffuse);
  m.movePoint(Specular, 1, 0.7, 0.95);
  EXPECT_NEAR(m.curve(Specular).points()[1].value, 0.5, 1e-9);  // 1 - diffuse there
  EXPECT_EQ(m.curve(Specular).points()[1].wavelength_um, 0.7);
  EXPECT_EQ(m.curve(Diffuse), diffuse);
  EXPECT_NEAR(m.energyAt(0.7), 1.0, 1e-9);
  EXPECT_NEAR(m.energyAt(0.4), 0.5, 1e-9);
  // A point between high ones cannot leave its place without raising the line: it goes as far as it may.
  m.setCurve(Specular, EditedCurve({{0.4, 0.0}}));
  m.setCurve(Diffuse, EditedCurve({{0.5, 0.0}, {0.6, 0.8}, {0.7, 0.0}}));
  m.setCurve(Specular, EditedCurve({{0.4, 0.9}, {0.6, 0.1}, {0.8, 0.9}}));
  m.movePoint(Specular, 1, 0.75, 0.1);
  EXPECT_LT(m.curve(Specular).points()[1].wavelength_um, 0.74);
  EXPECT_GT(m.curve(Specular).points()[1].wavelength_um, 0.6);
  EXPECT_LE(mostSharedOf(m), 1.0 + 1e-11);
  // Where a low point goes, those beside it come down, and they alone.
  m.setCurve(Specular, EditedCurve({{0.4, 0.0}}));
  m.setCurve(Diffuse, EditedCurve({{0.6, 0.0}, {0.7, 0.8}, {0.8, 0.0}}));
  for (bool smooth : {false, true}) {
    m.setCurve(Specular, EditedCurve({{0.4, 0.1}, {0.5, 0.7}, {0.7, 0.1}, {0.9, 0.7}, {1.0, 0.3}}, smooth));
    m.removePoint(Specular, 2);
    const auto& points = m.curve(Specular).points();
    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points.front().value, 0.1);
    EXPECT_EQ(points.back().value, 0.3);
    EXPECT_NEAR(m.curve(Specular).at(0.7), 0.2, 0.01);
    EXPECT_LE(mostSharedOf(m), 1.0 + 1e-11);
  }
  // Given emissivity has what is left.
  m.giveEmissivity(true);
  EXPECT_NEAR(m.curve(Emissivity).at(0.5), 1.0 - m.curve(Diffuse).at(0.5) - m.curve(Specular).at(0.5), 2e-4);
  EXPECT_LE(mostSharedOf(m), 1.0 + 1e-11);
  const double before = m.curve(Emissivity).at(0.5);
  m.addPoint(Emissivity, 0.5, 1.0);
  EXPECT_LE(m.curve(Emissivity).at(0.5), before + 2e-4);
}

TEST(EditedMaterial, UndoAndRedoGiveTheSameStates) {
  std::mt19937 random(7);
  EditedMaterial m({}, editLibraries());
  std::vector<EditedSurface> states{m.surface()};
  for (int k = 0; k < 300; ++k) {
    m.beginChange();
    editAtRandom(m, random);
    if (k % 50 == 0) m.setName("name " + std::to_string(k));
    if (k == 100) m.setFilm(EditedFilm{});
    m.endChange();
    if (!(m.surface() == states.back())) states.push_back(m.surface());
  }
  for (std::size_t k = states.size() - 1; k-- > 0;) {
    ASSERT_TRUE(m.canUndo());
    m.undo();
    ASSERT_TRUE(m.surface() == states[k]) << k;
  }
  EXPECT_FALSE(m.canUndo());
  m.undo();
  EXPECT_TRUE(m.surface() == states.front());
  for (std::size_t k = 1; k < states.size(); ++k) {
    m.redo();
    ASSERT_TRUE(m.surface() == states[k]) << k;
  }
  EXPECT_FALSE(m.canRedo());
}

TEST(EditedMaterial, ADragIsOneStep) {
  using enum CurveKind;
  EditedMaterial m({}, editLibraries());
  const EditedSurface before = m.surface();
  m.beginChange();
  for (int k = 0; k < 20; ++k) m.movePoint(Diffuse, 0, 0.3 + 0.01 * k, 0.3 + 0.01 * k);
  m.endChange();
  const EditedSurface after = m.surface();
  const auto at = m.revision();
  m.beginChange();
  m.endChange();  // nothing happened
  EXPECT_EQ(m.revision(), at);
  m.undo();
  EXPECT_TRUE(m.surface() == before);
  EXPECT_FALSE(m.canUndo());
  m.redo();
  EXPECT_TRUE(m.surface() == after);
  m.undo();
  m.setSmooth(Diffuse, true);
  EXPECT_FALSE(m.canRedo());  // another way was taken
  // Within a drag that goes on.
  m.beginChange();
  m.movePoint(Diffuse, 0, 0.5, 0.5);
  EXPECT_TRUE(m.canUndo());
  m.undo();
  EXPECT_EQ(m.curve(Diffuse).points()[0].wavelength_um, 0.3);
}

void expectTextMeans(const EditedMaterial& m, const char* what, double reflectances) {
  const auto read = readMaterialText(m.yaml("Drawn: \"by hand\"", "a test"), ".", editLibraries()), made = m.material();
  ASSERT_EQ(read->reflections.size(), made->reflections.size());
  EXPECT_EQ(read->given.has_value(), made->given.has_value());
  EXPECT_NEAR(read->validLow_um(), made->validLow_um(), 1e-9);
  double brdf = 0.0, hemispherical = 0.0, emitted = 0.0;
  for (std::size_t k = 0; k < made->reflections.size(); ++k)
    for (std::size_t a = 0; a < 2; ++a) {
      const AngleAxis one = read->reflections[k]->axes()[a], other = made->reflections[k]->axes()[a];
      EXPECT_EQ(one.count, other.count);
      EXPECT_NEAR(one.last_rad, other.last_rad, 1e-9);
    }
  const glm::dvec3 view(std::sin(0.5), 0.0, std::cos(0.5));
  for (double w = 0.4; w < 3.0; w += 0.0731)
    for (double angle = 0.0; angle < 1.57; angle += 0.26) {
      const glm::dvec3 light(-std::sin(angle), 0.0, std::cos(angle));
      double one = 0.0, other = 0.0;
      for (std::size_t k = 0; k < made->reflections.size(); ++k)
        one += read->reflections[k]->brdf(w, light, view), other += made->reflections[k]->brdf(w, light, view);
      brdf = std::max(brdf, std::abs(one - other) / std::max(1.0, one));
      hemispherical = std::max(hemispherical, std::abs(read->reflectance(w, angle) - made->reflectance(w, angle)));
      emitted = std::max(emitted, std::abs(read->emissivity(w, angle) - made->emissivity(w, angle)));
    }
  bound(std::string(what) + ", text as read against the material as made: BRDF", brdf, 1e-9, "twelve digits are written");
  bound(std::string(what) + ", the same: reflectance", hemispherical, reflectances, "tables of the lobe's albedo on either side");
  bound(std::string(what) + ", the same: emissivity", emitted, reflectances, "the same");
}

TEST(EditedMaterial, TextMeansWhatIsSeen) {
  using enum CurveKind;
  EditedMaterial m({}, editLibraries());
  expectTextMeans(m, "lambertian", 1e-9);
  m.setCurve(Specular, EditedCurve({{0.4, 0.1}, {0.7, 0.5}, {2.0, 0.2}}, true));
  m.setCurve(Exponent, EditedCurve({{0.4, 5.0}, {1.0, 800.0}, {2.0, 60.0}}, true, axisOf(Exponent).bounds));
  m.giveEmissivity(true);
  expectTextMeans(m, "lobe", kCurveTolerance);
  m.setFilm(EditedFilm{.thickness_um = 0.15, .substrate = "1.45", .roughness = 0.1, .pigmentApparent = false});
  m.setCurve(FilmIndex, EditedCurve({{0.4, 2.6}, {1.0, 2.2}}, true, axisOf(FilmIndex).bounds));
  m.setCurve(FilmAbsorption, EditedCurve({{0.4, 0.1}, {0.6, 0.0}}, false, axisOf(FilmAbsorption).bounds));
  expectTextMeans(m, "film", 1e-9);
  // All angles: facets return nearly everything where they graze, and no more than that.
  for (double w : {0.4, 0.6, 1.5}) {
    EXPECT_GT(m.energyAt(w), 1.2 * m.material()->reflectance(w, 0.0));
    EXPECT_LE(m.energyAt(w), 1.0 + 1e-6);
  }
}

TEST(EditedMaterial, AFilmThatCannotBeChangesNothing) {
  EditedMaterial m({}, editLibraries());
  const EditedSurface before = m.surface();
  EXPECT_THROW(m.setFilm(EditedFilm{.substrate = "unobtainium"}), UserError);
  EXPECT_THROW(m.setFilm(EditedFilm{.substrate = "a: b"}), UserError);
  EXPECT_THROW(m.setFilm(EditedFilm{.substrate = "titanium", .pigmentApparent = false}), UserError);
  EXPECT_THROW(m.setFilm(EditedFilm{.thickness_um = -1.0}), UserError);
  EXPECT_TRUE(m.surface() == before);
  EXPECT_FALSE(m.canUndo());
  m.setCurve(CurveKind::Diffuse, EditedCurve({{0.3, 1.0}}));
  m.setFilm(EditedFilm{});
  // What scatters beneath has what the facets leave: white is allowed.
  for (double w : {0.4, 1.0, 4.0}) EXPECT_LE(m.energyAt(w), 1.0 + 1e-6);
  EXPECT_TRUE(std::isnan(m.energyAt(200.0)));  // titanium is known to 25 um
  EXPECT_EQ(m.energyAt(2.0), m.energyAt(2.0));
}

/// Worst difference of reflectance at normal view over what is known of both.
double curvesApart(const Material& a, const Material& b) {
  const double low = std::max({a.validLow_um(), b.validLow_um(), 0.3}), high = std::min({a.validHigh_um(), b.validHigh_um(), 15.0});
  double worst = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double w = std::clamp(low * std::pow(high / low, i / 1000.0), low, high);
    worst = std::max(worst, std::abs(a.reflectance(w, 0.0) - b.reflectance(w, 0.0)));
    worst = std::max(worst, std::abs(a.emissivity(w, 0.0) - b.emissivity(w, 0.0)));
  }
  return worst;
}

TEST(EditedMaterial, LibraryMaterialsBecomeCurves) {
  using enum CurveKind;
  double plain = 0.0, others = 0.0;
  for (const char* name : {"grey_aircraft_paint", "glass", "snow", "white_lambertian", "blackbody", "conifer", "phong_r3"}) {
    const EditedMaterial m = EditedMaterial::named(name, editLibraries());
    plain = std::max(plain, curvesApart(*m.material(), *readMaterialFile(editLibraries().materials / (std::string(name) + ".yaml"), editLibraries())));
    EXPECT_FALSE(m.film()) << name;
    EXPECT_FALSE(m.surface().description.empty()) << name;
  }
  bound("library materials of plain spectra as curves, off by", plain, kCurveTolerance, "asked for");
  EXPECT_NEAR(EditedMaterial::named("glass", editLibraries()).curve(Exponent).at(1.0), 1000.0, 1e-9);
  for (const char* name : {"gold", "acrylic_canopy"}) {
    const EditedMaterial m = EditedMaterial::named(name, editLibraries());
    const auto file = readMaterialFile(editLibraries().materials / (std::string(name) + ".yaml"), editLibraries());
    for (double w = file->validLow_um() + 0.01; w < 15.0; w *= 1.03) others = std::max(others, std::abs(m.energyAt(w) - file->reflectance(w, 0.0)));
    EXPECT_FALSE(m.notes().empty());
  }
  bound("library materials without curves: reflectance at normal view as a curve, off by", others, kCurveTolerance, "asked for");
  const EditedMaterial film = EditedMaterial::named("anodised_titanium", editLibraries());
  ASSERT_TRUE(film.film());
  EXPECT_NEAR(film.film()->thickness_um, 0.06, 1e-12);
  EXPECT_EQ(film.film()->substrate, "titanium");
  bound("anodised titanium as a film of curves, reflectance, off by",
        curvesApart(*film.material(), *readMaterialFile(editLibraries().materials / "anodised_titanium.yaml", editLibraries())), 2.0 * kCurveTolerance,
        "indices followed to 2.5e-4 each");
  EXPECT_THROW(EditedMaterial::named("oil_smoke", editLibraries()), UserError);
  EXPECT_THROW(EditedMaterial::named("grey_aircraft_paimt", editLibraries()), UserError);
}

TEST(EditedMaterial, FilesBecomeCurves) {
  using enum CurveKind;
  const TemporaryFolder folder;
  // Its own text again: the same curves.
  EditedMaterial m({}, editLibraries());
  m.setCurve(Specular, EditedCurve({{0.4, 0.1}, {0.7, 0.5}, {2.0, 0.2}}));
  m.setCurve(Exponent, EditedCurve({{0.4, 30.0}, {2.0, 30.0}}, false, axisOf(Exponent).bounds));
  m.setCurve(Emissivity, EditedCurve({{0.4, 0.2}, {2.0, 0.1}}));
  const EditedMaterial again = EditedMaterial::named(folder.put("own.yaml", m.yaml("by hand", "")), editLibraries());
  EXPECT_EQ(again.name(), "own");
  for (CurveKind kind : {Diffuse, Specular, Exponent, Emissivity})
    for (double w : {0.3, 0.5, 0.69, 0.8, 1.9, 12.0}) EXPECT_NEAR(again.curve(kind).at(w), m.curve(kind).at(w), 1e-9) << axisOf(kind).name;
  // Spectra and optical constants of others.
  const EditedMaterial columns =
      EditedMaterial::named(folder.put("paint.txt", "Wavelength (um)  Reflectance (percent)\n0.4 10\n0.6 30\n1.0 20\n"), editLibraries());
  EXPECT_NEAR(columns.curve(Diffuse).at(0.5), 0.2, kCurveTolerance);
  const EditedMaterial index =
      EditedMaterial::named(folder.put("n.yml", "DATA:\n  - type: tabulated nk\n    data: |\n      0.4 1.5 0.0\n      2.0 1.5 0.0\n"), editLibraries());
  EXPECT_NEAR(index.curve(Diffuse).at(1.0), 0.04, 1e-9);
  EXPECT_NEAR(index.curve(FilmIndex).at(1.0), 1.5, 1e-9);
  EXPECT_FALSE(index.notes().empty());
}

}  // namespace
}  // namespace pitviper::test
