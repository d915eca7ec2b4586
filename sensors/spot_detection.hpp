#pragma once
// Detection of a spot, a target smaller than a pixel, by a threshold over noise.
//
// Law: a pixel is above k sigma of its noise without a target with Q(k), with one whose signal is TNR sigma with Q(k - TNR); Q(x) = erfc(x / sqrt 2) / 2. So
// many false alarms an hour from n pixels a second: Q(k) = alarms / (3600 n). Where a detector's video is compared as it comes, low-pass filtered at half of
// the pixels' rate, an alarm is an upward crossing: n / (2 sqrt 3) exp(-k^2 / 2) a second. Source: samples of Gaussian noise, independent as a staring array's
// pixels are from frame to frame; crossings: S. O. Rice, Bell Syst. Tech. J. 24, 46 (1945), as in RCA Electro-Optics Handbook EOH-11 (1974), section 8. Valid:
// the background is even, fixed pattern is corrected; one frame decides.

namespace pitviper {

/// Q(k).
double falseAlarms(double threshold);
/// k; `probability` within (0, 1). Good to a double's rounding.
double thresholdFor(double probability);
/// The threshold of so many false alarms an hour, over all pixels of all frames.
double thresholdForRate(double alarms_per_hour, double pixels_per_s);
/// The same of crossings by video. Errors: std::invalid_argument for more alarms than noise has crossings of its mean.
double thresholdByCrossings(double alarms_per_hour, double pixels_per_s);
double detection(double tnr, double threshold);
/// The TNR that is detected with a probability.
double tnrFor(double probability, double threshold);

}  // namespace pitviper
