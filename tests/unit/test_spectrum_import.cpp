// Spectra of others: what the words above their numbers say, in the spellings of libraries and instruments; what they leave open is refused with the choices.
#include <gtest/gtest.h>

#include "scenarios/import/material_import.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/spectrum_value.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

struct Made {
  std::string refused, notes, kind;
  std::optional<Spectrum> spectrum;
};

/// As a scenario would read it.
Made made(const std::string& content, const ImportChoices& choices = {}, const std::string& name = "a.txt") {
  const TemporaryFolder folder;
  Made m;
  try {
    const auto imported = importedMaterial(folder.put(name, content), choices);
    if (!imported) return m;
    for (const std::string& n : imported->notes) m.notes += n + "\n";
    const Value tree = parseYaml(imported->yaml, name);
    const Value* pane = tree.find("transmission");
    m.kind = pane ? "transmittance" : "reflectance";
    const Value* value = pane ? pane->find("transmittance") : tree.find("components")->items.at(0).find("reflectance");
    m.spectrum = SpectrumReader(SpectrumFiles{}).read(*value, "", "spectrum");
  } catch (const UserError& e) {
    m.refused = e.what();
  }
  return m;
}

struct Right {
  std::string name, content;
  double um, value;
  std::string kind = "reflectance", note = {};
};

