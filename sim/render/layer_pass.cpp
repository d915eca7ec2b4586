#include "sim/render/layer_pass.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "sim/gl/context.hpp"
#include "sim/render/media_groups.hpp"
#include "sim/render/node_loops.hpp"

namespace pitviper {
namespace {

/// The spectral image below, a texture each from here on.
constexpr int kUnderUnit = 22;

Pose poseOf(const WorldState& state, int entity) { return state.entities[static_cast<size_t>(entity)]; }

/// With fewer levels of surfaces than this, waiting before each costs less than shading what depth hides.
constexpr std::size_t kFewLevels = 64;

/// What is drawn in few runs (a medium is one by itself) is better read as a texture: drivers without a GPU shade every pixel where the target is fetched,
/// hidden or not, and else those alone that pass.
BlendPath pathOfFew(BlendPath path) {
  const auto offered = offeredBlendPaths();
  const char* wish = std::getenv("PITVIPER_BLEND");
  const bool free = isSoftware() && (!wish || !*wish) && std::find(offered.begin(), offered.end(), BlendPath::TextureBarrier) != offered.end();
  return free ? BlendPath::TextureBarrier : path;
}

/// The spectral image, in and out by framebuffer fetch, or read as a texture; its nodes blended one by one, or four by four.
void addBlend(ShaderSlots& slots, BlendPath path, int targets, int nodes, bool byFour) {
  std::ostringstream declared, blend;
  declared << "uniform int firstNode;\n";
  const bool fetch = path == BlendPath::FramebufferFetch, written = slots.constants.at("WRITTEN_OUT") != 0;
  if (fetch) slots.extensions.emplace_back("GL_EXT_shader_framebuffer_fetch");
  blend << "void blend() {\n";
  for (int t = 0; t < targets; ++t) {
    const std::string n = std::to_string(t);
    declared << "layout(location = " << n << ") " << (fetch ? "inout" : "out") << " vec4 spectrum" << n << ";\n";
    if (!fetch) declared << "layout(binding = " << kUnderUnit + t << ") uniform sampler2D under" << n << ";\n";
    blend << "  vec4 u" << n << " = " << (fetch ? "spectrum" + n : "texelFetch(under" + n + ", ivec2(gl_FragCoord.xy), 0)") << ";\n";
  }
  blend << "  for (int k = 0; k < layersHere(); ++k) {\n    prepareLayer(k);\n";
  for (int t = 0; t < targets && byFour; ++t) {
    const std::string four = written ? std::to_string(std::min(t, (nodes - 1) / 4)) : "min(firstNode / 4 + " + std::to_string(t) + ", (NODES - 1) / 4)";
    blend << "    u" << t << " = blendedFour(u" << t << ", " << four << ");\n";
  }
  if (!byFour) blend << nodesText("u", targets, written ? nodes : 0, "blended(", true);
  blend << "  }\n";
  for (int t = 0; t < targets; ++t) blend << "  spectrum" << t << " = u" << t << ";\n";
  blend << "}\n";
  slots.generated["targets"] = declared.str();
  slots.generated["blend"] = blend.str();
}

/// The spectral image as programs of fields name it, four nodes of each target.
void addTargets(ShaderSlots& slots, BlendPath path, int targets, int nodes) {
  std::ostringstream declared;
  declared << "uniform int firstNode;\n";
  const bool fetch = path == BlendPath::FramebufferFetch, written = slots.constants.at("WRITTEN_OUT") != 0;
  if (fetch) slots.extensions.emplace_back("GL_EXT_shader_framebuffer_fetch");
  for (int t = 0; t < targets; ++t) {
    const std::string n = std::to_string(t);
    declared << "layout(location = " << n << ") " << (fetch ? "inout" : "out") << " vec4 spectrum" << n << ";\n";
    if (!fetch) declared << "layout(binding = " << kUnderUnit + t << ") uniform sampler2D under" << n << ";\n";
    declared << "vec4 spectrumBelow" << n << "() { return " << (fetch ? "spectrum" + n : "texelFetch(under" + n + ", ivec2(gl_FragCoord.xy), 0)") << "; }\n";
  }
  declared << "int fourOf(int target) { return min(" << (written ? "" : "firstNode / 4 + ") << "target, " << (nodes - 1) / 4 << "); }\n";
  slots.generated["targets"] = declared.str();
  slots.constants["TARGETS"] = targets;
}

}  // namespace

LayerPass::LayerPass(const Simulation& simulation, const Plan& plan, const RenderTables& tables, std::shared_ptr<const GpuScene> scene,
                     const ShaderLibrary& library, const ShaderSlots& slots, int targets)
    : simulation_(simulation),
      tables_(tables),
      scene_(std::move(scene)),
      path_(chooseBlendPath()),
      fewPath_(pathOfFew(path_)),
      surfacePath_(path_),
      buffers_(tables.layer) {
  ShaderSlots base = slots;
  base.generated["outputs"] = "";
  base.generated["integrate"] = "";
  base.files["truth"] = "sim/render/glsl/truth_none.glsl";
  base.files["ground"] = simulation.ground ? "sim/render/glsl/ground_hides.glsl" : "sim/render/glsl/ground_none.glsl";
  base.files["ground_end"] = simulation.ground ? "sim/render/glsl/ground_end.glsl" : "sim/render/glsl/ground_endless.glsl";

  const SurfaceTerms& t = plan.terms.layer;
  if (t.any) {
    ShaderSlots own = base;
    const std::string folder = "sim/render/glsl/";
    addSurfaceSlots(tables.layer, t, plan, own);
    own.files["surface"] = folder + (tables.layer.general    ? "surface_general.glsl"
                                     : tables.layer.lit      ? "surface_simple.glsl"
                                     : t.emits || t.reflects ? "surface_unlit.glsl"
                                                             : "surface_filter.glsl");
    own.files["transmission"] = folder + (tables.layer.general ? "transmission_general.glsl" : "transmission_plain.glsl");
    const auto programOf = [&](BlendPath path) {
      ShaderSlots with = own;
      addBlend(with, path, targets, plan.nodeCount(), false);
      return Program(assembleShader(library, folder + "layer.vert.glsl", with), assembleShader(library, folder + "layer.frag.glsl", with));
    };
    layer_ = programOf(path_);
    if (fewPath_ != path_) fewLayers_ = programOf(fewPath_);
  }
  if (plan.terms.fields) {
    ShaderSlots own = base;
    addTargets(own, fewPath_, targets, plan.nodeCount());
    fields_ = std::make_unique<FieldDraws>(simulation, plan, library, own);
  }
  if (plan.terms.media) {
    addBlend(base, fewPath_, targets, plan.nodeCount(), true);
    volume_ = Program(assembleShader(library, "sim/render/glsl/box.vert.glsl", base), assembleShader(library, "sim/render/glsl/volume.frag.glsl", base));
    int formed = 0, meshed = 0;
    for (const Entity& e : simulation.entities)
      if (simulation.mediumOf(e)) ++(e.form.kind == BodyForm::Kind::Mesh ? meshed : formed);
    if (formed > 1) {  // joinMedia() may find them in each other
      ShaderSlots several = base;
      several.constants["GROUP"] = kMostMembers;
      group_ = Program(assembleShader(library, "sim/render/glsl/box.vert.glsl", several),
                       assembleShader(library, "sim/render/glsl/volume_group.frag.glsl", several));
    }
    if (meshed > 0)
      thickness_ =
          Program(assembleShader(library, "sim/render/glsl/thickness.vert.glsl", base), assembleShader(library, "sim/render/glsl/thickness.frag.glsl", base));
    media_.upload(tables.media);
  }
}

std::vector<NamedProgram> LayerPass::programs() const {
  std::vector<NamedProgram> all;
  for (const auto& [name, program] : {std::pair{"transparent surfaces", &layer_},
                                      {"few transparent surfaces", &fewLayers_},
                                      {"media", &volume_},
                                      {"media in each other", &group_},
                                      {"thickness of media", &thickness_}})
    if (!program->text().empty()) all.push_back({name, program->text()});
  if (fields_) fields_->addPrograms(all);
  return all;
}

void LayerPass::updateTemperatures() {
  buffers_.update(tables_.layer);
  media_.upload(tables_.media);
}

void LayerPass::order(const View& view, const WorldState& state, const std::vector<char>& drawn) {
  pieces_.clear();
  const glm::dmat3 cameraFromLocal = glm::transpose(view.localFromCamera);
  for (size_t d = 1; d < tables_.draws.size(); ++d) {
    const DrawItem& item = tables_.draws[d];
    const auto e = static_cast<size_t>(item.entity);
    if ((item.kind != DrawKind::Layer && item.kind != DrawKind::Medium) || !drawn[e] || !state.isThere(e)) continue;
    const Entity& entity = simulation_.entities[e];
    const Pose pose = poseOf(state, item.entity);
    if (!mayShow(view, pose.position + pose.orientation * glm::dvec3(entity.boundingCentre), entity.boundingRadius_m)) continue;
    LayerPiece piece;
    piece.draw = static_cast<std::uint32_t>(d);
    piece.origin = cameraFromLocal * (pose.position - view.position);
    piece.cameraFromBody = cameraFromLocal * glm::mat3_cast(pose.orientation);
    if (item.kind == DrawKind::Medium) {
      piece.medium = true;
      piece.low = scene_->box(item.entity).low;
      piece.high = scene_->box(item.entity).high;
      piece.form = entity.form;
      pieces_.push_back(piece);
      continue;
    }
    const Mesh& mesh = *entity.mesh;
    const MeshPart& part = mesh.parts[entity.surfaces[static_cast<size_t>(item.surface)].meshPart];
    for (std::uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangleCount; ++t) {
      piece.triangle = scene_->firstTriangle(item.entity) + t;
      for (int k = 0; k < 3; ++k) piece.corner[k] = piece.origin + piece.cameraFromBody * glm::dvec3(mesh.positions[mesh.triangles[t][k]]);
      pieces_.push_back(piece);
    }
  }
  joinMedia(pieces_, groups_);
  if (fields_) fields_->place(view, state, pieces_);
  order_ = orderLayers(view, pieces_);
  if (!order_.pieces.empty()) {
    if (!faults_) faults_.emplace();
    faults_->add(order_);
  }

  surfacePath_ = order_.levels.size() <= kFewLevels ? fewPath_ : path_;
  // Where the target is read in order of drawing, only the change between surfaces and media cuts a run; elsewhere each level does.
  runs_.clear();
  std::vector<glm::uvec2> sorted;
  for (size_t level = 0; level + 1 < order_.levels.size(); ++level)
    for (std::uint32_t i = order_.levels[level]; i < order_.levels[level + 1]; ++i) {
      const LayerPiece& piece = pieces_[order_.pieces[i]];
      sorted.emplace_back(piece.draw, piece.triangle);
      const bool fresh = runs_.empty() || runs_.back().medium || piece.medium || (surfacePath_ != BlendPath::FramebufferFetch && i == order_.levels[level]);
      if (fresh) runs_.push_back({piece.medium, i, 0});
      ++runs_.back().count;
    }
  sorted_.upload(sorted);
}

RenderTarget& LayerPass::sizedLike(std::deque<RenderTarget>& pool, const RenderTarget& target, std::size_t colours, bool depth) const {
  for (auto& t : pool)
    if (t.width() == target.width() && t.height() == target.height()) return t;
  return pool.emplace_back(target.width(), target.height(), std::vector<PixelFormat>(colours, PixelFormat::Rgba32f), depth);
}

void LayerPass::blend(const Over& over) {
  if (isEmpty()) return;
  if (fields_ && over.firstNode == 0) fields_->look(over.view);
  for (const Run& run : runs_) {
    const LayerPiece& first = pieces_[order_.pieces[run.first]];
    if (run.medium && first.field < 0 && first.group < 0 &&
        simulation_.entities[static_cast<size_t>(tables_.draws[first.draw].entity)].form.kind == BodyForm::Kind::Mesh)
      drawThickness(first, over);
    const BlendPath path = run.medium ? fewPath_ : surfacePath_;
    RenderTarget* copy = path == BlendPath::PingPong ? &sizedLike(copies_, over.spectrum, over.spectrum.colourCount()) : nullptr;
    if (copy) copy->copyFrom(over.spectrum);
    over.spectrum.bind();
    const RenderTarget& under = copy ? *copy : over.spectrum;
    if (path != BlendPath::FramebufferFetch)
      for (size_t t = 0; t < under.colourCount(); ++t) under.colour(t).bind(static_cast<unsigned>(kUnderUnit + t));
    if (path == BlendPath::TextureBarrier) glTextureBarrier();
    if (first.field >= 0) {
      drawField(first, over);
      continue;
    }
    const Program& program = !run.medium ? (surfacePath_ == path_ ? layer_ : fewLayers_) : first.group >= 0 ? group_ : volume_;
    program.use();
    glUniform1i(program.uniform("firstNode"), over.firstNode);
    if (run.medium) drawMedium(first, over);
    else drawLayers(run, over);
  }
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
}

void LayerPass::drawLayers(const Run& run, const Over& over) {
  buffers_.bind();
  over.visibility.colour(0).bind(0);
  sorted_.bindStorage(3);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_CLAMP);
  glDisable(GL_CULL_FACE);
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * run.first), static_cast<GLsizei>(3 * run.count));
}

