#pragma once
// The image of a camera at subpixel resolution, in double precision, while bodies and lights smaller than a pixel are added; then
// resolved into pixels.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/plan/plan.hpp"
#include "sim/plan/scattered_again.hpp"
#include "sim/render/scene_pass.hpp"

namespace pitviper {

/// Truth of a pixel: see sim/render/glsl/truth_layers.glsl for the order.
struct TruthPixel {
  float area_m2 = 0, solidAngleFromLight_sr = 0, solidAngleOfAperture_sr = 0, range_m = 0;
  float normal[3] = {0, 0, 0};
  float temperature_K = 0;
  float entity = 0, part = 0, cosView = 0;
};

/// What an audit found of a channel's slot: relative errors |L - Lref| / max(|Lref|, 1e-3 x the 99th percentile of the picture).
struct SlotAudit {
  int pixels = 0;  ///< random ones
  double median = 0.0, largest = 0.0;
  double doubt = -1.0;  ///< of the pixel that sees what few do; below 0: none was looked at
};

/// What leaves the renderer: integrals of kernel x radiance per slot and pixel, row 0 at the top.
struct CameraImage {
  int width = 0, height = 0;
  std::vector<std::vector<double>> slots;  ///< [slot][pixel], kernel unit x W/(m2 sr)
  std::shared_ptr<const Pinhole::SolidAngles> solidAngles;
  std::vector<TruthPixel> truth;               ///< per pixel, or empty
  std::vector<int> slotOfOutput;               ///< from the plan
  std::string transparentOrder;                ///< how transparent things in view were sorted, for the frame's metadata; empty: none in view
  std::vector<ScatteredAgain> scatteredAgain;  ///< channels in which light scattered more than once would matter
  double accuracy = 0.0;                       ///< from the plan, and so its error per slot
  std::vector<double> predictedError;          ///< empty where nothing was measured
  std::string plan;                            ///< its fingerprint
  std::vector<SlotAudit> audit;                ///< per slot; empty: not audited
};

class Subpixels {
 public:
  /// Takes what a pass drew for `view` (the camera's own view, samples x samples subpixels).
  Subpixels(const Plan& plan, const View& view, RawImage raw);

  const View& view() const { return view_; }
  size_t index(int x, int y) const { return static_cast<size_t>(y) * static_cast<size_t>(view_.width) + static_cast<size_t>(x); }
  size_t slotCount() const { return slotCount_; }
  double slot(size_t s, size_t pixel) const;
  /// Adds to a subpixel's integrals, in double precision: a faint target must not drown in the rounding of its background.
  void add(size_t s, size_t pixel, double value);
  /// Integral of cos(psi) dOmega over a subpixel [sr].
  double projectedSolidAngle_sr(int x, int y) const;
  bool hasTruth() const { return !raw_.truth.empty(); }
  void setTruth(size_t pixel, const TruthPixel& truth) { truth_[pixel] = truth; }

  /// Mean over samples x samples subpixels, weighted by projected solid angle (flux adds up); truth from the middle one.
  CameraImage resolve(const Pinhole& pinhole, int samples) const;

 private:
  View view_;
  size_t slotCount_;
  RawImage raw_;
  std::map<size_t, std::vector<double>> added_;  ///< subpixels that got something, by slot
  std::map<size_t, TruthPixel> truth_;           ///< truth that replaces the pass's own
};

TruthPixel truthAt(const RawImage& raw, size_t pixel);

}  // namespace pitviper
