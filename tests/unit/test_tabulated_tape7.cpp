// Air by tables from MODTRAN's runs: runs written here against values worked out by hand, what must be refused, and others' samples where present.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "atmosphere/modtran_files.hpp"
#include "atmosphere/tabulated_tape7.hpp"
#include "atmosphere/tape7_spectra.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {
namespace {

struct Card {
  int iemsct = 0, itype = 1;
  double h1_km = 0.0, zenith_deg = 0.0, range_km = 1.0, from_per_cm = 2000.0;
  int haze = 1;
};

std::string cards(const Card& c) {
  return print("T F 6%5d%5d    0    6    6    6    6    6    6    1    0    0   0.000   0.00\n", c.itype, c.iemsct) +
         print("%5d    1    1\n\n\n   36US\n", c.haze) +
         print("%10.5f%10.5f%10.5f%10.5f%10.5f%10.5f%5d%18.5f\n", c.h1_km, 10.0, c.zenith_deg, c.range_km, 0.0, 0.0, 0, 0.0) + "\n\n" +
         print("%10.1f%10.1f%10.1f%10.1fNW\n", c.from_per_cm, 2500.0, 500.0, 20.0) + "\n";
}

/// Two rows, 2000 and 2500 1/cm: transmittance and path radiance [W/(cm2 sr cm-1)].
std::string thermal(Card c, std::array<double, 2> tau, std::array<double, 2> radiance) {
  c.iemsct = 1;
  std::string text = cards(c) +
                     "    FREQ  TOT_TRANS  PTH_THRML  THRML_SCT  SURF_EMIS   SOL_SCAT  SING_SCAT  GRND_RFLT  DRCT_RFLT  TOTAL_RAD  REF_SOL  SOL@OBS   "
                     "DEPTH DIR_EM    TOA_SUN BBODY_T[K]\n";
  for (size_t i = 0; i < 2; ++i)
    text += print("%8.2f%11.8f%11.4E%11.4E%11.4E%33s%11.4E%11.4E%18s%8.3f%7.4f\n", i == 0 ? c.from_per_cm : 2500.0, tau[i], radiance[i], 0.0, 0.0, "", 0.0,
                  radiance[i], "", std::min(-std::log(std::max(tau[i], 1e-40)), 99.99), 1.0);
  return text + " -9999.\n";
}

/// Per row: total, water lines, mixed gases, ozone, then the water continuum and the aerosol.
std::string gases(Card c, const std::array<std::array<double, 6>, 2>& rows) {
  constexpr std::array<const char*, 2> names[] = {{"COMBIN", "TRANS"},   {"H2O", "TRANS"},   {"UMIX", "TRANS"}, {"O3", "TRANS"},      {"TRACE", "TRANS"},
                                                  {"N2", "CONT"},        {"H2O", "CONT"},    {"MOLEC", "SCAT"}, {"AER+CLD", "TRANS"}, {"HNO3", "TRANS"},
                                                  {"AER+CLD", "abTRNS"}, {"-LOG", "COMBIN"}, {"CO2", "TRANS"}};
  std::string upper = "    FREQ", lower = "    CM-1";
  for (const auto& n : names) {
    const int width = n[0][0] == '-' ? 8 : 7;
    upper += print("%*s", width, n[0]), lower += print("%*s", width, n[1]);
  }
  std::string text = cards(c) + upper + "\n" + lower + "\n";
  for (size_t i = 0; i < 2; ++i)
    text += print("%8.2f%7.4f%7.4f%7.4f%7.4f%7.4f%7.4f%7.4f%7.4f%7.4f%7.4f%7.4f%8.3f%7.4f\n", i == 0 ? c.from_per_cm : 2500.0, rows[i][0], rows[i][1],
                  rows[i][2], rows[i][3], 1.0, 1.0, rows[i][4], 1.0, rows[i][5], 1.0, 1.0, -std::log(rows[i][0]), 1.0);
  return text + " -9999.\n";
}

TabulatedAir air(const std::string& text, const PathChoice& choice = {}) { return tabulatedAir(parseTape7(text, "t7"), choice); }

std::string refused(const std::string& text, const PathChoice& choice = {}) {
  try {
    air(text, choice);
  } catch (const UserError& e) {
    return e.what();
  }
  return "no error";
}

TEST(TabulatedTape7, ComponentsKeepTheirPowers) {
  // 2 km: ln of the parts 0.8 0.9 0.95 0.98 0.97 scaled to the total.
  const TabulatedAir a = air(gases({.range_km = 2.0}, {{{0.6500, 0.8, 0.9, 0.95, 0.98, 0.97}, {1.0, 1.0, 1.0, 1.0, 1.0, 1.0}}}));
  ASSERT_EQ(a.exponents().size(), 4u);
  const double sum = -std::log(0.8 * 0.9 * 0.95 * 0.98 * 0.97), scale = -std::log(0.65) / sum;
  const std::array<double, 4> parts = {-std::log(0.8), -std::log(0.9), -std::log(0.95), -std::log(0.98 * 0.97)};
  for (size_t k = 0; k < 4; ++k) EXPECT_NEAR(a.coefficients(5.0)[k], scale * parts[k] / std::pow(2.0, a.exponents()[k]), 1e-12);
  EXPECT_NEAR(a.transmittance(5.0, 2000.0), 0.65, 1e-12);
  EXPECT_EQ(a.transmittance(4.0, 1e5), 1.0);
  EXPECT_GT(a.transmittance(5.0, 8000.0), std::pow(0.65, 4));  // bands of lines fall off less than exponentially
  EXPECT_EQ(a.longestRange_m(), 2000.0);
  EXPECT_FALSE(a.emits());
  EXPECT_EQ(a.sourceRadiance(4.5), 0.0);
}

TEST(TabulatedTape7, OneRadianceRunIsExponential) {
  const TabulatedAir a = air(thermal({.range_km = 2.0}, {0.25, 0.64}, {3e-8, 1e-8}));
  EXPECT_NEAR(a.transmittance(5.0, 1000.0), 0.5, 1e-9);
  EXPECT_NEAR(a.transmittance(4.0, 1000.0), 0.8, 1e-9);
  // 3e-8 x 2000^2 = 0.12 W/(m2 sr um) through 1 - 0.25.
  EXPECT_NEAR(a.sourceRadiance(5.0), 0.16, 1e-9);
  EXPECT_NEAR(a.pathRadiance(5.0, 2000.0), 0.12, 1e-9);
  EXPECT_NEAR(a.pathRadiance(4.0, 2000.0), 0.0625, 1e-9);
  EXPECT_LT(a.fit().largest, 1e-9);
  EXPECT_LT(a.fit().radiance, 1e-9);
  EXPECT_NE(a.description().find("exponential in range"), std::string::npos) << a.description();
}

TEST(TabulatedTape7, TransmittanceAndRadianceOfOneRangeJoin) {
  const Card c{.range_km = 2.0};
  const TabulatedAir a = air(gases(c, {{{0.25, 0.25, 1, 1, 1, 1}, {0.64, 1, 1, 1, 0.64, 1}}}) + thermal(c, {0.25, 0.64}, {3e-8, 1e-8}));
  EXPECT_EQ(a.exponents().size(), 4u);
  EXPECT_NEAR(a.pathRadiance(5.0, 2000.0), 0.12, 1e-9);
  EXPECT_NEAR(a.transmittance(5.0, 1000.0), std::exp(std::log(0.25) * std::pow(0.5, 0.552)), 1e-9);
  EXPECT_NEAR(a.transmittance(4.0, 1000.0), 0.8, 1e-9);
}

TEST(TabulatedTape7, SeveralRangesAreFitted) {
  std::string text;
  const auto tau = [](double r, double a, double b) { return std::exp(-a * std::pow(r, 0.55) - b * r); };
  for (double r : {5.0, 1.0, 2.0, 10.0})
    text += thermal({.range_km = r}, {tau(r, 0.3, 0.1), tau(r, 0.0, 0.2)}, {1e-8 * (1 - tau(r, 0.3, 0.1)), 2e-8 * (1 - tau(r, 0.0, 0.2))});
  const TabulatedAir a = air(text);
  EXPECT_NEAR(a.coefficients(5.0)[0], 0.3, 1e-5);  // eight decimals of transmittance
  EXPECT_NEAR(a.coefficients(5.0)[1], 0.0, 2e-5);
  EXPECT_NEAR(a.coefficients(5.0)[2], 0.1, 1e-5);
  EXPECT_NEAR(a.transmittance(4.0, 3000.0), tau(3, 0, 0.2), 1e-7);
  EXPECT_NEAR(a.sourceRadiance(5.0), 0.04, 1e-5);
  EXPECT_LT(a.fit().largest, 1e-7);
  EXPECT_LT(a.fit().radiance, 1e-4);  // five digits of radiance
  EXPECT_EQ(a.shortestRange_m(), 1000.0);
  EXPECT_EQ(a.longestRange_m(), 10000.0);
}

TEST(TabulatedTape7, RunsToSpaceAreTheSky) {
  const std::string sky =
      thermal({.itype = 3, .zenith_deg = 60, .range_km = 0}, {0.1, 0.2}, {4e-8, 2e-8}) + thermal({.itype = 3, .zenith_deg = 0}, {0.3, 0.4}, {2e-8, 1e-8});
  const TabulatedAir a = air(thermal({.range_km = 2.0}, {0.25, 0.64}, {3e-8, 1e-8}) + sky);
  ASSERT_TRUE(a.sky());
  EXPECT_NEAR(a.sky()->radiance(5.0, kPi / 2), 0.08, 1e-9);
  EXPECT_NEAR(a.sky()->radiance(5.0, kPi / 6), 0.16, 1e-9);
  EXPECT_NEAR(a.sky()->radiance(4.0, kPi / 6), 0.125, 1e-9);
  EXPECT_EQ(tabulatedSky(parseTape7(sky, "t7"))->views().size(), 2u);
  EXPECT_FALSE(tabulatedSky(parseTape7(thermal({}, {0.2, 0.3}, {0, 0}), "t7")));
}

// Level runs at two heights, slant ones in two directions and the sky in one file: one kind at a time makes the air, and it is said what was left out.
TEST(TabulatedTape7, PathsAreChosenAndNeverMixed) {
  const auto along = [](Card c, double perKm) {
    const double tau = std::exp(-perKm * c.range_km);
    return thermal(c, {tau, tau}, {1e-8 * (1 - tau), 1e-8 * (1 - tau)});
  };
  std::string text;
  for (double range : {1.0, 4.0}) {
    text += along({.h1_km = 0.0, .range_km = range}, 0.2) + along({.h1_km = 2.0, .range_km = range}, 0.1);
    text += along({.itype = 2, .zenith_deg = 60, .range_km = range}, 0.15) + along({.itype = 2, .zenith_deg = 120, .range_km = range}, 0.3);
  }
  for (double height : {0.0, 2.0}) text += thermal({.itype = 3, .h1_km = height, .zenith_deg = 30, .range_km = 0}, {0.1, 0.2}, {4e-8, 2e-8});
  const auto perKm = [&](const PathChoice& choice) { return air(text, choice).opticalDepth(4.5, 2500.0) / 2.5; };
  const double deg = kPi / 180.0;
  EXPECT_NEAR(perKm({.height_m = 0.0}), 0.2, 1e-6);  // eight decimals of transmittance
  EXPECT_NEAR(perKm({.height_m = 2000.0}), 0.1, 1e-6);
  EXPECT_NEAR(perKm({.height_m = 0.0, .elevation_rad = 0.0}), 0.2, 1e-6);
  EXPECT_NEAR(perKm({.height_m = 0.0, .elevation_rad = 30 * deg}), 0.15, 1e-6);
  EXPECT_NEAR(perKm({.height_m = 0.0, .elevation_rad = -30 * deg}), 0.3, 1e-6);
  EXPECT_TRUE(air(text, {.height_m = 0.0}).sky());
  EXPECT_NE(air(text, {.height_m = 0.0}).description().find("6 runs of other heights or directions left out"), std::string::npos);
  const std::string heights = refused(text);
  EXPECT_EQ(heights.rfind("t7:15:1: run 2 is along another path or in other air than run 1", 0), 0u) << heights;
  EXPECT_NE(heights.find("fix: choose a height: 0 km, 2 km"), std::string::npos) << heights;
  const std::string none = refused(text, {.height_m = 1000.0});
  EXPECT_NE(none.find("t7:1:1: no run has a height of 1 km; expected one of those in the file: 0 km, 2 km"), std::string::npos) << none;
  EXPECT_NE(refused(text, {.elevation_rad = 45 * deg}).find("no run has an elevation of 45 deg; expected one of those in the file: level, 30 deg, -30 deg"),
            std::string::npos);
  // Without level runs a direction must be chosen, where there are several.
  const std::string slant = along({.itype = 2, .zenith_deg = 60}, 0.1) + along({.itype = 2, .zenith_deg = 70, .range_km = 2}, 0.1);
  EXPECT_NE(refused(slant).find("fix: choose an elevation: 30 deg, 20 deg"), std::string::npos) << refused(slant);
  EXPECT_NEAR(air(slant, {.elevation_rad = 20 * deg}).transmittance(4.5, 2000.0), std::exp(-0.2), 1e-8);
  // One level run beside slant ones is the air.
  EXPECT_NEAR(air(slant + along({.range_km = 3}, 0.4)).transmittance(4.5, 3000.0), std::exp(-1.2), 1e-8);
}

// MODTRAN 6 names what is emitted and what is scattered apart; TOTAL_RAD says that they are what the path sends.
TEST(TabulatedTape7, Modtran6KeepsItsScatteringApart) {
  const std::string names =
      "    FREQ  TOT_TRANS   THRML_EM  THRML_SCT  SURF_EMIS  MULT_SCAT  SING_SCAT  GRND_RFLT  DRCT_RFLT  TOTAL_RAD  REF_SOL  SOL@OBS   DEPTH DIR_EM    "
      "TOA_SUN BBODY_T[K]\n";
  const auto row = [](double v, double total) {
    return print("%8.2f%11.8f%11.4E%11.4E%11.4E%11.4E%11.4E%11.4E%11.4E%11.4E%9.2E%9.2E%8.3f%7.4f%11.4E%11.3f\n", v, 0.5, 2e-8, 1e-9, 5e-9, 3e-9, 4e-9, 7e-9,
                 6e-9, total, 1e-6, 1e-6, 0.693, 1.0, 1e-6, 255.0);
  };
  const std::string head = cards({.iemsct = 2, .range_km = 2.0});
  // 2 + 0.1 + 0.3 + 0.4 of 1e-8 W/(cm2 sr cm-1) from the air, 0.5 + 0.7 from the surface.
  const auto runs = parseTape7(head + names + row(2000, 4e-8) + row(2500, 4e-8) + " -9999.\n", "t7");
  EXPECT_EQ(runs[0].columns.size(), 15u);
  for (const auto& c : runs[0].columns) EXPECT_NE(c.quantity, Tape7Quantity::Unknown) << c.name;
  EXPECT_NEAR(pathRadiance(runs[0])(5.0), 2.8e-8 * 2000 * 2000, 1e-12);
  EXPECT_NEAR(tabulatedAir(runs).pathRadiance(4.0, 2000.0), 2.8e-8 * 2500 * 2500, 1e-12);
  try {
    tabulatedAir(parseTape7(head + names + row(2000, 4e-8) + row(2500, 4.1e-8) + " -9999.\n", "t7"));
    ADD_FAILURE();
  } catch (const UserError& e) {
    const std::string said = e.what();
    EXPECT_EQ(said.rfind("t7:13:97: TOTAL_RAD is not the sum of its parts", 0), 0u) << said;
    EXPECT_NE(said.find("expected THRML_EM + THRML_SCT + MULT_SCAT + SING_SCAT + SURF_EMIS + GRND_RFLT"), std::string::npos) << said;
  }
}

TEST(TabulatedTape7, OpaqueAndClearBins) {
  const TabulatedAir a = air(thermal({.range_km = 2.0}, {0.0, 1.0}, {3e-8, 0.0}));
  EXPECT_LT(a.transmittance(5.0, 2000.0), 1e-8);
  EXPECT_NEAR(a.pathRadiance(5.0, 2000.0), 0.12, 1e-8);
  EXPECT_EQ(a.transmittance(4.0, 2000.0), 1.0);
  EXPECT_EQ(a.pathRadiance(4.0, 2000.0), 0.0);
}

TEST(TabulatedTape7, MistakesAreNamed) {
  const auto starts = [](const std::string& message, const std::string& begin) {
    EXPECT_EQ(message.rfind(begin, 0), 0u) << message << "\n  should begin with " << begin;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
  };
  const std::array<double, 2> tau = {0.25, 0.64}, l = {3e-8, 1e-8};
  const std::string one = thermal({}, tau, l);
  starts(refused(thermal({.itype = 3}, tau, l)), "t7:1:1: run 1 is a path to space, so no air along a range is known");
  starts(refused(thermal({.range_km = 0.0}, tau, l)), "t7:1:1: the range of run 1 is not in the file");
  EXPECT_EQ(refused(thermal({.range_km = 0.0}, tau, l), {.range_m = 2000.0}), "no error");
  starts(refused(one, {.range_m = 2000.0}), "t7:1:1: the range given, 2 km, is not the 1 km of run 1");
  EXPECT_EQ(refused(one, {.range_m = 1000.0}), "no error");
  starts(refused(one + thermal({.range_km = 2}, tau, l), {.range_m = 1000.0}), "t7:15:1: a range is given for a file of 2 paths");
  starts(refused(one + one), "t7:15:1: the range 1 km comes twice, in runs 1 and 2");
  starts(refused(one + thermal({.h1_km = 1.0, .range_km = 2}, tau, l)), "t7:15:1: run 2 is along another path or in other air than run 1");
  starts(refused(one + thermal({.range_km = 2, .haze = 0}, tau, l)), "t7:15:1: run 2 is along another path or in other air");
  starts(refused(one + thermal({.range_km = 2, .from_per_cm = 2100}, tau, l)), "t7:23:1: run 2 has other wavenumbers than run 1");
  const std::string up = thermal({.itype = 3, .zenith_deg = 30}, tau, l);
  starts(refused(one + up + up), "t7:29:1: the zenith angle 30 deg comes twice, in runs 2 and 3");
  starts(refused(one + thermal({.itype = 3, .zenith_deg = 120}, tau, l)), "t7:15:1: run 2 looks down, at a zenith angle of 120 deg");
  starts(refused(one + up + thermal({.itype = 3, .h1_km = 2, .zenith_deg = 40}, tau, l)), "t7:29:1: run 3 looks up from another height than run 2");
}

std::filesystem::path samples() {
  if (const char* folder = std::getenv("PITVIPER_TAPE7")) return folder;
  const auto folder = std::filesystem::path(PITVIPER_SOURCE_DIR) / ".." / "shared" / "data" / "tape7";
  return std::filesystem::exists(folder) ? folder : std::filesystem::path();
}

TEST(TabulatedTape7, SamplesAreAirOrRefused) {
  if (samples().empty()) GTEST_SKIP() << "no MODTRAN samples: set PITVIPER_TAPE7 to a folder that holds them";
  for (const char* name : {"tape7-01", "tape7-01b", "tape7-02b", "tape7-03"}) {
    SCOPED_TRACE(name);
    const auto runs = readModtran(samples() / name);
    const TabulatedAir a = tabulatedAir(runs);
    const double range = *runs[0].geometry.range_km * 1e3;
    EXPECT_DOUBLE_EQ(a.longestRange_m(), range);
    const Spectrum tau = totalTransmittance(runs[0]);
    for (double w : runs[0].wavelength_um) {
      // Four decimals of transmittance runs, three of their logarithm; eight of the others.
      const bool four = runs[0].kind == Tape7Kind::Transmittance;
      EXPECT_NEAR(a.transmittance(w, range), tau(w), four ? 1.1e-4 : 2e-8) << w;
      if (!four) {
        EXPECT_NEAR(a.pathRadiance(w, range) / pathRadiance(runs[0])(w), 1.0, 1e-9) << w;
      }
    }
    EXPECT_EQ(a.emits(), runs[0].kind != Tape7Kind::Transmittance);
    EXPECT_THROW(a.requireBand(3.0, 5.0, "seeker"), UserError);
    std::printf("%s: %s\n", name, a.description().c_str());
  }
  for (const char* name : {"tape7-04", "tape7-05", "tape7.LWIRSun"}) {
    try {
      tabulatedAir(readModtran(samples() / name));
      ADD_FAILURE() << name;
    } catch (const UserError& e) {
      EXPECT_NE(std::string(e.what()).find("no air along a range is known"), std::string::npos) << e.what();
    }
  }
  EXPECT_FALSE(tabulatedSky(readModtran(samples() / "tape7-04")));
  const auto sky = tabulatedSky(readModtran(samples() / "tape7.LWIRSun"));
  ASSERT_TRUE(sky);
  EXPECT_NEAR(sky->radiance(8.0, kPi / 2), 5.5406281250000005, 1e-9);  // sliced from the file by a script
}

}  // namespace
}  // namespace pitviper::test
