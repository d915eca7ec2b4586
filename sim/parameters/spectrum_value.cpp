#include "sim/parameters/spectrum_value.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/parameters/csv_table.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/unit_conversion.hpp"
#include "sim/parameters/units.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr int kDeepest = 12;
constexpr std::uintmax_t kLargestCsvBytes = 16u << 20;

/// Far below the end of a float (3.4e38), far above any radiance: a black body of 1e5 K has 1e10 W/(m2 sr um).
constexpr double kLargestValue = 1e30;

std::size_t rowsOf(const Spectrum& s) {
  std::size_t rows = 0;
  for (const auto& factor : s.factors())
    if (const auto* t = std::get_if<Spectrum::Table>(&factor)) rows += t->value.size();
  return rows;
}

/// One row of a table as written, before conversion.
struct Row {
  double x = 0.0, y = 0.0;
  Location where;
};

enum class Axis { Wavelength, Wavenumber };

Outside outsideOf(const Value& map, Outside otherwise) {
  const Value* v = map.find("outside");
  if (!v) return otherwise;
  if (v->text == "zero") return Outside::Zero;
  if (v->text == "hold") return Outside::Hold;
  return Outside::Error;
}

Spectrum fromRows(std::vector<Row> rows, const std::string& axisUnit, const Location& axisWhere, const std::string& valueUnit, const Location& unitWhere,
                  std::string_view canonical, Outside outside, std::string_view name, const Location& where) {
  Axis axis = Axis::Wavelength;
  if (!convert({1.0, axisUnit}, "um")) {
    if (!convert({1.0, axisUnit}, "1/cm"))
      throw UserError(axisWhere, "the spectral axis of " + std::string(name) + " has the unit '" + axisUnit + "'",
                      "a wavelength (um, nm) or a wavenumber (1/cm)", "write 'wavelength: um' or 'wavelength: 1/cm'");
    axis = Axis::Wavenumber;
  }
  if (!convert({1.0, valueUnit}, canonical))
    throw UserError(unitWhere, "the values of " + std::string(name) + " have the unit '" + valueUnit + "'",
                    canonical.empty() ? "plain numbers (unit 1)" : "a unit of the dimension of " + std::string(canonical), conversionOf(valueUnit, canonical));
  if (rows.empty()) throw UserError(where, "the table of " + std::string(name) + " is empty", "at least one row", "add rows [wavelength, value]");
  const bool falls = rows.size() > 1 && rows[1].x < rows[0].x;
  if (falls && axis == Axis::Wavelength)
    throw UserError(rows[1].where, "the wavelengths of " + std::string(name) + " do not rise", "each wavelength above the one before", "sort the table");
  Spectrum::Table t;
  t.outside = outside;
  t.name = where.text();
  const double perCm = axis == Axis::Wavenumber ? *convert({1.0, axisUnit}, "1/cm") : 0.0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const Row& r = rows[i];
    if (i > 0 && (falls ? r.x >= rows[i - 1].x : r.x <= rows[i - 1].x))
      throw UserError(r.where, std::string("the ") + (axis == Axis::Wavenumber ? "wavenumbers" : "wavelengths") + " of " + std::string(name) + " do not rise",
                      "each above the one before", "sort the table and remove duplicates");
    const double w = onAxis(axis == Axis::Wavenumber ? 1e4 / (r.x * perCm) : *convert({r.x, axisUnit}, "um"));
    if (!(w >= kShortestWavelength_um && w <= kLongestWavelength_um))
      throw UserError(r.where, "a wavelength of " + std::string(name) + " is outside the spectral axis", "0.1 to 1000 um (10 to 100000 1/cm)",
                      "check the unit of the first column");
    const double value = *convert({r.y, valueUnit}, canonical);
    if (!(std::abs(value) <= kLargestValue))
      throw UserError(r.where, "a value of " + std::string(name) + " is larger than any that can be drawn", "at most 1e30 " + std::string(canonical),
                      "correct it or its unit");
    // Neighbours a last digit apart can become one by the change of unit.
    if (!t.wavelength_um.empty() && w == t.wavelength_um.back())
      throw UserError(r.where, "two wavelengths of " + std::string(name) + " are the same", "each above the one before", "remove one of the rows");
    t.wavelength_um.push_back(w);
    t.value.push_back(value);
  }
  if (t.wavelength_um.size() > 1 && t.wavelength_um[1] < t.wavelength_um[0]) {
    std::reverse(t.wavelength_um.begin(), t.wavelength_um.end());
    std::reverse(t.value.begin(), t.value.end());
  }
  return Spectrum(std::move(t));
}

