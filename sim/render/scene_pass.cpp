#include "sim/render/scene_pass.hpp"

#include <epoxy/gl.h>

#include <cmath>

#include "sim/gl/context.hpp"
#include "sim/gl/timing.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Mirrors Draw of sim/render/glsl/draws.glsl (std430).
struct GpuDraw {
  glm::vec4 row[3];
  glm::uvec4 table;
  glm::vec4 state;
  glm::vec4 fine;
};
static_assert(sizeof(GpuDraw) == 96);

/// Mirrors ViewBlock of sim/render/glsl/view_block.glsl (std140).
struct GpuView {
  glm::vec4 pixel, film, depth, up, earth, sun, aperture, east, north;
};

/// The same plan at one wavelength: what the reference needs of tables is which part each draw is.
Plan outline(const Plan& plan) {
  Plan one = plan;
  one.nodes.resize(1);
  for (auto& w : one.weight) w.resize(1);
  one.blocks = {{0, 1, {}}};
  for (int s = 0; s < plan.slotCount; ++s) one.blocks[0].slots.push_back(s);
  return one;
}

}  // namespace

ScenePass::ScenePass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
                     double apertureArea_m2, Shading shading)
    : simulation_(simulation),
      plan_(plan),
      scene_(std::move(scene)),
      truth_(truth),
      apertureArea_m2_(apertureArea_m2),
      outline_(shading == Shading::Reference ? std::optional(outline(plan)) : std::nullopt),
      tables_(makeTables(simulation, tabled())),
      surfaceClasses_(sortIntoClasses(tables_, simulation)),
      solid_(tables_.solid),
      solids_(simulation, tables_, *scene_, library),
      relevance_(std::in_place, simulation, tabled(), tables_),
      how_(shading) {
  if (plan.terms.air && shading != Shading::Reference) air_ = simulation.air->onGpu(simulation, plan, shading == Shading::Direct);
  if (plan.terms.shadows) shadows_ = std::make_unique<ShadowPass>(simulation, plan, scene_, library);
  ShaderSlots slots;
  slots.constants["GROUND"] = tables_.ground;
  pixelClasses_.emplace(library, slots);
  if (shading != Shading::Reference)
    checkUniformSize((tables_.node.size() + tables_.ambient.size() + plan.nodes.size() * static_cast<size_t>(lightGroups(plan)) * 4) * sizeof(float),
                     "the spectral nodes");
}

ShaderSlots ScenePass::shadingSlots() const {
  ShaderSlots slots;
  slots.files["path"] = "sim/render/glsl/path_none.glsl";
  if (air_) air_->addSlots(slots);
  addSurfaceSlots(tables_.solid, plan_.terms.solid, plan_, slots);
  slots.files["shadow"] = ShadowPass::slotFile(plan_);
  slots.files["surface"] = std::string("sim/render/glsl/") + (tables_.solid.general ? "surface_general.glsl"
                                                              : tables_.solid.lit   ? "surface_simple.glsl"
                                                                                    : "surface_unlit.glsl");
  slots.files["transmission"] = "sim/render/glsl/transmission_none.glsl";
  slots.constants["NODES"] = how_ == Shading::Reference ? 1 : plan_.nodeCount();
  slots.constants["GROUPS"] = plan_.groupCount();
  slots.constants["LIGHTS"] = plan_.lightCount;
  slots.constants["LIGHT_GROUPS"] = lightGroups(plan_);
  slots.constants["SUN"] = simulation_.sun && plan_.lightCount > 0 ? 1 : 0;
  slots.constants["GROUND"] = tables_.ground;
  slots.constants["SURFACES"] = 1;
  slots.constants["SUN_SETS"] = simulation_.overEarth() ? 1 : 0;
  // Of four lights a vec4 at each node [W/(sr um)], the sun as irradiance; and radiance of the dome.
  slots.generated["light_nodes"] = plan_.lightCount > 0 ? "  vec4 nodeLight[NODES * LIGHT_GROUPS];\n" : "";
  slots.generated["ambient_nodes"] = tables_.ambient.empty() ? "" : "  vec4 nodeAmbient[NODES];\n";
  return slots;
}

std::vector<NamedProgram> ScenePass::programs() const {
  std::vector<NamedProgram> all;
  if (shadows_) all.push_back({"shadow maps", shadows_->program().text()});
  return all;
}

std::vector<std::string> ScenePass::channelTargets() const {
  std::vector<std::string> names;
  for (int g = 0; g < plan_.groupCount(); ++g) names.push_back("channels" + std::to_string(g));
  return names;
}

