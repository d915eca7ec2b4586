// BRDFs over three angles from files: the tables they become, the laws they keep, and pictures of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "materials/measured_files.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/hemisphere.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

/// A surface nobody has: a matt part and a lobe about the mirrored direction that an azimuth makes wider and narrower, alike both ways. h and d: half and
/// difference angle, p: the light's azimuth about the half vector.
double smooth(double h, double d, double p) {
  const double spread = 0.05 * (1.0 + 0.5 * std::cos(2.0 * p) * std::pow(std::sin(h) * std::sin(d), 2.0));
  return 0.1 + 0.25 * std::exp(-std::pow(std::tan(std::min(h, 1.5)), 2.0) / (4.0 * spread)) * (1.0 + std::pow(1.0 - std::cos(d), 3.0)) +
         0.05 * std::sin(h) * std::sin(d) * std::cos(2.0 * p);
}

/// The same for directions in a frame whose z is the normal.
double smoothAt(const glm::dvec3& l, const glm::dvec3& v) {
  const glm::dvec3 h = glm::normalize(l + v), n(0, 0, 1), up = n - glm::dot(n, h) * h, aside = l - glm::dot(l, h) * h;
  const double lengths = glm::length(up) * glm::length(aside), cosine = lengths > 1e-12 ? glm::dot(up, aside) / lengths : 1.0;
  return smooth(std::acos(std::min(1.0, h.z)), std::acos(std::min(1.0, glm::dot(l, h))), std::acos(std::clamp(cosine, -1.0, 1.0)));
}

struct Total {
  MeasuredBrdf brdf;
  MeasuredAngles kind;
  double operator()(double wavelength_um, const glm::dvec3& l, const glm::dvec3& v) const {
    double sum = 0.0;
    for (size_t k = 0; k < brdf.parts.size(); ++k) {
      const auto& axes = brdf.parts[k].axes;
      sum += brdf.parts[k].at(wavelength_um, angleBetween(axes[0].angle, l, v), angleBetween(axes[1].angle, l, v)) *
             azimuthLobeAt(kind, azimuthLobe(brdf, kind, k), l, v);
    }
    return sum;
  }
};

/// MERL's layout: red `f`, green and blue of it 0.8 and 0.5; below the horizon -1.
std::filesystem::path putMerl(const TemporaryFolder& folder, double scale = 1.0) {
  std::vector<double> values(3 * 90 * 90 * 180);
  const double colours[] = {1.0, 0.8, 0.5}, units[] = {1500.0, 1500.0 / 1.15, 1500.0 / 1.66};
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < 90; ++i)
      for (size_t j = 0; j < 90; ++j)
        for (size_t p = 0; p < 180; ++p) {
          const double x = (static_cast<double>(i) + 0.5) / 90.0, h = x * x * 0.5 * kPi, d = (static_cast<double>(j) + 0.5) * kDegree,
                       azimuth = (static_cast<double>(p) + 0.5) * kDegree;
          const bool above = std::cos(h) * std::cos(d) > std::sin(h) * std::sin(d) * std::abs(std::cos(azimuth));
          values[((c * 90 + i) * 90 + j) * 180 + p] = above ? scale * colours[c] * units[c] * smooth(h, d, azimuth) : -1.0;
        }
  const auto path = folder.path() / "surface.binary";
  std::ofstream out(path, std::ios::binary);
  const std::int32_t head[] = {90, 90, 180};
  out.write(reinterpret_cast<const char*>(head), sizeof head);
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(double)));
  return path;
}

/// Every `step` degrees of incidence and view, every `turn` of azimuth, at 3 and 5 um.
template <class F>
std::string directionsCsv(int step, int turn, const F& f, int lastIncidence = 90) {
  std::string text = "# made by a test\nwavelength [um], incidence [deg], view [deg], azimuth [deg], brdf [1/sr]\n";
  for (double w : {3.0, 5.0})
    for (int i = 0; i <= lastIncidence; i += step)
      for (int j = 0; j <= 90; j += step)
        for (int p = 0; p <= 180; p += turn) text += print("%g, %d, %d, %d, %.17g\n", w, i, j, p, f(w, i, j, p));
  return text;
}

glm::dvec3 direction(double angle, double azimuth) { return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)}; }

double smoothOf(double w, int i, int j, int p) {
  return 0.2 * w * smoothAt(direction(std::min(i * kDegree, 1.57), 0.0), direction(std::min(j * kDegree, 1.5701), p * kDegree));
}

