#include "sim/flight/trajectory_csv.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/flight/flight_axes.hpp"
#include "sim/parameters/csv_separators.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/table.hpp"
#include "sim/parameters/units.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kMostRows = 1000000;  // 112 MB of points
constexpr std::uintmax_t kMostBytes = 256u << 20;
constexpr std::size_t kMostLine = 4096;  // all columns with 17 digits take a tenth of it

constexpr double kMost = 1e9;            // m: beyond the moon; s: 30 years
constexpr double kLeastTime_s = 1e-6;    // with kMost, velocities stay far from overflow
constexpr double kUnitTolerance = 0.01;  // of a quaternion's length: four rounded to two digits
constexpr double kDegree = kPi / 180.0;

struct ColumnSet {
  const char* name;
  std::vector<const char*> columns;
};
const std::vector<ColumnSet> kPositions = {{"east, north, up", {"x_m", "y_m", "z_m"}},
                                           {"north, east, down", {"north_m", "east_m", "down_m"}},
                                           {"geodetic", {"latitude_deg", "longitude_deg", "height_m"}},
                                           {"earth-centred", {"ecef_x_m", "ecef_y_m", "ecef_z_m"}}};
const std::vector<ColumnSet> kAttitudes = {{"angles", {"heading_deg", "pitch_deg", "roll_deg"}},
                                           {"a quaternion", {"qw", "qx", "qy", "qz"}},
                                           {"a quaternion in north, east, down", {"ned_qw", "ned_qx", "ned_qy", "ned_qz"}}};
enum PositionKind : std::size_t { kLocal, kNed, kGeodetic, kEcef };
enum AttitudeKind : std::size_t { kAngles, kQuaternion, kNedQuaternion };

struct Cell {
  std::string_view text;
  int column;  ///< of its first character
};

/// Without blanks at its ends.
std::vector<Cell> cellsOf(std::string_view line) {
  std::vector<Cell> all;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::size_t first = begin, last = end;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    all.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    begin = end + 1;
  }
  return all;
}

std::vector<std::string> allNames() {
  std::vector<std::string> names{"time_s"};
  for (const auto* sets : {&kPositions, &kAttitudes})
    for (const ColumnSet& set : *sets) names.insert(names.end(), set.columns.begin(), set.columns.end());
  return names;
}

struct Header {
  std::vector<std::string> names;
  std::vector<Location> wheres;
  std::size_t time = 0;
  std::optional<std::size_t> position, attitude;    ///< which set
  std::vector<std::size_t> positionAt, attitudeAt;  ///< its columns

  std::optional<std::size_t> find(std::string_view name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - names.begin()));
  }
};

/// Which of the sets a header has, all of its columns there.
std::optional<std::size_t> setOf(const Header& header, const std::vector<ColumnSet>& sets, std::vector<std::size_t>& at) {
  std::optional<std::size_t> found;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    std::vector<std::size_t> columns;
    std::optional<std::string> missing;
    for (const char* name : sets[s].columns) {
      if (const auto column = header.find(name)) columns.push_back(*column);
      else if (!missing) missing = name;
    }
    if (columns.empty()) continue;
    const std::vector<std::string> all(sets[s].columns.begin(), sets[s].columns.end());
    if (missing) throw UserError(header.wheres[columns[0]], "a column '" + *missing + "' is missing", listed(all), "add it");
    if (found) throw UserError(header.wheres[columns[0]], std::string(sets[s].name) + " given beside " + sets[*found].name, "one of them", "leave one out");
    found = s;
    at = columns;
  }
  return found;
}

