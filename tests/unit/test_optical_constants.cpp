// Optical constants of refractiveindex.info: whatever form a file has, its index is loaded again as it was, or the file is refused at its line.
#include <gtest/gtest.h>

#include <random>
#include <regex>

#include "materials/refractive_index.hpp"
#include "scenarios/import/material_import.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/spectrum_value.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

constexpr double kAsked = 1e-5;

struct Loaded {
  std::optional<RefractiveIndex> index;
  std::string refused, notes, yaml;
};

/// As a scenario would load what is printed.
Loaded load(const std::string& content) {
  const TemporaryFolder folder;
  Loaded l;
  try {
    const auto made = importedMaterial(folder.put("a.yml", content));
    for (const std::string& n : made->notes) l.notes += n + "\n";
    l.yaml = made->yaml;
  } catch (const UserError& e) {
    l.refused = e.what();
    return l;
  }
  const Value tree = parseYaml(l.yaml, "printed");
  const SpectrumReader reader(SpectrumFiles{});
  l.index = readRefractiveIndex(*tree.find("index"), [&](const Value& v, const Parameter& p) { return reader.read(v, p.unit, p.key); }, {});
  return l;
}

using Rows = std::vector<std::array<double, 3>>;

std::string written(double v, bool scientific) {
  char text[40];
  std::snprintf(text, sizeof text, scientific ? "%.12E" : "%.17g", v);
  return text;
}

double linear(const Rows& rows, double w, std::size_t column) {
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (w <= rows[i][0]) {
      const double t = (w - rows[i - 1][0]) / (rows[i][0] - rows[i - 1][0]);
      return rows[i - 1][column] + t * (rows[i][column] - rows[i - 1][column]);
    }
  return rows.back()[column];
}

/// The formulas once more, as the database's page has them.
double formulaOf(int number, const std::vector<double>& c, double l) {
  const double l2 = l * l;
  double n2 = 0.0;
  switch (number) {
    case 1:
      return std::sqrt(1 + c[0] + c[1] * l2 / (l2 - c[2] * c[2]) + c[3] * l2 / (l2 - c[4] * c[4]));
    case 2:
      return std::sqrt(1 + c[0] + c[1] * l2 / (l2 - c[2]) + c[3] * l2 / (l2 - c[4]));
    case 3:
      return std::sqrt(c[0] + c[1] * std::pow(l, c[2]) + c[3] * std::pow(l, c[4]));
    case 4:
      n2 = c[0] + c[1] * std::pow(l, c[2]) / (l2 - std::pow(c[3], c[4])) + c[5] * std::pow(l, c[6]) / (l2 - std::pow(c[7], c[8])) + c[9] * std::pow(l, c[10]);
      return std::sqrt(n2);
    case 5:
      return c[0] + c[1] * std::pow(l, c[2]) + c[3] * std::pow(l, c[4]);
    case 6:
      return 1 + c[0] + c[1] / (c[2] - 1 / l2) + c[3] / (c[4] - 1 / l2);
    case 7:
      return c[0] + c[1] / (l2 - 0.028) + c[2] * std::pow(1 / (l2 - 0.028), 2) + c[3] * l2 + c[4] * l2 * l2 + c[5] * l2 * l2 * l2;
    case 8:
      n2 = c[0] + c[1] * l2 / (l2 - c[2]) + c[3] * l2;
      return std::sqrt((1 + 2 * n2) / (1 - n2));
    default:
      return std::sqrt(c[0] + c[1] / (l2 - c[2]) + c[3] * (l - c[4]) / ((l - c[4]) * (l - c[4]) + c[5]));
  }
}

