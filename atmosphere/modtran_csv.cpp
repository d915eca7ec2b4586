#include "atmosphere/modtran_csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "atmosphere/csv_columns.hpp"
#include "atmosphere/modtran_names.hpp"
#include "atmosphere/tape7_rows.hpp"
#include "sim/parameters/csv_separators.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

const char* const kAgain = "give the file as MODTRAN wrote it, or its JSON or tape7";
/// Its numbers are those of a float as text.
constexpr double kResolution = 1e-6;
/// More than MODTRAN writes before the names.
constexpr size_t kMostHeader = 40, kMostHeaderBytes = 1 << 16;

using Cells = std::vector<csv::Cell>;

std::optional<double> numberOf(const csv::Cell& cell) {
  double v = 0.0;
  const auto [end, error] = std::from_chars(cell.text.data(), cell.text.data() + cell.text.size(), v);
  if (error != std::errc() || end != cell.text.data() + cell.text.size()) return std::nullopt;
  return v;
}

/// Beside the wavenumber, the whole transmittance and another of MODTRAN's.
bool isNames(const Cells& cells, bool transmittance) {
  bool whole = false;
  size_t known = 0;
  for (const csv::Cell& cell : cells)
    if (const auto name = tape7Name(cell.text, transmittance)) {
      ++known;
      whole = whole || *name == (transmittance ? "COMBIN_TRANS" : "TOT_TRANS");
    }
  return whole && known >= 2;
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : lines_(csv::linesOf(text)), file_(file) {}

  Tape7Run read() {
    run_.file = file_;
    run_.resolution = kResolution;
    run_.model = 7;
    // Of the path nothing is said: the user knows how long it is.
    run_.geometry.path = Tape7Path::Slant;
    readNames();
    bool ended = false;
    while (next()) {
      const Cells cells = csv::cellsOf(line_);
      const bool numbers = numberOf(cells.front()).has_value();
      if (!numbers || cells.size() < 2) {
        if (rows_.wavenumbers().empty()) checkUnits(cells);
        else ended = ended || !(cells.size() == 1 && cells.front().text.empty());
        continue;
      }
      if (ended)
        fail(cells.front().column, "a second table: several cases in one file", "one case, for its range is not in the file",
             "give the JSON output of these cases");
      readRow(cells);
    }
    if (rows_.wavenumbers().empty()) fail(1, "no rows below the names", "a row for each wavenumber", kAgain);
    rows_.finish();
    return std::move(run_);
  }

 private:
  [[noreturn]] void fail(int column, const std::string& wrong, const std::string& expected, const std::string& fix) const {
    throw UserError({file_, std::max(number_, 1), column, -1}, wrong, expected, fix);
  }

  bool next() {
    if (static_cast<size_t>(number_) >= lines_.size()) return false;
    line_ = lines_[static_cast<size_t>(number_++)];
    return true;
  }

  void readNames() {
    Cells names;
    bool transmittance = false, found = false;
    while (!found && next()) {
      names = csv::cellsOf(line_);
      transmittance = isNames(names, true);
      found = transmittance || isNames(names, false);
    }
    run_.line = run_.bandLine = number_;
    for (size_t i = 1; i < names.size(); ++i) {
      const auto name = tape7Name(names[i].text, transmittance);
      if (!name && !names[i].text.empty() && names[i].text.size() < 2) fail(names[i].column, "a column without a name", "MODTRAN's names", kAgain);
      place_.push_back(name ? run_.columns.size() : kLeftOut);
      if (name) run_.columns.push_back({*name, transmittance ? Tape7Quantity::Transmittance : tape7::radianceQuantity(*name), {}, names[i].column});
    }
    checkUnits(names);
    const bool sunny = run_.find("SING_SCAT") || run_.find("SOL_SCAT");
    run_.kind = transmittance ? Tape7Kind::Transmittance : sunny ? Tape7Kind::SolarRadiance : Tape7Kind::ThermalRadiance;
  }

  /// Of what the first column is; wavelengths have radiances of another kind.
  void checkUnits(const Cells& cells) const {
    std::string first(cells.front().text);
    std::transform(first.begin(), first.end(), first.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* wrong : {"wavel", "micron", "micrometer", "um", "nm", "nanometer"})
      if (first.find(wrong) != std::string::npos)
        fail(cells.front().column, tokenOf(cells.front().text) + ": a table over wavelength", "wavenumbers in cm-1", "run MODTRAN with XFLAG = W");
  }

  void readRow(const Cells& cells) {
    const size_t wanted = place_.size() + 1;
    if (cells.size() != wanted && !(cells.size() == wanted + 1 && cells.back().text.empty()))
      fail(1, "a row of " + std::to_string(cells.size()) + " cells", std::to_string(wanted) + ", as line " + std::to_string(run_.bandLine) + " has names",
           fixOfCells(cells.size(), wanted));
    if (run_.dataLine == 0) run_.dataLine = number_;
    if (number_ != run_.dataLine + static_cast<int>(rows_.wavenumbers().size()))
      fail(1, "a line between the rows above", "rows that follow one another", kAgain);
    rows_.begin(*numberOf(cells.front()), {file_, number_, cells.front().column, -1}, tokenOf(cells.front().text));
    for (size_t i = 1; i < wanted; ++i) {
      if (place_[i - 1] == kLeftOut) continue;
      Tape7Column& column = run_.columns[place_[i - 1]];
      const csv::Cell& cell = cells[i];
      const Location at{file_, number_, cell.column, -1};
      if (cell.text.empty()) {
        rows_.addGap(column, number_);
        continue;
      }
      const auto value = numberOf(cell);
      if (!value) throw UserError(at, tokenOf(cell.text) + " for " + column.name + " is not a number", "a number such as 0.93 or 1.2e-3", kAgain);
      rows_.add(column, *value, at, tokenOf(cell.text));
    }
  }

  static constexpr size_t kLeftOut = static_cast<size_t>(-1);

  csv::Lines lines_;
  std::string_view line_;
  int number_ = 0;  ///< of the line
  const std::string& file_;
  Tape7Run run_;
  std::vector<size_t> place_;  ///< of each cell behind the first: its column
  tape7::Rows rows_{run_, "give MODTRAN's own file, in rising wavenumbers", kAgain};
};

}  // namespace

bool isModtranCsv(std::string_view text) {
  const auto lines = csv::linesOf(text.substr(0, kMostHeaderBytes));
  for (size_t i = 0; i < std::min(lines.size(), kMostHeader); ++i) {
    if (lines[i].find(',') == std::string_view::npos) continue;
    const Cells cells = csv::cellsOf(lines[i]);
    if (isNames(cells, true) || isNames(cells, false)) return true;
  }
  return false;
}

std::vector<Tape7Run> parseModtranCsv(std::string_view text, const std::string& name) {
  std::vector<Tape7Run> runs;
  runs.push_back(Reader(text, name).read());
  return runs;
}

}  // namespace pitviper
