// MODTRAN 6's JSON and comma-separated output: a known air in each of MODTRAN's files is the same air, and what must be refused.
// The files are written here by the documented layout; no output of MODTRAN 6's was at hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "atmosphere/json_places.hpp"
#include "atmosphere/modtran_files.hpp"
#include "atmosphere/tabulated_tape7.hpp"
#include "atmosphere/tape7_spectra.hpp"
#include "atmosphere/tape7_summary.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/air_text.hpp"

namespace pitviper::test {
namespace {

/// Exponential, and as bright as nothing warmer than 300 K.
double extinction_per_km(double um) { return 0.05 * um; }
double tauOf(double um, double km) { return std::exp(-extinction_per_km(um) * km); }
double sourceOf(double um) { return 0.3 * um; }
double sentOf(double um, double km) { return sourceOf(um) * (1.0 - tauOf(um, km)); }

constexpr std::array<double, 1> kOne = {2.0};
constexpr std::array<double, 3> kThree = {1.0, 2.0, 5.0};

std::string json(std::span<const double> ranges = kOne) { return modtranJsonText(2000, 2500, 50, ranges, tauOf, sentOf); }
std::string csv() { return modtranCsvText(2000, 2500, 50, 2.0, tauOf, sentOf); }

TabulatedAir air(const std::string& text, const PathChoice& choice = {}) { return tabulatedAir(parseModtran(text, "file"), choice); }

std::string refused(const std::string& text, const PathChoice& choice = {}) {
  try {
    air(text, choice);
  } catch (const UserError& e) {
    return e.what();
  }
  return "no error";
}

std::string with(std::string text, const std::string& what, const std::string& instead, size_t nth = 0) {
  size_t at = text.find(what);
  for (; nth > 0; --nth) at = text.find(what, at + 1);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), instead);
}

/// The known air at the file's wavelengths, at any range; at most this far off.
double largestDifference(const TabulatedAir& a) {
  double most = 0.0;
  for (double um : a.knots_um())
    for (double km : {0.1, 2.0, 20.0}) {
      most = std::max(most, std::abs(a.transmittance(um, 1e3 * km) - tauOf(um, km)));
      most = std::max(most, std::abs(a.pathRadiance(um, 1e3 * km) / sentOf(um, km) - 1.0));
    }
  return most;
}

TEST(Modtran6, AnExponentialAirComesBackFromEachFile) {
  const std::string t7 = tape7Text(2000, 2500, 50, kOne, tauOf, sentOf);
  EXPECT_LT(largestDifference(air(json())), 1e-6);
  EXPECT_LT(largestDifference(air(json(kThree))), 1e-6);
  EXPECT_LT(largestDifference(air(csv(), {.range_m = 2000.0})), 1e-6);
  EXPECT_LT(largestDifference(air(t7)), 5e-5);  // five digits of radiance
  std::printf("largest difference: JSON %.1e, of three ranges %.1e, CSV %.1e, tape7 %.1e\n", largestDifference(air(json())),
              largestDifference(air(json(kThree))), largestDifference(air(csv(), {.range_m = 2000.0})), largestDifference(air(t7)));
  // And the three are each other's.
  const TabulatedAir a = air(json()), b = air(csv(), {.range_m = 2000.0});
  for (double um : a.knots_um()) EXPECT_NEAR(a.coefficients(um)[0], b.coefficients(um)[0], 1e-12);
}

TEST(Modtran6, JsonSaysItsCase) {
  const auto runs = parseModtran(json(kThree), "file");
  ASSERT_EQ(runs.size(), 3u);
  const Tape7Run& r = runs[1];
  EXPECT_EQ(r.number, 2);
  EXPECT_EQ(r.kind, Tape7Kind::ThermalRadiance);
  EXPECT_EQ(r.geometry.path, Tape7Path::Horizontal);
  EXPECT_EQ(r.geometry.range_km, 2.0);
  EXPECT_EQ(r.geometry.h1_km, 0.0);
  EXPECT_EQ(r.model, 6);
  EXPECT_EQ(r.haze, 1);
  EXPECT_EQ(r.visibility_km, 23.0);
  EXPECT_EQ(r.wavelength_um.size(), 11u);
  EXPECT_DOUBLE_EQ(r.wavelength_um.front(), 4.0);
  EXPECT_EQ(
      describe(r).rfind("run 2: thermal radiance (IEMSCT 1)\n  US standard 1976 air, MODTRAN bands, haze 1, visibility 23 km\n  horizontal path of 2 km", 0),
      0u)
      << describe(r);
}

