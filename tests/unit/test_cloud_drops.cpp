// The library's water drops and ice crystals: their files against the laws that made them, and against published optics of clouds.
//
// Rationale: clouds, rain and snow of every scene take extinction, albedo and asymmetry from these two files alone; a damaged row, or a law changed under them,
// would be seen nowhere else.
// Expectation: 1 % of extinction and of what is absorbed and 0.005 of asymmetry of rows remade by Mie or in closed form (weak absorption of large clear drops
// 3 %: it is in resonances narrower than any step over sizes); between rows 3 % of extinction and 10 % of what is absorbed, by lines. Bands of published tables
// 1e-5 to 0.04, see each.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "sim/parameters/csv_table.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/mie.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test::cloud_drops {
namespace {

using Complex = std::complex<double>;
const std::filesystem::path kRoot = PITVIPER_SOURCE_DIR;

struct Optics {
  double extinction = 0.0, absorbed = 0.0, asymmetry = 0.0;
  double albedo() const { return 1.0 - absorbed / extinction; }
};

struct Block {
  double radius_um = 0.0;
  std::vector<double> um;
  std::vector<Optics> optics;
  /// As its readers do: all three linear in wavelength.
  Optics at(double asked) const {
    const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(std::lower_bound(um.begin(), um.end(), asked) - um.begin(), 1, std::ssize(um) - 1));
    const double f = (asked - um[k - 1]) / (um[k] - um[k - 1]);
    const Optics &a = optics[k - 1], &b = optics[k];
    return {a.extinction + f * (b.extinction - a.extinction), a.absorbed + f * (b.absorbed - a.absorbed), a.asymmetry + f * (b.asymmetry - a.asymmetry)};
  }
};

std::vector<Block> blocksOf(const std::string& name) {
  const CsvTable t = readCsvTable(kRoot / "atmosphere/library/aerosols" / (name + ".csv"), {}, 10000, {});
  std::vector<Block> all;
  for (std::size_t row = 0; row < t.rows(); ++row) {
    if (all.empty() || all.back().radius_um != t.at(row, 0)) all.emplace_back().radius_um = t.at(row, 0);
    all.back().um.push_back(t.at(row, 1));
    all.back().optics.push_back({t.at(row, 2), t.at(row, 2) * (1.0 - t.at(row, 3)), t.at(row, 4)});
  }
  return all;
}

/// Between blocks: logarithms of extinction and of what is absorbed, and asymmetry, linear in ln r.
Optics at(const std::vector<Block>& all, double radius_um, double um) {
  const auto over = std::upper_bound(all.begin() + 1, all.end() - 1, radius_um, [](double r, const Block& b) { return r < b.radius_um; });
  const Block &low = *(over - 1), &high = *over;
  const double f = std::log(radius_um / low.radius_um) / std::log(high.radius_um / low.radius_um);
  const Optics a = low.at(um), b = high.at(um);
  return {a.extinction * std::pow(b.extinction / a.extinction, f), a.absorbed * std::pow(b.absorbed / a.absorbed, f),
          a.asymmetry + f * (b.asymmetry - a.asymmetry)};
}

/// Means over a published band, each wavelength alike.
Optics meanOver(const std::vector<Block>& all, double radius_um, double low_um, double high_um) {
  Optics sum;
  double scattered = 0.0;
  constexpr int kSteps = 200;
  for (int i = 0; i < kSteps; ++i) {
    const Optics o = at(all, radius_um, low_um + (high_um - low_um) * (i + 0.5) / kSteps);
    sum.extinction += o.extinction / kSteps, sum.absorbed += o.absorbed / kSteps;
    sum.asymmetry += o.asymmetry * (o.extinction - o.absorbed), scattered += o.extinction - o.absorbed;
  }
  sum.asymmetry /= scattered;
  return sum;
}

/// The library's water, linear between its rows; its end beyond.
Complex water(double um) {
  static const std::vector<std::array<double, 3>> rows = [] {
    std::vector<std::array<double, 3>> all;
    const std::string text = readWholeFile(kRoot / "materials/substances/water.yaml");
    const std::regex row(R"(\[\s*([0-9.e+-]+),\s*([0-9.e+-]+),\s*([0-9.e+-]+)\s*\])");
    for (std::sregex_iterator i(text.begin(), text.end(), row), end; i != end; ++i) all.push_back({std::stod((*i)[1]), std::stod((*i)[2]), std::stod((*i)[3])});
    return all;
  }();
  if (um <= rows.front()[0]) return {rows.front()[1], rows.front()[2]};
  const auto b = std::lower_bound(rows.begin(), rows.end() - 1, um, [](const auto&r, double x) { return r[0] < x; }), a = b - 1;
  const double f = (um - (*a)[0]) / ((*b)[0] - (*a)[0]);
  return {(*a)[1] + f * ((*b)[1] - (*a)[1]), (*a)[2] + f * ((*b)[2] - (*a)[2])};
}

