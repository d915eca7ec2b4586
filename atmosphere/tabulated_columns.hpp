#pragma once
// Air by tables from columns of numbers between blanks, as line-by-line and scattering programs write them: LBLRTM, libRadtran, or any.
//
// What the columns hold is said, in this order, by
//   `names`: as the header of a CSV file, tabulated_csv.hpp: "wavenumber_1/cm, transmittance, -" ('-': left out);
//   LBLRTM's own header (its ASCII files of IPLOT with JOUT, TAPE27, TAPE28 ...): a line WAVENUMBER and RADIANCE [W/(cm2 sr cm-1)], TRANSMISSION or
//     OPTICAL DEPTH. Brightness temperatures are refused;
//   uvspec's input at the head of its output, each line behind '#': output_user lambda | wavenumber (nm, 1/cm) with
//     edir  with output_quantity transmittance: E / E0, so the transmittance of the sun's way times the cosine of sza, which is divided out;
//     uu    with source thermal, one direction: path radiance [W/(m2 sr cm-1), with output_process per_nm W/(m2 sr nm)];
//     other outputs are left out; without one of these two the file is refused. The atmosphere_file must end where the path ends.
// Lines before the rows, empty ones and those beginning with '#' are left out. Wavelengths or wavenumbers rise. The path's length is given beside the file,
// unless the names have it (transmittance_5km) or need none (extinction_1/km); one range is taken as exponential.
// Source: of LBLRTM others' readers of TAPE27 and TAPE28 (a header that ends in the line 0 WAVENUMBER RADIANCE, then two columns; W/(cm2 sr cm-1)), as in
// TROPoe and pyLBLRTM; its words beside RADIANCE are taken by their beginnings (TRANS, OPTICAL), which none of these shows. Of libRadtran its user's guide 2.0:
// output_user, output_quantity, output_process, source. No file of either program was at hand.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "atmosphere/tabulated_air.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {

struct ColumnText {
  std::string text;
  std::string name;  ///< the file in messages
};

struct ColumnsWanted {
  std::optional<std::string> names = {};
  Location namesAt = {};  ///< of their first character
  std::optional<double> range_m = {};
};

/// Whether the text says by itself what its columns hold.
bool isAirColumns(std::string_view text);

/// `radiance`: the file of path radiance over the same wavelengths, where it is apart (TAPE27 beside TAPE28); it must say so by its own header.
/// Errors: UserError with line and column, what was expected and the fix.
TabulatedAir parseAirColumns(const ColumnText& file, const ColumnsWanted& wanted = {}, const std::optional<ColumnText>& radiance = {});
TabulatedAir readAirColumns(const std::filesystem::path& file, const ColumnsWanted& wanted = {}, const std::optional<std::filesystem::path>& radiance = {});

}  // namespace pitviper