// A surface in MERL's layout comes back as it was.
TEST(Measured, MerlIsRead) {
  const TemporaryFolder folder;
  MeasuredGrid grid = readMerl(putMerl(folder), {0.62, 0.55, 0.46}, {});
  const Total total{measuredBrdf(std::move(grid), 7, {}), MeasuredAngles::HalfRoot};
  double off = 0.0, of = 0.0, worst = 0.0, way = 0.0, colour = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const auto [l, v] = directionPair(i);
    const double expected = smoothAt(l, v), found = total(0.62, l, v), weight = l.z * v.z;
    off += weight * (found - expected) * (found - expected), of += weight * expected * expected;
    if (std::min(l.z, v.z) > 0.17) worst = std::max(worst, std::abs(found / expected - 1.0));
    way = std::max(way, std::abs(found - total(0.62, v, l)) / found);
    colour =
        std::max({colour, std::abs(total(0.55, l, v) / found - 0.8), std::abs(total(0.46, l, v) / found - 0.5), std::abs(total(0.69, l, v) / found - 1.0)});
  }
  bound("a surface in MERL's layout, rms over flux", std::sqrt(off / of), 0.004, "linear between 91 x 46 angles and 7 azimuths at most, kept to 0.3 %");
  bound("the same down to 10 deg above the horizon, worst", worst, 0.08, "largest where it is smallest: the rms is of flux");
  bound("the same, both ways", way, 1e-12, "half and difference angles are the same both ways");
  bound("the same, its green and blue, and red beyond its band", colour, 1e-9, "scales of 1, 1.15 and 1.66 over 1500; held to 0.7 um");
}

// Directions on the grid return what a file has, and between them what is linear.
TEST(Measured, CsvIsReadExactly) {
  const TemporaryFolder folder;
  // Any values that are alike both ways.
  const auto value = [](double w, int i, int j, int p) {
    const int low = std::min(i, j), high = std::max(i, j);
    return 0.04 * w / 5.0 * (1.5 + std::sin(7.0 * low + 3.0 * high) * (low > 0 ? std::cos(5.0 * p) : 1.0));
  };
  const Total total{measuredBrdf(readBrdfCsv(folder.put("surface.csv", directionsCsv(15, 30, value)), {}), 7, {}), MeasuredAngles::Directions};
  EXPECT_EQ(total.brdf.parts.size(), 7u);
  EXPECT_TRUE(total.brdf.notes.empty()) << total.brdf.notes.front();
  double worst = 0.0, half = 0.0;
  for (int i = 15; i <= 75; i += 15)
    for (int j = 15; j <= 75; j += 15)
      for (int p = 0; p <= 150; p += 30) {
        const auto at = [&](double w, double in, double out, double azimuth) {
          return total(w, direction(in * kDegree, 1.0), direction(out * kDegree, 1.0 + azimuth * kDegree));
        };
        worst = std::max({worst, std::abs(at(3.0, i, j, p) / value(3.0, i, j, p) - 1.0), std::abs(at(4.0, i, j, p) / value(4.0, i, j, p) - 1.0)});
        half = std::max(half, std::abs(at(3.0, i, j, p + 15) / (0.5 * (value(3.0, i, j, p) + value(3.0, i, j, p + 30))) - 1.0));
      }
  bound("a CSV of directions at its own", worst, 1e-6, "angles of vectors in double precision, steps of 15 deg");
  bound("halfway between two azimuths", half, 1e-6, "linear between");
}

// One surface by directions and by half and difference angles.
TEST(Measured, BothLayoutsAreOne) {
  const TemporaryFolder folder;
  std::string text = "azimuth [deg], difference [deg], half [deg], brdf [1/sr], wavelength [nm]\n";
  for (int i = 0; i <= 90; i += 3)
    for (int j = 0; j <= 90; j += 3)
      for (int p = 0; p <= 90; p += 15)
        if (std::cos(i * kDegree) * std::cos(j * kDegree) >= std::sin(i * kDegree) * std::sin(j * kDegree) * std::cos(p * kDegree) || j == 0)
          text += print("%d, %d, %d, %.12g, 4000\n", p, j, i, 0.8 * smooth(i * kDegree, j * kDegree, p * kDegree));
  const Total ofHalf{measuredBrdf(readBrdfCsv(folder.put("half.csv", text), {}), 7, {}), MeasuredAngles::Half};
  const Total ofDirections{measuredBrdf(readBrdfCsv(folder.put("directions.csv", directionsCsv(5, 15, smoothOf)), {}), 13, {}), MeasuredAngles::Directions};
  double off = 0.0, of = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const auto [l, v] = directionPair(i);
    const double a = ofHalf(4.0, l, v), b = ofDirections(4.0, l, v), weight = l.z * v.z;
    off += weight * (a - b) * (a - b), of += weight * a * a;
  }
  bound("a surface by directions against half angles, rms over flux", std::sqrt(off / of), 0.01, "steps of 5 and 3 deg, linear between");
}

