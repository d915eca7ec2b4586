// Phong's lobe whose share and width change with wavelength, beside a diffuse part: read from a table over the angle to the mirrored direction.
#include <algorithm>
#include <cmath>

#include "materials/models.hpp"
#include "materials/phong_albedo.hpp"
#include "materials/reflection.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kQuarter = 0.5 * kPi;
/// Steps of the table: the narrowest lobe falls by so much less than its tangent says within one.
constexpr double kBend = 2e-4;
constexpr int kFewestAngles = 200, kMostAngles = 1024;
constexpr double kMostExponent = 1e5;
constexpr double kMostLobes = 64.0;

class SpectralPhong final : public ReflectionComponent {
 public:
  SpectralPhong(Spectrum diffuse, Spectrum specular, Spectrum exponent, double low, double high)
      : diffuse_(std::move(diffuse)), specular_(std::move(specular)), exponent_(std::move(exponent)), low_(low), high_(std::max(high, low)) {
    // Beyond its last entry the widest lobe is below 1e-8 of its height.
    const double last = std::min(kQuarter, std::acos(std::exp(-18.4 / std::max(low_, 1e-3)))), step = std::sqrt(8.0 * kBend / std::max(high_, 1.0));
    angles_ = {Angle::Specular, std::clamp(static_cast<int>(std::ceil(last / step)) + 1, kFewestAngles, kMostAngles), last};
    steps_ = (high_ + 1.0) / (low_ + 1.0) > 1.0 + 1e-9 ? 24 : 1;
    for (int k = 0; k <= (steps_ > 1 ? steps_ : 0); ++k) {
      const PhongAlbedo albedo(exponentAt(k));
      for (int j = 0; j <= kViews; ++j) albedo_.push_back(albedo.at(kQuarter * j / kViews));
    }
  }
  std::array<AngleAxis, 2> axes() const override { return {angles_, AngleAxis{}}; }
  double column(double w, double angle, double) const override {
    const double n = exponent_(w), c = std::cos(std::min(angle, angles_.last_rad));
    return diffuse_(w) / kPi + specular_(w) * (n + 2.0) / (2.0 * kPi) * (c > 0.0 ? std::pow(c, n) : 0.0);
  }
  /// n step^2 / 8 of the peak of the narrowest lobe: where exponents lie far apart, more than kBend.
  double angleError() const override { return high_ * std::pow(angles_.at(1), 2.0) / 8.0; }
  double hemispherical(double w, double angle) const override {
    const double n = exponent_(w),
                 along = steps_ > 1 ? std::clamp(std::log((n + 1.0) / (low_ + 1.0)) / std::log((high_ + 1.0) / (low_ + 1.0)), 0.0, 1.0) * steps_ : 0.0;
    const int k = std::min(static_cast<int>(along), std::max(steps_ - 1, 0)), next = steps_ > 1 ? k + 1 : k;
    const double x = std::clamp(angle / kQuarter, 0.0, 1.0) * kViews, f = along - k;
    const int j = std::min(static_cast<int>(x), kViews - 1);
    const double g = x - j;
    const auto at = [&](int row, int view) { return albedo_[static_cast<size_t>(row * (kViews + 1) + view)]; };
    return diffuse_(w) + specular_(w) * ((1 - f) * ((1 - g) * at(k, j) + g * at(k, j + 1)) + f * ((1 - g) * at(next, j) + g * at(next, j + 1)));
  }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return (diffuse_ * specular_ * exponent_).knots(); }
  double validLow_um() const override { return std::max({diffuse_.validLow(), specular_.validLow(), exponent_.validLow()}); }
  double validHigh_um() const override { return std::min({diffuse_.validHigh(), specular_.validHigh(), exponent_.validHigh()}); }

 private:
  static constexpr int kViews = 90;
  double exponentAt(int k) const { return (low_ + 1.0) * std::pow((high_ + 1.0) / (low_ + 1.0), static_cast<double>(k) / steps_) - 1.0; }
  Spectrum diffuse_, specular_, exponent_;
  double low_, high_;
  AngleAxis angles_;
  int steps_ = 1;
  std::vector<double> albedo_;  ///< by exponent, then view angle
};

}  // namespace

ReflectionModel spectralPhongModel() {
  return {"spectral_phong",
          "A diffuse part and Phong's lobe whose exponent changes with wavelength too: f = diffuse / pi + specular (n + 2) / (2 pi) cos^n(alpha).",
          {required(within(spectrum("diffuse", "", "albedo of the diffuse part"), 0, 1)),
           required(within(spectrum("specular", "", "of the lobe, at normal view"), 0, 1)),
           required(within(spectrum("exponent", "", "n: the greater, the narrower"), 0, kMostExponent))},
          [](const ComponentRecord& r) -> std::shared_ptr<ReflectionComponent> {
            const Spectrum& n = r.spectrum("exponent");
            const double low = std::max(n.validLow(), kShortestWavelength_um), high = std::min(n.validHigh(), kLongestWavelength_um);
            return std::make_shared<SpectralPhong>(r.spectrum("diffuse"), r.spectrum("specular"), n, n.minimum(low, high), n.maximum(low, high));
          },
          [](const Record&) { return 1.0 / kMostLobes; }};
}

}  // namespace pitviper
