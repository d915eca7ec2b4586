#pragma once
// Grids from files: VTK image data (.vti), OpenVDB (.vdb). Both readers are modules of their own that run in a child process, as for meshes
// (sim/scene/mesh_import.hpp): whatever a damaged file does to them, this process gets a grid or a UserError.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/scene/grid_data.hpp"

namespace pitviper {

/// Reads the arrays of these names, scalars, of an axis-parallel grid.
///  VTI: of its points, or of its cells, which then lie at their middles. One piece or several.
///  VDB: grids of floats over the box of all their active voxels, with one transform that scales and moves; elsewhere their background.
/// Throws UserError: at `askedAt` for a missing file, an unknown extension or a missing module; in the file itself for what is wrong there: no such array
/// (those that there are are named), values that are not finite (array and index), two to kMostGridNodes nodes.
GridData importGrid(const std::filesystem::path& file, const std::vector<std::string>& names, const Location& askedAt);

/// "node [3, 0, 7]", for messages.
std::string gridIndex(const GridData& grid, std::size_t index);

}  // namespace pitviper
