// Spheres of a material drawn on the CPU against sums over wavelengths at each pixel and closed forms; how unlike two materials look.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "materials/brdf_table.hpp"
#include "materials/reflection.hpp"
#include "scenarios/view/eye_channels.hpp"
#include "scenarios/view/sphere_picture.hpp"
#include "sim/image/srgb.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const std::filesystem::path kHome = PITVIPER_SOURCE_DIR;

const std::vector<SphereChannel>& eye() {
  static const auto channels = eyeChannels({kHome / "materials/library", kHome / "atmosphere/library", kHome / "sensors/library"});
  return channels;
}

const std::string kLooking =
    "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 20 mm, position: [9 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], channels: "
    "[{name: v, response: {band: [0.6 um, 0.62 um]}}]}]\n";

/// By its text, or of the library.
std::shared_ptr<const Material> sphereMaterial(const std::string& components) {
  return scene("materials: {m: {" + components + "}}\n" + kLooking).materials.front();
}
std::shared_ptr<const Material> knownMaterial(const std::string& name) {
  return scene("entities: [{name: b, shape: {model: sphere, radius: 1 m}, material: " + name + ", temperature: 300 K}]\n" + kLooking).materials.front();
}

Spectrum lightOfLibrary(const std::string& name) {
  return scene("sun: {azimuth: 0 deg, elevation: 40 deg, irradiance: {product: [\"1 W/(m2 um)\", " + name + "]}}\n" + kLooking).sun->irradiance;
}

const SphereChannel kInfrared{"lw", "W/(m2 sr)", Spectrum::band(8.0, 12.0)};

struct Seen {
  glm::dvec3 normal, light, view;  ///< the two in the frame of the normal
};

/// What a pixel's middle shows, or nothing; of its own making.
std::optional<Seen> seenAt(const SphereView& view, const glm::dvec3& direction, int column, int row) {
  const double x = (column + 0.5 - view.centre_px.x) / view.radius_px, y = (view.centre_px.y - row - 0.5) / view.radius_px, r2 = x * x + y * y;
  if (r2 >= 1.0) return std::nullopt;
  Seen s;
  s.normal = {x, y, std::sqrt(1.0 - r2)};
  const glm::dvec3 light = glm::normalize(direction), side = glm::normalize(glm::cross(glm::dvec3(0.3, -0.5, 0.2), s.normal)),
                   other = glm::cross(s.normal, side);
  const auto inFrame = [&](const glm::dvec3& d) { return glm::dvec3(glm::dot(d, side), glm::dot(d, other), glm::dot(d, s.normal)); };
  s.light = inFrame(light), s.view = inFrame({0.0, 0.0, 1.0});
  return s;
}

std::size_t pixelOf(const SphereView& view, int column, int row) { return static_cast<std::size_t>(row * view.side + column); }

/// The curves of `bench --phong` over 0.38 to 0.78 um.
struct Curves {
  const char* name;
  double (*diffuse)(double);
  double (*specular)(double);
  double (*exponent)(double);
  double far, near;  ///< RMS error of the paper's Table 1 (b) and (e), in 8-bit units
};
const Curves kCurves[] = {{"R1, exponents 5 to 40", [](double u) { return 0.2 + 0.3 * u; }, [](double u) { return 0.6 - 0.2 * u; },
                           [](double u) { return 5.0 + 35.0 * u; }, 0.067, 0.570},
                          {"R2, exponents 20 to 200", [](double u) { return 0.5 - 0.4 * u; }, [](double u) { return 0.3 + 0.3 * std::sin(3.0 * u); },
                           [](double u) { return 200.0 - 180.0 * u; }, 0.177, 1.570},
                          {"R3, exponents 300 to 1000", [](double u) { return 0.1 + 0.2 * u * u; }, [](double u) { return 0.5 + 0.2 * std::cos(6.0 * u); },
                           [](double u) { return 300.0 + 700.0 * u; }, 0.040, 0.189}};