TEST(SpectrumImport, HeadersInManySpellings) {
  const std::string percent = "0.5 1.4\n5 0.8\n", nm = "500 0.2\n2500 0.4\n", perCm = "4000 0.2\n400 0.4\n", mark = "\xC2\xB5";
  const std::vector<Right> all = {
      // per cent of dark surfaces
      {"ECOSTRESS", "Name: a\nX Units: Wavelength (micrometers)\nY Units: Reflectance (percent)\n\n" + percent, 0.5, 0.014},
      {"percentage", "Name: a\nX Units: Wavelength (micrometer)\nY Units: Reflectance (percentage)\n\n" + percent, 0.5, 0.014},
      {"sign", "X Units: um\nY Units: %\nMeasurement: Directional Hemispherical Reflectance\n\n" + percent, 0.5, 0.014},
      {"%R", "wavelength_um\t%R\n0.5\t1.4\n5\t0.8\n", 5, 0.008},
      {"R (%)", "Wavelength [" + mark + "m], R (%)\n0.5, 1.4\n5, 0.8\n", 5, 0.008},
      {"R [%] of Latin-1", "Wavelength [\xB5m]; R [%]\n0.5; 1.4\n5; 0.8\n", 5, 0.008},
      {"per cent", "Wavelength in microns, reflectance in per cent\n" + percent, 0.5, 0.014},
      {"units below names", "Wavelength;Reflectance\n[um];[%]\n0.5;1.4\n5;0.8\n", 0.5, 0.014},
      // shares
      {"share", "Wavelength (um)  Reflectance (0-1)\n0.5 0.2\n5 0.4\n", 0.5, 0.2},
      {"fraction", "wavelength [um],reflectance [fraction]\n0.5,0.2\n5,0.4\n", 0.5, 0.2},
      {"unit 1", "wavelength [um], reflectance [1]\n0.5,0.2\n5,0.4\n", 0.5, 0.2},
      // nanometres
      {"nm", "Wavelength [nm]\tReflectance\n" + nm, 2.5, 0.4},
      {"nanometers", "wavelength unit: nanometers\nreflectance\n" + nm, 2.5, 0.4},
      {"nanometres", "Wavelength in nanometres, reflectance as a fraction\n" + nm, 2.5, 0.4},
      {"ASD", "Text conversion of header file a.asd\nThe instrument number was 1\nSpectrum file is reflectance data\nWavelength\ta.asd\n" + nm, 2.5, 0.4,
       "reflectance", "nm, as of what line 1"},
      {"ASD of one range", "New ASD spectrum file\nSpectrum file is reflectance data\nWavelength\ta.001\n400 0.1\n900 0.4\n", 0.9, 0.4},
      {"no unit, one possible", "own\nWavelength Reflectance\n350 0.1\n2500 0.4\n", 2.5, 0.4, "reflectance", "the only one"},
      {"PerkinElmer", "PE UV SUBTECH SPECTRUM\n-1\n#GR\nnm\n%R\n1.0\n0.0\n2500.0\n#DATA\n2500.0\t40\n500.0\t20\n", 0.5, 0.2},
      {"Angstrom", "Wavelength (\xC3\x85)  Reflectance\n5000 0.2\n9000 0.4\n", 0.9, 0.4},
      {"eV", "Photon energy (eV), Reflectance (1)\n1,0.2\n2,0.4\n", 1.239841984, 0.2},
      // wavenumbers
      {"cm-1", "cm-1 reflectance\n" + perCm, 2.5, 0.2},
      {"cm^-1", "Wavenumber [cm^-1], Reflectance [%]\n4000, 20\n400, 40\n", 25, 0.4},
      {"1/cm", "wavenumber (1/cm)\treflectivity\n" + perCm, 2.5, 0.2},
      {"superscript", "Wavenumber (cm\xE2\x81\xBB\xC2\xB9)  Reflectance\n" + perCm, 25, 0.4},
      {"German", "Wellenzahl [cm-1];Reflexion [%]\n4000,0;20,0\n400,0;40,0\n", 25, 0.4, "reflectance", "commas are read as decimal points"},
      {"FTIR", "FTIR spectrometer, diffuse reflectance\nx y\n" + perCm, 2.5, 0.2, "reflectance", "1/cm, as of what line 1"},
      {"Bruker", "Bruker OPUS export, Reflectance\n4000.0,0.2\n400.0,0.4\n", 25, 0.4},
      // decimal commas and what parts cells
      {"tabs and decimal commas", "Wavelength [um]\tReflectance [%]\n0,5\t20,5\n5,0\t40,5\n", 0.5, 0.205},
      {"semicolons and points", "Wavelength [um];Reflectance [%]\n0.5;20.5\n5.0;40.5\n", 5, 0.405},
      {"quotes", "\"Wavelength (nm)\",\"Reflectance (%)\"\n\"500\",\"20.5\"\n\"900\",\"40.5\"\n", 0.9, 0.405},
      {"carriage returns", "Name: a\r\nX Units: um\r\nY Units: Reflectance\r\n\r\n0.5 0.2\r\n5 0.4\r\n", 0.5, 0.2},
      // the USGS's
      {"USGS 6",
       "USGS Digital Spectral Library splib06a\nwavelength    reflectance    standard deviation\n(standard deviation of 0.000000 means not measured)\n(      "
       "-1.23e34 indicates a "
       "deleted number)\n---------\nAcmite NMNH133746 W1R1Ba AREF\n 0.5 0.2 0.01\n 1.0 -1.23e34 -1.23e34\n 2.5 1.02 0.01\n",
       0.5, 0.2, "reflectance", "1 channels marked as deleted"},
      // others' kinds
      {"transmittance", "X Units: Wavelength (micrometers)\nY Units: Transmittance (percent)\n\n0.5 70\n5 5\n", 5, 0.05, "transmittance", "counts as absorbed"},
      {"%T", "Wavelength nm, %T\n500, 70\n900, 5\n", 0.9, 0.05, "transmittance"},
      {"transmission", "Wavelength (um); Transmission\n0.5; 0.7\n5; 0.05\n", 5, 0.05, "transmittance"},
      {"emissivity", "Wavenumber (cm-1)  Emissivity\n1000 0.9\n2000 0.7\n", 10, 0.1, "reflectance", "1 less it"},
      {"JCAMP pairs",
       "##TITLE=a\n##XUNITS=MICROMETERS\n##YUNITS=REFLECTANCE\n##XFACTOR=0.001\n##YFACTOR=0.01\n##NPOINTS=3\n##XYPOINTS=(XY..XY)\n500, 20; 900, 40\n5000, "
       "10\n##END=\n",
       0.9, 0.4},
      {"JCAMP steps",
       "##TITLE=a\n##XUNITS=1/CM\n##YUNITS=TRANSMITTANCE\n##FIRSTX=1000\n##LASTX=2000\n##NPOINTS=5\n##XFACTOR=1\n##YFACTOR=0.001\n##XYDATA=(X++(Y..Y))\n1000 "
       "100+200 300\n1750 "
       "400 500 $$ end\n##END=\n",
       1e4 / 1500, 0.3, "transmittance"},
      {"columns the other way round", "Reflectance (%)\tWavelength (nm)\n20\t500\n40\t900\n", 0.9, 0.4},
      {"times a hundred", "Wavelength (um), Reflectance x 100\n0.5, 1.4\n5, 0.8\n", 5, 0.008},
      {"columns by name", "Wave ;Sample ;Reference;Reflectance\n[nm];[counts];[counts];[%]\n500;1000;2000;50\n900;1000;4000;25\n", 0.9, 0.25}};
  double worst = 0.0;
  for (const Right& r : all) {
    const Made m = made(r.content);
    ASSERT_TRUE(m.spectrum) << r.name << ": " << m.refused;
    EXPECT_EQ(m.kind, r.kind) << r.name;
    const double error = std::abs((*m.spectrum)(r.um) / r.value - 1.0);
    EXPECT_LT(error, 1e-9) << r.name << ": " << (*m.spectrum)(r.um);
    worst = std::max(worst, error);
    EXPECT_NE(m.notes.find(r.note), std::string::npos) << r.name << ": " << m.notes;
  }
  bound("spectra of " + std::to_string(all.size()) + " headers: largest relative error of a value", worst, 1e-9,
        "values as written; twelve digits are kept where units change");
}

