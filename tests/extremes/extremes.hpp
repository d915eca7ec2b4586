#pragma once
// Scenes at the ends of what numbers hold: through the whole pipeline in single precision, again in double (`accuracy: reference`), and the
// worst of a range of cases in one line of the table.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/figures.hpp"
#include "tests/support/ray_march.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {

/// A square camera whose middle pixel looks at a place, channel "a" over a band.
struct Look {
  std::string from = "[9 m, 0 m, 0 m]", at = "[0 m, 0 m, 0 m]";
  double low_um = 8.0, high_um = 12.0;
  int pixels = 5;
  double field_deg = 2.0;
  std::string more{};      ///< further keys of the camera, each followed by ", "
  std::string channels{};  ///< instead of the band
  std::string yaml() const {
    return "cameras: [{name: c, film: {width: " + std::to_string(pixels) + ", height: " + std::to_string(pixels) + "}, field_of_view: " + text(field_deg) +
           " deg, aperture: 20 mm, position: " + from + ", look_at: " + at + ", " + more +
           "channels: " + (channels.empty() ? "[{name: a, response: {band: [" + text(low_um) + " um, " + text(high_um) + " um]}}]" : channels) + "}]\n";
  }
};

/// A square plate across the x axis at the origin.
inline std::string plate(double kelvin, const std::string& material = "blackbody", double size_m = 4.0) {
  return "entities: [{name: p, shape: {model: plate, width: " + text(size_m) + " m, height: " + text(size_m) + " m}, material: " + material +
         ", temperature: " + text(kelvin) + " K}]\n";
}

/// The frame of camera 0, every number of which is finite.
inline Frame finiteFrame(const std::string& yaml) {
  Frame frame = renderFrame(scene(yaml));
  for (const FrameLayer& l : frame.layers)
    for (float v : l.pixels)
      if (!std::isfinite(v)) {
        ADD_FAILURE() << l.name << " holds " << v << " in\n" << yaml;
        return frame;
      }
  return frame;
}

inline double middleOf(const Frame& frame, size_t layer = 0) { return at(frame.layers.at(layer), frame, frame.width / 2, frame.height / 2); }
inline double middle(const std::string& yaml) { return middleOf(finiteFrame(yaml)); }
/// The same in double precision, at every wavelength of the fine grid.
inline std::string inDouble(const std::string& yaml) { return "accuracy: reference\n" + yaml; }

/// A band that reference mode takes as one bin: its own bins are 5 1/cm or 1 nm wide, whichever is wider, and it takes their middles.
struct OneBin {
  double low_um, high_um;
  explicit OneBin(double from_um) : low_um(from_um), high_um(from_um + 0.3 * std::max(1e-3, 5e-4 * from_um * from_um)) {}
  double middle_um() const { return 0.5 * (low_um + high_um); }
  double width_um() const { return high_um - low_um; }
};

/// Planck's law [W/(m2 sr um)], in long double with the C library's own functions.
inline double planck(double wavelength_um, double kelvin) {
  const long double w = wavelength_um, c1 = 1.191042972397188414e8L, c2 = 14387.768775039337L;
  return static_cast<double>(c1 / std::pow(w, 5.0L) / std::expm1(c2 / (w * static_cast<long double>(kelvin))));
}

/// The worst relative error over a range of cases: one bound of the table, which the last of them completes.
class Range {
 public:
  Range(std::string what, double allowed, std::string against) : what_(std::move(what)), against_(std::move(against)), allowed_(allowed) {}
  Range(const Range&) = delete;
  Range& operator=(const Range&) = delete;
  ~Range() {
    EXPECT_GT(cases_, 0) << what_;
    bound(what_, worst_, allowed_, against_ + "; " + std::to_string(cases_) + " cases");
  }
  void add(double got, double want, const std::string& at) {
    ++cases_;
    const double error = want != 0.0 ? std::abs(got / want - 1.0) : std::abs(got);
    EXPECT_TRUE(error <= allowed_) << what_ << " at " << at << ": " << got << ", not " << want;
    if (!(error <= worst_)) worst_ = error;
  }

 private:
  std::string what_, against_;
  double allowed_, worst_ = 0.0;
  int cases_ = 0;
};

}  // namespace pitviper::test
