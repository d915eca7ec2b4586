#include "scenarios/reader/library_air.hpp"

#include <algorithm>

#include "atmosphere/layered.hpp"
#include "atmosphere/models.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"

namespace pitviper {

std::vector<LibraryAir> libraryAirs(const Libraries& libraries) {
  std::vector<LibraryAir> all;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(libraries.atmosphere, ignored)) {
    if (entry.path().extension() != ".yaml") continue;
    const Value tree = loadYaml(entry.path(), {entry.path().string(), 0, 0, -1});
    const Record r(tree, tables::airLibrary());
    all.push_back({entry.path().stem().string(), r.given("description") ? r.text("description") : ""});
  }
  std::sort(all.begin(), all.end(), [](const LibraryAir& a, const LibraryAir& b) { return a.name < b.name; });
  return all;
}

AbsorberTable libraryAirTable(const std::string& name, const Libraries& libraries) {
  const auto airs = libraryAirs(libraries);
  if (std::none_of(airs.begin(), airs.end(), [&](const LibraryAir& a) { return a.name == name; })) {
    std::vector<std::string> names;
    for (const auto& a : airs) names.push_back(a.name);
    throw UserError({name, 0, 0, -1}, "there is no such file and no such library air", "a file of air, or one of " + listed(names),
                    didYouMean(name, names, "check the name"));
  }
  const auto file = libraries.atmosphere / (name + ".yaml");
  const Value tree = loadYaml(file, {file.string(), 0, 0, -1});
  const Record r(tree, tables::airLibrary());
  if (!r.given("table"))
    throw UserError(r.where(), "this library air has no table: it is homogeneous, its extinction is in the file", "a library air with 'table'",
                    "read the file itself");
  Value keys = tree;
  keys.entries.clear(), keys.keyPlaces.clear();
  for (size_t k = 0; k < tree.entries.size(); ++k) {
    if (tree.entries[k].first == "description" || tree.entries[k].first == "source") continue;
    keys.entries.push_back(tree.entries[k]);
    keys.keyPlaces.push_back(tree.keyPlaces[k]);
  }
  const ParameterTable table = airTable(layeredModel());
  const Record record(keys, table);
  const std::map<std::string, Spectrum> none;
  return readAirTable({{record, none}, libraries.atmosphere, libraries.atmosphere});
}

}  // namespace pitviper
