// Points a camera: where it stands, where it looks, its field of view and exposure.
#include <cmath>

#include "sim/model/world.hpp"
#include "sim/scene/placement.hpp"
#include "sim/stream/command_models.hpp"

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

}  // namespace

CommandModel lookCommand() {
  std::vector<Parameter> keys = {required(text("camera", "name of a camera"))};
  for (auto& p : commandedPoseParameters()) keys.push_back(std::move(p));
  keys.push_back(within(number("field_of_view", "rad", "horizontal: the focal length follows, the film stays"), 1e-9, 3.1));
  keys.push_back(within(number("exposure", "s", "exposure time"), 1e-12, 1e6));
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const Camera& camera = sim.cameras[static_cast<size_t>(cameraOf(r, sim))];
    const CommandedPose pose = readCommandedPose(r, sim.frame, camera.mount.carrier >= 0);
    const double focal_m = focalLength_m(r, camera.pinhole), exposure_s = r.given("exposure") ? r.number("exposure") : 0.0;
    if (!pose.position && !pose.attitude && focal_m == 0.0 && exposure_s == 0.0)
      throw UserError(r.where(), "a look that changes nothing", "a position, an attitude, a field of view or an exposure", "add one");
    if (camera.follower && pose.attitude) {
      requireTakesCommands(camera, r.where("heading"));
      if (r.given("roll")) throw UserError(r.where("roll"), "a roll of a camera on a gimbal", "'heading' and 'pitch': its axes are azimuth and elevation", "remove it");
    }
    return [=, name = camera.name, gimbal = camera.follower.has_value(), mount = camera.mount](Courses& courses, double at_s) {
      if (pose.position) courses.cameraPositions[name] = [=](double t) { return *pose.position + (t - at_s) * pose.velocity; };
      if (pose.attitude && gimbal) {
        const glm::dvec3 sight = orientationFrom(*pose.attitude) * glm::dvec3(1, 0, 0);
        const bool carried = mount.carrier >= 0;
        addPointing(courses, name, {0, at_s, carried, carried ? glm::conjugate(mount.motion.at(at_s).orientation) * sight : sight});
      } else if (pose.attitude) courses.cameraOrientations[name] = [q = orientationFrom(*pose.attitude)](double) { return q; };
      if (focal_m > 0.0) courses.focalLengths_m[name] = [=](double) { return focal_m; };
      if (exposure_s > 0.0) courses.exposures_s[name] = [=](double) { return exposure_s; };
    };
  };
  return {"look",
          "Points a camera. A position, an attitude, a field of view or an exposure that is not given stays as the scenario has it; a camera that is turned no "
          "longer follows "
          "its `look_at`. The attitude of a camera on a gimbal is demanded of that, and it turns there as fast as it can.",
          keys, read};
}

}  // namespace pitviper