Header headerOf(std::string_view line, const Location& where) {
  Header header;
  const std::vector<std::string> known = allNames();
  for (const Cell& cell : cellsOf(line)) {
    const Location at{where.file, where.line, cell.column, -1};
    const std::string name(cell.text);
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw UserError(at, "there is no column " + tokenOf(cell.text), "names of " + listed(known), didYouMean(name, known, "remove or rename it"));
    if (header.find(name)) throw UserError(at, "a second column '" + name + "'", "each once", "remove one");
    header.names.push_back(name);
    header.wheres.push_back(at);
  }
  const auto time = header.find("time_s");
  if (!time) throw UserError(where, "there is no column 'time_s'", "the time of each row", "add it");
  header.time = *time;
  header.position = setOf(header, kPositions, header.positionAt);
  if (!header.position)
    throw UserError(where, "there is no position",
                    "x_m, y_m, z_m | north_m, east_m, down_m | latitude_deg, longitude_deg, height_m | ecef_x_m, ecef_y_m, ecef_z_m", "add one of these");
  header.attitude = setOf(header, kAttitudes, header.attitudeAt);
  return header;
}

class Rows {
 public:
  Rows(const Header& header, const LocalFrame& frame, const std::string& file)
      : header_(header), frame_(frame), file_(file), localFromEcef_(glm::transpose(frame.ecefFromLocal())) {}

  void read(std::string_view line, int number) {
    const Location where{file_, number, 1, -1};
    cells_ = cellsOf(line);
    if (cells_.size() != header_.names.size())
      throw UserError(where, "a row of " + std::to_string(cells_.size()) + " cells", std::to_string(header_.names.size()) + ", as the header has columns",
                      fixOfCells(cells_.size(), header_.names.size()));
    if (points.size() == kMostRows)
      throw UserError(where, "the trajectory goes on after " + std::to_string(kMostRows) + " rows", "at most that many", "thin it out");
    line_ = number;
    values_.clear();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const auto q = splitQuantity(cells_[i].text);
      if (!q || !q->unit.empty()) throw UserError(whereOf(i), "not a finite number: " + tokenOf(cells_[i].text), "a number", "correct or remove the line");
      if (std::abs(q->value) > kMost) throw UserError(whereOf(i), "too large: " + tokenOf(cells_[i].text), "1e9 at most", "check its unit");
      values_.push_back(q->value);
    }
    TrajectoryPoint p;
    p.time_s = values_[header_.time];
    if (!points.empty() && !(p.time_s - points.back().time_s >= kLeastTime_s))
      throw UserError(whereOf(header_.time), "time goes back or stands: " + tokenOf(cells_[header_.time].text), "more than the row before it",
                      "put rows in order, and each time once");
    Geodetic place;
    p.position = positionOf(place);
    if (header_.attitude) p.orientation = orientationOf(place);
    points.push_back(p);
  }

  std::vector<TrajectoryPoint> points;

 private:
  Location whereOf(std::size_t column) const { return {file_, line_, cells_[column].column, -1}; }
  double position(std::size_t i) const { return values_[header_.positionAt[i]]; }
  double attitude(std::size_t i) const { return values_[header_.attitudeAt[i]]; }
  void within(double most, std::size_t column) const {
    if (std::abs(values_[column]) > most)
      throw UserError(whereOf(column), "out of range: " + tokenOf(cells_[column].text), "at most " + std::to_string(static_cast<int>(most)) + " deg either way",
                      "check the order of the columns");
  }

  glm::dvec3 positionOf(Geodetic& place) const {
    switch (*header_.position) {
      case kLocal:
        return {position(0), position(1), position(2)};
      case kNed:
        return {position(1), position(0), -position(2)};
      case kGeodetic:
        within(90.0, header_.positionAt[0]);
        within(360.0, header_.positionAt[1]);
        place = {position(0) * kDegree, position(1) * kDegree, position(2)};
        return frame_.toLocal(place);
      default: {
        const glm::dvec3 local = frame_.fromEcef({position(0), position(1), position(2)});
        place = frame_.toGeodetic(local);
        return local;
      }
    }
  }

  glm::dquat orientationOf(const Geodetic& place) const {
    if (*header_.attitude == kAngles) {
      const glm::dquat own = orientationFrom({attitude(0) * kDegree, attitude(1) * kDegree, attitude(2) * kDegree});
      if (*header_.position == kLocal || *header_.position == kNed) return own;
      return glm::normalize(glm::quat_cast(localFromEcef_ * LocalFrame(place).ecefFromLocal()) * own);
    }
    const glm::dquat q(attitude(0), attitude(1), attitude(2), attitude(3));
    const double length = glm::length(q);
    if (!(std::abs(length - 1.0) <= kUnitTolerance))
      throw UserError(whereOf(header_.attitudeAt[0]), "a quaternion of length " + std::to_string(length), "1 within a hundredth",
                      "check the order of its columns; w is the real part");
    if (*header_.attitude == kQuaternion) return q / length;
    // Left is -right and up is -down: half a turn about x. North, east, down and east, north, up: half a turn about their middle (1, 1, 0).
    const double half = std::sqrt(0.5);
    return glm::dquat(0.0, half, half, 0.0) * (q / length) * glm::dquat(0.0, 1.0, 0.0, 0.0);
  }

  const Header& header_;
  const LocalFrame& frame_;
  std::string file_;
  glm::dmat3 localFromEcef_;
  std::vector<Cell> cells_;
  std::vector<double> values_;
  int line_ = 0;
};

