#include "scenarios/sweep/sweep_page.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "scenarios/commands/html_page.hpp"
#include "scenarios/sweep/sweep_plots.hpp"
#include "scenarios/sweep/sweep_statistics.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/image/ticks.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kMostReasons = 20;
/// A panel has dots enough at 2000; with many panels a page stays below some 10 MB.
constexpr std::size_t kMostDots = 2000, kLeastDots = 200, kMostDotsOfAll = 600000;
constexpr std::size_t kPanelsAcross = 3;

std::string numberCell(double v) { return std::isnan(v) ? "–" : shortNumber(v); }

std::string twoDigits(double v) { return std::isnan(v) ? "–" : print("%.2f", v); }

std::string twoEnds(const Interval& i) { return twoDigits(i.low) + " to " + twoDigits(i.high); }

std::string unitCell(const std::string& unit) { return unit.empty() ? "1" : unit; }

void tellSamples(HtmlPage& page, const SweepIdentity& sweep, const std::vector<SweepRow>& rows, bool isSaltelli) {
  struct Reason {
    int count = 0, first = 0;
  };
  std::map<std::string, Reason> reasons;
  int failed = 0;
  for (const SweepRow& r : rows) {
    if (r.why.empty()) continue;
    Reason& reason = reasons[r.why];
    if (reason.count++ == 0 || r.sample < reason.first) reason.first = r.sample;
    ++failed;
  }
  page.paragraph("Scenario " + sweep.scenario + ", drawn by pitviper " + sweep.version + ". Of " + std::to_string(sweep.samples) + " samples " +
                 std::to_string(rows.size()) + " are stored, and of these " + std::to_string(failed) + " have failed." +
                 (isSaltelli ? " They are a design of Saltelli." : ""));
  std::vector<std::vector<std::string>> factors;
  for (std::size_t i = 0; i < sweep.factors.size(); ++i) {
    const SweepFactor& f = sweep.factors[i];
    std::string words;
    for (const std::string& word : f.choices) words += (words.empty() ? "" : ", ") + word;
    double least = NAN, most = NAN;
    for (const SweepRow& r : rows) least = std::fmin(least, r.factors.at(i)), most = std::fmax(most, r.factors.at(i));
    factors.push_back({f.name, words.empty() ? unitCell(f.unit) : "", words.empty() ? numberCell(least) + " to " + numberCell(most) : words});
  }
  page.heading("What varies");
  page.table({"factor", "unit", "drawn"}, factors);
  if (reasons.empty()) return;
  page.heading("Samples that failed");
  std::vector<std::pair<std::string, Reason>> most(reasons.begin(), reasons.end());
  std::stable_sort(most.begin(), most.end(), [](const auto& a, const auto& b) { return a.second.count > b.second.count; });
  std::vector<std::vector<std::string>> lines;
  for (std::size_t i = 0; i < std::min(most.size(), kMostReasons); ++i)
    lines.push_back({most[i].first, std::to_string(most[i].second.count), std::to_string(most[i].second.first)});
  page.table({"why", "samples", "the first"}, lines);
  if (most.size() > kMostReasons) page.paragraph("and " + std::to_string(most.size() - kMostReasons) + " other reasons");
}

void tellMeasures(HtmlPage& page, const std::vector<MeasureStatistics>& all) {
  std::vector<std::string> head{"measure", "unit", "samples", "without it", "mean", "sigma"};
  for (double q : kSweepQuantiles) head.push_back(print("%g %%", 100.0 * q));
  std::vector<std::vector<std::string>> lines;
  for (const MeasureStatistics& m : all) {
    lines.push_back({m.name, unitCell(m.unit), std::to_string(m.count), std::to_string(m.missing), numberCell(m.mean), numberCell(m.sigma)});
    for (double q : m.quantiles) lines.back().push_back(numberCell(q));
  }
  page.heading("What was measured");
  page.table(head, lines);
}

void tellFactors(HtmlPage& page, const SweepIdentity& sweep, const MeasureStatistics& m) {
  std::vector<std::string> head{"factor", "rank correlation", "95 %"};
  if (m.sobol) head.insert(head.end(), {"first order", "95 %", "total", "95 %"});
  std::vector<std::vector<std::string>> lines;
  for (std::size_t i = 0; i < sweep.factors.size(); ++i) {
    lines.push_back({sweep.factors[i].name, twoDigits(m.withFactor[i].rho), twoEnds(m.withFactor[i].interval)});
    if (!m.sobol) continue;
    const SobolIndex& s = m.sobol->factors[i];
    lines.back().insert(lines.back().end(), {twoDigits(s.first), twoEnds(s.firstInterval), twoDigits(s.total), twoEnds(s.totalInterval)});
  }
  page.table(head, lines);
  if (m.sobol)
    page.paragraph("Indices are of " + std::to_string(m.sobol->rows) + " rows of the design; " + std::to_string(m.sobol->leftOut) +
                   " are left out, because one of their samples has no number or is not drawn yet.");
}

