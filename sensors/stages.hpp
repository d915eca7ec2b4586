#pragma once
// Stages of a sensor as rooms: a file pair each (.cpp, .glsl) with its table of parameters; a row in stages.cpp registers it.
#include "sim/model/simulation.hpp"
#include "sim/parameters/registry.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

struct StageModel {
  std::string name;  ///< what `stage:` says
  std::string description;
  std::vector<Parameter> parameters;  ///< besides `stage`
  /// Margin, cells and what makes it. The camera has its outputs. Errors: UserError.
  std::function<StageChoice(const Record&, const Camera&)> read;
  /// Paths and texts of its shader files, where those are not compiled in with this folder.
  std::vector<std::pair<std::string, std::string>> shaders = {};
  bool isDetector = false;  ///< it makes counts
};

StageModel distortionModel();
StageModel pointSpreadModel();
StageModel vignettingModel();
StageModel lensEmissionModel();
StageModel detectorModel();

Registry<StageModel>& stageModels();
/// All keys of a stage of a model.
ParameterTable stageTable(const StageModel& model);
/// From what a user wrote. Every mistake is a UserError.
StageChoice readStage(const Value& value, const Camera& camera);

}  // namespace pitviper
