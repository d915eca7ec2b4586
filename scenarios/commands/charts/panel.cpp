#include "scenarios/commands/charts/panel.hpp"

#include <vtkAxis.h>
#include <vtkChartXY.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlot.h>
#include <vtkPlotBar.h>
#include <vtkPlotLine.h>
#include <vtkPlotPoints.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <cmath>

#include "scenarios/commands/charts/axis_layout.hpp"
#include "scenarios/commands/charts/panel_text.hpp"
#include "scenarios/commands/charts/style.hpp"

namespace pitviper {
namespace {

using namespace chart_style;

/// Beside the plot for the axes' names.
constexpr float kNameRoom = 22.0f * kOversampling;

void setAxis(vtkAxis& axis, const AxisLayout& layout) {
  axis.SetBehavior(vtkAxis::FIXED);
  axis.SetRange(layout.low, layout.high);
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (double t : layout.ticks) positions->InsertNextValue(t);
  for (const auto& l : layout.labels) labels->InsertNextValue(l);
  axis.SetCustomTickPositions(positions, labels);
  axis.SetTitle("");
  setFont(*axis.GetLabelProperties(), kText_px, false, kInk);
  for (vtkPen* pen : {axis.GetPen(), axis.GetGridPen()}) pen->SetWidth(1.0f * kOversampling);
  axis.GetPen()->SetColor(kAxis.r, kAxis.g, kAxis.b);
  axis.GetGridPen()->SetColor(kGrid.r, kGrid.g, kGrid.b);
  axis.SetTickLength(4.0f * kOversampling);
  axis.SetLabelOffset(7.0f * kOversampling);
}

/// The points that have a place.
vtkSmartPointer<vtkTable> pointsOf(const Series& series, bool logX, bool logY) {
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName("y");
  for (size_t i = 0; i < series.x.size(); ++i) {
    const double a = axisCoordinate(series.x[i], logX), b = axisCoordinate(series.y[i], logY);
    if (std::isnan(a) || std::isnan(b)) continue;
    x->InsertNextValue(a);
    y->InsertNextValue(b);
  }
  auto table = vtkSmartPointer<vtkTable>::New();
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

void addSeries(vtkChartXY& plot, const Series& series, vtkTable* points, Rgb8 colour) {
  vtkPlot* p = plot.AddPlot(series.bars ? vtkChart::BAR : vtkChart::LINE);
  p->SetInputData(points, 0, 1);
  p->SetColor(colour.r, colour.g, colour.b, 255);
  if (series.bars) {
    p->GetPen()->SetLineType(vtkPen::NO_PEN);
    return;
  }
  p->SetWidth(2.0f * kOversampling);
  if (series.dashed) p->GetPen()->SetLineType(vtkPen::DASH_LINE);
  if (auto* line = vtkPlotLine::SafeDownCast(p)) {
    // Points of a spectrum would cover its line and each other.
    constexpr size_t kMostMarked = 60;
    line->SetMarkerStyle(series.dashed || series.x.size() > kMostMarked ? vtkPlotPoints::NONE : vtkPlotPoints::CIRCLE);
    line->SetMarkerSize(7.0f * kOversampling);
  }
}

}  // namespace

void addPanel(vtkContextScene& scene, const Chart& chart, const PanelPlace& place) {
  std::vector<double> allX, allY;
  std::vector<LegendEntry> legend;
  bool bars = false;
  for (size_t i = 0; i < chart.series.size(); ++i) {
    const Series& s = chart.series[i];
    allX.insert(allX.end(), s.x.begin(), s.x.end());
    allY.insert(allY.end(), s.y.begin(), s.y.end());
    bars |= s.bars;
    if (!s.name.empty()) legend.push_back({s.name, seriesColour(i), s.dashed, s.bars});
  }
  const AxisLayout across = chart.categories.empty() ? layOutAxis(allX, chart.logX, chart.xTicks, Zero::Ignored) : layOutCategories(chart.categories);
  const AxisLayout up = layOutAxis(allY, chart.logY, {}, bars || chart.yFromZero ? Zero::Always : Zero::IfNear);
  const auto named = [](const std::string& label, const AxisLayout& axis) { return axis.power.empty() ? label : label + " (" + axis.power + ")"; };

  vtkNew<PanelText> text;
  const float headerHeight = text->layOut(place.left, place.bottom + place.height, place.width, chart.title, legend);
  const float left = place.left + (chart.yLabel.empty() ? 0.0f : kNameRoom), bottom = place.bottom + (chart.xLabel.empty() ? 0.0f : kNameRoom);
  const float width = place.left + place.width - left, height = place.bottom + place.height - headerHeight - bottom;
  text->nameAxis(left + 0.5f * width, place.bottom + 0.5f * kNameRoom, named(chart.xLabel, across), false);
  text->nameAxis(place.left + 0.5f * kNameRoom, bottom + 0.5f * height, named(chart.yLabel, up), true);
  scene.AddItem(text);

  vtkNew<vtkChartXY> plot;
  plot->SetAutoSize(false);
  plot->SetLayoutStrategy(vtkChart::FILL_RECT);
  plot->SetSize(vtkRectf(left, bottom, width, height));
  plot->SetShowLegend(false);
  plot->SetBarWidthFraction(0.6f);
  setAxis(*plot->GetAxis(vtkAxis::BOTTOM), across);
  setAxis(*plot->GetAxis(vtkAxis::LEFT), up);
  for (size_t i = 0; i < chart.series.size(); ++i) {
    const auto points = pointsOf(chart.series[i], chart.logX && chart.categories.empty(), chart.logY);
    if (points->GetNumberOfRows() > 0) addSeries(*plot, chart.series[i], points, seriesColour(i));
  }
  scene.AddItem(plot);
}

}  // namespace pitviper
