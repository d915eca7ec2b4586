#include "sim/render/geometry/gpu_scene.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim/gl/context.hpp"
#include "sim/render/geometry/shadow_trees.hpp"
#include "sim/render/geometry/solid_programs.hpp"

namespace pitviper {

namespace {

BodyBox boxOf(const Mesh& mesh, const BodyForm& form) {
  constexpr double kMargin = 1e-5;
  BodyBox box{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (const glm::vec3& p : mesh.positions) box.low = glm::min(box.low, glm::dvec3(p)), box.high = glm::max(box.high, glm::dvec3(p));
  glm::dvec3 reach(0.0);
  if (form.kind == BodyForm::Kind::Ellipsoid) reach = form.size;
  if (form.kind == BodyForm::Kind::Cone) reach = {form.size.x, std::max(form.size.y, form.size.z), std::max(form.size.y, form.size.z)};
  if (form.kind != BodyForm::Kind::Mesh) box.low = glm::min(box.low, -reach), box.high = glm::max(box.high, reach);
  const double margin = kMargin * glm::length(box.high - box.low);
  return {box.low - margin, box.high + margin};
}

/// Mirrors sim/render/geometry/glsl/drawn_vertices.glsl.
struct DrawnVertex {
  glm::vec3 position;
  std::uint32_t triangle;
};

/// Corners in turn so that the last of each triangle is a vertex that no other has for its last: its own, or a copy.
void appendDrawn(const Mesh& mesh, const std::vector<std::uint32_t>& order, std::uint32_t first, std::vector<DrawnVertex>& drawn,
                 std::vector<std::uint32_t>& corners) {
  const auto base = static_cast<std::uint32_t>(drawn.size());
  for (const glm::vec3& p : mesh.positions) drawn.push_back({p, 0});
  std::vector<char> taken(mesh.positions.size(), 0);
  for (std::uint32_t n : order) {
    const glm::uvec3& t = mesh.triangles[n];
    int last = 2;
    while (last >= 0 && taken[t[last]]) --last;
    std::uint32_t own = base + t[std::max(last, 0)];
    if (last < 0) {
      own = static_cast<std::uint32_t>(drawn.size());
      drawn.push_back({mesh.positions[t[last = 0]], 0});
    } else {
      taken[t[last]] = 1;
    }
    drawn[own].triangle = first + n;
    corners.insert(corners.end(), {base + t[(last + 1) % 3], base + t[(last + 2) % 3], own});
  }
}

/// As textures.glsl reads it.
glm::uvec4 shapeOf(std::size_t first, int width, int height, std::size_t last) {
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), static_cast<std::uint32_t>(last)};
}

}  // namespace

GpuScene::GpuScene(const Simulation& sim) : vertexArray_(makeVertexArray()) {
  // What a driver has freed it gives out again: nothing of a renderer that has ended may still be written there.
  if (!isSoftware()) glFinish();
  std::vector<glm::vec4> vertices;
  std::vector<glm::uvec4> indices;
  std::vector<std::uint32_t> corners;
  std::vector<DrawnVertex> drawn;
  std::map<const Mesh*, std::uint32_t> placed;
  std::map<const Mesh*, std::shared_ptr<const ClusteredMesh>> clustered;
  std::set<const Mesh*> meshes;
  std::size_t points = 0, triangles = 0;
  for (const auto& entity : sim.entities)
    if (meshes.insert(entity.mesh.get()).second) points += entity.mesh->positions.size(), triangles += entity.mesh->triangles.size();
  vertices.reserve(2 * points), indices.reserve(triangles), corners.reserve(3 * triangles);
  for (const auto& entity : sim.entities) {
    const Mesh& mesh = *entity.mesh;
    const auto [at, fresh] = placed.try_emplace(&mesh, static_cast<std::uint32_t>(indices.size()));
    firstTriangle_.push_back(at->second);
    boxes_.push_back(boxOf(mesh, entity.form));
    auto& own = clustered[&mesh];
    if (!own) own = std::make_shared<const ClusteredMesh>(clustersOf(mesh));
    clustered_.push_back(own);
    if (!fresh) continue;
    const auto base = static_cast<std::uint32_t>(vertices.size() / 2);
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      vertices.emplace_back(mesh.positions[i], mesh.uv[i].x);
      vertices.emplace_back(mesh.normals[i], mesh.uv[i].y);
    }
    for (const auto& t : mesh.triangles) indices.emplace_back(base + t, 0u);
    appendDrawn(mesh, own->order, at->second, drawn, corners);
  }
  drawn_.upload(drawn);
  corners_.upload(corners);
  vertices_.upload(vertices);
  indices_.upload(indices);

  std::vector<glm::uvec4> shapes;
  std::vector<float> texels;
  std::size_t texelCount = 0;
  for (const Texture& t : sim.textures) texelCount += t.texels.size();
  texels.reserve(texelCount);
  // Shapes of the textures first, then of their levels, those of cells before the others; see textures.glsl.
  std::size_t shape = sim.textures.size();
  for (const Texture& t : sim.textures) {
    shape += t.cells.mean.empty() ? 0 : 1;
    shapes.push_back(shapeOf(texels.size(), t.width, t.height, (t.repeats ? 1u : 0u) + 2 * t.levels.size() + 64 * shape));
    texels.insert(texels.end(), t.texels.begin(), t.texels.end());
    shape += t.levels.size();
  }
  std::vector<glm::vec4> levels;
  const auto append = [&](const TextureLevel& l, const std::vector<float>& own) {
    shapes.push_back(shapeOf(levels.size(), l.width, l.height, 0));
    for (std::size_t k = 0; k < l.mean.size(); ++k)
      levels.emplace_back(l.mean[k], l.second.empty() ? 0.0f : l.second[k], l.third.empty() ? 0.0f : l.third[k], own[k]);
  };
  for (const Texture& t : sim.textures) {
    if (!t.cells.mean.empty()) append(t.cells, t.texels);
    for (const TextureLevel& l : t.levels) append(l, l.mean);
  }
  levels_.upload(levels);
  textureShapes_.upload(shapes);
  texels_.upload(texels);
}

std::shared_ptr<const ShadowTrees> GpuScene::shadowTrees(const Simulation& simulation) const {
  if (!shadowTrees_) shadowTrees_ = std::make_shared<const ShadowTrees>(simulation);
  return shadowTrees_;
}

std::shared_ptr<const SolidPrograms> GpuScene::solidPrograms(const ShaderLibrary& library) const {
  if (!solidPrograms_) solidPrograms_ = std::make_shared<const SolidPrograms>(library);
  return solidPrograms_;
}

void GpuScene::bind() const {
  glBindVertexArray(vertexArray_);
  vertices_.bindTexture(6, 4);
  indices_.bindTexture(7, 4, true);
  corners_.bindElements();
  drawn_.bindVertices();
  textureShapes_.bindTexture(11, 4, true);
  texels_.bindTexture(12, 1);
  levels_.bindTexture(30, 4);
}

}  // namespace pitviper
