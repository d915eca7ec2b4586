#include "atmosphere/tape7.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/tape7_cards.hpp"
#include "atmosphere/tape7_layout.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {
namespace {

using tape7::Field;
using tape7::Line;

// Four decimals round to within 0.00005; what is filtered over wavenumber may add a little. A per cent or a shifted column is far beyond.
constexpr double kMostTransmittance = 1.001;
/// A run of 5000 1/cm by 1 1/cm has 1 MB.
constexpr std::uintmax_t kLargestFile = 64u << 20;

bool isEnd(const Line& line) { return line.trimmed().rfind("-9999", 0) == 0; }

/// W/(cm2 cm-1) to W/(m2 um), both also per sr: with nu = 1e4/lambda, 1e4 cm2/m2 times |dnu/dlambda| = nu^2/1e4 cm-1/um.
bool isPerWavenumber(Tape7Quantity q) { return q == Tape7Quantity::Radiance || q == Tape7Quantity::Irradiance; }

class RunReader {
 public:
  RunReader(const std::vector<Line>& lines, Tape7Run& run) : lines_(lines), run_(run) {}

  /// Reads the run whose card 1 is at `card`; gives the place behind its -9999.
  size_t read(size_t card) {
    tape7::readFirstCard(lines_[card], run_);
    size_t at = card + 1;
    while (at < lines_.size() && !tape7::isNames(lines_[at]) && !isEnd(lines_[at])) ++at;
    if (at == lines_.size() || isEnd(lines_[at]))
      throw UserError(lines_[at == lines_.size() ? at - 1 : at].at(1), "the run's header is cut: no line with the names of columns (FREQ ...)",
                      "ten lines of cards and the names", kCopyAgain);
    tape7::readOtherCards(lines_, card, at, run_);
    const tape7::Layout layout = tape7::layoutOf(run_.kind, lines_, at);
    fields_ = layout.fields;
    at += static_cast<size_t>(layout.nameLines);
    if (at < lines_.size()) run_.dataLine = lines_[at].number;
    run_.columns.resize(fields_.size() - 1);
    for (size_t i = 1; i < fields_.size(); ++i) {
      run_.columns[i - 1].name = fields_[i].name;
      run_.columns[i - 1].quantity = fields_[i].quantity;
      run_.columns[i - 1].firstColumn = fields_[i].first;
    }
    const auto end = std::find_if(lines_.begin() + static_cast<std::ptrdiff_t>(at), lines_.end(), isEnd);
    if (end == lines_.end())
      throw UserError(lines_.back().at(1), "the file is cut short: run " + std::to_string(run_.number) + " has no -9999. behind its rows",
                      "a line -9999. at its end", kCopyAgain);
    for (; !isEnd(lines_[at]); ++at) addRow(lines_[at]);
    finish(*end);
    return at + 1;
  }

 private:
  static constexpr const char* kCopyAgain = "copy the whole file again, or run MODTRAN again";

  void addRow(const Line& line) {
    if (line.trimmed().empty())
      throw UserError(line.at(1), "a blank line in the table", "a row, or -9999. at its end", "remove the line, or copy the file again");
    const auto v = tape7::numberIn(line, fields_[0]);
    if (!v)
      throw UserError(line.at(1), "no wavenumber in columns 1-" + std::to_string(fields_[0].last), "a wavenumber in cm-1, or -9999. at the table's end",
                      kCopyAgain);
    checkWavenumber(line, *v);
    wavenumber_.push_back(*v);
    for (size_t i = 1; i < fields_.size(); ++i) addValue(line, fields_[i], run_.columns[i - 1], *v);
    checkGaps(line);  // last: a field that is wrong says more
  }

  /// Nothing but blanks where no field is.
  void checkGaps(const Line& line) const {
    int end = 0;
    const auto check = [&](int first, int last) {
      const std::string_view gap = line.cut(first, last);
      if (const size_t i = gap.find_first_not_of(' '); i != std::string_view::npos)
        throw UserError(line.at(first + static_cast<int>(i)), tape7::inQuotes(gap) + " stands outside the columns of this run", "a blank there",
                        "give the file as MODTRAN wrote it, its columns unchanged");
    };
    for (const Field& f : fields_) {
      check(end + 1, f.first - 1);
      end = f.last;
    }
    check(end + 1, static_cast<int>(line.text.size()));
  }

