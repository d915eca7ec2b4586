// Points a camera: where it stands, where it looks, its field of view and exposure.
#include <algorithm>
#include <cmath>

#include "sim/scene/placement.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// That of a field of view; 0 where none is given. UserError where the film would be wider or higher than a flat one can be.
double focalLength_m(const Record& r, const Pinhole& p) {
  if (!r.given("field_of_view")) return 0.0;
  Pinhole zoomed = p;
  zoomed.focalLength_m = 0.5 * p.width * p.pitchX_m / std::tan(0.5 * r.number("field_of_view"));
  if (!zoomed.isFlat())
    throw UserError(r.where("field_of_view"), "the field of view is wider than a flat film can hold", "below 176 deg across and up", "lower it");
  return zoomed.focalLength_m;
}

/// The channel whose exposure is set; empty: that of all that have none of their own.
std::string channelOf(const Record& r, const Camera& camera, bool setsExposure) {
  const auto hasOwn = [&](const std::string& channel) {
    const OwnChannel* own = camera.ownChannel(channel);
    return own && own->exposure_s;
  };
  std::vector<std::string> names;
  bool common = false;
  for (const ChannelOutput& o : camera.outputs)
    if (!hasOwn(o.channel)) common = true;
    else if (names.empty() || names.back() != o.channel) names.push_back(o.channel);
  if (!r.given("channel")) {
    if (setsExposure && !common && !names.empty())
      throw UserError(r.where("exposure"), "each channel of camera '" + camera.name + "' has an exposure of its own", "'channel', one of them",
                      "add 'channel: " + names.front() + "'");
    return "";
  }
  if (!setsExposure) throw UserError(r.where("channel"), "a channel without an exposure to set", "'exposure' beside it", "add it, or remove 'channel'");
  const std::string name = r.text("channel");
  if (!hasOwn(name)) {
    if (std::any_of(camera.outputs.begin(), camera.outputs.end(), [&](const ChannelOutput& o) { return o.channel == name; }))
      throw UserError(r.where("channel"), "channel '" + name + "' has the exposure of its camera", "a channel with an 'exposure' of its own",
                      "remove 'channel', or give it one in the scenario");
    throw unknownWord(r.where("channel"), "camera '" + camera.name + "' has no channel with an exposure of its own that is called", name, names);
  }
  return name;
}

}  // namespace

CommandModel lookCommand() {
  std::vector<Parameter> keys = {required(text("camera", "name of a camera"))};
  for (auto& p : commandedPoseParameters()) keys.push_back(std::move(p));
  keys.push_back(within(number("field_of_view", "rad", "horizontal: the focal length follows, the film stays"), 1e-9, 3.1));
  keys.push_back(within(number("exposure", "s", "exposure time"), 1e-12, 1e6));
  keys.push_back(text("channel", "whose exposure it is: of one that has an exposure of its own; unless given that of all others"));
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const Camera& camera = sim.cameras[static_cast<size_t>(cameraOf(r, sim))];
    const CommandedPose pose = readCommandedPose(r, sim.frame, camera.mount.carrier >= 0);
    const double focal_m = focalLength_m(r, camera.pinhole), exposure_s = r.given("exposure") ? r.number("exposure") : 0.0;
    const std::string channel = channelOf(r, camera, exposure_s > 0.0);
    if (!pose.position && !pose.attitude && focal_m == 0.0 && exposure_s == 0.0)
      throw UserError(r.where(), "a look that changes nothing", "a position, an attitude, a field of view or an exposure", "add one");
    if (camera.follower && pose.attitude) {
      requireTakesCommands(camera, r.where("heading"));
      if (r.given("roll"))
        throw UserError(r.where("roll"), "a roll of a camera on a gimbal", "'heading' and 'pitch': its axes are azimuth and elevation", "remove it");
    }
    return [=, name = camera.name, gimbal = camera.follower.has_value(), mount = camera.mount](Courses& courses, double at_s) {
      if (pose.position) courses.cameraPositions[name] = [=](double t) { return *pose.position + (t - at_s) * pose.velocity.value_or(glm::dvec3(0.0)); };
      if (pose.attitude && gimbal) {
        const glm::dvec3 sight = orientationFrom(*pose.attitude) * glm::dvec3(1, 0, 0);
        const bool carried = mount.carrier >= 0;
        addPointing(courses, name, {0, at_s, carried, carried ? glm::conjugate(mount.motion.at(at_s).orientation) * sight : sight});
      } else if (pose.attitude) courses.cameraOrientations[name] = [q = orientationFrom(*pose.attitude)](double) { return q; };
      if (focal_m > 0.0) courses.focalLengths_m[name] = [=](double) { return focal_m; };
      if (exposure_s > 0.0 && channel.empty()) courses.exposures_s[name] = [=](double) { return exposure_s; };
      else if (exposure_s > 0.0) courses.channelExposures_s[{name, channel}] = [=](double) { return exposure_s; };
    };
  };
  return {"look",
          "Points a camera. A position, an attitude, a field of view or an exposure that is not given stays as the scenario has it; a camera that is turned no "
          "longer follows its `look_at`. The attitude of a camera on a gimbal is demanded of that, and it turns there as fast as it can.",
          keys, read};
}

}  // namespace pitviper
