#include "sim/stream/clock/durations.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {

void Durations::add(std::int64_t d) {
  if (bins_.empty()) bins_.resize(static_cast<std::size_t>(kBinsOfOctave) * kOctaves);
  least_ = count_ ? std::min(least_, d) : d;
  most_ = count_ ? std::max(most_, d) : d;
  ++count_;
  // Welford: sums of squares of nanoseconds would lose their digits.
  const double x = static_cast<double>(d), off = x - mean_;
  mean_ += off / static_cast<double>(count_);
  squares_ += off * (x - mean_);
  const double place = d > 0 ? std::log2(x) * kBinsOfOctave : 0.0;
  ++bins_[std::min(static_cast<std::size_t>(place), bins_.size() - 1)];
}

double Durations::deviation_ns() const { return count_ > 1 ? std::sqrt(squares_ / static_cast<double>(count_ - 1)) : 0.0; }

double Durations::quantile_ns(double share) const {
  if (count_ == 0) return 0.0;
  const double wanted = share * static_cast<double>(count_);
  double below = 0.0;
  for (std::size_t b = 0; b < bins_.size(); ++b) {
    below += static_cast<double>(bins_[b]);
    if (below >= wanted && bins_[b] > 0)
      return std::clamp(std::exp2((static_cast<double>(b) + 0.5) / kBinsOfOctave), static_cast<double>(least_), static_cast<double>(most_));
  }
  return static_cast<double>(most_);
}

void LongCourse::add(double value) {
  if (pieces_.empty() || pieces_.back().count == length_) {
    if (pieces_.size() == kMost) {
      for (std::size_t k = 0; 2 * k < pieces_.size(); ++k) {
        const Piece &a = pieces_[2 * k], &b = pieces_[2 * k + 1];
        pieces_[k] = {a.sum + b.sum, std::max(a.most, b.most), a.count + b.count};
      }
      pieces_.resize(kMost / 2);
      length_ *= 2;
    }
    pieces_.emplace_back();
  }
  Piece& p = pieces_.back();
  p.most = p.count ? std::max(p.most, value) : value;
  p.sum += value;
  ++p.count;
}

}  // namespace pitviper
