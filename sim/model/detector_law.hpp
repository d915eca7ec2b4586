#pragma once
// How a detector makes counts of photoelectrons, as a scenario asks for it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace pitviper {

/// Why a pixel's count says nothing: as many electrons as its well holds or the converter's highest code, its lowest code, a bad pixel.
enum class CountMark : std::uint8_t { None = 0, Full = 1, Lowest = 2, Bad = 3 };

/// What temperatures and signals to noise are where a count says nothing: no number, or that of what just fills the pixel.
enum class WhereUnread { Nan, Limit };

/// How `display` maps counts to the 256 codes of a screen: for people only.
enum class Agc { Fixed, Linear, Plateau };

/// Fixed: the converter's whole range. Linear, Plateau: automatic gain (sensors/display_codes.hpp).
struct DisplayLaw {
  Agc agc = Agc::Linear;
  double tails = 0.005;             ///< share of the pixels at either end that the picture's range passes over
  double plateau = 0.02;            ///< share of the pixels beyond which a count weighs no more
  double linear = 0.2;              ///< Plateau: share of the codes that go evenly over the picture's range
  double most_codesPerCount = 0.0;  ///< 0: that with which noise from frame to frame is kNoise_codes
  static constexpr double kNoise_codes = 4.0;
};

/// count = round(gain x min(well, electrons) + offset), 0 to 2^bits - 1. Noises are standard deviations [electron], named as in EMVA 1288 and in the
/// three-dimensional noise model (t: from frame to frame, v: from row to row, h: from column to column).
struct DetectorLaw {
  double fillFactor = 1.0;
  double darkCurrent_per_s = 0.0;  ///< [electron/s]
  double fullWell = 1e6;           ///< [electron]
  double gain = 0.01;              ///< [count/electron]
  double offset = 0.0;             ///< [count]
  int bits = 14;
  double sigmaTvh = 0.0, sigmaTv = 0.0, sigmaTh = 0.0, sigmaT = 0.0;  ///< temporal: read and reset noise, of rows, of columns, of the frame
  /// A NETD that it was designed for, from which sigmaTvh follows; none: it was given.
  struct Netd {
    double value_K = 0.0, at_K = 300.0;
  };
  std::optional<Netd> netd = {};
  double flickerCorner_Hz = 0.0;                                     ///< where 1/f noise is as dense as sigmaTvh; 0: none
  double sigmaVh = 0.0, sigmaV = 0.0, sigmaH = 0.0;                   ///< fixed: of pixels (DSNU), rows, columns
  double prnu = 0.0;                                                  ///< of the response, relative
  double nonlinearity = 0.0;                                          ///< of pixels' own bends, rms at a full well, relative
  double badPixels = 0.0;                                             ///< share that is dead or hot, half and half
  int badTogether = 1;                                                ///< so many side by side
  double crosstalk = 0.0;                                             ///< of a pixel's photoelectrons, to each of the four beside it
  double lag = 0.0;                                                   ///< of a frame's signal that is left in the next
  double timeConstant_s = 0.0;                                        ///< of a bolometer's warming; 0: none
  double lineTime_s = 0.0;                                            ///< a row is exposed so much later than the one above it; 0: all at once
  /// Two-point correction at time 0: offsets and gains of pixels, learnt from black bodies by averages over frames.
  struct Correction {
    double low_K = 290.0, high_K = 310.0;
    int frames = 64;
  };
  std::optional<Correction> correction = {};
  double offsetDrift_per_s = 0.0;  ///< rms over pixels, in electrons a second since time 0
  double gainDrift_per_s = 0.0;    ///< the same, relative
  DisplayLaw display = {};
  WhereUnread unread = WhereUnread::Nan;
  static constexpr int kFlickerOctaves = 12;
  /// Of 1/f noise, in one octave of frequencies, at so many seconds from frame to frame [electron^2]: 2 sigma^2 (f_c / f_s) ln 2.
  double flickerVariance(double step_s) const { return 2.0 * sigmaTvh * sigmaTvh * flickerCorner_Hz * step_s * std::log(2.0); }
  /// Of read-out from frame to frame, 1/f noise and the converter's steps included [electron^2].
  double readoutVariance(double step_s) const {
    return sigmaTvh * sigmaTvh + sigmaTv * sigmaTv + sigmaTh * sigmaTh + sigmaT * sigmaT + kFlickerOctaves * flickerVariance(step_s) +
           1.0 / (12.0 * gain * gain);
  }
  double mostCount() const { return static_cast<double>((1 << bits) - 1); }
  /// Electrons at which it no longer tells: the well is full, or the highest count. `factor`: of its gain.
  double saturation(double factor = 1.0) const { return std::min(fullWell, (mostCount() - offset) / (gain * factor)); }
};

}  // namespace pitviper
