#include "scenarios/view/material_text.hpp"

#include <sstream>

#include "scenarios/import/import_yaml.hpp"
#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"

namespace pitviper {
namespace {

/// The first of a scenario's materials. Without cameras: a material need not have data in anyone's band.
std::shared_ptr<const Material> firstMaterial(const std::string& materials, const std::filesystem::path& base, const Libraries& libraries) {
  const Value tree = parseYaml("materials:\n" + materials, "material");
  Simulation simulation;
  Builder builder(simulation, base, libraries);
  try {
    builder.readMaterials(Record(tree, tables::scenario()));
  } catch (const OutsideSpectrum& e) {
    throw UserError(tree.where, e.what(), "spectra that cover what they are multiplied with", "extend the table");
  }
  return simulation.materials.at(0);
}

}  // namespace

std::shared_ptr<const Material> readMaterialText(const std::string& text, const std::filesystem::path& base, const Libraries& libraries) {
  std::string indented = "  edited:\n";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) indented += "    " + line + "\n";
  return firstMaterial(indented, base, libraries);
}

std::shared_ptr<const Material> readMaterialFile(const std::filesystem::path& file, const Libraries& libraries) {
  return firstMaterial("  edited: {file: " + quotedText(std::filesystem::absolute(file).string()) + "}\n", file.parent_path(), libraries);
}

}  // namespace pitviper
