// Reflection components and their hemispherical reflectance, the energy a material may return, and how its tables reach the renderer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/brdf_table.hpp"
#include "materials/energy.hpp"
#include "materials/phong_albedo.hpp"
#include "materials/reflection.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/render/assembly/tables.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

/// integral BRDF cos(theta_l) dw_l by equal steps about a pole in the plane of view: slow, and nothing of it is shared with the code
/// under test. `pole` is the pole's angle from the normal, positive on the viewer's side.
double byEqualSteps(const ReflectionComponent& r, double viewAngle, double pole, int rings, int azimuths) {
  const glm::dvec3 view(std::sin(viewAngle), 0, std::cos(viewAngle)), axis(std::sin(pole), 0, std::cos(pole)), side(std::cos(pole), 0, -std::sin(pole));
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double a = kPi * (i + 0.5) / rings;
    for (int j = 0; j < azimuths; ++j) {
      const double phi = kPi * (j + 0.5) / azimuths;
      const glm::dvec3 l = std::cos(a) * axis + std::sin(a) * (std::cos(phi) * side + std::sin(phi) * glm::dvec3(0, 1, 0));
      if (l.z > 0.0) sum += r.brdf(4.0, l, view) * l.z * std::sin(a);
    }
  }
  return sum * 2.0 * kPi / rings * kPi / azimuths;
}

TEST(Materials, PhongKeepsItsEnergyAndReciprocity) {
  for (double n : {0.0, 1.0, 30.0, 1000.0, 1e7}) {
    const auto phong = makePhong(Spectrum(0.6), n);
    figure("Phong, n = " + std::to_string(static_cast<long>(n)) + ", reflectance at normal view", phong->hemispherical(5.0, 0.0), 0.6, 1e-6,
           "(n + 2)/(2 pi) lobe integrates to 1");
    double last = 1.0;
    for (double a : {0.0, 0.4, 0.8, 1.2, 1.5}) {
      EXPECT_LE(phong->hemispherical(5.0, a), last + 1e-9);
      last = phong->hemispherical(5.0, a);
    }
    const glm::dvec3 l = glm::normalize(glm::dvec3(0.3, 0.1, 0.8)), v = glm::normalize(glm::dvec3(-0.2, -0.1, 0.7));
    EXPECT_NEAR(phong->brdf(5.0, l, v), phong->brdf(5.0, v, l), 1e-9 * (1.0 + phong->brdf(5.0, l, v)));
  }
  // The closed azimuth integral against integration over the hemisphere.
  for (double n : {0.0, 12.0, 3000.0, 1e7})
    for (double a : {0.0, 0.7, 1.3}) {
      const auto phong = makePhong(Spectrum(0.6), n);
      figure("Phong, n = " + std::to_string(static_cast<long>(n)) + ", reflectance at " + std::to_string(a).substr(0, 3) + " rad", phong->hemispherical(5.0, a),
             phong->ReflectionComponent::hemispherical(5.0, a), 1e-5, "integration about the mirrored view; grid of 0.25 deg in the closed form");
    }
}

/// Albedo of Phong's lobe by rings about the mirrored direction, each of equal weight in cos^(n+1), their azimuths in closed form.
double byRings(double n, double theta) {
  static const double edges[] = {0.0, 1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0};
  static const auto rings = fineNodes(0.0, 1.0, edges, 512);
  double sum = 0.0;
  for (const auto& node : rings) {
    const double c = std::pow(node.x, 1.0 / (n + 1.0)), a = std::cos(theta) * c, b = std::sin(theta) * std::sqrt(std::max(0.0, 1.0 - c * c));
    const double phi = b > a ? std::acos(std::clamp(-a / b, -1.0, 1.0)) : kPi;
    sum += node.weight * 2.0 * (phi * a + (b > a ? b * std::sin(phi) : 0.0));
  }
  return (n + 2.0) / (n + 1.0) / (2.0 * kPi) * sum;
}

TEST(Materials, PhongAlbedoIsWhatRingsSay) {
  double worst = 0.0;
  for (double n : {0.0, 0.7, 5.0, 40.0, 1000.0, 1e5, 1e7}) {
    const PhongAlbedo albedo(n);
    for (double angle : {0.0, 0.01, 0.4, 0.9, 1.3, 1.5, 1.57, 0.5 * kPi}) worst = std::max(worst, std::abs(albedo.at(angle) - byRings(n, angle)));
  }
  bound("albedo of Phong's lobe, 32 points against 5600 rings, off by", worst, 2e-6, "1e-6 of the points and as much of the rings");
}

