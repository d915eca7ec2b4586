#include "sim/scene/mesh_import.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "sim/parameters/module_on_demand.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/scene/import/child_process.hpp"
#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/mesh_cache.hpp"
#include "sim/scene/mesh_normals.hpp"
#include "sim/scene/mesh_orientation.hpp"
#include "sim/scene/mesh_tools.hpp"

namespace pitviper {
namespace {

/// Raised whenever the same file would be imported differently: older cache entries are then not found any more.
constexpr std::uint64_t kImportVersion = 3;

/// 10 million triangles take 0.5 GB as binary STL and about 1.5 GB as ASCII STL.
constexpr std::uintmax_t kMostBytes = 2ull << 30;

/// Bends above this are edges: facets of a curved surface with nine or more around stay smooth.
constexpr double kCrease_rad = 40.0 * std::numbers::pi / 180.0;

constexpr ModuleOnDemand kMeshModule{kImportModule,
                                     kImportFunction,
                                     "the mesh import module",
                                     "VTK",
                                     "install the package libvtk9-dev and build again",
                                     "install the package libvtk9.1 (to build: libvtk9-dev)"};

std::string lowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string readAll(const std::filesystem::path& file, const Location& askedAt) {
  return readWholeFile(
      file, {.what = "a mesh file", .mostBytes = kMostBytes, .fix = "check the name; it is relative to the scenario's folder", .fixLarge = "simplify the mesh"},
      askedAt);
}

/// Reads what an imported file names, relative to it, and notes what it was.
class FilesBeside {
 public:
  explicit FilesBeside(const std::filesystem::path& file) : folder_(file.parent_path()) {}

  bool read(const std::string& name, std::string& bytes, std::string& problem) {
    try {
      bytes = readWholeFile(folder_ / name, {.mostBytes = kMostBytes - read_});
      read_ += bytes.size();
      named_.push_back({name, contentKey(bytes)});
      return true;
    } catch (const std::exception& failure) {
      problem = failure.what();
      problem.resize(std::min(problem.find("; expected"), problem.size()));  // what the reader expects is said by itself
      return false;
    }
  }
  bool isUnchanged(const NamedFile& named) {
    std::string bytes, problem;
    return read(named.name, bytes, problem) && named_.back().key == named.key;
  }
  const std::vector<NamedFile>& named() const { return named_; }

 private:
  std::filesystem::path folder_;
  std::uintmax_t read_ = 0;
  std::vector<NamedFile> named_;
};

/// Fills in what the file did not have and checks everything: what comes from the child is not trusted.
void finish(Mesh& mesh, const Location& where) {
  const auto bad = [](const glm::vec3& n) { return !(std::abs(glm::dot(n, n)) > 1e-12f && std::isfinite(glm::dot(n, n))); };
  const bool hasNormals = mesh.normals.size() == mesh.positions.size() && std::none_of(mesh.normals.begin(), mesh.normals.end(), bad);
  if (!hasNormals) mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f, 0.0f, 1.0f));
  for (glm::vec3& n : mesh.normals) n = glm::normalize(n);
  if (mesh.uv.size() != mesh.positions.size()) mesh.uv.assign(mesh.positions.size(), glm::vec2(0.0f));
  if (mesh.parts.empty()) mesh.parts = {{"all", 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  validateMesh(mesh, where);
  orientShells(mesh, hasNormals, kCrease_rad);
  if (!hasNormals) computeNormals(mesh, kCrease_rad);
}

void scale(Mesh& mesh, double metresPerUnit, const Location& askedAt) {
  mesh.offset_m *= metresPerUnit;
  for (glm::vec3& p : mesh.positions) {
    p = glm::vec3(glm::dvec3(p) * metresPerUnit);
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw UserError(askedAt, "the mesh is too large at this number of metres per unit", "positions below 3e38 m", "check 'unit'");
  }
}

}  // namespace

Mesh importMesh(const std::filesystem::path& file, double metresPerUnit, const Location& askedAt) {
  if (!std::isfinite(metresPerUnit) || metresPerUnit <= 0.0)
    throw UserError(askedAt, "metres per unit of the mesh is " + std::to_string(metresPerUnit), "a finite positive number", "correct 'unit'");
  const std::string extension = lowerExtension(file);
  constexpr const char* kKnown[] = {".obj", ".stl", ".ply", ".vtp", ".gltf", ".glb"};
  if (std::find(std::begin(kKnown), std::end(kKnown), extension) == std::end(kKnown))
    throw UserError(askedAt, "the mesh file '" + file.string() + "' has an unknown extension", "one of .obj .stl .ply .vtp .gltf .glb",
                    "convert the file, or give it the extension of its format");
  const std::string bytes = readAll(file, askedAt);
  // The key is of this file's bytes; those of files that it names stand in the cache's entry, as the reader read them.
  const ContentKey key = contentKey(extension, contentKey(bytes, {kImportVersion, 0}));
  FilesBeside before(file);
  std::optional<Mesh> mesh = readCachedMesh(key, [&](const NamedFile& named) { return before.isUnchanged(named); });
  if (!mesh) {
    const std::filesystem::path module = fileOf(kMeshModule, askedAt);
    FilesBeside beside(file);
    std::vector<NamedFile> named;
    mesh = importInChild(kMeshModule, module, {file.string(), bytes, {}}, beside, named, askedAt);
    finish(*mesh, Location{file.string()});
    writeCachedMesh(key, *mesh, named);
  }
  scale(*mesh, metresPerUnit, askedAt);
  return std::move(*mesh);
}

}  // namespace pitviper