TEST(SpectrumImport, WhatIsOpenIsRefusedWithTheChoices) {
  const std::string um = "0.5 0.2\n5 0.4\n";
  const std::vector<std::array<std::string, 3>> all = {
      {"unit of wavelengths", "Reflectance\n400 0.1\n900 0.3\n", "a.txt:2:1: no word above the numbers says in what unit 400 to 900"},
      {"nm or angstrom", "Wavelength Reflectance\n3000 0.1\n9000 0.3\n", "it could be nm, angstrom; fix: say which by '--axis um'"},
      {"quantity", "Sp\n" + um, "a.txt:2:1: no word above the numbers says of what they are"},
      {"per cent or share", "Wavelength (um) Reflectance\n0.5 0.8\n5 1.4\n",
       "a.txt:3:1: no word above the numbers says in what unit the values are, which go up to 1.4"},
      {"neither", "Wavelength (um) Reflectance\n0.5 800\n5 9500\n", "--unit %"},
      {"share that is none", "Wavelength (um) Reflectance (0-1)\n0.5 20\n5 40\n", "a.txt:3:1: the value at 5 um is 40 as a share of 1"},
      {"two quantities", "Reflectance and transmittance of a leaf\nwavelength um\n" + um, "several quantities"},
      {"absorbance", "Wavenumber (cm-1), Absorbance\n4000, 0.1\n400, 0.2\n", "a.txt:1:1: the values are none of a surface's"},
      {"attenuated total reflection", "Wavenumber (cm-1), ATR reflectance\n4000, 0.1\n400, 0.2\n", "none of a surface's"},
      {"absorption coefficient", "Wavelength (um)\tAbsorption coefficient (1/cm)\n0.5\t0.1\n5\t0.2\n", "none of a surface's"},
      {"radiance", "Wavelength (nm)\tRadiance\n400\t0.1\n900\t0.2\n", "none of a surface's"},
      {"raw counts", "Spectrum file is raw data\nWavelength (nm)\ta.asd\n400\t1000\n900\t2000\n", "none of a surface's"},
      {"frequency", "Frequency (THz), Reflectance\n100, 0.1\n200, 0.2\n", "a.txt:1:1: an axis that is neither"},
      {"two units", "X Units: nm\nwavelength (um) reflectance\n" + um, "several units"},
      {"measurement of another", "Measurement: Transmission\nX Units: um\nY Units: Reflectance (percent)\n\n" + um,
       "a.txt:1:1: the measurement is of another quantity"},
      {"beyond the axis", "Wavelength (um) Reflectance\n350 0.1\n2500 0.3\n", "a.txt:3:1: 2500 um is 2500 um"},
      {"one column", "splib07a Record=1: Acmite AREF\n0.1\n0.2\n", "--wavelengths FILE"},
      {"three columns", "Wavelength (um), a, b\n0.5,1,2\n1,2,3\n", "--column N"},
      {"a line of words", "Wavelength (um) Reflectance\n0.5 0.2\nx1.0 0.1\n5 0.4\n", "a.txt:3:1: among the numbers a line that is none"},
      {"a hole", "Wavelength (um), Reflectance, error\n0.5,0.2,0\n1,0.3\n5,0.4,0\n", "a.txt:3:1: a row of 2 numbers"},
      {"commas for both", "wavelength (um), reflectance (%)\n3,6,0,5\n3,8,10,5\n", "commas are both"},
      {"groups of thousands", "wavelength (nm)\treflectance (%)\n1,000\t10\n2,000\t20\n", "a.txt:2:1: commas that are decimal points or part groups"},
      {"falls back", "Wavelength (um) Reflectance\n0.5 0.2\n5 0.4\n4 0.3\n", "a.txt:4:1: the wavelength goes from 5 back to 4"},
      {"two at one place", "Wavelength (um) Reflectance\n0.5 0.2\n5 0.4\n5 0.3\n6 0.3\n", "a.txt:4:1: a second value at 5 um"},
      {"packed", "##TITLE=a\n##XUNITS=1/CM\n##YUNITS=TRANSMITTANCE\n##FIRSTX=1000\n##LASTX=2000\n##NPOINTS=3\n##XYDATA=(X++(Y..Y))\n1000A23b\n##END=\n",
       "a.txt:8:"},
      {"points missing", "##TITLE=a\n##XUNITS=1/CM\n##YUNITS=TRANSMITTANCE\n##NPOINTS=3\n##XYPOINTS=(XY..XY)\n1000,0.1\n1100,0.2\n##END=\n",
       "a.txt:4:1: 2 points"},
      {"UTF-16", std::string("\xFF\xFEW\0a\0", 6), "no text in UTF-8"}};
  for (const auto& [name, content, words] : all) {
    const Made m = made(content);
    EXPECT_FALSE(m.spectrum) << name;
    EXPECT_NE(m.refused.find(words), std::string::npos) << name << ": " << m.refused;
  }
}

