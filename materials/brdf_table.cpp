#include "materials/brdf_table.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {
namespace {

/// Of a walk over the hemisphere at every view angle: about half a second.
constexpr size_t kMostSamples = 8000000;

struct Place {
  size_t low;
  double share;  ///< of the next
};

Place wavelengthPlace(const std::vector<double>& x, double w) {
  if (w < x.front() || w > x.back()) throw OutsideSpectrum("a BRDF table has no data at " + std::to_string(w) + " um");
  if (x.size() == 1) return {0, 0.0};
  const size_t i = std::min(static_cast<size_t>(std::upper_bound(x.begin(), x.end(), w) - x.begin()) - 1, x.size() - 2);
  return {i, (w - x[i]) / (x[i + 1] - x[i])};
}

Place anglePlace(const AngleAxis& axis, double angle) {
  if (axis.count < 2) return {0, 0.0};
  const double x = std::clamp(angle / axis.last_rad, 0.0, 1.0) * (axis.count - 1);
  const size_t i = std::min(static_cast<size_t>(x), static_cast<size_t>(axis.count - 2));
  return {i, x - static_cast<double>(i)};
}

/// As fine as the renderer's own grid of view angles where that costs little; a table of thousands of angles gets fewer.
std::vector<double> viewAnglesOf(const std::array<AngleAxis, 2>& axes) {
  size_t samples = 0;
  integrateHemisphere(axes, 0.25 * kPi, [&](const LightSample&) { ++samples; });
  int steps = 180;
  for (int fewer : {90, 60, 45, 30})
    if (samples * static_cast<size_t>(steps) > kMostSamples) steps = fewer;
  std::vector<double> all;
  for (int i = 0; i <= steps; ++i) all.push_back(0.5 * kPi * i / steps);
  for (const AngleAxis& axis : axes)
    if (axis.angle == Angle::View)
      for (int j = 0; j < axis.count; ++j)
        if (axis.at(j) < 0.5 * kPi) all.push_back(axis.at(j));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end(), [](double a, double b) { return b - a < 1e-9; }), all.end());
  return all;
}

class Tabulated final : public ReflectionComponent {
 public:
  Tabulated(BrdfTable table, ViewAlbedo albedo, Lobe lobe = {}, std::function<double(const glm::dvec3&, const glm::dvec3&)> lobeAt = {})
      : ReflectionComponent(std::move(lobe)), table_(std::move(table)), albedo_(std::move(albedo)), lobeAt_(std::move(lobeAt)) {}
  std::array<AngleAxis, 2> axes() const override { return table_.axes; }
  std::array<AngleAxis, 2> integrationAxes(bool) const override { return table_.axes; }
  double column(double w, double angle1, double angle2) const override { return table_.at(w, angle1, angle2); }
  double lobeAt(const glm::dvec3& light, const glm::dvec3& view) const override { return lobeAt_ ? lobeAt_(light, view) : 1.0; }
  double hemispherical(double w, double angle) const override {
    const auto [iw, fw] = wavelengthPlace(table_.wavelength_um, w);
    const auto& views = albedo_.viewAngle_rad;
    const size_t n = table_.wavelength_um.size();
    const size_t ia = static_cast<size_t>(std::upper_bound(views.begin() + 1, views.end() - 1, angle) - views.begin()) - 1;
    const double fa = std::clamp((angle - views[ia]) / (views[ia + 1] - views[ia]), 0.0, 1.0);
    const auto albedo = [&](size_t a, size_t i) { return albedo_.values[a * n + std::min(i, n - 1)]; };
    return (1 - fa) * ((1 - fw) * albedo(ia, iw) + fw * albedo(ia, iw + 1)) + fa * ((1 - fw) * albedo(ia + 1, iw) + fw * albedo(ia + 1, iw + 1));
  }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return table_.wavelength_um; }
  double validLow_um() const override { return table_.wavelength_um.front(); }
  double validHigh_um() const override { return table_.wavelength_um.back(); }

 private:
  BrdfTable table_;
  ViewAlbedo albedo_;
  std::function<double(const glm::dvec3&, const glm::dvec3&)> lobeAt_;
};

}  // namespace

