#pragma once
// Reflection models as rooms: a file pair each (.cpp, and .glsl where it has a lobe), opening with its table of parameters; a row in models.cpp registers it.
// From the table come reading, units, ranges, the key reference and the fingerprint.
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/model/component.hpp"
#include "sim/parameters/registry.hpp"
#include "sim/parameters/table.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// A component as a scenario has it: a record of the model's table, its spectra read.
struct ComponentRecord {
  const Record& record;
  const std::map<std::string, Spectrum>& spectra;  ///< of the parameters that are spectra, where given
  const Spectrum& spectrum(const std::string& key) const { return spectra.at(key); }
};

struct ReflectionModel {
  std::string name;  ///< what `reflection:` says
  std::string description;
  std::vector<Parameter> parameters;  ///< besides `reflection` and `modifier`; the ranges of spectra are those of their values
  std::function<std::shared_ptr<ReflectionComponent>(const ComponentRecord&)> make;
  /// How much of all that a scenario may hold of it (1) one takes: what costs time or memory to read. None: nothing to speak of.
  std::function<double(const Record&)> share = {};
  /// Path and text of its lobe's body, where that is not compiled in with this folder.
  std::pair<std::string, std::string> shader = {};
};

Registry<ReflectionModel>& reflectionModels();

/// All keys of a component of a model.
ParameterTable componentTable(const ReflectionModel& model);
/// All keys of any model: what is none of them is a mistake whatever the model.
ParameterTable anyComponentTable();

/// Reads a component. `spectrum`: reads a spectrum's value as its parameter says.
std::shared_ptr<const ReflectionComponent> makeComponent(const ReflectionModel& model, const Record& record,
                                                         const std::function<Spectrum(const Value&, const Parameter&)>& spectrum);

}  // namespace pitviper
