// A camera on a lab bench: figures from its pictures alone, beside those of its design.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "scenarios/commands/band_air.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/dri_report.hpp"
#include "scenarios/commands/html_page.hpp"
#include "scenarios/commands/measure_bench.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/scenario_wish.hpp"
#include "scenarios/commands/sensor_report.hpp"
#include "sim/frame/version.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

std::string offOf(const BenchFigure& f) {
  if (f.absolute) return print("%+.3g", f.measured - f.design);
  if (f.design == 0.0) return f.error > 0.0 ? print("%.1f standard errors", f.measured / f.error) : "";
  return print("%+.2f %%", 100.0 * (f.measured / f.design - 1.0)) +
         (f.error > 0.0 ? print(" (%.1f standard errors)", std::abs(f.measured - f.design) / f.error) : "");
}

std::vector<std::string> cellsOf(const BenchFigure& f) {
  return {f.name + (f.unit == "1" ? "" : " [" + f.unit + "]"), print("%.5g", f.design), print("%.5g", f.measured), offOf(f)};
}

/// "2.3x2.3", in metres.
void readTarget(const std::string& text, const Location& where, AcquiredTarget& t) {
  const auto x = text.find('x');
  char* end = nullptr;
  t.width_m = std::strtod(text.c_str(), &end);
  bool sound = x != std::string::npos && end == text.c_str() + x;
  if (sound) t.height_m = std::strtod(text.c_str() + x + 1, &end), sound = *end == '\0' && end != text.c_str() + x + 1;
  const auto isSize = [](double v) { return v >= 1e-3 && v <= 1e4; };
  if (!sound || !isSize(t.width_m) || !isSize(t.height_m))
    throw UserError(where, "not a target's size", "width x height in metres, from 0.001 to 10000 each", "write --target 2.3x2.3");
}

std::string lined(const std::vector<std::string>& cells) {
  std::string line = print("  %-16s", cells[0].c_str());
  for (std::size_t k = 1; k < cells.size(); ++k) line += print(" %15s", cells[k].c_str());
  return line;
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

struct MeasureWish {
  BenchOptions bench;
  std::vector<std::string> changes;
  ScenarioWish world;  ///< whose air ranges are through
  AcquiredTarget target;
  double alarms_per_hour = 1.0;
  std::string out;
};

int measure(MeasureWish& w, const std::string& word) {
  const fs::path file = word;
  const bool isFile = file.extension() == ".yaml" || file.extension() == ".yml";
  BenchOptions& options = w.bench;
  options.base = isFile ? fs::absolute(file).parent_path().string() : ".";
  options.camera = isFile ? "  sensor: {file: \"" + fs::absolute(file).string() + "\"}\n" : "  sensor: " + word + "\n";
  for (const std::string& change : w.changes) options.changes.push_back("cameras.bench." + change);
  const DriWish wish{w.world.file, w.target, w.alarms_per_hour};
  std::optional<Simulation> world;
  if (!w.world.file.empty()) world = w.world.read();
  const std::string name = isFile ? file.stem().string() : word;
  const fs::path out = w.out;
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
  page.paragraph(
      print("%d frames of each flat field, %d x %d pixels in the middle of the film, %g frames a second. Measured: from the pictures alone. Design: from the "
            "camera's own figures.",
            options.frames, options.film_px, options.film_px, 1.0 / options.step_s));
  std::string csv = kTableHead;
  for (const BenchResult& r : results) {
    std::printf("%s, %s: %d frames of %d x %d pixels, flat fields at %.4g K\n", name.c_str(), r.channel.c_str(), options.frames, options.film_px,
                options.film_px, r.temperature_K);
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
    std::optional<DriReport> dri;
    if (world && !r.sight.seesHeat)
      std::printf("  no ranges: they are of heat, and a body of 300 K gives channel %s next to nothing, or too much\n", r.channel.c_str());
    if (world && r.sight.seesHeat) {
      if (const double most = 0.1 * 3600.0 * r.sight.pixels_per_s; wish.alarms_per_hour > most)
        throw UserError({print("--false-alarms %g", wish.alarms_per_hour), 0, 0, -1}, "more than every tenth pixel",
                        print("at most %g an hour of this film", most), "ask for fewer");
      const BandAir air(*world, r.sight.output, r.temperature_K);
      const std::string aboutAir = print("air of %s from %.4g m up, %.3g deg above the level, transmittance %.3g at 1 km and %.3g at 10 km",
                                         wish.scenario.c_str(), air.height_m(), air.elevation_rad() * 180.0 / kPi, air.at(1e3), air.at(1e4));
      dri = driReport(
          r, wish, [&](double range_m) { return air.at(range_m); }, aboutAir);
      std::printf("  %s\n%s\n", dri->about.c_str(), lined(dri->rangeHead).c_str());
      for (const auto& row : dri->ranges) std::printf("%s\n", lined(row).c_str());
      std::printf("  %s\n%s\n", dri->aboutSpot.c_str(), lined(dri->spotHead).c_str());
      for (const auto& row : dri->spots) std::printf("%s\n", lined(row).c_str());
      page.heading("Detection, recognition, identification: channel " + r.channel);
      page.paragraph(dri->about);
      page.table(dri->rangeHead, dri->ranges);
      page.paragraph(dri->aboutSpot);
      page.table(dri->spotHead, dri->spots);
    }
    if (out.empty()) continue;
    ensureWritableFolder(out);
    const fs::path charts = out / (name + "_" + r.channel + ".png");
    drawCharts(r.charts, 2, charts);
    page.picture(charts, "Charts of channel " + r.channel);
    if (!dri) continue;
    const fs::path ranges = out / (name + "_" + r.channel + "_ranges.png");
    drawCharts(dri->charts, 2, ranges);
    page.picture(ranges, "Ranges of channel " + r.channel);
  }
  if (out.empty()) return 0;
  writeFileAtomically(out / (name + ".csv"), csv);
  page.write(out / (name + ".html"));
  std::printf("%s, %s, charts\n", (out / (name + ".html")).c_str(), (out / (name + ".csv")).c_str());
  return 0;
}

}  // namespace

