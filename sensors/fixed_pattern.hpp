#pragma once
// What the pixels of a detector have of their own: response, dark signal, bend, drift, and what a two-point correction leaves of them.
#include <cstdint>
#include <vector>

#include "sim/model/detector_law.hpp"

namespace pitviper {

/// Row by row. A pixel that gets S electrons by an ideal one's response says, before temporal noise and at time t,
///   (1 + p + p' t) S + d + d' t + q S^2 / W,
/// p: PRNU, d: DSNU with its row and column, q: its bend (rms at a full well W), p', d': drifts.
struct FixedPattern {
  std::vector<float> response;             ///< 1 + p
  std::vector<float> dark;                 ///< d [electron]
  std::vector<float> bend;                 ///< q / W [1/electron]; empty: none
  std::vector<float> gainDrift, darkDrift;  ///< p' [1/s], d' [electron/s]; empty: none
  std::vector<std::uint8_t> bad;           ///< 1: dead, 2: hot
  std::vector<float> gain, offset;         ///< of the correction: corrected = gain x said + offset [electron]; empty: none
};

FixedPattern fixedPattern(const DetectorLaw& law, std::uint64_t seed, std::uint32_t channel, int width, int height);

/// Two-point correction at time 0, pixel by pixel, from black bodies that give `low` and `high` electrons: said values there, averaged over the law's frames
/// with their temporal noise (`lowNoise`, `highNoise`: rms of a frame), become those. Source: D. L. Perry and E. L. Dereniak, Opt. Eng. 32, 1854 (1993): what
/// is left is 0 at both points but for that noise, and between and beyond them what bends leave.
void learnCorrection(FixedPattern& pattern, const DetectorLaw& law, std::uint64_t seed, std::uint32_t channel, double low, double high, double lowNoise,
                     double highNoise);

}  // namespace pitviper
