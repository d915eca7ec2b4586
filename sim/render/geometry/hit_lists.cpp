#include "sim/render/geometry/hit_lists.hpp"

#include <epoxy/gl.h>

#include <algorithm>

namespace pitviper {
namespace {

/// As in sim/render/geometry/glsl/hit_list.glsl.
enum Total : std::size_t { kHits, kLines, kTotals };

struct KindRow {
  const char *name, *vertices, *fragments;
};
/// In the order of HitLists::Kind.
constexpr KindRow kKinds[] = {{"hits of panes", "pane.vert.glsl", "hit_pane.frag.glsl"},
                              {"hits of media", "box.vert.glsl", "hit_medium.frag.glsl"},
                              {"borders of meshed media", "border.vert.glsl", "hit_border.frag.glsl"},
                              {"hits of fields", "full_screen.vert.glsl", "hit_field.frag.glsl"}};
const KindRow& rowOf(HitLists::Kind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

}  // namespace

HitLists::HitLists(const ShaderLibrary& library, const ShaderSlots& slots, const std::vector<Kind>& kinds) {
  const std::string folder = "sim/render/geometry/glsl/";
  for (Kind kind : kinds)
    if (!programs_.contains(kind))
      programs_[kind] = Program(assembleShader(library, folder + rowOf(kind).vertices, slots), assembleShader(library, folder + rowOf(kind).fragments, slots));
}

void HitLists::find(const RenderTarget& visibility, const std::function<void()>& draw) {
  const auto pixels = static_cast<std::size_t>(visibility.width()) * static_cast<std::size_t>(visibility.height());
  visibility_ = &visibility;
  const auto sized = [&](const RenderTarget& t) { return t.width() == visibility.width() && t.height() == visibility.height(); };
  auto target = std::find_if(targets_.begin(), targets_.end(), sized);
  if (target == targets_.end()) target = targets_.emplace(targets_.end(), visibility.width(), visibility.height(), std::vector<PixelFormat>{}, false);
  target->shareDepth(visibility);
  heads_.reserve(pixels * sizeof(std::uint32_t));
  lineList_.reserve(pixels * sizeof(std::uint32_t));
  room_ = std::max(room_, pixels);
  for (;;) {
    hits_.reserve(room_ * sizeof(glm::uvec4));
    links_.reserve(room_ * sizeof(glm::uvec4));
    heads_.fill(0);
    std::vector<std::uint32_t> totals(kTotals, 0);
    totals_.upload(totals);
    heads_.bindStorage(4);
    hits_.bindStorage(5);
    links_.bindStorage(6);
    lineList_.bindStorage(7);
    totals_.bindStorage(8);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    target->bind();
    glDepthMask(GL_FALSE);
    glDisable(GL_BLEND);
    draw();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CLIP_DISTANCE0);
    glDisable(GL_DEPTH_CLAMP);
    glDisable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glDepthRange(0.0, 1.0);
    glDepthMask(GL_TRUE);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    totals_.read(totals.data(), kTotals * sizeof(std::uint32_t));
    lines_ = totals[kLines];
    found_ = totals[kHits];
    if (found_ <= room_) return;
    room_ = roomFor(found_);
  }
}

const Program& HitLists::use(Kind kind) const {
  const Program& program = programs_.at(kind);
  program.use();
  visibility_->colour(0).bind(0);
  glUniform1i(program.uniform("filmWidth"), visibility_->width());
  glUniform1i(program.uniform("hitRoom"), static_cast<GLint>(room_));
  // In one state always: of a program's states llvmpipe finds only the first in its cache.
  glEnable(GL_DEPTH_TEST);
  if (kind == Kind::Pane) {
    glDepthFunc(GL_GEQUAL);
    glDepthRange(0.0, 1.0);
  } else {  // what is before and behind a solid is worked out by the program; depth only tells what is covered
    glDepthFunc(GL_NOTEQUAL);
    glDepthRange(1.0, 1.0);
  }
  // A medium begins at the camera, and the back of its box may lie anywhere.
  if (kind == Kind::Medium || kind == Kind::Field) glDisable(GL_CLIP_DISTANCE0);
  else glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_CLAMP);
  if (kind == Kind::Medium) glEnable(GL_CULL_FACE);
  else glDisable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  return program;
}

void HitLists::eachHit(const std::function<void(int, int, const glm::uvec4&)>& visit) const {
  std::vector<std::uint32_t> pixels(lines_), heads(static_cast<std::size_t>(visibility_->width()) * static_cast<std::size_t>(visibility_->height()));
  std::vector<glm::uvec4> hits(found_), links(found_);
  lineList_.read(pixels.data(), pixels.size() * sizeof(std::uint32_t));
  heads_.read(heads.data(), heads.size() * sizeof(std::uint32_t));
  hits_.read(hits.data(), hits.size() * sizeof(glm::uvec4));
  links_.read(links.data(), links.size() * sizeof(glm::uvec4));
  for (std::uint32_t pixel : pixels) {
    const std::uint32_t x = pixel & 0xffffu, y = pixel >> 16;
    for (std::uint32_t h = heads[static_cast<std::size_t>(y) * static_cast<std::size_t>(visibility_->width()) + x]; h != 0; h = links[h - 1].x)
      visit(static_cast<int>(x), static_cast<int>(y), hits[h - 1]);
  }
}

void HitLists::bind(unsigned heads, unsigned hits, unsigned lines, unsigned links) const {
  heads_.bindTexture(heads, 1, true);
  hits_.bindTexture(hits, 4, true);
  lineList_.bindTexture(lines, 1, true);
  links_.bindStorage(links);
}

void HitLists::addPrograms(std::vector<NamedProgram>& all) const {
  for (const auto& [kind, program] : programs_) all.push_back({rowOf(kind).name, program.text()});
}

}  // namespace pitviper
