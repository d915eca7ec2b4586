#pragma once
// Pictures spread by a kernel, in double precision: what is dim beside what is a million times brighter stays as it is.
#include <complex>
#include <vector>

#include "sensors/optical_transfer.hpp"

namespace pitviper {

/// By half spectra; where a kernel is a product of one along rows and one along columns (Gauss), and short, by these.
class Convolution {
 public:
  /// For pictures of this size. Cells within the kernel's reach of an edge are given what lies on the other side: a margin.
  Convolution(const SpreadKernel& kernel, int width, int height);
  /// Row by row, in place.
  void apply(std::vector<float>& picture) const;

 private:
  using Complex = std::complex<double>;
  /// Half of each row's spectrum, row by row; and back. Neither way scaled.
  std::vector<Complex> spectrum(const std::vector<double>& plane) const;
  std::vector<double> plane(std::vector<Complex> spectrum) const;
  void columns(std::vector<Complex>& spectrum, bool back) const;
  void applyAlong(std::vector<float>& picture) const;
  std::vector<double> along_;  ///< the kernel of rows and of columns, from its middle on; empty: it is no product
  int width_, height_, columns_, rows_, half_;  ///< of the picture; of the transform, and of half a row's spectrum
  std::vector<double> transfer_;                ///< of the kernel, real as it is even, over the number of cells of the transform
};

}  // namespace pitviper
