#include "sensors/flicker_noise.hpp"

#include "sensors/side_by_side.hpp"

namespace pitviper {
namespace {

long long floorOf(long long a, long long b) { return a / b - (a % b < 0 ? 1 : 0); }

int setOf(std::size_t pixel) { return static_cast<int>((static_cast<std::uint32_t>(pixel) * 2654435761u) >> 28); }  // Fibonacci hashing

}  // namespace

const std::vector<float>& FlickerNoise::at(int frame) {
  const bool isNew = octaves_.empty();
  if (isNew) octaves_.assign(kOctaves, std::vector<float>(pixels_)), sum_.resize(pixels_);
  for (int k = 0; k < kOctaves; ++k) {
    const long long length = 1LL << k;
    std::array<bool, kSets> changed{};
    bool any = false;
    for (int s = 0; s < kSets; ++s) {
      const long long block = floorOf(frame + length * s / kSets, length);
      changed[static_cast<std::size_t>(s)] = isNew || block != block_[static_cast<std::size_t>(k)][static_cast<std::size_t>(s)];
      any |= changed[static_cast<std::size_t>(s)];
      block_[static_cast<std::size_t>(k)][static_cast<std::size_t>(s)] = block;
    }
    if (!any) continue;
    sideBySide(static_cast<int>(pixels_), [&](int first, int last) {
      for (int p = first; p < last; ++p) {
        const auto s = static_cast<std::size_t>(setOf(static_cast<std::size_t>(p)));
        if (!changed[s]) continue;
        const NoiseSource source(seed_, channel_, static_cast<std::uint32_t>(block_[static_cast<std::size_t>(k)][s]), NoiseEffect::Flicker);
        octaves_[static_cast<std::size_t>(k)][static_cast<std::size_t>(p)] =
            static_cast<float>(source.normal(static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(k)));
      }
    });
  }
  sideBySide(static_cast<int>(pixels_), [&](int first, int last) {
    for (auto p = static_cast<std::size_t>(first); p < static_cast<std::size_t>(last); ++p) {
      float sum = 0.0f;
      for (const auto& octave : octaves_) sum += octave[p];
      sum_[p] = sum;
    }
  });
  return sum_;
}

}  // namespace pitviper
