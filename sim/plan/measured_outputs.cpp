#include "sim/plan/measured_outputs.hpp"

#include <set>

#include "sim/plan/plan.hpp"
#include "sim/world/coverage.hpp"

namespace pitviper {

std::vector<ChannelOutput> measuredOutputs(const Simulation& simulation, const Camera& camera) {
  std::vector<ChannelOutput> outputs;
  std::set<std::string> channels;
  for (const ChannelOutput& o : camera.outputs) {
    if (!channels.insert(o.channel).second || !o.curves) continue;
    ChannelOutput radiance;
    radiance.channel = o.channel;
    radiance.quantity = "radiance";
    radiance.unit = "W/(m2 sr)";
    radiance.where = o.where;
    radiance.kernel = o.curves->response;
    radiance.bandLow_um = o.curves->response.supportLow();
    radiance.bandHigh_um = o.curves->response.supportHigh();
    radiance.curves = o.curves;
    radiance.apart = o.apart;
    cutToData(simulation, radiance);  // as of those that are drawn
    outputs.push_back(radiance);
    for (const ChannelOutput& other : camera.outputs)
      if (other.detected && other.channel == o.channel) {
        outputs.push_back(other);
        break;
      }
  }
  return outputs;
}

PlannedOutputs plannedOutputs(const Simulation& sim, const Eye& eye) {
  if (!eye.camera) return {eye.probe->outputs, {}};
  const Camera& c = *eye.camera;
  PlannedOutputs all{c.outputs, {}};
  if (!(c.truth.targets || c.truth.terms) || c.spectral.reference || c.spectral.shared || !c.plan.empty()) return all;
  all.measured = measuredOutputs(sim, c);
  std::vector<ChannelOutput> both = all.drawn;
  both.insert(both.end(), all.measured.begin(), all.measured.end());
  if (differentKernels(both).size() > static_cast<std::size_t>(kMostSlots)) all.measured.clear();
  return all;
}

}  // namespace pitviper