/// Slopes of the parabola through a point and its neighbours; at ends through the three last ones.
void addVelocities(std::vector<TrajectoryPoint>& points) {
  const std::size_t n = points.size();
  if (n < 2) return;
  const auto time = [&](std::size_t i) { return points[i + 1].time_s - points[i].time_s; };
  const auto slope = [&](std::size_t i) { return (points[i + 1].position - points[i].position) / time(i); };
  for (std::size_t i = 1; i + 1 < n; ++i) points[i].velocity = (slope(i - 1) * time(i) + slope(i) * time(i - 1)) / (time(i - 1) + time(i));
  if (n == 2) {
    points[0].velocity = points[1].velocity = slope(0);
    return;
  }
  points[0].velocity = slope(0) + (slope(0) - slope(1)) * (time(0) / (time(0) + time(1)));
  points[n - 1].velocity = slope(n - 2) + (slope(n - 2) - slope(n - 3)) * (time(n - 2) / (time(n - 2) + time(n - 3)));
}

/// Along the path; where a body stands, as it came, or as it will go where it has not come.
void addOrientations(std::vector<TrajectoryPoint>& points, const LocalFrame& frame) {
  const auto moving = [](const TrajectoryPoint& p) { return glm::length(p.velocity) > 0.0; };
  const auto first = std::find_if(points.begin(), points.end(), moving);
  if (first == points.end()) return;
  glm::dvec3 ahead = first->velocity;
  for (TrajectoryPoint& p : points) {
    if (moving(p)) ahead = p.velocity;
    p.orientation = orientationWithTop(ahead, frame.up(p.position));
  }
}

}  // namespace

Trajectory readTrajectoryCsv(const std::filesystem::path& file, const LocalFrame& frame, AtEnd before, AtEnd after, const Location& askedAt) {
  const FileWanted wanted{"a CSV file with a trajectory", kMostBytes, "check the path and its permissions", "thin the trajectory out"};
  const std::string bytes = readWholeFile(file, wanted, askedAt);
  std::string_view rest = bytes;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);  // as spreadsheets write it
  std::optional<Header> header;
  std::optional<Rows> rows;
  Location where{file.string(), 1, 1, -1};
  for (; !rest.empty(); ++where.line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.size() > kMostLine)
      throw UserError(where, "a line of " + std::to_string(line.size()) + " characters", "4096 at most", "check that it is a CSV file");
    if (line.find_first_not_of(" \t") == std::string_view::npos || line[0] == '#') continue;
    refuseOtherSeparators(line, where);
    if (!header) {
      header = headerOf(line, where);
      rows.emplace(*header, frame, where.file);
    } else {
      rows->read(line, where.line);
    }
  }
  if (!header) throw UserError({where.file, 1, 1, -1}, "the file is empty", "a header and rows", "write 'time_s, x_m, y_m, z_m' and rows under it");
  if (rows->points.empty()) throw UserError(where, "no row follows the header", "one at least", "write rows of numbers");
  addVelocities(rows->points);
  if (!header->attitude) addOrientations(rows->points, frame);
  return Trajectory(std::move(rows->points), before, after, Trajectory::Interpolation::Cubic);
}

}  // namespace pitviper
