#include "sim/render/media/seen_through.hpp"

#include <epoxy/gl.h>

#include <algorithm>

#include "sim/gl/timing.hpp"
#include "sim/render/assembly/node_loops.hpp"
#include "sim/render/geometry/transparent_draws.hpp"
#include "sim/render/surface/surface_slots.hpp"

namespace pitviper {
namespace {

using Kind = HitLists::Kind;

/// Entries that one draw takes: as sim/render/media/glsl/listed_place.glsl has places for them.
constexpr std::size_t kEntries = 1024 * 1024;
constexpr int kListSide = 1024;
/// What lets through and what it adds, of all lines that are worked out at a time [bytes].
constexpr std::size_t kMostBytes = std::size_t{192} << 20;
constexpr std::size_t kMostLines = 262144, kFewestLines = 4096;
constexpr std::size_t kGroup = 64;  // as in sim/render/media/glsl/seen_walk.comp.glsl
constexpr std::size_t kMostGoes = kGroup * 65535;  // of a dispatch, by the standard

}  // namespace

SeenThrough::SeenThrough(const Simulation& simulation, const Plan& plan, const RenderTables& tables, std::shared_ptr<const GpuScene> scene,
                         const ShaderLibrary& library, const ShaderSlots& slots, int targets)
    : simulation_(simulation), tables_(tables), scene_(std::move(scene)), targets_(targets), buffers_(tables.layer) {
  const std::string folder = "sim/render/media/glsl/", geometry = "sim/render/geometry/glsl/";
  ShaderSlots base = slots;
  for (const char* none : {"outputs", "integrate"}) base.generated[none] = "";
  base.files["truth"] = "sim/render/assembly/glsl/truth_none.glsl";
  base.files["ground"] = geometry + (simulation.ground ? "ground_hides.glsl" : "ground_none.glsl");
  base.files["ground_end"] = geometry + (simulation.ground ? "ground_end.glsl" : "ground_endless.glsl");
  base.constants["TARGETS"] = targets;
  const bool written = base.constants.at("WRITTEN_OUT") != 0;
  base.generated["targets"] = std::string("uniform int firstNode;\nint fourOf(int target) { return min(") + (written ? "" : "firstNode / 4 + ") + "target, " +
                              std::to_string((plan.nodeCount() - 1) / 4) + "); }\n";
  const auto ofLists = [&](const char* fragments, const ShaderSlots& own) {
    return Program(assembleShader(library, folder + "listed.vert.glsl", own), assembleShader(library, folder + fragments, own));
  };
  std::vector<Kind> kinds;
  if (const SurfaceTerms& t = plan.terms.layer; t.any) {
    kinds.push_back(Kind::Pane);
    ShaderSlots own = base;
    addSurfaceSlots(tables.layer, t, plan, own);
    own.files["surface"] = surfaceShader(tables.layer.general    ? "surface_general"
                                         : tables.layer.lit      ? "surface_simple"
                                         : t.emits || t.reflects ? "surface_unlit"
                                                                 : "surface_filter");
    own.files["transmission"] = surfaceShader(tables.layer.general ? "transmission_general" : "transmission_plain");
    const int nodes = written ? plan.nodeCount() : 0;
    own.generated["nodes"] = nodesText("through", targets, nodes, "throughAt(", false) + nodesText("own", targets, nodes, "ownAt(", false);
    pane_ = ofLists("seen_pane.frag.glsl", own);
  }
  if (plan.terms.media) {
    for (const Entity& e : simulation.entities)
      if (simulation.mediumOf(e)) kinds.push_back(e.form.kind == BodyForm::Kind::Mesh ? Kind::Border : Kind::Medium);
    segment_ = ofLists("seen_segment.frag.glsl", base);
    media_.upload(tables.media);
  }
  if (plan.terms.fields) {
    kinds.push_back(Kind::Field);
    fields_ = std::make_unique<FieldDraws>(simulation, plan, library, base);
  }
  hits_ = std::make_unique<HitLists>(library, base, kinds);
  lines_ = std::make_unique<OrderedLines>(library, base, static_cast<int>(tables.draws.size()));
  walk_ = Program(assembleShader(library, folder + "seen_walk.comp.glsl", base));
  entries_ = RenderTarget(kListSide, kListSide, {}, false);
}

std::vector<NamedProgram> SeenThrough::programs() const {
  std::vector<NamedProgram> all;
  hits_->addPrograms(all);
  all.push_back(lines_->program());
  for (const auto& [name, program] : {std::pair{"transparent surfaces", &pane_}, {"media", &segment_}, {"lines through what is transparent", &walk_}})
    if (!program->text().empty()) all.push_back({name, program->text()});
  if (fields_) fields_->addPrograms(all);
  return all;
}

void SeenThrough::updateTemperatures() {
  buffers_.update(tables_.layer);
  media_.upload(tables_.media);
}

void SeenThrough::place(const View& view, const WorldState& state, const std::vector<char>& drawn) {
  draws_ = transparentIn(tables_.draws, simulation_, view, state, drawn);
  if (fields_) fields_->place(view, state);
}

void SeenThrough::findHits(const Over& over) {
  if (const TimedPart part("lines of fields"); fields_) fields_->look(over.view);
  const TimedPart part("hits");
  hits_->find(over.visibility, [&] {
    for (size_t d : draws_) (tables_.draws[d].kind == DrawKind::Layer ? drawPane : drawMedium)(*hits_, *scene_, simulation_, tables_.draws[d], d);
    for (size_t f = 0; fields_ && f < fields_->count(); ++f) {
      if (!fields_->shows(f)) continue;
      const Program& program = hits_->use(Kind::Field);
      glUniform1i(program.uniform("drawIndex"), static_cast<int>(tables_.draws.size() + f));
      fields_->setTiles(f, program);
      const glm::ivec4 rect = glm::max(fields_->rectOf(f), glm::ivec4(0));
      glEnable(GL_SCISSOR_TEST);
      glScissor(rect.x, rect.y, rect.z, rect.w);
      glDrawArrays(GL_TRIANGLES, 0, 3);
      glDisable(GL_SCISSOR_TEST);
    }
  });
}

/// As many lines as there is memory for what they leave, from the first on.
void SeenThrough::order(std::size_t first, std::size_t count) {
  const TimedPart part("order");
  const std::size_t each = 2 * static_cast<std::size_t>(targets_) * sizeof(glm::vec4);
  for (;; count = std::max(count / 2, kFewestLines)) {
    lists_ = lines_->order(*hits_, first, count, fields_ ? fields_->entries() : std::vector<std::size_t>{}, [&](const Program& program) {
      if (fields_) fields_->setLines(program);
    });
    ordered_ = {first, count};
    if (lists_.passages() * each <= kMostBytes || count <= kFewestLines) break;
  }
  passages_.reserve(std::max<std::size_t>(lists_.passages(), 1) * each);
}

void SeenThrough::shade(const List& list, int firstNode) {
  const Program& program = list.program;
  glUniform1i(program.uniform("firstNode"), firstNode);
  glUniform1i(program.uniform("firstPassage"), static_cast<GLint>(list.firstPassage));
  std::size_t done = 0;
  do {
    const std::size_t now = std::min(list.count - done, kEntries);
    glUniform1i(program.uniform("listFirst"), static_cast<GLint>(list.first + done));
    glUniform1i(program.uniform("listCount"), static_cast<GLint>(now));
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(std::max<std::size_t>((now >> 8) + ((now & 255) + 15) / 16, 1)));
    done += now;
  } while (done < list.count);
}