std::shared_ptr<const Material> spectralPhong(const Curves& c) {
  const auto table = [](double (*f)(double)) {
    std::string text = "{wavelength: um, unit: \"1\", outside: hold, values: [";
    for (int k = 0; k <= 80; ++k) text += print("%s[%.4f, %.9g]", k ? ", " : "", 0.38 + 0.005 * k, f(k / 80.0));
    return text + "]}";
  };
  return sphereMaterial("components: [{reflection: spectral_phong, diffuse: " + table(c.diffuse) + ", specular: " + table(c.specular) +
                        ", exponent: " + table(c.exponent) + "}]");
}

// Rationale: the paper's own measure. Expected: tables are no further off than its own with 200 entries.
TEST(SpherePicture, SpectralPhongBeatsThePaper) {
  constexpr int kSide = 64;
  const glm::dvec3 direction(0.4, 0.5, 1.0), half = glm::normalize(glm::normalize(direction) + glm::dvec3(0.0, 0.0, 1.0));
  for (const Curves& curves : kCurves) {
    const auto material = spectralPhong(curves);
    struct Wave {
      glm::dvec3 xyz;
      double diffuse, specular, exponent;
    };
    std::vector<Wave> waves;
    for (int nm = 361; nm < 830; ++nm) {
      const double w = 1e-3 * nm, u = std::clamp((w - 0.38) / 0.4, 0.0, 1.0);
      Wave wave{{}, curves.diffuse(u), curves.specular(u), curves.exponent(u)};
      for (int k = 0; k < 3; ++k) wave.xyz[k] = 1e-3 * eye()[static_cast<std::size_t>(k)].kernel(w);
      waves.push_back(wave);
    }
    for (bool near : {false, true}) {
      SphereView view{kSide, (near ? 420.0 : 110.0) / 256.0 * kSide, glm::dvec2(0.5 * kSide), 0.0};
      if (near) view.centre_px += view.radius_px * glm::dvec2(-half.x, half.y);
      const auto drawn = SpherePicture(eye(), {Spectrum(1.0), direction}, view).draw(*material);
      std::vector<glm::dvec3> exact, ours;
      double most = 0.0, worst = 0.0, mostY = 0.0;
      for (float y : drawn[1]) mostY = std::max(mostY, static_cast<double>(y));
      for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
          const auto seen = seenAt(view, direction, column, row);
          if (!seen) continue;
          glm::dvec3 xyz(0.0);
          const double t = 2.0 * seen->normal.z * seen->light.z - glm::normalize(direction).z;
          if (seen->light.z > 0.0)
            for (const Wave& w : waves)
              xyz += seen->light.z * w.xyz * (w.diffuse / kPi + (t > 0.0 ? w.specular * (w.exponent + 2.0) / (2.0 * kPi) * std::pow(t, w.exponent) : 0.0));
          exact.push_back(linearSrgb(xyz));
          most = std::max({most, exact.back().x, exact.back().y, exact.back().z});
          const std::size_t p = pixelOf(view, column, row);
          ours.push_back(linearSrgb({drawn[0][p], drawn[1][p], drawn[2][p]}));
          worst = std::max(worst, std::abs(static_cast<double>(drawn[1][p]) - xyz.y) / std::max(xyz.y, 1e-3 * mostY));
        }
      double sum = 0.0;
      for (std::size_t k = 0; k < ours.size(); ++k) sum += glm::dot(ours[k] - exact[k], ours[k] - exact[k]);
      bound(print("sphere, %s, %s, RMS error of linear sRGB in 8-bit units", curves.name, near ? "near" : "far"),
            255.0 / most * std::sqrt(sum / (3.0 * static_cast<double>(ours.size()))), near ? curves.near : curves.far,
            "Table 1 of the paper, 200 entries; against sums at 1 nm steps, the brightest is 255");
      bound(print("sphere, %s, %s, worst error of Y at a pixel", curves.name, near ? "near" : "far"), worst, view.tolerance, "accuracy 1e-3");
    }
  }
}

