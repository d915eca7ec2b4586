#pragma once
// How far a picture is from the reference, over all frames of a channel.
#include <optional>
#include <span>
#include <vector>

#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

struct ErrorFigures {
  double median = 0.0, percentile99 = 0.0, maximum = 0.0;
};

struct ChannelErrors {
  ErrorFigures relative;
  std::optional<ErrorFigures> kelvin;  ///< over the pixels as bright as a black body of 250 to 330 K; none: there is none
};

/// A channel's reference, and what is held against it.
///   relative error at a pixel: |L - Lref| / max(Lref, 1e-3 x the 99th percentile of Lref, 1e-14 W/(m2 sr um) x the kernel's integral)
///   temperature difference: |L - Lref| / (integral of kernel dB/dT at the temperature whose black body has Lref)
class ChannelReference {
 public:
  /// `values`: integrals of kernel x radiance, every pixel of every frame.
  ChannelReference(const Spectrum& kernel, std::vector<double> values);
  /// The same pixels, rendered otherwise.
  ChannelErrors errors(std::span<const double> rendered) const;
  /// Of each pixel.
  std::vector<double> relative(std::span<const double> rendered) const;
  const std::vector<double>& values() const { return values_; }

  static constexpr double kColdest_K = 250.0, kWarmest_K = 330.0;

 private:
  std::vector<double> values_;
  std::vector<double> slope_;  ///< per pixel, per kelvin; 0: not as bright as such a body
  double floor_ = 0.0;
};

/// Nearest ranks; the values come back sorted.
ErrorFigures figuresOf(std::vector<double>& values);

}  // namespace pitviper