void ScenePass::setState(const WorldState& state) {
  const TimedPart part("tables");
  if (updateTemperatures(tables_, simulation_, tabled(), state)) {
    solid_.update(tables_.solid);
    relevance_.emplace(simulation_, tabled(), tables_);
    onTemperatures();
  }
  std::vector<float> block = tables_.node;
  const auto lights = lightTable(simulation_, tabled(), state);
  block.insert(block.end(), lights.begin(), lights.end());
  block.insert(block.end(), tables_.ambient.begin(), tables_.ambient.end());
  nodes_.upload(block);
  if (air_) air_->begin();
  const TimedPart shadows("shadow maps");
  if (shadows_) shadows_->setState(state, [&](size_t e, size_t l) { return l == simulation_.lights.size() || relevance_->shadowMatters(e, l, state); });
}

void ScenePass::uploadView(const View& v, const WorldState& state) {
  if (const TimedPart part("air"); air_) air_->update(v, state);
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  GpuView g;
  g.pixel = {v.tanPerPixelX, v.tanPerPixelY, v.axisX, v.axisY};
  const double halfX = 0.5 * v.width, halfY = 0.5 * v.height;
  g.film = {1.0 / (halfX * v.tanPerPixelX), 1.0 / (halfY * v.tanPerPixelY), v.axisX / halfX - 1.0, v.axisY / halfY - 1.0};
  g.depth = {v.near_m, v.onlyEntity >= 0 ? 0.5 * glm::length(v.depthCentre - v.position) / v.depthRadius_m : 0.0, 0.0, 0.0};
  g.up = glm::vec4(cameraFromLocal * simulation_.frame.up(v.position), simulation_.frame.height(v.position));
  g.earth = {simulation_.frame.earthRadius_m(), simulation_.air ? simulation_.air->top_m() : physics::kFar, v.onlyEntity + 1, 0.0};
  g.sun = glm::vec4(simulation_.sun ? cameraFromLocal * simulation_.sun->toSun : glm::dvec3(0.0), 0.0);
  g.aperture = {apertureArea_m2_, v.pixelTan2, 0.0, 0.0};
  g.east = glm::vec4(cameraFromLocal * glm::dvec3(1, 0, 0), 0.0);
  g.north = glm::vec4(cameraFromLocal * glm::dvec3(0, 1, 0), 0.0);
  view_.upload(&g, sizeof g);
}

void ScenePass::uploadDraws(const View& v, const WorldState& state) {
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  const size_t stride = 2 * static_cast<size_t>(plan_.lightCount) + 1;
  std::vector<GpuDraw> draws;
  std::vector<glm::vec4> lights((state.entities.size() + 1) * stride, glm::vec4(0.0f));
  for (size_t d = 0; d < tables_.draws.size(); ++d) {
    const DrawItem& item = tables_.draws[d];
    GpuDraw g{};
    const Pose pose = item.entity < 0 ? Pose{v.position, {1, 0, 0, 0}} : state.entities[static_cast<size_t>(item.entity)];
    const glm::dmat3 bodyFromLocal = glm::transpose(glm::mat3_cast(pose.orientation));
    const glm::dmat3 bodyFromCamera = bodyFromLocal * v.localFromCamera;
    const glm::dvec3 origin = cameraFromLocal * (pose.position - v.position);
    for (int r = 0; r < 3; ++r) g.row[r] = glm::vec4(bodyFromCamera[0][r], bodyFromCamera[1][r], bodyFromCamera[2][r], origin[r]);
    const Surface* s = item.kind == DrawKind::Ground ? &*simulation_.ground
                       : item.entity < 0             ? nullptr
                                                     : &simulation_.entities[static_cast<size_t>(item.entity)].surfaces[static_cast<size_t>(item.surface)];
    g.table = {item.row, item.material, s ? static_cast<unsigned>(s->temperatureTexture + 1) : 0u, static_cast<unsigned>(item.entity + 1)};
    const size_t lightRow = static_cast<size_t>(item.entity + 1);
    const double fromCentre = (cameraFromLocal * (pose.position - v.depthCentre)).z;
    g.state = {item.entity >= 0 ? item.temperature_K : s ? s->temperature_K : 0.0, item.surface + 1, static_cast<double>(lightRow), fromCentre};
    g.fine = {origin.z - static_cast<double>(static_cast<float>(origin.z)), PixelClasses::depthOf(static_cast<size_t>(item.surfaceClass)), 0.0, 0.0};
    glm::vec4* row = &lights[lightRow * stride];
    const bool ground = item.kind == DrawKind::Ground;
    if (plan_.lightCount > 0 && (item.entity >= 0 || ground) && row->x == 0.0f) {  // once for all surfaces of a body
      // Few lights have a place each, many are listed one after the other: lights_few.glsl, lights_many.glsl.
      const bool few = plan_.lightCount <= kFewLights;
      auto add = [&](const glm::dvec3& place, double radius_m, size_t number, bool matters, double shadowReach2_m2) {
        if (!few && !matters) return;
        const size_t k = few ? number : static_cast<size_t>(row->x);
        row[2 * k + 1] = glm::vec4(place, radius_m);
        const auto casters = shadows_ && matters && !ground ? shadows_->castersOf(static_cast<size_t>(item.entity), number) : ShadowPass::Range{};
        row[2 * k + 2] = glm::vec4(matters ? static_cast<float>(number) : -1.0f, casters.first, casters.count, shadowReach2_m2);
        row->x += 1.0f;
      };
      for (size_t l = 0; l < simulation_.lights.size(); ++l)
        add(bodyFromLocal * (state.lights[l] - pose.position), simulation_.lights[l].radius_m, l,
            !ground && ((truth_ && l == 0) || relevance_->matters(static_cast<size_t>(item.entity), l, state)),
            ground ? 0.0 : relevance_->shadowReach2_m2(static_cast<size_t>(item.entity), l, state));
      if (simulation_.sun) add(bodyFromLocal * simulation_.sun->toSun, 0.0, simulation_.lights.size(), true, physics::kFar);
    }
    draws.push_back(g);
  }
  draws_.upload(draws);
  lights_.upload(lights);
}

