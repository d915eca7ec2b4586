// Climates, radiosondes and aerosols by name: against published columns, saturation, spectra, and the weight of air.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "atmosphere/absorber_table.hpp"
#include "sim/world/haze_not_fog.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

const fs::path kLibrary = fs::path(PITVIPER_SOURCE_DIR) / "atmosphere/library";

AirProfile climate(const std::string& name) { return AirProfile::read(kLibrary / "climates" / (name + ".csv"), {}); }

AbsorberTable table() { return AbsorberTable::read(kLibrary / "us76_rural.air"); }

/// Mass of water above the ground [g/cm2]: mole fraction x pressure over (R T), in fine steps.
double waterColumn(const AirProfile& p) {
  double sum = 0.0;
  for (double h = 0.0; h < 60e3; h += 20.0) {
    const AirLevel l = p.at(h + 10.0);
    sum += l.water * l.pressure_Pa / (8.31446 * l.temperature_K) * 18.0153 * 20.0;
  }
  return 1e-4 * sum;
}

TEST(Climates, ColumnsOfWaterAreThePublishedOnes) {
  for (const auto& [name, column] : {std::pair{"tropical", 4.118},
                                     {"midlatitude_summer", 2.924},
                                     {"midlatitude_winter", 0.852},
                                     {"subarctic_summer", 2.083},
                                     {"subarctic_winter", 0.416},
                                     {"us_standard_1976", 1.417}})
    figure(std::string("column of water, ") + name + " [g/cm2]", waterColumn(climate(name)), column, 0.01,
           "LOWTRAN 7's own columns of the six models; mixing ratios exponential in between");
}

TEST(Climates, SaturationIsThePublishedOne) {
  // Over water [Pa]: Goff and Gratch 1946, as in the Smithsonian tables.
  for (const auto& [t, pressure] : {std::pair{-40.0, 19.05}, {-20.0, 125.4}, {0.0, 611.1}, {20.0, 2338.0}, {40.0, 7381.0}})
    figure("saturation at " + std::to_string(t) + " degC [Pa]", AirProfile::saturation_Pa(t + 273.15), pressure, 6e-3, "Alduchov and Eskridge 1996, 0.4 %");
  EXPECT_NEAR(climate("us_standard_1976").humidity(), 0.46, 0.01);
  EXPECT_NEAR(climate("midlatitude_summer").humidity(), 0.76, 0.01);
}

/// By the laws of its amounts the table's own climate is the table.
TEST(Climates, LawsGiveTheTablesOwnLevels) {
  const AbsorberTable own = table();
  AbsorberTable made = own;
  made.setProfile(climate("us_standard_1976"), {});
  double worst = 0.0;
  for (double h = 0.0; h <= 40e3; h += 500.0) {
    const AbsorberAmounts a = own.densities(h), b = made.densities(h);
    for (std::size_t k = 0; k < own.absorbers().size(); ++k)
      if (a.amount_km[k] > 1e-6) worst = std::max(worst, std::abs(b.amount_km[k] / a.amount_km[k] - 1.0));
    EXPECT_NEAR(own.temperature_K(h), made.temperature_K(h), 0.15);
  }
  bound("densities by law against the table's own, relative", worst, 0.02, "powers of pressure and temperature as printed; ozone to three digits");
}

