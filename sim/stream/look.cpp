// Points a camera: where it stands, where it looks, its field of view and exposure.
#include <cmath>

#include "sim/scene/placement.hpp"
#include "sim/stream/command_models.hpp"

namespace pitviper {

CommandModel lookCommand() {
  std::vector<Parameter> keys = {required(text("camera", "name of a camera"))};
  for (auto& p : positionParameters()) keys.push_back(std::move(p));
  keys.push_back(within(vector3("velocity", "m/s", "goes on from the position; at rest unless given"), -1e6, 1e6));
  for (auto& p : attitudeParameters(kMostTurn_rad)) keys.push_back(std::move(p));
  keys.push_back(within(number("field_of_view", "rad", "horizontal: the focal length follows, the film stays"), 1e-9, 2.0 * std::atan(30.0)));
  keys.push_back(within(number("exposure", "s", "exposure time"), 1e-12, 1e6));
  const auto read = [](const Record& r, const Simulation& sim) -> decltype(Command::change) {
    const Camera& camera = sim.cameras[static_cast<size_t>(cameraOf(r, sim))];
    const auto position = readPosition(r, sim.frame);
    const auto attitude = readAttitude(r, camera.mount.carrier >= 0);
    if (!position && r.given("velocity"))
      throw UserError(r.where("velocity"), "a velocity without a position to go on from", "both", "add 'position:', or remove 'velocity'");
    const glm::dvec3 velocity = r.given("velocity") ? r.vector("velocity") : glm::dvec3(0.0);
    const double field_rad = r.given("field_of_view") ? r.number("field_of_view") : 0.0, exposure_s = r.given("exposure") ? r.number("exposure") : 0.0;
    if (!position && !attitude && field_rad == 0.0 && exposure_s == 0.0)
      throw UserError(r.where(), "a look that changes nothing", "a position, an attitude, a field of view or an exposure", "add one");
    const double focalLength_m = field_rad > 0.0 ? 0.5 * camera.pinhole.width * camera.pinhole.pitchX_m / std::tan(0.5 * field_rad) : 0.0;
    return [=, name = camera.name](Courses& courses, double at_s) {
      if (position) courses.cameraPositions[name] = [=](double t) { return *position + (t - at_s) * velocity; };
      if (attitude) courses.cameraOrientations[name] = [q = orientationFrom(*attitude)](double) { return q; };
      if (field_rad > 0.0) courses.focalLengths_m[name] = [=](double) { return focalLength_m; };
      if (exposure_s > 0.0) courses.exposures_s[name] = [=](double) { return exposure_s; };
    };
  };
  return {"look", "Points a camera. What is not given stays as the scenario has it; one that is turned no longer follows its `look_at`.", keys, read};
}

}  // namespace pitviper
