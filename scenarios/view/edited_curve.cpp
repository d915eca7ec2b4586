#include "scenarios/view/edited_curve.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scenarios/import/import_yaml.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {
namespace {

/// Slopes at the points with which cubics between them are monotone.
std::vector<double> monotoneSlopes(const std::vector<CurvePoint>& p) {
  std::vector<double> secant, slope(p.size(), 0.0);
  for (std::size_t k = 0; k + 1 < p.size(); ++k) secant.push_back((p[k + 1].value - p[k].value) / (p[k + 1].wavelength_um - p[k].wavelength_um));
  if (secant.empty()) return slope;
  slope.front() = secant.front();
  slope.back() = secant.back();
  for (std::size_t k = 1; k + 1 < p.size(); ++k) {
    if (secant[k - 1] * secant[k] <= 0.0) continue;  // a turning point is flat
    const double before = p[k].wavelength_um - p[k - 1].wavelength_um, after = p[k + 1].wavelength_um - p[k].wavelength_um;
    slope[k] = (after * secant[k - 1] + before * secant[k]) / (before + after);
  }
  for (std::size_t k = 0; k < secant.size(); ++k) {
    if (secant[k] == 0.0) {
      slope[k] = slope[k + 1] = 0.0;
      continue;
    }
    const double radius = std::hypot(slope[k] / secant[k], slope[k + 1] / secant[k]);
    if (radius <= 3.0) continue;
    slope[k] *= 3.0 / radius;
    slope[k + 1] *= 3.0 / radius;
  }
  return slope;
}

/// Of a spectrum, places between which it is as good as straight.
std::vector<CurvePoint> straightPieces(const Spectrum& s, double low, double high) {
  std::vector<double> all{low, high};
  for (double w : s.knots()) all.push_back(w);
  std::size_t tables = 0;
  bool bends = false;
  for (const auto& factor : s.factors()) {
    if (std::holds_alternative<Spectrum::BlackBody>(factor)) bends = true;
    const auto* t = std::get_if<Spectrum::Table>(&factor);
    if (!t) continue;
    ++tables;
    // Just before a step.
    const auto& x = t->wavelength_um;
    for (std::size_t k = 0; k < x.size(); ++k)
      if ((k > 0 && x[k] == x[k - 1]) || (k == 0 && t->outside == Outside::Zero)) all.push_back(x[k] * (1.0 - 2.0 * EditedCurve::kMargin));
    if (t->outside == Outside::Zero) all.push_back(x.back() * (1.0 + 2.0 * EditedCurve::kMargin));
  }
  constexpr int kGrid = 1024, kBetween = 8;
  if (bends)
    for (int i = 1; i < kGrid; ++i) all.push_back(low * std::pow(high / low, i / double(kGrid)));
  std::sort(all.begin(), all.end());
  if (bends || tables > 1) {
    const std::size_t knots = all.size();
    for (std::size_t k = 0; k + 1 < knots; ++k)
      for (int i = 1; i < kBetween; ++i) all.push_back(all[k] + (all[k + 1] - all[k]) * i / kBetween);
    std::sort(all.begin(), all.end());
  }
  std::vector<CurvePoint> pieces;
  for (double w : all)
    if (w >= low && w <= high && (pieces.empty() || w > pieces.back().wavelength_um * (1.0 + EditedCurve::kMargin))) pieces.push_back({w, s(w)});
  return pieces;
}

}  // namespace

EditedCurve::EditedCurve(std::vector<CurvePoint> points, bool smooth, CurveBounds bounds) : points_(std::move(points)), smooth_(smooth), bounds_(bounds) {
  if (points_.empty()) throw std::invalid_argument("a curve without points");
  if (points_.size() > kMost)
    throw UserError({"curve", 0, 0, -1}, "a curve of " + std::to_string(points_.size()) + " points", "at most " + std::to_string(kMost),
                    "follow it less closely");
  for (CurvePoint& p : points_) {
    if (!(p.wavelength_um >= bounds_.low_um && p.wavelength_um <= bounds_.high_um)) throw std::invalid_argument("a point of a curve off its wavelengths");
    p = within(p.wavelength_um, p.value);
  }
  for (std::size_t k = 1; k < points_.size(); ++k)
    if (!(points_[k].wavelength_um > points_[k - 1].wavelength_um)) throw std::invalid_argument("points of a curve that do not rise in wavelength");
  tabulate();
}

