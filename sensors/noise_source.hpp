#pragma once
// Random numbers by counter: what one is depends on what it is for alone, (seed, frame, effect, place), never on what else was drawn.
// Philox 4x32-10. Source: J. K. Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC'11, with its constants.
#include <array>
#include <cstdint>
#include <span>

namespace pitviper {

/// What a number is for.
enum class NoiseEffect : std::uint32_t {
  Shot,
  Read,
  Row,
  Column,
  Frame,
  FixedPixel,
  FixedRow,
  FixedColumn,
  Gain,
  BadPixel,
  Flicker,
  Bend,
  OffsetDrift,
  GainDrift,
  Correction
};

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// Of a uniform number in (0, 1): the normal one that as many lie below. Source: M. J. Wichura, Applied Statistics 37, 477 (1988), AS 241, PPND16, good to
/// 1e-15.
double normalQuantile(double u);
/// The same of each, in place: same bits, several at a time.
void normalQuantiles(std::span<double> u);

class NoiseSource {
 public:
  /// `channel`: below 2^24, of several of one camera; `frame` 0 for what is fixed.
  NoiseSource(std::uint64_t seed, std::uint32_t channel, std::uint32_t frame, NoiseEffect effect)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        frame_(frame),
        effect_(static_cast<std::uint32_t>(effect) | (channel << 8)) {}
  /// In (0, 1), the `draw`-th of a place.
  double uniform(std::uint32_t place, std::uint32_t draw = 0) const;
  /// Of mean 0 and variance 1 (Box and Muller).
  double normal(std::uint32_t place, std::uint32_t draw = 0) const;
  /// Counts of independent events of this mean. Up to 1e4 exactly distributed (inversion below 10; above, transformed rejection: W. Hoermann,
  /// Insurance: Mathematics and Economics 12, 39 (1993), PTRS), beyond by normal numbers bent to the same skewness (Cornish and Fisher 1938): the fourth
  /// cumulant, 1e-4 of the square of the second, is what they lack.
  double poisson(double mean, std::uint32_t place) const;
  /// The same, and beside it a normal number of its own, for one that both are wanted of.
  struct Drawn {
    double count, normal;
  };
  Drawn poissonAndNormal(double mean, std::uint32_t place) const;
  /// The same of places on end from `first` on: same bits, several at a time. `mean` becomes the counts. Both have as many.
  void poissonAndNormal(std::uint32_t first, std::span<double> mean, std::span<double> normal) const;

 private:
  std::array<double, 2> pair(std::uint32_t place, std::uint32_t draw) const;
  std::array<std::uint32_t, 2> key_;
  std::uint32_t frame_, effect_;
};

}  // namespace pitviper
