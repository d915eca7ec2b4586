#include "scenarios/commands/charts/panel_text.hpp"

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include "scenarios/commands/charts/style.hpp"

namespace pitviper {
namespace {

using namespace chart_style;

constexpr float kScale = kOversampling;
constexpr float kSample = 28.0f * kScale, kGap = 7.0f * kScale, kBetween = 18.0f * kScale;
constexpr float kTitleRow = 26.0f * kScale, kLegendRow = 20.0f * kScale;

float widthOf(const std::string& text, int size_px = kText_px, bool bold = false) {
  vtkNew<vtkTextProperty> font;
  setFont(*font, size_px, bold, kInk);
  int box[4] = {0, 0, 0, 0};
  vtkTextRenderer::GetInstance()->GetBoundingBox(font, text, box, 72);
  return static_cast<float>(box[1] - box[0] + 1);
}

/// A title's beginning and three dots, narrow enough; cut between UTF-8 characters.
std::string shortened(std::string title, int size_px, float width) {
  do {
    while (!title.empty() && (static_cast<unsigned char>(title.back()) & 0xC0u) == 0x80u) title.pop_back();
    if (!title.empty()) title.pop_back();
  } while (!title.empty() && widthOf(title + "...", size_px, true) > width);
  return title + "...";
}

}  // namespace

vtkStandardNewMacro(PanelText)

    float PanelText::layOut(float left, float top, float width, const std::string& title, const std::vector<LegendEntry>& entries) {
  left_ = left;
  title_ = title;
  while (titleSize_px_ > kText_px && widthOf(title, titleSize_px_, true) > width) --titleSize_px_;
  if (widthOf(title_, titleSize_px_, true) > width) title_ = shortened(title_, titleSize_px_, width);
  titleMiddle_ = top - 0.5f * kTitleRow;
  float x = left, y = top - kTitleRow - 0.5f * kLegendRow;
  for (const LegendEntry& entry : entries) {
    const float needed = kSample + kGap + widthOf(entry.name);
    if (x > left && x + needed > left + width) {
      x = left;
      y -= kLegendRow;
    }
    placed_.push_back({entry, x, y});
    x += needed + kBetween;
  }
  return placed_.empty() ? kTitleRow : top - (y - 0.5f * kLegendRow);
}

bool PanelText::Paint(vtkContext2D* painter) {
  vtkTextProperty* text = painter->GetTextProp();
  text->SetJustificationToLeft();
  text->SetVerticalJustificationToCentered();
  text->SetOrientation(0.0);
  setFont(*text, titleSize_px_, true, kInk);
  painter->DrawString(left_, titleMiddle_, title_);
  setFont(*text, kText_px, false, kInk);
  for (const Placed& p : placed_) {
    const Rgb8 c = p.entry.colour;
    painter->GetPen()->SetColor(c.r, c.g, c.b);
    painter->GetPen()->SetOpacity(255);  // plots drawn before leave theirs
    painter->GetBrush()->SetOpacity(255);
    painter->GetPen()->SetWidth(2.0f * kScale);
    painter->GetPen()->SetLineType(vtkPen::SOLID_LINE);
    painter->GetBrush()->SetColor(c.r, c.g, c.b);
    if (p.entry.bar) {
      painter->DrawRect(p.x + 0.25f * kSample, p.y - 5.0f * kScale, 0.5f * kSample, 10.0f * kScale);
    } else if (p.entry.dashed) {
      for (float at : {0.0f, 0.4f, 0.8f}) painter->DrawLine(p.x + at * kSample, p.y, p.x + (at + 0.2f) * kSample, p.y);
    } else {
      painter->DrawLine(p.x, p.y, p.x + kSample, p.y);
      painter->DrawEllipse(p.x + 0.5f * kSample, p.y, 3.0f * kScale, 3.0f * kScale);
    }
    painter->DrawString(p.x + kSample + kGap, p.y, p.entry.name);
  }
  text->SetJustificationToCentered();
  for (const AxisName& n : names_) {
    text->SetOrientation(n.upright ? 90.0 : 0.0);
    painter->DrawString(n.x, n.y, n.name);
  }
  text->SetOrientation(0.0);
  return true;
}

}  // namespace pitviper
