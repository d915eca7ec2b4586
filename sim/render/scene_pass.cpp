#include "sim/render/scene_pass.hpp"

#include <epoxy/gl.h>

#include <bit>
#include <cmath>

#include "sim/gl/context.hpp"
#include "sim/gl/timing.hpp"
#include "sim/plan/budget.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/surface/surface_slots.hpp"

namespace pitviper {
namespace {

/// Places for many lights, at least: with so many Mesa keeps the loop over those that shine; written out (up to 32), one would cost as much as all.
constexpr int kLightPlaces = 33;
/// Tiles are drawn in pictures of so many pixels a side at most, or of one tile.
constexpr int kTilePicture_px = 1024;
/// For the rounding of places in single precision.
constexpr double kRoom = 1.001;

}  // namespace

ScenePass::ScenePass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
                     double apertureArea_m2, Shading shading, bool classes)
    : simulation_(simulation),
      plan_(plan),
      library_(library),
      scene_(std::move(scene)),
      truth_(truth),
      apertureArea_m2_(apertureArea_m2),
      patterns_(simulation),
      tables_(makeTables(simulation, plan)),
      surfaceClasses_(sortIntoClasses(tables_, simulation, plan, truth, classes)),
      pixelClasses_(library, classSlots(classes)),
      solid_(tables_.solid),
      solids_(simulation, tables_.draws, *scene_, library),
      relevance_(simulation, plan, tables_) {
  if (plan.terms.air) air_ = simulation.air->onGpu(simulation, plan, shading == Shading::Direct);
  if (isShaded()) {
    const SunShadeGrid& grid = simulation.sunShade->grid();
    std::vector<float> all{static_cast<float>(grid.nodes.x), static_cast<float>(grid.nodes.y), static_cast<float>(grid.nodes.z)};
    all.insert(all.end(), grid.depth.begin(), grid.depth.end());
    sunShade_.upload(all);
  }
  if (tables_.around) around_ = std::make_shared<SurroundingsBuffer>(simulation, *tables_.around);
  if (plan.terms.shadows) shadows_ = std::make_shared<ShadowPass>(simulation, plan, scene_, library);
  checkUniformSize((tables_.node.size() + tables_.ambient.size() + plan.nodes.size() * static_cast<size_t>(lightGroups(simulation, plan)) * 4) * sizeof(float),
                   "the spectral nodes");
}

ShaderSlots ScenePass::classSlots(bool classes) const {
  ShaderSlots slots;
  slots.constants["GROUND"] = tables_.ground;
  const bool demand = classes && lightsVary(plan_, simulation_, truth_);
  slots.files["light_demand"] = surfaceShader(demand ? "light_demand" : "light_demand_none");
  slots.files["shadow_list"] = plan_.terms.shadows ? "sim/render/shadow/glsl/shadow_list.glsl" : "sim/render/shadow/glsl/shadow_list_none.glsl";
  slots.constants["SHADOWS_VARY"] = classes && shadowsVary(plan_, simulation_, truth_) ? 1 : 0;
  addLightSlots(slots);
  return slots;
}

void ScenePass::shareLight(const ScenePass& other) {
  shadows_ = other.shadows_;
  around_ = other.around_;
}

void ScenePass::addLightSlots(ShaderSlots& slots) const {
  slots.constants["LIGHTS"] = plan_.lightCount;
  slots.constants["FEW_LIGHTS"] = kFewLights;
  slots.constants["SUN"] = simulation_.sun && plan_.lightCount > 0 ? 1 : 0;
  slots.constants["SUN_SHADED"] = isShaded() ? 1 : 0;
  slots.files["sun_shade"] = surfaceShader(isShaded() ? "sun_shade_clouds" : "sun_shade_none");
  slots.constants["SUN_SETS"] = simulation_.overEarth() ? 1 : 0;
  patterns_.addSlots(slots);
}

