#include "scenarios/sweep/sweep_plots.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/sweep/sample_moments.hpp"
#include "scenarios/sweep/sweep_axis.hpp"

namespace pitviper {
namespace {

using Anchor = SvgDrawing::Anchor;

/// Of a panel, around its frame: for numbers at the left, for words of the vertical axis above, for both of the horizontal one below.
constexpr double kLeft = 50.0, kRight = 12.0, kAbove = 24.0, kBelow = 40.0;
constexpr double kNamesWidth = 118.0, kRow = 17.0, kHalfText = 4.0;
/// Indices of too few rows go anywhere; bars end here.
constexpr double kFarthestBar = 1.5;
constexpr std::size_t kNameCharacters = 18, kTitleCharacters = 48, kWordCharacters = 44;
/// Okabe and Ito's blue, its pale sister, and their vermilion.
constexpr const char *kBarColour = "#0072b2", *kPaleColour = "#8cc4e6", *kMarkColour = "#d55e00", *kGridColour = "#e4e4e4", *kFrameColour = "#6e6e6e",
                     *kInkColour = "#282828";

std::string titled(const std::string& name, const std::string& unit) {
  return shortenedText(name, kTitleCharacters) + " [" + (unit.empty() ? "1" : unit) + "]";
}

std::string withPower(const std::string& title, const SweepAxis& axis) { return axis.power.empty() ? title : title + " (" + axis.power + ")"; }

struct PanelFrame {
  SvgDrawing& drawing;
  double left, top, right, bottom;

  double x(double place) const { return left + place * (right - left); }
  double y(double place) const { return bottom - place * (bottom - top); }

  void across(const SweepAxis& axis, const std::string& title) const {
    for (const SweepAxis::Tick& t : axis.ticks) {
      drawing.line(x(t.at), top, x(t.at), bottom, kGridColour);
      drawing.text(x(t.at), bottom + 14.0, t.label, Anchor::Middle);
    }
    drawing.text(x(0.5), bottom + 30.0, withPower(title, axis), Anchor::Middle);
  }
  void up(const SweepAxis& axis, const std::string& title) const {
    for (const SweepAxis::Tick& t : axis.ticks) {
      drawing.line(left, y(t.at), right, y(t.at), kGridColour);
      drawing.text(left - 6.0, y(t.at) + kHalfText, t.label, Anchor::End);
    }
    drawing.text(left, top - 8.0, withPower(title, axis));
  }
  void around() const {
    drawing.line(left, bottom, right, bottom, kFrameColour);
    drawing.line(left, top, left, bottom, kFrameColour);
  }
  void nothing() const { drawing.text(x(0.5), y(0.5), "nothing to draw", Anchor::Middle); }
};

PanelFrame panelFrame(const SweepPanel& p, double left = kLeft) {
  return {p.drawing, p.left + left, p.top + kAbove, p.left + kSweepPanelWidth - kRight, p.top + p.height - kBelow};
}

/// From -0.5 to 0.5, by a number: the golden ratio's multiples fill it evenly.
double spreadOut(std::size_t number) {
  const double turns = static_cast<double>(number) * 0.6180339887498949;
  return turns - std::floor(turns) - 0.5;
}

}  // namespace

void drawHistogram(const SweepPanel& panel, const MeasureColumn& measure, const std::vector<double>& values) {
  const PanelFrame frame = panelFrame(panel);
  const SweepAxis axis = axisHolding(values);
  std::vector<double> rising;
  for (double v : values)
    if (std::isfinite(axis.place(v))) rising.push_back(v);
  std::sort(rising.begin(), rising.end());
  if (rising.empty()) return frame.nothing();
  // Rice's rule.
  const double wanted = std::clamp(std::ceil(2.0 * std::cbrt(static_cast<double>(rising.size()))), 5.0, 40.0);
  const double first = axis.place(rising.front()), width = (axis.place(rising.back()) - first) / wanted;
  std::vector<int> counts(width > 0.0 ? static_cast<std::size_t>(wanted) : 1, 0);
  for (double v : rising) {
    const double bin = width > 0.0 ? (axis.place(v) - first) / width : 0.0;
    ++counts[std::min(static_cast<std::size_t>(std::max(bin, 0.0)), counts.size() - 1)];
  }
  SweepAxis numbers = plainAxis(0.0, 1.08 * *std::max_element(counts.begin(), counts.end()));
  std::erase_if(numbers.ticks, [](const SweepAxis::Tick& t) {
    return t.label.find('.') != t.label.npos && t.label.find_first_not_of('0', t.label.find('.') + 1) != t.label.npos;
  });
  frame.up(numbers, "samples");
  frame.across(axis, titled(measure.name, measure.unit));
  constexpr double kLoneWidth = 0.02;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double from = width > 0.0 ? first + static_cast<double>(i) * width : first - 0.5 * kLoneWidth, to = from + (width > 0.0 ? width : kLoneWidth);
    const double height = frame.bottom - frame.y(counts[i] / numbers.high);
    if (counts[i] > 0) frame.drawing.bar(frame.x(from), frame.bottom - height, std::max(frame.x(to) - frame.x(from) - 0.6, 0.6), height, kBarColour);
  }
  for (double part : {0.05, 0.5, 0.95}) {
    const double x = frame.x(axis.place(quantileOf(rising, part)));
    frame.drawing.line(x, frame.top, x, frame.bottom, kMarkColour, part == 0.5 ? 1.6 : 0.8);
  }
  frame.around();
}