TEST(Materials, TabulatedLambertianIsLambertian) {
  BrdfTable t{{3.0, 5.0}, {AngleAxis{Angle::View, 3, 0.5 * kPi}, AngleAxis{}}, std::vector<double>(6, 0.3 / kPi)};
  const auto table = makeTabulated(t);
  EXPECT_NEAR(table->hemispherical(4.0, 0.5), 0.3, 1e-9);
  EXPECT_NEAR(table->brdf(4.2, {0, 0, 1}, glm::normalize(glm::dvec3(1, 0, 1))), 0.3 / kPi, 1e-12);
  EXPECT_THROW(table->column(6.0, 0, 0), OutsideSpectrum);
}

TEST(Materials, LambertianOverAnyAxesIsLambertian) {
  const Angle kinds[] = {Angle::None, Angle::Incidence, Angle::View, Angle::Specular, Angle::Half, Angle::Difference, Angle::HalfRoot};
  double one = 0.0, two = 0.0;
  for (Angle a : kinds)
    for (Angle b : kinds) {
      if (b != Angle::None && (a == b || a == Angle::None)) continue;
      if (std::min(a, b) == Angle::Half && std::max(a, b) == Angle::HalfRoot) continue;  // one angle, told in two ways
      const AngleAxis first{a, a == Angle::None ? 1 : 7, 0.4 * kPi}, second{b, b == Angle::None ? 1 : 5, 0.5 * kPi};
      const auto table = makeTabulated({{4.0}, {first, second}, std::vector<double>(static_cast<size_t>(first.count * second.count), 0.5 / kPi)});
      for (double angle : {0.0, 0.2, 0.8, 1.3, 1.55, 0.5 * kPi})
        (b == Angle::None ? one : two) = std::max(b == Angle::None ? one : two, std::abs(table->hemispherical(4.0, angle) / 0.5 - 1.0));
    }
  bound("constant table over any one axis, worst error of its reflectance", one, 1e-6, "pi f");
  bound("constant table over any two axes, worst error of its reflectance", two, 1e-3, "pi f");
}

// f to 1 deg about the mirrored direction, 0 from 1.1 deg: R = cos(theta_v) 2 pi integral f cos(a) sin(a) da while it is above the horizon.
TEST(Materials, NarrowSpecularDiscKeepsItsEnergy) {
  std::vector<double> values(12, 900.0);
  values.back() = 0.0;
  const auto table = makeTabulated({{4.0}, {AngleAxis{Angle::Specular, 12, 1.1 * kDegree}, AngleAxis{}}, values});
  double normal = 0.0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double a = 1.1 * kDegree * (i + 0.5) / n;
    normal += 900.0 * std::min(1.0, (1.1 * kDegree - a) / (0.1 * kDegree)) * std::sin(2.0 * a) * kPi * 1.1 * kDegree / n;
  }
  EXPECT_NEAR(normal, 0.95, 0.01);
  for (double angle : {0.0, 20.0, 20.3, 45.0, 80.0, 88.5})
    figure("specular disc of 1 deg seen at " + std::to_string(angle).substr(0, 4) + " deg, reflectance", table->hemispherical(4.0, angle * kDegree),
           normal * std::cos(angle * kDegree), 2e-5, "2 pi int f cos sin cos(theta_v); 0.5 deg grid of view angles");
  EXPECT_GT(table->hemispherical(4.0, 0.5 * kPi), 0.0) << "half of the disc is above the horizon at grazing view";
}

// A lobe over the half angle, narrow and wide, against equal steps about the mirrored view.
TEST(Materials, HalfVectorLobeAgainstEqualSteps) {
  for (double width : {3.0, 40.0}) {
    std::vector<double> values;
    for (int i = 0; i <= 12; ++i) values.push_back(0.3 / std::pow(width * kDegree, 2) * std::pow(1.0 - i / 12.0, 2));
    const auto table = makeTabulated({{4.0}, {AngleAxis{Angle::Half, 13, width * kDegree}, AngleAxis{}}, values});
    for (double angle : {0.0, 40.0, 75.0})
      figure("half-vector lobe of " + std::to_string(width).substr(0, 2) + " deg seen at " + std::to_string(angle).substr(0, 2) + " deg, reflectance",
             table->hemispherical(4.0, angle * kDegree), byEqualSteps(*table, angle * kDegree, -angle * kDegree, 6000, 300), 1e-3, "equal steps, 6000 x 300");
  }
}