/// What is bound and which program, for each list. `all`: of those without entries, too.
void SeenThrough::forLists(bool all, const std::function<void(const List&)>& visit) {
  if (lists_.panes > 0 || (all && !pane_.text().empty())) {
    buffers_.bind();
    lines_->bindPanes(18);
    visit({pane_, 0, lists_.panes, 0});
  }
  if (lists_.segments > 0 || (all && !segment_.text().empty())) {
    media_.bindTexture(5, 4);
    lines_->bindWords(17);
    lines_->bindSegments(18);
    visit({segment_, 0, lists_.segments, lists_.panes});
  }
  for (size_t f = 0; f < lists_.fieldEntries.size(); ++f)
    for (const bool even : {false, true}) {
      if (!all && (lists_.fieldEntries[f] == 0 || fields_->isEven(f) != even)) continue;
      fields_->bind(f);
      lines_->bindFieldEntries(18);
      lines_->bindWords(22);
      visit({fields_->program(f, even), lists_.fieldFirst[f], lists_.fieldEntries[f], lists_.panes + lists_.segments, f});
    }
}

void SeenThrough::addLists(const Over& over, bool all, FirstDraws& first) {
  passages_.bindImage(0);
  entries_.bind();
  over.visibility.colour(0).bind(0);
  glEnable(GL_PROGRAM_POINT_SIZE);
  forLists(all, [&](const List& list) { first.add(list.program, GL_POINTS); });
}

