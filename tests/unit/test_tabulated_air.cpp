// Air by tables: the fit over ranges against closed forms and LOWTRAN 7, the class, and comma-separated files right and wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "atmosphere/depth_fit.hpp"
#include "atmosphere/tabulated_air.hpp"
#include "atmosphere/tabulated_csv.hpp"
#include "sim/parameters/error.hpp"
#include "sim/plan/fine_grid.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

TabulatedAir read(const std::string& text) {
  std::istringstream in(text);
  return readAirCsv(in, "a.csv");
}

std::string refused(const std::string& text) {
  try {
    read(text);
  } catch (const UserError& e) {
    return e.what();
  }
  return "no error";
}

// ---- The fit -----------------------------------------------------------------------------------------------------------------------------

const std::vector<double> kPowers = {0.55, 0.75, 1.0};

std::vector<RangeDepth> rowsOf(const std::vector<double>& c, const std::vector<double>& ranges) {
  std::vector<RangeDepth> rows;
  for (double r : ranges) {
    double depth = 0.0;
    for (size_t k = 0; k < c.size(); ++k) depth += c[k] * std::pow(r, kPowers[k]);
    rows.push_back({r, std::exp(-depth), depth});
  }
  return rows;
}

TEST(DepthFit, FindsWhatIsThere) {
  for (const auto& c : std::vector<std::vector<double>>{{0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}, {0.4, 0, 0.05}, {0.1, 0.2, 0.03}, {0, 0, 0}}) {
    const DepthFit fit = fitDepth(rowsOf(c, {0.1, 0.5, 1, 2, 5, 10, 20}), kPowers, 1e-6);
    EXPECT_LT(fit.largest, 1e-12);
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(fit.coefficients[k], c[k], 1e-9);  // condition of the powers times rounding
  }
}

TEST(DepthFit, NothingIsNegative) {
  // Steeper than any power allowed: Beer's law is nearest. Flatter than any: the least power.
  std::vector<RangeDepth> steep, flat;
  for (double r : {0.5, 1.0, 2.0, 4.0}) {
    steep.push_back({r, std::exp(-0.1 * r * r), 0.1 * r * r});
    flat.push_back({r, std::exp(-0.3 * std::pow(r, 0.2)), 0.3 * std::pow(r, 0.2)});
  }
  const auto a = fitDepth(steep, kPowers, 1e-6).coefficients, b = fitDepth(flat, kPowers, 1e-6).coefficients;
  EXPECT_EQ(a[0], 0.0);
  EXPECT_EQ(a[1], 0.0);
  EXPECT_GT(a[2], 0.0);
  EXPECT_GT(b[0], 0.0);
  EXPECT_EQ(b[1], 0.0);
  EXPECT_EQ(b[2], 0.0);
}

TEST(DepthFit, IsTheBestNonNegativeOne) {
  // Against a search: no nearby non-negative coefficients are better.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<RangeDepth> rows;
    double depth = 0.0;
    for (double r : {0.2, 1.0, 3.0, 8.0}) {
      depth += unit(random);
      rows.push_back({r, std::exp(-depth), depth});
    }
    const auto cost = [&](const std::vector<double>& c) {
      double sum = 0.0;
      for (const auto& row : rows) {
        double d = 0.0;
        for (size_t k = 0; k < 3; ++k) d += c[k] * std::pow(row.range_km, kPowers[k]);
        sum += row.transmittance * row.transmittance * (d - row.depth) * (d - row.depth);
      }
      return sum;
    };
    const auto best = fitDepth(rows, kPowers, 1e-9).coefficients;
    for (int step = 0; step < 50; ++step) {
      auto other = best;
      for (double& c : other) c = std::max(0.0, c + 0.02 * (unit(random) - 0.5));
      EXPECT_GE(cost(other), cost(best) - 1e-12);
    }
  }
}

