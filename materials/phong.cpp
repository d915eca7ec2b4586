#include <algorithm>

#include "materials/models.hpp"
#include "materials/phong_albedo.hpp"
#include "materials/reflection.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/phong.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

/// Each lobe takes about a millisecond to integrate over the hemisphere.
constexpr double kMostLobes = 256.0;

class Phong final : public ReflectionComponent {
 public:
  Phong(Spectrum reflectance, double exponent)
      : ReflectionComponent({"materials/phong.glsl", "phongLobe", {exponent, 0.0, 0.0, 0.0}, (exponent + 2.0) / (2.0 * kPi), exponent}),
        reflectance_(std::move(reflectance)) {
    const PhongAlbedo albedo(exponent);
    for (int i = 0; i <= kAngles; ++i) albedo_.push_back(albedo.at(0.5 * kPi * i / kAngles));
  }
  double column(double w, double, double) const override { return reflectance_(w); }
  double lobeAt(const glm::dvec3& l, const glm::dvec3& v) const override { return physics::phongLobe(lobe().parameters, {0, 0, 1}, l, v); }
  double hemispherical(double w, double angle) const override {
    const double x = std::clamp(angle / (0.5 * kPi), 0.0, 1.0) * kAngles;
    const auto i = std::min(static_cast<size_t>(x), static_cast<size_t>(kAngles - 1));
    return reflectance_(w) * (albedo_[i] + (x - static_cast<double>(i)) * (albedo_[i + 1] - albedo_[i]));
  }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return reflectance_.knots(); }
  double validLow_um() const override { return reflectance_.validLow(); }
  double validHigh_um() const override { return reflectance_.validHigh(); }

 private:
  static constexpr int kAngles = 360;
  Spectrum reflectance_;
  std::vector<double> albedo_;
};

}  // namespace

std::shared_ptr<ReflectionComponent> makePhong(Spectrum reflectance, double exponent) { return std::make_shared<Phong>(std::move(reflectance), exponent); }

ReflectionModel phongModel() {
  return {"phong",
          "An energy-normalised lobe about the mirrored direction: f = reflectance (n + 2) / (2 pi) cos^n(alpha).",
          {required(within(spectrum("reflectance", "", "at normal view; it falls as the cosine of the view angle (a table can hold Fresnel's rise)"), 0, 1)),
           required(within(number("exponent", "", "n: the greater, the narrower"), 0, 1e7))},
          [](const ComponentRecord& r) { return makePhong(r.spectrum("reflectance"), r.record.number("exponent")); },
          [](const Record&) { return 1.0 / kMostLobes; }};
}

}  // namespace pitviper
