// A lamp: a spectrum of intensity, and a factor over time.
#include "materials/lights.hpp"

namespace pitviper {
LightModel lampModel() {
  return {"lamp",
          "A point light (flare, beacon, lamp) of a given intensity.",
          {required(atLeast(spectrum("intensity", "W/(sr um)", "spectral radiant intensity"), 0)),
           within(course("level", "", "factor on the intensity: rows [time, factor], dark outside unless said otherwise; or a number"), 0.0, 1e6)},
          [](const ModelRecord& r, PointLight& light) {
            light.intensity = r.spectrum("intensity");
            if (r.record.given("level")) light.level = readCourse(r.record.value("level"), "", "level", 0.0, 1e6, TimeCourse::Outside::Zero);
          }};
}

}  // namespace pitviper
