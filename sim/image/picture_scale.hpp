#pragma once
// Where values stand between the ends of a colour bar.
#include <utility>
#include <vector>

namespace pitviper {

/// Narrower than the rounding of float values (2^-24): no picture.
bool isNearlySame(double low, double high);

/// 0 at the bottom of the bar to 1. Linear; or, where a few very bright or dark things would leave the bulk of a picture in one colour, asinh: linear over
/// the bulk, logarithmic far from it.
class PictureScale {
 public:
  /// Linear, its ends apart.
  static PictureScale between(double low, double high);
  /// The 0.5 and 99.8 percentile of the finite pixels; smallest to largest where these coincide. Where that would leave the middle four fifths of the pixels
  /// less than an eighth of the bar, the bar is bent: its ticks say how.
  static PictureScale of(std::vector<float> pixels);

  double position(double value) const;
  double value(double position) const;
  bool isLinear() const { return spread_ <= 0.0; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  PictureScale(double low, double high) : low_(low), high_(high) {}
  PictureScale(double low, double high, double centre, double spread);
  double low_, high_, centre_ = 0.0, spread_ = 0.0, bottom_ = 0.0, top_ = 1.0;
};

/// One scale for many pictures: of all their pixels while these are few, of an even choice of them where they are many, and of all their extremes.
class CommonScale {
 public:
  void add(const std::vector<float>& pixels);
  PictureScale scale() const;

 private:
  std::vector<float> some_, extremes_;
  std::size_t step_ = 1;
};

}  // namespace pitviper