TEST(Materials, TablesOverTwoAnglesAgainstEqualSteps) {
  const std::pair<Angle, Angle> pairs[] = {{Angle::Half, Angle::Difference},     {Angle::Incidence, Angle::Specular}, {Angle::Specular, Angle::Half},
                                           {Angle::Difference, Angle::Specular}, {Angle::Half, Angle::Incidence},     {Angle::Incidence, Angle::Difference},
                                           {Angle::Specular, Angle::View}};
  double worst = 0.0;
  for (const auto& [a, b] : pairs) {
    BrdfTable t{{4.0}, {AngleAxis{a, 6, 50.0 * kDegree}, AngleAxis{b, 4, 80.0 * kDegree}}, {}};
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 6; ++i) t.values.push_back(0.02 + 0.3 * ((5 - i) * (5 - i) % 7) / 7.0 + 0.1 * (j * j % 3));
    const auto table = makeTabulated(t);
    for (double angle : {0.0, 35.0, 80.0})
      worst = std::max(worst, std::abs(table->hemispherical(4.0, angle * kDegree) / byEqualSteps(*table, angle * kDegree, 0.0, 1000, 500) - 1.0));
  }
  bound("rugged tables over two angles against equal steps, worst error", worst, 1e-3, "equal steps, 1000 x 500");
}

// A view axis bends the reflectance at each of its entries, wherever they lie.
TEST(Materials, NarrowFeatureOverTheViewAngle) {
  std::vector<double> values(1024, 0.1 / kPi);
  values[513] = 0.9 / kPi;
  const AngleAxis axis{Angle::View, 1024, 0.5 * kPi};
  const auto table = makeTabulated({{4.0}, {axis, AngleAxis{}}, values});
  EXPECT_NEAR(table->hemispherical(4.0, axis.at(513)), 0.9, 1e-9);
  EXPECT_NEAR(table->hemispherical(4.0, axis.at(514)), 0.1, 1e-9);
}

const std::string kCamera =
    "cameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 1 deg, aperture: 5 mm, position: [9 m, 0 m, 0 m], heading: 270 deg, channels: [{name: a, "
    "response: {band: [3 um, 5 um]}}]}]\n";

RenderTables tablesOf(const Simulation& sim) { return makeTables(sim, makePlan(sim, sim.cameras[0].outputs, sim.cameras[0].spectral, sim.cameras[0].where)); }

/// What is wrong with these materials, or nothing.
std::string refusal(const std::string& materials) {
  try {
    tablesOf(scene("materials:\n" + materials + kCamera));
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}
const std::string kTooMuch = "more than it receives";

TEST(MaterialEnergy, IsCheckedWhereverASpectrumBends) {
  EXPECT_NE(refusal("  m: {emission: {emissivity: 0.9, angular: [[0 deg, 1], [65 deg, 1], [70 deg, 3], [75 deg, 1]]}}\n").find(kTooMuch), std::string::npos);
  const std::string peak = "{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", outside: hold, values: [[3.95, 0], [4.0, 0.9], [4.05, 0]]}}";
  EXPECT_NE(refusal("  m: {components: [" + peak + ", " + peak + "]}\n").find(kTooMuch), std::string::npos);
  EXPECT_EQ(refusal("  m: {components: [" + peak + "]}\n"), "");
  // Each linear between its rows, their product of factors greatest in the middle.
  const std::string hill =
      "{product: [{wavelength: um, unit: \"1\", outside: hold, values: [[3, 0], [5, 1]]}, {wavelength: um, unit: \"1\", outside: hold, values: [[3, 1], [5, "
      "0]]}], scale: 4}";
  EXPECT_NE(refusal("  m: {components: [{reflection: lambertian, reflectance: " + hill + "}, {reflection: lambertian, reflectance: 0.2}]}\n"), "");
  // Kirchhoff's emissivity of a table that reflects more than it receives at 62.5 deg only.
  EXPECT_NE(refusal("  m: {components: [{reflection: table, wavelength: [3 um, 5 um], angles: [{angle: view, count: 37, last: 90 deg}], values: [" +
                    [] {
                      std::string rows;
                      for (int i = 0; i < 37; ++i) rows += std::string(i ? ", " : "") + (i == 25 ? "[0.5, 0.5]" : "[0.1, 0.1]");
                      return rows;
                    }() +
                    "]}]}\n")
                .find(kTooMuch),
            std::string::npos);
}

