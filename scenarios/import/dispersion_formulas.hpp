#pragma once
// The nine dispersion formulas of refractiveindex.info, and what stands for them in a substance.
// Source: M. N. Polyanskiy, Refractiveindex.info database of optical constants, Sci. Data 11, 94 (2024), and its "Dispersion formulas".
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// A formula of n over the vacuum wavelength in um; c are its coefficients C1, C2 ..., in the order of the file:
///   1  n^2 - 1 = C1 + sum of Ci l^2 / (l^2 - Ci+1^2)          Sellmeier
///   2  n^2 - 1 = C1 + sum of Ci l^2 / (l^2 - Ci+1)            Sellmeier
///   3  n^2 = C1 + sum of Ci l^Ci+1                            polynomial
///   4  n^2 = C1 + C2 l^C3 / (l^2 - C4^C5) + C6 l^C7 / (l^2 - C8^C9) + sum of Ci l^Ci+1
///   5  n = C1 + sum of Ci l^Ci+1                              Cauchy
///   6  n - 1 = C1 + sum of Ci / (Ci+1 - l^-2)                 gases
///   7  n = C1 + C2 / (l^2 - 0.028) + C3 / (l^2 - 0.028)^2 + C4 l^2 + C5 l^4 + C6 l^6   Herzberger
///   8  (n^2 - 1) / (n^2 + 2) = C1 + C2 l^2 / (l^2 - C3) + C4 l^2                       retro
///   9  n^2 = C1 + C2 / (l^2 - C3) + C4 (l - C5) / ((l - C5)^2 + C6)                    exotic
struct DispersionFormula {
  int number = 1;
  std::vector<double> c;

  /// Not a number where n^2 is below 0 or the formula has a pole.
  double operator()(double wavelength_um) const;
};

/// UserError at `where` for a number of coefficients that its formula has not.
void checkCoefficients(const DispersionFormula& formula, const Location& where);

/// Keys of `index:` for the formula from low_um to high_um: Sellmeier's and Cauchy's as such, others as a table of n whose lines are off by kTableError of n
/// at most. UserError at `where` for a formula that gives no index there.
std::string indexOf(const DispersionFormula& formula, double low_um, double high_um, const Location& where);

/// As readRefractiveIndex takes it.
constexpr double kLargestIndex = 1000.0;
/// A tenth of what an imported index may be off.
constexpr double kTableError = 1e-6;

}  // namespace pitviper
