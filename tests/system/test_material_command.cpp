// pitviper material as a user runs it: what it prints, what it imports and refuses.
#include <gtest/gtest.h>

#include "scenarios/commands/commands.hpp"
#include "scenarios/import/material_import.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

std::string refusal(const std::filesystem::path& file) {
  try {
    importedMaterial(file);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(MaterialCommand, ShowsLibraryAndSubstances) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(perform(materialCommand(), {}), 0);
  EXPECT_EQ(perform(materialCommand(), {"gold"}), 0);
  EXPECT_EQ(perform(materialCommand(), {"sapphire"}), 0);
  const std::string said = testing::internal::GetCapturedStdout();
  for (const char* part : {"sea_water", "substances", "Rakic", "| 0.55 |", "sapphire_facets"}) EXPECT_NE(said.find(part), std::string::npos) << part;
  EXPECT_THROW(perform(materialCommand(), {"golt"}), UserError);
}

TEST(MaterialCommand, ImportsOthersFiles) {
  const TemporaryFolder folder;
  const std::string nk = folder.put("a.yml", "REFERENCES: \"A. Author\"\nDATA:\n  - type: tabulated nk\n    data: |\n      0.5 1.5 0.1\n      1.0 1.6 0.2\n");
  const auto table = importedMaterial(nk);
  ASSERT_TRUE(table);
  EXPECT_NE(table->yaml.find("[0.5, 1.5, 0.1], [1, 1.6, 0.2]"), std::string::npos) << table->yaml;
  const auto formula =
      importedMaterial(folder.put("b.yml", "DATA:\n  - type: formula 1\n    wavelength_range: 0.3 2.5\n    coefficients: 0 0.7 0.07 0.4 0.1\n"));
  ASSERT_TRUE(formula);
  EXPECT_NE(formula->yaml.find("sellmeier: [[0.7, 0.0049], [0.4, 0.01]]"), std::string::npos) << formula->yaml;
  EXPECT_NE(formula->yaml.find("from: 0.3 um"), std::string::npos);
  const auto spectrum = importedMaterial(
      folder.put("c.txt", "Name: Paint\nX Units: Wavelength (micrometers)\nY Units: Reflectance (percent)\n\n14.0 5.0\n10.0 -1.23e34\n2.0 60\n"));
  ASSERT_TRUE(spectrum);
  EXPECT_NE(spectrum->yaml.find("[2, 0.6], [14, 0.05]"), std::string::npos) << spectrum->yaml;
  // What it writes is read.
  const std::string mine = folder.put("mine.yaml", spectrum->yaml);
  testing::internal::CaptureStdout();
  EXPECT_EQ(perform(materialCommand(), {mine}), 0);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("| 10.6 | 0.2"), std::string::npos);
  EXPECT_FALSE(importedMaterial(folder.put("own.yaml", "components: []\n")));
}

TEST(MaterialCommand, RefusesWhatIsNone) {
  const TemporaryFolder folder;
  EXPECT_NE(refusal(folder.put("a.yml", "DATA:\n  - type: formula 2\n    wavelength_range: 0.3 2.5\n    coefficients: \"\"\n")).find("coefficients"),
            std::string::npos);
  EXPECT_NE(refusal(folder.put("b.yml", "DATA:\n  - type: formula 2\n    wavelength_range: \"\"\n    coefficients: 0 1 2\n")).find("no numbers"),
            std::string::npos);
  EXPECT_NE(refusal(folder.put("c.yml", "DATA:\n  - type: formula 2\n    wavelength_range: 1 2\n    coefficients: 0 1\n")).find("odd number"),
            std::string::npos);
  EXPECT_NE(refusal(folder.put("d.yml", "DATA:\n  - type: formula 10\n")).find("formula 10"), std::string::npos);
  EXPECT_NE(refusal(folder.put("e.txt", "X Units: nanometers\n400 0.5\n500 0.6\n")).find("--quantity"), std::string::npos);
  EXPECT_NE(refusal(folder.put("f.txt", "words\n")).find("two columns"), std::string::npos);
}

}  // namespace
}  // namespace pitviper::test
