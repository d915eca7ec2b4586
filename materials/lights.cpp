#include "materials/lights.hpp"

#include "sim/parameters/asked_model.hpp"

namespace pitviper {

Registry<LightModel>& lightModels() {
  static Registry<LightModel> all("light", {lampModel()});
  return all;
}

const LightModel& askedLight(const Value& light) { return light.find("model") ? askedModel(lightModels(), light, "model") : *lightModels().named("lamp"); }

}  // namespace pitviper
