#include "sim/render/shadow/shadow_pass.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "sim/gl/context.hpp"
#include "sim/world/clear_facets.hpp"

namespace pitviper {
namespace {

/// Mirrors Shadow of sim/render/shadow/glsl/shadow_maps.glsl.
struct GpuShadow {
  glm::vec4 map[4];
  glm::vec4 body[3];
  glm::ivec4 what;
  glm::vec4 fine;
  glm::vec4 ball;
};
static_assert(sizeof(GpuShadow) == 160);

/// Added to that where clear facets are known.
constexpr int kClear = 8;

/// Directions that differ by less are the same: over a kilometre a micrometre.
constexpr double kSameLight = 1e-9;
/// Where a sun is that has a place: whoever looks from there sees the same faces.
constexpr double kFarSun_m = 1e11;
/// Half a unit in the last place of a float.
constexpr double kRounding = 6e-8;

/// How a caster shades the receiver, as sim/render/shadow/glsl/shadow_maps.glsl has it: 0 another body, else 1 + SelfShadow.
int kindOf(bool self, SelfShadow how) { return self ? 1 + static_cast<int>(how) : 0; }

/// The farthest corner from the axes' origin.
double reachOf(const ShadowBox& box) { return glm::length(glm::max(glm::abs(box.low), glm::abs(box.high))); }

}  // namespace

std::string ShadowPass::slotFile(const Plan& plan) {
  return plan.terms.shadows ? "sim/render/shadow/glsl/shadow_maps.glsl" : "sim/render/shadow/glsl/shadow_none.glsl";
}

ShadowPass::ShadowPass(const Simulation& simulation, const Plan& plan, std::shared_ptr<const GpuScene> scene, const ShaderLibrary& library)
    : simulation_(simulation), scene_(std::move(scene)), trees_(scene_->shadowTrees(simulation)), lightCount_(plan.lightCount) {
  const ShaderSlots none;
  program_ = Program(assembleShader(library, "sim/render/shadow/glsl/shadow_map.vert.glsl", none),
                     assembleShader(library, "sim/render/geometry/glsl/nothing.frag.glsl", none));
  int wanted = 0;
  for (size_t e = 0; e < simulation.entities.size(); ++e) {
    ShadowBox box{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    for (const glm::vec3& p : simulation.entities[e].mesh->positions) box.low = glm::min(box.low, glm::dvec3(p)), box.high = glm::max(box.high, glm::dvec3(p));
    boxes_.push_back(box);
    if (trees_->of(e).triangles >= kDense) wanted += lightCount_;
  }
  mostLayers_ = std::clamp(wanted, 1, kMostMaps);
  layers_ = DepthLayers(kTexels, 1);
  ranges_.assign(simulation.entities.size() * static_cast<size_t>(lightCount_), {});
}

bool ShadowPass::raysCostLess(std::size_t c, std::size_t r, std::size_t l, const WorldState& state, const ShadowDemand* demand) const {
  if (!demand) return false;
  const ShadowTrees::Body& body = trees_->of(c);
  const View& view = demand->view;
  const ShadowBox box{body.low, body.high};
  double nearest_m = distanceTo(boxes_[r], state.entities[r], view.position);
  if (c != r && simulation_.entities[r].mesh->heightField) {
    const Pose& pose = state.entities[c];
    nearest_m = std::max(nearest_m, distanceToShadow(simulation_, state, view.position, pose.position + pose.orientation * box.centre(), box.radius_m(), l, r));
  }
  const double asked = demand->zoomed[r] > 0.0 ? demand->zoomed[r] : shadowedSubpixels(simulation_, state, view, c, box, l, nearest_m);
  return asked < kRaysPerMap + kRaysPerTriangle * body.triangles;
}

LightPlace ShadowPass::lightFor(std::size_t caster, std::size_t light, const WorldState& state) const {
  const Pose& pose = state.entities[caster];
  const glm::dmat3 bodyFromLocal = glm::transpose(glm::mat3_cast(pose.orientation));
  if (light == simulation_.lights.size()) return {true, bodyFromLocal * simulation_.sun->toSun, 0.0};
  return {false, bodyFromLocal * (state.lights[light] - pose.position), simulation_.lights[light].radius_m};
}

ShadowPass::Map& ShadowPass::mapOf(std::size_t caster, std::size_t light, const LightPlace& place) {
  Map& map = maps_[{caster, light}];
  if (trees_->of(caster).triangles < kDense) return map;
  // Rounding of a body's attitude is no other light.
  const bool drawn = map.layer >= 0 && map.projection && glm::length(map.light.at - place.at) <= kSameLight * glm::length(place.at);
  if (drawn) return map;
  if (map.layer < 0 && layersTaken_ == mostLayers_) return map;
  map.light = place;
  map.projection = fitShadowMap({trees_->of(caster).low, trees_->of(caster).high}, place, kTexels);
  if (!map.projection) return map;
  if (map.layer < 0) {
    if (layersTaken_ == layers_.count()) layers_.grow(std::min(mostLayers_, layersTaken_ + (layersTaken_ + 1) / 2));
    map.layer = layersTaken_++;
  }
  draw(caster, map);
  return map;
}

/// Has its program compiled, for maps that later pictures ask for.
void ShadowPass::warmUp() {
  const UnseenDraws unseen;
  Map map;
  map.layer = 0;
  map.light = {true, glm::dvec3(0.0, 0.0, 1.0), 0.0};
  for (size_t c = 0; c < boxes_.size() && !map.projection; ++c) {
    if (trees_->of(c).triangles < kDense) continue;
    map.projection = fitShadowMap({trees_->of(c).low, trees_->of(c).high}, map.light, kTexels);
    if (map.projection) draw(c, map);
  }
}

void ShadowPass::draw(std::size_t caster, const Map& map) {
  const Entity& entity = simulation_.entities[caster];
  layers_.bindForDrawing(map.layer);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  const GLfloat farthest = 1.0f;
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  scene_->bind();
  program_.use();
  glm::vec4 rows[4];
  for (int r = 0; r < 4; ++r) rows[r] = glm::vec4(map.projection->row[r]);
  glUniform4fv(program_.uniform("mapFromBody"), 4, &rows[0].x);
  glUniform1f(program_.uniform("texels"), static_cast<float>(kTexels));
  // Of a whole closed body the faces that look away lie behind others, everywhere: clusters of them are left out. (Not face by face: which way a narrow one
  // looks is decided on the map's grid, and may be decided wrongly.)
  const glm::dvec3 eye = map.light.sun ? kFarSun_m * glm::normalize(map.light.at) : map.light.at;
  const bool half = entity.mesh->closed && !simulation_.isTransparent(entity) &&
                    glm::length(eye - glm::dvec3(entity.boundingCentre)) > 1.0001 * static_cast<double>(entity.boundingRadius_m);
  const std::uint32_t base = scene_->firstTriangle(static_cast<int>(caster));
  const auto drawRun = [](std::uint32_t first, std::uint32_t count) {
    if (count > 0)
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count * 3), GL_UNSIGNED_INT, reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * 12));
  };
  for (const Surface& s : entity.surfaces) {
    if (simulation_.materialOf(s).isTransparent()) continue;
    const MeshPart& part = entity.mesh->parts[s.meshPart];
    const std::uint32_t end = part.firstTriangle + part.triangleCount;
    std::uint32_t first = 0, count = 0;  // of what is drawn at once
    bool any = false;
    for (const MeshCluster& run : scene_->clusters(static_cast<int>(caster))) {
      if (!half || run.first < part.firstTriangle || run.first >= end) continue;
      any = true;
      if (run.facesAway(eye)) continue;
      if (first + count != base + run.first) {
        drawRun(first, count);
        first = base + run.first, count = 0;
      }
      count += run.count;
    }
    if (any) drawRun(first, count);
    else drawRun(base + part.firstTriangle, part.triangleCount);
  }
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_DEPTH_CLAMP);
}

