#include "sim/scene/grid_import.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "sim/parameters/read_file.hpp"
#include "sim/scene/import/child_process.hpp"
#include "sim/scene/import/grid_reply.hpp"

namespace pitviper {
namespace {

constexpr std::uintmax_t kMostBytes = 2ull << 30;

std::filesystem::path& importFolder() {
  static std::filesystem::path folder;
  return folder;
}

std::filesystem::path modulePath(const char* name) {
  if (!importFolder().empty()) return importFolder() / name;
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / name;
}

template <class T>
void put(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T>
bool get(std::string_view& in, T& value) {
  if (in.size() < sizeof value) return false;
  std::memcpy(&value, in.data(), sizeof value);
  in.remove_prefix(sizeof value);
  return true;
}

std::string encode(const GridData& grid) {
  std::string out = "G";
  put(out, grid.nodes);
  put(out, grid.origin);
  put(out, grid.spacing);
  for (const auto& a : grid.arrays) out.append(reinterpret_cast<const char*>(a.values.data()), a.values.size() * sizeof(float));
  return out;
}

/// What comes from the child is not trusted.
bool decode(std::string_view in, const std::vector<std::string>& names, GridData& grid) {
  if (!in.starts_with('G')) return false;
  in.remove_prefix(1);
  if (!get(in, grid.nodes) || !get(in, grid.origin) || !get(in, grid.spacing)) return false;
  const auto n = glm::dvec3(grid.nodes);
  if (!(std::min({n.x, n.y, n.z}) >= 1.0) || n.x * n.y * n.z > static_cast<double>(kMostGridNodes)) return false;
  if (in.size() != names.size() * grid.count() * sizeof(float)) return false;
  for (const std::string& name : names) {
    grid.arrays.push_back({name, std::vector<float>(grid.count())});
    std::memcpy(grid.arrays.back().values.data(), in.data(), grid.count() * sizeof(float));
    in.remove_prefix(grid.count() * sizeof(float));
  }
  return true;
}

}  // namespace

void setGridImportFolder(const std::filesystem::path& folder) { importFolder() = folder; }

GridData importGrid(const std::filesystem::path& file, const std::vector<std::string>& names, const Location& askedAt) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension != ".vti" && extension != ".vdb")
    throw UserError(askedAt, "the grid file '" + file.string() + "' has an unknown extension", ".vti (VTK image data) or .vdb (OpenVDB)",
                    "resample the flow onto a regular grid and write one of these");
  const std::string bytes = readWholeFile(
      file, {.what = "a grid file", .mostBytes = kMostBytes, .fix = "check the name; it is relative to the scenario's folder", .fixLarge = "thin the grid out"},
      askedAt);
  const bool vdb = extension == ".vdb";
  const std::filesystem::path module = modulePath(vdb ? kVdbModule : kVtiModule);
  const std::string package = vdb ? "libopenvdb-dev" : "libvtk9-dev";
  if (std::error_code ignored; !std::filesystem::exists(module, ignored))
    throw UserError(askedAt, "the grid import module " + module.string() + " is missing", std::string("a build with ") + (vdb ? "OpenVDB" : "VTK"),
                    "install the package " + package + " and build again");

  const GridRequest request{file.string(), bytes, names};
  const auto work = [&] {
    GridReply reply;
    void* handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* symbol = handle == nullptr ? nullptr : dlsym(handle, kGridFunction);
    if (symbol == nullptr) {
      const char* reason = dlerror();
      reply = {{},
               true,
               askedAt,
               std::string("the grid import module cannot be loaded (") + (reason != nullptr ? reason : "unknown") + ")",
               "a module of this build",
               "install the package " + package + " and build again"};
    } else {
      allowMemory(request.bytes.size());
      reinterpret_cast<GridFunction>(symbol)(request, &reply);
    }
    return reply.failed ? encodeFailure(reply) : encode(reply.grid);
  };
  std::string failure;
  const std::string answer = bytesFromChild(bytes.size(), askedAt, work, failure);
  GridData grid;
  if (!decode(answer, names, grid)) throwReply(answer, file.string(), failure, "grid");
  const Location in{file.string()};
  const auto finite = [](const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  if (!finite(grid.origin) || !finite(grid.spacing) || !(std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z}) > 0.0))
    throw UserError(in, "the grid has no spacing", "positive numbers along x, y and z", "write it again");
  if (std::min({grid.nodes.x, grid.nodes.y, grid.nodes.z}) < 2)
    throw UserError(in, "a grid of " + std::to_string(grid.nodes.x) + "x" + std::to_string(grid.nodes.y) + "x" + std::to_string(grid.nodes.z) + " nodes",
                    "two along each axis at least", "write it with depth: a plane is no field");
  for (const auto& a : grid.arrays)
    for (std::size_t i = 0; i < a.values.size(); ++i)
      if (!std::isfinite(a.values[i]))
        throw UserError(in, "array '" + a.name.substr(0, 60) + "' is no number at " + gridIndex(grid, i), "numbers everywhere", "correct the file");
  return grid;
}

std::string gridIndex(const GridData& grid, std::size_t i) {
  const std::size_t nx = static_cast<std::size_t>(grid.nodes.x), ny = static_cast<std::size_t>(grid.nodes.y);
  return "node [" + std::to_string(i % nx) + ", " + std::to_string(i / nx % ny) + ", " + std::to_string(i / (nx * ny)) + "]";
}

}  // namespace pitviper
