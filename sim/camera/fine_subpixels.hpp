#pragma once
// What sheets' lines say of subpixels of a picture, and how it gets into them.
#include <map>

#include "sim/camera/covered_cells.hpp"
#include "sim/camera/light_places.hpp"
#include "sim/camera/sheets.hpp"
#include "sim/camera/subpixels.hpp"

namespace pitviper {

/// A sheet's lines that fall into one subpixel.
struct SheetShare {
  double looked_sr = 0.0;        ///< projected solid angle of all
  double covered_sr = 0.0;       ///< of those that count
  std::vector<double> sum;       ///< of these, by slot: radiance times that
  Moments placed{};              ///< of these, by their solid angle
  std::vector<Moments> moments;  ///< by slot, by what they send; empty where no points are kept
};
using SheetShares = std::map<std::size_t, SheetShare>;

/// `drawn`: the sheet as a pass drew it; `mayCount`: as of Sheets; `cells`: takes what those cover that count, or null.
SheetShares sharesOf(const Subpixels& image, const Sheets& sheets, const Sheet& sheet, const RawImage& drawn, const std::vector<char>* mayCount,
                     CoveredCells* cells);

/// A subpixel's lines of all sheets, each at directions of its own.
struct FineSubpixel {
  double covered_sr = 0.0, whole_sr = 0.0;
  std::vector<double> sum, under;  ///< what they send, what the picture has where they are
  Moments placed{};
  std::vector<Moments> moments;
};
using FineSubpixels = std::map<std::size_t, FineSubpixel>;

/// Adds a sheet, the finest first.
void gather(const Subpixels& image, const Sheet& sheet, const SheetShares& shares, FineSubpixels& fine);

/// The picture keeps what it has in the rest of a subpixel: a mean of radiances, none of which is below 0. Where it keeps points (and few subpixels are fine)
/// what is beyond the picture's own becomes points, which have its middle and its spread.
void put(Subpixels& image, const FineSubpixels& fine);

}  // namespace pitviper
