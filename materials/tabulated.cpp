#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "materials/angle_tables.hpp"
#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Two angles that both depend on the light: up to 1.4 s to integrate over the hemisphere. Others take 3 ms and, with the most entries,
/// half a second.
constexpr std::size_t kMostAnglePairs = 65536;
constexpr double kMostTables = 64.0, kMostTableWavelengths = 1024.0;
constexpr AngleTableKind kBrdf{"a BRDF", "at least 0 per steradian", INFINITY};

class Tabulated final : public ReflectionComponent {
 public:
  explicit Tabulated(BrdfTable table) : table_(std::move(table)) {
    // As fine as the renderer's own grid of view angles where that costs little; a table of thousands of angles gets fewer.
    size_t samples = 0;
    integrateHemisphere(table_.axes, 0.25 * kPi, [&](const LightSample&) { ++samples; });
    int steps = 180;
    for (int fewer : {90, 60, 45, 30})
      if (samples * static_cast<size_t>(steps) > kMostSamples) steps = fewer;
    for (int i = 0; i <= steps; ++i) viewAngle_.push_back(0.5 * kPi * i / steps);
    for (const AngleAxis& axis : table_.axes)
      if (axis.angle == Angle::View)
        for (int j = 0; j < axis.count; ++j)
          if (axis.at(j) < 0.5 * kPi) viewAngle_.push_back(axis.at(j));
    std::sort(viewAngle_.begin(), viewAngle_.end());
    viewAngle_.erase(std::unique(viewAngle_.begin(), viewAngle_.end(), [](double a, double b) { return b - a < 1e-9; }), viewAngle_.end());
    for (double angle : viewAngle_) addAlbedo(angle);
  }
  std::array<AngleAxis, 2> axes() const override { return table_.axes; }
  double column(double w, double angle1, double angle2) const override {
    const auto [iw, fw] = wavelengthPlace(w);
    const auto [i1, f1] = anglePlace(table_.axes[0], angle1);
    const auto [i2, f2] = anglePlace(table_.axes[1], angle2);
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
      const double weight = ((c & 1) ? fw : 1 - fw) * ((c & 2) ? f1 : 1 - f1) * ((c & 4) ? f2 : 1 - f2);
      if (weight > 0.0) sum += weight * at(iw + (c & 1), i1 + ((c >> 1) & 1), i2 + ((c >> 2) & 1));
    }
    return sum;
  }
  double hemispherical(double w, double angle) const override {
    const auto [iw, fw] = wavelengthPlace(w);
    const size_t n = table_.wavelength_um.size();
    const auto above = std::upper_bound(viewAngle_.begin() + 1, viewAngle_.end() - 1, angle);
    const size_t ia = static_cast<size_t>(above - viewAngle_.begin()) - 1;
    const double fa = std::clamp((angle - viewAngle_[ia]) / (viewAngle_[ia + 1] - viewAngle_[ia]), 0.0, 1.0);
    auto albedo = [&](size_t a, size_t i) { return albedo_[a * n + std::min(i, n - 1)]; };
    return (1 - fa) * ((1 - fw) * albedo(ia, iw) + fw * albedo(ia, iw + 1)) + fa * ((1 - fw) * albedo(ia + 1, iw) + fw * albedo(ia + 1, iw + 1));
  }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return table_.wavelength_um; }
  double validLow_um() const override { return table_.wavelength_um.front(); }
  double validHigh_um() const override { return table_.wavelength_um.back(); }

 private:
  /// About half a second.
  static constexpr size_t kMostSamples = 8000000;

  /// The angles cost more than the wavelengths: each cell's share of the hemisphere first, then its values at all wavelengths.
  void addAlbedo(double viewAngle) {
    std::vector<double> share(static_cast<size_t>(table_.axes[0].count) * static_cast<size_t>(table_.axes[1].count), 0.0);
    const size_t columns = static_cast<size_t>(table_.axes[0].count);
    integrateHemisphere(table_.axes, viewAngle, [&](const LightSample& s) {
      const auto [i1, f1] = anglePlace(table_.axes[0], s.angle[0]);
      const auto [i2, f2] = anglePlace(table_.axes[1], s.angle[1]);
      for (int corner = 0; corner < 4; ++corner) {
        const double weight = s.weight * ((corner & 1) ? f1 : 1 - f1) * ((corner & 2) ? f2 : 1 - f2);
        if (weight > 0.0) share[(i2 + static_cast<size_t>(corner >> 1)) * columns + i1 + static_cast<size_t>(corner & 1)] += weight;
      }
    });
    const size_t wavelengths = table_.wavelength_um.size(), first = albedo_.size();
    albedo_.resize(first + wavelengths, 0.0);
    for (size_t cell = 0; cell < share.size(); ++cell) {
      if (share[cell] == 0.0) continue;
      for (size_t w = 0; w < wavelengths; ++w) albedo_[first + w] += share[cell] * table_.values[cell * wavelengths + w];
    }
  }

  std::pair<size_t, double> wavelengthPlace(double w) const {
    const auto& x = table_.wavelength_um;
    if (w < x.front() || w > x.back()) throw OutsideSpectrum("a BRDF table has no data at " + std::to_string(w) + " um");
    if (x.size() == 1) return {0, 0.0};
    const size_t i = std::min(static_cast<size_t>(std::upper_bound(x.begin(), x.end(), w) - x.begin()) - 1, x.size() - 2);
    return {i, (w - x[i]) / (x[i + 1] - x[i])};
  }
  static std::pair<size_t, double> anglePlace(const AngleAxis& axis, double angle) {
    if (axis.count < 2) return {0, 0.0};
    const double x = std::clamp(angle / axis.last_rad, 0.0, 1.0) * (axis.count - 1);
    const size_t i = std::min(static_cast<size_t>(x), static_cast<size_t>(axis.count - 2));
    return {i, x - static_cast<double>(i)};
  }
  /// Where the wavelengths of two angles begin.
  size_t rowAt(size_t a1, size_t a2) const {
    a1 = std::min(a1, static_cast<size_t>(table_.axes[0].count - 1));
    a2 = std::min(a2, static_cast<size_t>(table_.axes[1].count - 1));
    return (a2 * static_cast<size_t>(table_.axes[0].count) + a1) * table_.wavelength_um.size();
  }
  double at(size_t w, size_t a1, size_t a2) const { return table_.values[rowAt(a1, a2) + std::min(w, table_.wavelength_um.size() - 1)]; }

  BrdfTable table_;
  std::vector<double> viewAngle_, albedo_;  ///< albedo by view angle and wavelength
};

