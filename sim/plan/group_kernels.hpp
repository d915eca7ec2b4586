#pragma once
// What fits spend their time on, in vectors as wide as the machine has: number by number in the same order, so that all machines give the same.
#include <vector>

namespace pitviper {

/// Groups of a state as they are laid out: filled up with such as have no weight.
int paddedGroups(int groups);

/// Amounts of paths that are not zero.
struct SparseAmounts {
  std::vector<int> first{0};  ///< [path + 1]
  std::vector<int> column;
  std::vector<double> amount;
  void add(const double* amounts, int columns);
};

/// exp(-sum over columns of extinction x amount) of paths `begin` to `end`: `extinction` [column][group], `into` [path][group] of all paths, groups as
/// paddedGroups() has them.
void transmittances(const SparseAmounts& amounts, int begin, int end, const double* extinction, int groups, double* into);

/// Sums over wavelengths of share x spectrum: `share` [wavelength][group], `spectra` [spectrum][wavelength], `into` [spectrum][group].
void averages(const double* share, const double* spectra, int wavelengths, int count, int groups, double* into);

}  // namespace pitviper