double bandValue(const Value& v, std::string_view unit) {
  const double x = readNumber(v, unit, "band value");
  if (!(std::abs(x) <= kLargestValue))
    throw UserError(v.where, "the band value is larger than any that can be drawn", "at most 1e30 " + std::string(unit), "correct it or its unit");
  return x;
}

double plainNumber(const Value& v, std::string_view name) {
  const auto q = v.kind == Value::Kind::Scalar ? splitQuantity(v.text) : std::nullopt;
  if (!q || !q->unit.empty())
    throw UserError(v.where,
                    "a table entry of " + std::string(name) + " is not a plain finite number" +
                        (v.kind == Value::Kind::Scalar ? " ('" + v.text.substr(0, 40) + "')" : std::string()),
                    "two numbers [wavelength, value], units given once above", "write numbers only");
  return q->value;
}

}  // namespace

double onAxis(double wavelength_um) {
  for (double end : {kShortestWavelength_um, kLongestWavelength_um})
    if (std::abs(wavelength_um / end - 1.0) < 1e-9) return end;  // far above rounding, far below any width of a band
  return wavelength_um;
}

const ParameterTable& spectrumTable() {
  static const ParameterTable table{
      "spectrum",
      "Where a key takes a spectrum, write a quantity (`0.2 /km`: the same at all wavelengths), the name of a library spectrum "
      "(`insb_mwir`), or a map with one of `values` (and `lines`), `file`, `library`, `band`, `blackbody`, `product`.",
      {list("values", "rows [wavelength, value], rising; piecewise linear", 1, kMostSpectrumRows),
       list("lines",
            "spikes besides or instead of `values`, 0 outside: rows [wavelength, integral over it in `unit` x that of the wavelength], rising; each a triangle "
            "of "
            "1e-5 of its wavelength at half height",
            1, 4096),
       text("wavelength", "unit of the first column: um, nm, or 1/cm for wavenumbers (vacuum)"), text("unit", "unit of the values"),
       choice("outside", {"zero", "hold", "error"}, "what it is outside its table (a response: zero; others: error)"),
       text("file", "CSV with two columns and a header that names their units: `wavelength [um], value [1]`"), text("library", "name of a library spectrum"),
       list("band", "[from, to]: `value` between these wavelengths, 0 elsewhere", 2, 2), any("value", "height of the band (default 1)"),
       within(above(number("blackbody", "K", "Planck radiance at this temperature; with `area` an intensity, with `solid_angle` an irradiance"), 0.0), 0.0,
              1e5),
       within(above(number("area", "m2", "radiating area of a black body light"), 0.0), 0.0, 1e12),
       within(above(number("solid_angle", "sr", "solid angle of a black body sun"), 0.0), 0.0, 2.0 * kPi),
       list("product", "spectra to be multiplied (all but the first dimensionless)", 1, 32),
       any("power", "of an intensity: spectral power distribution; intensity = power / (4 pi)"),
       within(number("scale", "", "factor"), -kLargestValue, kLargestValue), text("source", "where the figures come from")}};
  return table;
}

SpectrumReader SpectrumReader::in(const std::filesystem::path& base) const {
  SpectrumFiles files = files_;
  files.base = base;
  return SpectrumReader(files);
}

Spectrum SpectrumReader::read(const Value& value, std::string_view unit, std::string_view name, Outside outside) const {
  Spectrum spectrum = readAny(value, unit, name, outside, 0);
  count(spectrum, value.where);
  return spectrum;
}

