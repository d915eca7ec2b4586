#include "atmosphere/csv_columns.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "sim/parameters/csv_separators.hpp"
#include "sim/parameters/readable_text.hpp"

namespace pitviper::csv {
namespace {

struct Unit {
  const char* name;
  double scale;
  bool perWavenumber = false;
};

struct Kind {
  const char* name;
  Meaning meaning;
  std::vector<Unit> units;  ///< none: a pure number
};

const std::vector<Unit> kRadiance = {{"W/(m2 sr um)", 1.0},          {"W/(cm2 sr um)", 1e4},         {"W/(m2 sr nm)", 1e3},
                                     {"W/(cm2 sr cm-1)", 1.0, true}, {"W/(m2 sr cm-1)", 1e-4, true}, {"mW/(m2 sr cm-1)", 1e-7, true}};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {{"wavelength", Meaning::Wavelength, {{"um", 1.0}, {"nm", 1e-3}}},
                                        {"wavenumber", Meaning::Wavenumber, {{"1/cm", 1.0}, {"cm-1", 1.0}}},
                                        {"range", Meaning::Range, {{"km", 1.0}, {"m", 1e-3}}},
                                        {"transmittance", Meaning::Transmittance, {}},
                                        {"optical_depth", Meaning::Transmittance, {}},
                                        {"extinction", Meaning::Extinction, {{"1/km", 1.0}, {"1/m", 1e3}}},
                                        {"path_radiance", Meaning::PathRadiance, kRadiance},
                                        {"source_radiance", Meaning::SourceRadiance, kRadiance}};
  return all;
}

std::string inQuotes(std::string_view text) { return tokenOf(text); }

/// Blanks as underscores, so that "path radiance [..]" and "path_radiance_.." are alike.
std::string plain(std::string_view text) {
  std::string out(text);
  std::replace(out.begin(), out.end(), ' ', '_');
  return out;
}

std::string_view withoutUnderscores(std::string_view text) {
  while (!text.empty() && text.front() == '_') text.remove_prefix(1);
  while (!text.empty() && text.back() == '_') text.remove_suffix(1);
  return text;
}

/// A range at the beginning of what follows the name: 5km, 500_m.
std::optional<double> takeRange(std::string_view& rest) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  std::string_view after = rest.substr(static_cast<size_t>(end - rest.data()));
  while (!after.empty() && after.front() == '_') after.remove_prefix(1);
  for (const auto& [unit, scale] : {std::pair<std::string_view, double>{"km", 1.0}, {"m", 1e-3}}) {
    if (after.substr(0, unit.size()) != unit) continue;
    const std::string_view next = after.substr(unit.size());
    if (!next.empty() && next.front() != '_') continue;
    rest = withoutUnderscores(next);
    return value * scale;
  }
  return std::nullopt;
}

std::string unitsOf(const Kind& kind) {
  std::string text;
  for (const Unit& u : kind.units) text += (text.empty() ? "" : " or ") + std::string(kind.name) + "_" + u.name;
  return text;
}

Column columnOf(const Cell& cell, Location where) {
  where.column += cell.column - 1;
  std::string name(cell.text), unit;
  if (name == "-") return {Meaning::LeftOut, 1.0, false, false, {}, name, cell.column};
  const size_t bracket = name.find('[');
  const bool bracketed = bracket != std::string::npos && name.back() == ']';
  if (bracketed) {
    unit = plain(name.substr(bracket + 1, name.size() - bracket - 2));
    name.resize(bracket);
    while (!name.empty() && name.back() == ' ') name.pop_back();
  }
  name = plain(name);
  for (const Kind& kind : kinds()) {
    const std::string_view base = kind.name;
    if (name.compare(0, base.size(), base) != 0 || (name.size() > base.size() && name[base.size()] != '_')) continue;
    Column column{kind.meaning, 1.0, false, base == "optical_depth", {}, std::string(cell.text), cell.column};
    std::string_view rest = withoutUnderscores(std::string_view(name).substr(base.size()));
    if (kind.meaning == Meaning::Transmittance || kind.meaning == Meaning::PathRadiance) {
      column.range_km = takeRange(rest);
      if (column.range_km && !(*column.range_km > 0.0))
        throw UserError(where, "the range in " + inQuotes(cell.text) + " is not above zero", "a range as in " + std::string(kind.name) + "_5km",
                        "correct the name of the column");
    }
    if (!bracketed) unit = rest;
    if ((bracketed && !rest.empty()) || (kind.units.empty() && !unit.empty() && unit != "1"))
      throw UserError(where, inQuotes(cell.text) + " is not understood behind '" + kind.name + "'",
                      kind.units.empty() ? std::string(kind.name) + ", or " + kind.name + "_5km" : unitsOf(kind), "correct the name of the column");
    if (kind.units.empty()) return column;
    if (unit.empty()) throw UserError(where, inQuotes(cell.text) + " has no unit", unitsOf(kind), "write the unit behind the name");
    const auto found = std::find_if(kind.units.begin(), kind.units.end(), [&](const Unit& u) { return plain(u.name) == unit; });
    if (found == kind.units.end()) throw UserError(where, inQuotes(cell.text) + " has an unknown unit", unitsOf(kind), "convert the column");
    column.scale = found->scale;
    column.perWavenumber = found->perWavenumber;
    return column;
  }
  throw UserError(where, "unknown column " + inQuotes(cell.text),
                  "wavelength, wavenumber, range, transmittance, optical_depth, extinction, path_radiance or source_radiance, with units",
                  "rename the column, or remove it");
}

