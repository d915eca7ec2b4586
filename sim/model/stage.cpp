#include "sim/model/stage.hpp"

#include <algorithm>

#include "sim/model/simulation.hpp"

namespace pitviper {

int marginOf(const Camera& camera) {
  int margin = 0;
  for (const StageChoice& s : camera.stages) margin += s.margin_px;
  return margin;
}

int cellsOf(const Camera& camera) {
  int cells = 1;
  for (const StageChoice& s : camera.stages) cells = std::max(cells, s.cells);
  return cells;
}

Camera drawnCamera(const Camera& camera) {
  Camera drawn = camera;
  const int cells = cellsOf(camera), margin = marginOf(camera);
  drawn.pinhole.width = (camera.pinhole.width + 2 * margin) * cells;
  drawn.pinhole.height = (camera.pinhole.height + 2 * margin) * cells;
  drawn.pinhole.pitchX_m /= cells;
  drawn.pinhole.pitchY_m /= cells;
  drawn.samples = (camera.samples + cells - 1) / cells;
  drawn.smallBody_px *= cells;
  drawn.stages.clear();
  return drawn;
}

}  // namespace pitviper