void SpectrumReader::count(const Spectrum& spectrum, const Location& where) const {
  *files_.rowsRead += rowsOf(spectrum);
  if (*files_.rowsRead > kMostRowsTogether)
    throw UserError(where, "the spectra of this scenario have more than " + std::to_string(kMostRowsTogether) + " rows together", "fewer rows",
                    "thin the tables out, or use fewer of them");
}

Spectrum SpectrumReader::readAny(const Value& value, std::string_view unit, std::string_view name, Outside outside, int depth) const {
  if (depth > kDeepest) throw UserError(value.where, std::string(name) + " refers to itself", "a spectrum that ends", "break the circle of library names");
  if (value.kind == Value::Kind::Map) return readMap(value, unit, name, outside, depth);
  if (value.kind == Value::Kind::Scalar && !splitQuantity(value.text)) {
    const std::string low = value.text.substr(0, 8);
    if (low == "nan" || low == ".nan" || low == ".inf" || low == "inf" || low == "-.inf" || low == ".NaN" || low == "NaN")
      throw UserError(value.where, std::string(name) + " is not a finite number", unitExample(unit), "write a finite value");
    return readLibrary(value.text, value.where, unit, name, outside, depth);
  }
  const double constant = readNumber(value, unit, name);
  if (!(std::abs(constant) <= kLargestValue))
    throw UserError(value.where, std::string(name) + " is larger than any that can be drawn", "at most 1e30 " + std::string(unit), "correct it or its unit");
  return Spectrum(constant);
}

