// Beard and Maxwell's model of paints as the Nonconventional Exploitation Factors database has it: facets by a retroreflection scan, a diffuse part, and light
// out of the volume.
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "materials/film_stack.hpp"
#include "materials/lobe_shares.hpp"
#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/beard_maxwell.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

constexpr double kQuarter = 0.5 * kPi;
constexpr int kAngles = 46;
/// cos_i + cos_o of two directions 0.6 deg above the horizon: where the light out of the volume ends.
constexpr double kGrazing = 0.02;

struct Paint {
  Spectrum n, k, diffuse, volume;  ///< diffuse and volume [1/sr]
  glm::dvec4 scan;                 ///< B, sigma, tau, Omega
  bool published;
  double low_um() const { return std::max({n.validLow(), k.validLow(), diffuse.validLow(), volume.validLow()}); }
  double high_um() const { return std::min({n.validHigh(), k.validHigh(), diffuse.validHigh(), volume.validHigh()}); }
  std::vector<double> knots() const { return (n * k * diffuse * volume).knots(); }
  /// rho_D + 2 rho_V / (cos_i + cos_o) over all light: pi rho_D + 4 pi rho_V (1 - c ln((1 + c) / c)).
  double bodyAlbedo(double w, double angle) const {
    const double c = std::max(std::cos(angle), 1e-9);
    return kPi * diffuse(w) + 4.0 * kPi * volume(w) * (1.0 - c * std::log1p(1.0 / c));
  }
};

class Body final : public ReflectionComponent {
 public:
  explicit Body(Paint paint) : paint_(std::move(paint)) {}
  std::array<AngleAxis, 2> axes() const override { return {AngleAxis{Angle::Incidence, kAngles, kQuarter}, AngleAxis{Angle::View, kAngles, kQuarter}}; }
  double column(double w, double in, double out) const override {
    return paint_.diffuse(w) + 2.0 * paint_.volume(w) / std::max(std::cos(in) + std::cos(out), kGrazing);
  }
  double hemispherical(double w, double angle) const override { return paint_.bodyAlbedo(w, angle); }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return paint_.knots(); }
  double validLow_um() const override { return paint_.low_um(); }
  double validHigh_um() const override { return paint_.high_um(); }

 private:
  Paint paint_;
};

/// The facets: lobe x R(beta) / R(0), of the bounded form scaled so that no view returns more than it receives.
class Facets final : public ReflectionComponent {
 public:
  explicit Facets(Paint paint)
      // The lobe rises towards grazing views; a hundredfold covers them to 89 degrees.
      : ReflectionComponent({"materials/beard_maxwell.glsl", paint.published ? "beardMaxwellFacets" : "beardMaxwellBounded", paint.scan,
                             100.0 * paint.scan.x / (paint.scan.y * paint.scan.y), std::max(0.0, 0.5 / (paint.scan.y * paint.scan.y) - 1.0)}),
        paint_(std::move(paint)) {
    shares_ =
        lobeShares([this](const glm::dvec3& l, const glm::dvec3& v) { return lobeAt(l, v); }, Sampled::Trowbridge, paint_.scan.y, Angle::Difference, kAngles);
  }
  std::array<AngleAxis, 2> axes() const override { return {AngleAxis{Angle::Difference, kAngles, kQuarter}, AngleAxis{}}; }
  double column(double w, double beta, double) const override {
    const auto& row = rowAt(w);
    return row.scale * byAngle(row.fresnel, beta);
  }
  double lobeAt(const glm::dvec3& l, const glm::dvec3& v) const override {
    return paint_.published ? physics::beardMaxwellFacets(lobe().parameters, {0, 0, 1}, l, v)
                            : physics::beardMaxwellBounded(lobe().parameters, {0, 0, 1}, l, v);
  }
  double hemispherical(double w, double angle) const override { return byAngle(rowAt(w).hemispherical, angle); }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return paint_.knots(); }
  double validLow_um() const override { return paint_.low_um(); }
  double validHigh_um() const override { return paint_.high_um(); }

 private:
  struct Row {
    std::vector<double> fresnel;        ///< R(beta) / R(0)
    std::vector<double> hemispherical;  ///< by view angle, scaled
    double scale = 1.0;
  };
  const Row& rowAt(double w) const {
    const std::lock_guard lock(mutex_);
    auto& row = rows_[w];
    if (!row.fresnel.empty()) return row;
    const std::complex<double> index(paint_.n(w), paint_.k(w));
    const double normal = filmPower({}, index, w, 0.0).reflectance;
    for (int j = 0; j < kAngles; ++j)
      row.fresnel.push_back(normal > 0.0 ? filmPower({}, index, w, std::sin(std::min(kQuarter * j / (kAngles - 1), kQuarter - 1e-9))).reflectance / normal
                                         : 1.0);
    for (int v = 0; v < kShareViews; ++v) {
      row.hemispherical.push_back(shares_[static_cast<size_t>(v)].of(row.fresnel));
      const double room = 1.0 - paint_.bodyAlbedo(w, kQuarter * v / (kShareViews - 1));
      if (!paint_.published && row.hemispherical.back() > room) row.scale = std::min(row.scale, std::max(room, 0.0) / row.hemispherical.back());
    }
    for (double& h : row.hemispherical) h *= row.scale;
    return row;
  }
  Paint paint_;
  std::vector<AngleShares> shares_;
  mutable std::mutex mutex_;
  mutable std::map<double, Row> rows_;
};

}  // namespace

