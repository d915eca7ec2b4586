#pragma once
// Files of BRDFs over three angles.
#include <array>
#include <filesystem>

#include "materials/measured_brdf.hpp"

namespace pitviper {

/// MERL's binary layout: three 4-byte integers 90, 90, 180 (half angle by its root, difference angle, azimuth of difference), then 8-byte numbers of red, green
/// and blue, to be scaled by 1, 1.15 and 1.66 over 1500. Little endian. Source: W. Matusik et al., ACM Trans. Graphics 22, 759 (2003), and its BRDFRead.
/// `bands_um`: what wavelengths red, green and blue stand for. Values below 0 are holes.
MeasuredGrid readMerl(const std::filesystem::path& file, const std::array<double, 3>& bands_um, const Location& askedAt);

/// A CSV (sim/parameters/csv_table.hpp) with the columns wavelength, brdf [1/sr], azimuth, and incidence and view or half and difference, in any order; a row
/// for every crossing of its wavelengths and angles that both directions can see, in any order.
MeasuredGrid readBrdfCsv(const std::filesystem::path& file, const Location& askedAt);

}  // namespace pitviper
