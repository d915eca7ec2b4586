#include "sim/render/direct_pass.hpp"

#include "sim/render/buffered_pass.hpp"

namespace pitviper {
namespace {

/// Unit of its weights.
constexpr int kWeights = 25;

}  // namespace

DirectPass::DirectPass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
                       double apertureArea_m2, bool classes)
    : ScenePass(simulation, plan, library, std::move(scene), truth, apertureArea_m2, Shading::Direct, classes) {
  ShaderSlots slots = shadingSlots(tables().writtenOut);
  slots.files["truth"] = truth ? "sim/render/assembly/glsl/truth_layers.glsl" : "sim/render/assembly/glsl/truth_none.glsl";
  slots.generated["targets"] = tables().targetsText;
  std::string integral = tables().integrateText;
  if (air() && air()->givesChannels()) {
    std::string own;
    for (int g = 0; g < plan.groupCount(); ++g) own += "  channels" + std::to_string(g) + " += channelAir(" + std::to_string(g) + ", air_);\n";
    integral.insert(integral.rfind('}'), own);
  }
  slots.generated["integrate"] = integral;
  slots.generated["weights"] = planNumbers("weights", kWeights);
  auto targets = channelTargets();
  if (truth)
    for (const auto& name : truthTargets()) targets.push_back(name);
  programs_ = ClassPrograms(library, slots, tables(), surfaceClasses(), targets);
  weights_.upload(tables().weights);
}

std::vector<NamedProgram> DirectPass::programs() const {
  auto all = ScenePass::programs();
  programs_.addTo(all);
  return all;
}

void DirectPass::shade(RenderTarget& into, const RenderTarget&) {
  weights_.bindTexture(kWeights, 4);
  if (rehearsal()) programs_.addTo(*rehearsal(), into, pixelClasses(), classesInView());
  else programs_.run(into, pixelClasses(), classesInView());
}

void DirectPass::shadeTile(RenderTarget& into, const glm::ivec4& part, const std::set<std::size_t>& classes) {
  weights_.bindTexture(kWeights, 4);
  programs_.run(into, pixelClasses(), classes, part);
}

std::unique_ptr<ScenePass> makeScenePass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene,
                                         bool truth, double apertureArea_m2, bool classes) {
  if (simulation.mode == RenderMode::Buffered || simulation.hasTransparent())
    return std::make_unique<BufferedPass>(simulation, plan, library, std::move(scene), truth, apertureArea_m2, classes);
  return std::make_unique<DirectPass>(simulation, plan, library, std::move(scene), truth, apertureArea_m2, classes);
}

}  // namespace pitviper
