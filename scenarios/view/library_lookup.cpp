#include "scenarios/view/library_lookup.hpp"

#include <algorithm>

#include "scenarios/reader/yaml_tree.hpp"

namespace pitviper {

Value substanceTree(const std::string& name, const Location& asked, const Libraries& libraries) {
  const auto folder = libraries.materials.parent_path() / "substances", file = folder / (name + ".yaml");
  std::error_code ignored;
  if (name.find('/') == std::string::npos && name.size() <= 100 && std::filesystem::is_regular_file(file, ignored)) return loadYaml(file, asked);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  throw unknownWord(asked, "there is no substance", name, names, "write its index as a number");
}

SpectrumReader spectraIn(const std::filesystem::path& base, const Libraries& libraries) {
  SpectrumFiles files;
  files.base = base;
  files.library = {libraries.sensors};
  files.loadYaml = [](const std::filesystem::path& path, const Location& asked) { return loadYaml(path, asked); };
  return SpectrumReader(std::move(files));
}

}  // namespace pitviper