bool ShadowPass::staysStill(std::size_t entity) const {
  const Entity& e = simulation_.entities[entity];
  return e.motion.isStill() && e.parent < 0 && e.lifetime.isEndless();
}

ShadowPass::Relative ShadowPass::relative(const Pose& own, const Pose& other) {
  const glm::dmat3 ownFromLocal = glm::transpose(glm::mat3_cast(own.orientation));
  return {ownFromLocal * glm::mat3_cast(other.orientation), ownFromLocal * (other.position - own.position)};
}

ShadowPass::Clear ShadowPass::findClear(std::size_t receiver, const glm::dvec3& toSun, const WorldState& state) {
  const Mesh& mesh = *simulation_.entities[receiver].mesh;
  size_t triangles = mesh.triangles.size();
  if (!staysStill(receiver) || triangles < kFewestFacets || triangles > kMostFacets) return {};
  Clear found{toSun, {{receiver, {}}}};
  const auto sharesMesh = [&](const Entity& e) { return e.mesh.get() == &mesh; };
  std::vector<Occluder> others;
  if (std::count_if(simulation_.entities.begin(), simulation_.entities.end(), sharesMesh) == 1)
    for (size_t c = 0; c < simulation_.entities.size(); ++c) {
      const Mesh& theirs = *simulation_.entities[c].mesh;
      if (c == receiver || !staysStill(c) || !trees_->of(c).casts() || triangles + theirs.triangles.size() > kMostFacets) continue;
      triangles += theirs.triangles.size();
      const Relative at = relative(state.entities[receiver], state.entities[c]);
      others.push_back({theirs, at.axes, at.origin});
      found.casters[c] = at;
    }
  const std::vector<char> clear = keptClearFacets(mesh, toSun, others);
  const std::uint32_t first = scene_->firstTriangle(static_cast<int>(receiver));
  clear_.resize(std::max<size_t>(clear_.size(), (first + clear.size()) / 32 + 1), 0);
  for (size_t n = 0; n < clear.size(); ++n)
    if (clear[n]) clear_[(first + n) / 32] |= 1u << (first + n) % 32;
  clearFacets_ = Buffer();
  return found;
}