TEST(DepthFit, FewOrOpaqueRows) {
  // One row: Beer's law.
  const std::vector<RangeDepth> one = {{2.0, std::exp(-0.4), 0.4}};
  EXPECT_EQ(fitDepth(one, kPowers, 1e-6).coefficients, (std::vector<double>{0.0, 0.0, 0.2}));
  // Opaque ones say nothing beside one that is not ...
  const std::vector<RangeDepth> mixed = {{0.1, 0.2, -std::log(0.2)}, {1.0, 0.0, 20.0}};
  EXPECT_LT(fitDepth(mixed, kPowers, 1e-6).largest, 1e-6);
  EXPECT_NEAR(fitDepth(mixed, kPowers, 1e-6).coefficients[2], -10.0 * std::log(0.2), 1e-9);
  // ... and alone that the shortest is opaque.
  const std::vector<RangeDepth> opaque = {{5.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  EXPECT_NEAR(fitDepth(opaque, kPowers, 1e-6).coefficients[2], -std::log(0.5e-6) / 2.0, 1e-12);
  EXPECT_EQ(fitDepth({}, kPowers, 1e-6).coefficients, (std::vector<double>{0.0, 0.0, 0.0}));
}

TEST(DepthFit, SourceComesBack) {
  const std::vector<std::vector<double>> depth = {{0.5}, {0.0}, {2.0}, {0.0}};
  const std::vector<double> powers = {1.0};
  const auto radiance = [&](double range, double j) {
    std::vector<double> all;
    for (const auto& d : depth) all.push_back(-j * std::expm1(-d[0] * range));
    return all;
  };
  double difference = -1.0;
  const auto source = fitSource(depth, powers, std::vector<RangeRadiance>{{1.0, radiance(1.0, 3.0)}, {2.0, radiance(2.0, 3.0)}}, difference);
  // Where nothing is seen the neighbour's.
  for (double j : source) EXPECT_NEAR(j, 3.0, 1e-12);
  EXPECT_LT(difference, 1e-12);
  EXPECT_TRUE(fitSource(depth, powers, {}, difference).empty());
  // Two that disagree: between them, and it is said by how much.
  const auto between = fitSource(depth, powers, std::vector<RangeRadiance>{{1.0, radiance(1.0, 3.0)}, {2.0, radiance(2.0, 4.0)}}, difference);
  EXPECT_GT(between[0], 3.0);
  EXPECT_LT(between[0], 4.0);
  EXPECT_GT(difference, 0.05);
}

// ---- LOWTRAN's own ranges --------------------------------------------------------------------------------------------------------------

TEST(TabulatedAir, RangesOfLowtranAreHeld) {
  const char* named = std::getenv("PITVIPER_REFERENCE_DATA");
  const auto file = (named ? fs::path(named) : fs::path(PITVIPER_SOURCE_DIR) / "../shared/data") / "lowtran7/horiz_tau_us76_rural23.csv";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file << "; the reference tables are no part of the project";
  std::ifstream in(file);
  // Columns: wavenumber, wavelength, then 0.1 0.5 1 2 5 10 20 km; wavenumbers rise.
  std::string all =
      "wavenumber_1/cm,transmittance_0.1km,transmittance_0.5km,transmittance_1km,transmittance_2km,transmittance_5km,transmittance_10km,transmittance_20km\n";
  std::string some = "wavenumber_1/cm,transmittance_0.5km,transmittance_2km,transmittance_10km\n", single = "wavenumber_1/cm,transmittance_2km\n";
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] < '0' || line[0] > '9') continue;
    std::vector<std::string> cells;
    std::istringstream split(line);
    for (std::string cell; std::getline(split, cell, ',');) cells.push_back(cell);
    all += cells[0];
    for (size_t i = 2; i < 9; ++i) all += "," + cells[i];
    all += "\n";
    some += cells[0] + "," + cells[3] + "," + cells[5] + "," + cells[7] + "\n";
    single += cells[0] + "," + cells[5] + "\n";
    rows.push_back({std::stod(cells[0]), std::stod(cells[6]), std::stod(cells[8])});
  }
  const TabulatedAir seven = read(all), three = read(some), one = read(single);
  bound("table of air, fit of seven ranges of LOWTRAN 7, difference of transmittance", seven.fit().largest, 2e-3, "three powers");
  // Ranges it was not made of: 5 and 20 km.
  const auto worst = [&](const TabulatedAir& air, size_t column, double range_m, double low, double high, double& mean) {
    double most = 0.0, a = 0.0, b = 0.0;
    for (const auto& row : rows) {
      const double um = 1e4 / row[0], tau = air.transmittance(um, range_m);
      most = std::max(most, std::abs(tau - row[column]));
      if (um >= low && um <= high) a += um * um * tau, b += um * um * row[column];
    }
    mean = std::abs(a / b - 1.0);
    return most;
  };
  double mean = 0.0;
  bound("the same from 0.5, 2 and 10 km, at 5 km", worst(three, 1, 5000.0, 3, 5, mean), 2e-3, "three powers");
  bound("the same, mean of 3-5 um, relative", mean, 1e-3, "three powers");
  const double exponential = worst(one, 1, 5000.0, 3, 5, mean);
  std::printf("one exponential from 2 km, at 5 km: difference of transmittance %.3f, mean of 3-5 um %.1f %%\n", exponential, 100 * mean);
  EXPECT_GT(exponential, 0.05);  // what the description warns of
}

