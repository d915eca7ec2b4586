#pragma once
// MODTRAN 6's JSON output (FILEOPTIONS: JSONPRNT, JSONOPT with WRT_OUTPUT).
//
//   {"MODTRAN": [{"MODTRANINPUT":  {"RTOPTIONS": {"IEMSCT": "RT_THERMAL_ONLY"}, "ATMOSPHERE": {"MODEL": ..}, "AEROSOLS": {"IHAZE": .., "VIS": km},
//                                   "GEOMETRY": {"ITYPE": 1, "H1ALT": km, "OBSZEN": deg, "HRANGE": km}},
//                 "MODTRANOUTPUT": {"SPECTRA": {"RADIANCE": {"FREQ": [1/cm], "TOT_TRANS": [..], "THRML_EM": [W/(cm2 sr cm-1)], ..}}}}]}
//
// A case is a run. MODTRANINPUT is there with WRT_INPUT_OUTPUT or WRT_ALL and says the path, the air and the kind of run; without it the file holds one path of
// unknown kind, whose range the user gives. A case with "CASE TEMPLATE" has the rest of its input from that case.
// Read: SPECTRA of TRANSMITTANCE or RADIANCE, one line of sight a case. Refused: IRRADIANCE alone, lunar runs, several lines of sight (MLOS).
// Source: keywords as in https://github.com/brianschubert/pymod6 (src/pymod6/input/schema.py, tests/test_io.py), which runs MODTRAN 6 and compares its
// outputs; FREQ after the member freq of MODTRAN 6's own programming interface. No file of MODTRAN 6's was at hand.
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/tape7.hpp"

namespace pitviper {

bool isModtranJson(std::string_view text);

/// `name` is the file in messages. Errors: UserError with line and column.
std::vector<Tape7Run> parseModtranJson(std::string_view text, const std::string& name);

}  // namespace pitviper
