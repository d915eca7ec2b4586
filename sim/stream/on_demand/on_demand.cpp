#include "sim/stream/on_demand/on_demand.hpp"

#include <dlfcn.h>

#include <string>

#include "sim/parameters/error.hpp"

namespace pitviper {
namespace {

std::filesystem::path& moduleFolder() {
  static std::filesystem::path folder;
  return folder;
}

std::filesystem::path pathOf(const char* file) {
  if (!moduleFolder().empty()) return moduleFolder() / file;
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / file;
}

}  // namespace

void setModuleFolder(const std::filesystem::path& folder) { moduleFolder() = folder; }

void* loadOnDemand(const ModuleOnDemand& module) {
  const std::filesystem::path path = pathOf(module.file);
  const std::string library = module.library;
  if (std::error_code ignored; !std::filesystem::exists(path, ignored))
    throw UserError({module.subject}, "the module " + path.string() + " is missing", "a build with " + library,
                    std::string("install the packages ") + module.toBuild + " and build again");
  // Never closed: threads and types of its libraries would be left pointing into it.
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* symbol = handle == nullptr ? nullptr : dlsym(handle, module.function);
  if (symbol == nullptr) {
    const char* reason = dlerror();
    throw UserError({module.subject}, std::string("the module cannot be loaded (") + (reason != nullptr ? reason : "unknown") + ")", library + "'s libraries",
                    std::string("install the packages ") + module.toRun);
  }
  return symbol;
}

}  // namespace pitviper
