// The Sandford-Robertson model of infrared paints: a diffuse part that falls towards grazing, and an elliptical glint.
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "materials/lobe_shares.hpp"
#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "sim/model/scene_fingerprint.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/sandford.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

constexpr double kQuarter = 0.5 * kPi;
constexpr const char* kShader = "materials/sandford.glsl";
constexpr int kAngles = 46;

struct Paint {
  Spectrum emissivity, diffuse;
  double grazing, width;
  bool published;
  double fall(double angle) const { return physics::sandfordFall(grazing, std::cos(angle)) / physics::sandfordMean(grazing); }
  glm::dvec4 parameters() const { return {grazing, width, published ? 1.0 : 0.0, 0.0}; }
  double low_um() const { return std::max(emissivity.validLow(), diffuse.validLow()); }
  double high_um() const { return std::min(emissivity.validHigh(), diffuse.validHigh()); }
};

class Diffuse final : public ReflectionComponent {
 public:
  explicit Diffuse(Paint paint)
      : ReflectionComponent({kShader, "sandfordDiffuseLobe", paint.parameters(), 1.0 / (kPi * std::pow(physics::sandfordMean(paint.grazing), 2.0)), 0.0}),
        paint_(std::move(paint)) {}
  double column(double w, double, double) const override { return paint_.diffuse(w); }
  double lobeAt(const glm::dvec3& l, const glm::dvec3& v) const override { return physics::sandfordDiffuseLobe(lobe().parameters, {0, 0, 1}, l, v); }
  double hemispherical(double w, double angle) const override { return paint_.diffuse(w) * paint_.fall(std::min(angle, kQuarter - 1e-6)); }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return paint_.diffuse.knots(); }
  double validLow_um() const override { return paint_.low_um(); }
  double validHigh_um() const override { return paint_.high_um(); }

 private:
  Paint paint_;
};

/// The glint: lobe x what is neither emitted nor scattered; of the form that is alike both ways, the geometric mean of the two directions'.
class Glint final : public ReflectionComponent {
 public:
  explicit Glint(Paint paint)
      : ReflectionComponent({kShader, "sandfordGlintLobe", paint.parameters(), 200.0 / (4.0 * kPi * paint.width * paint.width),
                             std::max(0.0, 0.5 / (paint.width * paint.width) - 1.0)}),
        paint_(std::move(paint)) {
    shares_ =
        lobeShares([this](const glm::dvec3& l, const glm::dvec3& v) { return lobeAt(l, v); }, Sampled::Trowbridge, paint_.width, Angle::Incidence, kAngles);
  }
  std::array<AngleAxis, 2> axes() const override { return {AngleAxis{Angle::Incidence, kAngles, kQuarter}, AngleAxis{Angle::View, kAngles, kQuarter}}; }
  double column(double w, double in, double out) const override {
    const auto& row = rowAt(w);
    return row.scale * (paint_.published ? byAngle(row.left, in) : byAngle(row.left, in) * byAngle(row.left, out));
  }
  double lobeAt(const glm::dvec3& l, const glm::dvec3& v) const override { return physics::sandfordGlintLobe(lobe().parameters, {0, 0, 1}, l, v); }
  double hemispherical(double w, double angle) const override { return byAngle(rowAt(w).hemispherical, angle); }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return (paint_.diffuse * paint_.emissivity).knots(); }
  double validLow_um() const override { return paint_.low_um(); }
  double validHigh_um() const override { return paint_.high_um(); }

 private:
  struct Row {
    std::vector<double> left;           ///< 1 - (emissivity + diffuse) g / G by angle; of the form alike both ways its root
    std::vector<double> hemispherical;  ///< by view angle, scaled
    double scale = 1.0;                 ///< so that no view returns more than it receives
  };
  const Row& rowAt(double w) const {
    const std::lock_guard lock(mutex_);
    auto& row = rows_[w];
    if (!row.left.empty()) return row;
    const double both = paint_.emissivity(w) + paint_.diffuse(w);
    for (int j = 0; j < kAngles; ++j) {
      const double left = std::max(0.0, 1.0 - both * paint_.fall(std::min(kQuarter * j / (kAngles - 1), kQuarter - 1e-6)));
      row.left.push_back(paint_.published ? left : std::sqrt(left));
    }
    for (int v = 0; v < kShareViews; ++v) {
      const double angle = std::min(kQuarter * v / (kShareViews - 1), kQuarter - 1e-6);
      if (paint_.published) {
        // Of light that comes in; what goes out the same way is not the same, and without bound towards grazing views.
        row.hemispherical.push_back(byAngle(row.left, angle));
        continue;
      }
      row.hemispherical.push_back(shares_[static_cast<size_t>(v)].of(row.left) * byAngle(row.left, angle));
      const double room = 1.0 - paint_.diffuse(w) * paint_.fall(angle);
      if (row.hemispherical.back() > room) row.scale = std::min(row.scale, room / row.hemispherical.back());
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

ReflectionModel sandfordRobertsonModel() {
  return {"sandford_robertson",
          "Infrared paint by its emissivity and diffuse reflectance at normal view, their fall towards grazing and the width of its glint (Sandford and "
          "Robertson 1985). Alike both ways, by the "
          "geometric mean, and scaled so that no view returns more than it receives; or as published, which is neither: it emits epsilon g / G.",
          {required(within(spectrum("emissivity", "", "epsilon, hemispherical"), 0, 1)),
           required(within(spectrum("diffuse", "", "rho_D, hemispherical diffuse reflectance"), 0, 1)),
           required(within(number("grazing", "", "b: how fast emissivity and diffuse reflectance fall towards grazing"), 0, 0.95)),
           required(within(number("width", "", "e: of the glint, 0.02 glossy to 0.9 matt"), 0.01, 1)),
           withDefault(choice("form", {"reciprocal", "published"}, "of the glint"), "reciprocal")},
          {},
          [](const Record&) { return 1.0 / 64.0; },
          {},
          {},
          [](const ComponentRecord& r) {
            Paint paint{r.spectrum("emissivity"), r.spectrum("diffuse"), r.record.number("grazing"), r.record.number("width"),
                        r.record.text("form") == "published"};
            for (double w : (paint.emissivity * paint.diffuse).knots())
              if (w >= paint.low_um() && w <= paint.high_um() && paint.emissivity(w) + paint.diffuse(w) > 1.0 + 1e-9)
                throw UserError(r.record.where("diffuse"),
                                "emissivity and diffuse reflectance are " + std::to_string(paint.emissivity(w) + paint.diffuse(w)) + " together",
                                "at most 1 at every wavelength", "lower one");
            if (paint.low_um() <= 1.0 && paint.high_um() >= 1.0 && paint.emissivity(1.0) + paint.diffuse(1.0) > 1.0 + 1e-9)
              throw UserError(r.record.where("diffuse"), "emissivity and diffuse reflectance are more than 1 together", "at most 1 at every wavelength",
                              "lower one");
            MadeReflection made;
            made.components.push_back(std::make_shared<Glint>(paint));
            made.components.push_back(std::make_shared<Diffuse>(paint));
            return made;
          }};
}

}  // namespace pitviper
