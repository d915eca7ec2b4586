#include "scenarios/reader/scenario_reader.hpp"

#include <openssl/sha.h>

#include <cstdlib>
#include <set>
#include <string_view>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/move_files.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sensors/quantity.hpp"
#include "sim/model/scene_fingerprint.hpp"

namespace pitviper {

std::string sha256(const std::string& text) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest);
  std::string hex;
  for (unsigned char byte : digest) {
    hex += "0123456789abcdef"[byte >> 4];
    hex += "0123456789abcdef"[byte & 15];
  }
  return hex;
}

Libraries findLibraries() {
  std::vector<std::filesystem::path> tried;
  if (const char* home = std::getenv("PITVIPER_HOME")) tried.emplace_back(home);
  std::error_code ignored;
  auto folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  for (int up = 0; up < 6 && !folder.empty(); ++up, folder = folder.parent_path()) tried.push_back(folder);
  for (const auto& home : tried)
    if (std::filesystem::is_directory(home / "materials/library", ignored) && std::filesystem::is_directory(home / "sensors/library", ignored))
      return {home / "materials/library", home / "atmosphere/library", home / "sensors/library"};
  throw UserError({"PITVIPER_HOME", 0, 0, -1}, "cannot find the folder with materials/library and sensors/library", "the folder pitviper was unpacked in",
                  "set PITVIPER_HOME to it");
}

namespace {

/// Whether a path leads from a folder to somewhere below the folder above it, by its words and where links on the way lead.
bool isNear(const std::filesystem::path& folder, const std::filesystem::path& name) {
  if (name.empty() || name.is_absolute()) return false;
  if (name.has_parent_path() && name.extension() != ".yaml" && name.extension() != ".yml") return false;  // elsewhere nothing but scenarios is read
  const auto plain = name.lexically_normal();
  int up = 0;
  for (const auto& part : plain) up += part == "..";
  if (up > 1) return false;
  std::error_code failed;
  const auto here = std::filesystem::canonical(folder.empty() ? std::filesystem::path(".") : folder, failed);
  if (failed) return false;
  const auto at = std::filesystem::weakly_canonical(here / plain, failed).lexically_relative(here.parent_path());
  return !failed && !at.empty() && *at.begin() != "..";
}

/// `extends: other.yaml`: the other's keys hold where the tree has none.
void extend(Value& tree, const std::filesystem::path& base, std::string& identity) {
  const Value* from = tree.find("extends");
  if (tree.kind != Value::Kind::Map || !from) return;
  const std::filesystem::path name = from->text;
  if (from->kind != Value::Kind::Scalar || !isNear(base, name))
    throw UserError(from->where, "not the name of a scenario near this one",
                    "a relative path to a .yaml file below the folder that holds this scenario's own folder",
                    "write 'extends: first_light.yaml', 'extends: base/scene.yaml' or 'extends: ../common/scene.yaml'");
  std::string text;
  Value other = loadYaml(base / name, from->where, &text);
  if (other.kind != Value::Kind::Map)
    throw UserError(other.where, "a scenario is " + std::string(other.kindName()), "a map of keys", "see scenarios/README.md");
  if (const Value* further = other.find("extends"))
    throw UserError(further->where, "a scenario that is extended extends another itself", "one that is whole", "name that one, or write its keys here");
  identity += "\n--extends\n" + text;
  if (name.has_parent_path()) moveFiles(other, name.parent_path());
  tree.entries.reserve(tree.entries.size() + other.entries.size());  // `own` looks at the keys: they must stay where they are
  std::set<std::string_view> own;
  for (const auto& [key, value] : tree.entries) own.insert(key);
  for (size_t k = 0; k < other.entries.size(); ++k)
    if (own.count(other.entries[k].first) == 0) {  // a key twice in the other stays twice: the reader tells
      tree.entries.push_back(other.entries[k]);
      tree.keyPlaces.push_back(other.keyPlaces[k]);
    }
}

}  // namespace

Simulation readScenarioText(const std::string& text, const std::string& fileName, const std::filesystem::path& base, const std::vector<std::string>& overrides,
                            const Libraries& libraries) {
  Value tree = parseYaml(text, fileName);
  std::string identity = text;
  extend(tree, base, identity);
  for (const auto& o : overrides) {
    applyOverride(tree, o);
    identity += "\n--set " + o;
  }
  if (const Value* e = tree.find("extends"); e && e->where.file.starts_with("--set"))
    throw UserError(e->where, "what a scenario extends cannot be set from outside", "other keys", "write 'extends' into the file");
  const Record r(tree, tables::scenario());
  Simulation sim;
  sim.file = fileName;
  sim.name = r.given("name") ? r.text("name") : std::filesystem::path(fileName).stem().string();
  sim.sha256 = sha256(identity);
  sim.seed = r.integer("seed");
  if (r.given("audit")) sim.audit = r.number("audit");
  Builder b(sim, base, libraries);
  try {
    if (r.given("render")) {
      const Record render(r.value("render"), tables::render());
      const std::string mode = render.text("mode");
      sim.shadows = render.boolean("shadows");
      sim.mode = mode == "buffered" ? RenderMode::Buffered : mode == "direct" ? RenderMode::Direct : RenderMode::Auto;
    }
    b.readOrigin(r);
    b.readTime(r);
    b.readLimits(r);
    b.readAtmosphere(r);
    b.readBackground(r);
    b.readSun(r);
    b.readAccuracy(r);
    b.readMaterials(r);
    b.readGround(r);
    b.readAmbient(r);
    b.readEntities(r);
    if (sim.mode == RenderMode::Direct && sim.hasTransparent())
      throw UserError(Record(r.value("render"), tables::render()).where("mode"), "direct mode cannot draw what is seen through something transparent",
                      "'auto' or 'buffered' in a scenario with a transmission or a medium", "write 'mode: auto'");
    b.readLights(r);
    b.readCameras(r);
    b.readProbes(r);
    b.readCommands(r);
    b.readSinks(r);
  } catch (const OutsideSpectrum& e) {
    throw UserError(tree.where, e.what(), "spectra that cover what they are multiplied with", "extend the table or narrow the band");
  }
  if (sim.cameras.empty() && sim.probes.empty())
    throw UserError(tree.where, "the scenario has neither a camera nor a probe", "at least one under 'cameras:'", "add a camera");
  Fingerprint content;
  addTo(content, sim);
  sim.content = sha256(content.bytes());
  return sim;
}

Simulation readScenario(const std::filesystem::path& file, const std::vector<std::string>& overrides, const Libraries& libraries) {
  std::string text;
  loadYaml(file, {file.string(), 0, 0, -1}, &text);
  return readScenarioText(text, file.string(), file.parent_path(), overrides, libraries);
}

std::string keyReference() {
  std::string out;
  for (const ParameterTable& table : tables::all()) out += describe(table) + "\n";
  out +=
      "### Quantities\n\nWhat a channel's `output` can be. S is the response, L the radiance at the aperture.\n\n| quantity | unit | meaning | probe "
      "|\n|---|---|---|---|\n";
  for (const auto& q : quantities().all()) out += "| `" + q.name + "` | " + q.unit + " | " + q.meaning + " | " + (q.probe ? "yes" : "") + " |\n";
  return out;
}

}  // namespace pitviper
