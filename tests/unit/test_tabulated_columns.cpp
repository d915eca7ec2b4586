// Air from columns of numbers between blanks: LBLRTM's and libRadtran's layouts as documented, or named by the user; a known air comes back from each, and
// what must be refused. The files are written here; none of either program was at hand.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "atmosphere/tabulated_columns.hpp"
#include "atmosphere/tabulated_csv.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {
namespace {

constexpr double kRange_km = 2.0;

double tauOf(double um, double km = kRange_km) { return std::exp(-0.05 * um * km); }
double sourceOf(double um) { return 0.3 * um; }
double sentOf(double um, double km = kRange_km) { return sourceOf(um) * (1.0 - tauOf(um, km)); }
/// W/(m2 sr um) to W/(m2 sr cm-1).
double perWavenumber(double um) { return sentOf(um) * um * um * 1e-4; }

using Of = std::function<double(double um)>;

/// Rows over wavenumber (2000 to 2500 1/cm, as LBLRTM writes them) or over wavelength in nm.
std::string overWavenumber(const Of& y) {
  std::string text;
  for (int v = 2000; v <= 2500; v += 50) text += print("%14.6f%16.8E\n", 1.0 * v, y(1e4 / v));
  return text;
}
std::string overWavelength(const std::vector<Of>& columns) {
  std::string text;
  for (int nm = 4000; nm <= 5000; nm += 100) {
    text += print(" %d.000", nm);
    for (const Of& y : columns) text += print("  %.8e", y(1e-3 * nm));
    text += "\n";
  }
  return text;
}

std::string lblrtm(const std::string& what, const Of& y) {
  return "1\n LBLRTM                                      11/28/26  19:00:00\n\n0 INITIAL LAYER =    1   FINAL LAYER =    1\n0 V1 =  2000.000000 CM-1\n\n"
         "0     WAVENUMBER        " +
         what + "\n\n" + overWavenumber(y);
}
std::string tape28() {
  return lblrtm("TRANSMISSION", [](double um) { return tauOf(um); });
}
std::string tape27() {
  return lblrtm("RADIANCE", [](double um) { return 1e-4 * perWavenumber(um); });
}

/// uvspec's input behind '#', then its output.
std::string uvspec(const std::string& input, const std::vector<Of>& columns) { return input + overWavelength(columns); }
const std::string kSunny =
    "# atmosphere_file slab.dat\n# source solar kurudz\n#  sza 60 # degrees\n# output_quantity transmittance\n# output_user lambda zout edir eglo\n";
std::string sunny() {
  return uvspec(kSunny, {[](double) { return 0.0; }, [](double um) { return 0.5 * tauOf(um); }, [](double) { return 0.7; }});
}
std::string thermal(const std::string& process = "", double scale = 1.0) {
  return uvspec("# source thermal\n" + process + "# output_user wavenumber lambda uu\n",
                {[](double um) { return um; }, [=](double um) { return scale * perWavenumber(um); }});
}

TabulatedAir air(const std::string& text, const ColumnsWanted& wanted = {.range_m = 1e3 * kRange_km}, const std::string& radiance = "") {
  return parseAirColumns({text, "a"}, wanted, radiance.empty() ? std::nullopt : std::optional(ColumnText{radiance, "b"}));
}

ColumnsWanted named(const std::string& names, std::optional<double> range_m = 1e3 * kRange_km) { return {names, {"case.yaml", 3, 20, -1}, range_m}; }

std::string refused(const std::string& text, const ColumnsWanted& wanted = {.range_m = 1e3 * kRange_km}, const std::string& radiance = "") {
  try {
    air(text, wanted, radiance);
  } catch (const UserError& e) {
    return e.what();
  }
  return "no error";
}

/// Transmittance at any range, path radiance relative to the known one.
double largestDifference(const TabulatedAir& a) {
  double most = 0.0;
  for (double um : a.knots_um())
    for (double km : {0.1, 2.0, 20.0}) {
      most = std::max(most, std::abs(a.transmittance(um, 1e3 * km) - tauOf(um, km)));
      if (a.emits()) most = std::max(most, std::abs(a.pathRadiance(um, 1e3 * km) / sentOf(um, km) - 1.0));
    }
  return most;
}

TEST(AirColumns, AKnownAirComesBackFromEachProgram) {
  const TabulatedAir lbl = air(tape28(), {.range_m = 2000.0}, tape27());
  EXPECT_TRUE(lbl.emits());
  EXPECT_LT(largestDifference(lbl), 1e-6);
  EXPECT_FALSE(air(tape28()).emits());
  EXPECT_LT(largestDifference(air(tape28())), 1e-6);
  EXPECT_LT(largestDifference(air(lblrtm("OPTICAL DEPTH", [](double um) { return -std::log(tauOf(um)); }))), 1e-6);
  EXPECT_LT(largestDifference(air(sunny())), 1e-6);  // the cosine of 60 deg divided out
  EXPECT_FALSE(air(sunny()).emits());
  const std::string emission = "# source thermal\n# output_user lambda uu\n";
  const TabulatedAir both = air(sunny(), {.range_m = 2000.0}, uvspec(emission, {perWavenumber}));
  EXPECT_LT(largestDifference(both), 1e-6);
  const std::string perNm = "# source thermal\n# output_process per_nm\n# output_user lambda uu\n";
  EXPECT_LT(largestDifference(air(sunny(), {.range_m = 2000.0}, uvspec(perNm, {[](double um) { return 1e-3 * sentOf(um); }}))), 1e-6);
  // Columns that the user names, some left out, others in front of the rows.
  const std::string bare =
      "made by hand\n\n" + overWavelength({[](double) { return 7.0; }, [](double um) { return tauOf(um); }, [](double um) { return sentOf(um); }});
  EXPECT_LT(largestDifference(air(bare, named("wavelength_nm, -, transmittance, path_radiance_W/(m2 sr um)"))), 1e-6);
  EXPECT_LT(largestDifference(air(bare, named("wavelength_nm, -, transmittance_2km, path_radiance_2km_W/(m2 sr um)", {}))), 1e-6);
  EXPECT_LT(largestDifference(air(tape28(), named("wavenumber_1/cm, transmittance"))), 1e-6);
  EXPECT_LT(largestDifference(air(overWavelength({[](double um) { return 0.05 * um; }}), named("wavelength_nm, extinction_1/km", {}))), 1e-6);
  std::printf("largest difference: LBLRTM %.1e, uvspec %.1e\n", largestDifference(lbl), largestDifference(both));
}

// The same air as CSV and as columns: the same numbers.
TEST(AirColumns, AsCsvSaysIt) {
  std::string table = "wavelength_nm,transmittance_2km,path_radiance_2km_W/(m2 sr cm-1)\n";
  const std::string rows = overWavelength({[](double um) { return tauOf(um); }, perWavenumber});
  std::string commas;
  for (size_t i = 0; i < rows.size(); ++i)
    if (rows[i] != ' ') commas += rows[i];
    else if (i > 0 && rows[i - 1] != ' ' && rows[i - 1] != '\n') commas += ',';
  std::istringstream in(table + commas);
  const TabulatedAir csv = readAirCsv(in, "a.csv"), columns = air(rows, named("wavelength_nm, transmittance, path_radiance_W/(m2 sr cm-1)"));
  for (double um : csv.knots_um()) {
    EXPECT_EQ(csv.coefficients(um)[0], columns.coefficients(um)[0]);
    EXPECT_EQ(csv.sourceRadiance(um), columns.sourceRadiance(um));
  }
  EXPECT_LT(largestDifference(csv), 1e-6);
}

TEST(AirColumns, AreKnownByTheirHeader) {
  EXPECT_TRUE(isAirColumns(tape28()));
  EXPECT_TRUE(isAirColumns(sunny()));
  EXPECT_FALSE(isAirColumns(overWavelength({perWavenumber})));
  EXPECT_FALSE(isAirColumns("wavelength_um,extinction_1/km\n4,1\n5,1\n"));
  EXPECT_FALSE(isAirColumns(""));
}

TEST(AirColumns, MistakesAreNamed) {
  const auto starts = [](const std::string& message, const std::string& begin) {
    EXPECT_EQ(message.rfind(begin, 0), 0u) << message << "\n  should begin with " << begin;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
  };
  const auto with = [](std::string text, const std::string& what, const std::string& instead) {
    const size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
  };
  const std::string bare = overWavelength({[](double um) { return tauOf(um); }});
  starts(refused(bare), "a:1:1: nothing says what the columns hold");
  starts(refused(""), "a:1:1: nothing says what the columns hold");
  starts(refused(tape28(), {}), "a:7:1: the file does not say over which range its columns hold");
  starts(refused(bare, named("wavelength_nm, transmittance", {})), "case.yaml:3:20: the file does not say over which range its columns hold");
  starts(refused(bare, named("wavelength_nm, extinction_1/km")), "case.yaml:3:20: a range is given for columns that need none");
  starts(refused(bare, named("wavelength_nm, transparency")), "case.yaml:3:35: unknown column 'transparency'");
  starts(refused(bare, named("wavelength, transmittance")), "case.yaml:3:20: 'wavelength' has no unit");
  starts(refused(bare, named("transmittance, -")), "case.yaml:3:20: no column of wavelengths");
  starts(refused(bare, named("wavelength_nm, path_radiance_W/(m2 sr um)")), "case.yaml:3:20: no transmittance and no extinction");
  starts(refused(bare, named("wavelength_nm, transmittance, -")), "a:1:1: a row of other numbers than its columns; expected 3 numbers");
  starts(refused("nothing\n", named("wavelength_nm, transmittance")), "a:1:1: no rows of numbers; expected 2 numbers");
  starts(refused(with(bare, "4500.000", "4500.000 1"), named("wavelength_nm, transmittance")),
         "a:6:14: a row of 3 cells; expected 2, as many as there are names");
  starts(refused(with(bare, "4500.000", "3500.000"), named("wavelength_nm, transmittance")), "a:6:2: wavelength_nm does not rise");
  starts(refused(bare + "end of the table\n", named("wavelength_nm, transmittance")), "a:12:");
  starts(refused(lblrtm("BRIGHTNESS", [](double) { return 300.0; })), "a:7:25: 'BRIGHTNESS' in a file of LBLRTM's");
  starts(refused(lblrtm("", [](double) { return 0.5; })), "a:7:7: LBLRTM's header does not say what stands beside the wavenumber");
  starts(refused(with(tape28(), "   2000.000000", "   ***********")), "a:9:4: '***********' for WAVENUMBER is not a number");
  starts(refused(with(bare, "4000.000", "********"), named("wavelength_nm, transmittance")), "a:1:2: '********' for wavelength_nm is not a number");
  starts(refused(with(tape28(), "  2050.000000", "  2050.00.000")), "a:10:4: '2050.00.000' for WAVENUMBER is not a number");
  starts(refused(lblrtm("TRANSMISSION", [](double) { return 50.0; })), "a:9:17: '5.00000000E+01' for TRANSMISSION is out of range");
  starts(refused(with(sunny(), "output_quantity transmittance", "output_quantity brightness")), "a:5:32: none of these outputs of uvspec is air along a path");
  starts(refused(with(sunny(), "# output_quantity transmittance\n", "")), "a:4:32: none of these outputs of uvspec is air along a path");
  starts(refused(with(sunny(), " eglo", " elgo")), "a:5:32: an unknown output of uvspec, 'elgo'");
  starts(refused(with(sunny(), "sza 60", "sza 95")), "a:3:8: '95' for the sun's zenith angle");
  starts(refused(with(sunny(), "sza 60", "sza 80")), "a:");
  starts(refused(with(sunny(), "lambda zout", "lambda")), "a:6:44: a row of 4 cells; expected 3, as line 5 has names");
  starts(refused(thermal()), "a:2:1: no transmittance and no extinction");
  starts(refused(thermal("# output_process integrate\n")), "a:2:18: 'integrate' is no spectrum");
  starts(refused(tape28(), {.range_m = 2000.0}, tape28()), "b:7:1: no header says that this is a path radiance");
  starts(refused(tape28(), {.range_m = 2000.0}, bare), "b:1:1: no header says that this is a path radiance");
  starts(refused(tape27()), "a:7:1: no transmittance and no extinction");
  starts(refused(tape28(), {.range_m = 2000.0}, with(tape27(), "  2050.000000", "  2051.000000")),
         "b:10:1: the wavelengths of the path radiance are not those of a");
  starts(refused(tape28(), {.range_m = 2000.0}, tape27() + "  2550.0 1e-8\n"), "b:20:1: the wavelengths of the path radiance are not those of a");
  starts(refused(tape28(), named("wavenumber_1/cm, transmittance_1km", {}), tape27()), "b:7:1: the file does not say over which range");
}

}  // namespace
}  // namespace pitviper::test
