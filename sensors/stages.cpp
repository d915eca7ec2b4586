#include "sensors/stages.hpp"

#include "sim/parameters/asked_model.hpp"

namespace pitviper {
namespace {

/// Far more than any point spread function that a film holds.
constexpr int kMostMargin_px = 256, kMostCells = 16;

void addTo(Fingerprint& f, const Value& value) {
  f.add(value.text);
  for (const Value& item : value.items) addTo(f, item);
  for (const auto& [key, item] : value.entries) f.add(key), addTo(f, item);
}

}  // namespace

Registry<StageModel>& stageModels() {
  static Registry<StageModel> all("stage", {distortionModel(), pointSpreadModel(), vignettingModel(), lensEmissionModel(), detectorModel()});
  return all;
}

ParameterTable stageTable(const StageModel& model) { return tableOf(model, "stage"); }

StageChoice readStage(const Value& value, const Camera& camera) {
  const StageModel& model = askedModel(stageModels(), value, "stage");
  const ParameterTable table = stageTable(model);
  const Record record(value, table);
  StageChoice choice = model.read(record, camera);
  choice.name = model.name;
  Fingerprint f;
  f.add(model.name);
  for (const Parameter& p : model.parameters) {
    f.add(p.key);
    if (record.has(p.key)) addTo(f, record.value(p.key));
  }
  choice.fingerprint = f.bytes();
  if (choice.margin_px < 0 || choice.margin_px > kMostMargin_px || choice.cells < 1 || choice.cells > kMostCells)
    throw UserError(value.where,
                    "stage '" + model.name + "' needs " + std::to_string(choice.margin_px) + " pixels around the film and " + std::to_string(choice.cells) +
                        " cells a pixel",
                    "at most " + std::to_string(kMostMargin_px) + " and " + std::to_string(kMostCells), "ask less of it");
  return choice;
}

}  // namespace pitviper
