#pragma once
// The least temperature difference of four bars that an observer at a display resolves (MRTD), over their frequency.
//
// Law, by direction of the modulation (across: bars side by side from left to right), E_a along the modulation, E_b along the bars, E_t over time:
//   noise: (pi^2 / 8) SNR / H(f) sqrt(s_tvh^2 E_t E_a E_b + s_vh^2 E_a E_b + s_th^2 E_t E_a + s_h^2 E_a); of bars one above the other s_tv and s_v instead of
//   s_th and s_h eye:   (pi / 4) 2 S m(f / M) / H(f) MRTD = sqrt(noise^2 + eye^2), up to half a cycle a pixel
// f: cycles/rad; H: lens, pixel and display; s: noise in three dimensions [K]; E_t = min(1, 1 / (rate t_eye)); E of a length w of a bar (1 / (2 f) across, 7 /
// (2 f) along) on pixels of pitch p, each shown as a square: p integral of sinc^2(p x) sinc^2(w x) dx = p / w (1 - p / (3 w)), or 1 - w / (3 p) where p > w; S:
// what the display shows from its mean brightness to black [K]; M: magnification; m: threshold modulation of the eye, of an observer who may step back from
// bars too coarse for it; 4 / pi: of the square wave's first harmonic, 2 / pi: its mean over a bar. Source: noise and its integration by the eye: J. A.
// Ratches, Opt. Eng. 15, 525 (1976), with the four bars' 7:1 and SNR 2.25; in three dimensions L. Scott and J. D'Agostino, "NVEOD FLIR92 thermal imaging
// systems performance model", Proc. SPIE 1689, 194 (1992) (its correction functions). The eye's own threshold, added as a square, as in R. H. Vollmerhausen, E.
// Jacobs, R. G. Driggers, Opt. Eng. 43, 2806 (2004): CTF_sys = CTF_eye / H sqrt(1 + noise^2), here with the noise of FLIR92. m: P. G. J. Barten, Proc. SPIE
// 5294, 231 (2004). Valid: bars below half a cycle a pixel; white noise.
#include <functional>

namespace pitviper {

/// Noise in three dimensions [K] (noise_components.hpp).
struct ThermalNoise {
  double tvh = 0.0, tv = 0.0, th = 0.0, vh = 0.0, v = 0.0, h = 0.0;
};

/// Who looks at what display. Figures without a source are chosen: a screen as high as a hand and a half at arm's length.
struct Observer {
  double snr = 2.25;              ///< at which bars are told (Ratches 1976)
  double eye_s = 0.2;             ///< that an eye adds up (Ratches 1976)
  double displayHeight_m = 0.15;  ///< of the film's whole height
  double distance_m = 0.4;        ///< of the eye from it
  double luminance_cd_m2 = 30.0;  ///< of its mean
  double sceneContrast_K = 5.0;   ///< S; 0: an eye without a threshold
};

/// A camera as its MRTD depends on it.
struct Resolving {
  std::function<double(double cycles_per_rad)> transfer;  ///< of lens and pixel
  double pitchX_rad = 0.0, pitchY_rad = 0.0;              ///< of pixels
  int rows = 0;                                           ///< of the whole film, over the display's height
  double rate_Hz = 0.0;
  ThermalNoise noise;
  Observer observer = {};
};

enum class Bars { SideBySide, Stacked };

/// Threshold modulation of an eye for `cycles_per_deg` on a field of so many degrees a side.
double eyeThreshold(double cycles_per_deg, double field_deg, double luminance_cd_m2);

/// The minimum resolvable temperature difference of one direction: what all frequencies have in common is worked out once.
class Mrtd {
 public:
  /// `camera` must outlive it.
  Mrtd(const Resolving& camera, Bars bars);
  /// [K]; infinite beyond half a cycle a pixel. `cycles_per_rad` above 0.
  double operator()(double cycles_per_rad) const;

 private:
  const Resolving& c_;
  Bars bars_;
  double field_deg_, cyclesPerDegree_;  ///< height of the display as the eye sees it; what one cycle a radian before the camera is on it
  double best_;                         ///< where the eye needs least contrast [1/deg]
};
double mrtd_K(const Resolving& camera, Bars bars, double cycles_per_rad);
/// The highest frequency that is resolved at a difference, of the geometric mean of both directions (FLIR92) [cycles/rad]; 0: none.
double resolved_per_rad(const Resolving& camera, double difference_K);
double nyquist_per_rad(const Resolving& camera, Bars bars);

}  // namespace pitviper
