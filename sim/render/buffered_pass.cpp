#include "sim/render/buffered_pass.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <sstream>

#include "sim/gl/context.hpp"
#include "sim/gl/timing.hpp"
#include "sim/render/assembly/node_loops.hpp"

namespace pitviper {
namespace {

/// RGBA draw buffers that OpenGL 4.5 promises; a driver with more is not asked for them: registers hold a batch at a time.
constexpr int kMostTargets = 8;

/// The spectral image of a batch of nodes: names, and the body that fills it. Which batch is a uniform, so that one program
/// serves all, unless there is one alone (`nodes`, else 0); nodes beyond the last repeat it and are not integrated.
std::vector<std::string> writeSpectrum(ShaderSlots& slots, int targets, int nodes) {
  std::ostringstream declared, body;
  declared << "uniform int firstNode;\nvoid clearTargets() {}\n";
  body << "void integrate() {\n" << nodesText("spectrum", targets, nodes, "nodeRadiance(", false) << "}\n";
  slots.generated["targets"] = declared.str();
  slots.generated["integrate"] = body.str();
  std::vector<std::string> names;
  for (int t = 0; t < targets; ++t) names.push_back("spectrum" + std::to_string(t));
  return names;
}

/// The integral over the same nodes: a multiply-add per node and group of channels that the node feeds; weights in that order.
ShaderSlots integration(const Plan& plan, int first, int count, std::vector<float>& weights) {
  ShaderSlots slots;
  std::ostringstream declared, body;
  for (int g = 0; g < plan.groupCount(); ++g) {
    declared << "layout(location = " << g << ") out vec4 channels" << g << ";\n";
    body << "  channels" << g << " = vec4(0.0);\n";
  }
  for (int t = 0; t < (count + 3) / 4; ++t) {
    declared << "layout(binding = " << 8 + t << ") uniform sampler2D spectrum" << t << ";\n";
    body << "  vec4 s" << t << " = texelFetch(spectrum" << t << ", ivec2(gl_FragCoord.xy), 0);\n";
  }
  for (int i = 0; i < count; ++i)
    for (int g = 0; g < plan.groupCount(); ++g) {
      float w[4];
      for (int k = 0; k < 4; ++k) {
        const size_t slot = static_cast<size_t>(4 * g + k);
        w[k] = slot < plan.weight.size() ? static_cast<float>(plan.weight[slot][static_cast<size_t>(first + i)]) : 0.0f;
      }
      if (std::all_of(w, w + 4, [](float x) { return x == 0.0f; })) continue;
      body << "  channels" << g << " += weight[" << weights.size() / 4 << "] * s" << i / 4 << "[" << i % 4 << "];\n";
      weights.insert(weights.end(), w, w + 4);
    }
  slots.generated["targets"] = declared.str();
  slots.generated["integrate"] = body.str();
  slots.constants["WEIGHTS"] = static_cast<long long>(weights.size() / 4);
  return slots;
}

}  // namespace

BufferedPass::BufferedPass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
                           double apertureArea_m2, bool classes)
    : ScenePass(simulation, plan, library, std::move(scene), truth, apertureArea_m2, Shading::Buffered, classes) {
  // As few batches as there can be, all alike: a batch costs what its targets do, filled or not.
  const int count = (plan.nodeCount() + 4 * kMostTargets - 1) / (4 * kMostTargets);
  const int perBatch = std::min(((plan.nodeCount() + count - 1) / count + 3) / 4 * 4, plan.nodeCount());
  targets_ = (perBatch + 3) / 4;
  const bool writtenOut = plan.nodeCount() == perBatch && tables().writtenOut;
  ShaderSlots slots = shadingSlots(writtenOut);
  slots.generated["weights"] = "";  // shading itself integrates nothing
  slots.files["truth"] = "sim/render/assembly/glsl/truth_none.glsl";
  const auto spectrum = writeSpectrum(slots, targets_, writtenOut ? plan.nodeCount() : 0);
  shade_ = ClassPrograms(library, slots, tables(), surfaceClasses(), spectrum);
  for (int first = 0; first < plan.nodeCount(); first += perBatch) {
    Batch batch;
    batch.firstNode = first;
    std::vector<float> weights;
    const ShaderSlots integral = integration(plan, first, std::min(perBatch, plan.nodeCount() - first), weights);
    checkUniformSize(weights.size() * sizeof(float), "the channels' spectral weights");
    batch.integrate = Program(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", integral),
                              assembleShader(library, "sim/render/glsl/integrate.frag.glsl", integral));
    batch.weights.upload(weights);
    batches_.push_back(std::move(batch));
  }
  if (plan.terms.layer.any || plan.terms.media || plan.terms.fields)
    transparent_ = std::make_unique<SeenThrough>(simulation, plan, tables(), sharedScene(), library, slots, targets_);
  if (!truth) return;
  slots.files["truth"] = "sim/render/assembly/glsl/truth_layers.glsl";
  slots.generated["targets"] = "void clearTargets() {}\n";
  slots.generated["integrate"] = "void integrate() {}\n";
  truth_ = ShadingProgram(library, slots, truthTargets(), static_cast<size_t>(plan.groupCount()));
}

