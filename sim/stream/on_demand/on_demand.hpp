#pragma once
// Modules: shared libraries with heavy libraries behind them, loaded when they are first asked for, so that the program runs where those are not installed.
#include <filesystem>

namespace pitviper {

struct ModuleOnDemand {
  const char* subject;   ///< what an error begins with
  const char* file;      ///< "libpitviper_x.so"
  const char* function;  ///< its C function
  const char* library;   ///< what it needs, for people: "GStreamer"
  const char* toRun;     ///< packages
  const char* toBuild;   ///< packages
};

/// The module's function. Errors: UserError where the file or a library is missing, with the packages to install.
void* loadOnDemand(const ModuleOnDemand& module);

/// Where modules lie; empty: next to the executable.
void setModuleFolder(const std::filesystem::path& folder);

}  // namespace pitviper
