#include "scenarios/commands/stream_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/commands/html_page.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

using Json = nlohmann::ordered_json;

std::string milliseconds(double ns) { return print(std::abs(ns) < 1e6 ? "%.3f" : "%.2f", 1e-6 * ns); }

const std::vector<std::string> kHead{"[ms]", "mean", "deviation", "p50", "p99", "p99.9", "largest"};

std::vector<std::string> rowOf(const std::string& name, const Durations& d) {
  std::vector<std::string> row{name};
  for (double ns : {d.mean_ns(), d.deviation_ns(), d.quantile_ns(0.5), d.quantile_ns(0.99), d.quantile_ns(0.999), d.most_ns()}) row.push_back(milliseconds(ns));
  return row;
}

std::vector<std::vector<std::string>> timesOf(const StreamReport& r) {
  std::vector<std::vector<std::string>> rows{kHead};
  const auto add = [&](const std::string& name, const Durations& d) {
    if (d.count() > 0) rows.push_back(rowOf(name, d));
  };
  for (const CameraAccount& a : r.cameras) {
    const std::string of = r.cameras.size() > 1 ? ", " + a.camera : "";
    add("period" + of, a.period);
    if (r.period_ns > 0) add("delay: tick begins to sent" + of, a.delay);
    add("drawing, with the sensor" + of, a.drawing);
    add("frame there to sent" + of, a.handing);
  }
  add("tick begins late by", r.start);
  add("step to frames out, less drawing", r.answer);
  add("a bare timer late by", r.bareTimer);
  return rows;
}

Json jsonOf(const Durations& d) {
  return {{"count", d.count()},
          {"mean_ms", 1e-6 * d.mean_ns()},
          {"deviation_ms", 1e-6 * d.deviation_ns()},
          {"p50_ms", 1e-6 * d.quantile_ns(0.5)},
          {"p99_ms", 1e-6 * d.quantile_ns(0.99)},
          {"p99_9_ms", 1e-6 * d.quantile_ns(0.999)},
          {"max_ms", 1e-6 * d.most_ns()}};
}

double percent(std::uint64_t part, std::uint64_t whole) { return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0; }

std::string bareTimerText(const StreamReport& r) {
  return print("a bare timer in the same time, which only wakes: late by more than a tenth of a period %llu times of %llu (%.2f %%)",
               static_cast<unsigned long long>(r.bareTimerLate), static_cast<unsigned long long>(r.bareTimer.count()),
               percent(r.bareTimerLate, r.bareTimer.count()));
}

/// How often each was why a frame was late.
std::string causesOf(const StreamReport& r, const char* between) {
  std::string text;
  for (std::size_t c = 0; c < kLateCauses; ++c)
    if (r.causes[c] > 0) text += (text.empty() ? "" : between) + std::to_string(r.causes[c]) + " " + nameOf(static_cast<LateCause>(c));
  return text;
}

std::string countsOf(const SinkCounts& s) {
  std::string text = s.sink + ": " + std::to_string(s.passedOn) + " passed on, " + std::to_string(s.skipped) + " skipped";
  for (const auto& [what, count] : s.others)
    if (count > 0) text += ", " + std::to_string(count) + " " + what;
  return text;
}

}  // namespace

std::string alignedTable(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (widths.size() <= c) widths.push_back(0);
      widths[c] = std::max(widths[c], row[c].size());
    }
  std::string text;
  for (const auto& row : rows) {
    text += "  ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string space(widths[c] - row[c].size(), ' ');
      text += c == 0 ? row[c] + space : "  " + space + row[c];
    }
    text += "\n";
  }
  return text;
}

std::uint64_t StreamResult::unaccounted() const {
  std::uint64_t missing = report.unaccounted();
  for (const SinkCounts& s : sinks) missing += s.taken > s.passedOn + s.skipped ? s.taken - s.passedOn - s.skipped : 0;
  return missing;
}

