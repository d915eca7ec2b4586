// A medium in one file: soot of small particles, absorption 6 pi E f_v / lambda (Rayleigh limit; Source: Modest, Radiative Heat Transfer, 3rd ed.,
// section 12.9; E = Im((m^2 - 1) / (m^2 + 2))). No other file knows it.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/media.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

MediumModel sootModel() {
  return {"soot",
          "Soot of particles much smaller than the wavelength.",
          {required(within(number("volume_fraction", "", "soot by volume"), 0.0, 1.0)),
           withDefault(within(number("refraction", "", "E of its refractive index"), 0.0, 1.0), "0.26")},
          [](const ModelRecord& r) {
            const double factor_um = 6.0 * kPi * r.record.number("refraction") * r.record.number("volume_fraction") * 1e6;
            Spectrum::Table inverse;
            for (double w = kShortestWavelength_um; w < kLongestWavelength_um; w *= 1.002) {
              inverse.wavelength_um.push_back(w);
              inverse.value.push_back(factor_um / w);
            }
            inverse.name = "soot";
            return Medium{Spectrum(inverse), {}};
          }};
}

[[maybe_unused]] const bool kRegistered = mediumModels().add(sootModel());

constexpr double kFraction = 1e-7, kDepth_m = 3.0;

}  // namespace

namespace test {
namespace {

std::string sootScene(const std::string& material) {
  return "materials: {flame: " + material +
         "}\nentities:\n- {name: wall, shape: {model: plate, width: 20 m, height: 20 m}, material: blackbody, temperature: 700 K, position: [-5 m, 0 m, 0 m]}\n"
         "- {name: flame, shape: {model: box, length: 9 m, width: 3 m, height: 9 m}, material: flame, temperature: 1500 K, heading: 0 deg, position: [0 m, 0 "
         "m, 0 m]}\n"
         "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 0.02 deg, aperture: 20 mm, position: [30 m, 0 m, 0 m], look_at: wall, "
         "channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
}

// B(T) (1 - tau) + B(wall) tau, tau = exp(-6 pi E f_v d / lambda), integrated here by the midpoint rule.
TEST(Soot, EmitsAndHidesByItsVolume) {
  double expected = 0.0;
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    const double w = 3.0 + 2.0 * (i + 0.5) / kSteps, tau = std::exp(-6.0 * kPi * 0.26 * kFraction * 1e6 / w * kDepth_m);
    expected += (physics::planckRadiance(w, 1500.0) * (1.0 - tau) + physics::planckRadiance(w, 700.0) * tau) * 2.0 / kSteps;
  }
  for (const auto& [accuracy, allowed] : {std::pair{"", 2e-5}, {"accuracy: 1 %\n", 0.01}, {"accuracy: reference\n", 2e-5}}) {
    const Frame f = renderFrame(scene(accuracy + sootScene("{medium: soot, volume_fraction: 1e-7}")));
    figure(std::string("a wall at 700 K behind 3 m of soot at 1500 K [W/(m2 sr)]") + (*accuracy ? ", planned or by the reference" : ", sampled"),
           at(layer(f, "mw.radiance"), f, 4, 4), expected, allowed, "Rayleigh limit; between rows of its table 2e-6, the accuracy");
  }
}

std::string refusal(const std::string& material) {
  try {
    scene(sootScene(material));
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(Soot, IsReadByItsTable) {
  EXPECT_NE(keyReference().find("### material: soot"), std::string::npos);
  EXPECT_NE(refusal("{medium: soot}").find("missing key 'volume_fraction'"), std::string::npos) << refusal("{medium: soot}");
  EXPECT_NE(refusal("{medium: sot, volume_fraction: 1e-7}").find("did you mean 'soot'?"), std::string::npos);
  EXPECT_NE(refusal("{medium: soot, volume_fraction: 1e-7, components: []}").find("a medium with 'components'"), std::string::npos);
  EXPECT_NE(refusal("{medium: soot, volume_fraction: 1e-7, absorption: 1 /m}").find("absorption"), std::string::npos) << "a gas's";
}

TEST(MediumModels, TwoOfOneNameAreRefused) {
  Registry<MediumModel> two("medium", {sootModel(), sootModel()});
  EXPECT_THROW(two.all(), std::logic_error);
}

}  // namespace
}  // namespace test
}  // namespace pitviper
