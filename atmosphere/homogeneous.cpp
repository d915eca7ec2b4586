#include "atmosphere/homogeneous.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "atmosphere/air_length.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

class NoAir final : public Path {
 public:
  std::string slotFile() const override { return "sim/render/glsl/path_none.glsl"; }
  bool isNone() const override { return true; }
  PathNode node(double) const override { return {}; }
  double top_m() const override { return physics::kFar; }
  double airLength_m(double, double, double, double) const override { return 0.0; }
  double transmittance(double, double) const override { return 1.0; }
  double radiance(double, double) const override { return 0.0; }
  double validLow_um() const override { return kShortestWavelength_um; }
  double validHigh_um() const override { return kLongestWavelength_um; }
};

class Homogeneous final : public Path {
 public:
  explicit Homogeneous(HomogeneousAir air) : air_(std::move(air)) {}
  std::string slotFile() const override { return "atmosphere/homogeneous.glsl"; }
  PathNode node(double w) const override { return {air_.extinction_per_m(w), source(w)}; }
  double top_m() const override { return std::min(air_.top_m, physics::kFar); }
  double airLength_m(double h, double sinElevation, double range, double radius) const override {
    return physics::layerLength(h, sinElevation, std::min(range, physics::kFar), top_m(), radius);
  }
  double transmittance(double w, double length) const override { return std::exp(-air_.extinction_per_m(w) * length); }
  double radiance(double w, double length) const override { return source(w) * physics::oneMinusExp(air_.extinction_per_m(w) * length); }
  double validLow_um() const override { return std::max(air_.extinction_per_m.validLow(), air_.radiance ? air_.radiance->validLow() : kShortestWavelength_um); }
  double validHigh_um() const override {
    return std::min(air_.extinction_per_m.validHigh(), air_.radiance ? air_.radiance->validHigh() : kLongestWavelength_um);
  }

 private:
  double source(double w) const {
    return (air_.temperature_K ? physics::planckRadiance(w, *air_.temperature_K) : 0.0) + (air_.radiance ? (*air_.radiance)(w) : 0.0);
  }
  HomogeneousAir air_;
};

}  // namespace

std::shared_ptr<const Path> makeHomogeneousAir(HomogeneousAir air) { return std::make_shared<Homogeneous>(std::move(air)); }
std::shared_ptr<const Path> makeNoAir() { return std::make_shared<NoAir>(); }

}  // namespace pitviper