TEST(MaterialEnergy, ModifiersAreTakenTexelByTexel) {
  const std::string grass = "{reflection: lambertian, reflectance: 0.7, modifier: {rows: ",
                    soil = "{reflection: lambertian, reflectance: 0.6, modifier: {rows: ";
  const std::string mask = "[[1, 0, 0.25], [0.5, 1, 0]]", rest = "[[0, 1, 0.75], [0.5, 0, 1]]";
  EXPECT_EQ(refusal("  m: {components: [" + grass + mask + "}}, " + soil + rest + "}}]}\n"), "") << "a mixture of two surfaces";
  EXPECT_NE(refusal("  m: {components: [" + grass + mask + "}}, " + soil + "[[0, 1, 0.75], [0.5, 0.6, 1]]}}]}\n").find(kTooMuch), std::string::npos)
      << "0.7 + 0.36 in one texel";
  EXPECT_NE(refusal("  m: {components: [" + grass + mask + "}}, {reflection: lambertian, reflectance: 0.6}]}\n").find(kTooMuch), std::string::npos)
      << "0.7 + 0.6 where the mask is 1";
  // Textures of other sizes are bilinear between the same lines.
  EXPECT_EQ(refusal("  m: {components: [" + grass + "[[1, 0]]}}, " + soil + "[[0, 0.5]]}}], emission: {emissivity: 0.3, modifier: {rows: [[1], [0.5]]}}}\n"),
            "");
  EXPECT_NE(refusal("  m: {components: [" + grass + "[[1, 0]]}}, " + soil + "[[1, 0, 0, 0]]}}]}\n").find(kTooMuch), std::string::npos);
  EXPECT_EQ(refusal("  m: {components: [" + grass + "[[1, 0]]}}, " + soil + "[[0, 0, 0, 1]]}}]}\n"), "");
}

// The lines of all texels against a fine search, textures of three sizes.
TEST(MaterialEnergy, TexturesOfSeveralSizesAgainstAFineSearch) {
  std::vector<Texture> textures{
      {"a", 3, 2, {0.1f, 0.9f, 0.3f, 0.8f, 0.2f, 0.6f}}, {"b", 2, 2, {0.9f, 0.1f, 0.4f, 0.7f}}, {"c", 1, 5, {0.2f, 0.9f, 0.1f, 0.5f, 0.3f}}};
  auto valueAt = [](const Texture& t, double u, double v) {
    const double x = u * t.width - 0.5 + t.width, y = v * t.height - 0.5 + t.height;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    auto texel = [&](int a, int b) { return static_cast<double>(t.texels[static_cast<size_t>(b % t.height * t.width + a % t.width)]); };
    const double f = x - i, g = y - j;
    return (1 - g) * ((1 - f) * texel(i, j) + f * texel(i + 1, j)) + g * ((1 - f) * texel(i, j + 1) + f * texel(i + 1, j + 1));
  };
  double greatest = 0.0;
  for (int i = 0; i < 600; ++i)
    for (int j = 0; j < 600; ++j) {
      const double u = i / 600.0, v = j / 600.0;
      greatest = std::max(greatest, 0.9 * valueAt(textures[0], u, v) + 0.8 * valueAt(textures[1], u, v) + 0.7 * valueAt(textures[2], u, v));
    }
  Material m;
  m.reflections = {makeLambertian(Spectrum(0.9)), makeLambertian(Spectrum(0.8)), makeLambertian(Spectrum(0.7))};
  m.modifiers = {0, 1, 2};
  ASSERT_GT(greatest, 1.0);
  const auto excess = energyExcess(m, textures);
  ASSERT_TRUE(excess.has_value());
  figure("greatest sum of three modified components, textures of three sizes", excess->sum, greatest, 1e-6,
         "search on 600 x 600 points that include all texels");
}

