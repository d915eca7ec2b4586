#pragma once
// The image of a camera at subpixel resolution, in double precision, while bodies and lights smaller than a pixel are added; then
// resolved into pixels.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/camera/camera_image.hpp"
#include "sim/plan/plan.hpp"
#include "sim/render/line_drawer.hpp"

namespace pitviper {

/// Projected solid angles of a film's subpixels: worked out once, and again where the projection changes.
class FilmWeights {
 public:
  /// Of a camera's own view, samples x samples subpixels.
  void follow(const View& view, int samples);
  const std::vector<double>& subpixel_sr() const { return subpixel_sr_; }  ///< row 0 at the bottom
  const std::vector<double>& pixel_sr() const { return pixel_sr_; }        ///< sums over pixels, row 0 at the top

 private:
  std::vector<double> key_, subpixel_sr_, pixel_sr_;
};

class Subpixels {
 public:
  /// Takes what a pass drew for `view` (the camera's own view, samples x samples subpixels), resolved or not. Of what was resolved integrals are those of
  /// View::kept alone.
  Subpixels(const Plan& plan, const View& view, RawImage raw);

  const View& view() const { return view_; }
  size_t index(int x, int y) const { return static_cast<size_t>(y) * static_cast<size_t>(view_.width) + static_cast<size_t>(x); }
  size_t slotCount() const { return slotCount_; }
  double slot(size_t s, size_t subpixel) const;
  /// Adds to a subpixel's integrals, in double precision: a faint target must not drown in the rounding of its background.
  void add(size_t s, size_t pixel, double value);
  /// What is smaller than a subpixel is told as points (CameraImage::points), not added to one.
  void keepPoints() { keepsPoints_ = true; }
  bool keepsPoints() const { return keepsPoints_; }
  /// `at`: subpixels from the lower left corner; `subpixel`: in which what it stands for is; `flux`: radiance times projected solid angle, of a slot.
  void addPoint(const glm::dvec2& at, size_t subpixel, size_t s, double flux) {
    points_.push_back({at.x, at.y, static_cast<int>(s), static_cast<int>(subpixel), flux});
  }
  /// Integral of cos(psi) dOmega over a subpixel [sr].
  double projectedSolidAngle_sr(int x, int y) const;
  bool hasTruth() const { return !raw_.truth.empty(); }
  /// Whether truth of a pixel is that of this subpixel.
  bool isMiddle(int x, int y) const { return x % view_.subpixels == view_.subpixels / 2 && y % view_.subpixels == view_.subpixels / 2; }
  void setTruth(size_t pixel, const TruthPixel& truth) { truth_[pixel] = truth; }

  /// Mean over samples x samples subpixels, weighted by projected solid angle (flux adds up); truth from the middle one. `weights`: brought up to date.
  CameraImage resolve(const Pinhole& pinhole, int samples, FilmWeights& weights) const;

 private:
  void takePixels(CameraImage& image, int samples) const;
  void takeSubpixels(CameraImage& image, int samples, FilmWeights& weights) const;
  size_t middleOf(size_t pixel, int samples) const;
  View view_;
  size_t slotCount_;
  RawImage raw_;
  std::map<size_t, std::vector<double>> added_;  ///< subpixels that got something, by slot
  bool keepsPoints_ = false;
  std::vector<FilmPoint> points_;       ///< in subpixels from the lower left corner
  std::map<size_t, TruthPixel> truth_;  ///< truth that replaces the pass's own
};

TruthPixel truthAt(const RawImage& raw, size_t pixel);

}  // namespace pitviper
