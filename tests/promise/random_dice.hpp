#pragma once
// Random numbers by counter: the same on every machine, which the standard's distributions are not.
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace pitviper::test {

class RandomDice {
 public:
  explicit RandomDice(std::uint64_t seed, std::uint64_t stream = 0) : key_(mix(seed + mix(stream + 1))) {}
  /// In [0, 1).
  double unit() { return static_cast<double>(mix(key_ + kStep * ++count_) >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// Even in its logarithm.
  double byFactor(double low, double high) { return low * std::exp(std::log(high / low) * unit()); }
  bool chance(double share) { return unit() < share; }
  int below(int count) { return static_cast<int>(unit() * count); }
  /// 0, 1, 2 ... as often as the weights say.
  int weighted(std::initializer_list<double> weights) {
    double sum = 0.0;
    for (double w : weights) sum += w;
    double at = unit() * sum;
    int k = 0;
    for (double w : weights) {
      if (at < w) return k;
      at -= w;
      ++k;
    }
    return static_cast<int>(weights.size()) - 1;
  }
  template <class Array>
  auto of(const Array& all) {
    return all[static_cast<std::size_t>(below(static_cast<int>(std::size(all))))];
  }

 private:
  /// Finalizer and increment of SplitMix64 (Steele, Lea and Flood 2014).
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t key_, count_ = 0;
};

}  // namespace pitviper::test