void SeenThrough::shadePassages(const Over& over, bool all) {
  FirstDraws first;
  addLists(over, all, first);
  first.make();
  forLists(all, [&](const List& list) {
    list.program.use();
    if (list.field) {
      fields_->setUniforms(*list.field, list.program);
      glUniform1i(list.program.uniform("drawIndex"), static_cast<int>(tables_.draws.size() + *list.field));
    }
    shade(list, over.firstNode);
  });
  glDisable(GL_PROGRAM_POINT_SIZE);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void SeenThrough::walk(const Over& over, std::size_t first, std::size_t count) {
  const TimedPart part("walk");
  walk_.use();
  lines_->bindSteps(18, 17, 23);  // 20 and 21 are the air's, for the lines after these
  hits_->bindLines(19);
  passages_.bindTexture(22, 4);
  if (fields_) fields_->setLines(walk_);
  glUniform3i(walk_.uniform("firstPassages"), 0, static_cast<GLint>(lists_.panes), static_cast<GLint>(lists_.panes + lists_.segments));
  sums_.reserve(std::max<std::size_t>(lists_.goes, 1) * static_cast<std::size_t>(targets_) * sizeof(glm::vec4));
  sums_.bindStorage(4);
  const auto dispatch = [&](bool adding, std::size_t from, std::size_t many) {
    glUniform1i(walk_.uniform("adding"), adding);
    glUniform1i(walk_.uniform("first"), static_cast<GLint>(from));
    glUniform1i(walk_.uniform("count"), static_cast<GLint>(many));
    glDispatchCompute(static_cast<GLuint>(std::max<std::size_t>((many + kGroup - 1) / kGroup, 1)), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  };
  for (int t = 0; t < targets_; ++t)
    glBindImageTexture(static_cast<GLuint>(t), over.spectrum.colour(static_cast<std::size_t>(t)).name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
  for (size_t g = 0; g == 0 || g < lists_.goes; g += kMostGoes) dispatch(false, g, std::min(lists_.goes - g, kMostGoes));
  if (lists_.goes > count) dispatch(true, first, count);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void SeenThrough::warmUp(const Over& over, FirstDraws* first) {
  const UnseenDraws unseen;
  if (fields_) fields_->reserve();
  hits_->find(over.visibility, [&] {
    for (size_t d = 0; d < tables_.draws.size(); ++d)
      if (tables_.draws[d].kind == DrawKind::Layer) drawPane(*hits_, *scene_, simulation_, tables_.draws[d], d);
      else if (tables_.draws[d].kind == DrawKind::Medium) drawMedium(*hits_, *scene_, simulation_, tables_.draws[d], d);
    for (size_t f = 0; fields_ && f < fields_->count(); ++f) {
      fields_->setTiles(f, hits_->use(Kind::Field));
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }
  });
  order(0, 0);
  if (first) {
    addLists(over, true, *first);
    glDisable(GL_PROGRAM_POINT_SIZE);
  } else {
    shadePassages(over, true);
    walk(over, 0, 0);
  }
  ordered_ = {0, 0};
}

void SeenThrough::run(const Over& over) {
  if (over.firstNode == 0) {
    findHits(over);
    ordered_ = {0, 0};
  }
  const std::size_t lines = hits_->lineCount();
  for (std::size_t first = 0; first < lines; first += ordered_.second) {
    // Of one lot only, later batches of nodes find it as the first one left it.
    if (ordered_ != std::pair(std::size_t{0}, lines)) order(first, std::min(lines - first, kMostLines));
    shadePassages(over, false);
    walk(over, first, ordered_.second);
  }
}

}  // namespace pitviper
