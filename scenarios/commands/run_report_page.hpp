#pragma once
// `report.html` of a run: all that somebody who was not there wants to know of it.
#include <map>
#include <string>
#include <vector>

#include "scenarios/commands/history_files.hpp"
#include "scenarios/commands/run_notes.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/frame/frame.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

class HtmlPage;

class RunReportPage {
 public:
  explicit RunReportPage(const Simulation& simulation) : simulation_(simulation) {}
  void add(const Frame& frame);
  struct Said {
    std::string summary;  ///< the run's last lines
    const Notes& notes;
    const HistoryReport* flown = nullptr;  ///< null: nothing moves, or it is not to be told
    bool tables = false;                   ///< history.csv is there
  };
  /// Puts in what lies in the folder: contact sheets, a film. Errors: OutputError.
  void write(const std::filesystem::path& folder, const std::string& video, const Said& said, const MayReplace& mayReplace) const;
  static std::filesystem::path fileIn(const std::filesystem::path& folder) { return folder / "report.html"; }

 private:
  static void tellFlown(HtmlPage& page, const Said& said);
  struct Course {
    std::string unit;
    std::vector<double> time_s, least, mean, most;
  };
  struct TargetCourse {
    std::vector<double> time_s, range_m, contrast, signalToNoise;
    std::string channel;
  };
  const Simulation& simulation_;
  std::map<std::string, std::map<std::string, Course>> layers_;         ///< by camera and layer
  std::map<std::string, std::map<std::string, TargetCourse>> targets_;  ///< by camera and target
};

}  // namespace pitviper
