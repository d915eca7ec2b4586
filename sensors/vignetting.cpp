// Vignetting: what mounts and edges of lenses cut off the light of oblique directions, besides cos^4, which a pixel's solid angle and the aperture have.
#include <algorithm>

#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"

namespace pitviper {
namespace {

struct Vignette {
  double v1 = 0.0, v2 = 0.0, v3 = 0.0;
  double operator()(double tan2) const { return std::clamp(1.0 + tan2 * (v1 + tan2 * (v2 + tan2 * v3)), 0.0, 1.0); }
};

class VignettingStage final : public SensorStage {
 public:
  VignettingStage(const Vignette& vignette, const Pinhole& pinhole) : vignette_(vignette), pinhole_(pinhole) {}
  void run(const SensorTick& tick, SensorPictures& pictures) override {
    const double perFocal = 1.0 / (pictures.cells * (tick.focalLength_m > 0.0 ? tick.focalLength_m : pinhole_.focalLength_m));
    const auto passed = [&](double column, double row) {
      const double x = (column - 0.5 * pictures.width) * pinhole_.pitchX_m * perFocal, y = (row - 0.5 * pictures.height) * pinhole_.pitchY_m * perFocal;
      return vignette_(x * x + y * y);
    };
    for (SensorPoint& p : pictures.points)
      if (pictures.outputs[p.output].behindOptics) p.value *= passed(p.column, p.row);
    for (std::size_t o = 0; o < pictures.outputs.size(); ++o) {
      if (!pictures.outputs[o].behindOptics) continue;
      std::vector<float>& picture = pictures.values(o);
      std::size_t c = 0;
      for (int y = 0; y < pictures.height; ++y)
        for (int x = 0; x < pictures.width; ++x, ++c) picture[c] = static_cast<float>(static_cast<double>(picture[c]) * passed(x + 0.5, y + 0.5));
    }
  }

 private:
  Vignette vignette_;
  Pinhole pinhole_;
};

Parameter coefficient(const char* key) { return withDefault(within(number(key, "", "of tan^2 of the angle from the axis, to this power"), -1e4, 1e4), "0"); }

}  // namespace

StageModel vignettingModel() {
  return {"vignetting",
          "Light of oblique directions that mounts and edges of lenses cut off: a share 1 + v1 tan^2 + v2 tan^4 + v3 tan^6 of the angle from the axis, within "
          "0 and 1, is left, besides cos^4. Of quantities behind the optics; radiance stays what arrives at the aperture.",
          {coefficient("v1"), coefficient("v2"), coefficient("v3"), withDefault(integer("cells", "cells a side of a pixel", 1, 16), "1")},
          [](const Record& r, const Camera& camera) {
            StageChoice choice;
            choice.cells = static_cast<int>(r.integer("cells"));
            const Vignette vignette{r.number("v1"), r.number("v2"), r.number("v3")};
            if (!(vignette.v1 < 0.0 || vignette.v2 < 0.0 || vignette.v3 < 0.0))
              throw UserError(r.where(), "a vignetting that takes nothing away", "one of v1, v2 and v3 below 0", "give one, or remove the stage");
            choice.make = [vignette, p = camera.pinhole](const ShaderLibrary&) { return std::make_unique<VignettingStage>(vignette, p); };
            return choice;
          }};
}

}  // namespace pitviper
