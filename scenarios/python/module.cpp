// The extension module behind `import pitviper`. What people call is in the package beside it (scenarios/python/pitviper), in Python.
#include <dlfcn.h>

#include <csignal>
#include <filesystem>

#include "scenarios/commands/process.hpp"
#include "scenarios/python/bindings.hpp"
#include "sim/frame/version.hpp"
#include "sim/gl/driver_cache.hpp"
#include "sim/parameters/module_on_demand.hpp"
#include "sim/scene/cache_folder.hpp"

namespace {

/// Modules that are loaded on demand lie next to this one, not next to the interpreter.
void findModules() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&findModules), &info) != 0 && info.dli_fname)
    pitviper::setModuleFolder(std::filesystem::path(info.dli_fname).parent_path());
}

}  // namespace

PYBIND11_MODULE(_pitviper, m) {
  findModules();
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond its limit is an error of the write, as a full disk is
  pitviper::tellOfDriverBy(pitviper::tell);
  pitviper::tellOfCacheBy(pitviper::tell);
  m.attr("version") = pitviper::kVersion;
  pitviper::bindErrors(m);
  pitviper::bindFrames(m);
  pitviper::bindScenes(m);
  pitviper::bindPhysics(m);
}
