#include "scenarios/view/viewed_scene.hpp"

#include "atmosphere/homogeneous.hpp"
#include "sim/run/camera_drawing.hpp"

namespace pitviper {
namespace {

/// Of a reference, which is never drawn live.
constexpr double kInPlaceOfReference = 0.01;
/// From where on what is as warm as the air is seen to glow at all.
constexpr double kGlow_um = 2.5;
/// Wavelengths of a sketch's channels.
constexpr int kSketchSamples = 3;

std::shared_ptr<ViewedScene> copyOf(const ViewedScene& scene) { return std::make_shared<ViewedScene>(scene); }

}  // namespace

ViewedScenePointer readScene(const ScenarioWish& wish) {
  auto scene = std::make_shared<ViewedScene>(ViewedScene{wish.read(), {}, std::make_shared<const int>(0)});
  for (Camera& c : scene->simulation.cameras) {
    c.truth.range = c.truth.entity = c.truth.temperature = true;
    c.truth.targets = c.truth.terms = false;
    c.spectralImage.reset();
    for (const ChannelOutput& o : c.outputs)
      if (o.unit == "W/(m2 sr)" && !o.perEtendue && !o.perExposure && !o.detected && o.bandHigh_um > kGlow_um)
        scene->temperatures[temperatureKey(c.name, o.layer())] = std::make_shared<const BandTemperature>(o.kernel * o.scale, o.bandLow_um, o.bandHigh_um);
    if (c.spectral.reference) c.spectral = {}, c.spectral.accuracy = kInPlaceOfReference;
  }
  return scene;
}

std::string temperatureKey(const std::string& camera, const std::string& layer) { return camera + "/" + layer; }

ViewedScenePointer withAccuracy(const ViewedScene& scene, double accuracy) {
  auto other = copyOf(scene);
  for (Camera& c : other->simulation.cameras) c = withAccuracy(c, accuracy);
  return other;
}

ViewedScenePointer withMaterial(const ViewedScene& scene, std::size_t number, std::shared_ptr<const Material> material) {
  auto other = copyOf(scene);
  // What light passes throws other shadows: nothing that was found of the bodies holds.
  if (material->isTransparent() != scene.simulation.materials.at(number)->isTransparent()) other->geometry = std::make_shared<const int>(0);
  other->simulation.materials[number] = std::move(material);
  return other;
}

ViewedScenePointer sketchOf(const ViewedScene& scene) {
  auto other = copyOf(scene);
  Simulation& s = other->simulation;
  s.air = makeNoAir();
  s.ambient.reset();
  s.surroundings.reset();
  s.sunShade.reset();
  s.lights.clear();
  s.fields.clear();
  s.stars.clear();
  s.stores.clear();
  s.commands.clear();
  s.background = Spectrum(0.0);
  s.alone = true;
  s.shadows = false;
  for (Camera& c : s.cameras) {
    c.spectral = {};
    c.spectral.samples = kSketchSamples;
    c.samples = 1;
    c.smallBody_px = 0.0;
    c.outlineAccuracy = c.textureAccuracy = 0.0;
    c.motionBlur = false;
    c.sharesShading = false;
    c.follower.reset();
    c.stages.clear();
    c.ownChannels.clear();
    c.learnt.clear();
    c.plan.clear();
    if (c.mount.lookAtLight >= 0) c.mount.lookAtLight = -1;
  }
  return other;
}

int materialAt(const Simulation& sim, int entity, int surface) {
  if (entity < 0 || entity >= static_cast<int>(sim.entities.size())) return -1;
  const auto& surfaces = sim.entities[static_cast<std::size_t>(entity)].surfaces;
  return surface >= 0 && surface < static_cast<int>(surfaces.size()) ? surfaces[static_cast<std::size_t>(surface)].material : -1;
}

}  // namespace pitviper