TEST(Modtran6, TransmittanceAndSunInJson) {
  const std::string gases = R"({"MODTRAN": [{"MODTRANINPUT": {"RTOPTIONS": {"IEMSCT": "RT_TRANSMITTANCE"}, "GEOMETRY": {"ITYPE": 1, "HRANGE": 2.0}},
    "MODTRANOUTPUT": {"SPECTRA": {"TRANSMITTANCE": {"FREQ": [2000, 2500], "TOT_TRANS": [0.5, 0.9], "TRANS_H2O": [0.6, 0.95], "CONT_H2O": [0.9, 1],
    "TRANS_AERCLD": [0.95, 0.97], "TRANS_CO2": [1, 1], "NUM_FREQ": 2}}}}]})";
  const auto runs = parseModtran(gases, "file");
  for (const char* name : {"COMBIN_TRANS", "H2O_TRANS", "H2O_CONT", "AER+CLD_TRANS", "CO2_TRANS"}) EXPECT_TRUE(runs[0].find(name)) << name;
  const TabulatedAir a = tabulatedAir(runs);
  EXPECT_EQ(a.exponents().size(), 4u);  // each gas by its own power
  EXPECT_NEAR(a.transmittance(5.0, 2000.0), 0.5, 1e-12);
  const std::string sunny = R"({"MODTRAN": [{"MODTRANOUTPUT": {"SPECTRA": {"RADIANCE": {"FREQ": [2000, 2500], "TOT_TRANS": [0.5, 0.9],
    "THRML_EM": [2e-8, 2e-8], "THRML_SCT": [1e-9, 1e-9], "SURF_EMIS": [5e-9, 5e-9], "MULT_SCAT": [3e-9, 3e-9], "SING_SCAT": [4e-9, 4e-9],
    "GRND_RFLT": [7e-9, 7e-9], "DRCT_RFLT": [6e-9, 6e-9], "TOTAL_RAD": [4e-8, 4e-8], "SOL_AT_OBS": [1e-6, 1e-6], "TOA_RAD": [2e-6, 2e-6],
    "BBODY_TK": [255, 255]}}}}]})";
  const auto sun = parseModtran(sunny, "file");
  EXPECT_EQ(sun[0].kind, Tape7Kind::SolarRadiance);
  EXPECT_NEAR(pathRadiance(sun[0])(5.0), 2.8e-8 * 4e6, 1e-12);
  EXPECT_NEAR(sunAtObserver(sun[0])(5.0), 1e-6 * 4e6, 1e-9);
  EXPECT_NEAR(sunAboveAir(sun[0])(5.0), 2e-6 * 4e6, 1e-9);
  // Without its input nothing is known of the path: its range must be given.
  EXPECT_NE(refused(sunny).find("the range of run 1 is not in the file"), std::string::npos) << refused(sunny);
  EXPECT_NEAR(air(sunny, {.range_m = 3000.0}).transmittance(4.0, 3000.0), 0.9, 1e-9);
}

// A case may name another that it is made after; of two lines of sight nothing is taken.
TEST(Modtran6, TemplatesAndLinesOfSight) {
  std::string text = with(json(kThree), "\"RTOPTIONS\"", "\"CASE\": 7, \"RTOPTIONS\"");
  const size_t second = text.find("\"MODTRANINPUT\"", text.find("\"MODTRANINPUT\"") + 1), end = text.find("\"MODTRANOUTPUT\"", second);
  text.replace(second, end - second, "\"MODTRANINPUT\": {\"CASE\": 8, \"CASE TEMPLATE\": 7, \"GEOMETRY\": {\"HRANGE\": 2.0}},\n      ");
  const auto runs = parseModtran(text, "file");
  EXPECT_EQ(runs[1].geometry.path, Tape7Path::Horizontal);
  EXPECT_EQ(runs[1].geometry.range_km, 2.0);
  EXPECT_EQ(runs[1].visibility_km, 23.0);
  EXPECT_LT(largestDifference(tabulatedAir(runs)), 1e-6);
  const std::string one = with(json(), "\"ITYPE\": 1, \"H1ALT\": 0.0, \"HRANGE\": 2", "\"ITYPE\": 1, \"MLOS\": [{\"H1ALT\": 0.5, \"HRANGE\": 2}]");
  EXPECT_EQ(parseModtran(one, "file")[0].geometry.h1_km, 0.5);
  EXPECT_LT(largestDifference(air(one)), 1e-6);
  EXPECT_NE(refused(with(one, "[{\"H1ALT\": 0.5, \"HRANGE\": 2}]", "[{\"HRANGE\": 2}, {\"HRANGE\": 3}]"))
                .find("2 lines of sight in one case; expected one to a case"),
            std::string::npos);
}

