#pragma once
// What stands in a scene: textures, entities with their parts, point lights, the sun; and where all of it is at a time.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/radiometry/spectrum.hpp"
#include "sim/scene/body_form.hpp"
#include "sim/scene/geodesy.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/motion.hpp"
#include "sim/scene/texture.hpp"

namespace pitviper {

/// A part of a mesh as it is in a scenario.
struct Surface {
  std::uint32_t meshPart = 0;
  int material = 0;  ///< index into Simulation::materials
  double temperature_K = 0.0;
  int temperatureTexture = -1;  ///< index into Simulation::textures (K), or -1
};

struct Entity {
  std::string name;
  std::shared_ptr<const Mesh> mesh;
  BodyForm form;
  std::vector<Surface> surfaces;
  Motion motion;
  int parent = -1;  ///< motion is then in that entity's body frame
  glm::vec3 boundingCentre{0.0f};
  float boundingRadius_m = 0.0f;
  std::string meshFile;        ///< as the scenario names it, of a mesh from a file; else empty
  double metresPerUnit = 0.0;  ///< that its unit and scale give
};

/// Point light: intensity(lambda) x level(t) [W/(sr um)].
struct PointLight {
  std::string name;
  Spectrum intensity;
  double radius_m = 0.05;  ///< distances to it are bounded below by this
  bool visible = true;     ///< adds its own flux to the pixel it is seen in
  Motion motion;
  int parent = -1;
  std::vector<std::pair<double, double>> level;  ///< (time_s, factor), linear between, 0 outside; empty: 1 always
  double levelAt(double time_s) const;
};

/// Directional light. toSun is a unit vector in the local frame; irradiance on a plane facing it [W/(m2 um)].
struct Sun {
  glm::dvec3 toSun{0.0, 0.0, 1.0};
  Spectrum irradiance;
};

/// What of a camera is not as the scenario has it.
struct CameraChange {
  std::optional<glm::dvec3> position;     ///< in the local frame or in its carrier's
  std::optional<glm::dquat> orientation;  ///< the same; it looks along its x axis
  std::optional<double> focalLength_m, exposure_s;
  std::optional<double> gain;  ///< factor of its detector's
};

/// Everything that changes, at one time: poses in the local frame.
struct WorldState {
  double time_s = 0.0;
  std::vector<Pose> entities;
  std::vector<std::vector<double>> temperatures_K;  ///< per entity and surface; of a surface with a temperature texture its mean
  std::vector<glm::dvec3> lights;
  std::vector<double> lightLevels;
  std::map<std::string, CameraChange> cameras;  ///< by name, of those that commands have changed
};

/// Pose of a child given in its parent's body frame.
Pose composed(const Pose& parent, const Pose& child);

}  // namespace pitviper
