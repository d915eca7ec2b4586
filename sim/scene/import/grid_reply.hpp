#pragma once
// What a module that reads grids hands back: as import_reply.hpp for meshes.
#include <string>
#include <string_view>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/scene/grid_data.hpp"

namespace pitviper {

struct GridRequest {
  std::string file;                ///< for messages
  std::string_view bytes;          ///< the whole file
  std::vector<std::string> names;  ///< of the arrays wanted
};

/// If `failed`, the grid is empty and the rest says what UserError says.
struct GridReply {
  GridData grid;
  bool failed = false;
  Location where;
  std::string wrong, expected, fix;
};

/// Exported as kGridFunction by both modules: .vti by kVtiModule, .vdb by kVdbModule.
using GridFunction = void (*)(const GridRequest& request, GridReply* reply);
inline constexpr const char* kGridFunction = "pitviperImportGrid";
inline constexpr const char* kVtiModule = "libpitviper_mesh_import.so";
inline constexpr const char* kVdbModule = "libpitviper_vdb_import.so";

}  // namespace pitviper