TEST(Climates, OtherGroundsKeepHumidityAndWeight) {
  const AirProfile before = climate("midlatitude_winter");
  AirProfile warm = before;
  warm.setGround({.temperature_K = 290.0, .pressure_Pa = 98e3, .humidity = std::nullopt});
  figure("relative humidity at the ground, kept", warm.humidity(), before.humidity(), 1e-9, "by design");
  EXPECT_DOUBLE_EQ(warm.levels().front().temperature_K, 290.0);
  EXPECT_NEAR(warm.levels().front().pressure_Pa, 98e3, 1e-6);
  EXPECT_DOUBLE_EQ(warm.at(15e3).temperature_K, before.at(15e3).temperature_K);
  // Beside the weight that the climate's own rows have: they are rounded to tenths of a hPa.
  const auto weight = [](const AirProfile& p, double low, double high) {
    double log = 0.0;
    for (double h = low; h < high; h += 10.0) log += 10.0 * 9.80665 / (287.05 * p.at(h + 5.0).temperature_K);
    return std::log(p.at(low).pressure_Pa / p.at(high).pressure_Pa) - log;
  };
  for (double h : {1e3, 5e3, 10e3})
    bound("pressure that is not weight, to " + std::to_string(h) + " m", std::abs(weight(warm, 0.0, h) - weight(before, 0.0, h)), 1e-3, "trapezoids of 1/T");
  AirProfile damp = before;
  damp.setGround({.temperature_K = std::nullopt, .pressure_Pa = std::nullopt, .humidity = 1.0});
  for (double h : {0.0, 1e3, 3e3, 8e3}) {
    const AirLevel l = damp.at(h);
    EXPECT_LE(l.water * l.pressure_Pa, AirProfile::saturation_Pa(l.temperature_K) * (1.0 + 1e-9)) << h;
    EXPECT_GE(l.water, before.at(h).water);
  }
}

TEST(Climates, CarbonDioxideIsItsOwnBandsAlone) {
  const AbsorberTable before = table();
  AbsorberTable more = before;
  more.setCarbonDioxide(660e-6, {});
  AbsorberAmounts mixed;
  for (std::size_t k = 0; k < before.absorbers().size(); ++k)
    if (before.absorbers()[k].name == "mixed_60") mixed.amount_km[k] = 1.0;
  for (double nu : {800.0, 2300.0, 3560.0, 4955.0})
    figure("depth of twice the CO2 at " + std::to_string(nu) + " 1/cm, over before", more.opticalDepth(1e4 / nu, mixed) / before.opticalDepth(1e4 / nu, mixed),
           std::pow(2.0, 0.605), 1e-12, "a band's depth grows as its amount to the power 0.605");
  for (double nu : {1300.0, 3050.0, 4255.0})  // methane's
    EXPECT_DOUBLE_EQ(more.opticalDepth(1e4 / nu, mixed), before.opticalDepth(1e4 / nu, mixed)) << nu;
}

TEST(Aerosols, RuralIsWhatTheTableWasFittedTo) {
  const AbsorberTable own = table();
  const AerosolOptics rural = aerosolOf("rural", 0.46, 0.0, kLibrary, {});  // humidity of the US standard
  double worst = 0.0;
  for (double um : {0.45, 0.55, 0.7, 1.06, 1.6, 2.2, 3.4, 4.0, 4.8, 8.5, 9.2, 10.5, 11.5}) {
    AbsorberAmounts haze;
    for (std::size_t k = 0; k < own.absorbers().size(); ++k)
      if (own.absorbers()[k].kind == AbsorberKind::Haze) haze.amount_km[k] = 1.0;
    worst = std::max(worst, std::abs(own.opticalDepth(um, haze) / (3.912 / 23.0 - 0.0116) - rural.at(um).extinction));
    EXPECT_NEAR(own.hazeAlbedo(um), rural.at(um).albedo, 0.007) << um;  // two digits in the table
  }
  bound("extinction of rural haze over that at 0.55 um, against the fit's", worst, 0.01, "lines between wavelengths; LOWTRAN's own in the fit");
}

