#pragma once
// The airs of the library by their names, for commands that show them without a scenario.
#include "atmosphere/absorber_table.hpp"
#include "scenarios/reader/scenario_reader.hpp"

namespace pitviper {

struct LibraryAir {
  std::string name, description;
};

/// All of them, by name.
std::vector<LibraryAir> libraryAirs(const Libraries& libraries);

/// The table of a library air with its visibility or without its aerosol, as a scenario has it. Throws UserError where there is no such name
/// (naming the nearest), or where it is homogeneous and has no table.
AbsorberTable libraryAirTable(const std::string& name, const Libraries& libraries);

}  // namespace pitviper
