#pragma once
// A curve over wavelength that a hand draws: points, joined by lines or smoothly, never beyond its bounds.
#include <cstddef>
#include <string>
#include <vector>

#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

struct CurvePoint {
  double wavelength_um, value;
  bool operator==(const CurvePoint&) const = default;
};

/// Where the points of a curve may lie.
struct CurveBounds {
  double lowest = 0.0, highest = 1.0;  ///< values
  double low_um = kShortestWavelength_um, high_um = kLongestWavelength_um;
  bool operator==(const CurveBounds&) const = default;
};

/// One point at least, up to kMost; wavelengths rise, values are held beyond the first and the last. Numbers are kept to 12 digits, as they are written.
/// Smooth: a cubic between neighbours that never leaves their values, 16 straight pieces of it from point to point. Source: F. N. Fritsch and R. E. Carlson,
/// SIAM J. Numer. Anal. 17, 238 (1980), slopes by three points, cut to the circle of radius 3.
class EditedCurve {
 public:
  static constexpr std::size_t kMost = 4096;
  /// Neighbours of a moved point stay so far away, of their wavelength.
  static constexpr double kMargin = 1e-6;
  static constexpr int kPieces = 16;

  /// Values out of bounds are put to them. Throws std::invalid_argument without points, where wavelengths do not rise within the bounds and for numbers that
  /// are not finite; UserError for more than kMost points.
  explicit EditedCurve(std::vector<CurvePoint> points, bool smooth = false, CurveBounds bounds = {});
  /// Lines that follow a spectrum over [low, high] within a tolerance: of its knots (and a fine grid where it bends between them), those without which they
  /// would not, by Douglas and Peucker's halving; steps become 1e-6 of their wavelength wide. UserError where that takes more than kMost points.
  static EditedCurve of(const Spectrum& spectrum, double low_um, double high_um, double tolerance, CurveBounds bounds = {});

  const std::vector<CurvePoint>& points() const { return points_; }
  const CurveBounds& bounds() const { return bounds_; }
  bool smooth() const { return smooth_; }
  void setSmooth(bool smooth);

  /// Its place among the points. Where there is one already (within kMargin), that one takes the value. UserError beyond kMost.
  std::size_t add(double wavelength_um, double value);
  /// The last one stays.
  void remove(std::size_t i);
  /// As far as its neighbours and the bounds let it.
  void move(std::size_t i, double wavelength_um, double value);
  void set(std::size_t i, double value) { move(i, points_[i].wavelength_um, value); }
  /// All values by a factor of 0 to 1, from the lower bound up.
  void scale(double factor);

  /// The point that is nearest in wavelength.
  std::size_t nearest(double wavelength_um) const;
  double at(double wavelength_um) const { return spectrum_(wavelength_um); }
  /// One table, Outside::Hold.
  const Spectrum& spectrum() const { return spectrum_; }
  const Spectrum::Table& table() const { return std::get<Spectrum::Table>(spectrum_.factors().front()); }
  /// The table as a spectrum is written, a flow map over one or more lines; smooth curves by their pieces.
  std::string yaml() const;

  bool operator==(const EditedCurve& other) const { return smooth_ == other.smooth_ && bounds_ == other.bounds_ && points_ == other.points_; }

 private:
  void tabulate();
  CurvePoint within(double wavelength_um, double value) const;

  std::vector<CurvePoint> points_;
  bool smooth_;
  CurveBounds bounds_;
  Spectrum spectrum_;
};

}  // namespace pitviper
