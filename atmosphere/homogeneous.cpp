#include "atmosphere/homogeneous.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "atmosphere/air_length.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

constexpr double kOne[] = {1.0};

class NoAir final : public Path {
 public:
  std::string slotFile() const override { return "sim/render/glsl/path_none.glsl"; }
  bool isNone() const override { return true; }
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

class Homogeneous final : public Path {
 public:
  explicit Homogeneous(HomogeneousAir air) : air_(std::move(air)) {}
  std::string slotFile() const override { return "atmosphere/homogeneous.glsl"; }
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
  std::vector<AirStation> stations(const AirRay& ray, double range_m) const override { return {{}, {range_m, 0.0, 0.0, amounts(ray, range_m)}}; }
  std::vector<AirStation> stationsAt(const AirRay& ray, std::span<const double> ranges_m) const override {
    std::vector<AirStation> stations;
    for (double r : ranges_m) stations.push_back({r, 0.0, 0.0, amounts(ray, r)});
    return stations;
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

std::shared_ptr<const Path> makeHomogeneousAir(HomogeneousAir air) { return std::make_shared<Homogeneous>(std::move(air)); }
std::shared_ptr<const Path> makeNoAir() { return std::make_shared<NoAir>(); }

}  // namespace pitviper
