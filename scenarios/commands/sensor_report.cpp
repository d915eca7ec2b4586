#include "scenarios/commands/sensor_report.hpp"

#include <cmath>
#include <set>

#include "sensors/figures.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {

std::string sensorText(const Camera& camera, double step_s) {
  if (!camera.hasStages()) return "";
  std::string out;
  std::set<std::string> told;
  for (int pass = 0; pass < 2; ++pass)  // of a channel's outputs the one that is detected
    for (const ChannelOutput& o : camera.outputs) {
      if ((pass == 0 && !o.detected) || !told.insert(o.channel).second) continue;
      const SensorFigures f = figuresOf(camera, o, step_s);
      out += print("    %s: %.3g urad a pixel, MTF %.2f at Nyquist (lens and pixel)", o.channel.c_str(), 1e6 * f.ifov_rad, f.mtfAtNyquist);
      if (!camera.ownChannels.empty()) out += print(", exposed for %.3g ms", 1e3 * camera.exposureOf(o.channel));
      if (std::abs(f.drawnMtf - f.mtfAtNyquist) > 0.02) out += print("; %.2f on its cells: more 'cells' would mend that", f.drawnMtf);
      if (const auto& d = f.detected) {
        const bool seesHeat = d->electronsAt300K >= 1.0;
        if (seesHeat) {
          out += print(", %.3g electrons at 300 K, NETD %.3g mK", d->electronsAt300K, 1e3 * d->netd_K);
          if (d->netdWithFixed_K > 1.01 * d->netd_K) out += print(" (%.3g with fixed pattern)", 1e3 * d->netdWithFixed_K);
          out += ", most of it " + d->limitedBy;
          if (const DetectorLaw* law = detectorOf(camera, o.channel); law && law->netd)
            out += print("; read noise of %.4g electrons from the NETD of %.4g mK at %.4g K", law->sigmaTvh, 1e3 * law->netd->value_K, law->netd->at_K);
          out += d->saturation_K > 0.0 ? print(", saturated at %.4g K", d->saturation_K) : ", never saturated";
        }
        out += print(", %.3g W/m2 on one pixel as its noise%s", d->noiseEquivalent_W_m2, seesHeat ? "" : " in the dark");
      }
      out += "\n";
    }
  return out;
}

}  // namespace pitviper
