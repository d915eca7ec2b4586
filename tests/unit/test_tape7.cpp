// MODTRAN's tape7: texts written here in its fixed columns against values worked out by hand, the samples of others where they are
// present, and what must be refused.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>

#include "atmosphere/modtran_files.hpp"
#include "atmosphere/tape7.hpp"
#include "atmosphere/tape7_spectra.hpp"
#include "atmosphere/tape7_summary.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {
namespace {

/// The ten lines above the names of columns; a run at sea level over 1.5 km, or 2 to 10 km.
std::string cards(int iemsct, int itype, const std::string& letters = "T F", const std::string& card3 = "") {
  return letters + print("%2d%5d%5d%5d    6    6    6    6    6    6    1    0    0%8.3f%7s\n", 6, itype, iemsct, 0, 290.0, "0.25") +
         print("%5d%5d%5d%5d%5d%5d%10.5f%10.5f%10.5f%10.5f%10.5f\n", 1, 1, 1, 0, 0, 0, 23.0, 0.0, 0.0, 0.0, 0.0) +
         " -99.000 -99.000 -99.000\n -99.00000 -99.00000 -99.00000  1.416445  0.000736 ! H2O & O3 COLUMNS [GM/CM2]\n   36MADE FOR A TEST\n" +
         (card3.empty() ? print("%10.5f%10.5f%10.5f%10.5f%10.5f%10.5f%5d%18.5f\n", 0.0, 10.0, 30.0, 1.5, 0.25, 0.0, 0, 0.0) : card3) +
         "  -99  -99  -99  -99\n" + print("%10.5f%10.5f\n", -99.0, -99.0) + print("%10.1f%10.1f%10.1f%10.1fNW\n", 2000.0, 2500.0, 500.0, 20.0) +
         "    0   0    0.000  0    0.000  0    1.000\n";
}

const std::string kEnd = " -9999.\n";

const std::vector<std::array<std::string, 2>> kGases = {{"COMBIN", "TRANS"},  {"H2O", "TRANS"},     {"UMIX", "TRANS"},     {"O3", "TRANS"},
                                                        {"TRACE", "TRANS"},   {"N2", "CONT"},       {"H2O", "CONT"},       {"MOLEC", "SCAT"},
                                                        {"AER+CLD", "TRANS"}, {"HNO3", "TRANS"},    {"AER+CLD", "abTRNS"}, {"-LOG", "COMBIN"},
                                                        {"CO2", "TRANS"},     {"CH4-CH4", "TRANS"}, {"H2-CH4", "TRANS"}};

/// Row by row the values of kGases.
std::string transmittanceRun(const std::vector<std::pair<double, std::vector<double>>>& rows, const std::string& letters = "T F") {
  std::string upper = "    FREQ", lower = "    CM-1", text = cards(0, 1, letters);
  for (const auto& g : kGases) {
    const int width = g[0] == "-LOG" ? 8 : 7;
    upper += print("%*s", width, g[0].c_str()), lower += print("%*s", width, g[1].c_str());
  }
  text += upper + "\n" + lower + "\n";
  for (const auto& [v, values] : rows) {
    text += print("%8.2f", v);
    for (size_t i = 0; i < values.size(); ++i) text += kGases[i][0] == "-LOG" ? print("%8.3f", values[i]) : print("%7.4f", values[i]);
    text += "\n";
  }
  return text + kEnd;
}

const std::string kRadianceNames =
    "    FREQ  TOT_TRANS  PTH_THRML  THRML_SCT  SURF_EMIS   SOL_SCAT  SING_SCAT  GRND_RFLT  DRCT_RFLT  TOTAL_RAD  REF_SOL  SOL@OBS   DEPTH DIR_EM    TOA_SUN "
    "BBODY_T[K]\n";

/// NaN is a blank.
std::string radianceRow(double v, const std::vector<double>& values) {
  constexpr int width[] = {11, 11, 11, 11, 11, 11, 11, 11, 11, 9, 9, 8, 7, 11, 11};
  constexpr const char* as[] = {"%*.8f", "%*.4E", "%*.4E", "%*.4E", "%*.4E", "%*.4E", "%*.4E", "%*.4E",
                                "%*.4E", "%*.2E", "%*.2E", "%*.3f", "%*.4f", "%*.4E", "%*.3f"};
  std::string text = print("%8.2f", v);
  for (size_t i = 0; i < values.size(); ++i) {
    char field[32];
    std::snprintf(field, sizeof field, as[i], width[i], values[i]);
    text += std::isnan(values[i]) ? std::string(static_cast<size_t>(width[i]), ' ') : field;
  }
  return text + "\n";
}

constexpr double kBlank = std::numeric_limits<double>::quiet_NaN();

std::string thermalRun(const std::string& letters = "T F") {
  return cards(1, 2, letters) + kRadianceNames +
         radianceRow(2000, {0.75, 1.25e-8, kBlank, 5.0e-8, kBlank, kBlank, 2.5e-8, kBlank, 8.75e-8, kBlank, kBlank, 0.288, 1.0, kBlank, 251.5}) +
         radianceRow(2500, {0.5, 2.0e-9, kBlank, 0.0, kBlank, kBlank, 0.0, kBlank, 2.0e-9, kBlank, kBlank, 0.693, 1.0, kBlank, 233.25}) + kEnd;
}

std::string sunnyRun() {
  return cards(2, 3) + kRadianceNames +
         radianceRow(2000, {0.75, 1.25e-8, 1.0e-9, 5.0e-8, 2.5e-9, 2.0e-9, 5.0e-9, 4.0e-9, 7.0e-8, 8.0e-7, 7.5e-7, 0.288, 0.9, 1.0e-6, 251.5}) +
         radianceRow(2500, {0.5, 2.0e-9, 0.0, 0.0, 6.0e-9, 6.0e-9, 0.0, 0.0, 8.0e-9, 4.0e-7, 5.0e-7, 0.693, 0.9, 1.6e-6, 233.25}) + kEnd;
}

std::string irradianceRun() {
  const std::string gap(60, ' ');
  return cards(3, 3) + "    FREQ   TRANS     SOL TR  SOLAR\n" + print("%8.2f%8.4f%9.2E%9.2E%s%11.3E\n", 2000.0, 0.75, 7.5e-7, 1e-6, gap.c_str(), 0.2877) +
         print("%8.2f%8.4f%9.2E%9.2E%s%11.3E\n", 2500.0, 0.5, 8e-7, 1.6e-6, gap.c_str(), 0.6931) + kEnd;
}

std::vector<Tape7Run> read(const std::string& text) { return parseTape7(text, "t7"); }

std::string refused(const std::string& text) {
  try {
    read(text);
  } catch (const UserError& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "read";
}

void expectColumn(const Tape7Run& run, const char* name, Tape7Quantity quantity, double at4um, double at5um) {
  const Tape7Column* c = run.find(name);
  ASSERT_TRUE(c) << name;
  EXPECT_EQ(c->quantity, quantity) << name;
  ASSERT_EQ(c->value.size(), 2u) << name;
  EXPECT_NEAR(c->value[0], at4um, 1e-12 * std::abs(at4um)) << name;
  EXPECT_NEAR(c->value[1], at5um, 1e-12 * std::abs(at5um)) << name;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

using Q = Tape7Quantity;

TEST(Tape7, Transmittance) {
  const auto runs = read(transmittanceRun({{2000, {0.75, 0.9, 0.8, 0.97, 0.96, 0.95, 0.94, 0.93, 0.92, 0.91, 0.99, 0.288, 0.81, 0.998, 0.999}},
                                           {2500, {0.5, 0.6, 0.7, 0.87, 0.86, 0.85, 0.84, 0.83, 0.82, 0.81, 0.89, 0.693, 0.71, 0.898, 0.899}}}));
  ASSERT_EQ(runs.size(), 1u);
  const Tape7Run& r = runs[0];
  EXPECT_EQ(r.kind, Tape7Kind::Transmittance);
  ASSERT_EQ(r.wavelength_um, (std::vector<double>{4.0, 5.0}));
  expectColumn(r, "COMBIN_TRANS", Q::Transmittance, 0.5, 0.75);
  expectColumn(r, "H2O_TRANS", Q::Transmittance, 0.6, 0.9);
  expectColumn(r, "UMIX_TRANS", Q::Transmittance, 0.7, 0.8);
  expectColumn(r, "O3_TRANS", Q::Transmittance, 0.87, 0.97);
  expectColumn(r, "TRACE_TRANS", Q::Transmittance, 0.86, 0.96);
  expectColumn(r, "N2_CONT", Q::Transmittance, 0.85, 0.95);
  expectColumn(r, "H2O_CONT", Q::Transmittance, 0.84, 0.94);
  expectColumn(r, "MOLEC_SCAT", Q::Transmittance, 0.83, 0.93);
  expectColumn(r, "AER+CLD_TRANS", Q::Transmittance, 0.82, 0.92);
  expectColumn(r, "HNO3_TRANS", Q::Transmittance, 0.81, 0.91);
  expectColumn(r, "AER+CLD_abTRNS", Q::Transmittance, 0.89, 0.99);
  expectColumn(r, "-LOG_COMBIN", Q::OpticalDepth, 0.693, 0.288);
  expectColumn(r, "CO2_TRANS", Q::Transmittance, 0.71, 0.81);
  expectColumn(r, "CH4-CH4_TRANS", Q::Transmittance, 0.898, 0.998);  // its name touches its neighbours'
  expectColumn(r, "H2-CH4_TRANS", Q::Transmittance, 0.899, 0.999);
  EXPECT_EQ(r.columns.size(), kGases.size());
  // A horizontal path: H2, ANGLE and BETA are leftovers.
  EXPECT_EQ(r.geometry.path, Tape7Path::Horizontal);
  EXPECT_EQ(r.geometry.h1_km, 0.0);
  EXPECT_EQ(r.geometry.range_km, 1.5);
  EXPECT_FALSE(r.geometry.h2_km || r.geometry.zenith_deg || r.geometry.earthCentreAngle_deg || r.geometry.longPath);
  EXPECT_EQ(r.model, 6);
  EXPECT_EQ(r.title, "MADE FOR A TEST");
  EXPECT_EQ(r.haze, 1);
  EXPECT_EQ(r.visibility_km, 23.0);
  EXPECT_EQ(r.boundaryTemperature_K, 290.0);
  EXPECT_EQ(r.surface, "0.25");
  EXPECT_EQ(r.from_per_cm, 2000.0);
  EXPECT_EQ(r.to_per_cm, 2500.0);
  EXPECT_EQ(r.step_per_cm, 500.0);
  EXPECT_EQ(r.resolution_per_cm, 20.0);
  EXPECT_EQ(r.placeOf(r.columns[0], 1).line, 13);  // 5 um is the first row
  EXPECT_DOUBLE_EQ(totalTransmittance(r)(4.5), 0.625);
}

// L [W/(m2 sr um)] = L [W/(cm2 sr cm-1)] nu^2: 4e6 at 2000 cm-1, 6.25e6 at 2500 cm-1.
TEST(Tape7, ThermalRadianceWithBlanks) {
  const Tape7Run r = read(thermalRun()).at(0);
  EXPECT_EQ(r.kind, Tape7Kind::ThermalRadiance);
  expectColumn(r, "TOT_TRANS", Q::Transmittance, 0.5, 0.75);
  expectColumn(r, "PTH_THRML", Q::Radiance, 0.0125, 0.05);
  expectColumn(r, "SURF_EMIS", Q::Radiance, 0.0, 0.2);
  expectColumn(r, "GRND_RFLT", Q::Radiance, 0.0, 0.1);
  expectColumn(r, "TOTAL_RAD", Q::Radiance, 0.0125, 0.35);
  expectColumn(r, "DEPTH", Q::OpticalDepth, 0.693, 0.288);
  expectColumn(r, "DIR_EM", Q::Emissivity, 1.0, 1.0);
  expectColumn(r, "BBODY_T[K]", Q::Temperature, 233.25, 251.5);
  EXPECT_EQ(r.columns.size(), 8u);  // those blank throughout were not computed
  EXPECT_FALSE(r.find("SOL_SCAT"));
  EXPECT_EQ(r.geometry.path, Tape7Path::Slant);
  EXPECT_EQ(r.geometry.h2_km, 10.0);
  EXPECT_EQ(r.geometry.zenith_deg, 30.0);
  EXPECT_EQ(r.geometry.earthCentreAngle_deg, 0.25);
  EXPECT_EQ(r.geometry.longPath, 0);
  EXPECT_DOUBLE_EQ(pathRadiance(r)(4.0), 0.0125);
  EXPECT_DOUBLE_EQ(pathRadiance(r)(5.0), 0.05);
  EXPECT_THROW(sunAtObserver(r), UserError);
}

TEST(Tape7, RadianceWithTheSun) {
  const Tape7Run r = read(sunnyRun()).at(0);
  EXPECT_EQ(r.kind, Tape7Kind::SolarRadiance);
  EXPECT_EQ(r.geometry.path, Tape7Path::ToSpace);
  expectColumn(r, "TOT_TRANS", Q::Transmittance, 0.5, 0.75);
  expectColumn(r, "PTH_THRML", Q::Radiance, 0.0125, 0.05);
  expectColumn(r, "THRML_SCT", Q::Radiance, 0.0, 0.004);
  expectColumn(r, "SURF_EMIS", Q::Radiance, 0.0, 0.2);
  expectColumn(r, "SOL_SCAT", Q::Radiance, 0.0375, 0.01);
  expectColumn(r, "SING_SCAT", Q::Radiance, 0.0375, 0.008);
  expectColumn(r, "GRND_RFLT", Q::Radiance, 0.0, 0.02);
  expectColumn(r, "DRCT_RFLT", Q::Radiance, 0.0, 0.016);
  expectColumn(r, "TOTAL_RAD", Q::Radiance, 0.05, 0.28);
  expectColumn(r, "REF_SOL", Q::Irradiance, 2.5, 3.2);
  expectColumn(r, "SOL@OBS", Q::Irradiance, 3.125, 3.0);
  expectColumn(r, "DEPTH", Q::OpticalDepth, 0.693, 0.288);
  expectColumn(r, "DIR_EM", Q::Emissivity, 0.9, 0.9);
  expectColumn(r, "TOA_SUN", Q::Irradiance, 10.0, 4.0);
  expectColumn(r, "BBODY_T[K]", Q::Temperature, 233.25, 251.5);
  EXPECT_EQ(r.columns.size(), 15u);
  EXPECT_DOUBLE_EQ(totalTransmittance(r)(5.0), 0.75);
  EXPECT_DOUBLE_EQ(pathRadiance(r)(5.0), 0.06);  // 0.28 less 0.2 and 0.02 of the surface
  EXPECT_DOUBLE_EQ(pathRadiance(r)(4.0), 0.05);
  EXPECT_DOUBLE_EQ(sunAtObserver(r)(5.0), 3.0);
  EXPECT_DOUBLE_EQ(sunAboveAir(r)(4.0), 10.0);
  EXPECT_THROW(pathRadiance(r)(3.9), OutsideSpectrum);
}

TEST(Tape7, SolarIrradiance) {
  const Tape7Run r = read(irradianceRun()).at(0);
  EXPECT_EQ(r.kind, Tape7Kind::SolarIrradiance);
  expectColumn(r, "TRANS", Q::Transmittance, 0.5, 0.75);
  expectColumn(r, "SOL_TR", Q::Irradiance, 5.0, 3.0);
  expectColumn(r, "SOLAR", Q::Irradiance, 10.0, 4.0);
  expectColumn(r, "DEPTH", Q::OpticalDepth, 0.6931, 0.2877);
  EXPECT_DOUBLE_EQ(sunAtObserver(r)(5.0), 3.0);
  EXPECT_DOUBLE_EQ(sunAboveAir(r)(5.0), 4.0);
  EXPECT_THROW(pathRadiance(r), UserError);
}

TEST(Tape7, VariantsOfTheHeader) {
  for (const char* letters : {"T F", "M F", "F F", "MSF", "C F", "T  ", "   "}) {
    const Tape7Run r = read(thermalRun(letters)).at(0);
    EXPECT_EQ(r.bandModel, letters[0]);
    EXPECT_EQ(r.model, 6);
    EXPECT_EQ(r.kind, Tape7Kind::ThermalRadiance) << letters;
  }
  // A letter in column 6 and the word LAMBER instead of an albedo: later versions.
  EXPECT_EQ(read(replaced(replaced(thermalRun("CMF"), "CMF 6 ", "CMF 6F"), "   0.25", " LAMBER")).at(0).surface, "LAMBER");
  // RANGE touches ANGLE; RO and LENN divided after 62 columns instead of 60.
  for (const char* tail : {"   0.00000    1        0.00000\n", "  6378.39000  1        0.00000   0.00000\n"}) {
    const Tape7Run r =
        read(cards(3, 3, "T F", std::string("   2.00000 100.00000  90.936551296.08740  11.54973") + tail) + irradianceRun().substr(cards(3, 3).size())).at(0);
    EXPECT_EQ(r.geometry.zenith_deg, 90.93655);
    EXPECT_EQ(r.geometry.range_km, 1296.0874);
    EXPECT_EQ(r.geometry.longPath, 1);
  }
  // Before MODTRAN 4: no underscores, the wavenumber in seven columns.
  std::string old = cards(1, 2, "T  ") +
                    "  FREQ   TOT TRANS  PTH THRML  THRML SCT  SURF EMIS   SOL SCAT  SING SCAT  GRND RFLT  DRCT RFLT  TOTAL RAD  REF SOL  SOL@OBS   DEPTH\n";
  old += print("%6.0f.", 2000.0) + radianceRow(0, {0.75, 1.25e-8, kBlank, 0, kBlank, kBlank, 0, kBlank, 1.25e-8, kBlank, kBlank, 0.288}).substr(8) + kEnd;
  EXPECT_DOUBLE_EQ(pathRadiance(read(old).at(0))(5.0), 0.05);
  const std::string oldSun = cards(3, 3, "T  ") + "  FREQ   TRANS     SOL TR  SOLAR\n  2000.  0.7500 7.50E-07 1.00E-06\n" + kEnd;
  EXPECT_DOUBLE_EQ(sunAtObserver(read(oldSun).at(0))(5.0), 3.0);
  // MODEL 0 has a layer in the place of card 3.
  const Tape7Run layer = read(replaced(transmittanceRun({{2000, {0.75, 0.9}}}), "T F 6", "T F 0")).at(0);
  EXPECT_FALSE(layer.geometry.h1_km || layer.geometry.range_km);
  // A user's profile between the cards.
  const std::string user = replaced(thermalRun(), "   36MADE FOR A TEST\n", "   36MADE FOR A TEST\n     0.000 1.013E+03\n");
  EXPECT_EQ(read(user).at(0).geometry.range_km, 1.5);
}

TEST(Tape7, LineEndsAndRepeatedRuns) {
  std::string text = thermalRun() + sunnyRun() + "\n" + irradianceRun() + "\n\n", dos;
  for (char c : text) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& t : {text, dos, dos + "\x1a"}) {
    const auto runs = read(t);
    ASSERT_EQ(runs.size(), 3u);
    EXPECT_EQ(runs[1].kind, Tape7Kind::SolarRadiance);
    EXPECT_EQ(runs[2].number, 3);
    EXPECT_EQ(runs[2].line, 30);
    EXPECT_DOUBLE_EQ(sunAboveAir(runs[2])(4.0), 10.0);
  }
  text.erase(text.find_last_of('.') + 1);  // the last line need not be ended
  EXPECT_EQ(read(text).size(), 3u);
}

TEST(Tape7, FortranNumbers) {
  EXPECT_DOUBLE_EQ(read(replaced(irradianceRun(), "7.50E-07", "7.50D-07")).at(0).find("SOL_TR")->value[1], 3.0);
  EXPECT_EQ(read(replaced(irradianceRun(), "7.50E-07", "7.50-107")).at(0).find("SOL_TR")->value[1], 7.5e-107 * 4e6);
  EXPECT_EQ(read(replaced(irradianceRun(), "7.50E-07", "7.5E-900")).at(0).find("SOL_TR")->value[1], 0.0);
  EXPECT_DOUBLE_EQ(read(replaced(irradianceRun(), "  0.7500", "   .7500")).at(0).find("TRANS")->value[1], 0.75);
  EXPECT_DOUBLE_EQ(totalTransmittance(read(replaced(irradianceRun(), "0.7500", "1.0004")).at(0))(5.0), 1.0);
}

TEST(Tape7, DescribesARun) {
  const std::string text = describe(read(sunnyRun()).at(0));
  EXPECT_EQ(text,
            "run 1: thermal radiance and scattered sunlight (IEMSCT 2)\n"
            "  US standard 1976 air 'MADE FOR A TEST', MODTRAN bands, haze 1, visibility 23 km, boundary at 290 K\n"
            "  path to space of 1.5 km from a height of 0 km, zenith angle 30 deg\n"
            "  4 to 5 um (2000.00 to 2500.00 cm-1), 2 values, every 500 cm-1, resolution 20 cm-1\n"
            "  mean transmittance 0.625 over 4 to 5 um, all there is of 3 to 5 um\n");
}

TEST(Tape7, ABandMustBeCovered) {
  const Tape7Run r = read(sunnyRun()).at(0);
  EXPECT_NO_THROW(requireBand(r, 4.0, 5.0, "seeker"));
  try {
    requireBand(r, 3.6, 4.9, "camera 'seeker' channel 'mw'");
    FAIL();
  } catch (const UserError& e) {
    EXPECT_EQ(std::string(e.what()),
              "t7:9:1: run 1 covers 4 to 5 um, not the 3.6 to 4.9 um of camera 'seeker' channel 'mw'; expected a run over all of it; fix: run MODTRAN from "
              "V1 = 2040 to V2 = 2778 cm-1");
  }
}

TEST(Tape7, BrokenOnesAreRefused) {
  const auto starts = [](const std::string& text, const std::string& begin) {
    const std::string message = refused(text);
    EXPECT_EQ(message.rfind(begin, 0), 0u) << message << "\n  should begin with " << begin;
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
  };
  const std::string sunny = sunnyRun(), gases = transmittanceRun({{2000, {0.75, 0.9}}, {2500, {0.5, 0.6}}});
  // Empty, or cut short.
  starts("", "t7:1:1: the file is empty");
  starts("\r\n \n", "t7:1:1: the file is empty");
  starts(sunny.substr(0, sunny.find(" -9999.")), "t7:13:1: the file is cut short: run 1 has no -9999. behind its rows");
  starts(sunny.substr(0, sunny.find(" 2500.00 0.5") + 13), "t7:13:1: the file is cut short");
  starts(sunny + sunny.substr(0, sunny.find("    FREQ")), "t7:24:1: the run's header is cut: no line with the names");
  starts(sunny + sunny.substr(0, sunny.size() - 60), "t7:27:1: the file is cut short: run 2");
  starts(sunny.substr(0, sunny.find("    FREQ")), "t7:10:1: the run's header is cut: no line with the names");
  starts(replaced(sunny, " -99.000 -99.000 -99.000\n", ""), "t7:10:1: the run's header is cut: 9 lines");
  starts(sunny.substr(sunny.find("    FREQ")), "t7:1:5: not card 1 of a MODTRAN run; ");
  starts(cards(2, 3) + kRadianceNames + kEnd, "t7:12:1: run 1 has no rows");
  starts(cards(0, 1) + "    FREQ COMBIN\n", "t7:11:1: the file ends within the names");
  // Fields run together.
  starts(replaced(sunny, " 1.2500E-08", "***********"), "t7:12:20: asterisks for PTH_THRML (columns 20-30)");
  starts(replaced(gases, " 0.7500 0.9000", " 0.75000.90.00"), "t7:13:16: two decimal points in H2O_TRANS (columns 16-22)");
  starts(replaced(gases, " 0.7500 0.9000", "0.75000.9000 "), "t7:13:16: '.9000' for H2O_TRANS ends at column 20, so the columns are shifted");
  starts(replaced(gases, " 0.7500 0.9000", "0.7500 0.9000"), "t7:13:9: '0.7500' for COMBIN_TRANS ends at column 14, so the columns are shifted");
  starts(replaced(gases, " 0.7500 0.9000", "\t0.7500 0.9000"), "t7:13:9: a tab");
  starts(replaced(gases, "0.7500", "0 7500"), "t7:13:10: two things in COMBIN_TRANS");
  starts(replaced(gases, "0.7500", "0,7500"), "t7:13:10: '0,7500' is not a number for COMBIN_TRANS");
  starts(replaced(irradianceRun(), "1.00E-06   ", "1.00E-06 x "), "t7:12:36: 'x' stands outside the columns");
  starts(replaced(sunny, "251.500\n", "251.500 17\n"), "t7:12:164: '17' stands outside the columns");
  starts(replaced(sunny, "\n 2500.00", "\n\n 2500.00"), "t7:13:1: a blank line in the table");
  starts(replaced(sunny, " 0.75000000", "           "), "t7:12:9: no total transmittance (TOT_TRANS)");
  starts(replaced(sunny, " 2000.00 ", "         "), "t7:12:1: no wavenumber");
  starts(replaced(sunny, "1.2500E-08", "***********"), "t7:12:21: asterisks for PTH_THRML");  // and all behind it shifted
  // Not finite.
  starts(replaced(sunny, " 1.2500E-08", "        NaN"), "t7:12:28: 'NaN' for PTH_THRML");
  starts(replaced(sunny, " 1.2500E-08", "   Infinity"), "t7:12:23: 'Infinity' for PTH_THRML");
  starts(replaced(sunny, " 1.2500E-08", " 1.250E+908"), "t7:12:21: '1.250E+908' for PTH_THRML is too large");
  // Other units, other tables.
  starts(replaced(sunny, "0.75000000", "7.5000E+01"), "t7:12:9: the transmittance TOT_TRANS is '7.5000E+01'");
  starts(replaced(sunny, "0.75000000", "-.75000000"), "t7:12:9: the transmittance TOT_TRANS is '-.75000000'");
  starts(replaced(sunny, "    FREQ", "  WAVLEN"), "t7:11:3: a table over wavelength ('WAVLEN')");
  starts(replaced(sunny, "FREQ  TOT_TRANS", "FREQ LOS TOT_TRANS"), "t7:11:10: a column LOS: several lines of sight in one run");
  starts(replaced(gases, "    FREQ COMBIN", "    FREQ LOS  COMBIN"), "t7:11:10: a column LOS");
  starts(replaced(irradianceRun(), "FREQ", "FREQ LOS"), "t7:11:");
  starts(replaced(sunny, "\n 2500.00", "\n 2000.00"), "t7:13:1: the wavenumber '2000.00' does not rise: it stands twice, as with several lines of sight");
  starts(replaced(sunny, "    FREQ", "FREQ(CM)"), "t7:11:1: 'FREQ(CM)' heads the first column");
  starts(replaced(sunny, " 2000.00 ", " 5000.00 "), "t7:12:1: the wavenumber '5000.00' lies outside the band of the run's card 4, line 9");
  starts(replaced(sunny, "\n 2500.00", "\n 2000.00"), "t7:13:1: the wavenumber '2000.00' does not rise");
  starts(replaced(replaced(sunny, "    2000.0", "       0.0"), " 2000.00 ", "    0.00 "), "t7:12:1: the wavenumber '0.00' lies beyond the spectral axis");
  starts(replaced(gases, "    CM-1", "      NM"), "t7:12:1: the second line of column names is missing");
  starts(cards(0, 1) + kRadianceNames + sunny.substr(sunny.find(" 2000.00 ")), "t7:12:1: the second line of column names is missing");
  starts(cards(1, 2) + irradianceRun().substr(cards(3, 3).size()), "t7:11:12: no TOT_TRANS behind FREQ");
  starts(cards(3, 2) + sunny.substr(cards(2, 3).size()), "t7:11:1: not the columns of a solar irradiance run");
  starts(replaced(replaced(gases, "    FREQ COMBIN", "  FREQ TOTAL"), "    CM-1  TRANS", "  CM-1 TRANS"),
         "t7:11:7: the columns of a transmittance run are not MODTRAN 4's");
  starts("wavelength,transmittance\n4,0.5\n", "t7:1:1: not card 1 of a MODTRAN run");
  starts(replaced(sunny, "    3    2    0", "    3    4    0"), "t7:1:11: IEMSCT is 4");
  starts(replaced(sunny, "    3    2    0", "    3    9    0"), "t7:1:11: IEMSCT of card 1");
  starts(replaced(sunny, "    3    2    0", "    7    2    0"), "t7:1:6: ITYPE of card 1");
  starts(replaced(sunny, "    3    2    0", "    3         0"), "t7:1:11: no IEMSCT");
  starts(replaced(sunny, "    2000.0    2500.0", "    2500.0    2000.0"), "t7:9:1: card 4 does not hold a band");
  starts(replaced(sunny, "    2000.0    2500.0", "              2500.0"), "t7:9:1: no V1 of card 4");
  // Binary.
  starts(replaced(sunny, "T F 6", "T T 6"), "t7:1:3: the run's BINARY flag is set");
  starts(std::string("\x10\0\0\0T F", 7), "t7:1:1: byte 16 is not text");
  // Behind the last run.
  starts(sunny + "the end\n", "t7:15:1: not card 1 of a MODTRAN run");
}

TEST(Tape7, SpectraRefuseWhatDoesNotAddUp) {
  EXPECT_THROW(pathRadiance(read(replaced(sunnyRun(), "7.0000E-08", "9.0000E-08")).at(0)), UserError);
  // Radiances that somebody turned into W/(cm2 um): nu^2 / 1e4 = 400 times as large at 2000 1/cm.
  try {
    pathRadiance(read(replaced(replaced(sunnyRun(), "1.2500E-08", "5.0000E-06"), "7.0000E-08", "2.8000E-05")).at(0));
    FAIL();
  } catch (const UserError& e) {
    EXPECT_EQ(std::string(e.what()).rfind("t7:12:97: TOTAL_RAD is ", 0), 0u) << e.what();
    EXPECT_NE(std::string(e.what()).find("BBODY_T, 251.5 K, sends: its unit is another"), std::string::npos) << e.what();
  }
  EXPECT_THROW(pathRadiance(read(replaced(sunnyRun(), " 2.5000E-09", "           ")).at(0)), UserError);
  EXPECT_NO_THROW(pathRadiance(read(replaced(sunnyRun(), "    251.500", "           ")).at(0)));  // blank, but not asked for
  try {
    sunAtObserver(read(replaced(sunnyRun(), " 7.50E-07", "         ")).at(0));
    FAIL();
  } catch (const UserError& e) {
    EXPECT_EQ(std::string(e.what()).rfind("t7:12:117: SOL@OBS is blank here and not in other rows", 0), 0u) << e.what();
  }
  EXPECT_THROW(readModtran("no such file"), UserError);
  EXPECT_THROW(readModtran("/"), UserError);
}

// 2000 damaged texts: read, or refused in one line.
TEST(Tape7, DamagedOnesAreReadOrRefused) {
  const std::vector<std::string> corpus = {thermalRun() + irradianceRun(), sunnyRun(), transmittanceRun({{2000, {0.75, 0.9}}, {2500, {0.5, 0.6}}})};
  std::mt19937 random(7);
  const auto below = [&](size_t n) { return static_cast<size_t>(random() % std::max<size_t>(n, 1)); };
  int refusals = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = corpus[below(corpus.size())];
    for (size_t k = 1 + below(3); k > 0; --k) {
      const size_t at = below(text.size()), length = below(60);
      switch (below(7)) {
        case 0:
          text.erase(at, length);
          break;
        case 1:
          text.insert(at, std::string(length, ' '));
          break;
        case 2:
          text.resize(at);
          break;
        case 3:
          text.insert(at, text.substr(below(text.size()), length));
          break;
        case 4:
          text.insert(at, "\n");
          break;
        case 5:
          if (!text.empty()) text[at] = static_cast<char>(random());
          break;
        default:
          if (!text.empty()) text[at] = "0123456789.-+EDTF*\r\n "[below(21)];
          break;
      }
    }
    try {
      for (const Tape7Run& r : read(text)) {
        ASSERT_FALSE(r.wavelength_um.empty());
        ASSERT_FALSE(describe(r).empty());
        for (const auto& spectrum : {totalTransmittance, pathRadiance, sunAtObserver, sunAboveAir}) {
          try {
            spectrum(r);
          } catch (const UserError&) {
          }
        }
      }
    } catch (const UserError& e) {
      ++refusals;
      ASSERT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      ASSERT_EQ(std::string(e.what()).rfind("t7:", 0), 0u) << e.what();
    }
  }
  EXPECT_GT(refusals, 500);
  EXPECT_LT(refusals, 2000);
}

/// Folder of the samples: PITVIPER_TAPE7, or beside the repository; "" where absent.
std::filesystem::path samples() {
  if (const char* folder = std::getenv("PITVIPER_TAPE7")) return folder;
  const auto folder = std::filesystem::path(PITVIPER_SOURCE_DIR) / ".." / "shared" / "data" / "tape7";
  return std::filesystem::exists(folder) ? folder : std::filesystem::path();
}

struct Sample {
  const char* name;
  Tape7Kind kind;
  size_t values, columns;
  double from_um, to_um;
  double meanTransmittance;  ///< over wavelength, trapezoids
  double h1_km, range_km;
};

// Counted, sliced and summed from the files by a script of its own.
const Sample kSamples[] = {
    {"tape7-01", Tape7Kind::Transmittance, 51, 35, 1e4 / 2100, 1e4 / 2050, 0.7033000770664768, 2.0, 2.0},
    {"tape7-01b", Tape7Kind::Transmittance, 20, 39, 1e4 / 750, 1e4 / 655, 0.0393199216657125, 0.0, 1.0},
    {"tape7-02b", Tape7Kind::ThermalRadiance, 51, 8, 1e4 / 2100, 1e4 / 2050, 0.6438820222443719, 2.0, 9.2359},
    {"tape7-03", Tape7Kind::SolarRadiance, 51, 15, 1e4 / 2100, 1e4 / 2050, 0.6438820222443719, 2.0, 9.2359},
    {"tape7-04", Tape7Kind::SolarIrradiance, 101, 4, 1e4 / 2150, 1e4 / 2050, 2.4153794137445515e-05, 2.0, 1296.0874},
    {"tape7-05", Tape7Kind::SolarRadiance, 51, 15, 1e4 / 2100, 1e4 / 2050, 0.43884382954537027, 0.0, 106.31252},
    {"tape7.LWIRSun", Tape7Kind::SolarRadiance, 418, 15, 8.0, 1e4 / 833, 0.47392974537671995, 0.0, 100.0},
};

Tape7Run sample(const char* name) { return readModtran(samples() / name).at(0); }

TEST(Tape7, Samples) {
  if (samples().empty()) GTEST_SKIP() << "no MODTRAN samples: set PITVIPER_TAPE7 to a folder that holds them";
  for (const Sample& s : kSamples) {
    SCOPED_TRACE(s.name);
    const auto runs = readModtran(samples() / s.name);
    ASSERT_EQ(runs.size(), 1u);
    const Tape7Run& r = runs[0];
    EXPECT_EQ(r.kind, s.kind);
    EXPECT_EQ(r.wavelength_um.size(), s.values);
    EXPECT_EQ(r.columns.size(), s.columns);
    for (const auto& c : r.columns) {
      EXPECT_EQ(c.gapLine, 0) << c.name;
      EXPECT_NE(c.quantity, Q::Unknown) << c.name;
    }
    EXPECT_DOUBLE_EQ(r.wavelength_um.front(), s.from_um);
    EXPECT_DOUBLE_EQ(r.wavelength_um.back(), s.to_um);
    const double mean = totalTransmittance(r).integral(s.from_um, s.to_um) / (s.to_um - s.from_um);
    EXPECT_NEAR(mean / s.meanTransmittance, 1.0, 1e-9);
    EXPECT_EQ(r.geometry.h1_km, s.h1_km);
    EXPECT_EQ(r.geometry.range_km, s.range_km);
    std::printf("%s: %s", s.name, describe(r).c_str());
  }
}

TEST(Tape7, SamplesHoldTheirOwnLaws) {
  if (samples().empty()) GTEST_SKIP() << "no MODTRAN samples: set PITVIPER_TAPE7 to a folder that holds them";
  // The parts' product is the whole, to their rounding; optical depth is the logarithm.
  const Tape7Run gases = sample("tape7-01");
  for (size_t i = 0; i < gases.wavelength_um.size(); ++i) {
    double product = 1.0;
    for (const char* part : {"H2O_TRANS", "UMIX_TRANS", "O3_TRANS", "TRACE_TRANS", "N2_CONT", "H2O_CONT", "MOLEC_SCAT", "AER+CLD_TRANS", "HNO3_TRANS"})
      product *= gases.find(part)->value[i];
    EXPECT_NEAR(product, gases.find("COMBIN_TRANS")->value[i], 0.01);  // products of band averages: approximate
    EXPECT_NEAR(std::exp(-gases.find("-LOG_COMBIN")->value[i]), gases.find("COMBIN_TRANS")->value[i], 6e-4);
  }
  for (const char* name : {"tape7-02b", "tape7-03", "tape7-05", "tape7.LWIRSun"}) {
    const Tape7Run r = sample(name);
    const Spectrum path = pathRadiance(r);
    double worstT = 0.0;
    for (size_t i = 0; i < r.wavelength_um.size(); ++i) {
      const double w = r.wavelength_um[i], total = r.find("TOTAL_RAD")->value[i];
      EXPECT_NEAR(path(w) + r.find("SURF_EMIS")->value[i] + r.find("GRND_RFLT")->value[i], total, 7e-5 * total) << name;
      EXPECT_NEAR(std::exp(-r.find("DEPTH")->value[i]), r.find("TOT_TRANS")->value[i], 6e-4) << name;
      // The brightness temperature says that the conversion to W/(m2 sr um) is right: Planck's law at it is the radiance.
      const double b = physics::planckRadiance(w, r.find("BBODY_T[K]")->value[i]);
      worstT = std::max(worstT, std::abs(b / total - 1.0));
    }
    EXPECT_LT(worstT, 3e-3) << name;  // 0.02 K at 220 K and 5 um is 0.1 %, radiance has five digits
  }
  const Tape7Run sun = sample("tape7-04");
  EXPECT_DOUBLE_EQ(sunAboveAir(sun)(1e4 / 2050), 9.63e-7 * 2050 * 2050);
  EXPECT_NEAR(sunAboveAir(sun)(1e4 / 2050), 4.05, 0.01);  // a sun of 5800 K at 4.9 um
  EXPECT_EQ(sun.geometry.longPath, 1);
  EXPECT_EQ(sun.geometry.zenith_deg, 90.93655);
  // Checkpoints sliced from the files by a script: the path alone, at both ends.
  EXPECT_NEAR(pathRadiance(sample("tape7-03"))(1e4 / 2050), 0.0677999411, 1e-10);
  EXPECT_NEAR(pathRadiance(sample("tape7-03"))(1e4 / 2100), 0.1905927912, 1e-10);
  EXPECT_NEAR(pathRadiance(sample("tape7.LWIRSun"))(1e4 / 833), 4.603430898621871, 1e-9);
  EXPECT_NEAR(pathRadiance(sample("tape7.LWIRSun"))(8.0), 5.5406281250000005, 1e-9);
  EXPECT_NEAR(sample("tape7-03").find("TOTAL_RAD")->value.back(), 2.11495015, 1e-9);
  EXPECT_EQ(sample("tape7-03").boundaryTemperature_K, 300.0);
  EXPECT_EQ(sample("tape7-01b").surface, "0.30000");
}

}  // namespace
}  // namespace pitviper::test