/// Like those of published substances: glasses, crystals, gases.
std::vector<double> coefficientsOf(int number, std::mt19937& random) {
  const auto u = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  switch (number) {
    case 1:
      return {0, u(0.5, 2), u(0.05, 0.2), u(0.2, 1), u(15, 40)};
    case 2:
      return {u(0, 1), u(0.5, 2), u(0.002, 0.04), u(0.2, 1), u(200, 900)};
    case 3:
      return {u(2, 3), u(-0.01, 0.0), 2, u(0.005, 0.02), -2};
    case 4:
      return {u(2, 3), u(0.1, 1), u(0, 1) < 0.5 ? 0.0 : 2.0, u(0.05, 0.2), 2, u(0.1, 0.3), 0, u(12, 20), 2, u(-0.001, 0.0), 2};
    case 5:
      return {u(1.3, 2), u(0.003, 0.02), u(0, 1) < 0.5 ? -2.0 : -1.5, u(0, 1e-4), -4};
    case 6:
      return {0, u(0.01, 0.06), u(100, 300), u(0.001, 0.002), u(40, 60)};
    case 7:
      return {u(1.5, 3.4), u(0.01, 0.2), u(0, 0.02), u(-1e-4, 0), u(-1e-7, 0), u(-1e-10, 0)};
    case 8:
      return {u(0.2, 0.4), u(0.05, 0.1), u(0.01, 0.06), u(-0.002, -0.0005)};
    default:
      return {u(2, 3), u(0.01, 0.03), u(0.01, 0.03), u(0.01, 0.05), u(0.2, 0.25), u(0.05, 0.1)};
  }
}

const std::vector<std::string> kWords = {R"("plain")", R"('it''s "quoted" \ and \x41 <i>n</i>')", "\"tab\\t line\\n back\\\\slash: [a, b] {c} # no comment\"",
                                         "|\n    first\n    second: \"half", "\"\xC2\xB5m \xE2\x80\x94 \xC3\xA9 \xE6\x97\xA5\""};

/// What a file of the format can be.
struct File {
  std::string content;
  Rows rows;  ///< of a table, rising
  int formula = 0;
  std::vector<double> c;
  std::optional<Rows> k;            ///< beside a formula
  double low = 0.1, high = 1000.0;  ///< where it says something, on the spectral axis
  bool refused = false;
};

File made(int number, std::mt19937& random) {
  const auto u = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const auto chance = [&](double p) { return u(0, 1) < p; };
  File f;
  f.content = "# this file is part of refractiveindex.info database\nREFERENCES: " + kWords[static_cast<std::size_t>(number) % kWords.size()] +
              "\nCOMMENTS: " + kWords[static_cast<std::size_t>(number / 3) % kWords.size()] + "\nDATA:\n";
  const bool scientific = chance(0.3);
  const auto table = [&](const char* type, const Rows& rows, std::vector<std::size_t> columns, bool falls, int damage, std::size_t at) {
    std::vector<std::string> lines;
    for (const auto& row : rows) {
      std::string line;
      for (std::size_t c : columns) line += (line.empty() ? "" : " ") + written(row[c], scientific);
      lines.push_back(line);
    }
    if (damage == 1) lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[at]);
    if (damage == 2) std::swap(lines[at], lines[at + 1]);
    if (damage == 3) lines[at].replace(lines[at].find('.'), 1, ",");
    if (damage == 4) lines[at] = "x" + lines[at];
    if (damage == 5) lines[at] += " 1";
    if (damage == 6) lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[at].substr(0, lines[at].rfind(' ')) + " 0.777");
    if (falls) std::reverse(lines.begin(), lines.end());
    f.content += std::string("  - type: ") + type + "\n    data: |\n";
    for (const auto& line : lines) f.content += "        " + line + "\n";
  };
  const auto rowsFrom = [&](double low, double high, bool fine) {
    Rows rows;
    const int count = 4 + static_cast<int>(u(0, 30));
    double w = low;
    for (int i = 0; i < count; ++i) {
      // To the digits written, so that the file holds what is compared with.
      rows.push_back(
          {std::stod(written(w, true)), std::stod(written(u(0.05, 4), true)), std::stod(written(chance(0.2) ? 0.0 : std::pow(10.0, u(-9, 1.5)), true))});
      w += fine ? u(1e-7, 5e-6) : (high - low) / count * u(0.5, 1.5);
    }
    return rows;
  };
  const int kind = number % 20;
  if (kind < 9) {
    f.formula = kind + 1;
    f.c = coefficientsOf(f.formula, random);
    const double low = u(0.35, 0.6), high = u(2, 8);
    f.low = low, f.high = high;
    std::string coefficients;
    for (double& c : f.c) coefficients += " " + written(c, false);
    f.content += "  - type: formula " + std::to_string(f.formula) + "\n    " + (chance(0.5) ? "wavelength_range: " : "range: ") + written(low, false) + " " +
                 written(high, false) + "\n    coefficients:" + coefficients + "\n";
    if (chance(0.4)) {
      f.k = rowsFrom(0.3, 10, false);
      table("tabulated k", *f.k, {0, 2}, false, 0, 0);
      f.low = std::max(low, f.k->front()[0]), f.high = std::min(high, f.k->back()[0]);
    }
    return f;
  }
  const bool beyond = kind == 9 || kind == 10, fine = kind == 11 || kind == 12;
  f.rows = beyond ? rowsFrom(std::pow(10.0, u(-3, -1.2)), std::pow(10.0, u(3.1, 5)), false) : rowsFrom(u(0.2, 20), u(25, 300), fine);
  f.low = std::max(0.1, f.rows.front()[0]), f.high = std::min(1000.0, f.rows.back()[0]);
  int damage = 0;
  if (kind == 13) damage = 1;
  if (kind >= 14 && kind <= 17) damage = 2 + (number / 20) % 5;
  if (kind == 18) f.rows[2][2] = -std::pow(10.0, u(-9, -1));
  f.refused = damage >= 2 || kind == 18;
  const bool falls = chance(0.4);
  if (damage == 0 && chance(0.5) && kind != 18) {
    table("tabulated n", f.rows, {0, 1}, falls, 0, 1);
    table("tabulated k", f.rows, {0, 2}, chance(0.5), 0, 1);
  } else {
    table("tabulated nk", f.rows, {0, 1, 2}, falls, damage, 1);
  }
  if (kind == 19 && chance(0.5)) table("tabulated n", f.rows, {0, 1}, false, 0, 1), f.refused = true;
  return f;
}

