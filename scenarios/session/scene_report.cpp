#include "scenarios/session/scene_report.hpp"

#include "scenarios/commands/plan_report.hpp"
#include "scenarios/commands/seen_report.hpp"
#include "scenarios/commands/sensor_report.hpp"
#include "sim/frame/limits_check.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {

std::string sceneText(const Simulation& sim) {
  std::string text;
  for (const Camera& c : sim.cameras) {
    text +=
        print("camera %s: %dx%d pixels, %zu layer%s\n", c.name.c_str(), c.pinhole.width, c.pinhole.height, c.outputs.size(), c.outputs.size() == 1 ? "" : "s");
    text += sensorText(c, sim.time.step_s);
  }
  const SeenReport seen = reportSeen(sim);
  return text + seen.text + seen.notes;
}

std::string planText(const Simulation& sim, const Camera& camera, const Plan& plan, bool asJson) {
  PlannedEye eye{camera.name, camera.outputs, plan, 0.0, 0.0, 0.0, 0.0, false, false, describe(sim.limits), &camera};
  eye.subpixels = static_cast<double>(camera.pinhole.width) * camera.pinhole.height * camera.samples * camera.samples;
  eye.tableBytes = shadingTableBytes(sim, plan);
  eye.buffered = sim.mode == RenderMode::Buffered || sim.hasTransparent();
  eye.airTables = plan.terms.air && plan.air.elevations > 0;
  return asJson ? planJson(eye) : planText(eye);
}

}  // namespace pitviper
