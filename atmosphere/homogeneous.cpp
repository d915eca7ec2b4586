#include "atmosphere/homogeneous.hpp"

#include <algorithm>
#include <cmath>

#include "atmosphere/models.hpp"
#include "sim/model/scene_fingerprint.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/assembly/air_on_gpu.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "atmosphere/air_length.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

constexpr double kOne[] = {1.0};

class NoAir final : public Atmosphere {
 public:
  AirTraits traits() const override { return {.any = false}; }
  std::unique_ptr<AirOnGpu> onGpu(const Simulation&, const Plan&, bool) const override {
    return std::make_unique<AirFile>("sim/render/assembly/glsl/path_none.glsl");
  }
  std::span<const double> exponents() const override { return {}; }
  AirNode node(double) const override { return {}; }
  double top_m() const override { return physics::kFar; }
  AirAmounts amounts(const AirRay&, double) const override { return {}; }
  std::vector<AirStation> stations(const AirRay&, double) const override { return {}; }
  std::vector<AirStation> stationsAt(const AirRay&, std::span<const double> ranges_m) const override { return std::vector<AirStation>(ranges_m.size()); }
  double validLow_um() const override { return kShortestWavelength_um; }
  double validHigh_um() const override { return kLongestWavelength_um; }
  std::vector<double> knots_um() const override { return {}; }
  void addTo(Fingerprint& f) const override { f.add("no air"); }
};

class Homogeneous final : public Atmosphere {
 public:
  explicit Homogeneous(HomogeneousAir air) : air_(std::move(air)) {}
  std::unique_ptr<AirOnGpu> onGpu(const Simulation&, const Plan&, bool) const override { return std::make_unique<AirFile>("atmosphere/homogeneous.glsl"); }
  double groundTemperature_K() const override { return air_.temperature_K.value_or(0.0); }
  std::span<const double> exponents() const override { return kOne; }
  AirNode node(double w) const override {
    AirNode n;
    n.extinction[0] = air_.extinction_per_m(w);
    n.source = (air_.temperature_K ? physics::planckRadiance(w, *air_.temperature_K) : 0.0) + (air_.radiance ? (*air_.radiance)(w) : 0.0);
    return n;
  }
  double top_m() const override { return std::min(air_.top_m, physics::kFar); }
  AirAmounts amounts(const AirRay& ray, double range_m) const override {
    AirAmounts a;
    a.amount[0] = physics::layerLength(ray.height_m, ray.sinElevation, std::min(range_m, physics::kFar), top_m(), ray.earthRadius_m);
    return a;
  }
  double validLow_um() const override { return std::max(air_.extinction_per_m.validLow(), air_.radiance ? air_.radiance->validLow() : kShortestWavelength_um); }
  double validHigh_um() const override {
    return std::min(air_.extinction_per_m.validHigh(), air_.radiance ? air_.radiance->validHigh() : kLongestWavelength_um);
  }
  std::vector<double> knots_um() const override {
    auto k = air_.extinction_per_m.knots();
    if (air_.radiance) {
      const auto more = air_.radiance->knots();
      k.insert(k.end(), more.begin(), more.end());
      std::sort(k.begin(), k.end());
    }
    return k;
  }
  void addTo(Fingerprint& f) const override {
    f.add("homogeneous").add(air_.temperature_K.value_or(-1.0)).add(air_.radiance.has_value()).add(air_.top_m);
    pitviper::addTo(f, air_.extinction_per_m);
    if (air_.radiance) pitviper::addTo(f, *air_.radiance);
  }

 private:
  HomogeneousAir air_;
};

}  // namespace

std::shared_ptr<const Atmosphere> makeHomogeneousAir(HomogeneousAir air) { return std::make_shared<Homogeneous>(std::move(air)); }
std::shared_ptr<const Atmosphere> makeNoAir() { return std::make_shared<NoAir>(); }

AirModel homogeneousModel() {
  return {
      "homogeneous",
      "Air of the same extinction everywhere.",
      {"extinction"},
      {required(atLeast(spectrum("extinction", "1/m", "extinction coefficient"), 0.0)),
       within(number("temperature", "K", "the air emits as a black body of this temperature, and does not without"), 0, 1e5),
       atLeast(spectrum("radiance", "W/(m2 sr um)", "further source radiance at great depth, for instance scattered sunlight"), 0.0),
       within(number("top", "m",
                     "height of the air's top above the earth (a sphere that touches the ellipsoid under the origin); without it the air never ends and the "
                     "sun's irradiance is that at the scene"),
              -500, 1e7)},
      [](const AirRecord& air) {
        HomogeneousAir own;
        own.extinction_per_m = air.spectra.at("extinction");
        if (air.record.given("temperature")) own.temperature_K = air.record.number("temperature");
        if (air.spectra.count("radiance")) own.radiance = air.spectra.at("radiance");
        if (air.record.given("top")) own.top_m = air.record.number("top");
        return makeHomogeneousAir(std::move(own));
      }};
}

}  // namespace pitviper
