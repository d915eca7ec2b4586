#include "sim/scene/mesh_import.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>

#include "sim/scene/import/child_process.hpp"
#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/mesh_cache.hpp"
#include "sim/scene/mesh_tools.hpp"

namespace pitviper {
namespace {

/// Raised whenever the same file would be imported differently: older cache entries are then not found any more.
constexpr std::uint64_t kImportVersion = 1;

/// 10 million triangles take 0.5 GB as binary STL and about 1.5 GB as ASCII STL.
constexpr std::uintmax_t kMostBytes = 2ull << 30;

/// Bends above this are edges: facets of a curved surface with nine or more around stay smooth.
constexpr double kCrease_rad = 40.0 * std::numbers::pi / 180.0;

std::filesystem::path& importFolder() {
  static std::filesystem::path folder;
  return folder;
}

std::filesystem::path modulePath() {
  if (!importFolder().empty()) return importFolder() / kImportModule;
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / kImportModule;
}

std::string lowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string readAll(const std::filesystem::path& file, const Location& askedAt) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(file, failure);
  if (!std::filesystem::exists(status))
    throw UserError(askedAt, "the mesh file '" + file.string() + "' does not exist", "a mesh file", "check the name; it is relative to the scenario's folder");
  if (!std::filesystem::is_regular_file(status))
    throw UserError(askedAt, "the mesh file '" + file.string() + "' is not a plain file", "a mesh file", "give the path of a file");
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  if (failure || size > kMostBytes) throw UserError(askedAt, "the mesh file '" + file.string() + "' is too large", "at most 2 GiB", "simplify the mesh");
  std::ifstream in(file, std::ios::binary);
  std::string bytes(size, '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw UserError(askedAt, "the mesh file '" + file.string() + "' cannot be read", "a readable file", "check its permissions");
  return bytes;
}

/// The content of a .gltf is also that of the files it names: every "uri" that is no data: URI.
ContentKey keyOf(const std::filesystem::path& file, const std::string& extension, std::string_view bytes) {
  ContentKey key = contentKey(extension, contentKey(bytes, {kImportVersion, 0}));
  if (extension != ".gltf") return key;
  for (std::size_t at = bytes.find("\"uri\""); at != std::string_view::npos; at = bytes.find("\"uri\"", at + 5)) {
    const std::size_t open = bytes.find('"', at + 5), close = bytes.find('"', std::min(open, bytes.size() - 1) + 1);
    if (open == std::string_view::npos || close == std::string_view::npos) break;
    const std::string_view uri = bytes.substr(open + 1, close - open - 1);
    if (uri.starts_with("data:")) continue;
    std::ifstream in(file.parent_path() / uri, std::ios::binary);
    key = contentKey(std::string{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}, key);
  }
  return key;
}

/// Fills in what the file did not have and checks everything: what comes from the child is not trusted.
void finish(Mesh& mesh, const Location& where) {
  const auto bad = [](const glm::vec3& n) { return !(std::abs(glm::dot(n, n)) > 1e-12f && std::isfinite(glm::dot(n, n))); };
  const bool hasNormals = mesh.normals.size() == mesh.positions.size() && std::none_of(mesh.normals.begin(), mesh.normals.end(), bad);
  if (!hasNormals) mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f, 0.0f, 1.0f));
  for (glm::vec3& n : mesh.normals) n = glm::normalize(n);
  if (mesh.uv.size() != mesh.positions.size()) mesh.uv.assign(mesh.positions.size(), glm::vec2(0.0f));
  if (mesh.parts.empty()) mesh.parts = {{"all", 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  validateMesh(mesh, where);
  if (!hasNormals) computeNormals(mesh, kCrease_rad);
  mesh.closed = isClosed(mesh);
}

void scale(Mesh& mesh, double metresPerUnit, const Location& askedAt) {
  for (glm::vec3& p : mesh.positions) {
    p = glm::vec3(glm::dvec3(p) * metresPerUnit);
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw UserError(askedAt, "the mesh is too large at this number of metres per unit", "positions below 3e38 m", "check 'unit'");
  }
}

}  // namespace

void setMeshImportFolder(const std::filesystem::path& folder) { importFolder() = folder; }

Mesh importMesh(const std::filesystem::path& file, double metresPerUnit, const Location& askedAt) {
  if (!std::isfinite(metresPerUnit) || metresPerUnit <= 0.0)
    throw UserError(askedAt, "metres per unit of the mesh is " + std::to_string(metresPerUnit), "a finite positive number", "correct 'unit'");
  const std::string extension = lowerExtension(file);
  constexpr const char* kKnown[] = {".obj", ".stl", ".ply", ".vtp", ".gltf", ".glb"};
  if (std::find(std::begin(kKnown), std::end(kKnown), extension) == std::end(kKnown))
    throw UserError(askedAt, "the mesh file '" + file.string() + "' has an unknown extension", "one of .obj .stl .ply .vtp .gltf .glb",
                    "convert the file, or give it the extension of its format");
  const std::string bytes = readAll(file, askedAt);
  const ContentKey key = keyOf(file, extension, bytes);
  std::optional<Mesh> mesh = readCachedMesh(key);
  if (!mesh) {
    const std::filesystem::path module = modulePath();
    if (std::error_code ignored; !std::filesystem::exists(module, ignored))
      throw UserError(askedAt, "the mesh import module " + module.string() + " is missing", "a build with VTK",
                      "install the package libvtk9-dev and build again");
    mesh = importInChild(module, file, bytes.size(), askedAt);
    finish(*mesh, Location{file.string()});
    writeCachedMesh(key, *mesh);
  }
  scale(*mesh, metresPerUnit, askedAt);
  return std::move(*mesh);
}

}  // namespace pitviper
