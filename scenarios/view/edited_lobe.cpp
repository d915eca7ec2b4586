#include "scenarios/view/edited_lobe.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

constexpr double kQuarter = 0.5 * kPi;
constexpr double kMostExponent = 1e5;

/// Albedos over the logarithm of n + 1 and the view angle.
class AlbedoTable {
 public:
  AlbedoTable() {
    for (int k = 0; k <= kRows; ++k)
      for (int j = 0; j <= kViews; ++j)
        values_[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)] =
            phongLobeAlbedo(std::expm1(std::log1p(kMostExponent) * k / kRows), kQuarter * j / kViews);
  }
  double at(double n, double angle) const {
    const double along = std::clamp(std::log1p(n) / std::log1p(kMostExponent), 0.0, 1.0) * kRows, x = std::clamp(angle / kQuarter, 0.0, 1.0) * kViews;
    const auto k = static_cast<std::size_t>(std::min(static_cast<int>(along), kRows - 1)),
               j = static_cast<std::size_t>(std::min(static_cast<int>(x), kViews - 1));
    const double f = along - static_cast<double>(k), g = x - static_cast<double>(j);
    return (1 - f) * ((1 - g) * values_[k][j] + g * values_[k][j + 1]) + f * ((1 - g) * values_[k + 1][j] + g * values_[k + 1][j + 1]);
  }

 private:
  static constexpr int kRows = 96, kViews = 90;
  std::array<std::array<double, kViews + 1>, kRows + 1> values_{};
};

const AlbedoTable& albedos() {
  static const AlbedoTable table;
  return table;
}

class EditedPhong final : public ReflectionComponent {
 public:
  EditedPhong(Spectrum diffuse, Spectrum specular, Spectrum exponent)
      : diffuse_(std::move(diffuse)), specular_(std::move(specular)), exponent_(std::move(exponent)) {
    const double from = std::max(exponent_.validLow(), kShortestWavelength_um), to = std::min(exponent_.validHigh(), kLongestWavelength_um);
    const double low = exponent_.minimum(from, to);
    high_ = std::max(exponent_.maximum(from, to), low);
    // As materials/spectral_phong.cpp has them: to where the widest lobe is below 1e-8 of its height, steps that the narrowest bends by 2e-4 in.
    const double last = std::min(kQuarter, std::acos(std::exp(-18.4 / std::max(low, 1e-3)))), step = std::sqrt(8.0 * 2e-4 / std::max(high_, 1.0));
    angles_ = {Angle::Specular, std::clamp(static_cast<int>(std::ceil(last / step)) + 1, 200, 1024), last};
    Fingerprint f;
    f.add("edited spectral_phong");
    for (const Spectrum* s : {&diffuse_, &specular_, &exponent_}) addTo(f, *s);
    setFingerprint(f.bytes());
  }
  std::array<AngleAxis, 2> axes() const override { return {angles_, AngleAxis{}}; }
  double column(double w, double angle, double) const override {
    const double n = exponent_(w), c = std::cos(std::min(angle, angles_.last_rad));
    return diffuse_(w) / kPi + specular_(w) * (n + 2.0) / (2.0 * kPi) * (c > 0.0 ? std::pow(c, n) : 0.0);
  }
  double angleError() const override { return high_ * std::pow(angles_.at(1), 2.0) / 8.0; }
  double hemispherical(double w, double angle) const override { return diffuse_(w) + specular_(w) * albedos().at(exponent_(w), angle); }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return (diffuse_ * specular_ * exponent_).knots(); }
  double validLow_um() const override { return std::max({diffuse_.validLow(), specular_.validLow(), exponent_.validLow()}); }
  double validHigh_um() const override { return std::min({diffuse_.validHigh(), specular_.validHigh(), exponent_.validHigh()}); }

 private:
  Spectrum diffuse_, specular_, exponent_;
  double high_ = 0.0;
  AngleAxis angles_;
};

}  // namespace

double phongLobeAlbedo(double n, double theta) {
  const double st = std::sin(theta), ct = std::cos(theta);
  if (st <= 0.0) return 1.0;
  // c = sin(theta) exp(-y^2 / (n + 1)): the power becomes a Gaussian, and where the horizon begins to cut, the rings are smooth in y.
  static const auto rule = gaussLegendre(32, 0.0, 5.5);
  double sum = 0.0;
  for (const auto& node : rule) {
    const double y = node.x, s = std::exp(-y * y / (n + 1.0)), c = st * s;
    const double phi = std::acos(std::clamp(-c * ct / (st * std::sqrt((1.0 - c) * (1.0 + c))), -1.0, 1.0));
    const double ring = phi * c * ct + st * std::sqrt(std::max(0.0, -std::expm1(-2.0 * y * y / (n + 1.0))));
    sum += node.weight * std::exp(-y * y) * 2.0 * y / (n + 1.0) * ring;
  }
  return std::min(1.0, ct * (1.0 - std::pow(st, n + 2.0)) + (n + 2.0) / kPi * std::pow(st, n + 1.0) * sum);
}

std::shared_ptr<ReflectionComponent> makeEditedPhong(Spectrum diffuse, Spectrum specular, Spectrum exponent) {
  return std::make_shared<EditedPhong>(std::move(diffuse), std::move(specular), std::move(exponent));
}

}  // namespace pitviper