std::string measured(const std::string& file, const std::string& more = "") { return "{reflection: measured, file: " + file + more + "}"; }
Simulation sceneOf(const std::string& component, const char* band = "[3.2 um, 4.8 um]") {
  return scene("materials: {m: {components: [" + component +
               "]}}\nsun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\nentities: [{name: s, shape: {model: sphere, radius: 1 m, segments: 96}, "
               "material: m, temperature: 320 K}]\ncameras: [{name: c, film: {width: 40, height: 40}, field_of_view: 12 deg, aperture: 5 mm, position: [12 m, "
               "0 m, 1 m], look_at: [0 m, 0 m, 0 m], channels: [{name: a, response: {band: " +
               band + "}}]}]\n");
}

// What a view receives from everywhere, by brute force; the picture on the GPU.
TEST(Measured, ReturnsAndIsDrawnAsItsTables) {
  const TemporaryFolder folder;
  const std::string file = folder.put("surface.csv", directionsCsv(10, 30, smoothOf));
  const Simulation sim = sceneOf(measured(file));
  const auto m = sim.materials.front();
  for (double degrees : {0.0, 40.0, 70.0, 85.0})
    figure(print("rho of a measured BRDF at %.0f deg", degrees), m->reflectance(4.0, degrees * kDegree), bruteHemispherical(*m, 4.0, degrees * kDegree), 1e-4,
           "uniform sums over 320,000 directions");
  const Worst w = compare(sim, 1);
  EXPECT_GT(w.covered, 700);
  bound("GPU measured BRDF against CPU double, 99 of 100 pixels", w.percentile99, 1e-4, "single precision; reflectance every 0.5 deg");
  const Worst merl = compare(sceneOf(measured(putMerl(folder, 0.8).string()), "[0.5 um, 0.6 um]"), 1);
  bound("GPU measured BRDF in MERL's layout against CPU double, 99 of 100 pixels", merl.percentile99, 1e-4, "single precision; reflectance every 0.5 deg");
  bound("GPU measured BRDF against CPU double, worst pixel", w.error, 1e-3, "on a triangle's edge the two take normals of one or the other");
}

// In an enclosure it is black, planned or not, in both layouts.
TEST(Measured, EnclosuresAreFlat) {
  const TemporaryFolder folder;
  std::string half = "wavelength [um], half [deg], difference [deg], azimuth [deg], brdf [1/sr]\n";
  for (double w : {3.0, 5.0})
    for (int i = 0; i <= 90; i += 5)
      for (int j = 0; j + i <= 90; j += 5)
        for (int p = 0; p <= 90; p += 30) half += print("%g, %d, %d, %d, %.12g\n", w, i, j, p, 0.8 * smooth(i * kDegree, j * kDegree, p * kDegree));
  for (int j = 5; j <= 90; j += 5)  // what both directions see beyond the corner of the square
    for (double w : {3.0, 5.0})
      for (int i = 95 - j; i <= 90; i += 5)
        for (int p = 0; p <= 90; p += 30) half += print("%g, %d, %d, %d, %.12g\n", w, i, j, p, 0.8 * smooth(i * kDegree, j * kDegree, p * kDegree));
  for (const std::string& file : {folder.put("half.csv", half), folder.put("directions.csv", directionsCsv(10, 30, smoothOf))})
    for (const char* accuracy : {"", "accuracy: 1 %\n"}) {
      const Frame f = renderFrame(scene(accuracy + std::string("materials: {m: {components: [") + measured(file) +
                                        "]}}\nbackground: {temperature: 600 K}\nambient: {temperature: 600 K}\nentities: [{name: s, shape: {model: sphere, "
                                        "radius: 1 m}, material: m, temperature: 600 K}]\ncameras: [{name: c, film: {width: 40, height: 40}, field_of_view: 12 "
                                        "deg, aperture: 5 mm, position: [12 m, 0 m, 1 m], look_at: [0 m, 0 m, 0 m], channels: [{name: a, response: {band: [3.2 "
                                        "um, 4.8 um]}}]}]\n"));
      double worst = 0.0;
      for (float x : layer(f, "a.radiance").pixels) worst = std::max(worst, std::abs(static_cast<double>(x) / blackBodyBand(3.2, 4.8, 600.0) - 1.0));
      bound(std::filesystem::path(file).stem().string() + (*accuracy ? ", planned" : "") + ": a measured sphere off the black body in an enclosure", worst,
            1e-4, "asked of every surface");
    }
}

