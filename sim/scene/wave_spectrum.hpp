#pragma once
// Waves that the wind raises on deep water: how their heights and slopes are spread over wavenumbers and directions.

namespace pitviper {

/// Gravity [m/s2] and, of clean water, the wavenumber [rad/m] and speed [m/s] of the slowest waves: k_m = 2 g / c_m^2.
constexpr double kWaveGravity_m_s2 = 9.81;
constexpr double kSlowestSpeed_m_s = 0.23;
constexpr double kSlowestWave_rad_m = 2.0 * kWaveGravity_m_s2 / (kSlowestSpeed_m_s * kSlowestSpeed_m_s);

/// Angular frequency [rad/s] of a wave: omega^2 = g k (1 + (k / k_m)^2), gravity and surface tension, deep water (depth above half a wavelength).
double waveFrequency_rad_s(double k_rad_m);
/// omega / k [m/s].
double phaseSpeed_m_s(double k_rad_m);

/// Variances that waves between two wavenumbers add.
struct WaveMoments {
  double height_m2 = 0.0;
  double slopeUp = 0.0, slopeCross = 0.0;  ///< mean square slopes along the wind and across it
  double slope() const { return slopeUp + slopeCross; }
};

/// The unified directional spectrum: Psi(k, phi) = S(k) (1 + Delta(k) cos 2 phi) / (2 pi k) [m4], phi from the wind,
///   S = (B_l + B_h) / k^3 [m3]: B_l long waves (JONSWAP's peak, Phillips's equilibrium range), B_h short ones up to capillary waves.
/// Psi is alike in opposite directions: it is of a picture at one time. Its integral over k dk dphi is the variance of the height.
/// Source: T. Elfouhaily, B. Chapron, K. Katsaros, D. Vandemark, J. Geophys. Res. 102, 15781 (1997), equations 30 to 34, 40 to 44, 49, 57 to 60; both
///   parts carry the peak's shape L_pm J_p, as C. D. Mobley's Ocean Optics Web Book writes them.
/// Valid: winds of 2 to 25 m/s, inverse wave ages of 0.84 (fully developed) to 5 (young); below 2 m/s there are hardly any short waves in it, at 0 none.
class WaveSpectrum {
 public:
  /// Wind 10 m above the sea [m/s]; inverse wave age, wind over the speed of the highest waves. std::invalid_argument outside 0 to 40 m/s, 0.84 to 5.
  explicit WaveSpectrum(double wind10_m_s, double inverseWaveAge = kFullyDeveloped);
  static constexpr double kFullyDeveloped = 0.84;
  /// Of a wind that has blown over so much open water [m]: 0.84 tanh((x g / (2.2e4 U^2))^0.4)^-0.75, at most 5. Source: as above, equation 37.
  static double inverseWaveAgeOf(double wind10_m_s, double fetch_m);

  /// B = k^3 S, without dimension.
  double curvature(double k_rad_m) const;
  /// S [m3].
  double omnidirectional(double k_rad_m) const;
  /// Delta, from 0 (alike in all directions) to 1.
  double spread(double k_rad_m) const;
  /// Psi [m4] at an angle from the wind.
  double directional(double k_rad_m, double phi_rad) const;

  /// Between two wavenumbers [rad/m]; relative error 1e-6. Everything: from 0 to kShortest_rad_m.
  WaveMoments moments(double low_rad_m, double high_rad_m) const;
  WaveMoments moments() const { return moments(0.0, kShortest_rad_m); }
  static constexpr double kShortest_rad_m = 2e4;  ///< waves of 0.3 mm: beyond, viscosity leaves nothing
  /// Four times the root of the height's variance.
  double significantHeight_m() const;
  double peak_rad_m() const { return peak_rad_m_; }
  /// Of the wind, u* = 0.4 U / ln(10 m / z0), z0 = 3.7e-5 U^2 / g Omega^0.9. Source: M. A. Donelan et al., J. Phys. Oceanogr. 23, 2143 (1993).
  double frictionVelocity_m_s() const { return friction_m_s_; }

 private:
  double friction_m_s_ = 0.0, age_, peak_rad_m_ = 0.0, peakSpeed_m_s_ = 0.0, longPart_ = 0.0, shortPart_ = 0.0, enhanced_ = 1.0, width_ = 0.0;
};

/// Mean square slopes of a clean sea by its glitter, wind 12.5 m above it, 1 to 14 m/s; they scatter by 0.004 (up) and 0.002 (across), 0.004 in sum.
/// Source: C. Cox and W. Munk, J. Opt. Soc. Am. 44, 838 (1954).
WaveMoments coxMunkSlopes(double wind12_m_s);

}  // namespace pitviper