TEST(SpectrumImport, ChoicesCountBeforeWords) {
  ImportChoices c;
  c.axis = SpectralAxis::Nanometre, c.quantity = SpectrumQuantity::Reflectance;
  EXPECT_NEAR((*made("Sp\n400 0.1\n900 0.3\n", c).spectrum)(0.9), 0.3, 1e-12);
  EXPECT_NEAR((*made("400 0.1\n900 0.3\n", c).spectrum)(0.4), 0.1, 1e-12);  // no words at all
  c.scale = 0.01;
  EXPECT_NEAR((*made("Wavelength (um) Reflectance (0-1)\n400 0.1\n900 0.3\n", c).spectrum)(0.9), 0.003, 1e-12);
  c.column = 3;
  EXPECT_NEAR((*made("Wavelength a b\n400 10 20\n900 30 40\n", c).spectrum)(0.9), 0.4, 1e-12);
  c.column = 7;
  EXPECT_NE(made("Wavelength a b\n400 10 20\n900 30 40\n", c).refused.find("3 columns"), std::string::npos);
  const TemporaryFolder folder;
  ImportChoices usgs;
  usgs.wavelengths = folder.put("w.txt", " splib07a Record=1: Wavelengths ASD 0.35-2.5 microns\n 0.35\n 1.0\n 2.5\n");
  const Made m = made(" splib07a Record=2: Snow AREF\n 0.98\n -1.2300000e+034\n 0.1\n", usgs);
  ASSERT_TRUE(m.spectrum) << m.refused;
  EXPECT_NEAR((*m.spectrum)(2.5), 0.1, 1e-12);
  EXPECT_TRUE(made("splib07a Record=2: Snow\n0.98\n0.5\n0.1\n", usgs, "splib07a_Snow_ASDFRa_AREF.txt").spectrum);
  EXPECT_NE(made("splib07a Record=2: Snow AREF\n0.98\n0.1\n", usgs).refused.find("3 wavelengths for the 2 values"), std::string::npos);
  EXPECT_NE(made("DATA:\n  - type: tabulated k\n", usgs, "a.yml").refused.find("leave them out"), std::string::npos);
}

TEST(SpectrumImport, TellsWhatItBringsIntoZeroToOne) {
  const Made m = made("X Units: um\nY Units: Reflectance (percent)\n\n3 101.2\n5 100.4\n10 99\n14 -0.2\n");
  EXPECT_NE(m.notes.find("2 of 4 values lie over 1 (greatest 1.012 at 3 um) and are taken as 1\n"), std::string::npos) << m.notes;
  EXPECT_NE(m.notes.find("1 of 4 values lies under 0 (least -0.002 at 14 um) and is taken as 0\n"), std::string::npos) << m.notes;
  EXPECT_EQ((*m.spectrum)(3), 1.0);
  EXPECT_EQ((*m.spectrum)(14), 0.0);
  EXPECT_EQ(made("X Units: um\nY Units: Reflectance (percent)\n\n3 100\n5 0\n").notes, "");
}

}  // namespace
}  // namespace pitviper::test
