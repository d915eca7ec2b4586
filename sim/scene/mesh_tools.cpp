#include "sim/scene/mesh_tools.hpp"

#include <algorithm>
#include <cmath>

#include "sim/scene/mesh_edges.hpp"

namespace pitviper {
namespace {

glm::dvec3 unitOr(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : otherwise;
}

}  // namespace

double surfaceArea(const Mesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) sum += 0.5 * glm::length(areaVector(mesh, t));
  return sum;
}

double signedVolume(const Mesh& mesh) {
  if (mesh.triangles.empty()) return 0.0;
  const glm::dvec3 origin(mesh.positions[mesh.triangles[0].x]);  // near the mesh: no cancellation
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) sum += glm::dot(areaVector(mesh, t), glm::dvec3(mesh.positions[t.x]) - origin) / 6.0;
  return sum;
}

BoundingSphere boundingSphere(const Mesh& mesh) {
  if (mesh.positions.empty()) return {};
  glm::dvec3 low(mesh.positions[0]), high = low;
  for (const glm::vec3& p : mesh.positions) low = glm::min(low, glm::dvec3(p)), high = glm::max(high, glm::dvec3(p));
  const auto farthest = [&](const glm::dvec3& from) {
    glm::dvec3 best = from;
    for (const glm::vec3& p : mesh.positions)
      if (glm::distance(glm::dvec3(p), from) > glm::distance(best, from)) best = glm::dvec3(p);
    return best;
  };
  // Two candidates, the box's centre and Ritter's sphere (Graphics Gems, 1990); the smaller one is kept.
  BoundingSphere box{0.5 * (low + high), 0.0};
  box.radius_m = glm::distance(farthest(box.center), box.center);
  const glm::dvec3 a = farthest(glm::dvec3(mesh.positions[0])), b = farthest(a);
  BoundingSphere ritter{0.5 * (a + b), 0.5 * glm::distance(a, b)};
  for (const glm::vec3& p : mesh.positions) {
    const double away = glm::distance(glm::dvec3(p), ritter.center);
    if (away <= ritter.radius_m) continue;
    const double radius = 0.5 * (away + ritter.radius_m);
    ritter.center += (glm::dvec3(p) - ritter.center) * ((away - radius) / away);
    ritter.radius_m = radius;
  }
  ritter.radius_m = glm::distance(farthest(ritter.center), ritter.center);
  return ritter.radius_m < box.radius_m ? ritter : box;
}

bool isClosed(const Mesh& mesh) {
  if (mesh.triangles.empty()) return false;
  const std::vector<MeshEdge> edges = sortedEdges(mesh, weldByPosition(mesh));
  for (std::size_t i = 0; i < edges.size();) {
    long long balance = 0;
    const std::uint64_t places = edges[i].places;
    for (; i < edges.size() && edges[i].places == places; ++i) balance += edges[i].forward ? 1 : -1;
    if (balance != 0 && edges[i - 1].hasLength()) return false;
  }
  return signedVolume(mesh) > 0.0;
}

void appendPart(Mesh& into, const Mesh& part, const std::string& name, const glm::mat4& placement) {
  const auto firstVertex = static_cast<std::uint32_t>(into.positions.size());
  const auto firstTriangle = static_cast<std::uint32_t>(into.triangles.size());
  const glm::dmat3 linear(glm::dmat4{placement});
  const double turn = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
  // The cofactor matrix takes normals to normals without a division; its sign is wrong for a mirror.
  const glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1]));
  into.closed = part.closed && (into.triangles.empty() || into.closed);
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    into.positions.push_back(glm::vec3(placement * glm::vec4(part.positions[i], 1.0f)));
    const glm::dvec3 normal(part.normals[i]);
    into.normals.push_back(glm::vec3(unitOr(turn * (cofactor * normal), normal)));
    into.uv.push_back(part.uv[i]);
  }
  for (const glm::uvec3& t : part.triangles) into.triangles.push_back(firstVertex + (turn < 0.0 ? glm::uvec3(t.x, t.z, t.y) : t));
  const auto count = static_cast<std::uint32_t>(part.triangles.size());
  if (!into.parts.empty() && into.parts.back().name == name) into.parts.back().triangleCount += count;
  else into.parts.push_back({name, firstTriangle, count});
}

std::size_t validateMesh(Mesh& mesh, const Location& where) {
  const auto finite = [](auto v) {
    for (int k = 0; k < v.length(); ++k)
      if (!std::isfinite(v[k])) return false;
    return true;
  };
  if (mesh.triangles.empty()) throw UserError(where, "the mesh has no triangles", "at least one triangle", "export the surface as triangles");
  if (mesh.triangles.size() > kMostTriangles)
    throw UserError(where, "the mesh has " + std::to_string(mesh.triangles.size()) + " triangles", "at most " + std::to_string(kMostTriangles),
                    "simplify the mesh");
  if (mesh.normals.size() != mesh.positions.size() || mesh.uv.size() != mesh.positions.size())
    throw UserError(where,
                    "the mesh has " + std::to_string(mesh.positions.size()) + " positions, " + std::to_string(mesh.normals.size()) + " normals and " +
                        std::to_string(mesh.uv.size()) + " texture coordinates",
                    "as many of each", "export the mesh again");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (!finite(mesh.positions[i]) || !finite(mesh.normals[i]) || !finite(mesh.uv[i]))
      throw UserError(where, "vertex " + std::to_string(i + 1) + " is not finite", "finite numbers in single precision",
                      "correct the mesh, its unit or its scale");
  for (const glm::uvec3& t : mesh.triangles)
    if (std::max({t.x, t.y, t.z}) >= mesh.positions.size())
      throw UserError(where, "a triangle uses vertex " + std::to_string(std::max({t.x, t.y, t.z}) + 1ull), "at most " + std::to_string(mesh.positions.size()),
                      "export the mesh again");
  std::size_t covered = 0;
  for (const MeshPart& part : mesh.parts) {
    if (part.firstTriangle != covered)
      throw UserError(where, "the part '" + part.name + "' leaves a gap or overlaps", "parts one after the other", "export the mesh again");
    covered += part.triangleCount;
  }
  if (covered != mesh.triangles.size())
    throw UserError(where, "the mesh's parts don't cover its triangles", "every triangle in one part", "export the mesh again");

  std::size_t kept = 0;
  for (MeshPart& part : mesh.parts) {
    const std::size_t first = kept, end = part.firstTriangle + static_cast<std::size_t>(part.triangleCount);
    for (std::size_t t = part.firstTriangle; t < end; ++t)
      if (areaVector(mesh, mesh.triangles[t]) != glm::dvec3(0.0)) mesh.triangles[kept++] = mesh.triangles[t];
    part = {part.name, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(kept - first)};
  }
  const std::size_t removed = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  std::erase_if(mesh.parts, [](const MeshPart& part) { return part.triangleCount == 0; });
  if (kept == 0) throw UserError(where, "every triangle of the mesh has zero area", "a surface", "check the mesh, its unit and its scale");
  return removed;
}

}  // namespace pitviper
