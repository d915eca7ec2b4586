#include "scenarios/commands/accuracy_report.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Two digits, and no exponent where it can be read without.
std::string figure(double v) {
  if (!(v >= 1e-4 && v < 1e6)) return print("%.2g", v);
  const int place = static_cast<int>(std::floor(std::log10(v))) - 1;
  return print("%.*f", std::max(0, -place), v);
}

std::string threeOf(const ErrorFigures& e, double scale) {
  return figure(scale * e.median) + " / " + figure(scale * e.percentile99) + " / " + figure(scale * e.maximum);
}

std::string rule(size_t cells) {
  std::string line = "|";
  for (size_t i = 0; i < cells; ++i) line += "---|";
  return line + "\n";
}

const char* kindName(AccuracySetting::Kind k) {
  switch (k) {
    case AccuracySetting::Kind::Planned:
      return "planned";
    case AccuracySetting::Kind::Even:
      return "even";
    case AccuracySetting::Kind::Gauss:
      return "gauss";
  }
  return "";
}

constexpr double kCompared = 0.01;

/// Even sampling that keeps a channel's worst pixel within kCompared, and so do all finer ones of the ladder; null: none does.
const AccuracyRow* enoughSamples(const AccuracyReport& report, size_t channel) {
  const AccuracyRow* enough = nullptr;
  for (const AccuracyRow& r : report.rows) {
    if (r.setting.kind != AccuracySetting::Kind::Even) continue;
    if (r.channels[channel].errors.relative.maximum > kCompared) enough = nullptr;
    else if (!enough) enough = &r;
  }
  return enough;
}

/// What planning for 1 % is worth: against the fewest even samples of the ladder that do the same in every pixel.
std::string comparison(const AccuracyReport& report) {
  const auto planned = std::find_if(report.rows.begin(), report.rows.end(), [](const AccuracyRow& r) {
    return r.setting.kind == AccuracySetting::Kind::Planned && r.setting.sampling.accuracy == kCompared;
  });
  if (planned == report.rows.end()) return "";
  std::string out = "\nWithin 1 % in every pixel:\n\n| channel | groups | even samples | fewer |\n|---|---|---|---|\n";
  const AccuracyRow* slowest = nullptr;
  bool all = true;
  for (size_t c = 0; c < planned->channels.size(); ++c) {
    const auto& channel = planned->channels[c];
    const AccuracyRow* even = enoughSamples(report, c);
    all &= even != nullptr;
    if (even && (!slowest || even->nodes > slowest->nodes)) slowest = even;
    out += "| " + channel.name + print(" | %d%s | ", channel.nodes, channel.errors.relative.maximum <= kCompared ? "" : " (not within)");
    out += even ? print("%d | %.1f times |\n", even->channels[c].nodes, static_cast<double>(even->channels[c].nodes) / channel.nodes) : "more than 340 | |\n";
  }
  if (all && slowest)
    out += print("\nFrames a second: %.1f planned, %.1f with %s samples in every channel, %.1f times.\n", planned->framesPerSecond, slowest->framesPerSecond,
                 slowest->setting.name.c_str(), planned->framesPerSecond / slowest->framesPerSecond);
  return out;
}

}  // namespace

