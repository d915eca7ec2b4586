#include "materials/reflection.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

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
  double validLow_um() const override { return reflectance_.validLow(); }
  double validHigh_um() const override { return reflectance_.validHigh(); }

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
  std::string lobeFile() const override { return "materials/phong.glsl"; }
  double lobe(const glm::dvec3& l, const glm::dvec3& v) const override { return physics::lobe(exponent_, {0, 0, 1}, l, v); }
  double hemispherical(double w, double angle) const override {
    const double x = std::clamp(angle / (0.5 * kPi), 0.0, 1.0) * kAngles;
    const auto i = std::min(static_cast<size_t>(x), static_cast<size_t>(kAngles - 1));
    return reflectance_(w) * (albedo_[i] + (x - static_cast<double>(i)) * (albedo_[i + 1] - albedo_[i]));
  }
  bool hemisphericalVaries() const override { return true; }
  double validLow_um() const override { return reflectance_.validLow(); }
  double validHigh_um() const override { return reflectance_.validHigh(); }

 private:
  static constexpr int kAngles = 360;
  Spectrum reflectance_;
  double exponent_;
  std::vector<double> albedo_;
};

class Tabulated final : public ReflectionComponent {
 public:
  explicit Tabulated(BrdfTable table) : table_(std::move(table)) {
    for (int i = 0; i <= kAngles; ++i) addAlbedo(0.5 * kPi * i / kAngles);
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
    const auto [ia, fa] = anglePlace({Angle::View, kAngles + 1, 0.5 * kPi}, angle);
    const size_t n = table_.wavelength_um.size();
    auto albedo = [&](size_t a, size_t i) { return albedo_[std::min(a, static_cast<size_t>(kAngles)) * n + std::min(i, n - 1)]; };
    return (1 - fa) * ((1 - fw) * albedo(ia, iw) + fw * albedo(ia, iw + 1)) + fa * ((1 - fw) * albedo(ia + 1, iw) + fw * albedo(ia + 1, iw + 1));
  }
  bool hemisphericalVaries() const override { return true; }
  double validLow_um() const override { return table_.wavelength_um.front(); }
  double validHigh_um() const override { return table_.wavelength_um.back(); }

 private:
  static constexpr int kAngles = 90;

  /// The rule of ReflectionComponent::hemispherical() for all wavelengths at once: the angles cost more than the table. A table does not
  /// tell one side of the plane of view from the other, so half the azimuths do.
  void addAlbedo(double viewAngle) {
    static const auto polar = gaussLegendre(48, 0.0, 1.0);
    constexpr int azimuths = 64;
    const size_t wavelengths = table_.wavelength_um.size(), first = albedo_.size();
    albedo_.resize(first + wavelengths, 0.0);
    const glm::dvec3 view(std::sin(viewAngle), 0.0, std::cos(viewAngle));
    for (const auto& p : polar) {
      const double c = std::sqrt(p.x), s = std::sqrt(1.0 - p.x);
      for (int i = 0; i < azimuths / 2; ++i) {
        const double phi = 2.0 * kPi * (i + 0.5) / azimuths;
        const glm::dvec3 light(s * std::cos(phi), s * std::sin(phi), c);
        const auto [i1, f1] = anglePlace(table_.axes[0], angleBetween(table_.axes[0].angle, light, view));
        const auto [i2, f2] = anglePlace(table_.axes[1], angleBetween(table_.axes[1].angle, light, view));
        for (int corner = 0; corner < 4; ++corner) {
          const double weight = 2.0 * kPi / azimuths * p.weight * ((corner & 1) ? f1 : 1 - f1) * ((corner & 2) ? f2 : 1 - f2);
          if (weight == 0.0) continue;
          const double* row = &table_.values[rowAt(i1 + (corner & 1), i2 + ((corner >> 1) & 1))];
          for (size_t w = 0; w < wavelengths; ++w) albedo_[first + w] += weight * row[w];
        }
      }
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
  double at(size_t w, size_t a1, size_t a2) const {
    return table_.values[rowAt(a1, a2) + std::min(w, table_.wavelength_um.size() - 1)];
  }

  BrdfTable table_;
  std::vector<double> albedo_;  ///< by view angle and wavelength
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
