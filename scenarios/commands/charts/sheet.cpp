#include "scenarios/commands/charts/sheet.hpp"

#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <stdexcept>

#include "scenarios/commands/charts/canvas.hpp"
#include "scenarios/commands/charts/panel.hpp"
#include "scenarios/commands/charts/style.hpp"

namespace pitviper {

using namespace chart_style;

Rgb8Image drawSheet(const std::vector<Chart>& charts, int columns) {
  const int count = static_cast<int>(charts.size()), across = std::min(columns, count), rows = (count + across - 1) / across;
  const int width = across * (kPanelWidth_px + kMargin_px) + kMargin_px, height = rows * (kPanelHeight_px + kMargin_px) + kMargin_px;
  if (width > 16384 / kOversampling || height > 16384 / kOversampling) throw std::invalid_argument("too many panels for one sheet");
  return drawnOffScreen(width, height, [&](vtkRenderer& renderer) {
    vtkNew<vtkContextActor> actor;
    actor->GetScene()->SetRenderer(&renderer);
    renderer.AddActor(actor);
    for (int i = 0; i < count; ++i) {
      const int left = kMargin_px + i % across * (kPanelWidth_px + kMargin_px), top = kMargin_px + i / across * (kPanelHeight_px + kMargin_px);
      constexpr float kScale = kOversampling;
      addPanel(
          *actor->GetScene(), charts[static_cast<size_t>(i)],
          {kScale * static_cast<float>(left), kScale * static_cast<float>(height - top - kPanelHeight_px), kScale * kPanelWidth_px, kScale * kPanelHeight_px});
    }
  });
}

}  // namespace pitviper
