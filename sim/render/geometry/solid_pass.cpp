#include "sim/render/geometry/solid_pass.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <map>

#include "sim/render/geometry/solid_programs.hpp"

namespace pitviper {
namespace {

/// Surfaces with fewer triangles are drawn at once: they cost less than asking whether they show.
constexpr std::uint32_t kDense = 1024;
/// Asking makes the driver wait for what is drawn so far; worth it from so many triangles on (llvmpipe draws about 4000 in a millisecond).
constexpr std::uint32_t kWorthAsking = 4096;

/// Larger meshes are drawn body by body: handing the body's number on with every triangle costs llvmpipe more than a draw call.
constexpr std::uint32_t kWorthInstancing = 100;

}  // namespace

SolidPass::SolidPass(const Simulation& simulation, const std::vector<DrawItem>& items, const GpuScene& scene, const ShaderLibrary& library)
    : simulation_(simulation), items_(items), scene_(scene), programs_(scene.solidPrograms(library)) {}

std::vector<SolidPass::Candidate> SolidPass::candidatesIn(const View& v, const WorldState& state, const std::vector<char>& drawn) const {
  std::vector<Candidate> all;
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  for (size_t d = 1; d < items_.size(); ++d) {
    const DrawItem& item = items_[d];
    const auto e = static_cast<size_t>(item.entity);
    if (item.kind != DrawKind::Solid || !drawn[e] || !state.isThere(e)) continue;
    const Entity& entity = simulation_.entities[e];
    const Pose& pose = state.entities[e];
    const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(entity.boundingCentre);
    if (!mayShow(v, centre, entity.boundingRadius_m)) continue;
    const MeshPart& part = entity.mesh->parts[entity.surfaces[static_cast<size_t>(item.surface)].meshPart];
    Candidate c;
    c.draw = static_cast<std::uint32_t>(d);
    c.first = scene_.firstTriangle(item.entity) + part.firstTriangle;
    c.triangles = part.triangleCount;
    c.entity = item.entity;
    c.cull = entity.mesh->closed && glm::length(centre - v.position) > entity.boundingRadius_m * 1.0001 + v.near_m;
    cutOff(c, v, pose, part);
    if (c.triangles == 0) continue;
    const BodyBox& box = scene_.box(item.entity);
    const glm::dvec3 camera = glm::inverse(pose.orientation) * (v.position - pose.position);
    c.distance_m = glm::length(camera - glm::clamp(camera, box.low, box.high));
    c.boxBefore = true;
    for (int k = 0; k < 8; ++k) {
      const glm::dvec3 corner((k & 1) ? box.high.x : box.low.x, (k & 2) ? box.high.y : box.low.y, (k & 4) ? box.high.z : box.low.z);
      c.boxBefore &= -(cameraFromLocal * (pose.position + pose.orientation * corner - v.position)).z > v.near_m;
    }
    all.push_back(c);
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.distance_m < b.distance_m; });
  return all;
}

void SolidPass::drawOne(const Program& program, const Candidate& c) const {
  program.use();
  glUniform1i(program.uniform("drawIndex"), static_cast<int>(c.draw));
  if (c.shown.empty()) drawTriangles(c, c.first, c.triangles, 1);
  for (const auto& [first, count] : c.shown) drawTriangles(c, first, count, 1);
}

/// Clusters of a large mesh that lie wholly outside the view, or of a closed one face away, are left out: a driver without a GPU takes 80 ns for a vertex that
/// nobody sees.
void SolidPass::cutOff(Candidate& c, const View& v, const Pose& pose, const MeshPart& part) const {
  const std::uint32_t base = scene_.firstTriangle(c.entity), end = part.firstTriangle + part.triangleCount;
  const glm::dvec3 eye = glm::conjugate(pose.orientation) * (v.position - pose.position);
  bool any = false;
  for (const MeshCluster& run : scene_.clusters(c.entity)) {
    if (run.first < part.firstTriangle || run.first >= end) continue;
    any = true;
    if ((c.cull && run.facesAway(eye)) || !mayShow(v, pose.position + pose.orientation * run.centre, run.radius_m)) continue;
    if (!c.shown.empty() && c.shown.back().first + c.shown.back().second == base + run.first) c.shown.back().second += run.count;
    else c.shown.emplace_back(base + run.first, run.count);
  }
  if (!any) return;
  c.triangles = 0;
  for (const auto& s : c.shown) c.triangles += s.second;
}

void SolidPass::drawTriangles(const Candidate& c, std::uint32_t first, std::uint32_t count, std::size_t instances) const {
  if (c.cull) glEnable(GL_CULL_FACE);
  else glDisable(GL_CULL_FACE);
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(count * 3), GL_UNSIGNED_INT,
                          reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * 12), static_cast<GLsizei>(instances));
}