  void checkWavenumber(const Line& line, double v) const {
    const char* const fix = "give MODTRAN's own tape7, in wavenumbers, not one turned into wavelengths";
    const std::string found = tape7::inQuotes(line.cut(1, fields_[0].last));
    if (!wavenumber_.empty() && v == wavenumber_.back())
      throw UserError(line.at(1), "the wavenumber " + found + " does not rise: it stands twice, as with several lines of sight in one run, which are not read",
                      "rising wavenumbers in cm-1", tape7::kOneLineOfSight);
    if (!wavenumber_.empty() && !(v > wavenumber_.back()))
      throw UserError(line.at(1), "the wavenumber " + found + " does not rise", "rising wavenumbers in cm-1", fix);
    if (!tape7::inBand(run_, v))
      throw UserError(line.at(1), "the wavenumber " + found + " lies outside the band of the run's card 4, line " + std::to_string(run_.bandLine),
                      "cm-1 from V1 to V2 of that card", fix);
    if (v < 1e4 / kLongestWavelength_um || v > 1e4 / kShortestWavelength_um)
      throw UserError(line.at(1), "the wavenumber " + found + " lies beyond the spectral axis", "10 to 100000 cm-1 (1000 to 0.1 um)",
                      "run MODTRAN with V1 and V2 within it");
  }

  void addValue(const Line& line, const Field& field, Tape7Column& column, double v) const {
    const auto found = tape7::numberIn(line, field);
    if (!found) {
      if (&column == &run_.columns.front())
        throw UserError(line.at(field.first),
                        "no total transmittance (" + field.name + ") in columns " + std::to_string(field.first) + "-" + std::to_string(field.last), "a number",
                        kCopyAgain);
      if (column.gapLine == 0) column.gapLine = line.number;
      column.value.push_back(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    if (field.quantity == Tape7Quantity::Transmittance && (*found < 0.0 || *found > kMostTransmittance))
      throw UserError(line.at(field.first), "the transmittance " + field.name + " is " + tape7::inQuotes(line.cut(field.first, field.last)), "0 to 1",
                      "give MODTRAN's own tape7: per cent, or columns shifted, are not read");
    const double value = isPerWavenumber(field.quantity) ? *found * v * v : *found;
    if (!std::isfinite(value))
      throw UserError(line.at(field.first), tape7::inQuotes(line.cut(field.first, field.last)) + " for " + field.name + " is too large",
                      "a radiance or irradiance", kCopyAgain);
    column.value.push_back(value);
  }

  /// Leaves out what was not computed, and turns everything from rising wavenumber to rising wavelength.
  void finish(const Line& end) {
    if (wavenumber_.empty()) throw UserError(end.at(1), "run " + std::to_string(run_.number) + " has no rows", "a row for each wavenumber", kCopyAgain);
    std::erase_if(run_.columns, [](const Tape7Column& c) { return std::all_of(c.value.begin(), c.value.end(), [](double x) { return std::isnan(x); }); });
    for (Tape7Column& c : run_.columns) std::reverse(c.value.begin(), c.value.end());
    run_.wavelength_um.reserve(wavenumber_.size());
    for (auto v = wavenumber_.rbegin(); v != wavenumber_.rend(); ++v) run_.wavelength_um.push_back(1e4 / *v);
  }

  const std::vector<Line>& lines_;
  Tape7Run& run_;
  std::vector<Field> fields_;
  std::vector<double> wavenumber_;
};

}  // namespace

const char* unitOf(Tape7Quantity quantity) {
  switch (quantity) {
    case Tape7Quantity::Radiance:
      return "W/(m2 sr um)";
    case Tape7Quantity::Irradiance:
      return "W/(m2 um)";
    case Tape7Quantity::Temperature:
      return "K";
    case Tape7Quantity::Unknown:
      return "as written";
    default:
      return "";
  }
}

const Tape7Column* Tape7Run::find(std::string_view name) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const Tape7Column& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

std::vector<Tape7Run> parseTape7(std::string_view text, const std::string& name) {
  const std::vector<Line> lines = tape7::linesOf(text, name);
  std::vector<Tape7Run> runs;
  size_t at = 0;
  while (at < lines.size()) {
    // Blank lines may only follow a run.
    if (!runs.empty() && lines[at].trimmed().empty()) {
      ++at;
      continue;
    }
    Tape7Run& run = runs.emplace_back();
    run.file = name;
    run.number = static_cast<int>(runs.size());
    at = RunReader(lines, run).read(at);
  }
  return runs;
}

std::vector<Tape7Run> readTape7(const std::filesystem::path& path) {
  return parseTape7(readWholeFile(path, {.what = "a tape7 of MODTRAN", .mostBytes = kLargestFile, .fix = "check its name"}), path.string());
}

}  // namespace pitviper
