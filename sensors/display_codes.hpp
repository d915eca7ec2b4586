#pragma once
// Counts as codes for a screen, as a camera's automatic gain has them. For people only: what they say depends on the rest of the picture.
#include <vector>

#include "sim/model/detector_law.hpp"

namespace pitviper {

/// 0 to 255, whole. `noise_counts`: of a pixel in the middle of the picture's counts from frame to frame, rms.
///
/// Law: a count k gets c(k) codes, and stands in the middle of them above those of all lower counts. h(k): share of the picture's pixels at k; [low, high]: its
/// range but for `tails` at either end, n counts; G: most codes a count; S: sum of min(h, plateau) over the range.
///   Linear:  c = min(G, 255 / n)
///   Plateau: c = min(G, 255 ((1 - linear) min(h, plateau) / S + linear / n)) within the range, min(G, 255 linear / n) beyond
/// Where G leaves some of the 255 codes over, the picture's median is mid-grey (127.5), as far as the range then stays on the screen: noise of an empty scene
/// stays noise. Source: V. E. Vickers, "Plateau equalization algorithm for real-time display of high-quality infrared imagery", Opt. Eng. 35, 1921 (1996); a
/// largest gain, a linear share, tails and a middle as in the manuals of cameras (FLIR Tau 2 and Boson, "AGC").
/// NaN is white.
void toDisplayCodes(std::vector<float>& counts, const DetectorLaw& law, double noise_counts);

}  // namespace pitviper
