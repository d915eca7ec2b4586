#pragma once
// A scenario as a window has it: read once, never changed; what is edited makes another.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/commands/scenario_wish.hpp"
#include "sim/model/band_temperature.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

struct ViewedScene {
  Simulation simulation;
  std::map<std::string, std::shared_ptr<const BandTemperature>> temperatures;  ///< of radiances in bands where bodies glow: by temperatureKey()
  std::shared_ptr<const int> geometry;                                         ///< scenes with the same have the same bodies, meshes and textures
};
using ViewedScenePointer = std::shared_ptr<const ViewedScene>;

/// Reads a scenario; its cameras have layers of range, entity and temperature besides their own, which cost a plan nothing. Errors: UserError.
ViewedScenePointer readScene(const ScenarioWish& wish);
std::string temperatureKey(const std::string& camera, const std::string& layer);

/// With every camera asked for another accuracy.
ViewedScenePointer withAccuracy(const ViewedScene& scene, double accuracy);
/// With a material of it as another: by its place among the simulation's.
ViewedScenePointer withMaterial(const ViewedScene& scene, std::size_t number, std::shared_ptr<const Material> material);
/// What can be drawn of it before anything is planned: materials under the sun and their own warmth, at a few wavelengths, without air, shadows, surroundings,
/// lamps, smoke and what is smaller than a pixel. No error is known of it.
ViewedScenePointer sketchOf(const ViewedScene& scene);

/// What a material is of an entity's part, by number of both from 0; -1: none.
int materialAt(const Simulation& simulation, int entity, int surface);

}  // namespace pitviper
