#include "sim/plan/group_kernels.hpp"

#include <algorithm>

#include "sim/radiometry/exponentials.hpp"

namespace pitviper {
namespace {

using wide::kLanes;
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

// Each of these is compiled for wide vectors too, without contracted sums of products: bytes are the same.
PITVIPER_WIDE void transmittances(const SparseAmounts& amounts, int begin, int end, const double* extinction, int groups, double* into) {
  for (int from = begin; from < end; from += kBlock) {
    const int to = std::min(from + kBlock, end);
    double* block = into + static_cast<std::ptrdiff_t>(groups) * from;
    if (groups % kLanes == 0) depths<kLanes>(amounts, from, to, extinction, groups, block);
    else if (groups % 2 == 0) depths<2>(amounts, from, to, extinction, groups, block);
    else depths<1>(amounts, from, to, extinction, groups, block);
    wide::exponential(block, groups * (to - from));
  }
}

PITVIPER_WIDE void averages(const double* share, const double* spectra, int wavelengths, int count, int groups, double* into) {
  if (groups % kLanes == 0) sums<kLanes>(share, spectra, wavelengths, count, groups, into);
  else if (groups % 2 == 0) sums<2>(share, spectra, wavelengths, count, groups, into);
  else sums<1>(share, spectra, wavelengths, count, groups, into);
}

}  // namespace pitviper