std::string accuracyTables(const AccuracyReport& report) {
  std::string out = "Error per pixel in per cent, median / 99th percentile / largest; n: wavelengths or groups that count in the channel.\n\n";
  if (report.rows.empty()) return out;
  const auto& first = report.rows.front().channels;
  const bool predicted = std::any_of(report.rows.begin(), report.rows.end(), [](const AccuracyRow& r) {
    return std::any_of(r.channels.begin(), r.channels.end(), [](const auto& c) { return c.predicted.has_value(); });
  });
  out += "| setting | frames/s | in all |";
  for (const auto& c : first) out += " " + c.name + " n |" + (predicted ? " expected |" : "") + " " + c.name + " |";
  out += "\n" + rule(3 + first.size() * (predicted ? 3 : 2));
  for (const AccuracyRow& r : report.rows) {
    out += print("| %s | %.1f | %d |", r.setting.name.c_str(), r.framesPerSecond, r.nodes);
    for (const auto& c : r.channels) {
      out += print(" %d |", c.nodes);
      if (predicted) out += c.predicted ? " " + figure(100.0 * *c.predicted) + " |" : " |";
      out += " " + threeOf(c.errors.relative, 100.0) + " |";
    }
    out += "\n";
  }
  std::vector<size_t> warm;
  for (size_t c = 0; c < first.size(); ++c)
    if (first[c].errors.kelvin) warm.push_back(c);
  if (!warm.empty()) {
    out += "\nThe same as a temperature difference, in mK, of the pixels as bright as a black body of 250 to 330 K.\n\n| setting |";
    for (size_t c : warm) out += " " + first[c].name + " |";
    out += "\n" + rule(1 + warm.size());
    for (const AccuracyRow& r : report.rows) {
      out += "| " + r.setting.name + " |";
      for (size_t c : warm) out += " " + threeOf(*r.channels[c].errors.kelvin, 1e3) + " |";
      out += "\n";
    }
  }
  out += comparison(report);
  for (const auto& m : report.missing) out += "\nnot drawn: " + m + "\n";
  return out;
}

std::string accuracyCsv(const AccuracyReport& report) {
  std::string out =
      "kind,setting,accuracy,samples,rate [frame/s],nodes,channel,nodes in channel,expected error,median error,99th percentile error,largest error,median "
      "difference [K],99th percentile difference [K],largest difference [K]\n";
  for (const AccuracyRow& r : report.rows)
    for (const auto& c : r.channels) {
      const bool planned = r.setting.kind == AccuracySetting::Kind::Planned;
      out += print("%s,%s,%s,%s,%.6g,%d,%s,%d,%s,%.6g,%.6g,%.6g,", kindName(r.setting.kind), r.setting.name.c_str(),
                   planned ? print("%g", r.setting.sampling.accuracy).c_str() : "", planned ? "" : std::to_string(r.setting.sampling.samples).c_str(),
                   r.framesPerSecond, r.nodes, c.name.c_str(), c.nodes, c.predicted ? print("%.6g", *c.predicted).c_str() : "", c.errors.relative.median,
                   c.errors.relative.percentile99, c.errors.relative.maximum);
      out += (c.errors.kelvin ? print("%.6g,%.6g,%.6g", c.errors.kelvin->median, c.errors.kelvin->percentile99, c.errors.kelvin->maximum) : ",,") + "\n";
    }
  return out;
}

std::vector<Chart> accuracyCharts(const AccuracyReport& report) {
  std::vector<Chart> charts;
  if (report.rows.empty()) return charts;
  for (size_t c = 0; c < report.rows.front().channels.size(); ++c) {
    Chart chart;
    chart.title = report.rows.front().channels[c].name + ": 99 of 100 pixels";
    chart.xLabel = "frames/s";
    chart.yLabel = "error [%]";
    chart.logX = chart.logY = true;
    for (const auto& [kind, name] : {std::pair{AccuracySetting::Kind::Planned, "accuracy 10 % to 0.1 %"},
                                     {AccuracySetting::Kind::Even, "4 to 340 even samples"},
                                     {AccuracySetting::Kind::Gauss, "16 Gauss points"}}) {
      Series s{name, {}, {}, false, false};
      for (const AccuracyRow& r : report.rows)
        if (r.setting.kind == kind) {
          s.x.push_back(r.framesPerSecond);
          s.y.push_back(100.0 * r.channels[c].errors.relative.percentile99);
        }
      if (s.x.size() == 1) s.x.push_back(s.x[0]), s.y.push_back(s.y[0]);  // a line has two ends
      chart.series.push_back(s);
    }
    charts.push_back(chart);
  }
  return charts;
}

}  // namespace pitviper
