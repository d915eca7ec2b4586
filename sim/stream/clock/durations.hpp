#pragma once
// Durations of a run, however long it is, in a memory that does not grow: mean and deviation exactly, quantiles to a hundredth of themselves.
#include <array>
#include <cstdint>
#include <vector>

namespace pitviper {

class Durations {
 public:
  /// Below 0 counts as 0 in quantiles.
  void add(std::int64_t duration_ns);
  std::uint64_t count() const { return count_; }
  double mean_ns() const { return mean_; }
  double deviation_ns() const;  ///< standard
  double least_ns() const { return count_ ? static_cast<double>(least_) : 0.0; }
  double most_ns() const { return count_ ? static_cast<double>(most_) : 0.0; }
  /// `share`: 0.5 the median. 0 of none.
  double quantile_ns(double share) const;

 private:
  static constexpr int kBinsOfOctave = 128, kOctaves = 44;
  std::uint64_t count_ = 0;
  double mean_ = 0.0, squares_ = 0.0;
  std::int64_t least_ = 0, most_ = 0;
  std::vector<std::uint64_t> bins_;  ///< each a hundredth of an octave and a bit wide
};

/// How something went over a run: means and maxima of pieces of equal length, which double where there would be too many.
class LongCourse {
 public:
  void add(double value);
  struct Piece {
    double sum = 0.0, most = 0.0;
    std::uint64_t count = 0;
  };
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  static constexpr std::size_t kMost = 512;
  std::uint64_t length_ = 1;
  std::vector<Piece> pieces_;
};

}  // namespace pitviper