ScenePass::Targets& ScenePass::targetsFor(int width, int height) {
  for (auto& [size, t] : targets_)
    if (size == std::pair(width, height)) return t;
  std::vector<PixelFormat> colours(static_cast<size_t>(plan_.groupCount() + (truth_ ? 3 : 0)), PixelFormat::Rgba32f);
  targets_.emplace_back(std::pair(width, height),
                        Targets{RenderTarget(width, height, {PixelFormat::Rg32ui}, true), RenderTarget(width, height, colours, false)});
  return targets_.back().second;
}

void ScenePass::bindBuffers() const {
  scene_->bind();
  draws_.bindStorage(2);
  solid_.bind();
  lights_.bindStorage(5);
  if (air_) air_->bind();
  view_.bindUniform(0);
  nodes_.bindUniform(1);
  if (shadows_) shadows_->bind();
}

void ScenePass::draw(const View& v, const WorldState& state, const std::vector<char>& drawn) {
  current_ = &targetsFor(v.width, v.height);
  uploadView(v, state);
  {
    const TimedPart part("draws");
    uploadDraws(v, state);
    bindBuffers();
  }
  {
    const TimedPart part("visibility");
    solids_.draw(current_->visibility, v, state, drawn);
  }
  {
    const TimedPart part("order");
    beforeShading(v, state, drawn);
  }
  const TimedPart part("shading");
  pixelClasses_->find(current_->visibility);
  current_->visibility.colour(0).bind(0);
  partial_ = v.onlyEntity >= 0;
  if (partial_) {
    current_->shading.select(0, current_->shading.colourCount());
    current_->shading.bind();
    const GLfloat zero[4] = {0, 0, 0, 0};
    for (size_t i = 0; i < current_->shading.colourCount(); ++i) glClearBufferfv(GL_COLOR, static_cast<GLint>(i), zero);
  }
  shade(current_->shading, current_->visibility);
  checkGl("drawing a frame");
}

void ScenePass::startReadback(bool identity) {
  const TimedPart part("readback");
  readback_.start(current_->shading, current_->shading.colourCount(), identity ? &current_->visibility : nullptr);
}

RawImage ScenePass::finishReadback() {
  const TimedPart part("readback");
  auto pixels = readback_.wait();
  RawImage image;
  image.width = current_->shading.width();
  image.height = current_->shading.height();
  for (size_t i = 0; i < pixels.identity.size(); i += 2) image.entity.push_back(tables_.draws[pixels.identity[i]].entity);
  for (size_t i = 0; i < pixels.colours.size(); ++i)
    (i < static_cast<size_t>(plan_.groupCount()) ? image.groups : image.truth).push_back(std::move(pixels.colours[i]));
  return image;
}

}  // namespace pitviper