TEST(Aerosols, AreThePublishedOnesAndLieBetween) {
  // Shettle and Fenn 1979: extinction over that at 0.55 um and albedo.
  const AerosolOptics dry = aerosolOf("rural", 0.0, 0.0, kLibrary, {}), damp = aerosolOf("rural", 0.99, 0.0, kLibrary, {});
  EXPECT_NEAR(dry.at(1.06).extinction, 0.41943, 1e-4);
  EXPECT_NEAR(dry.at(1.06).albedo, 1.0 - 0.05816 / 0.41943, 1e-4);
  for (double humidity : {0.5, 0.7, 0.75, 0.8, 0.9, 0.98}) {
    const AerosolOptics own = aerosolOf("rural", humidity, 0.0, kLibrary, {});
    EXPECT_DOUBLE_EQ(own.at(0.55).extinction, 1.0);
    EXPECT_GE(own.at(0.55).albedo, dry.at(0.55).albedo - 1e-3);
    EXPECT_LE(own.at(0.55).albedo, damp.at(0.55).albedo + 1e-3);
  }
  // LOWTRAN 7's fogs.
  figure("radiation fog, 10 um over 0.55 um", aerosolOf("radiation_fog", 1.0, 0.0, kLibrary, {}).at(10.0).extinction, 0.24139, 2e-3, "Shettle and Fenn 1979");
  figure("advection fog, 10 um over 0.55 um", aerosolOf("advection_fog", 1.0, 0.0, kLibrary, {}).at(10.0).extinction, 1.22677, 2e-3, "Shettle and Fenn 1979");
  // Storms raise larger dust, which infrared meets as well as visible light.
  EXPECT_GT(aerosolOf("desert", 0.0, 30.0, kLibrary, {}).at(10.0).extinction, 3.0 * aerosolOf("desert", 0.0, 0.0, kLibrary, {}).at(10.0).extinction);
  for (const std::string& type : aerosolTypes())
    for (double humidity : {0.0, 0.3, 0.85, 1.0})
      for (double um : {0.25, 0.4, 1.0, 3.0, 5.0, 10.0, 14.0, 30.0}) {
        const AerosolOptics::At at = aerosolOf(type, humidity, 7.0, kLibrary, {}).at(um);
        EXPECT_TRUE(at.extinction > 0.0 && at.albedo >= 0.0 && at.albedo <= 1.0 && std::abs(at.asymmetry) < 1.0) << type << um;
      }
}

TEST(Aerosols, HazeLiesAsHighAsItsTop) {
  const AbsorberTable before = table();
  AbsorberTable low = before;
  low.setHazeTop(200.0);
  std::size_t haze = 0;
  for (std::size_t k = 0; k < before.absorbers().size(); ++k)
    if (before.absorbers()[k].kind == AbsorberKind::Haze) haze = k;
  const auto column = [&](const AbsorberTable& t) { return t.amounts(0.0, 1.0, INFINITY, 6371e3); };
  figure("haze above the ground with a tenth of the height, over before", column(low).amount_km[haze] / column(before).amount_km[haze], 0.1, 5e-3,
         "stretched; densities exponential between levels");
  for (std::size_t k = 0; k < before.absorbers().size(); ++k) {
    if (k == haze) continue;
    EXPECT_NEAR(column(low).amount_km[k] / column(before).amount_km[k], 1.0, 1e-3) << k;
  }
  EXPECT_NEAR(low.densities(0.0).amount_km[haze], before.densities(0.0).amount_km[haze], 1e-12);
}

// Particles of one's own, through a scenario's keys: spheres far smaller than light scatter as its fourth power, and absorb as its first.
TEST(Aerosols, SmallParticlesOfOnesOwnFollowRayleigh) {
  const auto hazeOf = [](const std::string& k) {
    return scene("atmosphere: {library: hazy_us76, aerosol: particles, particle_radius: 4 nm, particle_deviation: 1.1, particle_n: 1.5, particle_k: " + k +
                 ", visibility: 20 km}\nprobes: [{name: p, position: [0 m, 0 m, 1 m], channels: [{name: a, response: {band: [0.5 um, 0.6 um]}, output: "
                 "irradiance}]}]\n");
  };
  const Simulation clear = hazeOf("0"), dark = hazeOf("0.5");
  const auto& white = dynamic_cast<const HasHaze&>(*clear.air);
  const auto& black = dynamic_cast<const HasHaze&>(*dark.air);
  figure("extinction of clear 4 nm spheres, 0.5 um over 1.0 um", white.hazePer_km(0.5) / white.hazePer_km(1.0), 16.0, 0.01,
         "Rayleigh; x is 0.06, and steps of 3.5 %");
  figure("extinction of dark 4 nm spheres, 0.5 um over 1.0 um", black.hazePer_km(0.5) / black.hazePer_km(1.0), 2.0, 0.01,
         "absorption as the wavelength; scattering adds 1e-3");
  figure("extinction at 0.55 um at 20 km of visibility [1/km]", white.hazePer_km(0.55), 3.912 / 20.0 - 0.0116, 5e-3, "Koschmieder less Rayleigh");
  EXPECT_NEAR(white.hazeAbsorbs(0.7), 0.0, 1e-6);
  EXPECT_GT(black.hazeAbsorbs(0.7), 0.99);
}

