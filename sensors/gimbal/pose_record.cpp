#include "sensors/gimbal/pose_record.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "sim/parameters/csv_separators.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

constexpr std::array<const char*, 4> kDrivers = {"truth", "centroid", "commands", "poses"};
constexpr std::string_view kHeader = "time_s,frame,qw,qx,qy,qz,x_m,y_m,z_m,azimuth_rad,elevation_rad,driver,locked";
constexpr std::size_t kCells = 13;
constexpr double kUnit = 1e-9;  // of a unit quaternion that double has rounded 1e-15 is left, of one written with ten digits 1e-10

struct Cell {
  std::string_view text;
  Location where;
};

std::vector<Cell> cellsOf(std::string_view line, Location where) {
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::string_view text = line.substr(begin, end - begin);
    where.column = static_cast<int>(begin) + 1;
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1), ++where.column;
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    cells.push_back({text, where});
    begin = end + 1;
  }
  return cells;
}

template <class T>
T numberOf(const Cell& cell, const char* expected) {
  T value{};
  const char* end = cell.text.data() + cell.text.size();
  const auto [stopped, error] = std::from_chars(cell.text.data(), end, value);
  bool sound = error == std::errc() && stopped == end;
  if constexpr (std::is_floating_point_v<T>) sound = sound && std::isfinite(value);
  if (!sound) throw UserError(cell.where, "not " + std::string(expected) + ": " + tokenOf(cell.text), expected, "correct or remove the line");
  return value;
}

PoseRow rowOf(const std::vector<Cell>& cells) {
  const auto number = [&](std::size_t i) { return numberOf<double>(cells[i], "a finite number"); };
  PoseRow row;
  row.time_s = number(0);
  row.frame = numberOf<std::int64_t>(cells[1], "a whole number");
  row.pose.orientation = glm::dquat(number(2), number(3), number(4), number(5));
  row.pose.position = {number(6), number(7), number(8)};
  row.angle_rad = {number(9), number(10)};
  if (const double length = glm::length(row.pose.orientation); std::abs(length - 1.0) > kUnit)
    throw UserError(cells[2].where, "a quaternion of length " + std::to_string(length), "length 1", "write qw to qz with all their digits");
  const auto driver = gimbalDriverOf(cells[11].text);
  if (!driver)
    throw UserError(cells[11].where, "no driver is called " + tokenOf(cells[11].text), listed({kDrivers.begin(), kDrivers.end()}), "correct the name");
  row.driver = *driver;
  if (cells[12].text != "0" && cells[12].text != "1") throw UserError(cells[12].where, "not a lock: " + tokenOf(cells[12].text), "0 or 1", "correct it");
  row.locked = cells[12].text == "1";
  return row;
}

}  // namespace

const char* nameOf(GimbalDriver driver) { return kDrivers[static_cast<std::size_t>(driver)]; }

std::optional<GimbalDriver> gimbalDriverOf(std::string_view name) {
  const auto found = std::find(kDrivers.begin(), kDrivers.end(), name);
  if (found == kDrivers.end()) return std::nullopt;
  return static_cast<GimbalDriver>(found - kDrivers.begin());
}

std::string posesFileName(std::string_view camera) { return std::string(camera) + "_poses.csv"; }

std::string posesHeader() { return std::string(kHeader) + "\n"; }

std::string poseLine(const PoseRow& row) {
  std::string line;
  const auto add = [&](double v) { line += print("%.17g,", v); };
  const glm::dquat& q = row.pose.orientation;
  add(row.time_s);
  line += std::to_string(row.frame) + ",";
  for (const double v : {q.w, q.x, q.y, q.z, row.pose.position.x, row.pose.position.y, row.pose.position.z, row.angle_rad.x, row.angle_rad.y}) add(v);
  return line + nameOf(row.driver) + (row.locked ? ",1\n" : ",0\n");
}

const PoseRow& PoseRecord::ofFrame(std::int64_t frame, const Location& where) const {
  const auto found = std::lower_bound(rows.begin(), rows.end(), frame, [](const PoseRow& row, std::int64_t f) { return row.frame < f; });
  if (found == rows.end() || found->frame != frame) {
    const std::string held = rows.empty() ? "no frames" : "frames from " + std::to_string(rows.front().frame) + " to " + std::to_string(rows.back().frame);
    throw UserError(where, "frame " + std::to_string(frame) + " is not in the poses of " + file, "one of its " + held, "choose such a frame, or record it");
  }
  return *found;
}

PoseRecord posesOf(std::string_view rest, const std::string& file) {
  PoseRecord record{file, {}};
  bool hasHeader = false;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);  // as spreadsheets write it
  for (Location where{file, 1, 1, -1}; !rest.empty(); ++where.line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() || line[0] == '#') continue;
    refuseOtherSeparators(line, where);
    const auto cells = cellsOf(line, where);
    if (!hasHeader) {
      const auto wanted = cellsOf(kHeader, where);
      for (std::size_t i = 0; i < kCells; ++i)
        if (i >= cells.size() || cells[i].text != wanted[i].text || cells.size() > kCells)
          throw UserError(i < cells.size() ? cells[i].where : cells.back().where, "not the header of a record of poses", std::string(kHeader), "write it so");
      hasHeader = true;
      continue;
    }
    if (cells.size() != kCells)
      throw UserError(where, "a row of " + std::to_string(cells.size()) + " cells", std::to_string(kCells) + ", as the header has",
                      fixOfCells(cells.size(), kCells));
    record.rows.push_back(rowOf(cells));
    if (record.rows.size() < 2) continue;
    const PoseRow &before = record.rows[record.rows.size() - 2], &row = record.rows.back();
    if (!(row.time_s > before.time_s)) throw UserError(cells[0].where, "a time that does not rise", "more than in the row before", "sort the rows");
    if (!(row.frame > before.frame)) throw UserError(cells[1].where, "a frame that does not rise", "more than in the row before", "sort the rows");
  }
  if (record.rows.empty()) throw UserError({file, 1, 1, -1}, "no poses", "a header and rows", "record them by a run");
  return record;
}

PoseRecord readPoses(const std::filesystem::path& file, const Location& askedAt) {
  FileWanted wanted;
  wanted.what = "a CSV file with poses";
  return posesOf(readWholeFile(file, wanted, askedAt), file.string());
}

}  // namespace pitviper