ReflectionModel beardMaxwellModel() {
  return {
      "beard_maxwell",
      "Paint by Beard and Maxwell, with the parameters of the Nonconventional Exploitation Factors database: R(beta)/R(0) times a retroreflection scan of "
      "facets and its shadow, rho_D, and 2 rho_V / (cos_i + cos_o). Bounded by the shadow of grooves and scaled so that no view returns more than it "
      "receives; or as published, which is refused where that shows.",
      {required(within(spectrum("n", "", "refractive index of the facets"), 0.05, 20)),
       withDefault(within(spectrum("k", "", "its imaginary part"), 0, 100), "0"),
       required(within(number("scan", "", "B of the scan B / (cos t (sigma^2 + tan^2 t)) [1/sr]"), 0, 100)),
       required(within(number("width", "", "sigma of the scan, a slope"), 0.01, 1)),
       required(within(number("tau", "rad", "of the shadow: how fast it deepens with the angle between light and half vector"), 0.001, 100)),
       required(within(number("omega", "rad", "of the shadow: how fast it deepens with the tilt of facets"), 0.001, 100)),
       withDefault(within(spectrum("diffuse", "", "rho_D [1/sr]"), 0, 0.31831), "0"), withDefault(within(spectrum("volume", "", "rho_V [1/sr]"), 0, 0.1), "0"),
       withDefault(choice("form", {"bounded", "published"}, "of the facets"), "bounded")},
      {},
      [](const Record&) { return 1.0 / 64.0; },
      {},
      {},
      [](const ComponentRecord& r) {
        Paint paint{r.spectrum("n"),
                    r.spectrum("k"),
                    r.spectrum("diffuse"),
                    r.spectrum("volume"),
                    {r.record.number("scan"), r.record.number("width"), r.record.number("tau"), r.record.number("omega")},
                    r.record.text("form") == "published"};
        std::vector<double> looked = paint.knots();
        looked.push_back(paint.low_um()), looked.push_back(paint.high_um());
        for (double w : looked)
          if (w >= paint.low_um() && w <= paint.high_um() && paint.bodyAlbedo(w, kQuarter) > 1.0 + 1e-9)
            throw UserError(r.record.where("diffuse"), "pi (diffuse + 4 volume) is " + std::to_string(paint.bodyAlbedo(w, kQuarter)) + " at grazing views",
                            "at most 1 at every wavelength", "lower one");
        MadeReflection made;
        made.components.push_back(std::make_shared<Facets>(paint));
        made.components.push_back(std::make_shared<Body>(paint));
        return made;
      }};
}

}  // namespace pitviper
