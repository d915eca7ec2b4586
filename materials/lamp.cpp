// A lamp: a spectrum of intensity, and a factor over time.
#include "materials/lights.hpp"

namespace pitviper {

LightModel lampModel() {
  return {"lamp",
          "A point light (flare, beacon, lamp) of a given intensity.",
          {required(atLeast(spectrum("intensity", "W/(sr um)", "spectral radiant intensity"), 0)), levelParameter()},
          [](const ModelRecord& r, PointLight& light) {
            light.intensity = r.spectrum("intensity");
            readLevel(r.record, light);
          }};
}

}  // namespace pitviper
