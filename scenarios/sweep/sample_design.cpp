#include "scenarios/sweep/sample_design.hpp"

#include <bit>
#include <cmath>
#include <numeric>

#include "sensors/noise_source.hpp"

namespace pitviper {
namespace {

/// What a number is for.
enum class DrawnFor : std::uint32_t { Point, Stratum, Order, Shift, Seed };

std::uint64_t randomBits(std::uint64_t seed, DrawnFor what, std::uint32_t sample, std::size_t factor = 0, int attempt = 0) {
  const auto bits = philox({sample, static_cast<std::uint32_t>(factor), static_cast<std::uint32_t>(attempt), static_cast<std::uint32_t>(what)},
                           {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return (std::uint64_t{bits[0]} << 32) | bits[1];
}

/// In (0, 1), of 52 bits: with 53 the last would round to 1.
double fractionOf(std::uint64_t bits) { return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52; }

/// Fisher and Yates' shuffle. Source: R. Durstenfeld, Comm. ACM 7, 420 (1964).
std::vector<std::uint32_t> shuffled(int count, std::uint64_t seed, std::size_t factor) {
  std::vector<std::uint32_t> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = order.size(); i-- > 1;) {
    const double u = fractionOf(randomBits(seed, DrawnFor::Order, static_cast<std::uint32_t>(i), factor));
    std::swap(order[i], order[static_cast<std::size_t>(u * static_cast<double>(i + 1))]);
  }
  return order;
}

}  // namespace

SampleDesign::SampleDesign(Design kind, std::uint64_t seed, int samples, std::size_t factors)
    : kind_(kind), seed_(seed), factors_(factors), size_(samples), strata_(samples) {
  if (kind == Design::LatinHypercube)
    for (std::size_t f = 0; f < factors; ++f) orders_.push_back(shuffled(samples, seed, f));
  if (kind == Design::Sobol) sequence_ = std::make_unique<const SobolSequence>(factors);
  if (kind == Design::SobolIndices) {
    sequence_ = std::make_unique<const SobolSequence>(2 * factors);
    size_ *= static_cast<long long>(factors) + 2;
  }
}

SampleDesign::SampleDesign(std::vector<int> levels) : kind_(Design::Grid), factors_(levels.size()), size_(1), levels_(std::move(levels)) {
  for (int count : levels_) size_ *= count;
}

std::vector<double> SampleDesign::sobolPoint(std::uint32_t number, std::size_t first) const {
  std::vector<double> u;
  for (std::size_t d = first; d < first + factors_; ++d) u.push_back(fractionOf(sequence_->bits(number, d) ^ randomBits(seed_, DrawnFor::Shift, 0, d)));
  return u;
}

std::vector<double> SampleDesign::point(int number, int attempt) const {
  const auto n = static_cast<std::uint32_t>(number);
  std::vector<double> u;
  switch (kind_) {
    case Design::Random:
      for (std::size_t f = 0; f < factors_; ++f) u.push_back(fractionOf(randomBits(seed_, DrawnFor::Point, n, f, attempt)));
      break;
    case Design::LatinHypercube: {
      // As many places within a stratum as leave it in its stratum after all rounding.
      const double places = std::ldexp(1.0, 50 - std::bit_width(static_cast<unsigned>(strata_)));
      for (std::size_t f = 0; f < factors_; ++f) {
        const double within = (std::floor(fractionOf(randomBits(seed_, DrawnFor::Stratum, n, f)) * places) + 0.5) / places;
        u.push_back((orders_[f][n] + within) / strata_);
      }
      break;
    }
    case Design::Sobol:
      return sobolPoint(n, 0);
    case Design::SobolIndices: {
      const auto [base, matrix] = saltelliRow(number, factors_);
      const auto m = static_cast<std::size_t>(matrix);
      if (m == factors_ + 1) return sobolPoint(static_cast<std::uint32_t>(base), factors_);
      u = sobolPoint(static_cast<std::uint32_t>(base), 0);
      if (m > 0) u[m - 1] = sobolPoint(static_cast<std::uint32_t>(base), factors_)[m - 1];
      break;
    }
    case Design::Grid: {
      u.resize(factors_);
      int rest = number;
      for (std::size_t f = factors_; f-- > 0; rest /= levels_[f]) u[f] = (rest % levels_[f] + 0.5) / levels_[f];
      break;
    }
    case Design::Table:
      break;  // its points are in its file
  }
  return u;
}

SaltelliRow saltelliRow(int sample, std::size_t factors) {
  const int d = static_cast<int>(factors), place = sample % (d + 2);
  return {sample / (d + 2), place == 0 ? 0 : place == 1 ? d + 1 : place - 1};
}

std::uint64_t sampleSeed(std::uint64_t sweepSeed, int sample) { return randomBits(sweepSeed, DrawnFor::Seed, static_cast<std::uint32_t>(sample)) >> 11; }

}  // namespace pitviper
