#pragma once
// Fourier transforms of planes of real numbers, by half spectra, in double precision.
#include <complex>
#include <vector>

namespace pitviper {

class PlaneTransform {
 public:
  using Complex = std::complex<double>;
  /// For planes of at least this size, row by row: columns() by rows(), of factors 2, 3 and 5.
  PlaneTransform(int leastColumns, int leastRows);
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  std::size_t size() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
  /// Half of each row's spectrum, row by row; and back. Neither way scaled.
  std::vector<Complex> spectrum(const std::vector<double>& plane) const;
  std::vector<double> plane(std::vector<Complex> spectrum) const;
  /// Of an even kernel with its middle in the first cell: its spectrum, real, over size(), so that spectrum, product and plane() are a convolution.
  std::vector<double> transferOf(const std::vector<double>& kernel) const;
  /// That convolution, around the plane's edges.
  std::vector<double> convolved(const std::vector<double>& plane, const std::vector<double>& transfer) const;

 private:
  void alongColumns(std::vector<Complex>& spectrum, bool back) const;
  int columns_, rows_, half_;  ///< half a row's spectrum
};

}  // namespace pitviper