std::string streamSummary(const StreamResult& result) {
  const StreamReport& r = result.report;
  std::string text = std::to_string(r.ticks) + (r.ticks == 1 ? " tick in " : " ticks in ") + print("%.2f s", r.seconds) +
                     (r.period_ns > 0 ? print(" at %.6g Hz", 1e9 / static_cast<double>(r.period_ns))
                                      : print(", %.1f a second", static_cast<double>(r.ticks) / std::max(r.seconds, 1e-9))) +
                     " (" + result.renderer + ")\n";
  for (const CameraAccount& a : r.cameras) {
    text += "  " + a.camera + ": " + std::to_string(a.onTime) + (r.period_ns > 0 ? " on time, " : " sent");
    if (r.period_ns > 0)
      text += std::to_string(a.late) + print(" late (%.2f %%), ", percent(a.late, r.ticks)) + std::to_string(a.dropped) + " dropped, " +
              std::to_string(a.repeated) + " repeated";
    if (a.outsideLimits > 0) text += ", " + std::to_string(a.outsideLimits) + " outside the scenario's limits";
    text += "\n";
  }
  text += "  unaccounted for: " + std::to_string(result.unaccounted()) + "\n";
  text += alignedTable(timesOf(r));
  if (r.bareTimer.count() > 0) text += "  " + bareTimerText(r) + "\n";
  if (const std::string causes = causesOf(r, ", "); !causes.empty()) text += "  not there when due, by cause: " + causes + "\n";
  for (const RungUse& u : r.rungs) text += "  " + u.camera + ": " + std::to_string(u.frames) + print(" frames to %.3g %%\n", 100.0 * u.accuracy);
  for (const SinkCounts& s : result.sinks) text += "  " + countsOf(s) + "\n";
  if (!result.commands.empty()) {
    text += "  commands:";
    for (const auto& [kind, count] : result.commands) text += (text.back() == ':' ? " " : ", ") + std::to_string(count) + " " + kind;
    text += "\n";
  }
  if (r.drafts > 0) text += "  " + std::to_string(r.drafts) + " ticks by drafts" + (r.whyDrafts.empty() ? "" : ", as " + r.whyDrafts) + "\n";
  if (!r.refused.empty()) text += "  the system did not give the drawing thread " + r.refused + "\n";
  const std::uint64_t behind = [&] {
    std::uint64_t n = 0;
    for (const CameraAccount& a : r.cameras) n += a.late + a.dropped + a.repeated;
    return n;
  }();
  if (r.period_ns > 0 && percent(behind, r.ticks * std::max<std::uint64_t>(1, r.cameras.size())) > 10.0)
    text += print(
        "  this machine does not hold %.6g Hz: drawing takes %s ms in the mean; frames were %s. Lower the film, the rate or the accuracy, or allow 'accuracy: "
        "{at_most: ...}'\n",
        1e9 / static_cast<double>(r.period_ns), milliseconds(r.cameras.front().drawing.mean_ns()).c_str(),
        result.late == "send"   ? "sent late or dropped"
        : result.late == "drop" ? "dropped"
                                : "repeated");
  return text;
}

