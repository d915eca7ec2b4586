#pragma once
// What the text of a material's file means, by the scenario reader.
#include <filesystem>
#include <memory>
#include <string>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/model/material.hpp"

namespace pitviper {

/// `text`: block YAML, as a file of materials/library. Files that it names are relative to `base`. UserError as of a scenario with it.
std::shared_ptr<const Material> readMaterialText(const std::string& text, const std::filesystem::path& base, const Libraries& libraries);

/// The same of a file.
std::shared_ptr<const Material> readMaterialFile(const std::filesystem::path& file, const Libraries& libraries);

}  // namespace pitviper
