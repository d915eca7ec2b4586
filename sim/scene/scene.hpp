#pragma once
// What stands in a scene: textures, entities with their parts, point lights, the sun; and where all of it is at a time.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/parameters/time_course.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "sim/scene/body_form.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/flight_record.hpp"
#include "sim/scene/geodesy.hpp"
#include "sim/scene/lifetime.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/motion.hpp"
#include "sim/scene/texture.hpp"

namespace pitviper {

/// A part of a mesh as it is in a scenario.
struct Surface {
  std::uint32_t meshPart = 0;
  int material = 0;             ///< index into Simulation::materials
  double temperature_K = 0.0;   ///< where it changes over time that of the scenario's first frame; of a texture its mean
  int temperatureTexture = -1;  ///< index into Simulation::textures (K), or -1
  TimeCourse temperature;       ///< [K] over time; empty: temperature_K always
  double temperatureAt_K(double time_s) const { return temperature.empty() ? temperature_K : temperature.at(time_s); }
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
  Lifetime lifetime;
  std::shared_ptr<const FlightRecord> flight;  ///< of one that flies, as it was worked out; null: none
  /// Whether it is there at all, as far as it says itself: a child is absent with its parent (WorldState::isThere).
  bool presentAt(double time_s) const { return lifetime.has(time_s) && motion.presentAt(time_s); }
};

/// How a light's intensity falls off with direction: one .glsl body, float on the GPU, double in C++.
struct LightPattern {
  std::string file;      ///< shader file with the body
  std::string function;  ///< PHYSICS Real function(Vec4 parameters, Vec3 direction), of a name of its own; direction: unit, from the light, in its axes
  double (*body)(glm::dvec4 parameters, glm::dvec3 direction) = nullptr;  ///< the same in double, from 0 to 1; null: it sends alike to all sides
  glm::dvec4 parameters{0.0};
};

/// Point light: intensity(lambda) x level(t) x pattern(direction) [W/(sr um)].
struct PointLight {
  std::string name;
  Spectrum intensity;  ///< where its pattern is 1
  LightPattern pattern;
  double radius_m = 0.05;  ///< distances to it are bounded below by this
  bool visible = true;     ///< adds its own flux to the pixel it is seen in
  Mount mount;
  glm::dvec3 offset_m{0.0};  ///< from what the mount carries, in its axes: of a lamp of several points
  int lamp = -1;             ///< index of the lamp that it is a further point of, whose name and commands it has; -1: its own
  TimeCourse level;          ///< factor over time, usually 0 outside; empty: 1 always
  Lifetime lifetime;
  int store = -1;  ///< index into Simulation::stores: it shines as what is ejected of that does; -1: as above
  bool presentAt(double time_s) const { return lifetime.has(time_s) && mount.motion.presentAt(time_s); }
  double levelAt(double time_s) const { return level.empty() ? 1.0 : level.at(time_s); }
};

/// Directional light. toSun is a unit vector in the local frame; irradiance on a plane facing it [W/(m2 um)].
struct Sun {
  glm::dvec3 toSun{0.0, 0.0, 1.0};
  Spectrum irradiance;
};

/// A direction that a camera on a gimbal is commanded to look.
struct Pointing {
  std::uint64_t number = 0;  ///< of this camera's, from 1
  double at_s = 0.0;         ///< from then on
  bool inBase = false;       ///< in the axes that its angles are of; else in the local frame
  glm::dvec3 direction{1.0, 0.0, 0.0};
};

/// A value of a camera, and of those of its channels that have their own.
struct ChannelValues {
  double common = 0.0;
  std::map<std::string, double> own = {};
  double of(const std::string& channel) const {
    const auto found = own.find(channel);
    return found == own.end() ? common : found->second;
  }
};

/// What of a camera is not as the scenario has it.
struct CameraChange {
  std::optional<glm::dvec3> position;     ///< in the local frame or in its carrier's
  std::optional<glm::dquat> orientation;  ///< the same; it looks along its x axis
  std::optional<double> focalLength_m, exposure_s;
  std::optional<double> gain;                                      ///< factor of its detector's
  std::map<std::string, double> channelExposures_s, channelGains;  ///< of channels that have their own
  std::vector<Pointing> pointings;                                 ///< the newest, oldest first, of one on a gimbal
  std::optional<Pose> pose;                                        ///< in the local frame, of what points it: goes before position, orientation and mount
};

class FieldStates;     // sim/world/field_states.hpp
struct Ejected;        // sim/model/store.hpp
struct ThrottleSteps;  // sim/model/command.hpp

/// Everything that changes, at one time: poses in the local frame.
struct WorldState {
  double time_s = 0.0;
  std::vector<Pose> entities;         ///< of their meshes: of the body itself, moved by its mesh's offset
  std::vector<glm::dvec3> offsets_m;  ///< per entity, of its mesh; none: all are 0
  Pose bodyPose(std::size_t entity) const;
  std::vector<std::vector<double>> temperatures_K;  ///< per entity and surface; of a surface with a temperature texture its mean
  std::vector<glm::dvec3> lights;                   ///< where they shine from
  std::vector<Pose> lightPoses;                     ///< of the lamps that they are of, whose axes patterns are in
  std::vector<double> lightLevels;                  ///< of a light that is not there 0
  std::vector<char> absent;                         ///< per entity: neither seen nor in the way of anything; none: all are there
  bool isThere(std::size_t entity) const { return entity >= absent.size() || !absent[entity]; }
  std::map<std::string, CameraChange> cameras;                    ///< by name, of those that commands have changed
  std::map<int, glm::dvec3> velocities;                           ///< of entities that commands move, they or what carries them [m/s]
  std::map<int, std::shared_ptr<const ThrottleSteps>> throttles;  ///< by field, that commands have set
  std::map<int, std::shared_ptr<const Ejected>> ejected;          ///< by store
  std::shared_ptr<const FieldStates> fields;                      ///< of media that vary through their bodies; null: none
};

/// Pose of a child given in its parent's body frame.
Pose composed(const Pose& parent, const Pose& child);

}  // namespace pitviper
