#include "sensors/netd_design.hpp"

#include <cmath>

#include "sensors/figures.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// The channel that counts, or the one of several that the user names.
const ChannelOutput* designChannel(const Record& r, const Camera& camera) {
  const ChannelOutput* found = nullptr;
  std::vector<std::string> names;
  for (const ChannelOutput& o : camera.outputs)
    if (o.detected && (names.empty() || names.back() != o.channel)) {
      names.push_back(o.channel);
      if (!found || (r.given("netd_channel") && o.channel == r.text("netd_channel"))) found = &o;
    }
  if (r.given("netd_channel") && !names.empty() && found->channel != r.text("netd_channel"))
    throw unknownWord(r.where("netd_channel"), "camera '" + camera.name + "' counts in no channel", r.text("netd_channel"), names);
  if (names.size() > 1 && !r.given("netd_channel"))
    throw UserError(r.where("netd"), "a NETD of a camera that counts in " + std::to_string(names.size()) + " channels",
                    "'netd_channel', one of " + listed(names), "add 'netd_channel: " + names[0] + "'");
  return found;
}

}  // namespace

void designNoise(const Record& r, const Camera& camera, DetectorLaw& law) {
  for (const char* key : {"netd_at", "netd_channel"})
    if (r.given(key) && !r.given("netd"))
      throw UserError(r.where(key), std::string("'") + key + "' without a NETD", "'netd' beside it", "add 'netd: 25 mK', or remove it");
  if (!r.given("netd")) return;
  for (const char* key : {"read_noise", "reset_noise", "flicker_corner"})
    if (r.given(key))
      throw UserError(r.where(key), std::string("a '") + key + "' and a 'netd'",
                      "one of the two: read noise follows from a NETD, and 1/f noise would come on top of it", "remove one");
  law.netd = DetectorLaw::Netd{r.number("netd"), r.number("netd_at")};
  const ChannelOutput* output = designChannel(r, camera);
  if (!output) return;  // nothing is counted: no noise is drawn
  Camera whole = camera;
  StageChoice& own = whole.stages.emplace_back();
  own.detector = law;
  const double at_K = law.netd->at_K, step_s = 1.0;  // only 1/f noise depends on that, and there is none
  const SensorFigures::Detected without = *figuresOf(whole, *output, step_s, at_K).detected;
  const auto milli = [](double v) { return print("%.6g mK", v); };
  const double others_mK = std::ceil(1e5 * without.netd_K) / 1e2;  // so that what is offered is taken
  const std::string where = " at " + std::to_string(static_cast<int>(std::lround(at_K))) + " K";
  if (without.saturation_K > 0.0 && at_K >= without.saturation_K)
    throw UserError(r.where("netd"), "a NETD of a detector that is full" + where,
                    "a full well above " + std::to_string(static_cast<long long>(without.electronsAt300K)) + " electrons",
                    "raise full_well, or shorten the exposure");
  if (!(without.netd_K <= law.netd->value_K))
    throw UserError(r.where("netd"),
                    "a NETD of " + milli(1e3 * law.netd->value_K) + where + " in channel '" + output->channel +
                        "', where noise without read-out's alone makes " + milli(others_mK) + ", most of it " + without.limitedBy,
                    "a NETD of " + milli(others_mK) + " or more",
                    "raise it, or collect more light: a longer exposure, a wider aperture, a higher quantum_efficiency");
  law.sigmaTvh = without.electrons_per_K * std::sqrt(law.netd->value_K * law.netd->value_K - without.netd_K * without.netd_K);
}

}  // namespace pitviper