// ---- The class ----------------------------------------------------------------------------------------------------------------------------

TEST(TabulatedAir, ValuesByHand) {
  const TabulatedAir air = read("wavelength_um,extinction_1/km,source_radiance_W/(m2 sr um)\n4,0.2,1\n5,0.4,3\n");
  EXPECT_EQ(air.exponents().size(), 1u);
  EXPECT_DOUBLE_EQ(air.coefficients(4.5)[0], 0.3);
  EXPECT_DOUBLE_EQ(air.sourceRadiance(4.5), 2.0);
  EXPECT_DOUBLE_EQ(air.transmittance(4.5, 2000.0), std::exp(-0.6));
  EXPECT_DOUBLE_EQ(air.pathRadiance(4.5, 2000.0), 2.0 * (1.0 - std::exp(-0.6)));
  EXPECT_EQ(air.transmittance(4.5, 0.0), 1.0);
  EXPECT_THROW(air.coefficients(3.99), OutsideSpectrum);
  EXPECT_THROW(air.sourceRadiance(5.01), OutsideSpectrum);
  EXPECT_FALSE(air.sky());
  EXPECT_THROW(TabulatedAir(TabulatedAir::Data{}), std::invalid_argument);
}

TEST(TabulatedAir, SkyByElevation) {
  const double up = kPi / 2, low = kPi / 6;
  const TabulatedSky sky({4, 5}, {{low, {3, 5}}, {up, {1, 2}}});
  EXPECT_DOUBLE_EQ(sky.radiance(4.0, up), 1.0);
  EXPECT_DOUBLE_EQ(sky.radiance(4.5, low), 4.0);
  // Air mass 1.5 lies at 41.8 degrees, half way from 1 to 2.
  EXPECT_NEAR(sky.radiance(4.0, 41.8 * kPi / 180.0), 2.0, 0.005);
  EXPECT_DOUBLE_EQ(sky.radiance(4.0, 0.0), 3.0);
  EXPECT_THROW(sky.radiance(6.0, 1.0), OutsideSpectrum);
  EXPECT_DOUBLE_EQ(TabulatedSky({4, 5}, {{0.7, {3, 5}}}).radiance(5.0, 0.1), 5.0);
  EXPECT_THROW(TabulatedSky({4, 5}, {}), std::invalid_argument);
}

TEST(TabulatedAir, ABandMustBeCovered) {
  const TabulatedAir air = read("# made\nwavelength_um,extinction_1/km\n4,0.2\n5,0.4\n");
  EXPECT_NO_THROW(air.requireBand(4.0, 5.0, "seeker"));
  try {
    air.requireBand(3.6, 4.9, "camera 'seeker' channel 'mw'");
    FAIL();
  } catch (const UserError& e) {
    EXPECT_EQ(
        std::string(e.what()),
        "a.csv:2:1: the air covers 4 to 5 um, not the 3.6 to 4.9 um of camera 'seeker' channel 'mw'; expected a table over all of it; fix: add rows from 3.6 "
        "to 4.9 um (2040 to 2778 1/cm)");
  }
}

// ---- Files -------------------------------------------------------------------------------------------------------------------------------