bool ShadowPass::leavesClear(std::size_t caster, std::size_t receiver, const glm::dvec3& toSun, const WorldState& state) {
  const std::uint32_t first = scene_->firstTriangle(static_cast<int>(receiver));
  auto known = clearOf_.find(first);
  if (known == clearOf_.end()) known = clearOf_.emplace(first, findClear(receiver, toSun, state)).first;
  const Clear& clear = known->second;
  if (clear.toSun != toSun) return false;
  if (caster == receiver) return true;
  const auto at = clear.casters.find(caster);
  return at != clear.casters.end() && at->second == relative(state.entities[receiver], state.entities[caster]);
}

bool ShadowPass::isNearLine(std::size_t caster, std::size_t receiver, std::size_t light, const WorldState& state, const std::vector<glm::dvec3>& centre) const {
  // Bounding spheres of floats, hence the room.
  const double both =
      1.0001 * (static_cast<double>(simulation_.entities[caster].boundingRadius_m) + static_cast<double>(simulation_.entities[receiver].boundingRadius_m));
  const glm::dvec3 to = centre[caster] - centre[receiver];
  glm::dvec3 nearest;
  if (light == simulation_.lights.size()) {
    nearest = std::max(glm::dot(to, simulation_.sun->toSun), 0.0) * simulation_.sun->toSun;
  } else {
    const glm::dvec3 line = state.lights[light] - centre[receiver];
    const double l2 = glm::dot(line, line);
    nearest = (l2 > 0.0 ? std::clamp(glm::dot(to, line) / l2, 0.0, 1.0) : 0.0) * line;
  }
  const glm::dvec3 beside = to - nearest;
  return glm::dot(beside, beside) <= both * both;
}