std::shared_ptr<ReflectionComponent> readTable(const Record& r) {
  BrdfTable t;
  t.wavelength_um = readTableWavelengths(r.value("wavelength"), kBrdf);
  std::vector<size_t> extents{t.wavelength_um.size()};
  if (r.given("angles")) {
    size_t k = 0;
    for (const Value& a : r.value("angles").items) {
      t.axes[k] = readAngleAxis(a);
      extents.insert(extents.begin(), static_cast<size_t>(t.axes[k++].count));
    }
    if (k == 2 && t.axes[0].angle == t.axes[1].angle) throw UserError(r.where("angles"), "both axes are the same angle", "two different angles", "change one");
  }
  const auto ofLight = [](const AngleAxis& a) { return a.angle != Angle::None && a.angle != Angle::View; };
  const auto pairs = static_cast<std::size_t>(t.axes[0].count) * static_cast<std::size_t>(t.axes[1].count);
  if (ofLight(t.axes[0]) && ofLight(t.axes[1]) && pairs > kMostAnglePairs)
    throw UserError(r.where("angles"), "a BRDF table over " + std::to_string(pairs) + " pairs of angles", "at most " + std::to_string(kMostAnglePairs),
                    "thin it out");
  t.values = readTableValues(r, kBrdf, extents);
  return makeTabulated(std::move(t));
}

}  // namespace

std::shared_ptr<ReflectionComponent> makeTabulated(BrdfTable table) {
  const size_t wanted = table.wavelength_um.size() * static_cast<size_t>(table.axes[0].count) * static_cast<size_t>(table.axes[1].count);
  if (table.values.size() != wanted) throw std::invalid_argument("a BRDF table of the wrong size");
  return std::make_shared<Tabulated>(std::move(table));
}

ReflectionModel tabulatedModel() {
  return {"table",
          "A BRDF by wavelength and up to two angles, linear between.",
          {required(list("wavelength", "rising wavelengths", 1, 1024)), list("angles", "up to two axes", 0, 2),
           required(list("values", "BRDF [1/sr], nested as values[angle 2][angle 1][wavelength]", 1, 4096))},
          [](const ComponentRecord& r) { return readTable(r.record); },
          [](const Record& r) { return std::max(1.0 / kMostTables, static_cast<double>(r.value("wavelength").items.size()) / kMostTableWavelengths); }};
}

}  // namespace pitviper
