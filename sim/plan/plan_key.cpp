// What a plan depends on, as bytes for its key: all of the scenario but for the cameras that do not look.
#include "sim/model/scene_fingerprint.hpp"
#include "sim/plan/measured_outputs.hpp"
#include "sim/plan/plan_cache.hpp"

namespace pitviper {

ContentKey planKey(const Simulation& sim, const Eye& eye, bool isForetold) {
  const auto [drawn, measured] = plannedOutputs(sim, eye);
  return contentKeyOf([&](Fingerprint& f) {
    f.add(isForetold);
    addTo(f, sim);
    if (eye.camera) {
      // Of what a camera asks for, light's way tells kernels apart, and nothing else: not how long it is exposed, what is made of it, or shown besides.
      Camera own = *eye.camera;
      own.exposure_s = 0.0;
      own.exposureOverTime_s = {};
      own.ownChannels.clear();
      own.outputs.clear();
      own.stages.clear();
      own.truth = {};
      own.truth.solidAngles = eye.camera->truth.solidAngles;
      addTo(f, own);
    } else {
      addTo(f, *eye.probe);
    }
    for (const auto& outputs : {drawn, measured})
      for (const ChannelOutput* o : differentKernels(outputs)) {
        f.add(o->apart);
        addTo(f, o->kernel);
      }
  });
}

}  // namespace pitviper
