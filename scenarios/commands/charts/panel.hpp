#pragma once
// One chart as a panel of the sheet.
#include <vtkContextScene.h>

#include "scenarios/commands/charts.hpp"

namespace pitviper {

/// A rectangle in drawn pixels from the lower left.
struct PanelPlace {
  float left, bottom, width, height;
};

void addPanel(vtkContextScene& scene, const Chart& chart, const PanelPlace& place);

}  // namespace pitviper
