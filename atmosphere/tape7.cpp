#include "atmosphere/tape7.hpp"

#include <algorithm>

#include "atmosphere/tape7_cards.hpp"
#include "atmosphere/tape7_layout.hpp"
#include "atmosphere/tape7_rows.hpp"

namespace pitviper {
namespace {

using tape7::Field;
using tape7::Line;

bool isEnd(const Line& line) { return line.trimmed().rfind("-9999", 0) == 0; }

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
  static constexpr const char* kOwnTape7 = "give MODTRAN's own tape7, in wavenumbers, not one turned into wavelengths";

  void addRow(const Line& line) {
    if (line.trimmed().empty())
      throw UserError(line.at(1), "a blank line in the table", "a row, or -9999. at its end", "remove the line, or copy the file again");
    const auto v = tape7::numberIn(line, fields_[0]);
    if (!v)
      throw UserError(line.at(1), "no wavenumber in columns 1-" + std::to_string(fields_[0].last), "a wavenumber in cm-1, or -9999. at the table's end",
                      kCopyAgain);
    beginRow(line, *v);
    for (size_t i = 1; i < fields_.size(); ++i) addValue(line, fields_[i], run_.columns[i - 1]);
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

  void beginRow(const Line& line, double v) {
    const std::string found = tape7::inQuotes(line.cut(1, fields_[0].last));
    if (!rows_.wavenumbers().empty() && v == rows_.wavenumbers().back())
      throw UserError(line.at(1), "the wavenumber " + found + " does not rise: it stands twice, as with several lines of sight in one run, which are not read",
                      "rising wavenumbers in cm-1", tape7::kOneLineOfSight);
    rows_.begin(v, line.at(1), found);
    if (!tape7::inBand(run_, v))
      throw UserError(line.at(1), "the wavenumber " + found + " lies outside the band of the run's card 4, line " + std::to_string(run_.bandLine),
                      "cm-1 from V1 to V2 of that card", kOwnTape7);
  }

  void addValue(const Line& line, const Field& field, Tape7Column& column) const {
    if (const auto found = tape7::numberIn(line, field)) {
      rows_.add(column, *found, line.at(field.first), tape7::inQuotes(line.cut(field.first, field.last)));
      return;
    }
    if (&column == &run_.columns.front())
      throw UserError(line.at(field.first),
                      "no total transmittance (" + field.name + ") in columns " + std::to_string(field.first) + "-" + std::to_string(field.last), "a number",
                      kCopyAgain);
    rows_.addGap(column, line.number);
  }

  void finish(const Line& end) {
    if (rows_.wavenumbers().empty()) throw UserError(end.at(1), "run " + std::to_string(run_.number) + " has no rows", "a row for each wavenumber", kCopyAgain);
    rows_.finish();
  }

  const std::vector<Line>& lines_;
  Tape7Run& run_;
  std::vector<Field> fields_;
  tape7::Rows rows_{run_, kOwnTape7, kCopyAgain};
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

}  // namespace pitviper
