#include "sensors/gimbal/scan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// The part of a period that has gone, in [0, 1): of whole periods none is left, so that late times lose no digits but their own.
double shareOf(double periods) {
  const double share = periods - std::floor(periods);
  return share < 1.0 ? share : 0.0;
}

glm::dvec2 rasterAt(const Scan& s, double time_s) {
  const double inFrame = shareOf(time_s * s.lineRate_Hz / s.lines) * s.lines, line = std::min(std::floor(inFrame), s.lines - 1.0), share = inFrame - line;
  const double active = 1.0 - s.flyback;
  const auto height = [&](double number) { return 0.5 * s.height_rad - (number + 0.5) * s.height_rad / s.lines; };
  if (share < active) return {s.width_rad * (0.5 - share / active), height(line)};
  const double back = (share - active) / s.flyback, next = line + 1.0 < s.lines ? line + 1.0 : 0.0;
  return {s.width_rad * (back - 0.5), height(line) + back * (height(next) - height(line))};
}

glm::dvec2 ofCircle(double radius_rad, double turns) {
  const double angle = 2.0 * kPi * shareOf(turns);
  return {radius_rad * std::cos(angle), radius_rad * std::sin(angle)};
}

glm::dvec2 spiralAt(const Scan& s, double time_s) {
  const double gone = 2.0 * s.turns * shareOf(0.5 * time_s * s.frequency_Hz / s.turns), turn = gone <= s.turns ? gone : 2.0 * s.turns - gone;
  return ofCircle(s.radius_rad * turn / s.turns, turn);
}

}  // namespace

glm::dvec2 scanAt(const Scan& s, double time_s) {
  switch (s.kind) {
    case Scan::Kind::None:
      break;
    case Scan::Kind::Raster:
      return rasterAt(s, time_s);
    case Scan::Kind::Spiral:
      return spiralAt(s, time_s);
    case Scan::Kind::Conical:
      return ofCircle(s.radius_rad, time_s * s.frequency_Hz + s.phase_rad / (2.0 * kPi));
    case Scan::Kind::Rosette:
      return ofCircle(0.5 * s.radius_rad, time_s * s.frequency_Hz) + ofCircle(0.5 * s.radius_rad, -time_s * s.secondFrequency_Hz);
  }
  return glm::dvec2(0.0);
}

void requireSound(const Scan& s) {
  const auto isPositive = [](double v) { return v > 0.0 && std::isfinite(v); };
  const auto require = [](bool sound, const char* what) {
    if (!sound) throw std::invalid_argument(std::string("scan: ") + what);
  };
  if (s.kind == Scan::Kind::None) return;
  if (s.kind == Scan::Kind::Raster) {
    require(isPositive(s.width_rad) && isPositive(s.height_rad), "a field that has no size");
    require(s.lines >= 1 && isPositive(s.lineRate_Hz), "no lines");
    require(s.flyback >= 0.0 && s.flyback < 1.0, "a flyback outside [0, 1)");
    return;
  }
  require(isPositive(s.radius_rad) && isPositive(s.frequency_Hz), "no radius or no frequency");
  if (s.kind == Scan::Kind::Spiral) require(isPositive(s.turns), "a spiral without turns");
  if (s.kind == Scan::Kind::Rosette) require(isPositive(s.secondFrequency_Hz), "a rosette without a second frequency");
  require(std::isfinite(s.phase_rad), "a phase that is no number");
}

}  // namespace pitviper
