#include "sim/model/stage.hpp"

#include <algorithm>

#include "sim/model/simulation.hpp"

namespace pitviper {
namespace {

/// The largest of what each list of stages gives.
template <class OfStages>
int mostOf(const Camera& camera, const OfStages& of) {
  int most = of(camera.stages);
  for (const auto& [channel, own] : camera.ownChannels) most = std::max(most, of(own.stages));
  return most;
}

bool takesPoints(const std::vector<StageChoice>& stages) {
  return std::any_of(stages.begin(), stages.end(), [](const StageChoice& s) { return s.takesPoints; });
}

}  // namespace

int marginOf(const Camera& camera) {
  return mostOf(camera, [](const std::vector<StageChoice>& stages) {
    int margin = 0;
    for (const StageChoice& s : stages) margin += s.margin_px;
    return margin;
  });
}

int cellsOf(const Camera& camera) {
  return mostOf(camera, [](const std::vector<StageChoice>& stages) {
    int cells = 1;
    for (const StageChoice& s : stages) cells = std::max(cells, s.cells);
    return cells;
  });
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
  drawn.pointsApart = mostOf(camera, [](const std::vector<StageChoice>& stages) { return takesPoints(stages) ? 1 : 0; }) > 0;
  drawn.stages.clear();
  for (auto& [channel, own] : drawn.ownChannels) own.stages.clear();
  return drawn;
}

int warmUpOf(const Camera& camera, double step_s) {
  return mostOf(camera, [step_s](const std::vector<StageChoice>& stages) {
    int frames = 0;
    for (const StageChoice& s : stages)
      if (s.warmUp_frames) frames += s.warmUp_frames(step_s);
    return frames;
  });
}

double pixelShareOf(const Camera& camera, const ChannelOutput& output, double focalLength_m, double x, double y) {
  const auto lens = [&](double u, double v) {
    for (const StageChoice& s : camera.stagesOf(output.channel))
      if (s.pixelShare) return s.pixelShare(output, focalLength_m, u, v);
    return std::abs(u) < 0.5 && std::abs(v) < 0.5 ? 1.0 : 0.0;
  };
  const DetectorLaw* law = detectorOf(camera, output.channel);
  if (!law || !(law->crosstalk > 0.0)) return lens(x, y);
  return (1.0 - 4.0 * law->crosstalk) * lens(x, y) + law->crosstalk * (lens(x - 1.0, y) + lens(x + 1.0, y) + lens(x, y - 1.0) + lens(x, y + 1.0));
}

double ownLightOf(const Camera& camera, const ChannelOutput& output, double axis_sr, double exposure_s) {
  double sum = 0.0;
  for (const StageChoice& s : camera.stagesOf(output.channel))
    if (s.ownLight) sum += s.ownLight(output, axis_sr) * (output.perExposure ? exposure_s : 1.0);
  return sum;
}

const DetectorLaw* detectorOf(const Camera& camera, const std::string& channel) {
  for (const StageChoice& s : camera.stagesOf(channel))
    if (s.detector) return &*s.detector;
  return nullptr;
}

bool hasDetector(const Camera& camera) {
  return std::any_of(camera.outputs.begin(), camera.outputs.end(), [&](const ChannelOutput& o) { return detectorOf(camera, o.channel) != nullptr; });
}

glm::dvec2 placeOnFilm(const Camera& camera, double focalLength_m, const glm::dvec2& column_row) {
  const Pinhole& p = camera.pinhole;
  const glm::dvec2 middle(0.5 * p.width, 0.5 * p.height), pitch(p.pitchX_m, -p.pitchY_m);
  glm::dvec2 film = (column_row - middle) * pitch;
  for (const StageChoice& s : camera.stages)  // what moves a picture is all channels' own
    if (s.place) film = s.place(film, focalLength_m);
  return film / pitch + middle;
}

}  // namespace pitviper
