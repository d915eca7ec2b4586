#pragma once
// What stands on the lab bench: one camera before one target.
#include <algorithm>
#include <string>
#include <vector>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/measure_bench.hpp"
#include "sim/run/run.hpp"

namespace pitviper {

/// A side of a pixel, for targets with edges: on cells of a half or a third of it some each.
constexpr int kSubpixels = 4;
/// Everything is a kilometre away, in empty space, before a cold background.
constexpr double kFar_m = 1000.0;

/// A picture of counts as numbers.
using Counts = std::vector<float>;

/// One camera before one target, and its frames of a channel's counts.
class Setup {
 public:
  /// `samples`: subpixels a side, for targets with edges.
  Setup(const BenchOptions& options, const std::string& target, int frames, int samples = 1, const std::string& commands = "");
  const Simulation& simulation() const { return simulation_; }
  const Camera& camera() const { return simulation_.cameras.front(); }
  /// Columns and rows of the camera's whole film.
  glm::ivec2 film() const { return film_; }

  /// Calls of(frame's number, counts of a layer) for each.
  template <class Of>
  void each(const std::string& layer, const Of& of) const {
    runFrames(simulation_, shaderLibrary(), {0, simulation_.time.frames - 1}, [&](const std::shared_ptr<const Frame>& f) {
      for (const FrameLayer& l : f->layers)
        if (l.name == layer) of(f->number, l.pixels);
    });
  }

 private:
  Simulation simulation_;
  glm::ivec2 film_{0};
};

/// A black plate across the line of sight, from left to right of the film's middle.
std::string plate(const char* name, double left_m, double right_m, double halfHeight_m, double kelvin, double roll_deg = 0.0, double range_m = kFar_m);

/// Pixels that are far from what those around them say in the mean of a flat field: by more than ten times what half of all are off.
std::vector<char> badPixels(const std::vector<double>& mean);

/// Each of them becomes the mean of the good ones around it, as a camera's own electronics would have it.
template <class Picture>
void mend(Picture& picture, const std::vector<char>& bad, int width) {
  const int height = static_cast<int>(bad.size()) / width;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * width + x);
      if (!bad[at]) continue;
      double sum = 0.0;
      int count = 0;
      for (int j = std::max(0, y - 1); j <= std::min(height - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(width - 1, x + 1); ++i)
          if (!bad[static_cast<std::size_t>(j * width + i)]) sum += static_cast<double>(picture[static_cast<std::size_t>(j * width + i)]), ++count;
      if (count > 0) picture[at] = static_cast<typename Picture::value_type>(sum / count);
    }
}

}  // namespace pitviper
