#include "scenarios/commands/phong_tables.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

double weightOf(const PhongColour& c) { return c[0] + c[1] + c[2]; }

/// acos where t is near 1: by the chord.
double angleOf(double t) { return 2.0 * std::asin(std::sqrt(std::max(0.0, 0.5 * (1.0 - t)))); }

}  // namespace

UniformTable::UniformTable(const PhongLobe& lobe, int entries) {
  for (int k = 0; k < entries; ++k) entries_.push_back(lobe(static_cast<double>(k) / (entries - 1)));
}
PhongColour UniformTable::at(double t) const { return entries_[static_cast<size_t>(t * static_cast<double>(entries_.size() - 1))]; }

ImportanceTable::ImportanceTable(const PhongLobe& lobe, int entries, int segments) : steps_(std::max(2, (entries - 1) / segments / 2 * 2)) {
  // Cumulated importance over t, finely towards 1 where lobes are.
  constexpr int kCells = 20000;
  std::vector<double> t{0.0}, sum{0.0};
  for (int k = 1; k <= kCells; ++k) {
    const double u = static_cast<double>(k) / kCells;
    t.push_back(1.0 - std::pow(1.0 - u, 3.0));
    sum.push_back(sum.back() + (t[static_cast<size_t>(k)] - t[static_cast<size_t>(k - 1)]) *
                                   weightOf(lobe(0.5 * (t[static_cast<size_t>(k)] + t[static_cast<size_t>(k - 1)]))));
  }
  ends_.push_back(0.0);
  for (int q = 1; q < segments; ++q) {
    const double wanted = sum.back() * q / segments;
    const size_t i = static_cast<size_t>(std::lower_bound(sum.begin(), sum.end(), wanted) - sum.begin());
    ends_.push_back(t[i - 1] + (t[i] - t[i - 1]) * (wanted - sum[i - 1]) / std::max(1e-300, sum[i] - sum[i - 1]));
  }
  ends_.push_back(1.0);
  for (int q = 0; q < segments; ++q)
    for (int k = 0; k <= steps_; ++k) {
      const double a = ends_[static_cast<size_t>(q)], b = ends_[static_cast<size_t>(q + 1)];
      entries_.push_back(lobe(a + (b - a) * k / steps_));
    }
}

PhongColour ImportanceTable::at(double t) const {
  const size_t q = std::min(static_cast<size_t>(std::upper_bound(ends_.begin() + 1, ends_.end() - 1, t) - ends_.begin()) - 1, ends_.size() - 2);
  const double x = (t - ends_[q]) / (ends_[q + 1] - ends_[q]) * steps_;
  // Three entries of this segment: none across its border.
  const int middle = std::clamp(static_cast<int>(std::lround(x)), 1, steps_ - 1);
  const double d = x - middle;
  const PhongColour* e = &entries_[q * static_cast<size_t>(steps_ + 1) + static_cast<size_t>(middle)];
  PhongColour c;
  for (size_t k = 0; k < 3; ++k) c[k] = e[0][k] + 0.5 * d * (e[1][k] - e[-1][k]) + 0.5 * d * d * (e[1][k] - 2.0 * e[0][k] + e[-1][k]);
  return c;
}

AngleTable::AngleTable(const PhongLobe& lobe, int entries) {
  const double peak = weightOf(lobe(1.0));
  double last = 1.5707963267948966;
  while (last > 1e-4 && weightOf(lobe(std::cos(last))) < 1e-5 * peak) last *= 0.99;
  perRadian_ = (entries - 1) / last;
  for (int k = 0; k < entries; ++k) entries_.push_back(lobe(std::cos(k / perRadian_)));
}

PhongColour AngleTable::at(double t) const {
  const double x = std::min(angleOf(t) * perRadian_, static_cast<double>(entries_.size() - 1));
  const size_t k = std::min(static_cast<size_t>(x), entries_.size() - 2);
  const double f = x - static_cast<double>(k);
  PhongColour c;
  for (size_t i = 0; i < 3; ++i) c[i] = entries_[k][i] + f * (entries_[k + 1][i] - entries_[k][i]);
  return c;
}

}  // namespace pitviper
