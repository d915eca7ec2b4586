#include "atmosphere/modtran_names.hpp"

#include <algorithm>
#include <cctype>

namespace pitviper {
namespace {

struct Names {
  const char *tape7, *json, *csv;
};

constexpr Names kTransmittance[] = {{"COMBIN_TRANS", "TOT_TRANS", "COMBIN_TRANS"},
                                    {"H2O_TRANS", "TRANS_H2O", "H2O_TRANS"},
                                    {"UMIX_TRANS", "TRANS_UMIX", "UMIX_TRANS"},
                                    {"O3_TRANS", "TRANS_O3", "O3_TRANS"},
                                    {"TRACE_TRANS", "TRANS_TRACE", "TRACE_TRANS"},
                                    {"N2_CONT", "CONT_N2", "N2_TRANS"},
                                    {"H2O_CONT", "CONT_H2O", "H2OCNT_TRANS"},
                                    {"MOLEC_SCAT", "MOLEC_SCAT", "MOLEC_SCAT"},
                                    {"AER+CLD_TRANS", "TRANS_AERCLD", "AERCLD_TRANS"},
                                    {"HNO3_TRANS", "TRANS_HNO3", "HNO3_TRANS"},
                                    {"AER+CLD_abTRNS", "ABTRNS_AERCLD", "AERCLD_ABTRNS"}};

constexpr Names kRadiance[] = {{"TOT_TRANS", "TOT_TRANS", "TOTAL_TRANSMITTANCE"},   {"THRML_EM", "THRML_EM", "PATH_EMISSION"},
                               {"THRML_SCT", "THRML_SCT", "PATH_THERMAL_SCAT"},     {"SURF_EMIS", "SURF_EMIS", "SURFACE_EMISSION"},
                               {"MULT_SCAT", "MULT_SCAT", "PATH_MULTIPLE_SCAT"},    {"SING_SCAT", "SING_SCAT", "PATH_SINGLE_SCAT"},
                               {"GRND_RFLT", "GRND_RFLT", "GROUND_REFLECT"},        {"DRCT_RFLT", "DRCT_RFLT", "DIRECT_REFLECT"},
                               {"TOTAL_RAD", "TOTAL_RAD", "TOTAL_RADIANCE"},        {"REF_SOL", "REF_SOL", "REFERENCE_IRRADIANCE"},
                               {"SOL@OBS", "SOL_AT_OBS", "IRRADIANCE_AT_OBSERVER"}, {"DEPTH", "DEPTH", "-_NAT_LOG_PATH_TRANS"},
                               {"DIR_EM", "DIR_EM", "DIRECTIONAL_EMISSIVITY"},      {"TOA_SUN", "TOA_RAD", "TOP-OF-ATMOSPHERE_IRRADIANCE"},
                               {"BBODY_T[K]", "BBODY_TK", "BRIGHTNESS_TEMP"}};

/// Capitals, and underscores for blanks.
std::string plain(std::string_view name) {
  std::string out;
  for (char c : name) out += c == ' ' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace

std::optional<std::string> tape7Name(std::string_view name, bool transmittanceRun) {
  const std::string own = plain(name);
  const auto find = [&](const auto& all) -> std::optional<std::string> {
    for (const Names& n : all)
      if (own == n.tape7 || own == n.json || own == n.csv) return n.tape7;
    return std::nullopt;
  };
  if (!transmittanceRun) return find(kRadiance);
  if (auto known = find(kTransmittance)) return known;
  // The single gases.
  if (own.starts_with("TRANS_")) return own.substr(6) + "_TRANS";
  if (own.size() > 6 && own.ends_with("_TRANS")) return own;
  return std::nullopt;
}

}  // namespace pitviper