// Incidences up to 60 deg: beyond, what light and view say the other way round.
TEST(Measured, TheOtherWayRoundFillsIn) {
  const TemporaryFolder folder;
  const Total part{measuredBrdf(readBrdfCsv(folder.put("part.csv", directionsCsv(10, 30, smoothOf, 60)), {}), 7, {}), MeasuredAngles::Directions};
  const Total whole{measuredBrdf(readBrdfCsv(folder.put("whole.csv", directionsCsv(10, 30, smoothOf)), {}), 7, {}), MeasuredAngles::Directions};
  for (int j : {10, 30, 60}) {
    const glm::dvec3 l = direction(80.0 * kDegree, 0.3), v = direction(j * kDegree, 0.3 + 120.0 * kDegree);
    figure(print("light from 80 deg that no row has, seen at %d deg", j), part(4.0, l, v), whole(4.0, l, v), 1e-9, "f(l, v) = f(v, l)");
  }
}

TEST(Measured, ChangesAreSaidAndBounded) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) {
    try {
      (void)sceneOf(measured(folder.put("surface.csv", text)));
    } catch (const UserError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  // Returns 106 %: scaled. 140 %: refused.
  const Simulation bright = sceneOf(measured(folder.put("bright.csv", directionsCsv(30, 180, [](double, int, int, int) { return 1.06 / kPi; }))));
  ASSERT_EQ(bright.materials.front()->notes.size(), 1u);
  EXPECT_NE(bright.materials.front()->notes.front().find("scaled by up to 5.66 %"), std::string::npos) << bright.materials.front()->notes.front();
  EXPECT_NEAR(bright.materials.front()->reflectance(4.0, 0.5), 1.0, 1e-4);
  EXPECT_NE(message(directionsCsv(30, 180, [](double, int, int, int) { return 1.4 / kPi; })).find("returns 140 %"), std::string::npos);
  // Incidence and view exchanged: a lobe that is 1.05 or 2 times as bright one way.
  const auto uneven = [](double by) { return [by](double w, int i, int j, int p) { return (i > j ? by : 1.0) * smoothOf(w, i, j, p); }; };
  const Simulation nearly = sceneOf(measured(folder.put("nearly.csv", directionsCsv(15, 60, uneven(1.05)))));
  ASSERT_FALSE(nearly.materials.front()->notes.empty());
  EXPECT_NE(nearly.materials.front()->notes.front().find("alike both ways"), std::string::npos);
  EXPECT_LT(worstReciprocity(*nearly.materials.front(), 4.0, 300), 1e-9);
  EXPECT_NE(message(directionsCsv(15, 60, uneven(2.0))).find("not alike both ways"), std::string::npos);
  // Holes, two of one, units, angles.
  std::string holed = directionsCsv(30, 60, smoothOf);
  holed.erase(holed.rfind("5, 60, 60, 60"), holed.find('\n', holed.rfind("5, 60, 60, 60")) + 1 - holed.rfind("5, 60, 60, 60"));
  EXPECT_NE(message(holed).find("of the BRDF is missing"), std::string::npos);
  EXPECT_NE(message(directionsCsv(30, 60, smoothOf) + "5, 30, 30, 60, 0.1\n").find("a second value for the same"), std::string::npos);
  EXPECT_NE(message("wavelength [um], incidence [deg], view [m], azimuth [deg], brdf [1/sr]\n4, 10, 10, 0, 0.1\n")
                .find("surface.csv:1:40: the column 'view' is in 'm'; expected an angle"),
            std::string::npos);
  EXPECT_NE(message("wavelength [um], incidence [deg], azimuth [deg], brdf [1/sr]\n").find("without the column 'view'"), std::string::npos);
  EXPECT_NE(
      message("wavelength [um], incidence [deg], view [deg], azimuth [deg], brdf [1/sr]\n4, 0, 95, 0, 0.1\n").find("surface.csv:2:1: an angle out of range"),
      std::string::npos);
}

TEST(Measured, MerlFilesThatAreNone) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& bytes, const std::string& more = "") {
    try {
      (void)sceneOf(measured(folder.put("surface.binary", bytes), more));
    } catch (const UserError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const char head[] = {90, 0, 0, 0, 90, 0, 0, 0, (char)180, 0, 0, 0};
  EXPECT_NE(message("nothing").find("byte 0: not a BRDF in MERL's layout"), std::string::npos);
  EXPECT_NE(message(std::string(head, 12) + "12345678").find("byte 20: the BRDF ends after 20 bytes"), std::string::npos);
  EXPECT_NE(message("nothing", ", bands: [0.4 um, 0.5 um, 0.6 um]").find("do not fall from red to blue"), std::string::npos);
  // Seen only where it has data.
  const auto path = putMerl(folder, 0.8);
  try {
    (void)sceneOf(measured(path.string()));
    FAIL();
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("has no data"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace pitviper::test