std::vector<NamedProgram> BufferedPass::programs() const {
  auto all = ScenePass::programs();
  shade_.addTo(all);
  if (hasTruth()) all.push_back({"truth", truth_.text()});
  if (transparent_)
    for (NamedProgram& p : transparent_->programs()) all.push_back(std::move(p));
  for (const Batch& b : batches_) all.push_back({"integration", b.integrate.text()});
  return all;
}

RenderTarget& BufferedPass::spectrumFor(const RenderTarget& visibility) {
  for (auto& t : spectra_)
    if (t.width() == visibility.width() && t.height() == visibility.height()) return t;
  RenderTarget& made =
      spectra_.emplace_back(visibility.width(), visibility.height(), std::vector<PixelFormat>(static_cast<size_t>(targets_), PixelFormat::Rgba32f), false);
  return made;
}

void BufferedPass::onTemperatures() {
  if (transparent_) transparent_->updateTemperatures();
}

void BufferedPass::leaveOut(RenderTarget& visibility) {
  if (drawsOver()) return pixelClasses().cover(visibility);
  if (!transparent_ || covers_ || !drawsMore()) return;
  covers_ = true;
  const UnseenDraws unseen;
  pixelClasses().cover(visibility);
}

void BufferedPass::place(const View& view, const WorldState& state, const std::vector<char>& drawn, std::vector<GpuDraw>& draws) {
  if (!transparent_) return;
  transparent_->place(view, state, drawn);
  transparent_->addDraws(draws);
}

void BufferedPass::integrate(const Batch& batch, RenderTarget& into, const RenderTarget& spectrum, bool adds) const {
  const TimedPart part("integration");
  into.select(0, static_cast<size_t>(plan().groupCount()));
  const ChosenPixels chosen = pixelClasses().all();
  into.shareDepth(chosen.classes);
  into.bind();
  for (size_t t = 0; t < spectrum.colourCount(); ++t) spectrum.colour(t).bind(static_cast<unsigned>(8 + t));
  batch.weights.bindUniform(2);
  if (adds) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
  }
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  batch.integrate.use();
  glUniform1f(batch.integrate.uniform("classDepth"), chosen.depth);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
}

void BufferedPass::shade(RenderTarget& into, const RenderTarget& visibility) {
  RenderTarget& spectrum = spectrumFor(visibility);
  if (rehearsal()) {
    shade_.addTo(*rehearsal(), spectrum, pixelClasses(), classesInView());
    if (transparent_) transparent_->warmUp({.spectrum = spectrum, .visibility = visibility, .firstNode = 0, .view = view()}, rehearsal());
    return;
  }
  const size_t groups = static_cast<size_t>(plan().groupCount());
  for (size_t b = 0; b < batches_.size(); ++b) {
    if (isPartial()) {  // what a zoomed view leaves out must not keep the last picture's spectrum
      spectrum.bind();
      const GLfloat zero[4] = {0, 0, 0, 0};
      for (size_t t = 0; t < spectrum.colourCount(); ++t) glClearBufferfv(GL_COLOR, static_cast<GLint>(t), zero);
    }
    shade_.run(spectrum, pixelClasses(), classesInView(), [&](const ShadingProgram& p) { glUniform1i(p.uniform("firstNode"), batches_[b].firstNode); });
    if (transparent_ && !warm_ && drawsMore()) {  // something transparent may come into view
      warm_ = true;
      transparent_->warmUp({.spectrum = spectrum, .visibility = visibility, .firstNode = 0, .view = view()});
      bindBuffers();
      visibility.colour(0).bind(0);
    }
    if (drawsOver()) {
      if (isOfWholePixels()) {
        if (!before_ || before_->width() != into.width() || before_->height() != into.height())
          before_.emplace(into.width(), into.height(), std::vector<PixelFormat>(groups, PixelFormat::Rgba32f), false);
        integrate(batches_[b], *before_, spectrum, b > 0);
      }
      const TimedPart part("transparent");
      transparent_->run({.spectrum = spectrum, .visibility = visibility, .firstNode = batches_[b].firstNode, .view = view()});
      bindBuffers();
      visibility.colour(0).bind(0);
    }

    integrate(batches_[b], into, spectrum, b > 0);
  }
  if (hasTruth()) truth_.run(into, pixelClasses().all());
}

}  // namespace pitviper
