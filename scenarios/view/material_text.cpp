#include "scenarios/view/material_text.hpp"

#include <sstream>

#include "scenarios/import/import_yaml.hpp"

namespace pitviper {
namespace {

/// The first material of the least of scenarios: nothing in it is of the material.
std::shared_ptr<const Material> firstMaterial(const std::string& materials, const std::filesystem::path& base, const Libraries& libraries) {
  const std::string scene = "materials:\n" + materials +
                            "background: {temperature: 250 K}\n"
                            "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 5 mm, heading: 0 deg, "
                            "channels: [{name: c, response: {band: [3 um, 3.1 um]}}]}]\n";
  return readScenarioText(scene, "material", base, {}, libraries).materials.at(0);
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
