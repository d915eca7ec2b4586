#include "tests/support/air_text.hpp"

#include <algorithm>
#include <cmath>

#include "tests/support/print.hpp"

namespace pitviper::test {

std::string tape7Text(int from_per_cm, int to_per_cm, int step_per_cm, std::span<const double> ranges_km, const OfPath& transmittance, const OfPath& radiance) {
  std::string text;
  for (double range : ranges_km) {
    text += print("T F 6%5d%5d    0    6    6    6    6    6    6    1    0    0   0.000   0.00\n", 1, 1) + print("%5d    1    1\n\n\n   36US\n", 1) +
            print("%10.5f%10.5f%10.5f%10.5f%10.5f%10.5f%5d%18.5f\n", 0.0, 0.0, 0.0, range, 0.0, 0.0, 0, 0.0) + "\n\n" +
            print("%10.1f%10.1f%10.1f%10.1fNW\n", 1.0 * from_per_cm, 1.0 * to_per_cm, 1.0 * step_per_cm, 2.0 * step_per_cm) + "\n" +
            "    FREQ  TOT_TRANS  PTH_THRML  THRML_SCT  SURF_EMIS   SOL_SCAT  SING_SCAT  GRND_RFLT  DRCT_RFLT  TOTAL_RAD  REF_SOL  SOL@OBS   "
            "DEPTH DIR_EM    TOA_SUN BBODY_T[K]\n";
    for (int v = from_per_cm; v <= to_per_cm; v += step_per_cm) {
      const double um = 1e4 / v, tau = transmittance(um, range), perWavenumber = radiance(um, range) * um * um * 1e-8;  // W/(m2 um) to W/(cm2 cm-1)
      text += print("%8.2f%11.8f%11.4E%11.4E%11.4E%33s%11.4E%11.4E%18s%8.3f%7.4f\n", 1.0 * v, tau, perWavenumber, 0.0, 0.0, "", 0.0, perWavenumber, "",
                    std::min(-std::log(std::max(tau, 1e-40)), 99.99), 1.0);
    }
    text += " -9999.\n";
  }
  return text;
}

std::string airCsvText(double from_um, double to_um, double step_um, std::span<const double> ranges_km, const OfPath& transmittance, const OfPath& radiance) {
  std::string text = "wavelength_um,range_km,transmittance,path_radiance_W/(m2 sr um)\n";
  const int rows = static_cast<int>(std::lround((to_um - from_um) / step_um));
  for (double range : ranges_km)
    for (int i = 0; i <= rows; ++i) {
      const double um = from_um + (to_um - from_um) * i / rows;
      text += print("%.9g,%g,%.12g,%.12g\n", um, range, transmittance(um, range), radiance(um, range));
    }
  return text;
}

}  // namespace pitviper::test