// Thousands of wavelengths of which none is the worst for all mixtures.
TEST(MaterialEnergy, ManyWavelengthsCompete) {
  Spectrum::Table cosine, sine;
  for (int i = 0; i <= 2000; ++i) {
    cosine.wavelength_um.push_back(3.0 + 0.001 * i);
    cosine.value.push_back(0.99 * std::cos(0.5 * kPi * i / 2000));
    sine.value.push_back(0.99 * std::sin(0.5 * kPi * i / 2000));
  }
  sine.wavelength_um = cosine.wavelength_um;
  Material m;
  m.reflections = {makeLambertian(Spectrum(cosine)), makeLambertian(Spectrum(sine))};
  m.modifiers = {0, 1};
  std::vector<Texture> textures{{"a", 64, 1, {}}, {"b", 64, 1, {}}};
  for (int i = 0; i < 64; ++i) {
    textures[0].texels.push_back(static_cast<float>(i) / 63.0f);
    textures[1].texels.push_back(static_cast<float>(63 - i) / 63.0f);
  }
  EXPECT_FALSE(energyExcess(m, textures).has_value()) << "a mixture of two surfaces";
  textures[1].texels[32] = 1.0f;
  const auto excess = energyExcess(m, textures);
  ASSERT_TRUE(excess.has_value());
  EXPECT_NEAR(excess->sum, 0.99 * std::hypot(32.0 / 63.0, 1.0), 1e-3);
}

TEST(MaterialTables, ComponentsOnOneAngleKeepTheirOwnSteps) {
  auto component = [](int count, double last_deg, double scale) {
    std::string rows;
    for (int i = 0; i < count; ++i) rows += (i ? ", [" : "[") + std::to_string(scale * (1 + i % 3)) + ", " + std::to_string(scale * (1 + i % 2)) + "]";
    return "{reflection: table, wavelength: [3 um, 5 um], angles: [{angle: specular, count: " + std::to_string(count) + ", last: " + std::to_string(last_deg) +
           " deg}], values: [" + rows + "]}";
  };
  for (const auto& [n1, last1, n2, last2, cells] : {std::tuple{3, 90.0, 7, 90.0, 6}, {5, 90.0, 4, 90.0, 12}, {4, 30.0, 10, 90.0, 9}, {5, 20.0, 10, 90.0, 18}}) {
    const auto sim = scene("sun: {azimuth: 0 deg, elevation: 45 deg, temperature: 5772 K}\nmaterials: {m: {components: [" + component(n1, last1, 0.05) + ", " +
                           component(n2, last2, 0.02) + "]}}\n" +
                           "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: m, temperature: 300 K}]\n" + kCamera);
    const Plan plan = makePlan(sim, sim.cameras[0].outputs, sim.cameras[0].spectral, sim.cameras[0].where);
    const RenderTables t = tablesOf(sim);
    ASSERT_EQ(t.solid.materials[0].counts[0], static_cast<std::uint32_t>(cells + 1));
    const double last = std::max(last1, last2) * kDegree;
    EXPECT_NEAR(static_cast<double>(t.solid.materials[0].scale[0]), cells / last, 1e-5);
    double worst = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      const double angle = last * i / 1000.0, x = angle / last * cells;
      const int j = std::min(static_cast<int>(x), cells - 1);
      for (int node = 0; node < plan.nodeCount(); ++node)
        for (size_t k = 0; k < 2; ++k) {
          auto entry = [&](int row) { return static_cast<double>(t.solid.columns[static_cast<size_t>((row * plan.nodeCount() + node) * 4) + k]); };
          const double want = sim.materials[0]->reflections[k]->column(plan.nodes[static_cast<size_t>(node)].members.front().wavelength_um, angle, 0.0);
          worst = std::max(worst, std::abs(entry(j) + (x - j) * (entry(j + 1) - entry(j)) - want) / want);
        }
    }
    EXPECT_LT(worst, 1e-6) << n1 << " to " << last1 << " and " << n2 << " to " << last2;
  }
  const std::string odd = refusal("  m: {components: [" + component(30, 90.0, 0.01) + ", " + component(9, 77.7, 0.01) + "]}\n");
  EXPECT_NE(odd.find("'specular'"), std::string::npos) << odd;
  EXPECT_NE(odd.find("30 entries to 90 deg and 9 entries to 77.7 deg"), std::string::npos) << odd;
}

