#include "sim/stream/sink_models.hpp"

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
  static Registry<SinkModel> all("sink", {filesSink(), previewsSink()});
  return all;
}

ParameterTable sinkTable(const SinkModel& model) {
  ParameterTable t{"sink: " + model.name, model.description, {required(text("sink", "`" + model.name + "`"))}};
  t.parameters.insert(t.parameters.end(), model.parameters.begin(), model.parameters.end());
  return t;
}

SinkChoice readSink(const Value& value) {
  Value map = value;
  if (value.kind == Value::Kind::Scalar) {
    map = {};
    map.kind = Value::Kind::Map;
    map.where = value.where;
    map.entries = {{"sink", value}};
    map.keyPlaces = {value.where};
  }
  std::vector<std::string> names;
  std::string all;
  for (const SinkModel& m : sinkModels().all()) names.push_back(m.name), all += (all.empty() ? "" : ", ") + m.name;
  const Value* word = asMap(map, "a sink").find("sink");
  if (!word) throw UserError(value.where, "missing key 'sink'", "one of " + all, "add 'sink:'");
  const std::string name = readText(*word, "sink");
  const SinkModel* model = sinkModels().named(name);
  if (!model) {
    const std::string near = nearestWord(name, names);
    throw UserError(word->where, "there is no sink '" + name.substr(0, 60) + "'", "one of " + all, near.empty() ? "choose one" : "did you mean '" + near + "'?");
  }
  const ParameterTable table = sinkTable(*model);
  return {value.where, model->read(Record(map, table))};
}

SinkChoice sinkNamed(const std::string& name) {
  Value word;
  word.kind = Value::Kind::Scalar;
  word.text = name;
  return readSink(word);
}

}  // namespace pitviper
