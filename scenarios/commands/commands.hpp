#pragma once
// The commands of the pitviper program. Each gives back an exit code: 0 done, 1 could not (machine, driver, disk), 2 a user's mistake.
#include "scenarios/commands/options.hpp"
#include "sim/gl/shader_assembler.hpp"

namespace pitviper {

/// Of each command its table, in a file of its own.
CommandLine runCommand();
CommandLine auditCommand();
CommandLine checkCommand();
CommandLine infoCommand();
CommandLine integrateCommand();
CommandLine planCommand();
CommandLine atmosphereCommand();
CommandLine materialCommand();
CommandLine measureCommand();
CommandLine skyCommand();
CommandLine keysCommand(const std::string& ofSweeps);
CommandLine streamCommand();
CommandLine selfTestCommand();
CommandLine benchCommand();
CommandLine scenarioBenchCommand();
CommandLine accuracyBenchCommand();
CommandLine firstBenchCommand();
CommandLine onceBenchCommand();
CommandLine guardBenchCommand();
CommandLine phongBenchCommand();

/// Every shader file compiled into the program.
const ShaderLibrary& shaderLibrary();

}  // namespace pitviper