TEST(SpherePicture, LambertianSphereInClosedForm) {
  const auto material = sphereMaterial("components: [{reflection: lambertian, reflectance: 0.4}]");
  const glm::dvec3 direction(-1.0, 0.3, 0.5);
  const SphereView view{96, 40.0, {50.0, 46.0}, 0.0};
  const auto drawn = SpherePicture({kInfrared}, {Spectrum(2.0), direction}, view).draw(*material);
  double worst = 0.0, flux = 0.0;
  for (int row = 0; row < view.side; ++row)
    for (int column = 0; column < view.side; ++column) {
      const auto seen = seenAt(view, direction, column, row);
      const double is = static_cast<double>(drawn[0][pixelOf(view, column, row)]), expected = seen ? 0.4 / kPi * 8.0 * std::max(seen->light.z, 0.0) : 0.0;
      worst = std::max(worst, std::abs(is - expected));
      flux += is;
    }
  bound("Lambertian sphere, worst pixel's error of the brightest", worst / (0.4 / kPi * 8.0), 1e-6, "rho E cos / pi; single precision");
  // Lambert's phase function, of the angle g between lamp and viewer.
  const double g = std::acos(glm::normalize(direction).z);
  figure("Lambertian sphere, all light that reaches the viewer", flux,
         2.0 / 3.0 * 0.4 * 8.0 * view.radius_px * view.radius_px * (std::sin(g) + (kPi - g) * std::cos(g)) / kPi, 2e-3,
         "2/3 rho E r^2 (sin g + (pi - g) cos g) / pi; pixels' middles at the edge");
}

TEST(SpherePicture, WarmSpheresInClosedForm) {
  const SphereView view{32, 15.0, {16.0, 16.0}, 300.0};
  const auto black = SpherePicture({kInfrared}, {}, view).draw(*knownMaterial("blackbody"));
  figure("black sphere of 300 K in 8 to 12 um, its middle [W/(m2 sr)]", static_cast<double>(black[0][pixelOf(view, 16, 16)]), blackBodyBand(8, 12, 300), 1e-5,
         "Planck's law by its series; single precision and a tenth of an accuracy of 1e-3 for wavelengths");
  // What films emit changes with wavelength and view.
  const auto titanium = knownMaterial("anodised_titanium");
  const auto warm = SpherePicture({kInfrared}, {}, view).draw(*titanium);
  double off = 0.0;
  for (int column = 16; column < 31; ++column) {
    const double angle = std::acos(seenAt(view, {0, 0, 1}, column, 16)->view.z);
    double sum = 0.0;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
      const double w = 8.0 + 4.0 * (i + 0.5) / kSteps;
      sum += 4.0 / kSteps * titanium->emissivity(w, angle) * physics::planckRadiance(w, 300.0);
    }
    off = std::max(off, std::abs(static_cast<double>(warm[0][pixelOf(view, column, 16)]) / sum - 1.0));
  }
  bound("anodised_titanium at 300 K, worst error of 15 pixels from its middle to its edge", off, view.tolerance,
        "emissivity x Planck's law summed at 20 nm steps; tolerance 1e-3");
  // Within walls as warm as itself everything that is opaque looks black.
  SphereLight within;
  within.ambient = Spectrum(Spectrum::BlackBody{300.0, 1.0});
  for (const char* name : {"grey_aircraft_paint", "anodised_titanium"}) {
    const auto drawn = SpherePicture({kInfrared}, within, view).draw(*knownMaterial(name));
    double worst = 0.0;
    for (int row = 0; row < view.side; ++row)
      for (int column = 0; column < view.side; ++column)
        if (seenAt(view, {0, 0, 1}, column, row))
          worst = std::max(worst, std::abs(static_cast<double>(drawn[0][pixelOf(view, column, row)]) / blackBodyBand(8, 12, 300) - 1.0));
    bound(std::string(name) + " at 300 K within walls of 300 K, worst pixel's error", worst, 2e-4, "Kirchhoff's law; a tenth of an accuracy of 1e-3, twice");
  }
}

