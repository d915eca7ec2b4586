#include "scenarios/commands/run_timing.hpp"

#include <algorithm>
#include <vector>

#include "sim/camera/camera_renderer.hpp"
#include "sim/parameters/print.hpp"
#include "sim/run/run.hpp"

namespace pitviper {

std::string stageOf(const std::string& part) {
  const bool preparing = part.starts_with(kPreparingPart);
  if (!preparing && !part.starts_with(kFirstFramePart)) return "";
  if (part.find(kProgramsPart) != std::string::npos) return "programs";
  if (part.find(kPlanningPart) != std::string::npos) return "planning";
  return preparing ? "tables" : "first_frame";
}

std::string timingText(const std::map<std::string, double>& parts, const ProgramCount& programs, double files_s, int frames) {
  double sum = 0.0;
  std::map<std::string, double> once{{"planning", 0.0}, {"tables", 0.0}, {"programs", 0.0}, {"first_frame", 0.0}};
  std::vector<std::pair<double, std::string>> longest;
  for (const auto& [name, seconds] : parts) {
    if (const std::string stage = stageOf(name); !stage.empty()) {
      once[stage] += seconds;
    } else {
      sum += seconds;
      longest.emplace_back(seconds, name);
    }
  }
  std::sort(longest.rbegin(), longest.rend());
  std::string text = print("Time, each part waited for: planning %.3g s, tables %.3g s, %ld programs of %ld lines %.3g s, the first frame %.3g s",
                           once["planning"], once["tables"], programs.programs, programs.lines, once["programs"], once["first_frame"]);
  const int later = frames - 1;
  if (later > 0) {
    text += print(", the others %.4g ms a frame, %.4g frames a second:\n", 1e3 * sum / later, sum > 0.0 ? later / sum : 0.0);
  } else {
    text += " (several frames show what each takes)\n";
  }
  constexpr double kWorthALine = 1e-3;
  double rest = 0.0;
  const auto add = [&](const std::string& name, double seconds) {
    text += print("  %-28s %9.3f ms %6.1f %%\n", name.c_str(), 1e3 * seconds / later, sum > 0.0 ? 100.0 * seconds / sum : 0.0);
  };
  for (const auto& [seconds, name] : longest) {
    if (later < 1) break;
    if (seconds >= kWorthALine * sum) add(name, seconds);
    else rest += seconds;
  }
  if (rest > 0.0) add("all others", rest);
  return text + print("  %-28s %9.3f ms beside drawing\n", "files", 1e3 * files_s / frames);
}

}  // namespace pitviper
