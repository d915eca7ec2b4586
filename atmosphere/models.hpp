#pragma once
// Atmospheres as rooms: a file each (.cpp, .glsl) with its table of parameters; a row in models.cpp registers it.
// From the table come reading, units, ranges and the key reference.
#include <filesystem>
#include <functional>
#include <map>

#include "sim/model/atmosphere.hpp"
#include "sim/parameters/model_record.hpp"
#include "sim/parameters/registry.hpp"
#include "sim/parameters/table.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// An air as a scenario or the library has it: a record of the model's table, its spectra read.
struct AirRecord : ModelRecord {
  std::filesystem::path folder;   ///< that the files it names are relative to
  std::filesystem::path library;  ///< atmosphere/library: climates and aerosols by name
  double ground_m = 0.0;          ///< height of the ground above the sea
};

struct AirModel {
  std::string name;  ///< what `model:` says
  std::string description;
  std::vector<std::string> marks;     ///< keys that say that an air is of this model where `model` does not
  std::vector<Parameter> parameters;  ///< besides `model` and `library`; the ranges of spectra are those of their values
  std::function<std::shared_ptr<const Atmosphere>(const AirRecord&)> make;
  /// Paths and texts of its shader files, where those are not compiled in with this folder.
  std::vector<std::pair<std::string, std::string>> shaders = {};
};

Registry<AirModel>& airModels();

/// The keys that all airs have.
ParameterTable commonAirTable();
/// All keys of an air of a model.
ParameterTable airTable(const AirModel& model);
/// All keys of any: what is none of them is a mistake whatever the model.
ParameterTable anyAirTable();

/// A key of an air that says of which model it is.
struct AirMark {
  std::string key;
  const AirModel* model;
};
/// Those among the keys of an air.
std::vector<AirMark> marksOf(const Value& air);

/// The air that keys describe; none where `model` says so. `spectrum`: reads a spectrum's value as its parameter says. Errors: UserError, also where the keys
/// are of several models, of none, or one of them is of another model.
std::shared_ptr<const Atmosphere> makeAir(const Value& air, const std::filesystem::path& folder, const std::filesystem::path& library, double ground_m,
                                          const SpectrumOf& spectrum);

AirModel homogeneousModel();
AirModel layeredModel();
AirModel tape7Model();
AirModel csvModel();
AirModel columnsModel();

}  // namespace pitviper
