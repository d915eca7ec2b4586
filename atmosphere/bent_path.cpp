#include "atmosphere/bent_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

// Below the deepest open ground no perigee is looked for.
constexpr double kLowest_m = -1000.0;

struct Segment {
  double lower_m, upper_m;
  double length_m = 0.0, centreAngle_rad = 0.0;
  AbsorberAmounts amounts;
};

class Bender {
 public:
  Bender(const AbsorberTable& air, double refractivity, double height_m, double sinElevation, double radius_m)
      : air_(air), radius_m_(radius_m), height_m_(height_m) {
    const auto perDensity = air.refractivityPerDensity(refractivity);
    if (!perDensity) throw std::invalid_argument("bent paths need an air table with a scatterer: its density bends");
    perDensity_ = *perDensity;
    start_ = index(height_m) * (radius_m + height_m);
    // Where it begins, n r - constant = n r (1 - cos e), without the difference of large numbers.
    const double cosine = std::sqrt(std::max(1.0 - sinElevation * sinElevation, 0.0));
    aboveAtStart_ = start_ * sinElevation * sinElevation / (1.0 + cosine);
    constant_ = start_ * cosine;
  }

  double index(double height_m) const { return 1.0 + perDensity_ * air_.airDensity(height_m); }

  // n r less the constant: 0 at a perigee.
  double above(double height_m) const {
    const double n0 = index(height_m_), n = index(height_m);
    return (n - n0) * (radius_m_ + height_m) + n0 * (height_m - height_m_) + aboveAtStart_;
  }

  double sinElevation(double height_m) const {
    const double a = std::max(above(height_m), 0.0), nr = constant_ + a;
    return std::sqrt(a * (nr + constant_)) / nr;
  }

  // The height at which it runs level, below the beginning; none above kLowest_m.
  std::optional<double> perigee() const {
    double low = kLowest_m, high = height_m_;
    if (above(low) > 0.0) return std::nullopt;
    // To the last digit: a height left over of 1e-6 m is an elevation of 1e-6.
    for (int i = 0; i < 100; ++i) (above(0.5 * (low + high)) > 0.0 ? high : low) = 0.5 * (low + high);
    return high;
  }

  // From one height up to another: in x = sqrt(height - lower + d), in which n r - constant is nearly a square, so that the integrand stays smooth
  // where the path begins level.
  std::vector<Segment> climb(double lower_m, double upper_m, int count) const {
    constexpr double kStep_m = 10.0;
    const double slope = std::max(1.0 + (radius_m_ + lower_m) * (index(lower_m + kStep_m) - index(lower_m)) / kStep_m, 0.05);
    const double d = std::max(above(lower_m), 0.0) / slope;
    const auto x = [&](double height) { return std::sqrt(std::max(height - lower_m, 0.0) + d); };
    std::vector<double> cuts = {x(lower_m), x(upper_m)};
    for (double level : air_.levels_m())
      if (level > lower_m && level < upper_m) cuts.push_back(x(level));
    const double first = cuts[0], last = cuts[1];
    for (int i = 1; i < count; ++i) cuts.push_back(first + (last - first) * i / count);
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    static const std::vector<QuadratureNode> nodes = gaussLegendre(AbsorberTable::kGaussPoints, 0.0, 1.0);
    std::vector<Segment> segments;
    for (size_t i = 0; i + 1 < cuts.size(); ++i) {
      const auto heightOf = [&](double at) { return lower_m + (at * at - d); };
      Segment s{i == 0 ? lower_m : heightOf(cuts[i]), i + 2 == cuts.size() ? upper_m : heightOf(cuts[i + 1]), 0.0, 0.0, {}};
      for (const QuadratureNode& node : nodes) {
        const double at = cuts[i] + (cuts[i + 1] - cuts[i]) * node.x, height = heightOf(at), sine = sinElevation(height);
        if (sine <= 0.0) continue;
        const double step_m = 2.0 * at * (cuts[i + 1] - cuts[i]) * node.weight / sine, r = radius_m_ + height;
        s.length_m += step_m;
        s.centreAngle_rad += step_m * constant_ / (index(height) * r * r);
        AbsorberAmounts w = air_.densities(height);
        for (double& amount : w.amount_km) amount *= 1e-3 * step_m;
        s.amounts += w;
      }
      segments.push_back(s);
    }
    return segments;
  }

