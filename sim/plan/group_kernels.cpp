#include "sim/plan/group_kernels.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

// Each of these is compiled for wide vectors too, without contracted sums of products: bytes are the same.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__)
#define PITVIPER_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define PITVIPER_WIDE
#endif

namespace pitviper {
namespace {

/// Lanes that are summed at once.
constexpr int kLanes = 4;
/// Paths between depths and their exponentials: they stay in the first cache.
constexpr int kBlock = 128;

template <int kWidth>
inline __attribute__((always_inline)) void depths(const SparseAmounts& a, int from, int to, const double* extinction, int groups, double* into) {
  for (int p = from; p < to; ++p, into += groups) {
    const int begin = a.first[static_cast<std::size_t>(p)], end = a.first[static_cast<std::size_t>(p) + 1];
    for (int g = 0; g < groups; g += kWidth) {
      const double* own = extinction + g;
      double sum[kWidth] = {};
      for (int n = begin; n < end; ++n) {
        const double amount = a.amount[static_cast<std::size_t>(n)];
        const double* c = own + a.column[static_cast<std::size_t>(n)] * static_cast<std::ptrdiff_t>(groups);
        for (int l = 0; l < kWidth; ++l) sum[l] -= amount * c[l];
      }
      for (int l = 0; l < kWidth; ++l) into[g + l] = sum[l];
    }
  }
}

using Reals = double __attribute__((vector_size(kLanes * sizeof(double))));
using Wholes = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

// 2^n e^r, n the nearest to x / ln 2, e^r by its series: r is at most 0.347, the twelfth power of which by 12! is 6e-15.
inline __attribute__((always_inline)) void fourExponentials(double* at) {
  constexpr double kPerLn2 = 1.4426950408889634, kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  constexpr double kRound = 6755399441055744.0;  // 1.5 x 2^52: what is added to it loses its fraction
  Reals x;
  std::memcpy(&x, at, sizeof x);
  const Reals least = Reals{} - 700.0;
  x = x > least ? x : least;
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

template <int kWidth>
inline __attribute__((always_inline)) void sums(const double* share, const double* spectra, int wavelengths, int count, int groups, double* into) {
  for (int s = 0; s < count; ++s, spectra += wavelengths, into += groups)
    for (int g = 0; g < groups; g += kWidth) {
      double even[kWidth] = {}, odd[kWidth] = {};
      int i = 0;
      for (; i + 1 < wavelengths; i += 2)
        for (int l = 0; l < kWidth; ++l) {
          even[l] += spectra[i] * share[groups * i + g + l];
          odd[l] += spectra[i + 1] * share[groups * (i + 1) + g + l];
        }
      for (; i < wavelengths; ++i)
        for (int l = 0; l < kWidth; ++l) even[l] += spectra[i] * share[groups * i + g + l];
      for (int l = 0; l < kWidth; ++l) into[g + l] = even[l] + odd[l];
    }
}

}  // namespace

int paddedGroups(int groups) { return groups < 3 ? groups : (groups + kLanes - 1) / kLanes * kLanes; }

void SparseAmounts::add(const double* amounts, int columns) {
  for (int k = 0; k < columns; ++k)
    if (amounts[k] != 0.0) column.push_back(k), amount.push_back(amounts[k]);
  first.push_back(static_cast<int>(column.size()));
}

PITVIPER_WIDE void transmittances(const SparseAmounts& amounts, int begin, int end, const double* extinction, int groups, double* into) {
  for (int from = begin; from < end; from += kBlock) {
    const int to = std::min(from + kBlock, end);
    double* block = into + static_cast<std::ptrdiff_t>(groups) * from;
    if (groups % kLanes == 0) depths<kLanes>(amounts, from, to, extinction, groups, block);
    else if (groups % 2 == 0) depths<2>(amounts, from, to, extinction, groups, block);
    else depths<1>(amounts, from, to, extinction, groups, block);
    exponential(block, groups * (to - from));
  }
}

PITVIPER_WIDE void averages(const double* share, const double* spectra, int wavelengths, int count, int groups, double* into) {
  if (groups % kLanes == 0) sums<kLanes>(share, spectra, wavelengths, count, groups, into);
  else if (groups % 2 == 0) sums<2>(share, spectra, wavelengths, count, groups, into);
  else sums<1>(share, spectra, wavelengths, count, groups, into);
}

PITVIPER_WIDE void exponentials(double* x, int count) { exponential(x, count); }

}  // namespace pitviper