namespace {

void setMedium(const Program& program, const LayerPiece& piece) { glUniform1i(program.uniform("drawIndex"), static_cast<int>(piece.draw)); }

}  // namespace

/// What is before and behind a solid is worked out by the shader; depth only tells what is covered.
void LayerPass::beginMedium(bool covered) const {
  if (covered) {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_NOTEQUAL);
    glDepthRange(1.0, 1.0);
  } else {
    glDisable(GL_DEPTH_TEST);
  }
  glDisable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_CLAMP);  // the back of the box may lie anywhere
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
}

/// Pixels that one box has worked out are left alone by the others: marked as covered in a depth of the group's own.
void LayerPass::beginGroup(const Over& over) {
  RenderTarget& own = sizedLike(groupDepths_, over.spectrum, 0, true);
  own.bind();
  glDepthMask(GL_TRUE);
  glClearDepth(0.0);
  glClear(GL_DEPTH_BUFFER_BIT);
  if (over.covered) over.covered->cover(own);
  over.spectrum.shareDepth(own);
  over.spectrum.bind();
}

void LayerPass::setGroup(const std::vector<std::uint32_t>& draws) const {
  std::vector<GLint> forms, rows, numbers;
  std::vector<glm::vec3> sizes;
  for (std::uint32_t d : draws) {
    const BodyForm& form = simulation_.entities[static_cast<size_t>(tables_.draws[d].entity)].form;
    numbers.push_back(static_cast<GLint>(d));
    forms.push_back(static_cast<GLint>(form.kind));
    rows.push_back(static_cast<GLint>(tables_.draws[d].row));
    sizes.emplace_back(form.size);
  }
  const auto n = static_cast<GLsizei>(draws.size());
  glUniform1i(group_.uniform("count"), n);
  glUniform1iv(group_.uniform("memberDraw"), n, numbers.data());
  glUniform1iv(group_.uniform("memberForm"), n, forms.data());
  glUniform1iv(group_.uniform("memberRow"), n, rows.data());
  glUniform3fv(group_.uniform("memberSize"), n, &sizes[0].x);
}

