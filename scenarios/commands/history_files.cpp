#include "scenarios/commands/history_files.hpp"

#include <stdexcept>

#include "scenarios/commands/charts.hpp"
#include "scenarios/commands/trajectory_scene.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

constexpr const char *kHistory = "history.csv", *kEncounters = "encounters.csv", *kPicture = "trajectories.png";
/// Rows are written in pieces of so many bytes: a system call each would cost more than making them.
constexpr std::size_t kPiece = 1u << 16;
/// Histories up to this size are held against what lies there.
constexpr std::size_t kFew = 1u << 22;

}  // namespace

void HistoryWish::settle(const Simulation& sim, bool reports) {
  const bool moves = hasHistory(sim);
  if (mustDraw) {
    if (!moves)
      throw UserError({"--trajectories", 0, 0, -1}, "nothing moves in this scenario", "a body, a lamp or a camera with 'motion'", "remove --trajectories");
    requireCharts();
  }
  tables = moves && !none;
  picture = moves && (mustDraw || reports);
}

OwnFiles HistoryFiles::filesIn(const std::filesystem::path& folder, const HistoryWish& wish) {
  OwnFiles files;
  if (wish.tables) files.push_back(folder / kHistory), files.push_back(folder / kEncounters);
  if (wish.picture) files.push_back(folder / kPicture);
  return files;
}

HistoryFiles::HistoryFiles(const Simulation& simulation, const std::filesystem::path& folder, const HistoryWish& wish)
    : simulation_(simulation), folder_(folder), wish_(wish), history_(simulation, wish.picture) {
  if (!wish_.tables) return;
  file_.emplace(folder_ / kHistory);
  file_->append(tableMark(simulation_) + History::head());
}

void HistoryFiles::append() {
  std::string lines = history_.take();
  if (!file_) return;
  if (few_) rows_ += lines;
  if (rows_.size() > kFew) few_ = false, rows_ = {};
  waiting_ += lines;
  if (waiting_.size() < kPiece) return;
  file_->append(waiting_);
  waiting_.clear();
}

void HistoryFiles::look(const Camera& camera, const Frame& frame, const WorldState& world, const Pose& pose) {
  if (!begun_) first_s_ = world.time_s;
  begun_ = true, last_s_ = world.time_s;
  history_.look(camera, frame, world, pose);
  append();
}

void HistoryFiles::look(int frame, const WorldState& world) {
  if (!begun_) first_s_ = world.time_s;
  begun_ = true, last_s_ = world.time_s;
  history_.look(frame, world);
  append();
}

HistoryReport HistoryFiles::write(const std::string& title, const MayReplace& mayReplace) {
  history_.finish();
  append();
  HistoryReport report;
  report.encounters = encountersOf(simulation_, first_s_, last_s_);
  if (file_) {
    file_->append(waiting_);
    waiting_.clear();
    const std::string before = tableMark(simulation_) + History::head();
    bool isThere = false;
    if (std::error_code ignored; few_ && std::filesystem::is_regular_file(folder_ / kHistory, ignored)) {
      try {
        const std::string old = readWholeFile(folder_ / kHistory, {});
        isThere = old.starts_with(before) && old.find("\n" + rows_) != old.npos;
      } catch (const UserError&) {
        // Too large or not to be read: whether it may be replaced is said below.
      }
    }
    if (!isThere) file_->keep(mayReplace);
    file_.reset();
    if (!report.encounters.empty()) writeFileAtomically(folder_ / kEncounters, tableMark(simulation_) + encountersText(report.encounters), mayReplace);
  }
  if (!wish_.picture) return report;
  if (last_s_ <= first_s_) {
    report.whyNoPicture = "a single frame shows no trajectories";
    return report;
  }
  try {
    drawTrajectories(flownScene(simulation_, history_, report.encounters, title), folder_ / kPicture,
                     {{kScenarioName, simulation_.name}, {kScenarioHash, simulation_.sha256}}, mayReplace);
    report.picture = folder_ / kPicture;
  } catch (const OutputError&) {
    throw;
  } catch (const UserError& e) {
    if (std::string(e.what()).find("charts") == std::string::npos) throw;  // whose file it is
    report.whyNoPicture = e.what();
  } catch (const std::runtime_error& e) {
    report.whyNoPicture = e.what();
  } catch (const std::invalid_argument& e) {
    report.whyNoPicture = e.what();
  }
  return report;
}

}  // namespace pitviper
