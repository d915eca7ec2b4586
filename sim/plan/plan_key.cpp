// What a plan depends on, as bytes for its key: all of the scenario but for the cameras that do not look.
#include "sim/model/scene_fingerprint.hpp"
#include "sim/plan/plan_cache.hpp"

namespace pitviper {
ContentKey planKey(const Simulation& sim, const Eye& eye) {
  return contentKeyOf([&](Fingerprint& f) {
    f.add(static_cast<double>(kPlannerVersion));
    addTo(f, sim);
    if (eye.camera) addTo(f, *eye.camera);
    else addTo(f, *eye.probe);
  });
}

}  // namespace pitviper
