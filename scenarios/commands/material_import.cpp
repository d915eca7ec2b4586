#include "scenarios/commands/material_import.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

std::string shortNumber(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

std::string quoted(std::string text) {
  std::string out;
  for (char c : text) out += c == '"' ? '\'' : c == '\n' || c == '\r' ? ' ' : c;
  return "\"" + out + "\"";
}

std::vector<std::vector<double>> rowsOf(const std::string& text, size_t columns, const Location& where) {
  std::vector<std::vector<double>> rows;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (double v; cells >> v;) row.push_back(v);
    if (row.empty()) continue;
    if (row.size() != columns)
      throw UserError(where, "a row of " + std::to_string(row.size()) + " numbers", std::to_string(columns) + ", as its type says", "correct it");
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw UserError(where, "no numbers", "rows of numbers", "fill them in");
  return rows;
}

std::string table(const std::vector<std::vector<double>>& rows) {
  std::string out = "[";
  for (size_t k = 0; k < rows.size(); ++k) {
    out += (k ? (k % 6 ? ", [" : ",\n         [") : "[");
    for (size_t c = 0; c < rows[k].size(); ++c) out += (c ? ", " : "") + shortNumber(rows[k][c]);
    out += "]";
  }
  return out + "]";
}

std::string ofDatabase(const Value& tree, const std::filesystem::path& file) {
  const auto words = [&](const char* key) { return tree.find(key) ? tree.find(key)->text : std::string(); };
  std::string out = "description: " + quoted(file.stem().string() + (words("COMMENTS").empty() ? "" : "; " + words("COMMENTS"))) +
                    "\nsource: " + quoted(words("REFERENCES") + "; as in refractiveindex.info") + "\nindex:\n";
  const Value& data = *tree.find("DATA");
  for (const Value& part : asList(data, "DATA").items) {
    const Value* type = part.find("type");
    if (!type) throw UserError(part.where, "a part of DATA without a type", "'type: tabulated nk'", "add it");
    const auto need = [&](const char* key) -> const Value& {
      const Value* v = part.find(key);
      if (!v) throw UserError(part.where, "'" + type->text + "' without '" + key + "'", std::string("'") + key + "'", "add it");
      return *v;
    };
    if (type->text == "tabulated nk") {
      out += "  table:\n    " + table(rowsOf(need("data").text, 3, part.where)) + "\n";
    } else if (type->text == "tabulated n" || type->text == "tabulated k") {
      out += std::string("  ") + type->text.back() + ": {wavelength: um, unit: \"1\", values: " + table(rowsOf(need("data").text, 2, part.where)) + "}\n";
    } else if (type->text == "formula 1" || type->text == "formula 2" || type->text == "formula 5") {
      const auto c =
          rowsOf(
              need("coefficients").text,
              [&] {
                std::istringstream in(need("coefficients").text);
                size_t n = 0;
                for (double v; in >> v;) ++n;
                if (n % 2 == 0)
                  throw UserError(part.where, std::to_string(n) + " coefficients", "an odd number: a constant, then pairs", "complete the last pair");
                return n;
              }(),
              part.where)
              .front();
      const auto range = rowsOf((part.find("wavelength_range") ? need("wavelength_range") : need("range")).text, 2, part.where).front();
      if (type->text == "formula 5") {
        // n = c1 + sum c_i lambda^c_(i+1): Cauchy's where the powers are -2, -4 ...
        out += "  cauchy: [" + shortNumber(c[0]);
        for (size_t k = 1; k + 1 < c.size(); k += 2) {
          if (c[k + 1] != -2.0 * static_cast<double>((k + 1) / 2))
            throw UserError(part.where, "formula 5 with a power of " + shortNumber(c[k + 1]), "powers of -2, -4 ...", "write it as a table of n");
          out += ", " + shortNumber(c[k]);
        }
        out += "]\n";
      } else {
        // n^2 - 1 = c1 + sum c_i lambda^2 / (lambda^2 - c_(i+1)), of formula 1 its square.
        out += "  constant: " + shortNumber(1.0 + c[0]) + "\n  sellmeier: [";
        for (size_t k = 1; k + 1 < c.size(); k += 2)
          out += (k > 1 ? ", [" : "[") + shortNumber(c[k]) + ", " + shortNumber(type->text == "formula 1" ? c[k + 1] * c[k + 1] : c[k + 1]) + "]";
        out += "]\n";
      }
      out += "  from: " + shortNumber(range[0]) + " um\n  to: " + shortNumber(range[1]) + " um\n";
    } else {
      throw UserError(type->where, "data of type '" + type->text + "'", "tabulated n, k or nk, formula 1, 2 or 5", "write it as a table of n and k");
    }
  }
  return out;
}

/// What is below is a channel that was taken out (USGS: -1.23e34).
constexpr double kDeleted = -1.0;

/// Two columns below lines of words.
std::optional<std::string> ofColumns(const std::string& text, const std::filesystem::path& file) {
  std::istringstream in(text);
  std::vector<std::vector<double>> rows;
  std::string name, unit;
  int words = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    double w = 0.0, v = 0.0;
    std::string more;
    if (cells >> w >> v && !(cells >> more)) {
      if (v > kDeleted) rows.push_back({w, v});
      continue;
    }
    if (!rows.empty() && line.find_first_not_of(" \t\r") != std::string::npos) return std::nullopt;
    ++words;
    if (line.rfind("Name:", 0) == 0) name = line.substr(5);
    if (line.rfind("Y Units:", 0) == 0) unit = line;
    if (line.rfind("X Units:", 0) == 0 && line.find("icromet") == std::string::npos && line.find("um") == std::string::npos)
      throw UserError({file.string(), words, 1, -1}, "wavelengths that are not in micrometres (" + line + ")", "micrometres", "convert them");
  }
  if (rows.size() < 2 || words == 0) return std::nullopt;
  if (rows.front()[0] > rows.back()[0]) std::reverse(rows.begin(), rows.end());
  double most = 0.0;
  for (const auto& r : rows) most = std::max(most, r[1]);
  const bool percent = unit.find("ercent") != std::string::npos || most > 1.5;
  for (auto& r : rows) r[1] = std::clamp(percent ? 0.01 * r[1] : r[1], 0.0, 1.0);
  const size_t first = name.find_first_not_of(' ');
  return "description: " + quoted(first == std::string::npos ? file.stem().string() : name.substr(first)) + "\nsource: " + quoted(file.filename().string()) +
         "\ncomponents:\n  - reflection: lambertian\n    reflectance:\n      wavelength: um\n      unit: \"1\"\n      outside: error\n      values:\n        " +
         table(rows) + "\n";
}

}  // namespace

std::optional<std::string> importedYaml(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".yml" || ending == ".yaml") {
    const Value tree = loadYaml(file, {file.string(), 0, 0, -1});
    if (tree.find("DATA")) return ofDatabase(tree, file);
    return std::nullopt;
  }
  if (const auto columns = ofColumns(readFileStart(file, 1 << 24), file)) return columns;
  throw UserError({file.string(), 1, 1, -1}, "neither a material nor two columns of wavelength and reflectance below a head of words",
                  "a YAML file, refractiveindex.info's YAML, or a spectrum of ECOSTRESS or USGS", "see 'pitviper material --help'");
}

}  // namespace pitviper