ShaderSlots ScenePass::shadingSlots(bool writtenOut) const {
  ShaderSlots slots;
  slots.files["path"] = "sim/render/assembly/glsl/path_none.glsl";
  slots.constants["WRITTEN_OUT"] = writtenOut ? 1 : 0;
  if (air_) air_->addSlots(slots);
  addSurfaceSlots(tables_.solid, plan_.terms.solid, plan_, slots);
  slots.files["shadow"] = ShadowPass::slotFile(plan_);
  slots.files["surface"] = surfaceShader(tables_.solid.general ? "surface_general" : tables_.solid.lit ? "surface_simple" : "surface_unlit");
  slots.files["transmission"] = "sim/render/surface/glsl/transmission_none.glsl";
  slots.constants["NODES"] = plan_.nodeCount();
  slots.constants["NODE_TEXELS"] = (plan_.nodeCount() + 3) / 4;
  slots.constants["GROUPS"] = plan_.groupCount();
  addLightSlots(slots);
  slots.constants["LIGHT_GROUPS"] = lightGroups(simulation_, plan_);
  slots.constants["LIGHT_PLACES"] = std::max(plan_.lightCount, kLightPlaces);
  slots.constants["GROUND"] = tables_.ground;
  slots.constants["SURFACES"] = 1;
  // Of four lights a vec4 at each node [W/(sr um)], the sun as irradiance; and radiance of the dome.
  slots.generated["light_nodes"] = plan_.lightCount > 0 ? "  vec4 nodeLight[NODES * LIGHT_GROUPS];\n" : "";
  if (around_) around_->addConstants(slots);
  slots.constants["AROUND_KEPT"] = writtenOut ? plan_.nodeCount() : 0;
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

void ScenePass::setState(const WorldState& state, const ShadowDemand* demand) {
  {
    const TimedPart part("tables");
    if (updateTemperatures(tables_, simulation_, plan_, state)) {
      solid_.update(tables_.solid);
      relevance_.follow(tables_);
      onTemperatures();
    }
  }
  if (const TimedPart part("shadow maps"); shadows_)
    shadows_->setState(
        state, [&](size_t e, size_t l) { return l == simulation_.lights.size() || relevance_.shadowMatters(e, l, state); }, demand);
  const TimedPart part("tables");
  std::vector<float> block = tables_.node;
  const auto lights = lightTable(simulation_, plan_, state);
  block.insert(block.end(), lights.begin(), lights.end());
  block.insert(block.end(), tables_.ambient.begin(), tables_.ambient.end());
  nodes_.upload(block);
  if (air_) air_->begin();
  if (around_) around_->setState(state);
  uploadLights(state);
}

GpuDraw ScenePass::drawOf(std::size_t draw, const View& view, const WorldState& state) const {
  GpuDraw data = drawData(simulation_, tables_.draws[draw], view, state);
  const DrawItem& item = tables_.draws[draw];
  if (around_) data.fine.w = around_->slotOf(item.entity);
  // Which of its classes are drawn: class_depth.glsl.
  const LightNeeds needs = item.entity >= 0 ? lightNeeds_[static_cast<size_t>(item.entity)] : LightNeeds{};
  const bool apart = item.unshadowed != item.everyLight;
  data.fine.z += 2.0f * static_cast<float>((needs.sunAlone ? 1 : 0) + (needs.lamps && apart ? 2 : 0) + (needs.shadows || (needs.lamps && !apart) ? 4 : 0));
  return data;
}

void ScenePass::uploadLights(const WorldState& state) {
  const auto texels = static_cast<size_t>(patterns_.texels()), stride = texels * static_cast<size_t>(plan_.lightCount) + 1;
  std::vector<glm::vec4> lights((state.entities.size() + 1) * stride, glm::vec4(0.0f));
  const bool few = plan_.lightCount <= kFewLights;
  lightNeeds_.assign(state.entities.size(), {});
  for (size_t r = 0; plan_.lightCount > 0 && r <= state.entities.size(); ++r) {
    // The first row is the ground's, which lamps don't light. Few lights have a place each, many are listed one after the other: lights_few.glsl,
    // lights_many.glsl.
    const bool body = r > 0;
    const size_t e = body ? r - 1 : 0;
    const Pose pose = body ? state.entities[e] : Pose{};
    const glm::dmat3 bodyFromLocal = glm::transpose(glm::mat3_cast(pose.orientation));
    glm::vec4* row = &lights[r * stride];
    auto add = [&](const glm::dvec3& place, double radius_m, size_t number, bool matters, double shadowReach2_m2, const glm::vec4& reach2_m2) {
      if (!few && !matters) return;
      const size_t k = few ? number : static_cast<size_t>(row->x);
      glm::vec4* entry = row + texels * k + 1;
      entry[0] = glm::vec4(place, radius_m);
      const auto casters = shadows_ && matters && body ? shadows_->castersOf(e, number) : ShadowPass::Range{};
      if (body && matters) {
        const Entity& entity = simulation_.entities[e];
        const bool lamp = number < simulation_.lights.size();
        const double farthest = kRoom * (glm::length(place - glm::dvec3(entity.boundingCentre)) + static_cast<double>(entity.boundingRadius_m));
        if (lamp && farthest * farthest < static_cast<double>(std::min(reach2_m2.x, reach2_m2.y))) lightNeeds_[e].sunAlone = false;
        lightNeeds_[e].lamps |= lamp;
        lightNeeds_[e].shadows |= casters.count > 0;
      }
      entry[1] = glm::vec4(matters ? static_cast<float>(number) : -1.0f, casters.first, casters.count, shadowReach2_m2);
      entry[2] = reach2_m2;
      if (number < simulation_.lights.size()) patterns_.put(number, state, pose.orientation, entry);
      row->x += 1.0f;
    };
    for (size_t l = 0; l < simulation_.lights.size(); ++l)
      add(bodyFromLocal * (state.lights[l] - pose.position), simulation_.lights[l].radius_m, l, body && ((truth_ && l == 0) || relevance_.matters(e, l, state)),
          body ? relevance_.shadowReach2_m2(e, l, state) : 0.0,
          body ? glm::vec4(relevance_.reach2_m2(e, l, state), relevance_.reach2_m2(e, l, state, true), 0.0, 0.0) : glm::vec4(0.0));
    if (simulation_.sun)
      add(bodyFromLocal * simulation_.sun->toSun, 0.0, simulation_.lights.size(), true, physics::kFar, glm::vec4(static_cast<float>(physics::kFar)));
  }
  lights_.upload(lights);
}

ScenePass::Targets& ScenePass::targetsFor(int width, int height) {
  for (auto& [size, t] : targets_)
    if (size == std::pair(width, height)) return t;
  std::vector<PixelFormat> colours(static_cast<size_t>(plan_.groupCount() + (truth_ ? 3 : 0)), PixelFormat::Rgba32f);
  targets_.emplace_back(std::pair(width, height),
                        Targets{RenderTarget(width, height, {PixelFormat::Rg32ui}, true), RenderTarget(width, height, colours, false)});
  // From the start, as what draws later shares one: llvmpipe would make what is drawn before that again.
  targets_.back().second.shading.shareDepth(targets_.back().second.visibility);
  return targets_.back().second;
}

void ScenePass::bindBuffers() const {
  scene_->bind();
  draws_.bindTexture(8, 4, true);
  solid_.bind();
  lights_.bindTexture(9, 4);
  if (air_) air_->bind();
  if (around_) around_->bind();
  if (isShaded()) sunShade_.bindTexture(28, 1);
  (wholePixels_ ? pixelView_ : view_).bindTexture(kViewUnit, 4);
  nodes_.bindUniform(1);
  if (shadows_) shadows_->bind();
}

void ScenePass::rehearse(const View& v, const WorldState& state, const std::vector<char>& drawn, FirstDraws& first) {
  rehearsal_ = &first;
  draw(v, state, drawn);
  rehearsal_ = nullptr;
}

void ScenePass::draw(const View& v, const WorldState& state, const std::vector<char>& drawn) {
  current_ = &targetsFor(v.width, v.height);
  if (const TimedPart part("air"); air_) air_->update(v, state);
  {
    const TimedPart part("draws");
    const GpuView data = viewData(simulation_, v, apertureArea_m2_);
    view_.upload(&data, sizeof data);
    std::vector<GpuDraw> draws;
    for (size_t d = 0; d < tables_.draws.size(); ++d) draws.push_back(drawOf(d, v, state));
    place(v, state, drawn, draws);
    draws_.upload(draws);
    bindBuffers();
  }
  {
    const TimedPart part("visibility");
    if (!warm_ && drawsMore()) solids_.warmUp(current_->visibility);
    solids_.draw(current_->visibility, v, state, drawn);
  }
  const TimedPart part("shading");
  findClassesIn(v, state, drawn);
  const auto shared = rehearsal_ ? std::optional<SharedPixels>() : shadeTogether(v);
  if (shared) pixelClasses_.findAgain(current_->visibility, shared->bends, v.grouped);
  else pixelClasses_.find(current_->visibility);
  if (shared) leaveOut(current_->visibility);
  current_->visibility.colour(0).bind(0);
  partial_ = v.onlyEntity >= 0;
  if (partial_) clearShading();
  shadedView_ = v;
  shade(current_->shading, current_->visibility);
  if (rehearsal_) return checkGl("rehearsing a frame");
  drawn_ = v;
  resolved_ = truthOf_ = nullptr;
  if (v.subpixels > 1) {
    const TimedPart resolving("resolve");
    const auto groups = static_cast<size_t>(plan_.groupCount());
    if (!resolve_) resolve_.emplace(library_, shared ? groups : current_->shading.colourCount(), groups);
    resolved_ = &resolve_->run(current_->shading, v, shared ? &*shared : nullptr);
    if (shared && truth_) truthOf_ = &shared->shaded;
  }
  checkGl("drawing a frame");
}

/// A pass over the film costs something where a class has no pixels, too.
void ScenePass::findClassesIn(const View& v, const WorldState& state, const std::vector<char>& drawn) {
  classesInView_ = {0};
  // Of the first picture of several all: a driver compiles what is left of a program when it is first used, and no later frame is to wait for that.
  for (size_t c = 1; !warm_ && drawsMore() && c < surfaceClasses_.size(); ++c) classesInView_.insert(c);
  warm_ = warm_ || !rehearsal_;
  for (const DrawItem& d : tables_.draws) {
    const auto add = [&](const LightNeeds& needs) {
      if (needs.sunAlone) classesInView_.insert(static_cast<size_t>(d.surfaceClass));
      if (needs.lamps) classesInView_.insert(static_cast<size_t>(d.unshadowed));
      if (needs.shadows) classesInView_.insert(static_cast<size_t>(d.everyLight));
    };
    if (d.kind == DrawKind::Ground) add({});
    if (d.kind != DrawKind::Solid) continue;
    const auto e = static_cast<size_t>(d.entity);
    const Pose& pose = state.entities[e];
    const Entity& entity = simulation_.entities[e];
    if (drawn[e] && state.isThere(e) && mayShow(v, pose.position + pose.orientation * glm::dvec3(entity.boundingCentre), entity.boundingRadius_m))
      add(lightNeeds_[e]);
  }
}

/// Pixels of several subpixels, each once; which of them need more. Null where each subpixel is shaded by itself.
std::optional<SharedPixels> ScenePass::shadeTogether(const View& v) {
  if (v.grouped < 2 || v.onlyEntity >= 0 || !sharesShading()) return {};
  const bool warms = !shared_ && drawsMore();  // everything is drawn once: no later picture is to wait for a compiler
  if (!shared_)
    shared_.emplace(library_, plan_.groupCount(), current_->shading.colourCount(), budget::kBends.of(plan_.accuracy > 0.0 ? plan_.accuracy : kUsualAccuracy),
                    plan_.textureAccuracy > 0.0, v.grouped, plan_.terms.layer.any || plan_.terms.media || plan_.terms.fields);
  View whole = v;
  whole.width /= v.grouped, whole.height /= v.grouped;
  whole.tanPerPixelX *= v.grouped, whole.tanPerPixelY *= v.grouped;
  whole.axisX /= v.grouped, whole.axisY /= v.grouped;
  Targets& pixels = targetsFor(whole.width, whole.height);
  shared_->findMiddles(current_->visibility, pixels.visibility);
  const GpuView data = viewData(simulation_, whole, apertureArea_m2_);
  pixelView_.upload(&data, sizeof data);
  wholePixels_ = true;
  pixelView_.bindTexture(kViewUnit, 4);
  pixelClasses_.findWithLight(pixels.visibility);
  pixels.visibility.colour(0).bind(0);
  partial_ = false;
  shadedView_ = whole;
  shade(pixels.shading, pixels.visibility);
  // What is averaged already bends as little as what is behind it.
  const RenderTarget* before = withoutTransparent();
  const bool averaged = before && transparentIsAveraged();
  shared_->findBends(current_->visibility, pixels.visibility, pixelClasses_.smoothness(), averaged ? *before : pixels.shading, averaged ? nullptr : before);
  if (v.subpixels != v.grouped) shared_->spread(pixels.shading, current_->shading, glm::ivec4(0));
  else if (v.kept.z > 0 || warms) shared_->spread(pixels.shading, current_->shading, v.kept);
  wholePixels_ = false;
  view_.bindTexture(kViewUnit, 4);
  return SharedPixels{pixels.shading, shared_->bends()};
}

void ScenePass::clearShading() {
  current_->shading.select(0, current_->shading.colourCount());
  current_->shading.bind();
  const GLfloat zero[4] = {0, 0, 0, 0};
  for (size_t i = 0; i < current_->shading.colourCount(); ++i) glClearBufferfv(GL_COLOR, static_cast<GLint>(i), zero);
}

/// A tile of a picture, and the numbers of what is drawn in it: pixels see places in this list.
struct ScenePass::Tile {
  const View* view = nullptr;
  glm::ivec4 part{0};  ///< lower left corner, size
  std::vector<std::uint32_t> draws;
  std::vector<SolidPass::Candidate> candidates;
  std::size_t firstDraw = 0;  ///< in the buffer
};

void ScenePass::drawTiles(const std::vector<View>& views, const WorldState& state, const std::vector<char>& drawn,
                          const std::function<void(std::size_t, const RawImage&)>& take) {
  const auto across = std::bit_floor(static_cast<unsigned>(std::max(kTilePicture_px / views.front().width, 1)));
  const size_t most = static_cast<size_t>(across) * across;
  for (size_t first = 0; first < views.size(); first += most) {
    const auto tiles = tilesOf(std::span(views).subspan(first, std::min(most, views.size() - first)), state, drawn);
    drawTilePicture(tiles, state);
    resolved_ = truthOf_ = nullptr;
    startReadback(true);
    const auto pixels = readback_.wait();
    for (size_t i = 0; i < tiles.size(); ++i) take(first + i, cut(pixels, tiles[i]));
  }
}

/// Side by side, in rows and columns of which there are powers of two: few sizes of picture are ever made.
std::vector<ScenePass::Tile> ScenePass::tilesOf(std::span<const View> views, const WorldState& state, const std::vector<char>& drawn) {
  const int size = views.front().width;
  int across = 1, rows = 1;
  while (across * rows < static_cast<int>(views.size())) (across > rows ? rows : across) *= 2;
  current_ = &targetsFor(across * size, rows * size);
  std::vector<Tile> tiles;
  std::vector<GpuDraw> draws;
  if (tileViews_.size() < views.size()) tileViews_.resize(views.size());
  for (size_t i = 0; i < views.size(); ++i) {
    Tile t;
    t.view = &views[i];
    t.part = {static_cast<int>(i) % across * size, static_cast<int>(i) / across * size, size, size};
    t.draws.push_back(0);
    if (tables_.ground >= 0) t.draws.push_back(static_cast<std::uint32_t>(tables_.ground));  // the second of all draws, and of a tile's
    t.candidates = solids_.candidatesIn(views[i], state, drawn);
    for (SolidPass::Candidate& c : t.candidates) {
      t.draws.push_back(c.draw);
      c.draw = static_cast<std::uint32_t>(t.draws.size()) - 1;
    }
    t.firstDraw = draws.size();
    for (std::uint32_t d : t.draws) draws.push_back(drawOf(d, views[i], state));
    GpuView block = viewData(simulation_, views[i], apertureArea_m2_, {t.part.x, t.part.y});
    block.depth.z = static_cast<float>(t.firstDraw);
    tileViews_[i].upload(&block, sizeof block);
    tiles.push_back(std::move(t));
  }
  tileDraws_.upload(draws);
  return tiles;
}

void ScenePass::bindTile(size_t i) const { tileViews_[i].bindTexture(kViewUnit, 4); }

void ScenePass::drawTilePicture(const std::vector<Tile>& tiles, const WorldState& state) {
  bindBuffers();
  tileDraws_.bindTexture(8, 4, true);
  {
    const TimedPart part("visibility");
    solids_.clear(current_->visibility);
    for (size_t i = 0; i < tiles.size(); ++i) {
      bindTile(i);
      solids_.drawPart(tiles[i].part, tiles[i].candidates);
    }
  }
  const TimedPart part("shading");
  pixelClasses_.begin(current_->visibility);
  for (size_t i = 0; i < tiles.size(); ++i) {
    bindTile(i);
    pixelClasses_.drawPart(tiles[i].part);
  }
  pixelClasses_.end();
  current_->visibility.colour(0).bind(0);
  clearShading();
  for (size_t i = 0; i < tiles.size(); ++i) {
    if (air_) {
      air_->update(*tiles[i].view, state);
      air_->bind();
    }
    bindTile(i);
    std::set<size_t> classes;
    for (std::uint32_t d : tiles[i].draws)
      if (tables_.draws[d].entity == tiles[i].view->onlyEntity)
        for (int c : {tables_.draws[d].surfaceClass, tables_.draws[d].unshadowed, tables_.draws[d].everyLight}) classes.insert(static_cast<size_t>(c));
    shadeTile(current_->shading, tiles[i].part, classes);
  }
  checkGl("drawing small bodies");
}

RawImage ScenePass::cut(const Readback::Pixels& picture, const Tile& t) const {
  RawImage image;
  image.width = t.part.z;
  image.height = t.part.w;
  const auto across = static_cast<size_t>(current_->shading.width()), width = static_cast<size_t>(t.part.z);
  const auto rows = [&](const auto& from, auto& to, size_t each) {
    for (int y = 0; y < t.part.w; ++y) {
      const auto begin = from.begin() + static_cast<long>(each * (static_cast<size_t>(t.part.y + y) * across + static_cast<size_t>(t.part.x)));
      to.insert(to.end(), begin, begin + static_cast<long>(each * width));
    }
  };
  std::vector<std::uint32_t> identity;
  rows(picture.identity, identity, 2);
  for (size_t i = 0; i < identity.size(); i += 2) image.entity.push_back(tables_.draws[t.draws[identity[i]]].entity);
  for (size_t i = 0; i < picture.colours.size(); ++i)
    rows(picture.colours[i], (i < static_cast<size_t>(plan_.groupCount()) ? image.groups : image.truth).emplace_back(), 4);
  return image;
}

void ScenePass::startReadback(bool identity) {
  const TimedPart part("readback");
  const auto groups = static_cast<size_t>(plan_.groupCount());
  const RenderTarget& picture = resolved_ ? *resolved_ : current_->shading;
  readback_.start(picture, picture.colourCount(), identity ? &current_->visibility : nullptr);
  if (truthOf_) truthReadback_.start(*truthOf_, groups, truthTargets().size(), {0, 0, picture.width(), picture.height()});
  if (resolved_ && drawn_.kept.z > 0) keptReadback_.start(current_->shading, 0, groups, drawn_.kept);
}

RawImage ScenePass::finishReadback() {
  const TimedPart part("readback");
  auto pixels = readback_.wait();
  RawImage image;
  image.width = (resolved_ ? *resolved_ : current_->shading).width();
  image.height = (resolved_ ? *resolved_ : current_->shading).height();
  if (resolved_) {
    image.subpixels = drawn_.subpixels;
    image.kept = drawn_.kept;
    if (drawn_.kept.z > 0) image.keptGroups = keptReadback_.wait().colours;
    if (truthOf_) image.truth = truthReadback_.wait().colours;
  }
  for (size_t i = 0; i < pixels.identity.size(); i += 2) image.entity.push_back(tables_.draws[pixels.identity[i]].entity);
  for (size_t i = 0; i < pixels.colours.size(); ++i)
    (i < static_cast<size_t>(plan_.groupCount()) ? image.groups : image.truth).push_back(std::move(pixels.colours[i]));
  return image;
}

}  // namespace pitviper