std::string streamJson(const StreamResult& result) {
  const StreamReport& r = result.report;
  Json j = {{"scenario", result.scenario}, {"renderer", result.renderer}, {"ticks", r.ticks}, {"seconds", r.seconds}, {"unaccounted", result.unaccounted()}};
  if (r.period_ns > 0)
    j["rate_hz"] = 1e9 / static_cast<double>(r.period_ns), j["due_after_ms"] = 1e-6 * static_cast<double>(r.delay_ns), j["late_frames_are"] = result.late;
  for (const CameraAccount& a : r.cameras)
    j["cameras"][a.camera] = {{"on_time", a.onTime},
                              {"late", a.late},
                              {"dropped", a.dropped},
                              {"repeated", a.repeated},
                              {"outside_limits", a.outsideLimits},
                              {"period", jsonOf(a.period)},
                              {"delay", jsonOf(a.delay)},
                              {"drawing", jsonOf(a.drawing)},
                              {"frame_there_to_sent", jsonOf(a.handing)}};
  for (std::size_t c = 0; r.period_ns > 0 && c < kLateCauses; ++c) j["not_there_when_due_by_cause"][nameOf(static_cast<LateCause>(c))] = r.causes[c];
  if (r.start.count() > 0) j["tick_begins_late"] = jsonOf(r.start);
  if (r.answer.count() > 0) j["step_to_frames_out_less_drawing"] = jsonOf(r.answer);
  if (r.bareTimer.count() > 0) j["bare_timer_late"] = jsonOf(r.bareTimer), j["bare_timer_late"]["late_by_more_than_a_tenth"] = r.bareTimerLate;
  for (const RungUse& u : r.rungs) j["accuracies"].push_back({{"camera", u.camera}, {"accuracy", u.accuracy}, {"frames", u.frames}});
  if (!r.rungs.empty()) j["accuracy_turns"] = r.turns;
  j["sinks"] = Json::array();
  for (const SinkCounts& s : result.sinks) {
    Json one = {{"sink", s.sink}, {"taken", s.taken}, {"passed_on", s.passedOn}, {"skipped", s.skipped}};
    for (const auto& [what, count] : s.others) one[what] = count;
    j["sinks"].push_back(one);
  }
  j["commands"] = result.commands;
  j["resident_memory_kB"] = {{"early", r.memoryBefore_kB}, {"end", r.memoryAfter_kB}};
  if (r.drafts > 0) j["ticks_by_drafts"] = r.drafts;
  if (!r.whyDrafts.empty()) j["why_drafts"] = r.whyDrafts;
  if (!r.refused.empty()) j["refused_by_the_system"] = r.refused;
  return j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void writeStreamReport(const StreamResult& result, const std::string& mark, const std::filesystem::path& folder, const MayReplace& mayReplace) {
  const StreamReport& r = result.report;
  writeFileAtomically(folder / "stream.json", streamJson(result), mayReplace);
  HtmlPage page("Stream of " + result.scenario, mark);
  page.lines(streamSummary(result));
  page.heading("Frames");
  std::vector<std::vector<std::string>> rows;
  for (const CameraAccount& a : r.cameras)
    rows.push_back(
        {a.camera, std::to_string(a.onTime), std::to_string(a.late), std::to_string(a.dropped), std::to_string(a.repeated), std::to_string(a.outsideLimits)});
  page.table({"camera", "on time", "late", "dropped", "repeated", "outside limits"}, rows);
  page.heading("Times [ms]");
  rows = timesOf(r);
  rows.erase(rows.begin());
  page.table({"", "mean", "standard deviation", "p50", "p99", "p99.9", "largest"}, rows);
  std::vector<Chart> charts;
  for (const CameraAccount& a : r.cameras) {
    Series mean{"mean", {}, {}, false, false}, most{"largest", {}, {}, true, false};
    const double perTick_s = r.seconds / std::max(1.0, static_cast<double>(r.ticks));
    std::uint64_t at = 0;
    for (const LongCourse::Piece& p : a.delayCourse.pieces()) {
      const double t = (static_cast<double>(at) + 0.5 * static_cast<double>(p.count)) * perTick_s;
      at += p.count;
      mean.x.push_back(t), mean.y.push_back(1e-6 * p.sum / static_cast<double>(p.count));
      most.x.push_back(t), most.y.push_back(1e-6 * p.most);
    }
    if (mean.x.size() > 1) charts.push_back({"Delay of frames, " + a.camera, "time [s]", "tick begins to sent [ms]", false, false, true, {mean, most}, {}, {}});
    Series shares{"", {}, {}, false, false};
    for (double q = 0.0; q < 0.99999; q = q + (1.0 - q) * 0.05) {
      shares.x.push_back(1e-6 * a.period.quantile_ns(q));
      shares.y.push_back(1.0 - q);
    }
    if (a.period.count() > 1)
      charts.push_back({"Share of periods longer than, " + a.camera, "sent to sent [ms]", "share", false, true, false, {shares}, {}, {}});
  }
  page.charts(charts, folder, "Each point of the course is the mean, and the largest, of a piece of the run");
  page.write(folder / "stream.html", mayReplace);
}

}  // namespace pitviper
