#include "sim/scene/mesh_tools.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <unordered_map>

namespace pitviper {
namespace {

/// Three float bit patterns (positions) or a smoothing group and two of them (uv): equal keys mean the same vertex.
using Key = std::array<std::uint32_t, 3>;

struct KeyHash {
  std::size_t operator()(const Key& k) const {
    std::uint64_t h = 0x9e3779b97f4a7c15u;  // the golden ratio and two odd multipliers: any good mix will do
    for (std::uint32_t v : k) h = (std::rotl(h, 23) ^ v) * 0xff51afd7ed558ccdu;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

std::uint32_t bitsOf(float value) { return std::bit_cast<std::uint32_t>(value == 0.0f ? 0.0f : value); }  // -0 is 0

/// For each vertex the number of its position: vertices at exactly the same place share one.
std::vector<std::uint32_t> weldByPosition(const Mesh& mesh) {
  std::vector<std::uint32_t> place(mesh.positions.size());
  std::unordered_map<Key, std::uint32_t, KeyHash> known;
  known.reserve(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    const Key key{bitsOf(p.x), bitsOf(p.y), bitsOf(p.z)};
    place[i] = known.try_emplace(key, static_cast<std::uint32_t>(known.size())).first->second;
  }
  return place;
}

/// Twice the triangle's area times its normal.
glm::dvec3 areaVector(const Mesh& mesh, const glm::uvec3& t) {
  const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
  return glm::cross(b - a, c - a);
}

glm::dvec3 unitOr(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : otherwise;
}

/// One of the three directed edges of a triangle, between welded places, smaller place first.
struct Edge {
  std::uint64_t places;  ///< smaller place in the upper half
  std::uint32_t triangle;
  std::uint8_t corner;  ///< where the edge starts
  bool forward;         ///< runs from the smaller place to the larger
  friend bool operator<(const Edge& a, const Edge& b) { return a.places != b.places ? a.places < b.places : a.triangle < b.triangle; }
};

std::vector<Edge> sortedEdges(const Mesh& mesh, const std::vector<std::uint32_t>& place) {
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint64_t a = place[mesh.triangles[t][k]], b = place[mesh.triangles[t][(k + 1) % 3]];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, k, a < b});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Corners (3 t + k) of triangles that meet at a place and are joined by edges bent less than the crease: one root
/// each.
std::vector<std::uint32_t> smoothingGroups(const Mesh& mesh, const std::vector<std::uint32_t>& place, const std::vector<glm::dvec3>& faceNormals,
                                           double leastCosine) {
  std::vector<std::uint32_t> parent(mesh.triangles.size() * 3);
  std::iota(parent.begin(), parent.end(), 0u);
  const std::vector<Edge> edges = sortedEdges(mesh, place);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const Edge &a = edges[i], &b = edges[i + 1];
    if (a.places != b.places || a.forward == b.forward) continue;
    if (i > 0 && edges[i - 1].places == a.places) continue;  // more than two triangles: a crease
    if (i + 2 < edges.size() && edges[i + 2].places == a.places) continue;
    if (glm::dot(faceNormals[a.triangle], faceNormals[b.triangle]) < leastCosine) continue;
    const auto join = [&](std::uint32_t ka, std::uint32_t kb) { parent[rootOf(parent, a.triangle * 3 + ka % 3)] = rootOf(parent, b.triangle * 3 + kb % 3); };
    join(a.corner, b.corner + 1u);
    join(a.corner + 1u, b.corner);
  }
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = rootOf(parent, i);
  return parent;
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
  const std::vector<Edge> edges = sortedEdges(mesh, weldByPosition(mesh));
  for (std::size_t i = 0; i < edges.size();) {
    long long balance = 0;
    const std::uint64_t places = edges[i].places;
    for (; i < edges.size() && edges[i].places == places; ++i) balance += edges[i].forward ? 1 : -1;
    if (balance != 0 && places >> 32 != (places & 0xffffffffu)) return false;  // an edge of no length doesn't count
  }
  return signedVolume(mesh) > 0.0;
}

void computeNormals(Mesh& mesh, double creaseAngle_rad) {
  const std::vector<std::uint32_t> place = weldByPosition(mesh);
  std::vector<glm::dvec3> faceNormals;
  faceNormals.reserve(mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) faceNormals.push_back(unitOr(areaVector(mesh, t), {0.0, 0.0, 1.0}));
  const std::vector<std::uint32_t> group = smoothingGroups(mesh, place, faceNormals, std::cos(creaseAngle_rad));

  std::vector<glm::dvec3> sums(group.size(), glm::dvec3(0.0));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 at(mesh.positions[mesh.triangles[t][k]]);
      const glm::dvec3 u = glm::dvec3(mesh.positions[mesh.triangles[t][(k + 1) % 3]]) - at;
      const glm::dvec3 v = glm::dvec3(mesh.positions[mesh.triangles[t][(k + 2) % 3]]) - at;
      sums[group[3 * t + k]] += faceNormals[t] * std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
    }

  Mesh out;
  std::unordered_map<Key, std::uint32_t, KeyHash> known;
  known.reserve(mesh.positions.size());
  const bool hasUv = mesh.uv.size() == mesh.positions.size();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t i = mesh.triangles[t][k], root = group[3 * t + k];
      const glm::vec2 uv = hasUv ? mesh.uv[i] : glm::vec2(0.0f);
      const auto [entry, isNew] = known.try_emplace(Key{root, bitsOf(uv.x), bitsOf(uv.y)}, static_cast<std::uint32_t>(out.positions.size()));
      if (isNew) {
        out.positions.push_back(mesh.positions[i]);
        out.normals.push_back(glm::vec3(unitOr(sums[root], faceNormals[t])));
        out.uv.push_back(uv);
      }
      mesh.triangles[t][k] = entry->second;
    }
  mesh.positions = std::move(out.positions);
  mesh.normals = std::move(out.normals);
  mesh.uv = std::move(out.uv);
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

std::string writeObj(const Mesh& mesh) {
  std::string text;
  char line[128];
  const auto put = [&](const char* format, auto... values) {
    text.append(line, static_cast<std::size_t>(std::snprintf(line, sizeof line, format, values...)));
  };
  const auto number = [](float v) { return static_cast<double>(v); };
  for (const glm::vec3& p : mesh.positions) put("v %.5g %.5g %.5g\n", number(p.x), number(p.y), number(p.z));
  for (const glm::vec2& t : mesh.uv) put("vt %.5g %.5g\n", number(t.x), number(t.y));
  for (const glm::vec3& n : mesh.normals) put("vn %.5g %.5g %.5g\n", number(n.x), number(n.y), number(n.z));
  for (const MeshPart& part : mesh.parts) {
    text += "g " + part.name + "\n";
    for (std::uint32_t i = 0; i < part.triangleCount; ++i) {
      const glm::uvec3 t = mesh.triangles[part.firstTriangle + i] + 1u;
      put("f %u/%u/%u %u/%u/%u %u/%u/%u\n", t.x, t.x, t.x, t.y, t.y, t.y, t.z, t.z, t.z);
    }
  }
  return text;
}

}  // namespace pitviper
