#pragma once
// How a window turns a layer's values into places on its colour bar.
#include <string>
#include <vector>

namespace pitviper {

enum class ScaleKind { Linear, Logarithmic, Histogram };
const char* nameOf(ScaleKind kind);

class DisplayScale {
 public:
  DisplayScale() = default;
  /// Of some values between two ends; histogram: as many pixels in each step of the bar. Logarithmic scales begin above 0. Ends that coincide are drawn apart.
  DisplayScale(ScaleKind kind, double low, double high, const std::vector<float>& pixels);
  /// Ends that most of the finite pixels lie between: the 0.5 and 99.8 percentile, or all where these coincide.
  static std::pair<double, double> endsOf(const std::vector<float>& pixels);

  /// 0 at the bottom of the bar to 1.
  double position(double value) const;
  double value(double position) const;
  /// Values to write beside the bar, and where they stand on it.
  std::vector<std::pair<double, std::string>> ticks() const;
  double low() const { return low_; }
  double high() const { return high_; }
  ScaleKind kind() const { return kind_; }

 private:
  ScaleKind kind_ = ScaleKind::Linear;
  double low_ = 0.0, high_ = 1.0;
  std::vector<double> quantiles_;  ///< of a histogram, evenly spread
};

}  // namespace pitviper
