#pragma once
// Reflection models as rooms: a file pair each (.cpp, and .glsl where it has a lobe) with its table of parameters; a row in models.cpp registers it.
// From the table come reading, units, ranges, the key reference and the fingerprint.
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "materials/refractive_index.hpp"
#include "sim/model/component.hpp"
#include "sim/model/view_spectrum.hpp"
#include "sim/parameters/model_record.hpp"
#include "sim/parameters/registry.hpp"
#include "sim/parameters/table.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// A component as a scenario has it: a record of the model's table, its spectra read.
struct ComponentRecord : ModelRecord {
  double state = 0.0;            ///< of its model's state parameter
  SpectrumOf spectrumOf = {};    ///< for spectra within its parameters
  SubstanceOf substanceOf = {};  ///< for named substances
  std::filesystem::path base = {};  ///< where relative names of files begin
};

/// What a model makes of a record.
struct MadeReflection {
  std::vector<std::shared_ptr<ReflectionComponent>> components;  ///< one or more: facets and what lies beneath them, parts of a table over three angles
  std::shared_ptr<const ViewModel> transmission;  ///< what the whole lets through; null: nothing
  double statesPerUnit = 0.0;                     ///< so many states, per unit of it, resolve what it does; 0: as many as the model has
  Fingerprint within;                             ///< of what its parameters name besides what they say
  std::vector<std::string> notes;                 ///< what was changed or left out of what the user gave
};

/// A parameter that a texture may drive over a surface: a number, or a texture of them.
struct StateParameter {
  std::string key, unit, description;
  double low = 0.0, high = 1.0;  ///< what it may be
  double usual = 0.0;            ///< where it is not given
  int entries = 2;               ///< so many components stand for a texture's range; between two of them the surface is linear
};

struct ReflectionModel {
  std::string name;  ///< what `reflection:` says
  std::string description;
  std::vector<Parameter> parameters;  ///< besides `reflection` and `modifier`; the ranges of spectra are those of their values
  std::function<std::shared_ptr<ReflectionComponent>(const ComponentRecord&)> make;
  /// How much of all that a scenario may hold of it (1) one takes: what costs time or memory to read. None: nothing to speak of.
  std::function<double(const Record&)> share = {};
  std::optional<StateParameter> state = {};
  /// Path and text of its lobe's body, where that is not compiled in with this folder.
  std::pair<std::string, std::string> shader = {};
  /// Instead of `make`, where there is more to it than one component.
  std::function<MadeReflection(const ComponentRecord&)> makeAll = {};
};

Registry<ReflectionModel>& reflectionModels();

/// All keys of a component of a model.
ParameterTable componentTable(const ReflectionModel& model);
/// All keys of any model: what is none of them is a mistake whatever the model.
ParameterTable anyComponentTable();

/// Makes a component of a state.
using ComponentMaker = std::function<MadeReflection(double state)>;

/// Reads a component but for its state. `record` must outlive what it returns. `spectrum`: reads a spectrum's value as its parameter says; `base`: where
/// relative names of files begin.
ComponentMaker componentMaker(const ReflectionModel& model, const Record& record, const SpectrumOf& spectrum, const SubstanceOf& substance,
                              const std::filesystem::path& base);

}  // namespace pitviper
