#include "materials/facet_components.hpp"

#include <algorithm>

#include "sim/model/fringes.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kQuarter = 0.5 * kPi;
/// Entries of what several facets return and of what scatters beneath, over both angles: smooth.
constexpr int kBeneathAngles = 31;
static_assert((FacetOptics::kViews - 1) % (kBeneathAngles - 1) == 0);

class PartOfFace : public ReflectionComponent, public HasFringes {
 public:
  PartOfFace(Lobe lobe, std::shared_ptr<const FacetOptics> optics) : ReflectionComponent(std::move(lobe)), optics_(std::move(optics)) {}
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return optics_->knots_um(); }
  double validLow_um() const override { return optics_->validLow_um(); }
  double validHigh_um() const override { return optics_->validHigh_um(); }
  double resolvedBy_um(double w) const override { return optics_->resolvedBy_um(w); }
  double averagedFringe_um(double w) const override { return optics_->averagedFringe_um(w); }

 protected:
  std::shared_ptr<const FacetOptics> optics_;
};

/// The facets' own mirror images: a facet's reflectance over the difference angle x the lobe.
class Facets final : public PartOfFace {
 public:
  explicit Facets(const std::shared_ptr<const FacetOptics>& optics) : PartOfFace(facetLobe(optics->spec().slopes, optics->spec().roughness), optics) {}
  std::array<AngleAxis, 2> axes() const override { return {AngleAxis{Angle::Difference, optics_->facetAngles(), kQuarter}, AngleAxis{}}; }
  double column(double w, double angle, double) const override { return optics_->spec().share * byAngle(optics_->at(w).facet, angle); }
  double lobeAt(const glm::dvec3& l, const glm::dvec3& v) const override { return facetLobeAt(optics_->spec().slopes, optics_->spec().roughness, l, v); }
  double hemispherical(double w, double angle) const override { return optics_->spec().share * byAngle(optics_->at(w).hemispherical, angle); }
  double angleError() const override { return optics_->angleError(); }
};

/// What comes back by way of several facets, or from beneath them: products of a function of either direction.
class Beneath final : public PartOfFace {
 public:
  explicit Beneath(const std::shared_ptr<const FacetOptics>& optics) : PartOfFace({}, optics) {}
  std::array<AngleAxis, 2> axes() const override {
    return {AngleAxis{Angle::Incidence, kBeneathAngles, kQuarter}, AngleAxis{Angle::View, kBeneathAngles, kQuarter}};
  }
  double column(double w, double in, double out) const override {
    const FacetRow& row = optics_->at(w);
    // Linear between the entries of its own axes.
    const auto at = [](const std::vector<double>& views, double angle) {
      constexpr size_t kEach = (FacetOptics::kViews - 1) / (kBeneathAngles - 1);
      const double x = std::clamp(angle / kQuarter, 0.0, 1.0) * (kBeneathAngles - 1);
      const size_t j = std::min(static_cast<size_t>(x), static_cast<size_t>(kBeneathAngles - 2));
      const double f = x - static_cast<double>(j);
      return (1.0 - f) * views[kEach * j] + f * views[kEach * (j + 1)];
    };
    const auto both = [&](const std::vector<double>& views) { return at(views, in) * at(views, out); };
    return optics_->spec().share * ((row.again > 0.0 ? row.again * both(row.returned) : 0.0) + (row.scattered > 0.0 ? row.scattered * both(row.through) : 0.0));
  }
  double hemispherical(double w, double angle) const override { return optics_->spec().share * byAngle(optics_->at(w).beneath, angle); }
};

class Pane final : public ViewModel {
 public:
  explicit Pane(std::shared_ptr<const FacetOptics> optics) : optics_(std::move(optics)) {
    Fingerprint f;
    optics_->addTo(f);
    fingerprint_ = f.bytes();
  }
  double at(double w, double angle) const override { return byAngle(optics_->at(w).transmitted, angle); }
  std::vector<double> knots_um() const override { return optics_->knots_um(); }
  std::vector<double> knots_rad() const override {
    std::vector<double> all;
    for (int v = 0; v < FacetOptics::kViews; ++v) all.push_back(kQuarter * v / (FacetOptics::kViews - 1));
    return all;
  }
  double validLow_um() const override { return optics_->validLow_um(); }
  double validHigh_um() const override { return optics_->validHigh_um(); }
  const std::string& fingerprint() const override { return fingerprint_; }

 private:
  std::shared_ptr<const FacetOptics> optics_;
  std::string fingerprint_;
};

}  // namespace

MadeReflection facetComponents(FacetSpec spec, const Location& where) {
  const auto optics = std::make_shared<const FacetOptics>(std::move(spec));
  if (optics->validLow_um() > optics->validHigh_um())
    throw UserError(where, "the substances of this stack have no wavelength in common", "ranges that overlap", "extend one");
  MadeReflection made;
  made.components.push_back(std::make_shared<Facets>(optics));
  if (optics->hasBeneath()) made.components.push_back(std::make_shared<Beneath>(optics));
  if (optics->spec().paneThickness_um) made.transmission = std::make_shared<Pane>(optics);
  made.statesPerUnit = optics->statesPerUm();
  optics->addTo(made.within);
  return made;
}

}  // namespace pitviper
