#include "materials/mixed_component.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/model/fringes.hpp"

namespace pitviper {
namespace {

class Mixed final : public ReflectionComponent, public HasFringes {
 public:
  Mixed(std::shared_ptr<const ReflectionComponent> a, std::shared_ptr<const ReflectionComponent> b, double share)
      : ReflectionComponent(a->lobe()), a_(std::move(a)), b_(std::move(b)), share_(share) {}
  std::array<AngleAxis, 2> axes() const override { return a_->axes(); }
  double column(double w, double angle1, double angle2) const override { return between(a_->column(w, angle1, angle2), b_->column(w, angle1, angle2)); }
  double lobeAt(const glm::dvec3& light, const glm::dvec3& view) const override { return a_->lobeAt(light, view); }
  double hemispherical(double w, double angle) const override { return between(a_->hemispherical(w, angle), b_->hemispherical(w, angle)); }
  bool hemisphericalVaries() const override { return a_->hemisphericalVaries() || b_->hemisphericalVaries(); }
  double angleError() const override { return std::max(a_->angleError(), b_->angleError()); }
  std::vector<double> knots_um() const override {
    std::vector<double> all = a_->knots_um(), more = b_->knots_um();
    all.insert(all.end(), more.begin(), more.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }
  double resolvedBy_um(double w) const override {
    const auto of = [w](const auto& c) {
      const auto* has = dynamic_cast<const HasFringes*>(c.get());
      return has ? has->resolvedBy_um(w) : std::numeric_limits<double>::infinity();
    };
    return std::min(of(a_), of(b_));
  }
  double averagedFringe_um(double w) const override {
    const auto of = [w](const auto& c) {
      const auto* has = dynamic_cast<const HasFringes*>(c.get());
      return has ? has->averagedFringe_um(w) : 0.0;
    };
    return std::max(of(a_), of(b_));
  }
  double validLow_um() const override { return std::max(a_->validLow_um(), b_->validLow_um()); }
  double validHigh_um() const override { return std::min(a_->validHigh_um(), b_->validHigh_um()); }

 private:
  double between(double x, double y) const { return (1.0 - share_) * x + share_ * y; }
  std::shared_ptr<const ReflectionComponent> a_, b_;
  double share_;
};

}  // namespace

bool areAlike(const ReflectionComponent& a, const ReflectionComponent& b) {
  const auto first = a.axes(), second = b.axes();
  for (std::size_t k = 0; k < 2; ++k)
    if (first[k].angle != second[k].angle || first[k].count != second[k].count || std::abs(first[k].last_rad - second[k].last_rad) > 1e-9) return false;
  return a.lobe().file == b.lobe().file && a.lobe().function == b.lobe().function && a.lobe().parameters == b.lobe().parameters;
}

std::shared_ptr<ReflectionComponent> mixed(std::shared_ptr<const ReflectionComponent> a, std::shared_ptr<const ReflectionComponent> b, double share) {
  const std::string both = a->fingerprint() + b->fingerprint() + std::to_string(share);
  auto made = std::make_shared<Mixed>(std::move(a), std::move(b), share);
  made->setFingerprint(both);
  return made;
}

}  // namespace pitviper
