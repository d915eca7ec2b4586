#pragma once
// Sinks as rooms: a file each with its table of parameters; a row in sink_models.cpp registers it.
#include "sim/model/sink.hpp"
#include "sim/parameters/registry.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

struct SinkModel {
  std::string name;  ///< what `sink:` says
  std::string description;
  std::vector<Parameter> parameters;  ///< besides `sink`
  /// Errors: UserError. The record does not outlive the call; the simulation has its cameras.
  std::function<decltype(SinkChoice::make)(const Record&, const Simulation&)> read;
};

Registry<SinkModel>& sinkModels();
/// All keys of a sink of a model.
ParameterTable sinkTable(const SinkModel& model);

/// `folder`, for sinks that write files; what it says, which never leads out of the run's own. Errors: UserError.
Parameter folderParameter();
std::filesystem::path readFolder(const Record& record);

/// From what a user wrote: a map, or its name alone. Every mistake is a UserError.
SinkChoice readSink(const Value& value, const Simulation& simulation);
/// The same as if it had been written by its name, with these keys.
SinkChoice sinkNamed(const std::string& name, const Simulation& simulation, const std::vector<std::pair<std::string, std::string>>& keys = {});

SinkModel filesSink();
SinkModel previewsSink();
SinkModel sheetSink();
SinkModel videoSink();
SinkModel truthSink();
SinkModel sharedMemorySink();
SinkModel gigeSink();
SinkModel cocoSink();
SinkModel yoloSink();
SinkModel hdf5Sink();

}  // namespace pitviper
