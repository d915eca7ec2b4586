#include "scenarios/view/window/plot.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/view/window/style.hpp"
#include "sim/image/ticks.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

struct Tick {
  double value;
  std::string label;
};

std::vector<Tick> ticksOf(const PlotAxis& axis) {
  std::vector<Tick> all;
  if (!axis.isLog) {
    const Ticks t = chooseTicks(axis.low, axis.high);
    for (std::size_t k = 0; k < t.values.size(); ++k) all.push_back({t.values[k], t.labels[k]});
    return all;
  }
  for (int power = static_cast<int>(std::floor(std::log10(axis.low))); power <= std::log10(axis.high); ++power)
    for (int step : {1, 2, 5}) {
      const double v = step * std::pow(10.0, power);
      if (v >= axis.low && v <= axis.high) all.push_back({v, print("%g", v)});
    }
  if (all.size() > 8) std::erase_if(all, [](const Tick& t) { return std::abs(std::remainder(std::log10(t.value), 1.0)) > 1e-9; });
  return all;
}

std::string labelOf(const PlotAxis& axis) {
  const std::string power = axis.isLog ? "" : powerText(chooseTicks(axis.low, axis.high).power);
  return power.empty() ? axis.label : axis.label + " " + power;
}

double partOf(const PlotAxis& axis, double v) {
  if (axis.isLog) return std::log(std::max(v, 1e-300) / axis.low) / std::log(axis.high / axis.low);
  return (v - axis.low) / (axis.high - axis.low);
}

double valueOf(const PlotAxis& axis, double part) {
  return axis.isLog ? axis.low * std::pow(axis.high / axis.low, part) : axis.low + part * (axis.high - axis.low);
}

PlotAxis drawable(PlotAxis axis) {
  if (!(axis.high > axis.low) || !std::isfinite(axis.low) || !std::isfinite(axis.high)) axis.low = 0.0, axis.high = 1.0, axis.isLog = false;
  if (axis.isLog && axis.low <= 0.0) axis.low = axis.high * 1e-6;
  return axis;
}

}  // namespace

Plot::Plot(const std::string& id, ImVec2 size, PlotAxis x, PlotAxis y)
    : x_(drawable(std::move(x))), y_(drawable(std::move(y))), list_(ImGui::GetWindowDrawList()) {
  const float text = ImGui::GetTextLineHeight();
  size = ImVec2(std::max(size.x, 8.0f * text), std::max(size.y, 6.0f * text));
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(id.c_str(), size);
  hovered_ = ImGui::IsItemHovered();
  active_ = ImGui::IsItemActive();
  low_ = ImVec2(from.x + 3.4f * text, from.y + 1.5f * text);
  high_ = ImVec2(from.x + size.x - 0.8f * text, from.y + size.y - 2.5f * text);
  drawAxes();
}

ImVec2 Plot::at(double x, double y) const {
  const double px = std::clamp(partOf(x_, x), -10.0, 11.0), py = std::clamp(partOf(y_, y), -10.0, 11.0);
  return ImVec2(low_.x + static_cast<float>(px) * (high_.x - low_.x), high_.y - static_cast<float>(py) * (high_.y - low_.y));
}

glm::dvec2 Plot::valueAt(ImVec2 place) const {
  return {valueOf(x_, static_cast<double>((place.x - low_.x) / (high_.x - low_.x))),
          valueOf(y_, static_cast<double>((high_.y - place.y) / (high_.y - low_.y)))};
}

std::optional<glm::dvec2> Plot::mouse() const {
  const ImVec2 m = ImGui::GetIO().MousePos;
  if (!hovered_ || m.x < low_.x || m.x > high_.x || m.y < low_.y || m.y > high_.y) return std::nullopt;
  return valueAt(m);
}

void Plot::drawAxes() {
  const float text = ImGui::GetTextLineHeight();
  list_->AddRectFilled(low_, high_, colours::kPlot, 2.0f);
  for (const Tick& t : ticksOf(x_)) {
    const ImVec2 p = at(t.value, y_.low);
    list_->AddLine(ImVec2(p.x, low_.y), ImVec2(p.x, high_.y), colours::kLine, 0.5f);
    const ImVec2 size = ImGui::CalcTextSize(t.label.c_str());
    list_->AddText(ImVec2(p.x - 0.5f * size.x, high_.y + 0.15f * text), colours::kDim, t.label.c_str());
  }
  float labelled = -1e9f;  // where a label stands that the next must not cover
  for (const Tick& t : ticksOf(y_)) {
    const ImVec2 p = at(x_.low, t.value);
    list_->AddLine(ImVec2(low_.x, p.y), ImVec2(high_.x, p.y), colours::kLine, 0.5f);
    if (std::abs(p.y - labelled) < text) continue;
    labelled = p.y;
    const ImVec2 size = ImGui::CalcTextSize(t.label.c_str());
    list_->AddText(ImVec2(low_.x - size.x - 0.3f * text, p.y - 0.5f * size.y), colours::kDim, t.label.c_str());
  }
  const std::string x = labelOf(x_), y = labelOf(y_);
  const ImVec2 size = ImGui::CalcTextSize(x.c_str());
  list_->AddText(ImVec2(0.5f * (low_.x + high_.x - size.x), high_.y + 1.2f * text), colours::kText, x.c_str());
  list_->AddText(ImVec2(low_.x - 3.2f * text, low_.y - 1.4f * text), colours::kText, y.c_str());
}