// Rationale: whatever the model and its axes, a pixel is the integral of light x BRDF. Expected: off by the accuracy asked, at most.
TEST(SpherePicture, AnyMaterialAgainstItsBrdf) {
  const glm::dvec3 direction(0.5, 0.2, 0.8);
  const SphereView view{64, 30.0, {32.0, 32.0}, 0.0};
  const Spectrum daylight = lightOfLibrary("cie_d65");
  std::vector<std::pair<std::string, std::shared_ptr<const Material>>> materials;
  for (const char* name : {"gold", "grey_aircraft_paint", "anodised_titanium"}) materials.emplace_back(name, knownMaterial(name));
  for (const char* component :
       {"{reflection: ward, reflectance: 0.6, roughness: 0.15}", "{reflection: sandford_robertson, emissivity: 0.55, diffuse: 0.25, grazing: 0.25, width: 0.2}",
        "{reflection: beard_maxwell, n: 1.5, k: 0.1, scan: 0.0008, width: 0.2, tau: 30 deg, omega: 40 deg, diffuse: 0.05}"})
    materials.emplace_back(std::string(component).substr(1, std::string(component).find(',') - 1),
                           sphereMaterial(std::string("components: [") + component + "]"));
  const Angle pairs[][2] = {{Angle::Half, Angle::Difference}, {Angle::HalfRoot, Angle::View}, {Angle::Difference, Angle::Specular}};
  for (const auto& pair : pairs) {
    // Rugged, over two angles and three wavelengths.
    BrdfTable table{{0.3, 0.55, 0.9}, {AngleAxis{pair[0], 5, 1.4}, AngleAxis{pair[1], 3, 1.5}}, {}};
    for (int k = 0; k < 3 * 5 * 3; ++k) table.values.push_back(0.02 + 0.01 * (k * k % 11));
    auto made = std::make_shared<Material>();
    made->reflections = {makeTabulated(table)};
    made->modifiers = {-1};
    materials.emplace_back(print("a table over angles %d and %d", static_cast<int>(pair[0]), static_cast<int>(pair[1])), made);
  }
  for (const auto& [name, material] : materials) {
    const auto drawn = SpherePicture(eye(), {daylight, direction}, view).draw(*material);
    std::mt19937 random(7);
    std::vector<Seen> seen;
    std::vector<std::size_t> pixels;
    while (seen.size() < 50) {
      const int column = static_cast<int>(random() % 64), row = static_cast<int>(random() % 64);
      const auto s = seenAt(view, direction, column, row);
      if (!s || s->light.z <= 0.0) continue;
      seen.push_back(*s), pixels.push_back(pixelOf(view, column, row));
    }
    std::vector<glm::dvec3> sums(seen.size(), glm::dvec3(0.0));
    constexpr int kSteps = 470;
    const double low = eye()[0].kernel.supportLow(), step = (eye()[0].kernel.supportHigh() - low) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double w = low + (i + 0.5) * step;
      glm::dvec3 weight;
      for (int k = 0; k < 3; ++k) weight[k] = step * eye()[static_cast<std::size_t>(k)].kernel(w) * daylight(w);
      for (std::size_t p = 0; p < seen.size(); ++p)
        for (const auto& r : material->reflections) sums[p] += weight * r->brdf(w, seen[p].light, seen[p].view) * seen[p].light.z;
    }
    double worst = 0.0;
    glm::dvec3 most(0.0);
    for (const auto& picture : {0, 1, 2})
      most[picture] = static_cast<double>(*std::max_element(drawn[static_cast<std::size_t>(picture)].begin(), drawn[static_cast<std::size_t>(picture)].end()));
    for (std::size_t p = 0; p < seen.size(); ++p)
      for (int k = 0; k < 3; ++k)
        worst =
            std::max(worst, std::abs(static_cast<double>(drawn[static_cast<std::size_t>(k)][pixels[p]]) - sums[p][k]) / std::max(sums[p][k], 1e-3 * most[k]));
    bound("sphere of " + name + ", worst error of X, Y or Z at 50 pixels", worst, view.tolerance, "its BRDF summed at 1 nm steps; tolerance 1e-3");
  }
}

