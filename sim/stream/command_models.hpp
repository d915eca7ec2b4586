#pragma once
// Commands as rooms: a file each with its table of parameters; a row in command_models.cpp registers it. The same words serve in a scenario's
// `commands` and wherever else they come from.
#include "sim/model/simulation.hpp"
#include "sim/parameters/registry.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

struct CommandModel {
  std::string name;  ///< what `command:` says
  std::string description;
  std::vector<Parameter> parameters;  ///< besides `command` and `at`
  /// What it changes. The simulation outlives that. Errors: UserError, for what is not there too.
  std::function<decltype(Command::change)(const Record&, const Simulation&)> read;
};

Registry<CommandModel>& commandModels();
/// All keys of a command of a model.
ParameterTable commandTable(const CommandModel& model);

/// From what a user wrote; where it does not say when, from `now_s` on. Every mistake is a UserError.
Command readCommand(const Value& value, const Simulation& simulation, double now_s);

/// The same from keys and their values; `from`: who says so, for messages.
Command commandOf(const std::vector<std::pair<std::string, std::string>>& words, const std::string& from, const Simulation& simulation, double now_s);

/// The index of what a key names. UserError where there is no such thing.
int entityOf(const Record& record, const Simulation& simulation);
int lightOf(const Record& record, const Simulation& simulation);
int cameraOf(const Record& record, const Simulation& simulation);
int plumeOf(const Record& record, const Simulation& simulation);  ///< of Simulation::fields
int storeOf(const Record& record, const Simulation& simulation);

/// That a camera's follower takes commands. Errors: UserError at a key that would point it.
void requireTakesCommands(const Camera& camera, const Location& where);

CommandModel moveCommand();
CommandModel speedCommand();
CommandModel throttleCommand();
CommandModel ejectCommand();
CommandModel temperatureCommand();
CommandModel lightCommand();
CommandModel lookCommand();
CommandModel pointCommand();
CommandModel triggerCommand();
CommandModel gainCommand();

}  // namespace pitviper
