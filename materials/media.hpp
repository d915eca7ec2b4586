#pragma once
// Media as rooms: what fills a body, a file each with its table of parameters; a row in media.cpp registers it.
#include "sim/model/medium.hpp"
#include "sim/parameters/model_record.hpp"
#include "sim/parameters/registry.hpp"

namespace pitviper {

struct MediumModel {
  std::string name;  ///< what `medium:` of a material says
  std::string description;
  std::vector<Parameter> parameters;  ///< besides those of all materials; the ranges of spectra are those of their values
  std::function<Medium(const ModelRecord&)> make;
};

Registry<MediumModel>& mediumModels();
/// The model that a material's map asks for: by `medium`, or by `absorption`, which is of a gas. Null: it is a surface. Errors: UserError.
const MediumModel* askedMedium(const Value& material);

}  // namespace pitviper