TEST(SpherePicture, TemperaturesHaveTheirStates) {
  const auto material = sphereMaterial(
      "temperatures: [{temperature: 300 K, components: [{reflection: lambertian, reflectance: 0.8}]}, {temperature: 500 K, components: [{reflection: "
      "lambertian, reflectance: 0.2}]}]");
  const auto middle = [&](double temperature_K) {
    const SphereView view{3, 10.0, {1.5, 1.5}, temperature_K};
    return static_cast<double>(SpherePicture({kInfrared}, {}, view).draw(*material)[0][4]) / blackBodyBand(8, 12, temperature_K);
  };
  figure("emissivity of a surface known as 0.2 at 300 K and 0.8 at 500 K, at 350 K", middle(350.0), 0.35, 1e-4, "linear between states");
  figure("the same at 700 K", middle(700.0), 0.8, 1e-4, "the last state");
}

TEST(SpherePicture, RefusesWhatItCannotDraw) {
  const auto infrared =
      sphereMaterial("components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", outside: error, values: [[0.5, 0.1], [9, 0.2]]}}]");
  const SpherePicture picture({kInfrared}, {Spectrum(1.0), {0, 0, 1}}, {});
  try {
    picture.draw(*infrared);
    FAIL() << "no data from 9 to 12 um";
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("channel 'lw'"), std::string::npos) << e.what();
  }
  const Spectrum lamp(Spectrum::Table{{1.0, 9.0}, {1.0, 1.0}, Outside::Error, "lamp"});
  EXPECT_THROW(SpherePicture({kInfrared}, {lamp, {0, 0, 1}}, {}), UserError) << "no light known from 9 to 12 um";
  EXPECT_THROW(SpherePicture({}, {}, {}), UserError);
  EXPECT_THROW(SpherePicture({kInfrared}, {Spectrum(1.0), {0, 0, 0}}, {}), UserError);
}

TEST(SpherePicture, MetamersMatchUnderOneLight) {
  const Simulation sim =
      readScenario(kHome / "scenarios/metamers.yaml", {}, {kHome / "materials/library", kHome / "atmosphere/library", kHome / "sensors/library"});
  const auto paint = [&](const std::string& name) {
    return *std::find_if(sim.materials.begin(), sim.materials.end(), [&](const auto& m) { return m->name == name; });
  };
  const auto difference = [&](const Spectrum& light) {
    return colourDifference(xyzOf(*paint("left_paint"), light, eye()), xyzOf(*paint("right_paint"), light, eye()), whiteOf(light, eye()));
  };
  const Spectrum d65 = lightOfLibrary("cie_d65");
  bound("colour difference of two metamers under D65 [L*a*b*]", difference(d65), 0.1, "made to match: five digits of their curves");
  bound("1 / the same under illuminant A", 1.0 / difference(lightOfLibrary("cie_a")), 0.2, "an eye tells 1 apart; 5 at least here");
  const glm::dvec3 white = whiteOf(d65, eye());
  figure("white point of D65, X", white.x, 0.95047, 2e-4, "CIE 15; 5 nm steps in vacuum");
  figure("white point of D65, Z", white.z, 1.08883, 2e-4, "CIE 15; 5 nm steps in vacuum");
  const auto grey = sphereMaterial("components: [{reflection: lambertian, reflectance: 0.18418652}]");
  figure("lightness of a grey of 18.4 %", labOf(xyzOf(*grey, d65, eye()), white).x, 50.0, 1e-4, "L* = 116 Y^(1/3) - 16");
}

}  // namespace
}  // namespace pitviper::test