TEST(Modtran6, MistakesInJsonAreNamed) {
  const auto starts = [](const std::string& message, const std::string& begin) {
    EXPECT_EQ(message.rfind(begin, 0), 0u) << message << "\n  should begin with " << begin;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
  };
  const std::string whole = json();
  starts(refused(whole.substr(0, whole.size() / 2)), "file:14:5: the file is no whole JSON");
  starts(refused("{}"), "file:1:1: this JSON is no output of MODTRAN 6");
  starts(refused("{\"MODTRAN\": []}"), "file:1:1: this JSON is no output of MODTRAN 6");
  starts(refused("{\"MODTRAN\": [3]}"), "file:1:14: a case that is no map");
  starts(refused("{\"MODTRAN\": [{\"MODTRANINPUT\": {}}]}"), "file:1:14: the case has no spectra");
  starts(refused("{\"MODTRAN\": [{\"MODTRANINPUT\": 3}]}"), "file:1:14: the case has no spectra");
  starts(refused(with(whole, "\"RADIANCE\": {", "\"IRRADIANCE\": {")), "file:11:20: neither TRANSMITTANCE nor RADIANCE in SPECTRA");
  starts(refused(with(whole, "RT_THERMAL_ONLY", "RT_TRANSMITTANCE")), "file:5:33: IEMSCT is RT_TRANSMITTANCE, and the spectra are RADIANCE");
  starts(refused(with(whole, "RT_THERMAL_ONLY", "RT_LUNAR_AND_THERMAL")), "file:5:33: IEMSCT is RT_LUNAR_AND_THERMAL");
  starts(refused(with(whole, "RT_THERMAL_ONLY", "RT_SOMETHING")), "file:5:33: IEMSCT is unknown");
  starts(refused(with(whole, "\"ITYPE\": 1", "\"ITYPE\": 4")), "file:8:31: ITYPE is 4");
  starts(refused(with(whole, "\"HRANGE\": 2", "\"HRANGE\": \"2\"")), "file:8:58: HRANGE is no number");
  starts(refused(with(whole, "\"HRANGE\": 2", "\"HRANGE\": 0")), "file:3:1: the range of run 1 is not in the file");
  starts(refused(with(whole, "\"ITYPE\": 1", "\"ITYPE\": 3")), "file:3:1: run 1 is a path to space");
  starts(refused(with(whole, "\"FREQ\"", "\"WAVELENGTH\"")), "file:11:33: no wavenumbers (FREQ)");
  starts(refused(with(whole, "[2000, 2050", "[2050, 2050")), "file:12:26: the wavenumber '2050' does not rise");
  starts(refused(with(whole, "[2000, 2050", "[5, 2050")), "file:12:20: the wavenumber '5' lies beyond the spectral axis");
  starts(refused(with(whole, "[2000, 2050", "[2050")), "file:13:24: TOT_TRANS has 11 values; expected 10, as FREQ");
  starts(refused(with(whole, "[2000, 2050", "[\"2000\", 2050")), "file:12:20: '2000' in FREQ");
  starts(refused(with(whole, "\"TOT_TRANS\": [0.", "\"TOT_TRANS\": [60.")), "file:13:25: the transmittance TOT_TRANS is '60.");
  starts(refused(with(whole, "\"TOT_TRANS\": [0.", "\"TOT_TRANS\": [null, 0.")), "file:13:24: TOT_TRANS has 12 values");
  starts(refused(with(whole, "\"TOT_TRANS\": [0.", "\"TOT_TRANS\": [NaN, 0.")), "file:13:25: the file is no whole JSON");
  starts(refused(with(whole, "\"TOT_TRANS\": [0.", "\"TOT_TRANS\": [1e999, 0.")), "file:1:1: a number in this JSON is too large");
  starts(refused(with(whole, "\"THRML_EM\": [", "\"THRML_EM\": [1e300,")), "file:14:23: THRML_EM has 12 values");
  starts(refused(with(whole, "\"TOTAL_RAD\": [", "\"TOTAL_RAD\": [1e306, \"")), "file:");
  starts(refused(with(whole, "\"SURF_EMIS\": [0", "\"SURF_EMIS\": [1")), "file:18:24: TOTAL_RAD is not the sum of its parts");
  starts(refused(with(whole, "\"TOT_TRANS\"", "\"TOTAL_TRANS\"")), "file:3:11: run 1 (thermal radiance) holds no TOT_TRANS");
  // What is nested without an end costs no stack.
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  starts(refused("{\"MODTRAN\": " + deep + "}"), "file:1:1: this JSON is nested too deep");
  starts(refused(with(whole, "\"ITYPE\": 1", "\"ITYPE\": " + deep)), "file:1:1: this JSON is nested too deep");
  starts(refused(with(whole, "[2000, 2050", "[2000, [2050]")), "file:12:26: array in FREQ");
}

