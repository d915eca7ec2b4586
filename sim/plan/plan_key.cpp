// What a plan depends on, as bytes for its key: all of the scenario but for the cameras that do not look.
#include "sim/model/scene_fingerprint.hpp"
#include "sim/plan/plan_cache.hpp"

namespace pitviper {
namespace {

/// A change of the planner makes old plans strangers.
constexpr double kPlannerVersion = 78;

}  // namespace

ContentKey planKey(const Simulation& sim, const Eye& eye) {
  Fingerprint f;
  f.add(kPlannerVersion);
  addTo(f, sim);
  if (eye.camera) addTo(f, *eye.camera);
  else addTo(f, *eye.probe);
  return contentKey(f.bytes());
}

}  // namespace pitviper