TEST(OpticalConstants, TwoHundredFilesAreLoadedAsTheyAreOrRefusedAtTheirLine) {
  std::mt19937 random(39);
  int loaded = 0, refused = 0;
  double worst = 0.0;
  for (int number = 0; number < 200; ++number) {
    const File f = made(number, random);
    const Loaded l = load(f.content);
    EXPECT_EQ(!l.index.has_value(), f.refused) << number << "\n" << f.content << l.refused;
    if (!l.index) {
      ++refused;
      EXPECT_TRUE(std::regex_search(l.refused, std::regex("a\\.yml:[1-9][0-9]*:[1-9]"))) << l.refused;
      EXPECT_EQ(l.refused.find("cannot be read back"), std::string::npos) << l.refused;
      continue;
    }
    ++loaded;
    EXPECT_NEAR(l.index->validLow_um(), f.low, 1e-12 * f.low) << number;
    EXPECT_NEAR(l.index->validHigh_um(), f.high, 1e-12 * f.high) << number;
    std::vector<double> places;
    for (const auto& row : f.rows)
      if (row[0] >= f.low && row[0] <= f.high) places.push_back(row[0]);
    for (int i = 0; i <= 60; ++i) places.push_back(std::clamp(f.low + (f.high - f.low) * i / 60.0, f.low, f.high));
    for (double w : places) {
      const auto found = (*l.index)(w);
      const double n = f.formula ? formulaOf(f.formula, f.c, w) : linear(f.rows, w, 1), k = f.formula ? f.k ? linear(*f.k, w, 2) : 0.0 : linear(f.rows, w, 2);
      const double error = std::max(std::abs(found.real() - n) / n, std::abs(found.imag() - k) / (k > 0.0 ? k : 1.0));
      ASSERT_LT(error, kAsked) << number << " at " << w << " um: " << found << " for " << n << ", " << k << "\n" << f.content;
      worst = std::max(worst, error);
    }
  }
  EXPECT_GT(loaded, 140);
  EXPECT_GT(refused, 30);
  bound("200 made-up files, " + std::to_string(loaded) + " of them loaded: largest relative error of n and k", worst, kAsked,
        "as issue 39 asks; formulas become tables whose lines are off by 1e-6");
}

