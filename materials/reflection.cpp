#include "materials/reflection.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/phong.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

class Lambertian final : public ReflectionComponent {
 public:
  explicit Lambertian(Spectrum reflectance) : reflectance_(std::move(reflectance)) {}
  double column(double w, double, double) const override { return reflectance_(w) / kPi; }
  double hemispherical(double w, double) const override { return reflectance_(w); }
  bool hemisphericalVaries() const override { return false; }
  std::vector<double> knots_um() const override { return reflectance_.knots(); }
  double validLow_um() const override { return reflectance_.validLow(); }
  double validHigh_um() const override { return reflectance_.validHigh(); }
  void addTo(Fingerprint& f) const override {
    f.add("lambertian");
    pitviper::addTo(f, reflectance_);
  }

 private:
  Spectrum reflectance_;
};

/// Directional-hemispherical reflectance of the unit Phong lobe:
///   A(theta) = (n + 2) / (n + 1) / (2 pi) integral_0^1 dt integral dphi max(0, cos theta cos alpha + sin theta sin alpha cos phi),
/// t = cos^(n+1) alpha; the azimuth integral in closed form.
class PhongAlbedo {
 public:
  explicit PhongAlbedo(double n) : factor_((n + 2.0) / (n + 1.0) / (2.0 * kPi)) {
    static const double edges[] = {0.0, 1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0};
    for (const auto& node : fineNodes(0.0, 1.0, edges, 512)) {
      const double ca = std::pow(node.x, 1.0 / (n + 1.0));
      rings_.push_back({ca, std::sqrt(std::max(0.0, 1.0 - ca * ca)), node.weight});
    }
  }
  double at(double theta) const;

 private:
  struct Ring {
    double cosine, sine, weight;
  };
  double factor_;
  std::vector<Ring> rings_;
};

double PhongAlbedo::at(double theta) const {
  const double ct = std::cos(theta), st = std::sin(theta);
  double sum = 0.0;
  for (const Ring& r : rings_) {
    const double a = ct * r.cosine, b = st * r.sine;
    double ring = 2.0 * kPi * a;
    if (b > a) {
      const double phi = std::acos(std::clamp(-a / b, -1.0, 1.0));
      ring = 2.0 * (phi * a + b * std::sin(phi));
    }
    sum += r.weight * ring;
  }
  return factor_ * sum;
}

class Phong final : public ReflectionComponent {
 public:
  Phong(Spectrum reflectance, double exponent) : reflectance_(std::move(reflectance)), exponent_(exponent) {
    const PhongAlbedo albedo(exponent);
    for (int i = 0; i <= kAngles; ++i) albedo_.push_back(albedo.at(0.5 * kPi * i / kAngles));
  }
  double column(double w, double, double) const override { return reflectance_(w); }
  double lobeExponent() const override { return exponent_; }
  double lobeMaximum() const override { return (exponent_ + 2.0) / (2.0 * kPi); }
  std::string lobeFile() const override { return "materials/phong.glsl"; }
  double lobe(const glm::dvec3& l, const glm::dvec3& v) const override { return physics::lobe(exponent_, {0, 0, 1}, l, v); }
  double hemispherical(double w, double angle) const override {
    const double x = std::clamp(angle / (0.5 * kPi), 0.0, 1.0) * kAngles;
    const auto i = std::min(static_cast<size_t>(x), static_cast<size_t>(kAngles - 1));
    return reflectance_(w) * (albedo_[i] + (x - static_cast<double>(i)) * (albedo_[i + 1] - albedo_[i]));
  }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return reflectance_.knots(); }
  double validLow_um() const override { return reflectance_.validLow(); }
  double validHigh_um() const override { return reflectance_.validHigh(); }
  void addTo(Fingerprint& f) const override {
    f.add("phong").add(exponent_);
    pitviper::addTo(f, reflectance_);
  }

 private:
  static constexpr int kAngles = 360;
  Spectrum reflectance_;
  double exponent_;
  std::vector<double> albedo_;
};

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
  void addTo(Fingerprint& f) const override {
    f.add("table").all(table_.wavelength_um).all(table_.values);
    for (const AngleAxis& a : table_.axes) f.add(static_cast<int>(a.angle)).add(a.count).add(a.last_rad);
  }

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

}  // namespace

std::shared_ptr<const ReflectionComponent> makeLambertian(Spectrum reflectance) { return std::make_shared<Lambertian>(std::move(reflectance)); }
std::shared_ptr<const ReflectionComponent> makePhong(Spectrum reflectance, double exponent) {
  return std::make_shared<Phong>(std::move(reflectance), exponent);
}
std::shared_ptr<const ReflectionComponent> makeTabulated(BrdfTable table) {
  const size_t wanted = table.wavelength_um.size() * static_cast<size_t>(table.axes[0].count) * static_cast<size_t>(table.axes[1].count);
  if (table.values.size() != wanted) throw std::invalid_argument("a BRDF table of the wrong size");
  return std::make_shared<Tabulated>(std::move(table));
}

}  // namespace pitviper
