#include "materials/lights.hpp"

#include "sim/parameters/asked_model.hpp"

namespace pitviper {

Registry<LightModel>& lightModels() {
  static Registry<LightModel> all("light", {lampModel(), spotModel(), areaModel()});
  return all;
}

Parameter levelParameter() {
  return within(course("level", "", "factor on the intensity: rows [time, factor], dark outside unless said otherwise; or a number"), 0.0, 1e6);
}

void readLevel(const Record& r, PointLight& light) {
  if (r.given("level")) light.level = readCourse(r.value("level"), "", "level", 0.0, 1e6, TimeCourse::Outside::Zero);
}

const LightModel& askedLight(const Value& light) { return light.find("model") ? askedModel(lightModels(), light, "model") : *lightModels().named("lamp"); }

}  // namespace pitviper