/// Of light on a large sphere of size parameter x: absorbed, reflected outside, refracted through it; and the latter two times their mean cosines.
/// Law: Fresnel's reflectances, rays of all orders summed as a geometric series in R T exp(-2 i tau'), tau' the glancing angle inside.
/// Source: van de Hulst 1957, Light Scattering by Small Particles, chapter 12; Bohren and Huffman 1983, chapter 7.
struct Rays {
  double absorbed = 0.0, reflected = 0.0, through = 0.0, turnedBack = 0.0, turnedThrough = 0.0;
};
Rays raysOf(Complex m, double x, int steps) {
  Rays out;
  for (int i = 0; i < steps; ++i) {
    const double q = (i + 0.5) / steps, cosine = q * q, weight = 2.0 * cosine * q / steps, sine2 = 1.0 - cosine * cosine, n = m.real();
    const bool total = sine2 >= n * n;
    const double inside = total ? 0.0 : std::sqrt(1.0 - sine2 / (n * n)), passed = std::exp(-4.0 * m.imag() * x * inside);
    const Complex s = std::sqrt(m * m - sine2);
    for (const double r : {std::norm((cosine - s) / (cosine + s)), std::norm((m * m * cosine - s) / (m * m * cosine + s))}) {
      out.reflected += weight * r, out.turnedBack += weight * r * (1.0 - 2.0 * cosine * cosine);
      if (total) {
        out.absorbed += weight * (1.0 - r);
        continue;
      }
      const Complex step = std::polar(passed, -2.0 * std::asin(inside));
      out.absorbed += weight * (1.0 - r) * (1.0 - passed) / (1.0 - r * passed);
      out.through += weight * (1.0 - r) * (1.0 - r) * passed / (1.0 - r * passed);
      out.turnedThrough += weight * (1.0 - r) * (1.0 - r) * (std::polar(1.0, 2.0 * std::asin(cosine)) * step / (1.0 - r * step)).real();
    }
  }
  return out;
}

/// f(q, weight): q = radius over effective radius, of a gamma distribution of effective variance 0.1, by area.
template <class F>
void overSizes(int count, F&& f) {
  for (int i = 0; i < count; ++i) {
    const double q = 0.08 + 3.32 * (i + 0.5) / count;
    f(q, std::pow(q, 9.0) * std::exp(9.0 - 10.0 * q));
  }
}

double sizeParameter(double radius_um, double um) { return 2.0 * kPi * radius_um / um; }

/// Efficiencies of drops by Mie. The last is the asymmetry times what is scattered.
struct Efficiencies {
  double extinction = 0.0, absorbed = 0.0, turned = 0.0;
};
Efficiencies mieOf(Complex m, double x, int count) {
  double area = 0.0;
  Efficiencies out;
  overSizes(count, [&](double q, double w) {
    const SphereScattering s = sphereScattering(x * q, m);
    area += w, out.extinction += w * s.extinction, out.absorbed += w * (s.extinction - s.scattering), out.turned += w * s.scattering * s.asymmetry;
  });
  return {out.extinction / area, out.absorbed / area, out.turned / area};
}
Efficiencies raysOver(Complex m, double x) {
  double area = 0.0;
  Efficiencies out;
  overSizes(60, [&](double q, double w) {
    const Rays r = raysOf(m, x * q, 300);
    area += w, out.extinction += 2.0 * w, out.absorbed += w * r.absorbed, out.turned += w * (1.0 + r.turnedBack + r.turnedThrough);
  });
  return {out.extinction / area, out.absorbed / area, out.turned / area};
}

/// Rain: rays and diffraction, and what Mie has beside them at 100 um, falling as r^(-2/3), as what grazing light adds does.
Optics rain(double radius_um, double um) {
  const Complex m = water(um);
  const double edge = std::pow(100.0 / radius_um, 2.0 / 3.0), x100 = sizeParameter(100.0, um);
  const Efficiencies mie = mieOf(m, x100, static_cast<int>(8.0 * x100)), own = raysOver(m, sizeParameter(radius_um, um)), there = raysOver(m, x100);
  const double extinction = 2.0 + edge * (mie.extinction - there.extinction), absorbed = own.absorbed + edge * (mie.absorbed - there.absorbed);
  return {extinction, absorbed, (own.turned + edge * (mie.turned - there.turned)) / (extinction - absorbed)};
}

