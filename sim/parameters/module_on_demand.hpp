#pragma once
// Modules: shared libraries with heavy libraries behind them, loaded when they are first asked for, so that the program runs where those are not installed.
#include <filesystem>
#include <string>

#include "sim/parameters/error.hpp"

namespace pitviper {

struct ModuleOnDemand {
  const char* file;      ///< "libpitviper_x.so"
  const char* function;  ///< its C function
  const char* called;    ///< in errors: "the charts module"
  const char* library;   ///< what it needs, for people: "GStreamer"
  const char* toBuild;   ///< what to do where it is missing,
  const char* toRun;     ///< and where it cannot be loaded
};

/// Where it lies: next to the executable. Errors: UserError where it is missing.
std::filesystem::path fileOf(const ModuleOnDemand& module, const Location& askedAt);

/// A module's function; or null, and why. The module is never closed: factories, threads and types of its libraries would be left pointing into it.
void* functionIn(const std::filesystem::path& file, const char* function, std::string& problem);

/// The module's function. Errors: UserError where the file or a library is missing.
void* loadOnDemand(const ModuleOnDemand& module, const Location& askedAt);

/// Where modules lie; empty: next to the executable.
void setModuleFolder(const std::filesystem::path& folder);

}  // namespace pitviper