TEST(MaterialTables, EmissivityOverWavelengthAndViewAngle) {
  const auto sim = scene(
      "materials: {m: {emission: {wavelength: [3 um, 5 um], angles: [{angle: view, count: 3, last: 90 deg}], values: [[0.9, 0.7], [0.8, 0.6], [0.1, "
      "0.3]]}}}\n" +
      kCamera);
  const Material& m = *sim.materials[0];
  EXPECT_TRUE(m.needsAngles());
  EXPECT_EQ(m.validLow_um(), 3.0);
  EXPECT_EQ(m.validHigh_um(), 5.0);
  EXPECT_NEAR(m.emissivity(3.0, 0.0), 0.9, 1e-12);
  EXPECT_NEAR(m.emissivity(5.0, 45 * kDegree), 0.6, 1e-12);
  EXPECT_NEAR(m.emissivity(3.5, 60 * kDegree), (2.0 * (0.75 * 0.8 + 0.25 * 0.6) + (0.75 * 0.1 + 0.25 * 0.3)) / 3.0, 1e-12);
  EXPECT_NEAR(m.emissivity(5.0, 0.5 * kPi), 0.3, 1e-12);
  EXPECT_THROW(m.emissivity(5.1, 0.0), OutsideSpectrum);
}

TEST(MaterialTables, EmissionIsASpectrumOrATable) {
  const std::string angles = "angles: [{angle: view, count: 2, last: 90 deg}]", values = "values: [[0.9, 0.9], [0.5, 0.5]]";
  auto emission = [](const std::string& keys) { return refusal("  m: {emission: {" + keys + "}}\n"); };
  EXPECT_EQ(emission("wavelength: [3 um, 5 um], " + angles + ", " + values), "");
  EXPECT_NE(emission("").find("emissi"), std::string::npos);
  EXPECT_NE(emission("emissivity: 0.5, wavelength: [3 um, 5 um], " + angles + ", " + values).find("both a spectrum and a table"), std::string::npos);
  EXPECT_NE(emission("angular: [[0 deg, 1]], wavelength: [3 um, 5 um], " + angles + ", " + values).find("both a spectrum and a table"), std::string::npos);
  EXPECT_NE(emission("angular: [[0 deg, 1]]").find("without 'emissivity'"), std::string::npos);
  EXPECT_NE(emission("wavelength: [3 um, 5 um], " + values).find("without 'angles'"), std::string::npos);
  EXPECT_NE(emission("wavelength: [3 um, 5 um], angles: [{angle: half, count: 2, last: 90 deg}], " + values).find("view"), std::string::npos);
  EXPECT_NE(emission("wavelength: [3 um, 5 um], " + angles + ", values: [[0.9, 0.9], [1.5, 0.9]]").find("an emissivity value is above 1"), std::string::npos);
  EXPECT_NE(emission("wavelength: [3 um, 5 um], " + angles + ", values: [[0.9, 0.9]]").find("values"), std::string::npos);
  EXPECT_NE(refusal("  m: {components: [{reflection: lambertian, reflectance: 0.3}], emission: {wavelength: [3 um, 4 um, 5 um], " + angles +
                    ", values: [[0.6, 0.75, 0.6], [0.6, 0.6, 0.6]]}}\n")
                .find(kTooMuch),
            std::string::npos);
}

// Bends of an emissivity are on the renderer's grid of view angles where a grid of at most 1441 entries has them.
TEST(MaterialTables, GridOfViewAnglesHasTheBends) {
  for (const auto& [count, last, entries] : {std::tuple{3, "90 deg", 181u}, {7, "85 deg", 217u}, {4, "10 deg", 190u}, {8, "1 rad", 1441u}}) {
    std::string rows;
    for (int i = 0; i < count; ++i) rows += i ? ", [0.5, 0.5]" : "[0.9, 0.9]";
    const auto sim = scene("materials: {m: {emission: {wavelength: [3 um, 5 um], angles: [{angle: view, count: " + std::to_string(count) + ", last: " + last +
                           "}], values: [" + rows + "]}}}\n" + kCamera);
    EXPECT_EQ(tablesOf(sim).solid.materials[0].counts[2], entries) << last;
  }
}

}  // namespace
}  // namespace pitviper::test
