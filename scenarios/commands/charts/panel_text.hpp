#pragma once
// What is written around a plot: the title, below it the legend in rows (above the plot, so that it never lies over a curve), and the
// axes' names, which VTK would put over the numbers of large fonts.
#include <vtkContextItem.h>

#include <string>
#include <vector>

#include "scenarios/commands/charts/style.hpp"

namespace pitviper {

struct LegendEntry {
  std::string name;
  Rgb8 colour;
  bool dashed = false, bar = false;
};

class PanelText final : public vtkContextItem {
 public:
  vtkTypeMacro(PanelText, vtkContextItem) static PanelText* New();
  /// Title and legend within `width` from `left`, down from `top`; drawn pixels. Gives their height.
  float layOut(float left, float top, float width, const std::string& title, const std::vector<LegendEntry>& entries);
  /// The name of an axis around a point; `upright`: reading upwards.
  void nameAxis(float x, float y, const std::string& name, bool upright) { names_.push_back({name, x, y, upright}); }
  bool Paint(vtkContext2D* painter) override;

 private:
  struct Placed {
    LegendEntry entry;
    float x, y;  ///< left end, middle of the row
  };
  std::string title_;
  float left_ = 0.0f, titleMiddle_ = 0.0f;
  int titleSize_px_ = chart_style::kTitle_px;  ///< smaller where the title is long
  std::vector<Placed> placed_;
  struct AxisName {
    std::string name;
    float x, y;
    bool upright;
  };
  std::vector<AxisName> names_;
};

}  // namespace pitviper