double BrdfTable::at(double w, double angle1, double angle2) const {
  const auto [iw, fw] = wavelengthPlace(wavelength_um, w);
  const auto [i1, f1] = anglePlace(axes[0], angle1);
  const auto [i2, f2] = anglePlace(axes[1], angle2);
  const size_t wavelengths = wavelength_um.size(), along = static_cast<size_t>(axes[0].count);
  double sum = 0.0;
  for (size_t c = 0; c < 8; ++c) {
    const double weight = ((c & 1) ? fw : 1 - fw) * ((c & 2) ? f1 : 1 - f1) * ((c & 4) ? f2 : 1 - f2);
    if (weight > 0.0) sum += weight * values[((i2 + (c >> 2)) * along + i1 + ((c >> 1) & 1)) * wavelengths + iw + (c & 1)];
  }
  return sum;
}

std::vector<ViewAlbedo> albedosOf(const std::vector<BrdfTable>& parts, const LobesAt& lobesAt, int azimuths) {
  const BrdfTable& first = parts.front();
  const std::vector<double> views = viewAnglesOf(first.axes);
  std::vector<ViewAlbedo> all(parts.size(), {views, {}});
  const size_t columns = static_cast<size_t>(first.axes[0].count), cells = columns * static_cast<size_t>(first.axes[1].count);
  const size_t wavelengths = first.wavelength_um.size();
  std::vector<double> lobes(parts.size(), 1.0);
  for (double angle : views) {
    const glm::dvec3 view(std::sin(angle), 0.0, std::cos(angle));
    // The angles cost more than the wavelengths: each cell's share of the hemisphere first, then its values at all wavelengths.
    std::vector<std::vector<double>> share(parts.size(), std::vector<double>(cells, 0.0));
    integrateHemisphere(first.axes, angle, [&](const LightSample& s) {
      if (lobesAt) lobesAt(s.light, view, lobes);
      const auto [i1, f1] = anglePlace(first.axes[0], s.angle[0]);
      const auto [i2, f2] = anglePlace(first.axes[1], s.angle[1]);
      for (size_t corner = 0; corner < 4; ++corner) {
        const double weight = s.weight * ((corner & 1) ? f1 : 1 - f1) * ((corner & 2) ? f2 : 1 - f2);
        if (weight == 0.0) continue;
        for (size_t k = 0; k < parts.size(); ++k) share[k][(i2 + (corner >> 1)) * columns + i1 + (corner & 1)] += weight * lobes[k];
      }
    }, azimuths);
    for (size_t k = 0; k < parts.size(); ++k) {
      auto& to = all[k].values;
      const size_t at = to.size();
      to.resize(at + wavelengths, 0.0);
      for (size_t cell = 0; cell < cells; ++cell)
        for (size_t w = 0; share[k][cell] != 0.0 && w < wavelengths; ++w) to[at + w] += share[k][cell] * parts[k].values[cell * wavelengths + w];
    }
  }
  return all;
}

std::shared_ptr<ReflectionComponent> makeTabulated(BrdfTable table) {
  const size_t wanted = table.wavelength_um.size() * static_cast<size_t>(table.axes[0].count) * static_cast<size_t>(table.axes[1].count);
  if (table.values.size() != wanted) throw std::invalid_argument("a BRDF table of the wrong size");
  auto albedo = albedosOf({table}, {}).front();
  return std::make_shared<Tabulated>(std::move(table), std::move(albedo));
}

std::shared_ptr<ReflectionComponent> makeTabulated(BrdfTable table, ViewAlbedo albedo, Lobe lobe,
                                                   std::function<double(const glm::dvec3& light, const glm::dvec3& view)> lobeAt) {
  return std::make_shared<Tabulated>(std::move(table), std::move(albedo), std::move(lobe), std::move(lobeAt));
}

}  // namespace pitviper
