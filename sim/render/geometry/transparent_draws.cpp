#include "sim/render/geometry/transparent_draws.hpp"

#include <epoxy/gl.h>

namespace pitviper {
namespace {

using Kind = HitLists::Kind;

void drawTriangles(std::uint32_t first, std::size_t count) {
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT, reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * 12));
}

}  // namespace

std::vector<std::size_t> transparentIn(const std::vector<DrawItem>& items, const Simulation& simulation, const View& view, const WorldState& state,
                                       const std::vector<char>& drawn) {
  std::vector<std::size_t> found;
  for (std::size_t d = 1; d < items.size(); ++d) {
    const auto e = static_cast<std::size_t>(items[d].entity);
    if ((items[d].kind != DrawKind::Layer && items[d].kind != DrawKind::Medium) || !drawn[e] || !state.isThere(e)) continue;
    const Entity& entity = simulation.entities[e];
    const Pose& pose = state.entities[e];
    if (mayShow(view, pose.position + pose.orientation * glm::dvec3(entity.boundingCentre), entity.boundingRadius_m)) found.push_back(d);
  }
  return found;
}

void drawPane(HitLists& hits, const GpuScene& scene, const Simulation& simulation, const DrawItem& item, std::size_t draw) {
  const Entity& entity = simulation.entities[static_cast<std::size_t>(item.entity)];
  const MeshPart& part = entity.mesh->parts[entity.surfaces[static_cast<std::size_t>(item.surface)].meshPart];
  glUniform1i(hits.use(Kind::Pane).uniform("drawIndex"), static_cast<int>(draw));
  drawTriangles(scene.firstTriangle(item.entity) + part.firstTriangle, part.triangleCount);
}

void drawMedium(HitLists& hits, const GpuScene& scene, const Simulation& simulation, const DrawItem& item, std::size_t draw) {
  const Entity& entity = simulation.entities[static_cast<std::size_t>(item.entity)];
  const bool meshed = entity.form.kind == BodyForm::Kind::Mesh;
  const Program& program = hits.use(meshed ? Kind::Border : Kind::Medium);
  glUniform1i(program.uniform("drawIndex"), static_cast<int>(draw));
  if (meshed) return drawTriangles(scene.firstTriangle(item.entity), entity.mesh->triangles.size());
  // A line that meets the form must find its box, whatever the rasteriser's steps (1/256 of a pixel).
  const BodyBox& box = scene.box(item.entity);
  const glm::dvec3 margin = 0.01 * (box.high - box.low);
  const glm::vec3 size(entity.form.size), low(box.low - margin), high(box.high + margin);
  glUniform1i(program.uniform("form"), static_cast<int>(entity.form.kind));
  for (const auto& [name, v] : {std::pair{"formSize", size}, {"low", low}, {"high", high}}) glUniform3f(program.uniform(name), v.x, v.y, v.z);
  glDrawArrays(GL_TRIANGLES, 0, 36);
}

}  // namespace pitviper
