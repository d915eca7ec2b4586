#include "sim/scene/mesh_axes.hpp"

#include <cctype>
#include <filesystem>

namespace pitviper {
namespace {

glm::ivec3 cross(const glm::ivec3& a, const glm::ivec3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// Columns: body x (forward), y (left), z (up) in the axes of the file.
glm::mat3 fileFromBody(const FileAxes& axes) { return {glm::vec3(axes.forward), glm::vec3(cross(axes.up, axes.forward)), glm::vec3(axes.up)}; }

}  // namespace

FileAxes usualAxes(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".gltf" || extension == ".glb") return {{0, 0, 1}, {0, 1, 0}};
  return {};
}

std::optional<glm::ivec3> axisNamed(const std::string& word) {
  if (word.size() != 2 || (word[0] != '+' && word[0] != '-') || word[1] < 'x' || word[1] > 'z') return std::nullopt;
  glm::ivec3 axis(0);
  axis[word[1] - 'x'] = word[0] == '+' ? 1 : -1;
  return axis;
}

void turnAxes(Mesh& mesh, const FileAxes& readAs, const FileAxes& meant) {
  const glm::mat3 turn = glm::transpose(fileFromBody(meant)) * fileFromBody(readAs);  // of 0, 1 and -1
  for (glm::vec3& p : mesh.positions) p = turn * p;
  for (glm::vec3& n : mesh.normals) n = turn * n;
  mesh.offset_m = glm::dmat3(turn) * mesh.offset_m;
}

}  // namespace pitviper
