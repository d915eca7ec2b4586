#include "materials/fields/gas_levels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kBands = std::size(kLevelBands_um);
constexpr int kPoints = 150;      // of a band: samples of its curves of growth, whose order within 25 1/cm is mixed
constexpr double kStep_K = 25.0;  // between temperatures looked at
constexpr double kAir_K = 288.15;
constexpr double kSpread[] = {0.8, 1.5, 2.5};  // a jet's mixture lies over its excess of temperature as about that power of its inverse

/// What each level sends more than the air does, by way a jet's gas is spread over temperature and by band, from one of its temperatures.
using Sent = std::array<std::array<double, kBands>, std::size(kSpread)>;

Sent sentAt(const Spectrum& absorption, double temperature_K) {
  Sent sent{};
  for (std::size_t b = 0; b < kBands; ++b) {
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double um = kLevelBands_um[b][0] + (kLevelBands_um[b][1] - kLevelBands_um[b][0]) * (i + 0.5) / kPoints;
      sum += absorption(um) * (physics::planckRadiance(um, temperature_K) - physics::planckRadiance(um, kAir_K));
    }
    for (std::size_t s = 0; s < sent.size(); ++s) sent[s][b] = sum * std::pow(temperature_K - kAir_K, -kSpread[s]);
  }
  return sent;
}

}  // namespace

GasLevels gasLevels(const SpeciesTable& table, double low_K, double high_K, double error) {
  const auto& t = table.temperature_K;
  std::size_t first = 0, last = t.size() - 1;
  while (first + 1 < t.size() && t[first + 1] <= low_K) ++first;
  while (last > first && t[last - 1] >= high_K) --last;
  std::vector<std::size_t> levels;
  for (std::size_t i = first; i <= last; ++i) levels.push_back(i);
  if (levels.size() < 3) return {levels, 0.0};

  std::vector<double> temperature_K;
  for (double k = std::max(t[first], kAir_K) + kStep_K; k <= std::min(t[last], high_K); k += kStep_K) temperature_K.push_back(k);
  std::vector<std::vector<Sent>> sent;
  for (double k : temperature_K) {
    sent.emplace_back();
    for (std::size_t l : levels) sent.back().push_back(sentAt(table.absorption[l], k));
  }
  const auto sumOf = [&](std::uint32_t chosen) {
    Sent sum{};
    for (std::size_t k = 0; k < temperature_K.size(); ++k) {
      std::size_t low = 0, high = levels.size() - 1;
      for (std::size_t l = 0; l < levels.size(); ++l) {
        if (!(chosen >> l & 1u)) continue;
        if (t[levels[l]] <= temperature_K[k]) low = l;
        else high = std::min(high, l);
      }
      const double part = low == high ? 0.0 : std::clamp((temperature_K[k] - t[levels[low]]) / (t[levels[high]] - t[levels[low]]), 0.0, 1.0);
      for (std::size_t s = 0; s < sum.size(); ++s)
        for (std::size_t b = 0; b < kBands; ++b) sum[s][b] += (1.0 - part) * sent[k][low][s][b] + part * sent[k][high][s][b];
    }
    return sum;
  };
  const std::uint32_t all = (1u << levels.size()) - 1u, ends = 1u | 1u << (levels.size() - 1);
  const Sent whole = sumOf(all);
  for (std::size_t count = 2; count < levels.size(); ++count) {
    double least = 1e300;
    std::uint32_t best = all;
    for (std::uint32_t chosen = ends; chosen <= all; ++chosen) {
      if ((chosen & ends) != ends || static_cast<std::size_t>(std::popcount(chosen)) != count) continue;
      const Sent sum = sumOf(chosen);
      double worst = 0.0;
      for (std::size_t s = 0; s < whole.size(); ++s)
        for (std::size_t b = 0; b < kBands; ++b)
          if (whole[s][b] > 0.0) worst = std::max(worst, std::abs(sum[s][b] / whole[s][b] - 1.0));
      if (worst < least) least = worst, best = chosen;
    }
    if (least > error) continue;
    GasLevels result{{}, least};
    for (std::size_t l = 0; l < levels.size(); ++l)
      if (best >> l & 1u) result.level.push_back(levels[l]);
    return result;
  }
  return {levels, 0.0};
}

}  // namespace pitviper