// The table's own air has 46 % of humidity; and nobody may ask for light that an index is not known of.
TEST(Aerosols, GoByTheTablesOwnHumidityAndEndWithTheirIndex) {
  EXPECT_NEAR(table().referenceHumidity().value_or(0.0), climate("us_standard_1976").humidity(), 1e-9);
  const auto airOf = [](const std::string& keys) {
    return scene("atmosphere: {library: hazy_us76, " + keys +
                 "}\nprobes: [{name: p, position: [0 m, 0 m, 1 m], channels: [{name: a, response: {band: [0.5 um, 0.6 um]}, output: irradiance}]}]\n");
  };
  const Simulation rural = airOf("aerosol: rural"), half = airOf(
                                                        "aerosol: particles, particle_radius: 0.1 um, particle_n: {wavelength: um, unit: 1, values: "
                                                        "[[0.4, 1.5], [0.7, 1.5]]}");
  const auto& haze = dynamic_cast<const HasHaze&>(*rural.air);
  EXPECT_NEAR(haze.hazeAbsorbs(11.5), 1.0 - aerosolOf("rural", 0.46, 0.0, kLibrary, {}).at(11.5).albedo, 2e-3);
  EXPECT_NEAR(half.air->validHigh_um(), 0.7, 1e-6);
  EXPECT_NEAR(half.air->validLow_um(), 0.4, 1e-6);
}