CommandLine measureCommand() {
  const auto w = std::make_shared<MeasureWish>();
  const auto target = [w](const std::string& text, const Location& where) { readTarget(text, where, w->target); };
  return {{"measure", "NAME|CAMERA.yaml", "a camera on a lab bench: SiTF, NETD, noise, MTF, gain, well, point response from its pictures, beside its design"},
          "Draws flat fields, levels from dark to full, a slanted edge (ISO 12233), a point in a pixel's middle, edge and corner, and four-bar targets through "
          "a camera of the library, or one in a file with a key 'camera', whose channels have 'output: counts'; and measures from these pictures alone: SiTF, "
          "NETD, the seven components of three-dimensional noise with their standard errors, gain by photon transfer, full well, linearity, MTF, a pixel's "
          "share of a star, the bars' contrast, what a star is to send for its signal to be its noise, and the MRTD over frequency (FLIR92 with an eye's own "
          "threshold). Flat fields are at 300 K, or where the detector is half full if 300 K give it next to nothing.",
          {{"--frames", "N", "of each flat field", number(w->bench.frames, {4, 4096})},
           {"--film", "N", "a side of the square in the film's middle that is measured", number(w->bench.film_px, {64, 1024})},
           {"--set", "KEY=VALUE...", "a key of the camera: --set exposure='2 ms'", into(w->changes)},
           {"--ranges", "SCENARIO.yaml",
            "also how far a target is detected, recognised and identified through this scenario's air, along the line of sight of its first camera: by "
            "Johnson's cycles (STANAG 4347: 1, 3 and 6) and by TTP (V50 2, 7.5 and 13); and as a spot: its TNR, and how far a threshold finds it",
            into(w->world.file)},
           {"--target", "WxH", "metres (default 2.3x2.3, STANAG 4347)", {target}, "--ranges"},
           {"--contrast", "'T K'", "of the target over what is around it, which is as hot as the flat fields", number(w->target.difference_K, {1e-6, 1e4, "K"}),
            "--ranges"},
           {"--false-alarms", "N", "an hour, over the film, of the threshold for spots", number(w->alarms_per_hour, {1e-6, 1e6, ""}), "--ranges"},
           rootOption(w->world, "--ranges"),
           {"--out", "FOLDER", "also NAME.html, a page with charts (needs VTK), NAME.csv and the charts; created if missing", into(w->out)}},
          [w](const Arguments& words) { return measure(*w, words[0]); }};
}

}  // namespace pitviper
