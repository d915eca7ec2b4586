// A camera on a lab bench: figures from its pictures alone, beside those of its design.
#include <cmath>
#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/html_page.hpp"
#include "scenarios/commands/measure_bench.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/sensor_report.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/frame/version.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

std::string print(const char* format, auto... values) {
  char text[300];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string offOf(const BenchFigure& f) {
  if (f.absolute) return print("%+.3g", f.measured - f.design);
  if (f.design == 0.0) return f.error > 0.0 ? print("%.1f standard errors", f.measured / f.error) : "";
  return print("%+.2f %%", 100.0 * (f.measured / f.design - 1.0)) + (f.error > 0.0 ? print(" (%.1f standard errors)", std::abs(f.measured - f.design) / f.error) : "");
}

std::vector<std::string> cellsOf(const BenchFigure& f) {
  return {f.name + (f.unit == "1" ? "" : " [" + f.unit + "]"), print("%.5g", f.design), print("%.5g", f.measured), offOf(f)};
}

int wholeOption(const Options& o, const char* name, int otherwise, int least, int most) {
  if (!o.has(name)) return otherwise;
  const auto [a, b] = readRange(o.value(name), name);
  if (a != b || a < least || a > most)
    throw UserError({name + std::string(" ") + o.value(name), 0, 0, -1}, "no such number", "a whole number from " + std::to_string(least) + " to " + std::to_string(most),
                    "write " + std::string(name) + " " + std::to_string(otherwise));
  return static_cast<int>(a);
}

constexpr const char* kTableHead = "channel,figure,unit,design,measured,standard error\n";

/// Only what it has written itself is written again.
void refuseOthers(const fs::path& file, const std::string& begins) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return;
  const std::string start = readFileStart(file, 400);
  if (start.find(begins) == std::string::npos)
    throw UserError({file.string(), 0, 0, -1}, "is there already and was not written by measure", "a folder without such a file", "give another --out");
}

}  // namespace

int measureCommand(const Arguments& arguments) {
  const Options o("measure", arguments, {{"--out"}, {"--frames"}, {"--film"}, {"--set", true, true}}, 1, 1);
  const std::string word = o.words()[0];
  const fs::path file = word;
  const bool isFile = file.extension() == ".yaml" || file.extension() == ".yml";
  BenchOptions options;
  options.base = isFile ? fs::absolute(file).parent_path().string() : ".";
  options.camera = isFile ? "  sensor: {file: \"" + fs::absolute(file).string() + "\"}\n" : "  sensor: " + word + "\n";
  options.frames = wholeOption(o, "--frames", options.frames, 4, 4096);
  options.film_px = wholeOption(o, "--film", options.film_px, 64, 1024);
  for (const std::string& change : o.values("--set")) options.changes.push_back("cameras.bench." + change);
  const std::string name = isFile ? file.stem().string() : word;
  const fs::path out = o.value("--out");
  if (!out.empty()) {
    refuseOthers(out / (name + ".csv"), kTableHead);
    refuseOthers(out / (name + ".html"), std::string("pitviper ") + kVersion + " measure");
  }
  const GlContext context;
  std::vector<BenchResult> results;
  {
    Progress progress("measure " + word, 1);
    results = measureCamera(options, [&](const std::string& what, double share) { progress.phase(what, share); });
    progress.withdraw();
  }
  HtmlPage page(name + " on the bench", std::string("pitviper ") + kVersion + " measure");
  page.paragraph(print("%d frames of each flat field, %d x %d pixels in the middle of the film, %g frames a second. Measured: from the pictures alone. Design: from the camera's own figures.",
                       options.frames, options.film_px, options.film_px, 1.0 / options.step_s));
  std::string csv = kTableHead;
  for (const BenchResult& r : results) {
    std::printf("%s, %s: %d frames of %d x %d pixels, flat fields at %.4g K\n", name.c_str(), r.channel.c_str(), options.frames, options.film_px, options.film_px,
                r.temperature_K);
    std::printf("  %-46s %13s %13s  %s\n", "", "design", "measured", "off");
    std::vector<std::vector<std::string>> rows;
    for (const BenchFigure& f : r.figures) {
      rows.push_back(cellsOf(f));
      std::printf("  %-46s %13s %13s  %s\n", rows.back()[0].c_str(), rows.back()[1].c_str(), rows.back()[2].c_str(), rows.back()[3].c_str());
      csv += r.channel + ",\"" + f.name + "\"," + f.unit + "," + print("%.9g,%.9g,%.9g\n", f.design, f.measured, f.error);
    }
    for (const std::string& note : r.notes) std::printf("  note: %s\n", note.c_str());
    page.heading("Channel " + r.channel + print(", flat fields at %.4g K", r.temperature_K));
    page.table({"figure", "design", "measured", "off"}, rows);
    for (const std::string& note : r.notes) page.paragraph(note);
    if (out.empty()) continue;
    ensureWritableFolder(out);
    const fs::path charts = out / (name + "_" + r.channel + ".png");
    drawCharts(r.charts, 2, charts);
    page.picture(charts, "Charts of channel " + r.channel);
  }
  if (out.empty()) return 0;
  writeFileAtomically(out / (name + ".csv"), csv);
  page.write(out / (name + ".html"));
  std::printf("%s, %s, charts\n", (out / (name + ".html")).c_str(), (out / (name + ".csv")).c_str());
  return 0;
}

}  // namespace pitviper