/// Crystals, of a mean path d = volume over projected area = 4/3 of the effective radius.
/// Law: rays absorb T s / (T + s), s = n^2 4 pi k d / wavelength, T what a face lets in of diffuse light (Malinka 2014, J. Quant. Spectrosc. Radiat. Transf.
/// 141,
///   14: random paths, roughened); waves add what Mie's spheres of as much volume over area have beyond rays, times the square of what those rays absorb.
///   Extinction: anomalous diffraction (van de Hulst 1957) over paths of a gamma distribution of order 2, and the edge of Mitchell 2000, J. Atmos. Sci. 57,
///   1311. Asymmetry: reflected outside as by spheres; let through with 2.4 times a sphere's 1 - g, which makes 0.76 in the visible; the rest diffracted.
Optics crystals(Complex m, double radius_um, double um) {
  const double x = sizeParameter(radius_um, um), d = 4.0 / 3.0 * radius_um, few = std::min(x, 150.0);
  const Rays sphere = raysOf(m, x, 400);
  const double in = 1.0 - sphere.reflected, seen = m.real() * m.real() * 4.0 * kPi * m.imag() * d / um, byRays = in * seen / (in + seen);
  double area = 0.0, byWaves = 0.0;
  overSizes(std::max(200, static_cast<int>(4.0 * few)), [&](double q, double w) {
    const SphereScattering s = sphereScattering(few * q, m);
    area += w, byWaves += w * (s.extinction - s.scattering - raysOf(m, few * q, 60).absorbed);
  });
  const double absorbed = byRays + sphere.absorbed * sphere.absorbed * byWaves / area * std::pow(few / x, 2.0 / 3.0);
  const Complex phase = 1.0 - Complex(0.0, kPi * d / um) * (m - 1.0);
  const double extinction = 2.0 * (1.0 - 1.0 / (phase * phase)).real() + (1.0 - std::exp(-0.06 * x)) * std::pow(x, -2.0 / 3.0);
  const double through = in - byRays, clear = through / in;
  const Rays near = raysOf(m, std::min(x, 0.75 / m.imag()), 400);  // those short enough to be let through
  const double cosine = 1.0 - 2.4 * (1.0 - near.turnedThrough / near.through);
  const double diffracted = extinction - absorbed - sphere.reflected - through;
  return {extinction, absorbed, (sphere.turnedBack + through * cosine + diffracted * (1.0 - (0.1 + 1.3 * clear * clear) / x)) / (extinction - absorbed)};
}

/// What lines between the files' rows may be off by, of extinction.
constexpr double kLines = 0.03;

void expectSame(const std::string& what, const Optics& file, Optics law, double lawUsual, double absorbedPart) {
  law.extinction /= lawUsual, law.absorbed /= lawUsual;
  figure("extinction, " + what, file.extinction, law.extinction, 0.01, "four digits, lines between wavelengths");
  if (law.absorbed > 3e-5) figure("absorbed, " + what, file.absorbed, law.absorbed, absorbedPart, "digits of the albedo, lines between wavelengths");
  else EXPECT_NEAR(file.absorbed, law.absorbed, 1e-6) << what;
  EXPECT_NEAR(file.asymmetry, law.asymmetry, 0.005) << what;
}

TEST(CloudDrops, FilesAreWhole) {
  for (const std::string name : {"water_drops", "ice_crystals"}) {
    const std::vector<Block> all = blocksOf(name);
    ASSERT_GE(all.size(), 5u);
    for (const Block& b : all) {
      EXPECT_EQ(b.um, all.front().um) << name;
      EXPECT_DOUBLE_EQ(b.um.front(), 0.25);
      EXPECT_DOUBLE_EQ(b.um.back(), 16.0);
      EXPECT_NEAR(b.at(0.55).extinction, 1.0, 1e-4);
      for (std::size_t i = 0; i < b.um.size(); ++i) {
        if (i) {
          EXPECT_GT(b.um[i], b.um[i - 1]);
        }
        EXPECT_GT(b.optics[i].albedo(), 0.0);
        EXPECT_LE(b.optics[i].albedo(), 1.0);
        EXPECT_GT(b.optics[i].asymmetry, 0.0);
        EXPECT_LT(b.optics[i].asymmetry, 1.0);
      }
    }
    EXPECT_DOUBLE_EQ(all.front().radius_um, name == "water_drops" ? 2.0 : 5.0);
    EXPECT_DOUBLE_EQ(all.back().radius_um, 3000.0);
  }
}

