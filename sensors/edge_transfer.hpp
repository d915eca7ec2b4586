#pragma once
// Contrast from the picture of a slanted edge.
#include <cstddef>
#include <vector>

namespace pitviper {

/// MTF across an edge that runs from the top to the bottom of a picture, a few degrees off its columns: frequencies [cycles a pixel] and contrast from 0 to 1.
/// Source: ISO 12233:2017, annex D (rows' centroids, a line through them, four bins a pixel, derivative, Hamming's window, Fourier), the derivative's and the
/// bins' own losses taken out. Errors: std::invalid_argument where there is no such edge.
struct EdgeTransfer {
  std::vector<double> frequency, contrast;
  double slope = 0.0;  ///< columns a row
  double at(double frequency) const;
};
EdgeTransfer edgeTransfer(const std::vector<double>& picture, std::size_t width, std::size_t height);

}  // namespace pitviper