void LayerPass::drawField(const LayerPiece& piece, const Over& over) {
  const Program& program = fields_->use(piece.field, over.covered != nullptr);
  over.visibility.colour(0).bind(0);
  glUniform1i(program.uniform("firstNode"), over.firstNode);
  beginMedium(over.covered != nullptr);
  glDisable(GL_CULL_FACE);
  const glm::ivec4 rect = glm::max(fields_->rectOf(piece.field), glm::ivec4(0));
  glEnable(GL_SCISSOR_TEST);
  glScissor(rect.x, rect.y, rect.z, rect.w);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_SCISSOR_TEST);
  glCullFace(GL_BACK);
  glDepthRange(0.0, 1.0);
}

void LayerPass::drawMedium(const LayerPiece& piece, const Over& over) {
  const DrawItem& item = tables_.draws[piece.draw];
  const BodyForm& form = simulation_.entities[static_cast<size_t>(item.entity)].form;
  const Program& program = piece.group >= 0 ? group_ : volume_;
  media_.bindTexture(5, 4);
  over.visibility.colour(0).bind(0);
  if (piece.group >= 0) beginGroup(over);
  program.use();
  setMedium(program, piece);
  beginMedium(over.covered || piece.group >= 0);
  auto drawBox = [&](const glm::vec3& low, const glm::vec3& high) {
    glUniform3f(program.uniform("low"), low.x, low.y, low.z);
    glUniform3f(program.uniform("high"), high.x, high.y, high.z);
    glDrawArrays(GL_TRIANGLES, 0, 36);
  };
  if (piece.group >= 0) {
    const auto& draws = groups_[static_cast<size_t>(piece.group)];
    setGroup(draws);
    glDepthMask(GL_TRUE);
    for (size_t k = 0; k < draws.size(); ++k) {
      // A ray that meets a member must find its box, whatever the rasteriser's steps (1/256 of a pixel).
      const BodyBox& box = scene_->box(tables_.draws[draws[k]].entity);
      const glm::dvec3 margin = 0.01 * (box.high - box.low);
      glUniform1i(program.uniform("drawIndex"), static_cast<int>(draws[k]));
      drawBox(box.low - margin, box.high + margin);
    }
    over.spectrum.shareDepth(over.visibility);
  } else {
    const glm::vec3 size(form.size);
    glUniform3f(program.uniform("formSize"), size.x, size.y, size.z);
    glUniform1i(program.uniform("form"), static_cast<int>(form.kind));
    glUniform1i(program.uniform("mediumRow"), static_cast<int>(item.row));
    drawBox(piece.low, piece.high);
  }
  glCullFace(GL_BACK);
  glDepthRange(0.0, 1.0);
}

void LayerPass::drawThickness(const LayerPiece& piece, const Over& over) {
  const DrawItem& item = tables_.draws[piece.draw];
  const Mesh& mesh = *simulation_.entities[static_cast<size_t>(item.entity)].mesh;
  RenderTarget& target = sizedLike(thicknesses_, over.spectrum, 2);
  target.bind();
  const GLfloat zero[4] = {0, 0, 0, 0}, nothing[4] = {-1e30f, -1e30f, 0, 0};
  glClearBufferfv(GL_COLOR, 0, zero);
  glClearBufferfv(GL_COLOR, 1, nothing);
  over.visibility.colour(0).bind(0);
  thickness_.use();
  setMedium(thickness_, piece);
  const std::uint32_t first = scene_->firstTriangle(item.entity);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquationi(0, GL_FUNC_ADD);
  glBlendEquationi(1, GL_MAX);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.triangles.size() * 3), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * 12));
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  target.colour(0).bind(17);
  target.colour(1).bind(19);
}

}  // namespace pitviper