void ShadowPass::setState(const WorldState& state, const std::function<bool(std::size_t, std::size_t)>& matters, const ShadowDemand* demand) {
  if (!warm_ && simulation_.drawsMore()) warmUp();
  warm_ = true;
  const auto lights = static_cast<size_t>(lightCount_);
  std::vector<GpuShadow> shadows;
  ranges_.assign(state.entities.size() * lights, {});
  std::vector<glm::dvec3> centre;
  for (size_t e = 0; e < state.entities.size(); ++e)
    centre.push_back(state.entities[e].position + state.entities[e].orientation * glm::dvec3(simulation_.entities[e].boundingCentre));
  for (size_t l = 0; l < lights; ++l) {
    if (l < simulation_.lights.size() && !(state.lightLevels[l] > 0.0)) continue;
    for (size_t r = 0; r < state.entities.size(); ++r) {
      if (!state.isThere(r) || simulation_.mediumOf(simulation_.entities[r]) || (demand && !demand->drawn[r]) || !matters(r, l)) continue;
      const Pose& receiver = state.entities[r];
      const auto first = static_cast<std::uint32_t>(shadows.size());
      for (size_t c = 0; c < state.entities.size(); ++c) {
        const ShadowTrees::Body& body = trees_->of(c);
        if (!body.casts() || !state.isThere(c) || (c == r ? body.self == SelfShadow::Never : !isNearLine(c, r, l, state, centre))) continue;
        const Pose& caster = state.entities[c];
        const glm::dmat3 casterFromLocal = glm::transpose(glm::mat3_cast(caster.orientation));
        const glm::dmat3 axes = c == r ? glm::dmat3(1.0) : casterFromLocal * glm::mat3_cast(receiver.orientation);
        const glm::dvec3 origin = c == r ? glm::dvec3(0.0) : casterFromLocal * (receiver.position - caster.position);
        const LightPlace place = lightFor(c, l, state);
        const ShadowBox box{body.low, body.high};
        if (c != r && !mayShade(box, boxes_[r], axes, origin, place)) continue;
        // Of the inside of a convex body, seldom seen, rays are enough.
        const Map* map = (c == r && body.self == SelfShadow::Inside) || raysCostLess(c, r, l, state, demand) ? nullptr : &mapOf(c, l, place);
        const bool mapped = map && map->layer >= 0 && map->projection;
        GpuShadow g{};
        double noise = 0.0;
        const double reach = reachOf(boxes_[r]);
        for (int k = 0; k < 3; ++k) g.body[k] = glm::vec4(axes[0][k], axes[1][k], axes[2][k], origin[k]);
        for (int k = 0; mapped && k < 4; ++k) {
          const glm::dvec4& row = map->projection->row[k];
          const glm::dvec3 turned = glm::transpose(axes) * glm::dvec3(row);
          const double constant = glm::dot(glm::dvec3(row), origin) + row.w;
          g.map[k] = glm::vec4(turned, constant);
          // Rounding of the four products and sums, and of the point itself.
          if (k == 2 || k == 3) noise += 8.0 * kRounding * (glm::length(turned) * reach + std::abs(constant));
        }
        // Rounding of a place in the receiver: it stays on its facet's plane to a few units of the last place of its coordinates.
        g.fine = {noise, mapped ? map->projection->texelDepth : 0.0, c == r ? 8.0 * kRounding * reach : 0.0,
                  mapped && place.sun ? 1.0 / glm::length(glm::dvec3(map->projection->row[2])) : 0.0};
        const bool clear = place.sun && leavesClear(c, r, lightFor(r, l, state).at, state);
        g.what = {mapped ? map->layer : -1, body.first, body.end, kindOf(c == r, body.self) | (clear ? kClear : 0)};
        g.ball = glm::vec4(glm::transpose(axes) * (box.centre() - origin), box.radius_m());
        shadows.push_back(g);
      }
      ranges_[r * lights + l] = {first, static_cast<std::uint32_t>(shadows.size()) - first};
    }
  }
  shadows_.upload(shadows);
  if (!clearFacets_) clearFacets_.upload(clear_);
  checkGl("drawing shadow maps");
}

void ShadowPass::bind() const {
  shadows_.bindTexture(13, 4, true);
  clearFacets_.bindTexture(15, 1, true);
  trees_->bind();
  layers_.bind(16);
}

}  // namespace pitviper
