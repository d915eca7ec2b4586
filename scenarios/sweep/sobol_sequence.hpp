#pragma once
// Sobol's sequence, any point of it by its number.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pitviper {

/// Of numbers below 2^24, in at most 3667 dimensions. Source: S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. 30, 2635 (2008), their direction numbers; in the
/// order of Gray's code (I. A. Antonov and V. M. Saleev, USSR Comput. Math. Math. Phys. 19, 252 (1980)).
class SobolSequence {
 public:
  static constexpr int kBits = 24;
  explicit SobolSequence(std::size_t dimensions);
  /// The fraction's 64 bits behind the binary point. Point 0 is the origin.
  std::uint64_t bits(std::uint32_t number, std::size_t dimension) const;

 private:
  std::size_t dimensions_;
  std::vector<std::uint64_t> directions_;  ///< [bit][dimension]
};

}  // namespace pitviper
