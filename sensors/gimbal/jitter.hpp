#pragma once
// Jitter of a line of sight by its spectrum: what stabilisation leaves. A function of time alone, the same whatever was asked before.
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string_view>
#include <vector>

namespace pitviper {

/// One axis: a table, or an rms with a corner frequency. Densities are one-sided: their integral over positive frequencies is the variance.
struct AxisJitter {
  struct Point {
    double frequency_Hz = 0.0, density_rad2_Hz = 0.0;
  };
  /// S(f) = 2 rms^2 / (pi fc) / (1 + (f / fc)^2), a first-order Markov process (A. Gelb, ed., "Applied Optimal Estimation", MIT Press 1974, chapter 2), up to
  /// 100 fc, beyond which 0.64 % of the variance would lie: S is raised by as much, so that the rms is what was asked.
  double rms_rad = 0.0;    ///< 0: none
  double corner_Hz = 0.0;  ///< above 0 where there is an rms
  /// Straight between points, 0 beyond the first and the last. Frequencies rise from 0 or more; empty: by rms and corner.
  std::vector<Point> spectrum;
};

struct Jitter {
  AxisJitter left, up;  ///< in the camera's axes
};

/// Errors: std::invalid_argument for a table that does not rise or holds what is negative or no number, an rms without a corner, both at once.
void requireSound(const AxisJitter& jitter);
/// Integral of the density [rad^2].
double variance_rad2(const AxisJitter& jitter);
/// Of frequencies below `frequency_Hz`.
double varianceBelow_rad2(const AxisJitter& jitter, double frequency_Hz);

/// A course with these spectra: 256 cosines an axis with random phases. Source: M. Shinozuka and C.-M. Jan, "Digital simulation of random processes and its
/// applications", J. Sound Vib. 25, 111 (1972); frequencies are drawn within their bins, so that it has no period. The bins share
/// half by variance and half by the logarithm of frequency, and each cosine has its bin's variance: the mean square over a long time is the integral of the
/// spectrum, and its distribution nears a normal one.
/// Numbers are counted, of (seed, camera, axis, cosine): splitmix64 (G. L. Steele et al., "Fast splittable pseudorandom number generators", OOPSLA 2014).
class JitterCourse {
 public:
  JitterCourse() = default;
  JitterCourse(const Jitter& jitter, std::uint64_t seed, std::string_view camera);
  /// Left, up [rad].
  glm::dvec2 at(double time_s) const;

 private:
  struct Wave {
    double frequency_Hz, amplitude_rad, phase_turns;
  };
  std::array<std::vector<Wave>, 2> waves_;
};

}  // namespace pitviper
