#pragma once
// A band of many lines as a few steps of constant absorption: the k-distribution of its curve of growth, laid out over the band's wavelengths.
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace pitviper {

/// Optical depth of a band of randomly placed Lorentz lines of exponentially distributed strengths (Goody), x/sqrt(1 + x/(4 overlap)), x = mean path.
/// mean: absorption coefficient of the band's mean [1/(atm m)], path: partial pressure times length [atm m], overlap: half width of lines over their spacing.
/// Source: R. M. Goody, Q. J. R. Meteorol. Soc. 78, 165 (1952); NASA SP-3080 (1973), equation 3-52. Valid: paths of one temperature; others by Curtis and
/// Godson: mean path = sum of mean du, overlap = its mean weighted with mean du (NASA SP-3080, chapter 3).
double curveOfGrowth(double mean_per_atm_m, double overlap, double path_atm_m);

/// Gases whose bands overlap. Within a band each ranks its absorption in an order of its own, so that the mean of a product of their transmittances
/// is nearly the product of their means.
enum class BandAbsorber { CarbonDioxide, WaterVapour, CarbonMonoxide };

/// How a band is divided: shares of its range of wavelengths, from short to long, sum 1. There are divisions into 1 cell (a band without lines), 6 (one gas
/// alone), 8 (carbon dioxide and water vapour) and 12 (all three). Throws std::invalid_argument for others.
std::span<const double> cellShares(std::size_t cells);
/// The cell of each rank, from the least absorption to the most.
std::span<const std::size_t> cellOfRank(std::size_t cells, BandAbsorber);
bool isCellCount(std::size_t cells);

/// Absorption in each cell over the band's mean. Their mean is exactly 1; the mean of exp(-absorption x) is exp(-curveOfGrowth) within 0.005 at any x for
/// overlaps from 0.01 up (carbon dioxide in 8 cells: from 0.03), and the mean of the product of two gases the product of their means within 0.01
/// (tests/unit/test_species.cpp). Overlaps are bounded to 0.004..100.
std::vector<double> cellAbsorption(std::size_t cells, BandAbsorber, double overlap);

/// Absorption over its mean as a function of the share of a band that absorbs less: its logarithm is a cubic of the normal deviate of that share, as
/// coefficients of Chebyshev polynomials of half the deviate.
using RankCurve = std::array<double, 4>;
/// At the middle of each of the shares `weights` (sum 1), from the least absorption to the most.
std::vector<double> levelsOf(const RankCurve&, std::span<const double> weights);
/// The curve whose levels fit a transmittance over x best: the mean of exp(-level x) = transmittance(x), whose slope at 0 is -1. `start`: a first guess.
RankCurve fitRankCurve(const std::function<double(double)>& transmittance, std::span<const double> weights, const RankCurve& start);

}  // namespace pitviper
