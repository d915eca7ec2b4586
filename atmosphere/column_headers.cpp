#include "atmosphere/column_headers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "sim/parameters/readable_text.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

using csv::Cell;
using csv::Column;
using csv::Meaning;

/// A header is far shorter in honest files.
constexpr size_t kMostHeader = 400;

Column column(Meaning meaning, const Cell& cell, double scale = 1.0, bool perWavenumber = false) {
  return {meaning, scale, perWavenumber, false, {}, std::string(cell.text), cell.column};
}

// ---- LBLRTM -------------------------------------------------------------------------------------------------------------------------------

/// The number of the line that names its two columns; none: 0.
size_t lblrtmLine(const csv::Lines& lines) {
  for (size_t i = 0; i < std::min(lines.size(), kMostHeader); ++i)
    for (const Cell& word : csv::wordsOf(lines[i]))
      if (word.text == "WAVENUMBER") return i + 1;
  return 0;
}

ColumnHeader lblrtmHeader(const csv::Lines& lines, const std::string& file) {
  const auto number = static_cast<int>(lblrtmLine(lines));
  auto words = csv::wordsOf(lines[static_cast<size_t>(number) - 1]);
  words.erase(words.begin(), std::find_if(words.begin(), words.end(), [](const Cell& w) { return w.text == "WAVENUMBER"; }));
  const auto refuse = [&](const Cell& word, const std::string& wrong) {
    throw UserError({file, number, word.column, -1}, wrong, "RADIANCE, TRANSMISSION or OPTICAL DEPTH behind WAVENUMBER",
                    "run LBLRTM's plot with JEMIT = 0 (transmittance) or JEMIT = 1, JPLOT = 0 (radiance), or say what the columns hold");
  };
  if (words.size() < 2) refuse(words.front(), "LBLRTM's header does not say what stands beside the wavenumber");
  const Cell& what = words[1];
  const auto begins = [&](const char* word) { return what.text.substr(0, std::string_view(word).size()) == word; };
  Column value = column(Meaning::Transmittance, what);
  if (begins("RAD")) value = column(Meaning::PathRadiance, what, 1.0, true);
  else if (begins("OPTICAL")) value.isDepth = true;
  else if (!begins("TRANS")) refuse(what, tokenOf(what.text) + " in a file of LBLRTM's");
  return {{column(Meaning::Wavenumber, words[0]), value}, number, static_cast<size_t>(number)};
}

// ---- uvspec -------------------------------------------------------------------------------------------------------------------------------

/// Where a line begins that is an input of uvspec's behind '#'; cut before a comment of its own.
std::string_view inputOf(std::string_view line, int& column) {
  const size_t hash = line.find_first_not_of(" \t");
  if (hash == std::string_view::npos || line[hash] != '#') return {};
  const size_t first = line.find_first_not_of("# \t", hash);
  if (first == std::string_view::npos) return {};
  column = static_cast<int>(first);
  const std::string_view rest = line.substr(first);
  return rest.substr(0, rest.find('#'));
}

struct Input {
  std::vector<Cell> words;
  int line = 0;
};

/// By the first word of each; the last of several counts, as in uvspec.
std::map<std::string_view, Input> uvspecInput(const csv::Lines& lines) {
  std::map<std::string_view, Input> all;
  for (size_t i = 0; i < std::min(lines.size(), kMostHeader); ++i) {
    int column = 0;
    auto words = csv::wordsOf(inputOf(lines[i], column));
    for (Cell& word : words) word.column += column;
    if (!words.empty()) all[words.front().text] = {words, static_cast<int>(i) + 1};
  }
  return all;
}

ColumnHeader uvspecHeader(const std::map<std::string_view, Input>& inputs, const std::string& file) {
  const Input& user = inputs.at("output_user");
  const auto word = [&](const char* key) -> std::string_view {
    const auto found = inputs.find(key);
    return found == inputs.end() || found->second.words.size() < 2 ? std::string_view() : found->second.words[1].text;
  };
  const auto refuse = [&](const char* key, const std::string& wrong, const std::string& expected, const std::string& fix) {
    const Input& at = inputs.at(key);
    throw UserError({file, at.line, at.words.back().column, -1}, wrong, expected, fix);
  };
  double sza_deg = 0.0;
  if (const std::string_view text = word("sza"); !text.empty()) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), sza_deg);
    if (error != std::errc() || end != text.data() + text.size() || !(sza_deg >= 0.0 && sza_deg < 90.0))
      refuse("sza", tokenOf(text) + " for the sun's zenith angle", "0 to 90 deg", "correct the line");
  }
  const bool ratio = word("output_quantity") == "transmittance", thermal = word("source") == "thermal", spectral = word("output_quantity").empty();
  const std::string_view process = word("output_process");
  if (!process.empty() && process != "per_nm" && process != "per_cm-1" && process != "none")
    refuse("output_process", tokenOf(process) + " is no spectrum", "output_process per_nm or per_cm-1", "run uvspec with one of these");
  // What uvspec writes besides.
  static constexpr const char* others[] = {"sza", "zout", "eglo", "edn",     "eup",     "enet",   "esum",   "fdir", "fglo",   "fdn", "fup", "f",  "edir",
                                           "uu",  "heat", "p",    "uavgdir", "uavgglo", "uavgdn", "uavgup", "uavg", "albedo", "T",   "T_d", "rh", "spher_alb"};
  ColumnHeader header{{}, user.line, static_cast<size_t>(user.line)};
  bool useful = false;
  for (size_t i = 1; i < user.words.size(); ++i) {
    const Cell& out = user.words[i];
    Column c = column(Meaning::LeftOut, out);
    if (out.text == "lambda") c = column(Meaning::Wavelength, out, 1e-3);
    else if (out.text == "wavenumber") c = column(Meaning::Wavenumber, out);
    else if (out.text == "edir" && ratio && !thermal) c = column(Meaning::Transmittance, out, 1.0 / std::cos(sza_deg * kPi / 180.0));
    else if (out.text == "uu" && thermal && spectral) c = column(Meaning::PathRadiance, out, process == "per_nm" ? 1e3 : 1e-4, process != "per_nm");
    else if (std::none_of(std::begin(others), std::end(others), [&](const char* other) { return out.text == other; }))
      throw UserError({file, user.line, out.column, -1}, "an unknown output of uvspec, " + tokenOf(out.text),
                      "lambda, wavenumber, edir, uu or others that are left out", "correct the line, or say what the columns hold");
    useful = useful || c.meaning == Meaning::Transmittance || c.meaning == Meaning::PathRadiance;
    header.columns.push_back(std::move(c));
  }
  if (!useful)
    refuse("output_user", "none of these outputs of uvspec is air along a path",
           "edir with output_quantity transmittance and source solar, or uu with source thermal and no output_quantity", "run uvspec with one of the two");
  return header;
}

}  // namespace

std::optional<ColumnHeader> columnHeader(const csv::Lines& lines, const std::string& file) {
  if (lblrtmLine(lines) > 0) return lblrtmHeader(lines, file);
  if (const auto inputs = uvspecInput(lines); inputs.count("output_user") > 0) return uvspecHeader(inputs, file);
  return std::nullopt;
}

size_t rowsBelowHeader(const csv::Lines& lines) { return lblrtmLine(lines); }

bool hasColumnHeader(const csv::Lines& lines) { return lblrtmLine(lines) > 0 || uvspecInput(lines).count("output_user") > 0; }

}  // namespace pitviper