/// The row nearest to a wavelength.
std::size_t nearest(const Block& b, double um) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < b.um.size(); ++i)
    if (std::abs(std::log(b.um[i] / um)) < std::abs(std::log(b.um[best] / um))) best = i;
  return best;
}

TEST(CloudDrops, DropsAreMies) {
  const std::vector<Block> all = blocksOf("water_drops");
  const auto mie = [](double radius, double um) {
    const Complex m = water(um);
    const Efficiencies e = mieOf(m, sizeParameter(radius, um), std::max(400, static_cast<int>(8.0 * sizeParameter(radius, um))));
    return Optics{e.extinction, e.absorbed, e.turned / (e.extinction - e.absorbed)};
  };
  for (const Block& b : all) {
    if (b.radius_um > 35.0) continue;
    const double usual = mie(b.radius_um, 0.55).extinction;
    for (const double um : {0.4, 1.6, 2.2, 3.1, 3.7, 4.9, 8.8, 11.0, 14.0}) {
      const std::size_t i = nearest(b, um);
      expectSame(std::to_string(b.radius_um) + " um at " + std::to_string(b.um[i]) + " um", b.optics[i], mie(b.radius_um, b.um[i]), usual,
                 um < 3.0 ? 0.03 : 0.01);
    }
  }
  // Between rows and blocks, by lines.
  const double usual10 = mie(10.0, 0.55).extinction;
  for (const double um : {1.7, 2.13, 3.3, 4.9, 8.5, 9.4, 10.8, 11.9}) {
    const Optics file = at(all, 10.0, um), law = mie(10.0, um);
    bound("extinction of 10 um between rows at " + std::to_string(um) + " um, relative", std::abs(file.extinction * usual10 / law.extinction - 1.0), kLines,
          "lines between thinned-out rows");
    bound("absorbed by 10 um between rows at " + std::to_string(um) + " um, relative", std::abs(file.absorbed * usual10 / law.absorbed - 1.0), 0.1,
          "lines between thinned-out rows");
    EXPECT_NEAR(file.asymmetry, law.asymmetry, 0.012) << um;
  }
  // The library's own integration over sizes.
  const SizeDistribution cloud(ModifiedGamma::of(10.0, 0.1));
  const ParticleOptics o = opticsOf(cloud, water(10.5), 10.5, 0), usual = opticsOf(cloud, water(0.55), 0.55, 0);
  const Optics file = at(all, 10.0, 10.5);
  figure("extinction of drops at 10.5 um over that at 0.55 um", file.extinction, o.extinction_um2 / usual.extinction_um2, 0.01,
         "gamma distribution by opticsOf");
  EXPECT_NEAR(file.albedo(), o.albedo, 0.005);
  EXPECT_NEAR(file.asymmetry, o.asymmetry, 0.005);
}

TEST(CloudDrops, RainIsRays) {
  const std::vector<Block> all = blocksOf("water_drops");
  for (const double radius : {300.0, 3000.0}) {
    const double usual = 2.0 + (mieOf(water(0.55), sizeParameter(100.0, 0.55), 2000).extinction - 2.0) * std::pow(100.0 / radius, 2.0 / 3.0);
    for (const double um : {2.2, 3.7, 10.0})
      expectSame("rain of " + std::to_string(static_cast<int>(radius)) + " um at " + std::to_string(um) + " um", at(all, radius, um), rain(radius, um), usual,
                 0.03);
  }
  // Mie's own, of drops as large as it can still be asked for.
  const Efficiencies mie = mieOf(water(10.0), sizeParameter(300.0, 10.0), 2000);
  const Optics file = at(all, 300.0, 10.0);
  EXPECT_NEAR(file.albedo(), 1.0 - mie.absorbed / mie.extinction, 0.005);
  EXPECT_NEAR(file.asymmetry, mie.turned / (mie.extinction - mie.absorbed), 0.005);
}

