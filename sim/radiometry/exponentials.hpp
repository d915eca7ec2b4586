#pragma once
// exp of many numbers at once, in vectors as wide as the machine has: number by number the same operations, so that all machines give the same bits.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "sim/radiometry/wide_loops.hpp"

namespace pitviper {

/// exp(x) to 1e-14 of it, x up to 700; below -700 as at -700.
void exponentials(double* x, int count);

/// Its body, for loops that are compiled for wide vectors themselves (PITVIPER_WIDE).
namespace wide {

constexpr int kLanes = 4;
using Reals = double __attribute__((vector_size(kLanes * sizeof(double))));
using Wholes = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

// 2^n e^r, n the nearest to x / ln 2, e^r by its series: r is at most 0.347, the twelfth power of which by 12! is 6e-15.
inline __attribute__((always_inline)) void fourExponentials(double* at) {
  constexpr double kPerLn2 = 1.4426950408889634, kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  constexpr double kRound = 6755399441055744.0;  // 1.5 x 2^52: what is added to it loses its fraction
  Reals x;
  std::memcpy(&x, at, sizeof x);
  const Reals least = Reals{} - 700.0;
  x = x < least ? least : x;  // what is no number stays none
  const Reals rounded = x * kPerLn2 + kRound, n = rounded - kRound, r = (x - n * kLn2High) - n * kLn2Low;
  Reals e = r * (1.0 / 39916800.0) + 1.0 / 3628800.0;
  e = e * r + 1.0 / 362880.0;
  e = e * r + 1.0 / 40320.0;
  e = e * r + 1.0 / 5040.0;
  e = e * r + 1.0 / 720.0;
  e = e * r + 1.0 / 120.0;
  e = e * r + 1.0 / 24.0;
  e = e * r + 1.0 / 6.0;
  e = e * r + 0.5;
  e = e * r + 1.0;
  e = e * r + 1.0;
  Wholes bits;
  std::memcpy(&bits, &rounded, sizeof bits);
  bits = (bits + 1023) << 52;
  Reals power;
  std::memcpy(&power, &bits, sizeof power);
  e *= power;
  std::memcpy(at, &e, sizeof e);
}

inline __attribute__((always_inline)) void exponential(double* x, int count) {
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) fourExponentials(x + i);
  if (i == count) return;
  double rest[kLanes] = {};
  std::copy(x + i, x + count, rest);
  fourExponentials(rest);
  std::copy(rest, rest + count - i, x + i);
}

}  // namespace wide
}  // namespace pitviper