double barsHeight(const std::vector<SweepBar>& bars) { return std::max(kSweepPanelHeight, kAbove + kBelow + kRow * static_cast<double>(bars.size())); }

void drawBars(const SweepPanel& panel, const std::string& title, const std::string& second, std::vector<SweepBar> bars, double low) {
  const PanelFrame frame = panelFrame(panel, kNamesWidth);
  const auto size = [](const SweepBar& b) {
    const double s = std::max(std::abs(b.value), std::isnan(b.second) ? 0.0 : std::abs(b.second));
    return std::isnan(s) ? -1.0 : s;
  };
  std::stable_sort(bars.begin(), bars.end(), [&](const SweepBar& a, const SweepBar& b) { return size(a) > size(b); });
  double high = 1.0;
  for (const SweepBar& b : bars)
    for (double v : {b.value, b.interval.low, b.interval.high, b.second, b.secondInterval.low, b.secondInterval.high})
      if (std::isfinite(v)) low = std::clamp(v, -kFarthestBar, low), high = std::clamp(v, high, kFarthestBar);
  const SweepAxis axis = plainAxis(low, high);
  const auto x = [&](double v) { return frame.x(std::clamp(axis.place(v), 0.0, 1.0)); };
  frame.across(axis, second.empty() ? title : title + "; pale: " + second);
  const auto one = [&](double value, const Interval& interval, double y, double height, const char* colour) {
    if (!std::isfinite(value)) return;
    const double from = x(std::min(value, 0.0)), to = x(std::max(value, 0.0));
    frame.drawing.bar(from, y - 0.5 * height, to - from, height, colour);
    if (std::isfinite(interval.low + interval.high))
      frame.drawing.line(frame.x(axis.place(interval.low)), y, frame.x(axis.place(interval.high)), y, kInkColour, 1.2);
  };
  const double step = (frame.bottom - frame.top) / std::max(static_cast<double>(bars.size()), 1.0), row = std::min(step, 2.0 * kRow);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const SweepBar& b = bars[i];
    const double y = frame.top + (static_cast<double>(i) + 0.5) * step;
    const bool two = !std::isnan(b.second);
    one(b.value, b.interval, two ? y - 0.2 * row : y, two ? 0.36 * row : 0.6 * row, kBarColour);
    if (two) one(b.second, b.secondInterval, y + 0.2 * row, 0.36 * row, kPaleColour);
    frame.drawing.text(frame.left - 6.0, y + kHalfText, shortenedText(b.factor, kNameCharacters), Anchor::End);
  }
  frame.drawing.line(x(0.0), frame.top, x(0.0), frame.bottom, kFrameColour);
}

void drawScatter(const SweepPanel& panel, const SweepFactor& factor, const MeasureColumn& measure, const std::vector<double>& x, const std::vector<double>& y,
                 std::size_t mostDots) {
  const PanelFrame frame = panelFrame(panel);
  const bool words = !factor.choices.empty();
  const SweepAxis along = words ? axisOfWords(factor, kWordCharacters) : axisHolding(x), up = axisHolding(y);
  const std::size_t drawn = std::min(x.size(), mostDots);
  std::vector<std::pair<double, double>> places;
  for (std::size_t i = 0; i < drawn; ++i) {
    const std::size_t k = i * x.size() / drawn;
    // Columns of choices keep a fifth of their width free on each side.
    const double px = along.place(words ? x[k] + 0.6 * spreadOut(k) : x[k]), py = up.place(y[k]);
    if (std::isfinite(px) && std::isfinite(py)) places.push_back({frame.x(px), frame.y(py)});
  }
  frame.across(along, words ? shortenedText(factor.name, kTitleCharacters) : titled(factor.name, factor.unit));
  frame.up(up, titled(measure.name, measure.unit));
  if (places.empty()) frame.nothing();
  frame.drawing.dots(places, places.size() > 800 ? 2.0 : places.size() > 200 ? 3.0 : 4.0, kBarColour);
  frame.around();
}

}  // namespace pitviper