EditedCurve EditedCurve::of(const Spectrum& spectrum, double low_um, double high_um, double tolerance, CurveBounds bounds) {
  const double low = std::max(low_um, bounds.low_um), high = std::min(high_um, bounds.high_um);
  if (!(low <= high)) throw std::invalid_argument("a curve over no wavelength");
  const auto all = straightPieces(spectrum, low, high);
  std::vector<CurvePoint> kept{all.front()};
  // Stretches that are still to be followed, the leftmost on top.
  std::vector<std::size_t> ends;
  for (std::size_t begin = 0, end = all.size() - 1; begin < all.size() - 1;) {
    const CurvePoint &a = all[begin], &b = all[end];
    std::size_t worst = begin;
    double most = tolerance;
    for (std::size_t k = begin + 1; k < end; ++k) {
      const double line = a.value + (b.value - a.value) * (all[k].wavelength_um - a.wavelength_um) / (b.wavelength_um - a.wavelength_um);
      // Rounding must not choose among places on one line.
      if (const double off = std::abs(all[k].value - line); off > most * (1.0 + 1e-9)) most = off, worst = k;
    }
    if (worst > begin) {
      ends.push_back(end);
      end = worst;
      continue;
    }
    kept.push_back(b);
    begin = end;
    if (!ends.empty()) end = ends.back(), ends.pop_back();
  }
  return EditedCurve(std::move(kept), false, bounds);
}

CurvePoint EditedCurve::within(double wavelength_um, double value) const {
  if (!std::isfinite(wavelength_um) || !std::isfinite(value)) throw std::invalid_argument("a point of a curve that is not finite");
  return {std::clamp(tidy(wavelength_um), bounds_.low_um, bounds_.high_um), std::clamp(tidy(value), bounds_.lowest, bounds_.highest)};
}

void EditedCurve::setSmooth(bool smooth) {
  smooth_ = smooth;
  tabulate();
}

std::size_t EditedCurve::add(double wavelength_um, double value) {
  const CurvePoint added = within(wavelength_um, value);
  if (const std::size_t i = nearest(added.wavelength_um); std::abs(points_[i].wavelength_um / added.wavelength_um - 1.0) <= kMargin) {
    set(i, value);
    return i;
  }
  if (points_.size() >= kMost) throw UserError({"curve", 0, 0, -1}, "a curve of more than " + std::to_string(kMost) + " points", "fewer", "remove some");
  const auto after = std::upper_bound(points_.begin(), points_.end(), added.wavelength_um, [](double w, const CurvePoint& p) { return w < p.wavelength_um; });
  const auto at = points_.insert(after, added);
  const auto i = static_cast<std::size_t>(at - points_.begin());
  tabulate();
  return i;
}

void EditedCurve::remove(std::size_t i) {
  if (points_.size() < 2 || i >= points_.size()) return;
  points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(i));
  tabulate();
}

void EditedCurve::move(std::size_t i, double wavelength_um, double value) {
  CurvePoint moved = within(wavelength_um, value);
  const double low = i > 0 ? points_[i - 1].wavelength_um * (1.0 + kMargin) : bounds_.low_um,
               high = i + 1 < points_.size() ? points_[i + 1].wavelength_um * (1.0 - kMargin) : bounds_.high_um;
  // Without room, it stays where it is.
  moved.wavelength_um = low <= high ? tidy(std::clamp(moved.wavelength_um, low, high)) : points_[i].wavelength_um;
  points_[i] = moved;
  tabulate();
}

void EditedCurve::scale(double factor) {
  for (CurvePoint& p : points_) p = within(p.wavelength_um, bounds_.lowest + std::clamp(factor, 0.0, 1.0) * (p.value - bounds_.lowest));
  tabulate();
}

std::size_t EditedCurve::nearest(double wavelength_um) const {
  const auto off = [&](const CurvePoint& p) { return std::abs(p.wavelength_um - wavelength_um); };
  const auto best = std::min_element(points_.begin(), points_.end(), [&](const CurvePoint& a, const CurvePoint& b) { return off(a) < off(b); });
  return static_cast<std::size_t>(best - points_.begin());
}

void EditedCurve::tabulate() {
  Spectrum::Table t{{}, {}, Outside::Hold, "a curve"};
  const auto slope = smooth_ ? monotoneSlopes(points_) : std::vector<double>();
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const CurvePoint& a = points_[k];
    t.wavelength_um.push_back(a.wavelength_um);
    t.value.push_back(a.value);
    if (!smooth_ || k + 1 == points_.size()) continue;
    const CurvePoint& b = points_[k + 1];
    const double step = b.wavelength_um - a.wavelength_um;
    const auto [least, most] = std::minmax(a.value, b.value);
    for (int i = 1; i < kPieces; ++i) {
      const double u = i / double(kPieces), v = 1.0 - u;
      const double cubic = v * v * (1.0 + 2.0 * u) * a.value + u * u * (3.0 - 2.0 * u) * b.value + step * u * v * (v * slope[k] - u * slope[k + 1]);
      t.wavelength_um.push_back(a.wavelength_um + step * u);
      t.value.push_back(std::clamp(cubic, least, most));  // what rounding leaves
    }
  }
  spectrum_ = Spectrum(std::move(t));
}

std::string EditedCurve::yaml() const {
  const Spectrum::Table& t = table();
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < t.value.size(); ++k) {
    const double w = tidy(t.wavelength_um[k]);
    // Points a last digit apart have no room for pieces.
    if (rows.empty() || w > rows.back().front()) rows.push_back({w, tidy(t.value[k])});
  }
  return "{wavelength: um, unit: \"1\", outside: hold, values: " + rowsOfNumbers(rows) + "}";
}

}  // namespace pitviper
