#include "scenarios/commands/run_timing.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace pitviper {

std::string timingText(const std::map<std::string, double>& parts, double files_s, int frames) {
  char line[160];
  double sum = 0.0, preparing = 0.0;
  std::vector<std::pair<double, std::string>> longest;
  for (const auto& [name, seconds] : parts) {
    if (name.starts_with(kPreparing)) {
      preparing += seconds;
      continue;
    }
    sum += seconds;
    longest.emplace_back(seconds, name);
  }
  std::sort(longest.rbegin(), longest.rend());
  std::snprintf(line, sizeof line, "Time, each part waited for: preparing %.3g s, then %.4g ms a frame, %.4g frames a second:\n", preparing,
                1e3 * sum / frames, sum > 0.0 ? frames / sum : 0.0);
  std::string text = line;
  constexpr double kWorthALine = 1e-3;
  double rest = 0.0;
  const auto add = [&](const std::string& name, double seconds) {
    std::snprintf(line, sizeof line, "  %-28s %9.3f ms %6.1f %%\n", name.c_str(), 1e3 * seconds / frames, sum > 0.0 ? 100.0 * seconds / sum : 0.0);
    text += line;
  };
  for (const auto& [seconds, name] : longest)
    if (seconds >= kWorthALine * sum) add(name, seconds);
    else rest += seconds;
  if (rest > 0.0) add("all others", rest);
  std::snprintf(line, sizeof line, "  %-28s %9.3f ms beside drawing\n", "files", 1e3 * files_s / frames);
  return text + line;
}

}  // namespace pitviper