Spectrum SpectrumReader::readLibrary(const std::string& word, const Location& where, std::string_view unit, std::string_view name, Outside outside,
                                     int depth) const {
  std::vector<std::string> names;
  const bool plain =
      !word.empty() && word.size() < 100 && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
  for (const auto& folder : files_.library) {
    const auto path = folder / (word + ".yaml");
    std::error_code ignored;
    if (plain && std::filesystem::is_regular_file(path, ignored)) {
      const Value tree = files_.loadYaml(path, where);
      const Value* s = tree.find("spectrum");
      if (!s) throw UserError(tree.where, "a library spectrum without the key 'spectrum'", "a map with description, source and spectrum", "add 'spectrum:'");
      Spectrum spectrum = in(folder).readAny(*s, unit, name, outside, depth + 1);
      spectrum.setProvenance(word);
      return spectrum;
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  throw UserError(where, std::string(name) + " is neither a quantity nor a library spectrum ('" + word.substr(0, 60) + "')",
                  unitExample(unit) + ", or one of " + listed(names), didYouMean(word, names, "write a number with its unit, a table or a library name"));
}

namespace {

std::vector<Row> rowsOf(const Value& list, std::string_view name) {
  std::vector<Row> rows;
  for (const Value& row : list.items) {
    if (row.kind != Value::Kind::List || row.items.size() != 2)
      throw UserError(
          row.where,
          "a table row of " + std::string(name) + " is " + (row.kind == Value::Kind::List ? "a list of " + std::to_string(row.items.size()) : row.kindName()),
          "two numbers [wavelength, value]", "write [3.5, 0.82]");
    rows.push_back({plainNumber(row.items[0], name), plainNumber(row.items[1], name), row.where});
  }
  return rows;
}

/// Lines upon a table that is 0 outside: triangles over it, of the lines' own integrals. A product with anything smooth over a line is its value there.
std::vector<Row> withLines(std::vector<Row> table, const std::vector<Row>& lines, std::string_view name) {
  constexpr double kHalfWidth = 1e-5;  // of the wavelength: below any smooth spectrum's, above rounding
  for (std::size_t k = 1; k < table.size(); ++k)
    if (!(table[k].x > table[k - 1].x))
      throw UserError(table[k].where, "the wavelengths of " + std::string(name) + " do not rise", "each wavelength above the one before", "sort the table");
  if (table.size() == 1) table.push_back({table.front().x * (1.0 + kHalfWidth), table.front().y, table.front().where});
  const auto smooth = [&](double x) {
    if (table.empty() || x < table.front().x || x > table.back().x) return 0.0;
    const auto above = std::upper_bound(table.begin() + 1, table.end() - 1, x, [](double a, const Row& r) { return a < r.x; });
    const Row &a = *(above - 1), &b = *above;
    return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
  };
  std::vector<Row> all;
  double last = -INFINITY;
  for (const Row& line : lines) {
    const double width = kHalfWidth * line.x, low = line.x - width, high = line.x + width;
    if (!(line.x > 0.0 && low > last))
      throw UserError(line.where, "lines of " + std::string(name) + " that do not rise, or are less than 2e-5 of their wavelength apart", "rising wavelengths",
                      "sort them, and add up those that are as good as one");
    all.push_back({low, smooth(low), line.where});
    all.push_back({line.x, smooth(line.x) + line.y / width, line.where});
    all.push_back({high, smooth(high), line.where});
    last = high;
  }
  for (const Row& row : table) {
    const bool covered = std::any_of(lines.begin(), lines.end(), [&](const Row& line) { return std::abs(row.x / line.x - 1.0) <= 1.001 * kHalfWidth; });
    if (!covered) all.push_back(row);
  }
  // Where lines lie beyond it, the table ends in steps.
  constexpr double kStep = 1e-9;
  if (!table.empty() && lines.front().x < table.front().x * (1.0 - kHalfWidth)) all.push_back({table.front().x * (1.0 - kStep), 0.0, table.front().where});
  if (!table.empty() && lines.back().x > table.back().x * (1.0 + kHalfWidth)) all.push_back({table.back().x * (1.0 + kStep), 0.0, table.back().where});
  std::sort(all.begin(), all.end(), [](const Row& a, const Row& b) { return a.x < b.x; });
  return all;
}

Spectrum readValues(const Record& r, std::string_view unit, std::string_view name, Outside beyond) {
  if (!r.given("wavelength"))
    throw UserError(r.where(), "the table of " + std::string(name) + " has no unit for its first column", "'wavelength: um', 'nm' or '1/cm'",
                    "add 'wavelength: um'");
  if (!r.given("unit"))
    throw UserError(r.where(), "the table of " + std::string(name) + " has no unit for its values",
                    unit.empty() ? "'unit: \"1\"'" : "'unit: " + std::string(unit) + "'", "add it");
  std::vector<Row> rows;
  if (r.given("values")) rows = rowsOf(r.value("values"), name);
  if (r.given("lines")) {
    if (!convert({1.0, r.text("wavelength")}, "um"))
      throw UserError(r.where("wavelength"), "lines of " + std::string(name) + " by wavenumber", "'wavelength: um' or 'nm'", "give their wavelengths");
    if (r.given("outside") && beyond != Outside::Zero)
      throw UserError(r.where("outside"), "lines of a spectrum that goes on outside its table", "'outside: zero'", "remove it");
    beyond = Outside::Zero;
    rows = withLines(std::move(rows), rowsOf(r.value("lines"), name), name);
  }
  return fromRows(std::move(rows), r.text("wavelength"), r.where("wavelength"), r.text("unit"), r.where("unit"), unit, beyond, name, r.where());
}

Spectrum readBlackBody(const Record& r, std::string_view unit, std::string_view name) {
  const double t = r.number("blackbody");
  double factor = 1.0;
  std::string dimension = "W/(m2 sr um)";
  if (r.given("area")) factor = r.number("area"), dimension = "W/(sr um)";
  if (r.given("solid_angle")) factor *= r.number("solid_angle"), dimension = r.given("area") ? "W/um" : "W/(m2 um)";
  const auto converted = convert({factor, dimension}, unit);
  if (!converted)
    throw UserError(r.where(),
                    "a black body here is in " + dimension + " but " + std::string(name) + " is in " + std::string(unit.empty() ? "plain numbers" : unit),
                    "for an intensity 'area', for an irradiance 'solid_angle', for a radiance neither", "add or remove 'area' or 'solid_angle'");
  return Spectrum(Spectrum::BlackBody{t, *converted});
}

}  // namespace

Spectrum SpectrumReader::readMap(const Value& value, std::string_view unit, std::string_view name, Outside outside, int depth) const {
  const Record r(value, spectrumTable());
  static const char* const kinds[] = {"values", "lines", "file", "library", "band", "blackbody", "product", "power"};
  std::vector<std::string> given;
  for (const char* k : kinds)
    if (r.given(k) && !(std::string_view(k) == "lines" && r.given("values"))) given.emplace_back(k);
  if (given.size() != 1)
    throw UserError(value.where,
                    std::string(name) + (given.empty() ? " says nothing of its values" : " is given in " + std::to_string(given.size()) + " ways at once"),
                    "one of values, lines, file, library, band, blackbody, product, power", given.empty() ? "add one of them" : "keep one of them");
  const std::string& kind = given.front();
  const Outside beyond = outsideOf(value, outside);
  const double scale = r.given("scale") ? r.number("scale") : 1.0;
  Spectrum s;
  if (kind == "values" || kind == "lines") {
    s = readValues(r, unit, name, beyond);
  } else if (kind == "file") {
    std::filesystem::path path = r.text("file");
    if (path.is_relative()) path = files_.base / path;
    s = readSpectrumCsv(path, unit, beyond, r.where("file"));
  } else if (kind == "library") {
    s = readLibrary(r.text("library"), r.where("library"), unit, name, beyond, depth + 1);
  } else if (kind == "band") {
    const auto& b = r.value("band").items;
    const double low = onAxis(readNumber(b[0], "um", "band edge")), high = onAxis(readNumber(b[1], "um", "band edge"));
    if (!(low >= kShortestWavelength_um && high <= kLongestWavelength_um && low < high))
      throw UserError(r.where("band"), "the band of " + std::string(name) + " is empty or outside the spectral axis", "rising edges within 0.1 to 1000 um",
                      "write [3 um, 5 um]");
    s = Spectrum::band(low, high, r.given("value") ? bandValue(r.value("value"), unit) : convert({1.0, ""}, unit).value_or(1.0));
  } else if (kind == "blackbody") {
    s = readBlackBody(r, unit, name);
  } else if (kind == "product") {
    bool first = true;
    for (const Value& factor : r.value("product").items) {
      const Spectrum f = readAny(factor, first ? unit : "", name, outside, depth + 1);
      s = first ? f : s * f;
      first = false;
      if (rowsOf(s) > kMostSpectrumRows)
        throw UserError(factor.where, "the factors of " + std::string(name) + " have more than " + std::to_string(kMostSpectrumRows) + " rows together",
                        "fewer rows", "thin the tables out");
    }
  } else {
    if (!convert({1.0, "W/(sr um)"}, unit))
      throw UserError(value.where, "'power' gives an intensity, but " + std::string(name) + " is in " + std::string(unit), unitExample(unit), "use 'values'");
    s = readAny(r.value("power"), "W/um", name, outside, depth + 1) * (*convert({1.0, "W/(sr um)"}, unit) / (4.0 * kPi));
  }
  if (scale != 1.0) s = s * scale;
  if (r.given("source")) s.setProvenance(r.text("source"));
  return s;
}

Spectrum readSpectrumCsv(const std::filesystem::path& file, std::string_view unit, Outside outside, const Location& askedAt) {
  const CsvTable table = readCsvTable(file,
                                      {.what = "a CSV file with a spectrum of at most " + std::to_string(kMostSpectrumRows) + " rows",
                                       .mostBytes = kLargestCsvBytes,
                                       .fix = "check the name; it is relative to the scenario's folder",
                                       .fixLarge = "thin the table out"},
                                      kMostSpectrumRows, askedAt);
  if (table.columns.size() != 2)
    throw UserError(table.columns.back().where, table.columns.size() < 2 ? "a table of one column" : "a table of more than two columns",
                    "two columns separated by one comma", "keep wavelength and value only");
  std::vector<Row> rows;
  for (std::size_t k = 0; k < table.rows(); ++k) rows.push_back({table.at(k, 0), table.at(k, 1), table.whereOf(k)});
  return fromRows(std::move(rows), table.columns[0].unit, table.columns[0].where, table.columns[1].unit, table.columns[1].where, unit, outside, "this table",
                  Location{table.file, 1, 1, -1});
}

}  // namespace pitviper
