// Damaged spectra and optical constants of others: each becomes YAML that loads, or is refused in one line.
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>

#include "scenarios/import/material_import.hpp"
#include "sim/parameters/error.hpp"
#include "tests/fuzz/fuzz_damage.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

const std::vector<std::array<std::string, 2>> kSound = {
    {"a.txt", "Name: a\nX Units: Wavelength (micrometers)\nY Units: Reflectance (percent)\n\n14.0 1.4\n10.0 2.5\n2.0 60\n"},
    {"a.txt", "Wellenzahl [cm-1];Reflexion [%]\n4000,0;20,0\n3000,5;30,25\n400,0;40,0\n"},
    {"a.txt", "FTIR\nWavenumber (cm\xE2\x81\xBB\xC2\xB9)\tTransmittance\n4000.0\t0.2\n400.0\t0.4\n"},
    {"a.txt", "PE UV SUBTECH SPECTRUM\n-1\n#GR\nnm\n%R\n1.0\n0.0\n2500.0\n#DATA\n2500.0\t40\n500.0\t20\n"},
    {"a.txt",
     "USGS Digital Spectral Library splib06a\nwavelength    reflectance    standard deviation\nAcmite AREF\n 0.5 0.2 0.01\n 1.0 -1.23e34 -1.23e34\n 2.5 0.4 "
     "0.01\n"},
    {"a.jdx",
     "##TITLE=a\n##XUNITS=1/CM\n##YUNITS=TRANSMITTANCE\n##FIRSTX=1000\n##LASTX=2000\n##NPOINTS=5\n##YFACTOR=0.001\n##XYDATA=(X++(Y..Y))\n1000 100+200 "
     "300\n1750 400 500\n##END=\n"},
    {"a.jdx", "##TITLE=a\n##XUNITS=MICROMETERS\n##YUNITS=REFLECTANCE\n##NPOINTS=3\n##XYPOINTS=(XY..XY)\n0.5, 0.2; 0.9, 0.4\n5, 0.1\n##END=\n"},
    {"a.yml",
     "REFERENCES: \"a \\\\ \\\"b\\\"\"\nCOMMENTS: 'c'\nDATA:\n  - type: tabulated nk\n    data: |\n        0.05 1.5 0.0\n        1.0 1.5 0.1\n        5.0 1.6 "
     "2e-3\n        2000 1.6 1\n"},
    {"a.yml",
     "DATA:\n  - type: formula 4\n    wavelength_range: 0.5 5\n    coefficients: 2.25 0.5 2 0.1 2 0.5 0 15 2 -0.001 2\n  - type: tabulated k\n    data: |\n    "
     "    0.4 0.1\n        3.0 0.2\n"},
    {"a.yml", "DATA:\n  - type: formula 8\n    wavelength_range: 0.5 5\n    coefficients: 0.3 0.06 0.02 -0.001\n"},
    {"a.yml", "DATA:\n  - type: formula 1\n    wavelength_range: 0.5 5\n    coefficients: 0 0.7 0.07 0.4 0.1\n"}};

TEST(FuzzImport, DamagedFilesBecomeWhatLoadsOrAreRefused) {
  const char* wanted = std::getenv("PITVIPER_FUZZ_IMPORT");
  const int cases = wanted ? std::atoi(wanted) : 3000;
  const TemporaryFolder folder;
  int accepted = 0, refused = 0;
  double slowest_s = 0.0;
  for (const auto& [name, content] : kSound) EXPECT_TRUE(importedMaterial(folder.put(name, content))) << content;  // undamaged
  for (int i = 0; i < cases; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i));
    auto [name, content] = kSound[random() % kSound.size()];
    for (std::size_t n = 1 + random() % 3; n > 0; --n) damageBytes(content, random);
    const std::string file = folder.put(name, content);
    const std::clock_t begin = std::clock();
    try {
      const auto made = importedMaterial(file);
      ++accepted;
      EXPECT_TRUE(!made || !made->yaml.empty());
    } catch (const UserError& e) {
      ++refused;
      EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << i << e.what();
    } catch (const std::exception& e) {
      ADD_FAILURE() << i << ": " << e.what() << "\n" << content;
    }
    slowest_s = std::max(slowest_s, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::printf("%d damaged files of others: %d accepted, %d refused; slowest %.2f s\n", cases, accepted, refused, slowest_s);
  EXPECT_GT(refused, cases / 5) << "the damage does not damage";
  EXPECT_GT(accepted, cases / 20);
  EXPECT_LT(slowest_s, 5.0);  // a formula near a pole is the longest: a table of 100 000 rows
}

}  // namespace
}  // namespace pitviper::test