 private:
  const AbsorberTable& air_;
  double radius_m_, height_m_, perDensity_ = 0.0, start_ = 0.0, constant_ = 0.0, aboveAtStart_ = 0.0;
};

}  // namespace

double airRefractivity(double wavelength_um) {
  const double s = 1.0 / (wavelength_um * wavelength_um);
  return 1e-8 * (8342.13 + 2406030.0 / (130.0 - s) + 15997.0 / (38.9 - s));
}

BentPath bentPath(const AbsorberTable& air, double refractivity, double height_m, double sinElevation, double earthRadius_m, double endHeight_m, int count) {
  const double top = std::min(endHeight_m, air.top_m());
  double height = height_m, sine = std::clamp(sinElevation, -1.0, 1.0), before_m = 0.0;
  if (height > air.top_m()) {
    // Straight down to the air, if it meets it: s of r^2 = r0^2 + s (2 b + s).
    const double r0 = earthRadius_m + height, b = r0 * sine, c = (height - air.top_m()) * (r0 + earthRadius_m + air.top_m());
    if (b >= 0.0 || b * b <= c) return {{PathStation{0.0, air.temperature_K(height), {}, height}}, sine, 0.0, false};
    before_m = c / (-b + std::sqrt(b * b - c));
    sine = (b + before_m) / (earthRadius_m + air.top_m());
    height = air.top_m();
  }
  if (top < height && sine >= 0.0) throw std::invalid_argument("a bent path that rises cannot end below its beginning");
  const Bender bender(air, refractivity, height, sine, earthRadius_m);

  BentPath path;
  path.stations.push_back({before_m, air.temperature_K(height), {}, height});
  double centreAngle = 0.0;
  const auto go = [&](const Segment& s, double to_m) {
    PathStation next{path.stations.back().range_m + s.length_m, air.temperature_K(to_m), path.stations.back().amounts + s.amounts, to_m};
    path.stations.push_back(next);
    centreAngle += s.centreAngle_rad;
  };
  double from = height;
  if (sine < 0.0) {
    const auto perigee = bender.perigee();
    path.endsAtGround = height >= 0.0 && (!perigee || *perigee < 0.0);
    from = path.endsAtGround ? 0.0 : perigee.value_or(kLowest_m);
    const auto down = bender.climb(from, height, count);
    for (auto s = down.rbegin(); s != down.rend(); ++s) go(*s, s->lower_m);
  }
  if (!path.endsAtGround && top > from)
    for (const Segment& s : bender.climb(from, top, count)) go(s, s.upper_m);
  const double end = path.stations.back().height_m;
  path.sinElevationAtEnd = path.endsAtGround ? -bender.sinElevation(end) : bender.sinElevation(end);
  // A straight line's elevation grows by the angle at the earth's centre.
  path.bending_rad = std::asin(sine) + centreAngle - std::asin(path.sinElevationAtEnd);
  return path;
}

double bendingFromSpace(const AbsorberTable& air, double refractivity, double height_m, double sinElevation, double earthRadius_m) {
  double lowest = 0.0;
  if (const auto perDensity = air.refractivityPerDensity(refractivity); perDensity && height_m > 0.0) {
    const auto nr = [&](double h) { return (1.0 + *perDensity * air.airDensity(h)) * (earthRadius_m + h); };
    const double cosine = std::min(nr(0.0) / nr(height_m), 1.0);
    // A little above: what just grazes the ground must not end there by rounding.
    lowest = -std::sqrt(1.0 - cosine * cosine) * (1.0 - 1e-4);
  }
  return bentPath(air, refractivity, height_m, std::max(sinElevation, lowest), earthRadius_m, INFINITY, 1).bending_rad;
}

}  // namespace pitviper
