// A reflection model of one file (and its lobe's body): it shines back to where light came from. No other file knows of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "tests/extensions/retro.glsl"
#undef PHYSICS
}  // namespace physics

namespace test {
namespace {

class Retro final : public ReflectionComponent {
 public:
  /// `soot`: share of it that covers the surface and reflects nothing.
  Retro(Spectrum reflectance, double exponent, double soot)
      : ReflectionComponent({"tests/extensions/retro.glsl", "retroLobe", {exponent, 0.0, 0.0, 0.0}, (exponent + 2.0) / (2.0 * kPi), exponent}),
        albedo_(makePhong(Spectrum(1.0), exponent)),
        reflectance_(std::move(reflectance)),
        clean_(1.0 - soot) {}
  double column(double w, double, double) const override { return clean_ * reflectance_(w); }
  double lobeAt(const glm::dvec3& l, const glm::dvec3& v) const override { return physics::retroLobe(lobe().parameters, {0, 0, 1}, l, v); }
  double hemispherical(double w, double angle) const override { return clean_ * reflectance_(w) * albedo_->hemispherical(w, angle); }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return reflectance_.knots(); }
  double validLow_um() const override { return reflectance_.validLow(); }
  double validHigh_um() const override { return reflectance_.validHigh(); }

 private:
  std::shared_ptr<const ReflectionComponent> albedo_;
  Spectrum reflectance_;
  double clean_;
};

ReflectionModel retroModel() {
  return {"retro",
          "Sends light back to where it came from.",
          {required(within(spectrum("reflectance", "", "at normal view"), 0, 1)), withDefault(within(number("sharpness", "", "of its lobe"), 0, 1e6), "40")},
          [](const ComponentRecord& r) { return std::make_shared<Retro>(r.spectrum("reflectance"), r.record.number("sharpness"), r.state); },
          {},
          StateParameter{"soot", "", "share of the surface that it covers", 0.0, 1.0, 0.0, 2},
          {"tests/extensions/retro.glsl", readFileStart(std::filesystem::path(PITVIPER_SOURCE_DIR) / "tests/extensions/retro.glsl", 1 << 20)}};
}
const bool registered = reflectionModels().add(retroModel());

/// A plate that faces +x under a sun at an elevation towards it, seen from 10 m at the same elevation on the sun's side or on the mirrored one.
double seen(const std::string& components, double elevation_deg, double view_deg, const std::string& accuracy = "") {
  const double s = std::sin(view_deg * kPi / 180.0), c = std::cos(view_deg * kPi / 180.0);
  const Frame f = renderFrame(
      scene(accuracy + "materials: {m: {components: [" + components + "]}}\nsun: {azimuth: 90 deg, elevation: " + std::to_string(elevation_deg) +
            " deg, irradiance: 100 W/(m2 um)}\nentities: [{name: p, shape: {model: plate, width: 40 m, height: 40 m}, material: m, temperature: 0 K}]\n"
            "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [" +
            std::to_string(10.0 * c) + " m, 0 m, " + std::to_string(10.0 * s) +
            " m], look_at: [0 m, 0 m, 0 m], channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n"));
  return at(layer(f, "mw.radiance"), f, 4, 4);
}

const std::string kRetro = "{reflection: retro, reflectance: 0.2, sharpness: 60}", kPhong = "{reflection: phong, reflectance: 0.15, exponent: 90}",
                  kFlat = "{reflection: lambertian, reflectance: 0.1}";

// L = E cos rho (n + 2)/(2 pi) x 2 um on the lobes' axes, 40 degrees from the normal.
TEST(Retro, ShinesBack) {
  const double in = 100.0 * std::cos(40.0 * kPi / 180.0) * 2.0;
  figure("a retroreflecting plate, seen from where the sun is [W/(m2 sr)]", seen(kRetro, 40.0, 40.0), in * 0.2 * 62.0 / (2.0 * kPi), 1e-5,
         "E cos rho (n + 2)/(2 pi); pixel of 1e-5 rad");
  EXPECT_LT(seen(kRetro, 40.0, -40.0), 1e-9);
}

// Five components and two lobes of different models in one material: each where it belongs, drawn and planned.
TEST(Retro, BesideOtherLobes) {
  const double in = 100.0 * std::cos(40.0 * kPi / 180.0) * 2.0, flat = in * 0.3 / kPi;
  const std::string all = kRetro + ", " + kFlat + ", " + kPhong + ", " + kFlat + ", " + kFlat;
  figure("five components, two lobes, seen from the sun [W/(m2 sr)]", seen(all, 40.0, 40.0), flat + in * 0.2 * 62.0 / (2.0 * kPi), 1e-5, "both closed forms");
  figure("the same, seen from the mirrored side [W/(m2 sr)]", seen(all, 40.0, -40.0), flat + in * 0.15 * 92.0 / (2.0 * kPi), 1e-5, "both closed forms");
  figure("the same, planned at 1 %", seen(all, 40.0, -40.0, "accuracy: 1 %\n"), flat + in * 0.15 * 92.0 / (2.0 * kPi), 0.01, "asked for");
}

// A number or a texture of soot: what it covers is black, and emits as much as it no longer reflects.
TEST(Retro, UnderSootFromATexture) {
  const double lobe = 100.0 * std::cos(40.0 * kPi / 180.0) * 2.0 * 0.2 * 62.0 / (2.0 * kPi), flat = 100.0 * std::cos(40.0 * kPi / 180.0) * 2.0 * 0.1 / kPi;
  const std::string end = kRetro.substr(0, kRetro.size() - 1) + ", soot: ";
  figure("a retroreflecting plate, three quarters of it covered [W/(m2 sr)]", seen(end + "0.75}", 40.0, 40.0), 0.25 * lobe, 1e-5, "closed form");
  figure("the same from a texture that is even", seen(end + "{rows: [[0.75, 0.75]]}}, " + kFlat, 40.0, 40.0), 0.25 * lobe + flat, 1e-5, "closed form");
  // From 0.2 on the left to 0.6 on the right: 0.4 in the middle.
  for (const char* accuracy : {"", "accuracy: 1 %\n", "accuracy: reference\n"})
    figure(std::string("the same from a texture that is not, ") + (*accuracy ? accuracy : "sampled"),
           seen(kFlat + ", " + end + "{rows: [[0.2, 0.6]]}}", 40.0, 40.0, accuracy), 0.6 * lobe + flat, *accuracy == 'a' && accuracy[10] == '1' ? 0.01 : 2e-5,
           "closed form, linear between texels");
}

// Thermal emission of the same: (1 - D (1 - s)) B, D of the lobe at 40 degrees.
TEST(Retro, SootEmitsWhatItNoLongerReflects) {
  const auto radianceOf = [](const std::string& soot) {
    const Frame f =
        renderFrame(scene("materials: {m: {components: [" + kRetro.substr(0, kRetro.size() - 1) + ", soot: " + soot +
                          "}]}}\nentities: [{name: p, shape: {model: plate, width: 40 m, height: 40 m}, material: m, temperature: 400 K}]\n"
                          "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [7.660444 m, 0 m, 6.427876 m], "
                          "look_at: p, channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n"));
    return at(layer(f, "mw.radiance"), f, 4, 4);
  };
  const double albedo = makePhong(Spectrum(0.2), 60.0)->hemispherical(4.0, 40.0 * kPi / 180.0), black = blackBodyBand(3, 5, 400);
  figure("emission of a plate under soot from a texture [W/(m2 sr)]", radianceOf("{rows: [[0.2, 0.6]]}"), (1.0 - 0.6 * albedo) * black, 1e-5, "Kirchhoff");
  figure("the same under an even one", radianceOf("0.4"), (1.0 - 0.6 * albedo) * black, 1e-5, "Kirchhoff");
}

// What the table of parameters says holds, in messages and in the reference of keys.
TEST(Retro, IsReadByItsTable) {
  EXPECT_NE(keyReference().find("### component: retro"), std::string::npos);
  EXPECT_NE(keyReference().find("`sharpness` | number |  | 40 | 0 to 1e+06 | of its lobe |"), std::string::npos);
  const auto refusal = [](const std::string& component) -> std::string {
    try {
      seen(component, 40.0, 40.0);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{reflection: retro}").find("missing key 'reflectance'"), std::string::npos) << refusal("{reflection: retro}");
  EXPECT_NE(refusal("{reflection: retro, reflectance: 0.2, exponent: 3}").find("'exponent'"), std::string::npos);
  EXPECT_NE(refusal("{reflection: retro, reflectance: 1.2}").find("0 to 1"), std::string::npos);
  EXPECT_NE(refusal("{reflection: retro, reflectance: 0.2, soot: 1.2}").find("'soot' is 1.2"), std::string::npos);
  EXPECT_NE(refusal("{reflection: retro, reflectance: 0.2, soot: {rows: [[0, 2]]}}").find("0 to 1"), std::string::npos);
  EXPECT_NE(refusal("{reflection: retr, reflectance: 0.2}").find("retro"), std::string::npos);
}

TEST(Registry, RefusesWhatCannotBe) {
  ReflectionModel twice = retroModel(), bare = retroModel();
  bare.name = "bare";
  bare.parameters.clear();
  Registry<ReflectionModel> a("reflection", {retroModel(), twice}), b("reflection", {bare});
  EXPECT_THROW(
      {
        try {
          a.all();
        } catch (const std::logic_error& e) {
          EXPECT_STREQ(e.what(), "two reflection models are called 'retro'");
          throw;
        }
      },
      std::logic_error);
  EXPECT_THROW(b.named("bare"), std::logic_error);
}

}  // namespace
}  // namespace test
}  // namespace pitviper
