#include "sim/stream/sink_models.hpp"

#include "sim/parameters/asked_model.hpp"

namespace pitviper {

Parameter folderParameter() { return withDefault(text("folder", "below the one that the run writes into"), "."); }

std::filesystem::path readFolder(const Record& r) {
  const std::filesystem::path folder = r.text("folder");
  bool outside = folder.is_absolute();
  for (const auto& part : folder) outside |= part == "..";
  if (outside)
    throw UserError(r.where("folder"), "a folder outside that of the run", "a folder below it, such as 'folder: seeker'", "write a relative path without '..'");
  return folder;
}

Registry<SinkModel>& sinkModels() {
  static Registry<SinkModel> all(
      "sink", {filesSink(), previewsSink(), sheetSink(), videoSink(), truthSink(), sharedMemorySink(), gigeSink(), cocoSink(), yoloSink(), hdf5Sink()});
  return all;
}

ParameterTable sinkTable(const SinkModel& model) { return tableOf(model, "sink"); }

SinkChoice readSink(const Value& value, const Simulation& simulation) {
  Value map = value;
  if (value.kind == Value::Kind::Scalar) {
    map = {};
    map.kind = Value::Kind::Map;
    map.where = value.where;
    map.entries = {{"sink", value}};
    map.keyPlaces = {value.where};
  }
  const SinkModel& model = askedModel(sinkModels(), map, "sink");
  const ParameterTable table = sinkTable(model);
  return {value.where, model.read(Record(map, table), simulation)};
}

SinkChoice sinkNamed(const std::string& name, const Simulation& simulation, const std::vector<std::pair<std::string, std::string>>& keys) {
  Value map;
  map.kind = Value::Kind::Map;
  const auto add = [&](const std::string& key, const std::string& text) {
    Value word;
    word.kind = Value::Kind::Scalar;
    word.text = text;
    map.entries.emplace_back(key, word);
    map.keyPlaces.emplace_back();
  };
  add("sink", name);
  for (const auto& [key, text] : keys) add(key, text);
  return readSink(map, simulation);
}

}  // namespace pitviper