void Plot::line(const std::vector<double>& x, const std::vector<double>& y, ImU32 colour, float thickness) {
  list_->PushClipRect(low_, high_, true);
  std::vector<ImVec2> points;
  const auto put = [&] {
    if (points.size() > 1) list_->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, thickness);
    points.clear();
  };
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k)
    if (std::isfinite(y[k]) && !(y_.isLog && y[k] <= 0.0)) points.push_back(at(x[k], y[k]));
    else put();
  put();
  list_->PopClipRect();
}

void Plot::bars(const std::vector<double>& edges, const std::vector<double>& heights, ImU32 colour) {
  list_->PushClipRect(low_, high_, true);
  for (std::size_t k = 0; k < heights.size() && k + 1 < edges.size(); ++k) {
    const ImVec2 a = at(edges[k], y_.low), b = at(edges[k + 1], heights[k]);
    list_->AddRectFilled(ImVec2(a.x, b.y), ImVec2(std::max(b.x - 1.0f, a.x + 1.0f), a.y), colour);
  }
  list_->PopClipRect();
}

void Plot::mark(double x, double y, ImU32 colour, bool isBig) {
  const ImVec2 p = at(x, y);
  const float r = (isBig ? 0.42f : 0.3f) * ImGui::GetTextLineHeight();
  list_->AddCircleFilled(p, r, colour);
  list_->AddCircle(p, r, IM_COL32(255, 255, 255, isBig ? 255 : 120), 0, isBig ? 2.0f : 1.0f);
}

void Plot::upright(double x, ImU32 colour, const std::string& label) {
  const ImVec2 p = at(x, y_.low);
  if (p.x < low_.x || p.x > high_.x) return;
  list_->AddLine(ImVec2(p.x, low_.y), ImVec2(p.x, high_.y), colour, 1.0f);
  if (!label.empty()) list_->AddText(ImVec2(p.x + 3.0f, low_.y + 2.0f), colour, label.c_str());
}

void Plot::level(double y, ImU32 colour) {
  const ImVec2 p = at(x_.low, y);
  if (p.y >= low_.y && p.y <= high_.y) list_->AddLine(ImVec2(low_.x, p.y), ImVec2(high_.x, p.y), colour, 1.0f);
}

void Plot::legend(const std::vector<std::pair<std::string, ImU32>>& names) {
  const float text = ImGui::GetTextLineHeight();
  float widest = 0.0f;
  for (const auto& [name, colour] : names) widest = std::max(widest, ImGui::CalcTextSize(name.c_str()).x);
  ImVec2 p(high_.x - widest - 2.4f * text, low_.y + 0.4f * text);
  list_->AddRectFilled(ImVec2(p.x - 0.3f * text, p.y - 0.2f * text),
                       ImVec2(high_.x - 0.2f * text, p.y + 1.1f * text * static_cast<float>(names.size()) + 0.1f * text), IM_COL32(18, 20, 25, 120), 3.0f);
  for (const auto& [name, colour] : names) {
    list_->AddLine(ImVec2(p.x, p.y + 0.5f * text), ImVec2(p.x + 1.4f * text, p.y + 0.5f * text), colour, 2.5f);
    list_->AddText(ImVec2(p.x + 1.8f * text, p.y), colours::kText, name.c_str());
    p.y += 1.1f * text;
  }
}

PlotAxis axisAround(const std::string& label, const std::vector<const std::vector<double>*>& values, bool fromZero) {
  double low = INFINITY, high = -INFINITY;
  for (const auto* list : values)
    for (double v : *list)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (!(low <= high)) low = 0.0, high = 1.0;
  if (fromZero) low = std::min(low, 0.0), high = std::max(high, 0.0);
  const double room = high > low ? 0.06 * (high - low) : std::max(0.05 * std::abs(high), 1e-12);
  return {label, fromZero && low == 0.0 ? 0.0 : low - room, high + room, false};
}

}  // namespace pitviper
