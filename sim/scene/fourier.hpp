#pragma once
// Discrete Fourier sums of powers of two.
#include <complex>
#include <vector>

namespace pitviper {

/// x_n = sum_m X_m exp(+2 pi i m n / N), in place. std::invalid_argument where the size is not a power of two.
void fourierSum(std::vector<std::complex<double>>& values);

/// The same over both axes of a square of `points` x `points`, x fastest.
void fourierSumSquare(std::vector<std::complex<double>>& values, int points);

}  // namespace pitviper
