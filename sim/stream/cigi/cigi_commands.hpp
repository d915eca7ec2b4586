#pragma once
// What CIGI packets change, in our units and axes: radians, x forward, y left, z up. Ids are the host's; which body or camera they are, a scenario says.
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "sim/scene/geodesy.hpp"
#include "sim/stream/cigi/cigi_packets.hpp"

namespace pitviper {

/// Turns a body by a yaw to the right, then a pitch up, then a roll right wing down, from axes x forward, y left, z up [rad].
glm::dquat cigiRotation(double yaw_rad, double pitch_rad, double roll_rad);

/// Where an entity is. Of one that is not attached: in earth-centred, earth-fixed axes; else in its parent's body axes.
struct CigiEntityPose {
  int entity = 0;
  bool attached = false;
  int parent = 0;                              ///< where attached
  Geodetic geodetic;                           ///< where not attached: for LocalFrame::toLocal()
  glm::dvec3 position{0.0};                    ///< [m]
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  ///< takes body directions to those axes
  CigiEntityState state = CigiEntityState::Standby;
  double alpha = 1.0;         ///< 0: invisible, 1: opaque
  bool inheritAlpha = false;  ///< times the parent's
  int type = 0;
  CigiClamp clamp = CigiClamp::None;  ///< asks for a height and an attitude of the ground's instead
};

/// Offsets and angles of a view or a part from its carrier. What is not given stays as it was.
struct CigiOffsets {
  std::optional<double> forward_m, left_m, up_m;
  std::optional<double> yaw_rad, pitch_rad, roll_rad;  ///< right, up, right wing down

  /// What a newer one gives takes the place of what this one has.
  void take(const CigiOffsets& newer);
  /// In the carrier's body axes; 0 where not given.
  glm::dvec3 position() const;
  glm::dquat orientation() const;
};

/// Which view goes with which entity, and how it stands there.
struct CigiView {
  int view = 0;
  int group = 0;  ///< not 0: all views of it, whatever `view` says
  int entity = 0;
  CigiOffsets offsets;
};

/// Half-angles from the line of sight, right and up positive: of a view that looks ahead, left and bottom are negative [rad]. Its near and far planes
/// are not told: a path has its own length.
struct CigiViewDefinition {
  int view = 0;
  int group = 0;  ///< not 0: all views of it, whatever `view` says
  std::optional<double> left_rad, right_rad, top_rad, bottom_rad;
  CigiMirror mirror = CigiMirror::None;
  bool orthographic = false;

  /// Of a view as wide to the left as to the right (within 1e-6 rad: half-angles are floats) with both given: what `look` takes.
  std::optional<double> horizontalFieldOfView_rad() const;
};

/// CIGI has no command that resets a sensor.
struct CigiSensor {
  int view = 0, sensor = 0;
  bool on = false, blackHot = false, automaticGain = false, lineDropout = false;
  double gain = 0.0, level = 0.0, noise = 0.0;  ///< 0 to 1; what 1 is, the image generator says
  double acCoupling_s = 0.0;                    ///< time constant
  CigiTrackMode trackMode = CigiTrackMode::Off;
  bool trackBlack = false;
  bool extendedResponse = false;  ///< the host wants Sensor Extended Response packets: gate and target
};

/// A part of an entity, from its place in the model.
struct CigiPart {
  int entity = 0, part = 0;
  bool enabled = false;
  CigiOffsets offsets;
};

/// How an entity or a part goes on between messages.
struct CigiRate {
  int entity = 0;
  std::optional<int> part;
  /// Own: the body's axes. Else the parent's body axes, or, of an entity without parent, x north, y west, z up at its place. A part's are its own.
  bool ownAxes = false;
  glm::dvec3 linear_m_s{0.0};
  glm::dvec3 angular_rad_s{0.0};  ///< about x, y and z of those axes: roll, minus pitch, minus yaw
};

/// What a component of a scene is set to: what it means, a scenario says.
struct CigiComponent {
  CigiComponentClass componentClass = CigiComponentClass::Entity;
  int component = 0, instance = 0, state = 0;
  int wordCount = 0;
  std::array<std::uint32_t, 6> words{};

  /// Word `i` as a float. Nothing beyond their count, or where it is no finite number.
  std::optional<double> asFloat(int i) const;
};

using CigiChange = std::variant<CigiEntityPose, CigiView, CigiViewDefinition, CigiSensor, CigiPart, CigiRate, CigiComponent>;

/// What a datagram changes, in its order; nothing where it has a fault. Packets as readCigi() gives them: their numbers are in range.
std::vector<CigiChange> cigiChanges(const CigiMessage& message);

}  // namespace pitviper
