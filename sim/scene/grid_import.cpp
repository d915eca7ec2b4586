#include "sim/scene/grid_import.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "sim/parameters/module_on_demand.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/scene/import/child_process.hpp"
#include "sim/scene/import/grid_reply.hpp"

namespace pitviper {
namespace {

constexpr std::uintmax_t kMostBytes = 2ull << 30;

constexpr const char *kCalled = "the grid import module", *kVtkFix = "install the package libvtk9-dev and build again",
                     *kVdbFix = "install the package libopenvdb-dev and build again";
constexpr ModuleOnDemand kVti{kVtiModule, kGridFunction, kCalled, "VTK", kVtkFix, kVtkFix},
    kVdb{kVdbModule, kGridFunction, kCalled, "OpenVDB", kVdbFix, kVdbFix};

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

GridData importGrid(const std::filesystem::path& file, const std::vector<std::string>& names, const Location& askedAt) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension != ".vti" && extension != ".vdb")
    throw UserError(askedAt, "the grid file '" + file.string() + "' has an unknown extension", ".vti (VTK image data) or .vdb (OpenVDB)",
                    "resample the flow onto a regular grid and write one of these");
  const std::string bytes = readWholeFile(
      file, {.what = "a grid file", .mostBytes = kMostBytes, .fix = "check the name; it is relative to the scenario's folder", .fixLarge = "thin the grid out"},
      askedAt);
  const ModuleOnDemand& module = extension == ".vdb" ? kVdb : kVti;
  const std::filesystem::path moduleFile = fileOf(module, askedAt);

  const GridRequest request{file.string(), bytes, names};
  const auto work = [&] {
    GridReply reply;
    std::string problem;
    if (void* function = functionIn(moduleFile, module.function, problem)) {
      allowMemory(request.bytes.size());
      reinterpret_cast<GridFunction>(function)(request, &reply);
    } else {
      reply = {{}, true, askedAt, std::string(module.called) + " " + problem, "a module of this build", module.toRun};
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
