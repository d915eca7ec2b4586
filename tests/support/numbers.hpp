#pragma once
// Even random numbers for tests: the same ones for the same seed, whatever the standard library.
#include <random>

namespace pitviper::test {

class Numbers {
 public:
  explicit Numbers(unsigned long long seed) : engine_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace pitviper::test