bool isKnown(const Cell& cell) {
  const std::string name = plain(cell.text);
  return std::any_of(kinds().begin(), kinds().end(), [&](const Kind& kind) { return name.starts_with(kind.name); });
}

}  // namespace

std::vector<Cell> cellsOf(std::string_view line) {
  std::vector<Cell> cells;
  for (size_t at = 0;;) {
    size_t end = std::min(line.find(',', at), line.size());
    size_t first = at, last = end;
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (first < last && blank(line[first])) ++first;
    while (last > first && blank(line[last - 1])) --last;
    cells.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    if (end == line.size()) return cells;
    at = end + 1;
  }
}

Lines linesOf(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return lines;
}

std::vector<Cell> wordsOf(std::string_view line) {
  std::vector<Cell> words;
  for (size_t i = 0; i < line.size();) {
    const size_t first = line.find_first_not_of(" \t\r", i);
    if (first == std::string_view::npos) break;
    const size_t end = std::min(line.find_first_of(" \t\r", first), line.size());
    words.push_back({line.substr(first, end - first), static_cast<int>(first) + 1});
    i = end;
  }
  return words;
}

std::vector<Column> namesOf(std::string_view header, const Location& where) {
  std::vector<Column> columns;
  const auto cells = cellsOf(header);
  // A file that is something else is not told of by its words.
  if (std::none_of(cells.begin(), cells.end(), isKnown))
    throw UserError(where, "no column of air has a name of those on this line", "a line with the names of columns: wavelength_um, range_km, transmittance",
                    "see atmosphere/tabulated_csv.hpp");
  refuseOtherSeparators(header, where);
  for (const Cell& cell : cells) {
    Column c = columnOf(cell, where);
    for (const Column& other : columns)
      if (other.meaning == c.meaning && c.meaning != Meaning::LeftOut && (other.range_km.has_value() == c.range_km.has_value()) &&
          std::abs(other.range_km.value_or(1.0) - c.range_km.value_or(1.0)) < 1e-9 * c.range_km.value_or(1.0))
        throw UserError({where.file, where.line, where.column + cell.column - 1, -1},
                        c.range_km ? "the range of " + inQuotes(cell.text) + " comes twice" : "the column " + inQuotes(cell.text) + " comes twice", "each once",
                        "remove one of the columns");
    columns.push_back(std::move(c));
  }
  return columns;
}

void requireAir(const std::vector<Column>& columns, const Location& where) {
  const auto has = [&](Meaning m, bool withRange) {
    return std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.meaning == m && c.range_km.has_value() == withRange; });
  };
  const auto none = columns.end();
  const auto refuse = [&](std::vector<Column>::const_iterator at, const std::string& wrong, const std::string& expected, const std::string& fix) {
    throw UserError({where.file, where.line, where.column + (at == none ? 1 : at->column) - 1, -1}, wrong, expected, fix);
  };
  const auto range = has(Meaning::Range, false), tau = has(Meaning::Transmittance, false), wide = has(Meaning::Transmittance, true),
             extinction = has(Meaning::Extinction, false), path = has(Meaning::PathRadiance, false), widePath = has(Meaning::PathRadiance, true),
             source = has(Meaning::SourceRadiance, false);
  if (has(Meaning::Wavelength, false) == none && has(Meaning::Wavenumber, false) == none)
    refuse(none, "no column of wavelengths", "wavelength_um, wavelength_nm or wavenumber_1/cm", "add it");
  if (extinction == none && tau == none && wide == none) refuse(none, "no transmittance and no extinction", "one of them", "add the column");
  if (extinction != none && (tau != none || wide != none)) refuse(extinction, "extinction beside transmittance", "one of the two", "remove one");
  if (tau != none && wide != none) refuse(tau, "a transmittance without a range beside one with it", "ranges in a column or in the names", "remove one");
  if (tau != none && range == none)
    refuse(tau, "a transmittance without a range", "a column range_km, or the range in the name: transmittance_5km", "say over which range it holds");
  if (range != none && tau == none) refuse(range, "a range without a transmittance of its own", "transmittance", "remove the column of ranges");
  if (path != none && tau == none)
    refuse(path, "a path radiance without a range",
           wide != none ? "path_radiance_5km_... for a range of the transmittances" : "source_radiance, which needs none", "rename the column");
  if (widePath != none && wide == none) refuse(widePath, "a path radiance with a range, and no transmittance with one", "transmittance_5km", "add it");
  if (source != none && (path != none || widePath != none)) refuse(source, "a source radiance beside a path radiance", "one of the two", "remove one");
  for (auto c = columns.begin(); c != columns.end(); ++c) {
    if (c->meaning != Meaning::PathRadiance || !c->range_km) continue;
    const bool known = std::any_of(columns.begin(), columns.end(), [&](const Column& t) {
      return t.meaning == Meaning::Transmittance && t.range_km && std::abs(*t.range_km - *c->range_km) < 1e-9 * *c->range_km;
    });
    if (!known) refuse(c, inQuotes(c->name) + " is for a range without a transmittance", "a range that has one", "add the transmittance of this range");
  }
}

}  // namespace pitviper::csv
