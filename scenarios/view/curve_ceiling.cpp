#include "scenarios/view/curve_ceiling.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// Rounding of sums of twelve digits; the reader forgives a million times as much.
constexpr double kRounding = 1e-12;

/// A table read at rising wavelengths.
class RisingReader {
 public:
  RisingReader(const std::vector<double>& x, const std::vector<double>& y) : x_(x), y_(y) {}
  double next_um() const { return k_ < x_.size() ? x_[k_] : INFINITY; }
  /// At w, no less than the one before; knots up to there are passed.
  double at(double w) {
    while (k_ < x_.size() && x_[k_] <= w) ++k_;
    if (k_ == 0) return y_.front();
    if (k_ == x_.size() || x_[k_ - 1] == w) return y_[k_ - 1];
    return y_[k_ - 1] + (y_[k_] - y_[k_ - 1]) * (w - x_[k_ - 1]) / (x_[k_] - x_[k_ - 1]);
  }

 private:
  const std::vector<double>&x_, &y_;
  std::size_t k_ = 0;
};

}  // namespace

CurveCeiling::CurveCeiling(const std::vector<const EditedCurve*>& others) : none_(others.empty()) {
  for (const EditedCurve* other : others) wavelength_um_.insert(wavelength_um_.end(), other->table().wavelength_um.begin(), other->table().wavelength_um.end());
  std::sort(wavelength_um_.begin(), wavelength_um_.end());
  wavelength_um_.erase(std::unique(wavelength_um_.begin(), wavelength_um_.end()), wavelength_um_.end());
  left_.assign(wavelength_um_.size(), 1.0);
  for (const EditedCurve* other : others) {
    RisingReader reader(other->table().wavelength_um, other->table().value);
    for (std::size_t k = 0; k < left_.size(); ++k) left_[k] -= reader.at(wavelength_um_[k]);
  }
}

template <class Visit>
void CurveCeiling::visit(const EditedCurve& curve, const Visit& visit) const {
  if (none_) return;
  RisingReader own(curve.table().wavelength_um, curve.table().value), most(wavelength_um_, left_);
  for (double w = std::min(own.next_um(), most.next_um()); std::isfinite(w); w = std::min(own.next_um(), most.next_um()))
    visit(w, own.at(w) - std::max(0.0, most.at(w)));
}

bool CurveCeiling::allows(const EditedCurve& curve) const {
  double worst = 0.0;
  visit(curve, [&](double, double above) { worst = std::max(worst, above); });
  return worst <= kRounding;
}

EditedCurve CurveCeiling::under(EditedCurve curve) const {
  // Lines are under it after one round, cubics, whose slopes change with their neighbours, after a few.
  for (int round = 0; round < 24; ++round) {
    const auto& points = curve.points();
    std::vector<double> lower(points.size(), 0.0);
    std::size_t after = 0;
    bool enough = true;
    visit(curve, [&](double w, double above) {
      if (above <= kRounding) return;
      enough = false;
      while (after < points.size() && points[after].wavelength_um < w) ++after;
      if (after < points.size()) lower[after] = std::max(lower[after], above);
      if (after > 0) lower[after - 1] = std::max(lower[after - 1], above);
    });
    if (enough) return curve;
    std::vector<CurvePoint> lowered = points;
    for (std::size_t k = 0; k < lowered.size(); ++k) lowered[k].value -= lower[k];
    curve = EditedCurve(std::move(lowered), curve.smooth(), curve.bounds());
  }
  return furthest([&](double factor) {
    EditedCurve scaled = curve;
    scaled.scale(factor);
    return scaled;
  });
}

EditedCurve CurveCeiling::furthest(const std::function<EditedCurve(double)>& made) const {
  EditedCurve best = made(1.0);
  if (allows(best)) return best;
  best = made(0.0);
  if (!allows(best)) return best;
  constexpr int kHalvings = 34;
  double allowed = 0.0, refused = 1.0;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (allowed + refused);
    EditedCurve next = made(middle);
    if (allows(next)) allowed = middle, best = std::move(next);
    else refused = middle;
  }
  return best;
}

}  // namespace pitviper
