#pragma once
// Pictures spread by a kernel, in double precision: what is dim beside what is a million times brighter stays as it is.
#include <vector>

#include "sensors/optical_transfer.hpp"
#include "sensors/plane_transform.hpp"

namespace pitviper {

/// By half spectra; where a kernel is a product of one along rows and one along columns (Gauss), and short, by these.
class Convolution {
 public:
  /// `unused`: cells at each edge of the picture that nobody looks at, a margin; light may come to them around the picture.
  Convolution(const SpreadKernel& kernel, int width, int height, int unused = 0);
  /// What is spread of a picture less a level, row by row; beyond the picture there is nothing but that level.
  std::vector<double> operator()(const std::vector<float>& picture, double level) const;

 private:
  std::vector<double> alongBoth(const std::vector<float>& picture, double level) const;
  std::vector<double> along_;  ///< the kernel of rows and of columns, from its middle on; empty: it is no product
  int width_, height_;
  PlaneTransform transform_;      ///< of the picture and, beside it, nothing for a reach
  std::vector<double> transfer_;  ///< of the kernel
};

}  // namespace pitviper
