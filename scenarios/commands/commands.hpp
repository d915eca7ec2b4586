#pragma once
// The commands of the pitviper program. Each returns an exit code: 0 done, 1 could not (machine, driver, disk), 2 a user's mistake.
#include <string>
#include <vector>

#include "sim/gl/shader_assembler.hpp"

namespace pitviper {

using Arguments = std::vector<std::string>;

int runCommand(const Arguments& arguments);
int auditCommand(const Arguments& arguments);
int checkCommand(const Arguments& arguments);
int infoCommand(const Arguments& arguments);
int integrateCommand(const Arguments& arguments);
int benchCommand(const Arguments& arguments);
int planCommand(const Arguments& arguments);
int atmosphereCommand(const Arguments& arguments);
int materialCommand(const Arguments& arguments);
int measureCommand(const Arguments& arguments);
int streamCommand(const Arguments& arguments);
int keysCommand(const Arguments& arguments);

/// Every shader file compiled into the program.
const ShaderLibrary& shaderLibrary();

}  // namespace pitviper
