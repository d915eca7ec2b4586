#include "scenarios/import/material_import.hpp"

#include <cctype>

#include "materials/refractive_index.hpp"
#include "scenarios/import/optical_constants_import.hpp"
#include "scenarios/import/spectrum_import.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/spectrum_value.hpp"

namespace pitviper {
namespace {

constexpr std::uintmax_t kLargestFile = 16u << 20;

/// Of the kind that a surface has.
Spectrum shareOf(const Value& value, const SpectrumReader& reader) {
  Spectrum s = reader.read(value, "", "the spectrum");
  if (!(s.minimum(s.validLow(), s.validHigh()) >= 0.0 && s.maximum(s.validLow(), s.validHigh()) <= 1.0))
    throw UserError(value.where, "the spectrum leaves 0 to 1", "values from 0 to 1", "correct its values");
  return s;
}

/// Reads what was made, as a scenario will.
void readBack(const std::string& yaml, const std::filesystem::path& file) {
  SpectrumFiles files;
  files.loadYaml = [](const std::filesystem::path& path, const Location& asked) { return loadYaml(path, asked); };
  const SpectrumReader reader(files);
  try {
    const Value tree = parseYaml(yaml, file.string() + " as YAML");
    if (const Value* index = tree.find("index"))
      readRefractiveIndex(*index, [&](const Value& v, const Parameter& p) { return reader.read(v, p.unit, p.key); }, {});
    else if (const Value* pane = tree.find("transmission")) shareOf(*pane->find("transmittance"), reader);
    else shareOf(*tree.find("components")->items.front().find("reflectance"), reader);
  } catch (const UserError& e) {
    throw UserError({file.string(), 1, 1, -1}, std::string("what the file would become cannot be read back: ") + e.what(),
                    "a file within the limits of a material's", "thin it out, or correct its values");
  }
}

}  // namespace

std::optional<ImportedMaterial> importedMaterial(const std::filesystem::path& file, const ImportChoices& choices) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::optional<ImportedMaterial> made;
  if (ending == ".yml" || ending == ".yaml") {
    std::string text;
    const Value tree = loadYaml(file, {file.string(), 0, 0, -1}, &text);
    const bool database = tree.find("DATA") != nullptr;
    if (choices.axis || choices.scale || choices.quantity || choices.column || !choices.wavelengths.empty())
      throw UserError({file.string(), 1, 1, -1}, "the file says itself what it holds",
                      "'--axis', '--unit', '--quantity', '--column' and '--wavelengths' with a spectrum in columns", "leave them out");
    if (!database) return std::nullopt;
    made = importOpticalConstants(tree, text, file.stem().string());
  } else {
    made = importSpectrum(readWholeFile(file, {.what = "a spectrum", .mostBytes = kLargestFile, .fix = "check the name"}), file, choices);
  }
  readBack(made->yaml, file);
  return made;
}

}  // namespace pitviper
