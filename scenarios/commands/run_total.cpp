#include "scenarios/commands/run_total.hpp"

#include <algorithm>
#include <vector>

#include "sim/frame/mark_header.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

}  // namespace

void RunTotal::add(const Frame& f) {
  if (!f.kind.empty()) return;  // spectral images say nothing of errors
  static const std::string kError = "pitviper.predicted_error.";
  Seen& seen = cameras_[f.camera];
  ++seen.frames;
  for (const auto& [channel, tally] : markTallies(f))
    if (tally.full > 0) {
      Seen::Full& full = seen.full[channel];
      ++full.frames;
      full.most = std::max(full.most, static_cast<double>(tally.full) / (static_cast<double>(f.width) * f.height));
    }
  const bool isDraft = std::any_of(f.attributes.begin(), f.attributes.end(), [](const Attribute& a) { return a.name == "pitviper.draft"; });
  seen.drafts += isDraft;
  for (const Attribute& a : f.attributes) {
    if (a.name == "pitviper.mode") seen.mode = std::get<std::string>(a.value);
    if (a.name == "pitviper.accuracy") seen.accuracy = std::get<double>(a.value);
    if (a.name == "pitviper.exposure_parts") seen.parts = std::max(seen.parts, std::get<int>(a.value));
    if (a.name == "pitviper.exposure_motion_px") seen.motion_px = std::max(seen.motion_px, std::get<double>(a.value));
    if (a.name == "pitviper.exposure_error") seen.partError = std::max(seen.partError, std::get<double>(a.value));
    if (a.name == "pitviper.exposure_streak_error") seen.streakError = std::max(seen.streakError, std::get<double>(a.value));
    if (!a.name.starts_with(kError)) continue;
    if (isDraft) seen.draftError = std::max(seen.draftError, std::get<double>(a.value));
    if (isDraft) continue;
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
    if (seen.drafts < seen.frames && seen.accuracy > 0.0) text += " to " + print("%.3g %%", 100.0 * seen.accuracy);
    std::string errors;
    for (const auto& [channel, error] : seen.error) errors += (errors.empty() ? "" : ", ") + channel + " " + print("%.2g %%", 100.0 * error);
    if (!errors.empty()) text += "; expected error at most " + errors;
    else if (seen.drafts < seen.frames && seen.mode == "sampled") text += "; no accuracy asked for, no error expected";
    if (seen.drafts > 0)
      text += "; " + std::to_string(seen.drafts) + " of " + std::to_string(seen.frames) + " frames by a draft, expected error at most " +
              print("%.2g %%", 100.0 * seen.draftError);
    if (seen.parts > 1)
      text += "; exposures in up to " + std::to_string(seen.parts) + " parts (" + print("%.3g pixels", seen.motion_px) + " of motion; " +
              print("%.2g %%", 100.0 * seen.partError) + " of an edge's contrast at most" +
              (seen.streakError > 0.0 ? ", " + print("%.2g %%", 100.0 * seen.streakError) + " of a small body's streak" : "") + ")";
    text += "\n";
    for (const auto& [channel, full] : seen.full)
      text += "  " + camera + ": " + channel + " is full in " + std::to_string(full.frames) + " of " + std::to_string(seen.frames) + " frames, " +
              print("%.3g %%", 100.0 * full.most) + " of a frame's pixels at most\n";
  }
  return text;
}

std::string auditText(const RunReport& report) {
  std::string text;
  for (const auto& [camera, t] : report.audits) {
    std::vector<double> sorted = t.errors;
    std::sort(sorted.begin(), sorted.end());
    text += print("  %s: audited %d pixel%s of %d frame%s against the reference: median %.2g %%, largest %.2g %% (%s)", camera.c_str(), t.pixels,
                  t.pixels == 1 ? "" : "s", t.frames, t.frames == 1 ? "" : "s", 100.0 * sorted[sorted.size() / 2], 100.0 * t.largest, t.channel.c_str());
    if (t.asked > 0.0) {
      text += print(" of %.2g %% asked%s", 100.0 * t.asked, t.largest > t.asked ? ": MORE THAN ASKED, those frames say so" : "");
    }
    text += "\n";
    if (t.whole.empty()) continue;
    sorted = t.whole;
    std::sort(sorted.begin(), sorted.end());
    text += print("  %s: with its geometry, against 32x32 places a pixel: median %.2g %%, largest %.2g %% (standard error up to %.2g %%)\n", camera.c_str(),
                  100.0 * sorted[sorted.size() / 2], 100.0 * sorted.back(), 100.0 * t.wholeError);
  }
  return text;
}

}  // namespace pitviper
