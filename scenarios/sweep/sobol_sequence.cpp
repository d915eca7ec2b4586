#include "scenarios/sweep/sobol_sequence.hpp"

#include <boost/random/sobol.hpp>

namespace pitviper {

SobolSequence::SobolSequence(std::size_t dimensions) : dimensions_(dimensions) {
  boost::random::sobol points(dimensions);
  // Point 2^(b + 1) - 1 has Gray's code 2^b and is direction b; the engine counts from point 1.
  for (int b = 0; b < kBits; ++b) {
    points.seed((std::uint64_t{2} << b) - 2);
    for (std::size_t d = 0; d < dimensions; ++d) directions_.push_back(points());
  }
}

std::uint64_t SobolSequence::bits(std::uint32_t number, std::size_t dimension) const {
  std::uint64_t fraction = 0;
  std::uint32_t code = number ^ (number >> 1);
  for (std::size_t b = 0; code != 0; ++b, code >>= 1)
    if (code & 1u) fraction ^= directions_[b * dimensions_ + dimension];
  return fraction;
}

}  // namespace pitviper