// Bins of a table's own where it is finer than the usual ones, usual ones between its wavelengths where it is coarse; nothing of a response is lost.
TEST(FineGrid, FollowsATable) {
  const Spectrum band = Spectrum::band(4.0, 5.0, 2.0);
  std::vector<double> fine, coarse = {3.0, 4.1, 4.7, 6.0};
  for (int v = 2600; v >= 1900; --v) fine.push_back(1e4 / v);
  const auto sum = [](const std::vector<QuadratureNode>& nodes) {
    double total = 0.0;
    for (const auto& n : nodes) total += n.weight;
    return total;
  };
  const auto own = fineGrid(band, fine);
  EXPECT_NEAR(sum(own), 2.0, 1e-12);
  ASSERT_EQ(own.size(), 501u);  // 2000 to 2500 1/cm
  for (size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(1e4 / own[i].x, 2500.0 - static_cast<double>(i), 1e-9);
  const auto usual = fineGrid(band, coarse);
  EXPECT_NEAR(sum(usual), 2.0, 1e-12);
  EXPECT_GT(usual.size(), 90u);  // 5 1/cm are 0.008 to 0.0125 um
  EXPECT_LT(usual.size(), 130u);
  for (size_t i = 1; i < usual.size(); ++i) EXPECT_GT(usual[i].x, usual[i - 1].x);
  EXPECT_NEAR(sum(fineGrid(band)), 2.0, 1e-12);
}

TEST(AirCsv, AllFormsAgree) {
  const double tau1 = std::exp(-0.3 - 0.1), tau4 = std::exp(-0.3 * std::pow(4.0, 0.55) - 0.4), j = 2.5;
  std::ostringstream t1, t4, l1, l4;
  t1.precision(17), t4.precision(17), l1.precision(17), l4.precision(17);
  t1 << tau1, t4 << tau4, l1 << j * (1 - tau1), l4 << j * (1 - tau4);
  const std::string both = t1.str() + "," + t4.str() + "," + l1.str() + "," + l4.str();
  const std::vector<std::string> forms = {
      "wavelength_um, range_km, transmittance, path_radiance_W/(m2 sr um)\n4,1," + t1.str() + "," + l1.str() + "\n4,4," + t4.str() + "," + l4.str() + "\n5,1," +
          t1.str() + "," + l1.str() + "\n5,4," + t4.str() + "," + l4.str() + "\n",
      "# blocks\r\nwavelength [nm],range [m],transmittance,path radiance [W/(m2 sr um)]\r\n4000,4000," + t4.str() + "," + l4.str() + "\r\n5000,4000," +
          t4.str() + "," + l4.str() + "\r\n\r\n4000,1000," + t1.str() + "," + l1.str() + "\r\n5000,1000," + t1.str() + "," + l1.str() + "\r\n",
      "wavenumber_1/cm,wavelength_um,transmittance_1km,transmittance_4km,path_radiance_1km_W/(m2 sr um),path_radiance_4km_W/(m2 sr um)\n2000,5," + both +
          "\n2500,4," + both + "\n",
      "\xEF\xBB\xBFwavelength_um,transmittance 1 km,transmittance_4000m,path radiance 1 km [W/(m2 sr um)],path_radiance_4000_m_W/(m2_sr_um)\n4," + both +
          "\n5," + both,
  };
  for (const std::string& form : forms) {
    const TabulatedAir air = read(form);
    EXPECT_EQ(air.knots_um().size(), 2u);
    EXPECT_NEAR(air.validLow_um(), 4.0, 1e-12);
    EXPECT_NEAR(air.validHigh_um(), 5.0, 1e-12);
    EXPECT_NEAR(air.shortestRange_m(), 1000.0, 1e-9);
    EXPECT_NEAR(air.longestRange_m(), 4000.0, 1e-9);
    EXPECT_NEAR(air.transmittance(4.5, 1000.0), tau1, 1e-9) << form;
    EXPECT_NEAR(air.transmittance(4.5, 4000.0), tau4, 1e-9) << form;
    EXPECT_NEAR(air.pathRadiance(4.0, 4000.0), j * (1 - tau4), 1e-8) << form;
    EXPECT_LT(air.fit().largest, 1e-9);
  }
  // Radiance per wavenumber: W/(cm2 sr cm-1) nu^2 is W/(m2 sr um).
  const TabulatedAir other = read("wavenumber_cm-1,extinction_1/m,source_radiance_W/(cm2 sr cm-1)\n2000,1e-4,1e-7\n2500,2e-4,2e-7\n");
  EXPECT_NEAR(other.sourceRadiance(5.0), 0.4, 1e-12);
  EXPECT_NEAR(other.sourceRadiance(4.0), 1.25, 1e-12);
  EXPECT_NEAR(other.coefficients(4.0)[0], 0.2, 1e-12);
  // One range: exponential, and it says so.
  const TabulatedAir one = read("wavelength_um,range_km,transmittance\n4,2,0.5\n5,2,0\n");
  EXPECT_NEAR(one.transmittance(4.0, 1000.0), std::sqrt(0.5), 1e-12);
  EXPECT_LT(one.transmittance(5.0, 2000.0), 1e-6);
  EXPECT_NE(one.description().find("exponential"), std::string::npos);
  EXPECT_FALSE(one.emits());
}

TEST(AirCsv, MistakesAreNamed) {
  const std::string head = "wavelength_um,range_km,transmittance\n";
  const std::pair<std::string, std::string> broken[] = {
      {"", "a.csv:1:1: the file is empty"},
      {"# nothing\n", "a.csv:1:1: the file is empty"},
      {"wavelength,transmittance_1km\n", "a.csv:1:1: 'wavelength' has no unit; expected wavelength_um or wavelength_nm; fix: write the unit"},
      {"wavelength_ft,transmittance_1km\n", "a.csv:1:1: 'wavelength_ft' has an unknown unit"},
      {"wavelength_um,range,transmittance\n", "a.csv:1:15: 'range' has no unit; expected range_km or range_m"},
      {"wavelength_um,range_km,transmittance_percent\n", "a.csv:1:24: 'transmittance_percent' is not understood"},
      {"wavelength_um,range_km,transmittance,path_radiance\n", "a.csv:1:38: 'path_radiance' has no unit"},
      {"wavelength_um,tau\n", "a.csv:1:15: unknown column 'tau'"},
      {"wavelength_um,transmittance\n", "a.csv:1:15: a transmittance without a range"},
      {"wavelength_um,range_km\n", "a.csv:1:1: no transmittance and no extinction"},
      {"transmittance_1km\n", "a.csv:1:1: no column of wavelengths"},
      {"wavelength_um,wavelength_nm,transmittance_1km\n", "a.csv:1:15: the column 'wavelength_nm' comes twice"},
      {"wavelength_um,transmittance_1km,transmittance_1000m\n", "a.csv:1:33: the range of 'transmittance_1000m' comes twice"},
      {"wavelength_um,transmittance_0km\n", "a.csv:1:15: the range in 'transmittance_0km' is not above zero"},
      {"wavelength_um,extinction_1/km,transmittance_1km\n", "a.csv:1:15: extinction beside transmittance"},
      {"wavelength_um,extinction_1/km,path_radiance_W/(m2 sr um)\n", "a.csv:1:31: a path radiance without a range; expected source_radiance"},
      {"wavelength_um,extinction_1/km,range_km\n", "a.csv:1:31: a range without a transmittance"},
      {"wavelength_um,transmittance_1km,path_radiance_2km_W/(m2 sr um)\n", "a.csv:1:33: 'path_radiance_2km_W/(m2 sr um)' is for a range without"},
      {head, "a.csv:1:1: no rows"},
      {head + "4,1,0.5\n", "a.csv:2:1: one wavelength"},
      {head + "4,1,0.5\n5,1\n", "a.csv:3:4: a row of 2 cells; expected 3"},
      {head + "4,1,0.5\n5,1,0.5,7\n", "a.csv:3:9: a row of 4 cells; expected 3"},
      {head + "4,1,\n", "a.csv:2:5: nothing stands for transmittance"},
      {head + "4,1,nan\n", "a.csv:2:5: 'nan' for transmittance is not finite"},
      {head + "4,inf,0.5\n", "a.csv:2:3: 'inf' for range_km is not finite"},
      {head + "4,1,1e999\n", "a.csv:2:5: '1e999' for transmittance is not finite"},
      {head + "4,1,half\n", "a.csv:2:5: 'half' for transmittance is not a number"},
      {head + "4,1,93\n", "a.csv:2:5: '93' for transmittance is out of range; expected a number from 0 to 1; fix: give transmittance as a fraction"},
      {head + "4,1,-0.1\n", "a.csv:2:5: '-0.1' for transmittance is out of range"},
      {head + "4,0,0.5\n", "a.csv:2:3: '0' for range_km is out of range"},
      {head + "0,1,0.5\n", "a.csv:2:1: '0' for wavelength_um is out of range"},
      {head + "4,1,0.5\n4,1,0.6\n", "a.csv:3:3: this wavelength at a range of 1 km comes twice; expected each once; fix: remove one of lines 2 and 3"},
      {head + "5,1,0.5\n4,1,0.6\n", "a.csv:3:1: wavelength_um does not rise at a range of 1 km; expected more than in line 2"},
      {head + "4,1,0.5\n5,1,0.6\n4,2,0.5\n4.5,2,0.5\n", "a.csv:5:1: a wavelength at a range of 2 km that 1 km has not"},
      {head + "4,1,0.5\n5,1,0.6\n4,2,0.5\n", "a.csv:3:1: a wavelength at a range of 1 km that 2 km has not"},
      {"wavenumber_1/cm,extinction_1/km\n2500,1\n2000,1\n", "a.csv:3:1: wavenumber_1/cm does not rise; expected more than in line 2"},
      {"wavelength_um,extinction_1/km\n4,1\n4,1\n", "a.csv:3:1: this wavelength comes twice"},
      {"wavelength_um,wavenumber_1/cm,extinction_1/km\n4,2000,1\n", "a.csv:2:3: wavenumber_1/cm is not that of wavelength_um"},
      {"wavelength_um,extinction_1/km\n4,-1\n", "a.csv:2:3: '-1' for extinction_1/km is out of range"},
      {head + std::string(70000, '1'), "a.csv:2:1: a line of more than 65536 characters"},
  };
  for (const auto& [text, expected] : broken) {
    const std::string message = refused(text);
    EXPECT_EQ(message.substr(0, expected.size()), expected) << text.substr(0, 200);
    EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    EXPECT_NE(message.find("; fix: "), std::string::npos) << message;
  }
  EXPECT_THROW(readAirCsv(fs::path("/no/such/file.csv")), UserError);
  EXPECT_THROW(readAirCsv(fs::path("/tmp")), UserError);
}

// 3000 damaged files: read, or refused in one line.
TEST(AirCsv, DamagedOnesAreReadOrRefused) {
  const std::vector<std::string> corpus = {
      "wavelength_um,range_km,transmittance,path_radiance_W/(m2 sr um)\n4,1,0.5,0.1\n4,2,0.4,0.2\n5,1,0.6,0.1\n5,2,0.5,0.2\n",
      "wavenumber_1/cm,transmittance_1km,transmittance_2km,source_radiance_W/(m2 sr um)\n2000,0.5,0.3,1\n2500,0.7,0.6,2\n",
      "wavelength [nm],extinction [1/km]\n400,0.2\n500,0.1\n700,0.05\n"};
  std::mt19937 random(11);
  const auto below = [&](size_t n) { return static_cast<size_t>(random() % std::max<size_t>(n, 1)); };
  int refusals = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = corpus[below(corpus.size())];
    for (size_t k = 1 + below(3); k > 0; --k) {
      const size_t at = below(text.size()), length = below(12);
      switch (below(5)) {
        case 0:
          text.erase(at, length);
          break;
        case 1:
          text.insert(at, text.substr(below(text.size()), length));
          break;
        case 2:
          text.insert(at, ",");
          break;
        case 3:
          if (!text.empty()) text[at] = static_cast<char>(random());
          break;
        default:
          if (!text.empty()) text[at] = "0123456789.-+eE,\n ["[below(19)];
          break;
      }
    }
    try {
      const TabulatedAir air = read(text);
      for (double um : {air.validLow_um(), air.validHigh_um()}) {
        const double tau = air.transmittance(um, 1500.0);
        ASSERT_TRUE(tau >= 0.0 && tau <= 1.0) << text;
        ASSERT_TRUE(air.pathRadiance(um, 1500.0) >= 0.0) << text;
      }
    } catch (const UserError& e) {
      ++refusals;
      ASSERT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      ASSERT_EQ(std::string(e.what()).rfind("a.csv:", 0), 0u) << e.what();
    }
  }
  EXPECT_GT(refusals, 1000);
  EXPECT_LT(refusals, 3000);
}

}  // namespace
}  // namespace pitviper::test