void SolidPass::drawHidden(const std::vector<Candidate>& dense) {
  while (queries_.size() < dense.size()) {
    GLuint name = 0;
    glCreateQueries(GL_ANY_SAMPLES_PASSED_CONSERVATIVE, 1, &name);
    queries_.emplace_back(name);
  }
  // All boxes against what is drawn so far, then the bodies whose box has shown: one wait for all.
  programs_->box.use();
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  for (size_t i = 0; i < dense.size(); ++i) {
    if (!dense[i].boxBefore) continue;
    const BodyBox& box = scene_.box(dense[i].entity);
    const glm::vec3 low(box.low), high(box.high);
    glUniform1i(programs_->box.uniform("drawIndex"), static_cast<int>(dense[i].draw));
    glUniform3f(programs_->box.uniform("low"), low.x, low.y, low.z);
    glUniform3f(programs_->box.uniform("high"), high.x, high.y, high.z);
    glBeginQuery(GL_ANY_SAMPLES_PASSED_CONSERVATIVE, queries_[i]);
    glDrawArrays(GL_TRIANGLES, 0, 36);
    glEndQuery(GL_ANY_SAMPLES_PASSED_CONSERVATIVE);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  for (size_t i = 0; i < dense.size(); ++i) {
    if (dense[i].boxBefore) glBeginConditionalRender(queries_[i], GL_QUERY_WAIT);
    drawOne(programs_->single, dense[i]);
    if (dense[i].boxBefore) glEndConditionalRender();
  }
}

void SolidPass::warmUp(RenderTarget& target) {
  const auto solid = std::find_if(items_.begin(), items_.end(), [](const DrawItem& item) { return item.kind == DrawKind::Solid; });
  if (solid == items_.end()) return;
  clear(target);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_CLAMP);
  const UnseenDraws unseen;
  Candidate c;
  c.first = scene_.firstTriangle(solid->entity), c.triangles = 1;
  drawOne(programs_->single, c);
  instances_.reserve(sizeof(std::uint32_t));
  instances_.bindStorage(7);
  programs_->instanced.use();
  drawTriangles(c, c.first, 1, 2);
  c.entity = solid->entity, c.boxBefore = true;
  drawHidden({c});
  finish();
}

void SolidPass::clear(RenderTarget& target) {
  target_ = &target;
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  target.bind();
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_GREATER);
  const GLuint nothing[4] = {0, 0, 0, 0};
  const GLfloat farthest = 0.0f;
  glClearBufferuiv(GL_COLOR, 0, nothing);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
}

void SolidPass::drawPart(const glm::ivec4& part, const std::vector<Candidate>& candidates) const {
  target_->setPart(part);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_CLAMP);
  for (const Candidate& c : candidates) drawOne(programs_->single, c);
  finish();
  target_->setPart(glm::ivec4(0));
}

void SolidPass::finish() {
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
}

void SolidPass::draw(RenderTarget& target, const View& v, const WorldState& state, const std::vector<char>& drawn) {
  clear(target);
  std::vector<Candidate> dense;
  std::vector<std::vector<Candidate>> groups;  // of one small mesh, where the nearest of them stands
  std::map<std::pair<std::uint32_t, bool>, size_t> groupOf;
  std::uint32_t asked = 0;
  for (const Candidate& c : candidatesIn(v, state, drawn)) {
    if (c.triangles >= kDense) {
      if (!dense.empty()) asked += c.triangles;
      dense.push_back(c);
      continue;
    }
    const auto [known, fresh] = groupOf.try_emplace({c.first, c.cull}, groups.size());
    if (fresh || c.triangles > kWorthInstancing) groups.push_back({c});
    else groups[known->second].push_back(c);
  }
  std::vector<std::uint32_t> instances;
  for (const auto& group : groups)
    if (group.size() > 1)
      for (const Candidate& c : group) instances.push_back(c.draw);
  if (!instances.empty()) {
    instances_.upload(instances);
    instances_.bindStorage(7);
  }

  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_CLAMP);  // what is before the camera's near plane is cut off by a distance; in one state always, for which llvmpipe compiles once
  int firstInstance = 0;
  for (const auto& group : groups) {
    if (group.size() == 1) {
      drawOne(programs_->single, group.front());
      continue;
    }
    programs_->instanced.use();
    glUniform1i(programs_->instanced.uniform("firstInstance"), firstInstance);
    drawTriangles(group.front(), group.front().first, group.front().triangles, group.size());
    firstInstance += static_cast<int>(group.size());
  }
  if (asked < kWorthAsking) {
    for (const Candidate& c : dense) drawOne(programs_->single, c);
  } else {
    drawOne(programs_->single, dense[0]);
    drawHidden({dense.begin() + 1, dense.end()});
  }
  finish();
}

}  // namespace pitviper
