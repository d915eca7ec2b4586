#pragma once
// Lights as rooms: what one sends out, where to and when, a file each with its table of parameters; a row in lights.cpp registers it.
#include "sim/parameters/model_record.hpp"
#include "sim/parameters/registry.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

/// One of the points that stand for a light.
struct LightPoint {
  glm::dvec3 offset_m{0.0};  ///< in the light's axes: x forward, y left, z up
  double share = 1.0;        ///< of its intensity
};

struct LightModel {
  std::string name;  ///< what `model:` of a light says
  std::string description;
  std::vector<Parameter> parameters;  ///< besides name, radius, visible and place; the ranges of spectra are those of their values
  /// Gives a light its intensity, its pattern and the course of its level.
  std::function<void(const ModelRecord&, PointLight&)> make;
  bool hasAxes = false;  ///< it is turned: by heading, pitch and roll, by its motion and carrier, or towards what it looks at
  /// Path and text of its pattern's body, where that is not compiled in with this folder.
  std::pair<std::string, std::string> shader = {};
  /// The points that stand for it, of shares that add up to 1. None: it is one.
  std::function<std::vector<LightPoint>(const Record&)> points = {};
};

Registry<LightModel>& lightModels();
/// The model that a light's map asks for by `model`; without it a lamp. Errors: UserError.
const LightModel& askedLight(const Value& light);

LightModel lampModel();
LightModel spotModel();
LightModel areaModel();

/// The course of a light's level, as several models have it.
Parameter levelParameter();
void readLevel(const Record& record, PointLight& light);

}  // namespace pitviper
