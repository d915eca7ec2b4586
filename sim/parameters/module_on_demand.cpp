#include "sim/parameters/module_on_demand.hpp"

#include <dlfcn.h>

namespace pitviper {
namespace {

std::filesystem::path& moduleFolder() {
  static std::filesystem::path folder;
  return folder;
}

}  // namespace

void setModuleFolder(const std::filesystem::path& folder) { moduleFolder() = folder; }

std::filesystem::path fileOf(const ModuleOnDemand& module, const Location& askedAt) {
  std::error_code ignored;
  const std::filesystem::path folder = moduleFolder().empty() ? std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() : moduleFolder();
  if (!std::filesystem::exists(folder / module.file, ignored))
    throw UserError(askedAt, std::string(module.called) + " " + (folder / module.file).string() + " is missing", std::string("a build with ") + module.library,
                    module.toBuild);
  return folder / module.file;
}

void* functionIn(const std::filesystem::path& file, const char* function, std::string& problem) {
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* symbol = handle == nullptr ? nullptr : dlsym(handle, function);
  if (symbol == nullptr) {
    const char* reason = dlerror();
    problem = std::string("cannot be loaded (") + (reason != nullptr ? reason : "unknown") + ")";
  }
  return symbol;
}

void* loadOnDemand(const ModuleOnDemand& module, const Location& askedAt) {
  std::string problem;
  void* function = functionIn(fileOf(module, askedAt), module.function, problem);
  if (function == nullptr) throw UserError(askedAt, std::string(module.called) + " " + problem, std::string(module.library) + "'s libraries", module.toRun);
  return function;
}

}  // namespace pitviper
