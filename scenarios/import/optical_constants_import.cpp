#include "scenarios/import/optical_constants_import.hpp"

#include <algorithm>
#include <sstream>

#include "scenarios/import/dispersion_formulas.hpp"
#include "scenarios/import/import_yaml.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/spectrum_value.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

struct Row {
  std::vector<double> values;  ///< wavelength in um first
  Location where;
};

std::string place(const Location& where) { return "line " + std::to_string(where.line); }
std::string um(double wavelength) { return exactNumber(wavelength) + " um"; }

class Importer {
 public:
  Importer(const Value& tree, const std::string& text, std::string name) : tree_(tree), name_(std::move(name)) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines_.push_back(line);
  }

  ImportedMaterial run() {
    const Value& data = *tree_.find("DATA");
    if (data.kind != Value::Kind::List || data.items.empty())
      throw UserError(data.where, "DATA without parts", "a list of parts, each with a type and its data", "take the file as the database has it");
    for (const Value& part : data.items) readPart(part);
    if (n_.empty()) throw UserError(data.where, "no n in the file", "tabulated n or nk, or a formula", "add n: k alone is no index");
    if (k_.empty() && !kInTable_) note("the file has no k: the substance does not absorb");
    const double low = std::max(nLow_, kLow_), high = std::min(nHigh_, kHigh_);
    if (low > high)
      throw UserError(kWhere_, "k has no wavelength in common with n (" + um(kLow_) + " to " + um(kHigh_) + ", n from " + um(nLow_) + " to " + um(nHigh_) + ")",
                      "ranges that overlap", "remove k if the substance does not absorb where n is known");
    if (low > nLow_ || high < nHigh_)
      note("n is known from " + um(nLow_) + " to " + um(nHigh_) + ", k only from " + um(low) + " to " + um(high) + ": the index ends there");
    noteSpecs();
    std::string head;
    for (const std::string& n : notes_) head += "# note: " + n + "\n";
    const std::string comments = words("COMMENTS");
    return {head + "description: " + quotedText(name_ + (comments.empty() ? "" : "; " + comments)) + "\nsource: " +
                quotedText((words("REFERENCES").empty() ? "" : words("REFERENCES") + "; ") + "as in refractiveindex.info") + "\nindex:\n" + n_ + k_,
            notes_};
  }

 private:
  void note(const std::string& text) { notes_.push_back(readable(text)); }

  std::string words(const char* key) const {
    const Value* v = tree_.find(key);
    std::string text = v ? v->text : "";
    while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.pop_back();
    return text;
  }

  /// n is relative to air where the file says so.
  void noteSpecs() {
    for (const char* map : {"SPECS", "PROPERTIES", "CONDITIONS"}) {
      const Value* specs = tree_.find(map);
      const auto isFalse = [&](const char* key) { return specs && specs->find(key) && specs->find(key)->text == "false"; };
      if (isFalse("n_is_absolute")) note("the file's n is relative to air, up to 0.03 % below that against vacuum; taken as it is");
      if (isFalse("wavelength_is_vacuum")) note("the file's wavelengths are those in air, up to 0.03 % below those in vacuum; taken as they are");
    }
  }

  const Value& need(const Value& part, const Value& type, const char* key) const {
    const Value* v = part.find(key);
    if (!v) throw UserError(part.where, "'" + type.text + "' without '" + key + "'", std::string("'") + key + "'", "add it");
    return *v;
  }

  void readPart(const Value& part) {
    const Value* type = part.find("type");
    if (!type) throw UserError(part.where, "a part of DATA without a type", "'type: tabulated nk'", "add it");
    if (type->text == "tabulated nk") return addTable(rowsOf(need(part, *type, "data"), 3), true, true, *type);
    if (type->text == "tabulated n") return addTable(rowsOf(need(part, *type, "data"), 2), true, false, *type);
    if (type->text == "tabulated k") return addTable(rowsOf(need(part, *type, "data"), 2), false, true, *type);
    const std::string& t = type->text;
    if (t.size() == 9 && t.rfind("formula ", 0) == 0 && t[8] >= '1' && t[8] <= '9') return addFormula(part, *type, t[8] - '0');
    throw UserError(type->where, "data of type " + tokenOf(t), "tabulated n, k or nk, formula 1 to 9", "write it as a table of n and k");
  }

  double numberAt(std::string_view cell, const Location& where) const {
    const auto q = splitQuantity(cell);
    if (q && q->unit.empty()) return q->value;
    if (cell.find(',') != std::string_view::npos)
      throw UserError(where, "a comma in " + tokenOf(cell), "numbers with a decimal point, blanks between them", "write points for decimal commas");
    throw UserError(where, "not a finite number: " + tokenOf(cell), "a number", "correct or remove the row");
  }

  /// Numbers between blanks, with the column at which each begins.
  std::vector<double> numbersOf(std::string_view line, Location where) const {
    std::vector<double> all;
    for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
      where.column = static_cast<int>(at) + 1;
      all.push_back(numberAt(line.substr(at, end - at), where));
      at = end;
    }
    return all;
  }

  /// A line of the file for each of the text's, where it is a literal block; columns are then those of the file.
  std::vector<Row> rowsOf(const Value& data, std::size_t columns) const {
    const std::size_t first = static_cast<std::size_t>(data.where.line);
    const std::string_view head = first >= 1 && first <= lines_.size() ? std::string_view(lines_[first - 1]) : std::string_view();
    const bool block =
        data.where.column >= 1 && static_cast<std::size_t>(data.where.column) <= head.size() && head[static_cast<std::size_t>(data.where.column) - 1] == '|';
    std::vector<Row> rows;
    std::istringstream in(data.text);
    std::size_t k = 0;
    for (std::string line; std::getline(in, line); ++k) {
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      Location where = data.where;
      std::string_view shown = line;
      if (block && first + k < lines_.size() && lines_[first + k].find(line.substr(line.find_first_not_of(" \t\r"))) != std::string::npos)
        where.line += static_cast<int>(k) + 1, where.column = 1, shown = lines_[first + k];
      Row row{numbersOf(shown, where), where};
      if (row.values.size() != columns)
        throw UserError(where, "a row of " + std::to_string(row.values.size()) + " numbers", std::to_string(columns) + ", as its type says, a row to a line",
                        "correct it");
      rows.push_back(std::move(row));
    }
    if (rows.empty()) throw UserError(data.where, "no numbers", "rows of numbers", "fill them in");
    return rows;
  }

  /// Rising, each wavelength once, within the spectral axis.
  std::vector<Row> ordered(std::vector<Row> rows) {
    const bool falls = rows.size() > 1 &&
                       std::find_if(rows.begin() + 1, rows.end(), [&](const Row& r) { return r.values[0] != rows[0].values[0]; }) != rows.end() &&
                       rows.back().values[0] < rows.front().values[0];
    std::vector<Row> kept;
    std::size_t twice = 0;
    for (Row& row : rows) {
      if (!(row.values[0] > 0.0)) throw UserError(row.where, "a wavelength of " + um(row.values[0]), "above 0", "correct or remove the row");
      if (!kept.empty()) {
        const double before = kept.back().values[0], here = row.values[0];
        if (row.values == kept.back().values) {
          ++twice;
          continue;
        }
        if (here == before)
          throw UserError(row.where, "a second row at " + um(here) + ", of other values than that of " + place(kept.back().where), "one row to a wavelength",
                          "remove one of the two");
        if ((here < before) != falls)
          throw UserError(row.where,
                          "the wavelength goes from " + um(before) + (here < before ? " back to " : " up to ") + um(here) + " in a table that " +
                              (falls ? "falls" : "rises"),
                          "rising or falling all through", "put the rows in order, or correct the wavelength");
      }
      kept.push_back(std::move(row));
    }
    if (twice > 0) note(std::to_string(twice) + (twice == 1 ? " row" : " rows") + " that stood twice, word for word, kept once");
    if (falls) std::reverse(kept.begin(), kept.end());
    return cut(std::move(kept));
  }

  /// To the spectral axis, with rows at its ends where the table goes on.
  std::vector<Row> cut(std::vector<Row> rows) {
    const double low = rows.front().values[0], high = rows.back().values[0];
    const Location where = rows.front().where;
    if (high < kShortestWavelength_um || low > kLongestWavelength_um)
      throw UserError(where, "the table goes from " + um(low) + " to " + um(high), "wavelengths within 0.1 to 1000 um", "there is nothing to draw with it");
    const auto between = [](const Row& a, const Row& b, double at) {
      Row row = a;
      const double t = (at - a.values[0]) / (b.values[0] - a.values[0]);
      for (std::size_t c = 1; c < row.values.size(); ++c) row.values[c] += t * (b.values[c] - a.values[c]);
      row.values[0] = at;
      return row;
    };
    std::vector<Row> kept;
    std::size_t out = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double w = rows[k].values[0];
      const bool inside = w >= kShortestWavelength_um && w <= kLongestWavelength_um;
      for (double end : {kShortestWavelength_um, kLongestWavelength_um})
        if (k > 0 && rows[k - 1].values[0] < end && w > end) kept.push_back(between(rows[k - 1], rows[k], end));
      if (inside) kept.push_back(rows[k]);
      else ++out;
    }
    if (out > 0)
      note(std::to_string(out) + " of " + std::to_string(rows.size()) + " rows (the table goes from " + um(low) + " to " + um(high) +
           ") lie beyond the spectral axis, 0.1 to 1000 um, and are left out");
    return kept;
  }

  void addTable(std::vector<Row> rows, bool n, bool k, const Value& type) {
    refuseSecond(n, k, type);
    rows = ordered(std::move(rows));
    if (rows.size() > kMostSpectrumRows)
      throw UserError(rows[kMostSpectrumRows].where, "the table goes on after " + std::to_string(kMostSpectrumRows) + " rows", "at most that many",
                      "thin it out");
    for (const Row& row : rows) {
      if (n && !(row.values[1] > 0.0 && row.values[1] <= kLargestIndex))
        throw UserError(row.where, "n is " + exactNumber(row.values[1]) + " at " + um(row.values[0]), "n above 0, up to 1000", "correct or remove the row");
      const double absorbs = row.values.back();
      if (k && !(absorbs >= 0.0 && absorbs <= kLargestIndex))
        throw UserError(row.where, "k is " + exactNumber(absorbs) + " at " + um(row.values[0]) + (absorbs < 0.0 ? ": light would grow on its way" : ""),
                        "k from 0 to 1000",
                        absorbs < 0.0 ? "write 0 where it is noise about 0; turn the sign of a table of n - ik" : "correct or remove the row");
    }
    std::vector<std::vector<double>> values;
    for (const Row& row : rows) values.push_back(row.values);
    const double low = rows.front().values[0], high = rows.back().values[0];
    if (n) nLow_ = low, nHigh_ = high;
    if (k) kLow_ = low, kHigh_ = high, kWhere_ = type.where;
    if (n && k && rows.size() > 1) n_ = "  table:\n    " + rowsOfNumbers(values) + "\n", kInTable_ = true;
    else if (n && k) n_ = spectrum("n", {{low, values[0][1]}}), k_ = spectrum("k", {{low, values[0][2]}});
    else (n ? n_ : k_) = spectrum(n ? "n" : "k", values);
  }

  static std::string spectrum(const char* key, const std::vector<std::vector<double>>& rows) {
    return std::string("  ") + key + ": {wavelength: um, unit: \"1\", values: " + rowsOfNumbers(rows) + "}\n";
  }

  void refuseSecond(bool n, bool k, const Value& type) const {
    const bool second = n && !n_.empty();
    if (second || (k && (!k_.empty() || kInTable_)))
      throw UserError(type.where, std::string("'") + type.text + "' gives " + (second ? "n" : "k") + " a second time", "n once and k once",
                      "keep the one that you want, and remove the other part from the file");
  }

  void addFormula(const Value& part, const Value& type, int number) {
    refuseSecond(true, false, type);
    const Value& coefficients = need(part, type, "coefficients");
    Location inText = coefficients.where;
    DispersionFormula formula{number, {}};
    std::string flat = coefficients.text;
    std::replace(flat.begin(), flat.end(), '\n', ' ');
    for (std::string_view rest = flat; (rest = rest.substr(std::min(rest.find_first_not_of(" \t\r"), rest.size()))).size() > 0;) {
      const std::size_t end = std::min(rest.find_first_of(" \t\r"), rest.size());
      formula.c.push_back(numberAt(rest.substr(0, end), inText));
      rest.remove_prefix(end);
    }
    checkCoefficients(formula, inText);
    const Value& written = need(part, type, part.find("wavelength_range") ? "wavelength_range" : "range");
    const auto range = rowsOf(written, 2).front();
    double low = range.values[0], high = range.values[1];
    if (!(low < high))
      throw UserError(written.where, "a range from " + um(low) + " to " + um(high), "a shorter wavelength, then a longer one", "exchange them");
    if (high <= kShortestWavelength_um || low >= kLongestWavelength_um)
      throw UserError(written.where, "the formula holds from " + um(low) + " to " + um(high), "wavelengths within 0.1 to 1000 um",
                      "there is nothing to draw with it");
    if (low < kShortestWavelength_um || high > kLongestWavelength_um)
      note("the formula holds from " + um(low) + " to " + um(high) + "; the spectral axis goes from 0.1 to 1000 um");
    low = std::max(low, kShortestWavelength_um), high = std::min(high, kLongestWavelength_um);
    n_ = indexOf(formula, low, high, coefficients.where);
    nLow_ = low, nHigh_ = high;
    if (n_.rfind("  n:", 0) == 0) note("formula " + std::to_string(number) + " as a table of n, lines between its rows off by 1e-6 at most");
  }

  const Value& tree_;
  std::string name_;
  std::vector<std::string> lines_, notes_;
  std::string n_, k_;
  bool kInTable_ = false;
  Location kWhere_;
  double nLow_ = 0.0, nHigh_ = 0.0, kLow_ = kShortestWavelength_um, kHigh_ = kLongestWavelength_um;
};

}  // namespace

ImportedMaterial importOpticalConstants(const Value& tree, const std::string& text, const std::string& name) { return Importer(tree, text, name).run(); }

}  // namespace pitviper
