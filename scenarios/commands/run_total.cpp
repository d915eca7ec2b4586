#include "scenarios/commands/run_total.hpp"

#include <algorithm>
#include <cstdio>

namespace pitviper {
namespace {

std::string print(const char* format, double v) {
  char text[64];
  std::snprintf(text, sizeof text, format, v);
  return text;
}

}  // namespace

void RunTotal::add(const Frame& f) {
  if (!f.kind.empty()) return;  // spectral images say nothing of errors
  static const std::string kError = "pitviper.predicted_error.";
  Seen& seen = cameras_[f.camera];
  for (const Attribute& a : f.attributes) {
    if (a.name == "pitviper.mode") seen.mode = std::get<std::string>(a.value);
    if (a.name == "pitviper.accuracy") seen.accuracy = std::get<double>(a.value);
    if (!a.name.starts_with(kError)) continue;
    double& error = seen.error[a.name.substr(kError.size())];
    error = std::max(error, std::get<double>(a.value));
  }
}

std::string RunTotal::pace(int frames, double seconds) {
  return print("%.3g s", seconds) + (seconds > 0.0 ? print(", %.3g frames a second", frames / seconds) : "");
}

std::string RunTotal::expected() const {
  std::string text;
  for (const auto& [camera, seen] : cameras_) {
    text += "  " + camera + ": " + seen.mode;
    if (seen.accuracy > 0.0) text += " to " + print("%.3g %%", 100.0 * seen.accuracy);
    std::string errors;
    for (const auto& [channel, error] : seen.error) errors += (errors.empty() ? "" : ", ") + channel + " " + print("%.2g %%", 100.0 * error);
    if (!errors.empty()) text += "; expected error at most " + errors;
    else if (seen.mode == "sampled") text += "; no accuracy asked for, no error expected";
    text += "\n";
  }
  return text;
}

}  // namespace pitviper
