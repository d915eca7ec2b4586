#include "sim/stream/cigi/cigi_commands.hpp"

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/motion.hpp"

namespace pitviper {
namespace {

double radians(double degrees) { return degrees * (kPi / 180.0); }
std::optional<double> radians(const std::optional<double>& degrees) { return degrees ? std::optional<double>(radians(*degrees)) : std::nullopt; }
std::optional<double> minus(const std::optional<double>& x) { return x ? std::optional<double>(-*x) : std::nullopt; }

/// CIGI's body axes are x forward, y right, z down.
glm::dvec3 ours(const std::array<double, 3>& v) { return {v[0], -v[1], -v[2]}; }

CigiOffsets offsetsOf(const CigiDegreesGiven& d) { return {d.x_m, minus(d.y_m), minus(d.z_m), radians(d.yaw_deg), radians(d.pitch_deg), radians(d.roll_deg)}; }

CigiOffsets offsetsOf(const CigiShortPartControl::Single& p) {
  CigiDegreesGiven d;
  switch (p.degree) {
    case CigiDegree::X:
      d.x_m = p.value;
      break;
    case CigiDegree::Y:
      d.y_m = p.value;
      break;
    case CigiDegree::Z:
      d.z_m = p.value;
      break;
    case CigiDegree::Yaw:
      d.yaw_deg = p.value;
      break;
    case CigiDegree::Pitch:
      d.pitch_deg = p.value;
      break;
    case CigiDegree::Roll:
      d.roll_deg = p.value;
      break;
    case CigiDegree::None:
      break;
  }
  return offsetsOf(d);
}

std::optional<double> symmetric(const std::optional<double>& lower, const std::optional<double>& upper) {
  if (!lower || !upper || std::abs(*lower + *upper) > 1e-6) return std::nullopt;
  return *upper - *lower;
}

std::optional<double> ifFinite(double x) { return std::isfinite(x) ? std::optional<double>(x) : std::nullopt; }

/// Turns each kind of packet into what it changes.
struct Changes {
  std::vector<CigiChange> list;

  void operator()(const CigiEntityControl& c) {
    CigiEntityPose pose;
    pose.entity = c.entity;
    pose.attached = c.attached;
    pose.parent = c.parent;
    const double yaw = radians(c.yaw_deg), pitch = radians(c.pitch_deg), roll = radians(c.roll_deg);
    if (c.attached) {
      pose.position = ours(c.position);
      pose.orientation = cigiRotation(yaw, pitch, roll);
    } else {
      pose.geodetic = {radians(c.position[0]), radians(c.position[1]), c.position[2]};
      // Heading, pitch and roll mean the same here and there, over the ellipsoid's east, north and up at the entity itself.
      const LocalFrame here(pose.geodetic);
      pose.position = here.toEcef(glm::dvec3(0.0));
      pose.orientation = glm::normalize(glm::quat_cast(here.ecefFromLocal()) * orientationFrom({yaw, pitch, roll}));
    }
    pose.state = c.state;
    pose.alpha = c.alpha / 255.0;
    pose.inheritAlpha = c.inheritAlpha;
    pose.type = c.type;
    pose.clamp = c.clamp;
    list.emplace_back(pose);
  }

  void operator()(const CigiComponentControl& c) { list.emplace_back(CigiComponent{c.componentClass, c.component, c.instance, c.state, c.wordCount, c.words}); }

  void operator()(const CigiPartControl& c) { list.emplace_back(CigiPart{c.entity, c.part, c.enabled, offsetsOf(c.given)}); }

  void operator()(const CigiShortPartControl& c) {
    for (const auto& p : c.parts)
      if (p.degree != CigiDegree::None) list.emplace_back(CigiPart{c.entity, p.part, p.enabled, offsetsOf(p)});
  }

  void operator()(const CigiRateControl& c) {
    CigiRate rate;
    rate.entity = c.entity;
    if (c.ofPart) rate.part = c.part;
    rate.ownAxes = c.ofPart || c.ownAxes;
    rate.linear_m_s = ours(c.linear_m_s);
    rate.angular_rad_s = ours({radians(c.angular_deg_s[0]), radians(c.angular_deg_s[1]), radians(c.angular_deg_s[2])});
    list.emplace_back(rate);
  }

  void operator()(const CigiViewControl& c) { list.emplace_back(CigiView{c.view, c.group, c.entity, offsetsOf(c.given)}); }

  void operator()(const CigiSensorControl& c) {
    CigiSensor s;
    s.view = c.view;
    s.sensor = c.sensor;
    s.on = c.on;
    s.blackHot = c.blackHot;
    s.automaticGain = c.automaticGain;
    s.lineDropout = c.lineDropout;
    s.gain = c.gain;
    s.level = c.level;
    s.noise = c.noise;
    s.acCoupling_s = 1e-6 * c.acCoupling_us;
    s.trackMode = c.trackMode;
    s.trackBlack = c.trackBlack;
    s.extendedResponse = c.extendedResponse;
    list.emplace_back(s);
  }

  void operator()(const CigiViewDefinitionPacket& c) {
    list.emplace_back(
        CigiViewDefinition{c.view, c.group, radians(c.left_deg), radians(c.right_deg), radians(c.top_deg), radians(c.bottom_deg), c.mirror, c.orthographic});
  }
};

}  // namespace

glm::dquat cigiRotation(double yaw_rad, double pitch_rad, double roll_rad) {
  // From x forward instead of from north, which is y: a quarter turn on.
  return orientationFrom({yaw_rad + 0.5 * kPi, pitch_rad, roll_rad});
}

void CigiOffsets::take(const CigiOffsets& newer) {
  for (const auto member :
       {&CigiOffsets::forward_m, &CigiOffsets::left_m, &CigiOffsets::up_m, &CigiOffsets::yaw_rad, &CigiOffsets::pitch_rad, &CigiOffsets::roll_rad})
    if (newer.*member) this->*member = newer.*member;
}

glm::dvec3 CigiOffsets::position() const { return {forward_m.value_or(0.0), left_m.value_or(0.0), up_m.value_or(0.0)}; }
glm::dquat CigiOffsets::orientation() const { return cigiRotation(yaw_rad.value_or(0.0), pitch_rad.value_or(0.0), roll_rad.value_or(0.0)); }

std::optional<double> CigiViewDefinition::horizontalFieldOfView_rad() const { return symmetric(left_rad, right_rad); }

std::optional<double> CigiComponent::asFloat(int i) const {
  if (i < 0 || i >= wordCount) return std::nullopt;
  return ifFinite(std::bit_cast<float>(words[static_cast<std::size_t>(i)]));
}

std::vector<CigiChange> cigiChanges(const CigiMessage& message) {
  Changes changes;
  if (message.fault != CigiFault::None) return {};
  changes.list.reserve(message.packets.size());
  for (const CigiPacket& packet : message.packets) std::visit(changes, packet);
  return std::move(changes.list);
}

}  // namespace pitviper
