// Tables of spectral Phong lobes: the paper's scheme, its baseline, and steps of the angle; and the material that is read so.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/models.hpp"
#include "scenarios/commands/phong_tables.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

PhongLobe lobeOf(double low, double high) {
  return [low, high](double t) {
    double sum = 0.0;
    for (int k = 0; k <= 20; ++k) sum += std::pow(t, low + (high - low) * k / 20.0) / 21.0;
    return PhongColour{sum, sum, sum};
  };
}

/// Root mean square over the solid angle of the lobe's half space.
double rms(const PhongTable& table, const PhongLobe& lobe) {
  double sum = 0.0;
  constexpr int kPlaces = 20000;
  for (int k = 0; k < kPlaces; ++k) {
    const double t = (k + 0.5) / kPlaces;
    sum += std::pow(table.at(t)[0] - lobe(t)[0], 2.0) / kPlaces;
  }
  return std::sqrt(sum);
}

TEST(PhongTables, StepsOfTheAngleBeatImportance) {
  for (const auto& [low, high] :
       {std::pair{10.0, 10.0}, std::pair{100.0, 100.0}, std::pair{1000.0, 1000.0}, std::pair{5.0, 40.0}, std::pair{20.0, 200.0}, std::pair{300.0, 1000.0}}) {
    const PhongLobe lobe = lobeOf(low, high);
    const double uniform = rms(UniformTable(lobe, 200), lobe), importance = rms(ImportanceTable(lobe, 200, 10), lobe), angle = rms(AngleTable(lobe, 200), lobe);
    bound(print("angle over importance, exponents %g to %g, 200 entries", low, high), angle / importance, low < 11.0 ? 1.0 : 0.1,
          "a tenth asked; parabolas hold broad lobes well");
    bound(print("importance over uniform, exponents %g to %g", low, high), importance / uniform, 1.0, "the paper's finding");
  }
}

TEST(PhongTables, ImportanceSplitsAlike) {
  // cos^n: the share of the integral below t is t^(n+1): the middle of two segments at 0.5^(1/(n+1)). A parabola is exact on a parabola.
  const PhongLobe parabola = [](double t) { return PhongColour{t * t, 1.0 - t * t, 0.3}; };
  const ImportanceTable table(parabola, 41, 4);
  for (double t : {0.0, 0.123, 0.5, 0.71, 0.999, 1.0})
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(table.at(t)[c], parabola(t)[c], 1e-12) << t;
}

std::shared_ptr<const Material> material(const std::string& component) {
  return scene("materials: {m: {components: [" + component +
               "]}}\ncameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 20 mm, position: [1 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 "
               "m], "
               "channels: [{name: v, response: {band: [0.6 um, 0.62 um]}}]}]\n")
      .materials.front();
}

TEST(SpectralPhong, IsPhongAtEachWavelength) {
  const auto m = material(
      "{reflection: spectral_phong, diffuse: 0.2, specular: {wavelength: um, unit: \"1\", values: [[0.3, 0.1], [1, 0.7]]}, exponent: {wavelength: um, unit: "
      "\"1\", "
      "values: [[0.3, 20], [1, 160]]}}");
  for (double w : {0.35, 0.6, 0.95}) {
    const double n = 20.0 + 140.0 * (w - 0.3) / 0.7, rho = 0.1 + 0.6 * (w - 0.3) / 0.7;
    const auto plain = material(print("{reflection: phong, reflectance: %.12g, exponent: %.12g}", rho, n));
    for (double degrees : {0.0, 40.0, 70.0, 85.0})
      figure(print("hemispherical reflectance at %g um, %g deg", w, degrees), m->reflectance(w, degrees * kPi / 180.0),
             0.2 + plain->reflectance(w, degrees * kPi / 180.0), 1e-3, "25 exponents and 91 angles, linear between");
    const glm::dvec3 l(std::sin(0.5), 0.0, std::cos(0.5)), v(-std::sin(0.6), 0.0, std::cos(0.6));
    figure(print("BRDF 0.1 rad off the mirror at %g um", w), m->reflections[0]->brdf(w, l, v),
           0.2 / kPi + rho * (n + 2.0) / (2.0 * kPi) * std::pow(std::cos(0.1), n), 1e-9, "the formula");
  }
  // Exponents that differ by rounding alone.
  EXPECT_NEAR(
      material(
          "{reflection: spectral_phong, diffuse: 0.1, specular: 0.5, exponent: {wavelength: um, unit: \"1\", values: [[0.3, 7], [1, 7.0000000000000009]]}}")
          ->reflectance(0.5, 0.0),
      0.6, 1e-6);
  EXPECT_THROW(material("{reflection: spectral_phong, diffuse: 0.5, specular: 0.6, exponent: 10}"), UserError);
}

}  // namespace
}  // namespace pitviper::test