TEST(Modtran6, MistakesInCsvAreNamed) {
  const auto starts = [](const std::string& message, const std::string& begin) {
    EXPECT_EQ(message.rfind(begin, 0), 0u) << message << "\n  should begin with " << begin;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
  };
  const PathChoice km2{.range_m = 2000.0};
  const std::string whole = csv();
  EXPECT_EQ(refused(whole, km2), "no error");
  EXPECT_EQ(refused(with(whole, "end\n", ""), km2), "no error");
  EXPECT_EQ(refused(with(whole, "freq,total transmittance,path emission", "FREQ,TOT_TRANS,THRML_EM"), km2), "no error");
  starts(refused(whole), "file:5:1: the range of run 1 is not in the file");
  starts(refused(with(whole, "freq,", "wavelength,"), km2), "file:5:1: 'wavelength': a table over wavelength");
  starts(refused(with(whole, "cm-1,,", "microns,,"), km2), "file:6:1: 'microns': a table over wavelength");
  starts(refused(whole + whole, km2), "file:25:1: a second table");
  starts(refused(with(whole, "2050,", "2050,1,"), km2), "file:8:1: a row of 8 cells; expected 7, as line 5 has names");
  starts(refused(with(whole, "2050,", "1999,"), km2), "file:8:1: the wavenumber '1999' does not rise");
  starts(refused(with(whole, "2050,0.", "2050,60."), km2), "file:8:6: the transmittance TOT_TRANS is '60.");
  starts(refused(with(whole, "2050,0.", "2050,x0."), km2), "file:8:6: 'x0.");
  starts(refused(with(whole, "\n2050,", "\n\n2050,"), km2), "file:9:1: a line between the rows above");
  starts(refused(whole.substr(0, whole.find("2000,")), km2), "file:6:1: no rows below the names");
  starts(refused(with(whole, "total radiance", "some radiance"), km2), "file:5:11: run 1 (thermal radiance) holds no TOTAL_RAD");
}

TEST(Modtran6, PlacesInJson) {
  const std::string text = "{\"a\\\"]\": [1, {\"b\": \"x,]\\\\\"}],\n \"c\" : [[],\n  {\"d\":null , \"e\":  -2.5e3}]}";
  const auto at = [&](std::vector<std::string> way) { return placeInJson(text, "f", way).text(); };
  EXPECT_EQ(at({}), "f:1:1");
  EXPECT_EQ(at({"c"}), "f:2:8");
  EXPECT_EQ(at({"c", "0"}), "f:2:9");
  EXPECT_EQ(at({"c", "1", "e"}), "f:3:21");
  EXPECT_EQ(at({"c", "1", "none"}), "f:3:3");
  EXPECT_EQ(at({"a\\\"]", "1", "b"}), "f:1:20");
  EXPECT_EQ(at({"c", "7"}), "f:2:8");
}

}  // namespace
}  // namespace pitviper::test
