#pragma once
// Point lights as rooms: what one sends out and when, a file each with its table of parameters; a row in lights.cpp registers it.
#include "sim/parameters/model_record.hpp"
#include "sim/parameters/registry.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

struct LightModel {
  std::string name;  ///< what `model:` of a light says
  std::string description;
  std::vector<Parameter> parameters;  ///< besides name, radius, visible and place; the ranges of spectra are those of their values
  /// Gives a light its intensity and the course of its level.
  std::function<void(const ModelRecord&, PointLight&)> make;
};

Registry<LightModel>& lightModels();
/// The model that a light's map asks for by `model`; without it a lamp. Errors: UserError.
const LightModel& askedLight(const Value& light);

LightModel lampModel();

}  // namespace pitviper
