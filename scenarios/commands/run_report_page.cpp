#include "scenarios/commands/run_report_page.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/commands/html_page.hpp"
#include "scenarios/commands/plan_report.hpp"
#include "scenarios/commands/sensor_report.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/stream/picture_sink.hpp"

namespace pitviper {
namespace {

/// More bodies than these make no chart that anybody reads.
constexpr std::size_t kMostTargets = 8;

}  // namespace

void RunReportPage::add(const Frame& frame) {
  if (!frame.kind.empty()) return;
  for (const FrameLayer& l : frame.layers) {
    if (l.name.starts_with("truth.")) continue;
    Course& c = layers_[frame.camera][l.name];
    c.unit = l.unit;
    double sum = 0.0, least = INFINITY, most = -INFINITY;
    for (float v : l.pixels) {
      const double value = static_cast<double>(v);
      sum += value, least = std::min(least, value), most = std::max(most, value);
    }
    c.time_s.push_back(frame.time_s);
    c.least.push_back(least), c.mean.push_back(sum / static_cast<double>(l.pixels.size())), c.most.push_back(most);
  }
  for (const TargetRow& t : frame.targets) {
    TargetCourse& c = targets_[frame.camera][t.name];
    c.time_s.push_back(frame.time_s);
    c.range_m.push_back(t.range_m);
    if (t.channels.empty()) continue;
    c.channel = t.channels.front().channel;
    c.contrast.push_back(t.channels.front().contrast);
    c.signalToNoise.push_back(t.channels.front().signalToNoise);
  }
}

void RunReportPage::tellFlown(HtmlPage& page, const Said& said) {
  page.heading("What was flown");
  const HistoryReport& flown = *said.flown;
  if (!flown.picture.empty())
    page.picture(flown.picture, "Trajectories: balls at equal times, shadows on the floor, the closest approach and lines of sight then");
  else if (!flown.whyNoPicture.empty()) page.paragraph("No picture of the trajectories: " + flown.whyNoPicture);
  if (!flown.encounters.empty()) {
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMostRows = 40;  // more is read in the table beside the page
    for (const Encounter& e : flown.encounters) {
      if (rows.size() >= kMostRows) break;
      rows.push_back({e.kind == "camera" ? "camera " + e.body : e.body, e.target, print("%.4g", e.distance_m), print("%.6g", e.time_s), e.passed ? "yes" : "no",
                      print("%.4g", e.relativeSpeed_m_s), std::isfinite(e.aspect_rad) ? print("%.1f", e.aspect_rad * 180.0 / kPi) : "", e.end});
    }
    page.table({"who", "to", "closest approach [m]", "at [s]", "passed", "relative speed [m/s]", "aspect [deg]", "flight ended by"}, rows);
    if (flown.encounters.size() > rows.size()) page.paragraph("and " + std::to_string(flown.encounters.size() - rows.size()) + " more");
    page.paragraph(
        "Not passed: the least distance of the time looked at, at one of its ends. Aspect: between the target's nose and where the other comes from (a camera: "
        "is), 0 head-on, 180 from behind.");
  }
  if (!said.tables) return;
  page.link("history.csv", "history.csv: positions, velocities, accelerations, attitudes and rates, tick by tick");
  if (!flown.encounters.empty()) page.link("encounters.csv", "encounters.csv: closest approaches with positions");
}

void RunReportPage::write(const std::filesystem::path& folder, const std::string& video, const Said& said, const MayReplace& mayReplace) const {
  const Simulation& sim = simulation_;
  HtmlPage page(sim.name, ownerMark(sim));
  page.lines(said.summary);
  if (!said.notes.all().empty()) {
    page.heading("Notes and warnings");
    for (const std::string& note : said.notes.all()) page.paragraph(note);
  }
  if (said.flown) tellFlown(page, said);
  for (const Camera& c : sim.cameras) {
    page.heading("Camera " + c.name);
    if (std::error_code ignored; std::filesystem::exists(folder / contactSheetOf(c.name), ignored))
      page.picture(folder / contactSheetOf(c.name), "Pictures evenly over the run, all on one scale: the first layer");
    if (!video.empty()) {
      const std::filesystem::path film = video;
      page.link(sim.cameras.size() == 1 ? video : film.stem().string() + "_" + c.name + film.extension().string(), "The film, beside this page");
    }
    std::vector<std::vector<std::string>> rows;
    std::vector<Chart> charts;
    const auto layers = layers_.find(c.name);
    if (layers != layers_.end())
      for (const auto& [name, course] : layers->second) {
        double sum = 0.0;
        for (double v : course.mean) sum += v;
        rows.push_back({name, course.unit, print("%.5g", *std::min_element(course.least.begin(), course.least.end())),
                        print("%.5g", sum / static_cast<double>(course.mean.size())),
                        print("%.5g", *std::max_element(course.most.begin(), course.most.end()))});
        if (course.time_s.size() > 1)
          charts.push_back({name,
                            "time [s]",
                            course.unit,
                            false,
                            false,
                            false,
                            {{"mean", course.time_s, course.mean, false, false},
                             {"smallest", course.time_s, course.least, true, false},
                             {"largest", course.time_s, course.most, true, false}},
                            {},
                            {}});
      }
    if (!rows.empty()) page.table({"layer", "unit", "smallest", "mean", "largest"}, rows);
    if (const auto targets = targets_.find(c.name); targets != targets_.end()) {
      Chart ranges{"Range of targets", "time [s]", "m", false, false, true, {}, {}, {}},
          contrasts{"Contrast of targets", "time [s]", "W/sr", false, false, false, {}, {}, {}};
      for (const auto& [name, course] : targets->second) {
        if (ranges.series.size() >= kMostTargets || course.time_s.size() < 2) break;
        ranges.series.push_back({name, course.time_s, course.range_m, false, false});
        if (course.contrast.size() != course.time_s.size()) continue;
        contrasts.series.push_back({name, course.time_s, course.contrast, false, false});
        contrasts.title = "Contrast of targets, channel " + course.channel;
      }
      for (const Chart& chart : {ranges, contrasts})
        if (!chart.series.empty()) charts.push_back(chart);
      page.paragraph("Targets: " + c.name + "_truth.csv, unless a sink of its own was asked for.");
    }
    page.charts(charts, folder, "What its layers and targets do over time");
    if (const std::string text = sensorText(c, sim.time.step_s); !text.empty()) {
      page.paragraph("The sensor by its design:");
      page.lines(text);
    }
    const Camera drawn = drawnCamera(c);
    const Plan plan = planFor(sim, {&drawn, nullptr});
    const bool buffered = sim.mode == RenderMode::Buffered || sim.hasTransparent();
    const PlannedEye told{c.name, c.outputs, plan, 0.0, 0.0, 0.0, 0.0, buffered, plan.terms.air && plan.air.elevations > 0, "", &c};
    page.folded("The plan: terms, wavelengths, expected error", planText(told));
  }
  if (!sim.file.empty()) {
    page.heading("Scenario");
    page.folded(sim.file + ", sha256 " + sim.sha256, readWholeFile(sim.file, {}, {}));
  }
  page.write(fileIn(folder), mayReplace);
}

}  // namespace pitviper
