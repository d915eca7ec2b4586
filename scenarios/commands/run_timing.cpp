#include "scenarios/commands/run_timing.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "sim/run/run.hpp"

namespace pitviper {

std::string timingText(const std::map<std::string, double>& parts, double files_s, int frames) {
  char line[160];
  double sum = 0.0, preparing = 0.0, first = 0.0;
  std::vector<std::pair<double, std::string>> longest;
  for (const auto& [name, seconds] : parts) {
    if (name.starts_with(kPreparingPart)) {
      preparing += seconds;
    } else if (name.starts_with(kFirstFramePart)) {
      first += seconds;
    } else {
      sum += seconds;
      longest.emplace_back(seconds, name);
    }
  }
  std::sort(longest.rbegin(), longest.rend());
  std::snprintf(line, sizeof line, "Time, each part waited for: preparing %.3g s, the first frame %.3g s", preparing, first);
  std::string text = line;
  const int later = frames - 1;
  if (later > 0) {
    std::snprintf(line, sizeof line, ", the others %.4g ms a frame, %.4g frames a second:\n", 1e3 * sum / later, sum > 0.0 ? later / sum : 0.0);
    text += line;
  } else {
    text += " (several frames show what each takes)\n";
  }
  constexpr double kWorthALine = 1e-3;
  double rest = 0.0;
  const auto add = [&](const std::string& name, double seconds) {
    std::snprintf(line, sizeof line, "  %-28s %9.3f ms %6.1f %%\n", name.c_str(), 1e3 * seconds / later, sum > 0.0 ? 100.0 * seconds / sum : 0.0);
    text += line;
  };
  for (const auto& [seconds, name] : longest) {
    if (later < 1) break;
    if (seconds >= kWorthALine * sum) add(name, seconds);
    else rest += seconds;
  }
  if (rest > 0.0) add("all others", rest);
  std::snprintf(line, sizeof line, "  %-28s %9.3f ms beside drawing\n", "files", 1e3 * files_s / frames);
  return text + line;
}

}  // namespace pitviper