TEST(CloudDrops, CrystalsAreTheirLaw) {
  const std::vector<Block> all = blocksOf("ice_crystals");
  struct Row {
    double um;
    Complex m;
  };
  // Rows of Warren and Brandt 2008.
  const Complex visible{1.311, 2.289e-9};
  for (const std::size_t i : {std::size_t{0}, all.size() / 2, all.size() - 1}) {
    const double radius = all[i].radius_um, usual = crystals(visible, radius, 0.55).extinction;
    for (const Row& r : {Row{0.55, visible},
                         {0.86, {1.3039, 2.15e-07}},
                         {1.493, {1.2918, 0.0005532}},
                         {2.15, {1.2663, 0.0004025}},
                         {2.899, {0.9563, 0.169}},
                         {3.732, {1.3924, 0.006672}},
                         {7.042, {1.3244, 0.05161}},
                         {10.87, {1.0833, 0.204}},
                         {13.89, {1.5596, 0.294}}})
      expectSame("ice of " + std::to_string(radius) + " um at " + std::to_string(r.um) + " um", all[i].at(r.um), crystals(r.m, radius, r.um), usual, 0.01);
  }
}

TEST(CloudDrops, LiquidCloudsAreThePublishedOnes) {
  const std::vector<Block> all = blocksOf("water_drops");
  const Optics visible = at(all, 10.0, 0.55);
  EXPECT_NEAR(visible.asymmetry, 0.86, 0.01);
  EXPECT_GE(visible.albedo(), 0.999999);
  EXPECT_NEAR(at(all, 50.0, 0.55).asymmetry, 0.875, 0.01);
  struct Band {
    double low_um, high_um, albedo, asymmetry;
  };
  // Of an effective radius of 10 um, from the published polynomials; bands by wavenumber, here without the weight of sunlight or of the Planck law.
  for (const Band& b :
       {Band{1.19, 2.38, 0.9799, 0.0},       // Dobbie, Li and Chylek 1999, J. Geophys. Res. 104, 2067
        Band{4.545, 5.263, 0.8061, 0.8488},  // Lindner and Li 2000, J. Climate 13, 1797
        Band{5.263, 7.143, 0.6891, 0.0}, Band{7.143, 9.091, 0.7359, 0.8925}, Band{9.091, 10.2, 0.6846, 0.9136}, Band{10.2, 12.5, 0.4435, 0.9165}}) {
    const Optics o = meanOver(all, 10.0, b.low_um, b.high_um);
    const std::string what = "drops of 10 um, " + std::to_string(b.low_um) + " to " + std::to_string(b.high_um) + " um: ";
    bound(what + "albedo beside the published", std::abs(o.albedo() - b.albedo), 0.03, "published polynomial over the band");
    if (b.asymmetry > 0.0) bound(what + "asymmetry beside the published", std::abs(o.asymmetry - b.asymmetry), 0.03, "published polynomial over the band");
  }
}

TEST(CloudDrops, IceCloudsAreThePublishedOnes) {
  const std::vector<Block> all = blocksOf("ice_crystals");
  struct Published {
    double low_um, high_um, albedo, asymmetry, albedoWithin, asymmetryWithin;
  };
  // Of an effective radius of 25 um. Rough aggregates: Key et al. 2002, bands. Hexagonal columns: Fu 1996, J. Climate 9, 2058, and Fu et al. 1998, J. Climate
  // 11, 2223.
  for (const Published& p : {Published{0.5, 0.6, 1.0, 0.7635, 1e-5, 0.01},  // Key
                             Published{1.5, 1.65, 0.9348, 0.7939, 0.01, 0.02}, Published{2.1, 2.2, 0.9429, 0.8014, 0.01, 0.02},
                             Published{3.5, 4.0, 0.6672, 0.8792, 0.03, 0.03},      // Fu 1996
                             Published{3.969, 3.969, 0.6753, 0.8758, 0.03, 0.02},  // Fu 1998
                             Published{8.065, 8.065, 0.6219, 0.9138, 0.04, 0.02}, Published{9.091, 9.091, 0.6420, 0.9301, 0.04, 0.03},
                             Published{10.0, 10.0, 0.6164, 0.9495, 0.03, 0.03}, Published{11.0, 11.0, 0.4654, 0.9492, 0.03, 0.03},
                             Published{12.2, 12.2, 0.4803, 0.9129, 0.03, 0.03}}) {
    const Optics o = meanOver(all, 25.0, p.low_um, p.high_um);
    const std::string what = "crystals of 25 um, " + std::to_string(p.low_um) + " to " + std::to_string(p.high_um) + " um: ";
    bound(what + "albedo beside the published", std::abs(o.albedo() - p.albedo), p.albedoWithin, "other shapes, other indices");
    bound(what + "asymmetry beside the published", std::abs(o.asymmetry - p.asymmetry), p.asymmetryWithin, "other shapes, other indices");
  }
}

}  // namespace
}  // namespace pitviper::test::cloud_drops
