#include "atmosphere/tabulated_path.hpp"

#include <algorithm>
#include <stdexcept>

#include "atmosphere/tabulated_gpu.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

class TabulatedPath final : public Atmosphere {
 public:
  explicit TabulatedPath(TabulatedAir air) : air_(std::move(air)) {
    if (air_.exponents().size() > kMostAirAmounts) throw std::invalid_argument("table of air: more exponents than a path has amounts");
  }
  AirTraits traits() const override { return {.isBanded = true, .linearBetweenKnots = true}; }
  std::unique_ptr<AirOnGpu> onGpu(const Simulation& simulation, const Plan& plan, bool) const override {
    return std::make_unique<TabulatedOnGpu>(simulation, plan);
  }
  Location where() const override { return {air_.file(), air_.line(), 1, -1}; }
  std::span<const double> exponents() const override { return air_.exponents(); }
  AirNode node(double wavelength_um) const override {
    AirNode n;
    const auto c = air_.coefficients(wavelength_um);
    std::copy(c.begin(), c.end(), n.extinction.begin());
    n.source = air_.sourceRadiance(wavelength_um);
    return n;
  }
  double top_m() const override { return physics::kFar; }
  AirAmounts amounts(const AirRay&, double range_m) const override {
    AirAmounts a;
    std::fill_n(a.amount.begin(), air_.exponents().size(), 1e-3 * std::min(range_m, physics::kFar));
    return a;
  }
  double validLow_um() const override { return air_.validLow_um(); }
  double validHigh_um() const override { return air_.validHigh_um(); }
  void addTo(Fingerprint& f) const override { air_.addTo(f.add("table")); }
  std::vector<double> knots_um() const override { return {air_.knots_um().begin(), air_.knots_um().end()}; }

 private:
  TabulatedAir air_;
};

}  // namespace

std::shared_ptr<const Atmosphere> makeTabulatedPath(TabulatedAir air) { return std::make_shared<TabulatedPath>(std::move(air)); }

}  // namespace pitviper
