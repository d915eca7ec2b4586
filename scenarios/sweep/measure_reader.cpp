#include "scenarios/sweep/measure_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "scenarios/reader/expression.hpp"
#include "scenarios/sweep/factor_reader.hpp"
#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

/// As targetTableHead() calls them.
const std::vector<std::string> kTruthColumns = {"column", "row", "left", "top", "right", "bottom", "range", "range rate", "sight right", "sight up", "visible"};
const std::vector<std::string> kTruthChannelColumns = {"own", "total", "contrast", "snr", "saturated"};
const std::vector<std::string> kStatisticWords = {"mean", "sigma", "min", "max", "median", "sum"};
constexpr long long kLargestFilm = 32768;

bool isAmong(const std::string& word, const std::vector<std::string>& words) { return std::find(words.begin(), words.end(), word) != words.end(); }

void checkTruthColumn(const std::string& column, const Location& where) {
  const std::size_t dot = column.rfind('.');
  if (dot == std::string::npos ? isAmong(column, kTruthColumns) : dot > 0 && isAmong(column.substr(dot + 1), kTruthChannelColumns)) return;
  const std::string channel = dot == std::string::npos ? "CHANNEL" : column.substr(0, dot);
  std::vector<std::string> names = kTruthColumns;
  for (const std::string& own : kTruthChannelColumns) names.push_back(channel + "." + own);
  throw unknownWord(where, "the truth table has no column", column, names, "take one of its columns, without its unit");
}

void checkStatistic(const std::string& word, const Location& where) {
  if (isAmong(word, kStatisticWords)) return;
  double percent = -1.0;
  const char* const end = word.data() + word.size();
  if (word.starts_with('p')) {
    const auto [last, error] = std::from_chars(word.data() + 1, end, percent, std::chars_format::fixed);
    if (error == std::errc() && last == end && percent >= 0.0 && percent <= 100.0) return;
  }
  throw UserError(where, "there is no statistic " + tokenOf(word), "one of " + listed(kStatisticWords) + ", or a percentile p0 to p100 such as p99.5",
                  didYouMean(word, kStatisticWords, "choose one"));
}

std::vector<int> readPixelRegion(const Value& list) {
  std::vector<int> region;
  for (const Value& item : list.items) {
    const double v = readNumber(item, "", "a number of pixels");
    const bool size = region.size() >= 2;
    if (v != std::floor(v) || v < (size ? 1.0 : 0.0) || v > kLargestFilm)
      throw UserError(item.where, std::string(size ? "a size of " : "a place of ") + item.text + " pixels",
                      size ? "a whole number, at least 1" : "a whole number, at least 0", "write region: [left, top, width, height]");
    region.push_back(static_cast<int>(v));
  }
  return region;
}

/// `names` and `units`.
void readColumns(const Record& r, Measure& m) {
  for (const Value& item : r.value("names").items) {
    m.names.push_back(readText(item, "a name"));
    checkColumnName(m.names.back(), item.where);
  }
  if (!r.given("units")) {
    m.units.assign(m.names.size(), "");
    return;
  }
  for (const Value& item : r.value("units").items) {
    m.units.push_back(readText(item, "a unit"));
    if (m.units.back().find_first_of(",[]\n\"") != std::string::npos)
      throw UserError(item.where, "a unit cannot be " + tokenOf(m.units.back()), "a unit without commas, quotes and brackets [ ]", "correct it");
    if (m.units.back() == "1" || m.units.back() == "-") m.units.back().clear();
  }
  if (m.units.size() != m.names.size())
    throw UserError(r.where("units"), std::to_string(m.units.size()) + " units of " + std::to_string(m.names.size()) + " names", "a unit for each name",
                    "write \"1\" for what has none");
}

}  // namespace

const ParameterTable& truthMeasureTable() {
  static const ParameterTable t{
      "measure of a target",
      "What the truth table says of a target in the picture.",
      {required(text("name", "its column in the results: letters, digits and '_'")), required(text("truth", "name of the target: an entity", &Measure::target)),
       required(text("value",
                     "column of the truth table without its unit: column, row, left, top, right, bottom, range, range rate, sight right, sight up, visible, "
                     "or own, total, contrast, snr, saturated of a channel: `mw.snr`",
                     &Measure::value)),
       text("camera", "the first unless given", &Measure::camera)}};
  return t;
}

const ParameterTable& statisticMeasureTable() {
  static const ParameterTable t{
      "measure of a layer",
      "A statistic of a layer's pixels.",
      {required(text("name", "its column in the results: letters, digits and '_'")),
       required(text("statistic", "mean, sigma, min, max, median, sum, or a percentile: `p99.5`", &Measure::statistic)),
       required(text("layer", "of the frame: `mw.radiance`", &Measure::layer)), text("camera", "the first unless given", &Measure::camera),
       list("region", "[left, top, width, height] in pixels; the whole film unless given", 4, 4)}};
  return t;
}

const ParameterTable& pythonMeasureTable() {
  static const ParameterTable t{
      "measure by Python",
      "What a function of the user's gives for a frame.",
      {required(text("python", "file, found from the sweep's folder")), required(text("function", "its name in that file", &Measure::function)),
       required(list("names", "of the numbers that it gives: a column each", 1, 1024)),
       list("units", "of these, \"1\" for none; all without unless given", 1, 1024), text("camera", "the first unless given", &Measure::camera)}};
  return t;
}

Measure readMeasure(const Value& entry, const std::filesystem::path& base) {
  asMap(entry, "a measure");
  std::string kind;
  for (const char* key : {"truth", "statistic", "python"}) {
    if (!entry.find(key)) continue;
    if (!kind.empty()) throw UserError(entry.where, "a measure has both '" + kind + "' and '" + key + "'", "one of the two", "write two measures");
    kind = key;
  }
  if (kind.empty())
    throw UserError(entry.where, "nothing says what the measure is", "one of truth, statistic, python", "write 'statistic: mean' and 'layer: mw.radiance'");
  Measure m;
  m.where = entry.where;
  if (kind == "python") {
    m.kind = Measure::Kind::Python;
    const Record r(entry, pythonMeasureTable());
    r.fill(m);
    if (nameLength(m.function) != m.function.size())
      throw UserError(r.where("function"), "a function cannot be called " + tokenOf(m.function), "a name of Python: letters, digits and '_'", "correct it");
    m.file = base / r.text("python");
    if (!std::filesystem::is_regular_file(m.file))
      throw UserError(r.where("python"), "there is no file '" + readable(m.file.string()) + "'", "a file of Python",
                      "check the name; it is found from the sweep's folder");
    readColumns(r, m);
    return m;
  }
  const bool truth = kind == "truth";
  m.kind = truth ? Measure::Kind::Truth : Measure::Kind::Statistic;
  const Record r(entry, truth ? truthMeasureTable() : statisticMeasureTable());
  r.fill(m);
  m.names = {r.text("name")};
  m.units = {""};
  checkColumnName(m.names[0], r.where("name"));
  if (truth) {
    checkTruthColumn(m.value, r.where("value"));
    return m;
  }
  checkStatistic(m.statistic, r.where("statistic"));
  if (const Value* region = r.find("region")) m.region = readPixelRegion(*region);
  return m;
}

}  // namespace pitviper