TEST(OpticalConstants, RefusesAtTheRow) {
  const std::string head = "REFERENCES: a\nDATA:\n  - type: tabulated nk\n    data: |\n", good = "        0.4 1.5 0.0\n        1.0 1.5 0.1\n";
  const std::vector<std::array<std::string, 2>> all = {
      {head + good + "        5.0 1.6 0,2\n", "a.yml:7:17: a comma in '0,2'"},
      {head + good + "\n        x5 1.6 0.2\n", "a.yml:8:9: not a finite number: 'x5'"},
      {head + good + "        5.0 1.6\n", "a.yml:7:1: a row of 2 numbers"},
      {head + good + "        5.0 nan 0.1\n", "a.yml:7:13: not a finite number"},
      {head + good + "        0.5 1.6 0.1\n", "a.yml:7:1: the wavelength goes from 1 um back to 0.5 um"},
      {head + good + "        1.0 1.6 0.1\n", "a.yml:7:1: a second row at 1 um, of other values than that of line 6"},
      {head + good + "        5.0 1.6 -1e-7\n", "a.yml:7:1: k is -1e-07 at 5 um: light would grow"},
      {head + good + "        5.0 0 0.1\n", "a.yml:7:1: n is 0 at 5 um"},
      {head + "        0 1.6 0.1\n        2 1.6 0.1\n", "a.yml:5:1: a wavelength of 0 um"},
      {head + "        1001 1.6 0.1\n        2000 1.6 0.1\n", "a.yml:5:1: the table goes from 1001 um to 2000 um"},
      {"DATA:\n  - type: tabulated k\n    data: |\n        1 0.1\n        2 0.2\n", "a.yml:2:3: no n in the file"},
      {"DATA:\n  - type: tabulated n\n    data: |\n        1 1\n        2 2\n  - type: tabulated k\n    data: |\n        3 1\n        4 2\n",
       "a.yml:6:11: k has no wavelength in common"},
      {"DATA:\n  - type: formula 2\n    wavelength_range: 1 5\n    coefficients: 0 1 4\n", "a.yml:4:19: formula 2 has a pole at 2 um"},
      {"DATA:\n  - type: formula 6\n    wavelength_range: 1 5\n    coefficients: 0 1 0.25\n", "a.yml:4:19: formula 6 gives n"},
      {"DATA:\n  - type: formula 3\n    wavelength_range: 1 5\n    coefficients: 1 -1 2\n", "a.yml:4:19: formula 3 gives n = 0"},
      {"DATA:\n  - type: formula 4\n    wavelength_range: 1 5\n    coefficients: 1 1 2\n", "a.yml:4:19: formula 4 with 3 coefficients"},
      {"DATA:\n  - type: formula 1\n    wavelength_range: 5 1\n    coefficients: 1 1 0.1\n", "a.yml:3:23: a range from 5 um to 1 um"},
      {"DATA:\n  - type: tabulated n2\n    data: |\n        1 1\n", "a.yml:2:11: data of type 'tabulated n2'"}};
  for (const auto& [content, words] : all) EXPECT_NE(load(content).refused.find(words), std::string::npos) << words << "\n" << load(content).refused;
}

TEST(OpticalConstants, TellsWhatItLeavesOut) {
  const std::string head = "SPECS:\n  n_is_absolute: false\nDATA:\n  - type: tabulated nk\n    data: |\n";
  const Loaded l = load(head + "        0.05 1 0.1\n        0.15 2 0.3\n        0.15 2 0.3\n        1500 2 0.3\n");
  ASSERT_TRUE(l.index) << l.refused;
  for (const char* part : {"1 row that stood twice", "2 of 3 rows", "relative to air"}) EXPECT_NE(l.notes.find(part), std::string::npos) << l.notes;
  EXPECT_NEAR((*l.index)(0.1).real(), 1.5, 1e-12);
  EXPECT_NEAR((*l.index)(0.1).imag(), 0.2, 1e-12);
  const Loaded glass = load("DATA:\n  - type: formula 5\n    wavelength_range: 0.05 2000\n    coefficients: 1.5\n");
  ASSERT_TRUE(glass.index) << glass.refused;
  EXPECT_EQ(glass.index->validHigh_um(), 1000.0);
  EXPECT_NE(glass.notes.find("no k"), std::string::npos) << glass.notes;
}

}  // namespace
}  // namespace pitviper::test
