#pragma once
// What a run or a stream leaves of what was flown: history.csv, encounters.csv, and a picture of the trajectories.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/commands/run_sinks.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/run/encounters.hpp"
#include "sim/run/history.hpp"

namespace pitviper {

/// What is to be written of it.
struct HistoryWish {
  bool tables = false;    ///< history.csv and encounters.csv
  bool picture = false;   ///< trajectories.png
  bool mustDraw = false;  ///< it was asked for by itself: without VTK the run is refused before it begins
  bool none = false;      ///< no tables were asked for
  /// Of a run: tables unless told otherwise, a picture with a report or where asked for; nothing where nothing moves.
  /// Errors: UserError where a picture is asked for and nothing moves, or there is no VTK.
  void settle(const Simulation& simulation, bool reports);
};

/// What came of it, for the report.
struct HistoryReport {
  std::vector<Encounter> encounters;
  std::filesystem::path picture;  ///< empty: there is none
  std::string whyNoPicture;       ///< empty: there is one, or none was wished for
};

/// The files, from the first tick to the last.
class HistoryFiles {
 public:
  /// The folder must exist. Errors: OutputError.
  HistoryFiles(const Simulation& simulation, const std::filesystem::path& folder, const HistoryWish& wish);
  static OwnFiles filesIn(const std::filesystem::path& folder, const HistoryWish& wish);
  void look(const Camera& camera, const Frame& frame, const WorldState& world, const Pose& pose);
  /// A tick of a scenario without cameras.
  void look(int frame, const WorldState& world);
  /// Gives the files their names. A history of the same scenario that has these rows and more stays: a run of some frames again says nothing new.
  /// `title`: of the picture. Errors: OutputError, and what `mayReplace` throws.
  HistoryReport write(const std::string& title, const MayReplace& mayReplace);

 private:
  void append();
  const Simulation& simulation_;
  std::filesystem::path folder_;
  HistoryWish wish_;
  History history_;
  std::optional<GrowingFile> file_;
  std::string waiting_;  ///< not yet in the file
  std::string rows_;     ///< all of them, while they are few
  bool few_ = true;
  double first_s_ = 0.0, last_s_ = 0.0;
  bool begun_ = false;
};

}  // namespace pitviper