class Sounding : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("pitviper_sounding_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  AirProfile read(const std::string& text) const {
    const fs::path file = folder_ / "s.csv";
    std::ofstream(file) << text;
    const AirProfile above = climate("us_standard_1976");
    return AirProfile::read(file, {}, &above);
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const UserError& e) {
      return std::string(e.what()).substr(folder_.string().size() + 1);
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(Sounding, DewPointHumidityAndMixingRatioAreTheSameAir) {
  const std::string rows[] = {"altitude [m], pressure [hPa], temperature [degC], dew_point [degC]\n0, 1000, 20, 10\n500, 942, 16, 8\n2000, 780, 6, -4\n",
                              "altitude [km], pressure [Pa], temperature [K], humidity [%]\n0, 100000, 293.15, " +
                                  std::to_string(100.0 * AirProfile::saturation_Pa(283.15) / AirProfile::saturation_Pa(293.15)) + "\n0.5, 94200, 289.15, " +
                                  std::to_string(100.0 * AirProfile::saturation_Pa(281.15) / AirProfile::saturation_Pa(289.15)) + "\n2, 78000, 279.15, " +
                                  std::to_string(100.0 * AirProfile::saturation_Pa(269.15) / AirProfile::saturation_Pa(279.15)) + "\n"};
  const AirProfile a = read(rows[0]), b = read(rows[1]);
  ASSERT_EQ(a.levels().size(), b.levels().size());
  for (std::size_t i = 0; i < a.levels().size(); ++i) EXPECT_NEAR(a.levels()[i].water, b.levels()[i].water, 1e-7) << i;
  figure("water at 10 degC of dew and 1000 hPa [ppmv]", 1e6 * a.levels().front().water, 12281.0, 5e-3, "1228.1 Pa (Goff and Gratch)");
  // Above its end as the standard atmosphere, from the pressure that is there.
  const AirProfile standard = climate("us_standard_1976");
  EXPECT_NEAR(a.at(20e3).pressure_Pa / standard.at(20e3).pressure_Pa, 780e2 / standard.at(2e3).pressure_Pa, 1e-9);
  EXPECT_DOUBLE_EQ(a.at(20e3).ozone, standard.at(20e3).ozone);
}

TEST_F(Sounding, FineOnesAreThinnedOut) {
  std::string text = "altitude [m], pressure [hPa], temperature [K], humidity [%]\n";
  for (int i = 0; i < 3000; ++i) {
    const double h = 4.0 * i;
    text += std::to_string(h) + ", " + std::to_string(1013.0 * std::exp(-h / 8000.0)) + ", " +
            std::to_string(288.0 - 0.0065 * h + (h > 800.0 && h < 1200.0 ? 3.0 : 0.0)) + ", 50\n";
  }
  const AirProfile p = read(text);
  EXPECT_LT(p.levels().size(), 120u);
  for (double h : {100.0, 700.0, 1000.0, 5000.0, 11e3})
    EXPECT_NEAR(p.at(h).temperature_K, 288.0 - 0.0065 * h + (h > 800.0 && h < 1200.0 ? 3.0 : 0.0), 0.25) << h;
}

// Rows between the levels that a table has of its own.
TEST_F(Sounding, AllItsRowsAreInTheAir) {
  AbsorberTable table = AbsorberTable::read(fs::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
  table.setProfile(read("altitude [m], pressure [hPa], temperature [K], humidity [%]\n0, 1013, 288, 60\n50, 1007, 291, 50\n1000, 900, 284, 40\n"), {});
  EXPECT_NEAR(table.temperature_K(50.0), 291.0, 1e-9);
  EXPECT_NEAR(table.airDensity(50.0) / table.airDensity(0.0), 1007.0 / 1013.0 * 288.0 / 291.0, 1e-9);
}

TEST_F(Sounding, DamagedOnesSayWhere) {
  const std::string head = "altitude [m], pressure [hPa], temperature [K], humidity [%]\n";
  for (const auto& [text, said] : std::initializer_list<std::pair<std::string, std::string>>{
           {"altitude [m], pressure [hPa], humidity [%]\n0, 1000, 50\n", "s.csv:1:1: no column 'temperature'"},
           {"altitude [m], pressure [hPa], temperature [K]\n0, 1000, 280\n", "s.csv:1:1: water is told by none or several"},
           {head + "0, 1000, 280, 50\n100, , 279, 50\n", "s.csv:3:5: not a finite number"},
           {head + "0, 1000, 280, 50\n100, -999, 279, 50\n", "s.csv:3:1: a pressure of -999 hPa"},
           {head + "0, 1000, 280, 120\n100, 990, 279, 50\n", "s.csv:2:1: a relative humidity of 120 %"},
           {head + "0, 1000, 280, 50\n0, 990, 279, 50\n", "s.csv:3:1: an altitude that is not above"},
           {head + "0, 1000, 280, 50\n100, 1010, 279, 50\n", "s.csv:3:1: a pressure that is not below"},
           {head + "0, 1000, 20, 50\n100, 990, 19, 50\n", "s.csv:2:1: a temperature of 20 K"},
           {head + "0, 1000, 280, 50\n", "s.csv:1:1: fewer than two rows"},
           {"altitude [m], pressure [hPa], temperature [K], rain [mm]\n0, 1000, 280, 1\n", "s.csv:1:53: a column 'rain'"},
           {"altitude [s], pressure [hPa], temperature [K], humidity [%]\n0, 1000, 280, 50\n", "s.csv:1:10: unit 's' of altitude"}})
    EXPECT_EQ(refusal(text).substr(0, said.size()), said) << refusal(text);
}

}  // namespace
}  // namespace pitviper::test
