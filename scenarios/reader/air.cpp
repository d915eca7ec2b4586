// The air of a scenario: its own keys, or those of a library air.
#include <algorithm>

#include "atmosphere/models.hpp"
#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/move_files.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"

namespace pitviper {
namespace {

std::vector<std::string> libraryNames(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The keys of a library air that are not given beside its name.
void addLibrary(Value& air, const std::filesystem::path& folder) {
  const Value word = *air.find("library");
  const std::string name = readText(word, "library");
  const auto file = folder / (name + ".yaml");
  std::error_code ignored;
  if (name.find('/') != std::string::npos || name.size() > 100 || !std::filesystem::is_regular_file(file, ignored))
    throw unknownWord(word.where, "there is no library air", name, libraryNames(folder));
  Value tree = loadYaml(file, word.where);
  const Record checked(tree, tables::airLibrary());
  moveFiles(tree, folder);
  // A visibility is of a haze, whatever the library says of having one.
  const bool hazy = air.find("visibility") && !air.find("aerosol");
  for (size_t k = 0; k < tree.entries.size(); ++k) {
    const std::string& key = tree.entries[k].first;
    if (key == "description" || key == "source" || air.find(key) || (hazy && key == "aerosol")) continue;
    air.entries.push_back(tree.entries[k]);
    air.keyPlaces.push_back(tree.keyPlaces[k]);
  }
}

/// A table of the library is the library's air: its file lies beside none of a user's scenarios.
void refuseMissingTable(const Value& air, const std::filesystem::path& base, const std::filesystem::path& library) {
  const Value* word = air.find("table");
  if (!word || word->kind != Value::Kind::Scalar || air.find("library")) return;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(base / word->text, ignored)) return;
  const auto names = libraryNames(library);
  std::string fix = "check the path";
  std::vector<std::string> same;
  for (const std::string& name : names) {
    const Value tree = loadYaml(library / (name + ".yaml"), word->where);
    const Value* table = tree.find("table");
    if (table && !tree.find("climate") && std::filesystem::path(table->text).stem() == std::filesystem::path(word->text).stem()) same.push_back(name);
  }
  if (!same.empty()) fix = "write 'library: " + same.back() + "' in its place" + (same.size() > 1 ? ", or one of " + listed(same) : "");
  throw UserError(word->where, "there is no file '" + (base / word->text).string() + "'",
                  "an air table (.air), its path relative to this file; or 'library', one of " + listed(names), fix);
}

}  // namespace

void Builder::readAtmosphere(const Record& scenario) {
  const Value* value = scenario.find("atmosphere");
  Value air;
  air.kind = Value::Kind::Map;
  air.where = value ? value->where : scenario.where();
  const bool word = value && value->kind == Value::Kind::Scalar;
  if (value && !word) air = *value;
  else if (word && value->text != "none") air.entries = {{"library", *value}}, air.keyPlaces = {value->where};
  if (!value || (word && value->text == "none")) {
    Value none;
    none.kind = Value::Kind::Scalar;
    none.where = air.where;
    none.text = "none";
    air.entries = {{"model", none}};
    air.keyPlaces = {air.where};
  }
  const ParameterTable all = anyAirTable();
  const Record r(air, all);
  const bool none = r.text("model") == "none";
  // Of a library air the visibility stands there whether its haze is taken or not.
  if (const Value* aerosol = air.find("aerosol"); aerosol && aerosol->text == "none" && air.find("visibility"))
    throw UserError(air.find("visibility")->where, "'visibility' has no say here: there is no aerosol", "an aerosol", "remove 'visibility' or 'aerosol: none'");
  refuseMissingTable(air, base_, libraries_.atmosphere);
  if (r.given("library") && !none) {
    if (const auto own = marksOf(air); !own.empty())
      throw UserError(air.find("library")->where, "the air is given twice, by '" + own.front().key + "' and by 'library'", "one of the two", "remove one");
    addLibrary(air, libraries_.atmosphere);
    const auto own = marksOf(air);
    if (const std::string asked = r.text("model"); asked != "air" && !own.empty() && own.front().model->name != asked)
      throw UserError(r.where("model"), "library air '" + r.text("library") + "' is " + own.front().model->name + ", and 'model' says " + asked,
                      "'model: " + own.front().model->name + "', or none", "remove 'model'");
  }
  simulation_.air = makeAir(air, base_, libraries_.atmosphere, simulation_.frame.ground_m(),
                            [this](const Value& v, const Parameter& p) { return bounded(spectra_, v, p.unit, p.key + " of the air", p.minimum, p.maximum); });
}

}  // namespace pitviper
