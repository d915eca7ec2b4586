// What other programs and countries write into tables: semicolons, decimal commas, units of other dimensions, several lines of sight; told by their names.
#include <gtest/gtest.h>

#include "sim/parameters/unit_conversion.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

const std::string kBody = "entities: [{name: s, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K";
const std::string kCamera =
    "cameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 10 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, channels: [{name: mw, "
    "response: ";

std::string refusal(const std::string& yaml) {
  try {
    scene(yaml);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(ForeignTables, SemicolonsAndDecimalCommasAreNamed) {
  const TemporaryFolder folder;
  const std::vector<std::array<std::string, 3>> all = {
      {"response", "wavelength [um]; value [1]\n3,6; 0\n3,8; 0,6\n4,0; 0\n", "1:16: semicolons between the cells"},
      {"response", "wavelength [um], value [1]\n3;0\n4;1\n", "2:2: semicolons"},
      {"response", "wavelength [um]\tvalue [1]\n3.6\t0\n", "1:16: tabs between the cells"},
      {"response", "wavelength [um], value [1]\n3,6, 0\n3,8, 0\n", "write points for decimal commas"},
      {"air", "wavelength_um;transmittance_2km\n3;0,9\n", "1:14: semicolons"},
      {"air", "wavelength_um,transmittance_2km\n3,0,0,9\n", "write points for decimal commas"},
      {"air", "wavelength_um\ttransmittance_2km\n3\t0.9\n", "1:14: tabs"},
      {"path", "time_s;x_m;y_m;z_m\n0;0;0;100\n", "1:7: semicolons"},
      {"path", "time_s,x_m,y_m,z_m\n0,0,0,100\n0,5,1,2,3\n", "write points for decimal commas"},
      {"path", "time_s\tx_m\ty_m\tz_m\n0\t0\t0\t100\n", "1:7: tabs"}};
  for (const auto& [where, content, words] : all) {
    const std::string file = folder.put("t.csv", content), band = "{band: [3 um, 5 um]}}]}]\n";
    const std::string said = where == "response" ? refusal(kBody + "}]\n" + kCamera + "{file: " + file + "}}]}]\n")
                             : where == "air"    ? refusal("atmosphere: {csv: " + file + "}\n" + kBody + "}]\n" + kCamera + band)
                                                 : refusal(kBody + ", motion: {model: csv, file: " + file + "}}]\n" + kCamera + band);
    EXPECT_NE(said.find(words), std::string::npos) << where << ": " << content << said;
    EXPECT_NE(said.find("t.csv:"), std::string::npos) << said;
  }
}

/// The number after a word.
double numberAfter(const std::string& text, const std::string& word) { return std::stod(text.substr(text.find(word) + word.size())); }

TEST(ForeignTables, UnitsOfOtherDimensionsAreConvertedNotRenamed) {
  // 1e-6 W/(cm2 sr cm-1) at 2500 1/cm is 1e-2 W/(m2 sr cm-1), times nu^2 / 1e4 = 625 cm-1/um.
  const std::string perCm = conversionOf("W/(cm2 sr cm-1)", "W/(m2 sr um)");
  figure("W/(cm2 sr cm-1) to W/(m2 sr um) at 2500 1/cm", 1e-6 * numberAfter(perCm, "times ") * 2500.0 * 2500.0, 6.25, 1e-6,
         "d nu / d lambda = nu^2 / 1e4; seven digits are told");
  // A photon of 4 um has h c / 4 um = 4.96611e-20 J.
  const std::string photons = conversionOf("photon/(s m2 sr um)", "W/(m2 sr um)");
  figure("photons of 4 um to watts", numberAfter(photons, "times ") / 4.0, 4.966115e-20, 1e-6, "h c / lambda, CODATA 2018; seven digits are told");
  const std::vector<std::array<std::string, 2>> all = {{"photon/(s m2 sr um)", "times 1.986446e-19 / lambda"},
                                                       {"photon/(s cm2 sr um)", "times 1.986446e-15 / lambda"},
                                                       {"W/(m2 um)", "pi sr"},
                                                       {"W/(cm2 sr cm-1)", "times 1 nu^2"},
                                                       {"mW/(m2 sr cm-1)", "times 1e-07 nu^2"},
                                                       {"W/m2", "another name for their unit would not change them"},
                                                       {"K", "another name"},
                                                       {"flicks", "if they are in it already, write W/(m2 sr um)"}};
  for (const auto& [unit, words] : all) {
    const std::string said = refusal("background: {radiance: {wavelength: um, unit: \"" + unit + "\", values: [[3, 1], [6, 1]]}}\n" + kBody + "}]\n" + kCamera +
                                     "{band: [4 um, 5 um]}}]}]\n");
    EXPECT_NE(said.find("fix: convert the values to W/(m2 sr um)"), std::string::npos) << said;
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_EQ(said.find("write 'unit"), std::string::npos) << said;
  }
}

TEST(ForeignTables, TablesOfTheLibraryAreNamedAsItsAirs) {
  for (const auto& [table, words] : {std::pair<std::string, std::string>{"us76_rural", "write 'library: hazy_us76'"},
                                     {"us76_rural.air", "write 'library: hazy_us76'"},
                                     {"desert.air", "check the path"}}) {
    const std::string said = refusal("atmosphere: {table: " + table + "}\n" + kBody + "}]\n" + kCamera + "{band: [4 um, 5 um]}}]}]\n");
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_NE(said.find("or 'library', one of "), std::string::npos) << said;
    EXPECT_NE(said.find("hazy_mls"), std::string::npos) << said;
  }
  EXPECT_EQ(refusal("atmosphere: {library: hazy_us76, visibility: 10 km}\n" + kBody + "}]\n" + kCamera + "{band: [4 um, 5 um]}}]}]\n"), "");
}

}  // namespace
}  // namespace pitviper::test