/// Its histogram, its bars, and a panel for each factor.
void drawMeasure(HtmlPage& page, const SweepIdentity& sweep, const std::vector<SweepRow>& rows, const MeasureStatistics& m, std::size_t column,
                 std::size_t mostDots) {
  std::vector<double> values;
  std::vector<std::vector<double>> factors(sweep.factors.size());
  for (const SweepRow& r : rows) {
    if (!r.why.empty()) continue;
    values.push_back(r.measures.at(column));
    for (std::size_t i = 0; i < factors.size(); ++i) factors[i].push_back(r.factors.at(i));
  }
  std::vector<SweepBar> correlations, indices;
  for (std::size_t i = 0; i < sweep.factors.size(); ++i) {
    const std::string& name = sweep.factors[i].name;
    correlations.push_back({name, m.withFactor[i].rho, m.withFactor[i].interval, NAN, {}});
    if (!m.sobol) continue;
    const SobolIndex& s = m.sobol->factors[i];
    indices.push_back({name, s.first, s.firstInterval, s.total, s.totalInterval});
  }
  const MeasureColumn measure{m.name, m.unit};
  const std::size_t before = m.sobol ? 3 : 2;  // panels
  const double upper = barsHeight(correlations), lines = std::ceil(static_cast<double>(before + factors.size()) / kPanelsAcross);
  SvgDrawing drawing(kPanelsAcross * kSweepPanelWidth, upper + (lines - 1.0) * kSweepPanelHeight);
  drawHistogram({drawing, 0.0, 0.0}, measure, values);
  if (m.sobol) drawBars({drawing, kSweepPanelWidth, 0.0, upper}, "first-order index", "total", indices, 0.0);
  drawBars({drawing, static_cast<double>(before - 1) * kSweepPanelWidth, 0.0, upper}, "rank correlation", "", correlations, -1.0);
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const std::size_t across = (before + i) % kPanelsAcross, line = (before + i) / kPanelsAcross;
    const double top = line > 0 ? upper + static_cast<double>(line - 1) * kSweepPanelHeight : 0.0;
    drawScatter({drawing, static_cast<double>(across) * kSweepPanelWidth, top}, sweep.factors[i], measure, factors[i], values, mostDots);
  }
  page.drawing(drawing.svg(m.name + " against each factor"),
               "Red: the median, and 5 and 95 %. Thin lines over bars: 95 % intervals." +
                   (values.size() > mostDots ? " Of " + std::to_string(values.size()) + " samples " + std::to_string(mostDots) + " are drawn as dots." : ""));
}

}  // namespace

void writeSweepPage(const std::filesystem::path& file, const SweepIdentity& sweep, const std::vector<SweepRow>& unordered, bool isSaltelli,
                    const MayReplace& mayReplace) {
  std::vector<SweepRow> rows = unordered;
  std::sort(rows.begin(), rows.end(), [](const SweepRow& a, const SweepRow& b) { return a.sample < b.sample; });
  Simulation owner;
  owner.name = sweep.name, owner.sha256 = sweep.sha256;
  HtmlPage page(sweep.name, ownerMark(owner));
  const std::vector<MeasureStatistics> all = sweepStatistics(sweep, rows, isSaltelli);
  tellSamples(page, sweep, rows, isSaltelli);
  tellMeasures(page, all);
  const std::size_t panels = std::max<std::size_t>(all.size() * sweep.factors.size(), 1);
  for (std::size_t column = 0; column < all.size(); ++column) {
    page.heading(all[column].name + " [" + unitCell(all[column].unit) + "]");
    drawMeasure(page, sweep, rows, all[column], column, std::clamp(kMostDotsOfAll / panels, kLeastDots, kMostDots));
    tellFactors(page, sweep, all[column]);
  }
  page.paragraph(
      "Rank correlation: Spearman's, from -1 to 1; of a choice by the order of its words. First order: the part of the variance that goes with this factor "
      "alone; total: with it and with what it does together with others.");
  page.write(file, mayReplace);
}

}  // namespace pitviper
