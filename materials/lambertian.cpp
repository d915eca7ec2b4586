#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
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

 private:
  Spectrum reflectance_;
};

}  // namespace

std::shared_ptr<ReflectionComponent> makeLambertian(Spectrum reflectance) { return std::make_shared<Lambertian>(std::move(reflectance)); }

ReflectionModel lambertianModel() {
  return {"lambertian",
          "Alike in all directions: f = reflectance / pi.",
          {required(within(spectrum("reflectance", "", "of light from and to anywhere"), 0, 1))},
          [](const ComponentRecord& r) { return makeLambertian(r.spectrum("reflectance")); }};
}

}  // namespace pitviper
