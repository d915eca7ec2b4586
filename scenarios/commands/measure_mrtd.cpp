#include "scenarios/commands/measure_mrtd.hpp"


#include "sim/parameters/print.hpp"

namespace pitviper {

void tellResolvable(BenchResult& result) {
  const BenchSight& sight = result.sight;
  if (!sight.seesHeat) {
    result.notes.push_back("no MRTD: a body of 300 K gives this channel next to nothing, or too much");
    return;
  }
  const double most = nyquist_per_rad(sight.design, Bars::SideBySide);
  Series design{"design", {}, {}, true, false}, measured{"measured", {}, {}, false, false}, stacked{"design, bars stacked", {}, {}, true, false};
  constexpr int kPoints = 60;
  for (int k = 1; k <= kPoints; ++k) {
    const double f = most * k / kPoints, x = 1e-3 * f;
    design.x.push_back(x), design.y.push_back(1e3 * mrtd_K(sight.design, Bars::SideBySide, f));
    if (sight.measured) measured.x.push_back(x), measured.y.push_back(1e3 * mrtd_K(*sight.measured, Bars::SideBySide, f));
    if (f <= nyquist_per_rad(sight.design, Bars::Stacked)) stacked.x.push_back(x), stacked.y.push_back(1e3 * mrtd_K(sight.design, Bars::Stacked, f));
  }
  if (sight.measured)
    for (const double part : {0.1, 0.25, 0.5, 0.75, 0.95}) {
      const double f = part * most;
      result.figures.push_back({print("MRTD at %.3g cycles/mrad", 1e-3 * f), "mK", 1e3 * mrtd_K(sight.design, Bars::SideBySide, f),
                                1e3 * mrtd_K(*sight.measured, Bars::SideBySide, f), 0.0, false});
    }
  const Observer& o = sight.design.observer;
  result.notes.push_back(
      print("MRTD: noise in three dimensions by FLIR92 (SNR %g over %g s) and an eye's own threshold (Barten 2004) before a display %g cm high at %g cm, %g "
            "cd/m2, %g K from its mean to black; up to half a cycle a pixel",
            o.snr, o.eye_s, 100.0 * o.displayHeight_m, 100.0 * o.distance_m, o.luminance_cd_m2, o.sceneContrast_K));
  std::vector<Series> all{design, stacked};
  if (sight.measured) all.insert(all.begin(), measured);
  result.charts.push_back({"MRTD", "cycles/mrad", "mK", false, true, false, all, {}, {}});
}

}  // namespace pitviper
