#pragma once
// Optical depth by range from a few transmittances: a sum of powers with coefficients that are not negative.
#include <span>
#include <vector>

namespace pitviper {

struct RangeDepth {
  double range_km = 0.0;
  double transmittance = 1.0;
  double depth = 0.0;  ///< -ln of it; from a column of its own where the transmittance has lost its digits
};

struct DepthFit {
  std::vector<double> coefficients;  ///< optical depth of the first kilometre, one per exponent
  double largest = 0.0;              ///< largest difference of transmittance from the rows
  double sumOfSquares = 0.0;         ///< of those differences
};

/// -ln tau(R) = sum over k of c_k R^a_k, c_k >= 0, least squares of the transmittance (to first order: depths weighted by it).
/// Rows at or below `resolution` (the step of their last digit) say only "opaque" and are used only if all do: then the shortest has half of it.
/// Where several single powers fit equally, the last exponent is taken; so let the last be 1.
/// The support of the best non-negative solution is found by trying all: at most 4 exponents. Errors: none; no rows give zero.
DepthFit fitDepth(std::span<const RangeDepth> rows, std::span<const double> exponents, double resolution);

struct RangeRadiance {
  double range_km = 0.0;
  std::vector<double> radiance;  ///< at each wavelength
};

/// Source radiance J at each wavelength: least squares of L(R) = J (1 - tau(R)), tau from the depths as fitted, so that one range's radiance comes
/// back as it was. Where the air is clear to the last digit nothing can be said of J: the nearest wavelength's, which adds nothing there.
/// `difference`: largest difference from the rows, of the largest radiance. No rows give none.
std::vector<double> fitSource(std::span<const std::vector<double>> depth, std::span<const double> exponents, std::span<const RangeRadiance> seen,
                              double& difference);

}  // namespace pitviper
