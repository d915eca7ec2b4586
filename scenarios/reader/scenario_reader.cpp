#include "scenarios/reader/scenario_reader.hpp"

#include <openssl/evp.h>

#include <cstdlib>
#include <memory>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/expand.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sensors/quantity.hpp"
#include "sim/model/scene_fingerprint.hpp"

namespace pitviper {

namespace {

/// FIPS 180-4, of bytes that come piece by piece.
class Sha256 {
 public:
  Sha256() { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }
  void add(std::string_view piece) { EVP_DigestUpdate(context_.get(), piece.data(), piece.size()); }
  std::string hex() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned size = 0;
    EVP_DigestFinal_ex(context_.get(), digest, &size);
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
      text += "0123456789abcdef"[digest[i] >> 4];
      text += "0123456789abcdef"[digest[i] & 15];
    }
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_{EVP_MD_CTX_new(), &EVP_MD_CTX_free};
};

}  // namespace

std::string sha256(const std::string& text) {
  Sha256 hash;
  hash.add(text);
  return hash.hex();
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

Simulation readScenarioText(const std::string& text, const std::string& fileName, const std::filesystem::path& base, const std::vector<std::string>& overrides,
                            const Libraries& libraries, const std::vector<std::filesystem::path>& roots) {
  return readExpanded(expandScenario(text, fileName, base, overrides, libraries, roots), fileName, base, libraries);
}

Simulation readExpanded(const ExpandedScenario& expanded, const std::string& fileName, const std::filesystem::path& base, const Libraries& libraries) {
  const Value& tree = expanded.tree;
  const Record r(tree, tables::scenario());
  Simulation sim;
  sim.file = fileName;
  sim.name = std::filesystem::path(fileName).stem().string();
  r.fill(sim);
  sim.sha256 = sha256(expanded.identity);
  Builder b(sim, base, libraries);
  try {
    if (r.given("render")) Record(r.value("render"), tables::render()).fill(sim);
    b.readOrigin(r);
    b.readTime(r);
    b.readLimits(r);
    b.readAirMotion(r);
    b.readAtmosphere(r);
    b.readRefraction(r);
    b.readBackground(r);
    b.readSun(r);
    b.readStars(r);
    b.readAccuracy(r);
    b.readMaterials(r);
    b.readGround(r);
    b.readAmbient(r);
    b.readEntities(r);
    b.readPlumes(r);
    b.readSmokes(r);
    b.readFlares(r);
    b.readCumuli(r);
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
  Sha256 hash;
  Fingerprint content([&hash](std::string_view piece) { hash.add(piece); });
  addTo(content, sim);
  content.finish();
  sim.content = hash.hex();
  return sim;
}

Simulation readScenario(const std::filesystem::path& file, const std::vector<std::string>& overrides, const Libraries& libraries,
                        const std::vector<std::filesystem::path>& roots) {
  std::string text;
  loadYaml(file, {file.string(), 0, 0, -1}, &text);
  return readScenarioText(text, file.string(), file.parent_path(), overrides, libraries, roots);
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
