#include "tests/support/air_text.hpp"

#include <algorithm>
#include <cmath>

#include "tests/support/print.hpp"

namespace pitviper::test {

namespace {

/// W/(m2 um) to W/(cm2 cm-1).
double perWavenumber(double radiance, double um) { return radiance * um * um * 1e-8; }

std::string listText(int from_per_cm, int to_per_cm, int step_per_cm, const std::function<double(double um)>& of) {
  std::string text;
  for (int v = from_per_cm; v <= to_per_cm; v += step_per_cm) text += (text.empty() ? "" : ", ") + print("%.9g", of(1e4 / v));
  return "[" + text + "]";
}

}  // namespace

std::string tape7Text(int from_per_cm, int to_per_cm, int step_per_cm, std::span<const double> ranges_km, const OfPath& transmittance, const OfPath& radiance) {
  std::string text;
  for (double range : ranges_km) {
    text += print("T F 6%5d%5d    0    6    6    6    6    6    6    1    0    0   0.000   0.00\n", 1, 1) + print("%5d    1    1\n\n\n   36US\n", 1) +
            print("%10.5f%10.5f%10.5f%10.5f%10.5f%10.5f%5d%18.5f\n", 0.0, 0.0, 0.0, range, 0.0, 0.0, 0, 0.0) + "\n\n" +
            print("%10.1f%10.1f%10.1f%10.1fNW\n", 1.0 * from_per_cm, 1.0 * to_per_cm, 1.0 * step_per_cm, 2.0 * step_per_cm) + "\n" +
            "    FREQ  TOT_TRANS  PTH_THRML  THRML_SCT  SURF_EMIS   SOL_SCAT  SING_SCAT  GRND_RFLT  DRCT_RFLT  TOTAL_RAD  REF_SOL  SOL@OBS   "
            "DEPTH DIR_EM    TOA_SUN BBODY_T[K]\n";
    for (int v = from_per_cm; v <= to_per_cm; v += step_per_cm) {
      const double um = 1e4 / v, tau = transmittance(um, range), sent = perWavenumber(radiance(um, range), um);
      text += print("%8.2f%11.8f%11.4E%11.4E%11.4E%33s%11.4E%11.4E%18s%8.3f%7.4f\n", 1.0 * v, tau, sent, 0.0, 0.0, "", 0.0, sent, "",
                    std::min(-std::log(std::max(tau, 1e-40)), 99.99), 1.0);
    }
    text += " -9999.\n";
  }
  return text;
}

std::string modtranJsonText(int from_per_cm, int to_per_cm, int step_per_cm, std::span<const double> ranges_km, const OfPath& transmittance,
                            const OfPath& radiance) {
  std::string cases;
  for (double range : ranges_km) {
    const auto list = [&](const char* key, const std::function<double(double um)>& of) {
      return print("          \"%s\": ", key) + listText(from_per_cm, to_per_cm, step_per_cm, of);
    };
    const auto sent = [&](double um) { return perWavenumber(radiance(um, range), um); };
    const auto none = [](double) { return 0.0; };
    cases += (cases.empty() ? "" : ",\n") +
             print(
                 "    {\n      \"MODTRANINPUT\": {\n        \"RTOPTIONS\": {\"IEMSCT\": \"RT_THERMAL_ONLY\"},\n"
                 "        \"ATMOSPHERE\": {\"MODEL\": \"ATM_US_STANDARD_1976\"},\n        \"AEROSOLS\": {\"IHAZE\": \"AER_RURAL\", \"VIS\": 23.0},\n") +
             print("        \"GEOMETRY\": {\"ITYPE\": 1, \"H1ALT\": 0.0, \"HRANGE\": %.9g}\n      },\n", range) +
             "      \"MODTRANOUTPUT\": {\n        \"SPECTRA\": {\"RADIANCE\": {\n" + list("FREQ", [](double um) { return 1e4 / um; }) + ",\n" +
             list("TOT_TRANS", [&](double um) { return transmittance(um, range); }) + ",\n" + list("THRML_EM", sent) + ",\n" + list("THRML_SCT", none) + ",\n" +
             list("SURF_EMIS", none) + ",\n" + list("GRND_RFLT", none) + ",\n" + list("TOTAL_RAD", sent) + "\n        }}\n      }\n    }";
  }
  return "{\n  \"MODTRAN\": [\n" + cases + "\n  ]\n}\n";
}

std::string modtranCsvText(int from_per_cm, int to_per_cm, int step_per_cm, double range_km, const OfPath& transmittance, const OfPath& radiance) {
  std::string text =
      "MODTRAN 6\ncase 0\n\n\nfreq,total transmittance,path emission,path thermal scat,surface emission,ground reflect,total radiance\n"
      "cm-1,,W cm-2 sr-1/cm-1,W cm-2 sr-1/cm-1,W cm-2 sr-1/cm-1,W cm-2 sr-1/cm-1,W cm-2 sr-1/cm-1\n";
  for (int v = from_per_cm; v <= to_per_cm; v += step_per_cm) {
    const double um = 1e4 / v, sent = perWavenumber(radiance(um, range_km), um);
    text += print("%d,%.9g,%.9g,0,0,0,%.9g\n", v, transmittance(um, range_km), sent, sent);
  }
  return text + "end\n";
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
