#include <algorithm>
#include <cmath>

#include "sim/plan/sights.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Steps between places: of the root of the height, of the sine of an elevation, of the cosine of an azimuth.
constexpr double kHeightRoot = 20.0, kSineStep = 0.25, kAzimuthStep = 0.5;
/// Of the amount between a place in a cloud and the nearer edge: the least, and the ratio of one to the next; about an optical depth in the visible.
constexpr double kLeastWithin = 0.1, kNextWithin = 2.0;

double nearest(double value, double step) { return step * std::round(value / step); }

}  // namespace

struct DiffuseOnGrids::OnGrid {
  std::vector<SpectralNode> nodes;
  std::unique_ptr<NodeDiffuse> light;
  std::vector<double> irradiance;
  std::map<Place, TurnedLight> turned;
  std::mutex busy;
};

DiffuseOnGrids::DiffuseOnGrids(const Simulation& simulation, int streams) : simulation_(simulation), light_(DiffuseLight::of(columnOf(simulation), streams)) {
  const Atmosphere& air = *simulation.air;
  const AirNode node = air.node(std::clamp(1.0, air.validLow_um(), air.validHigh_um()));
  for (const AirShell& s : air.shells())
    if (node.haze[static_cast<size_t>(s.amount)] > 0.0) clouds_.push_back(s);
}

int DiffuseOnGrids::cloudAt(double height_m) const {
  for (size_t c = 0; c < clouds_.size(); ++c)
    if (height_m >= clouds_[c].low_m && height_m <= clouds_[c].high_m) return static_cast<int>(c);
  return -1;
}

DiffuseOnGrids::Place DiffuseOnGrids::stepped(Place p, double step_K) const {
  const double root = nearest(std::sqrt(std::max(p.height_m, 0.0)), kHeightRoot);
  double height_m = root * root;
  if (const int in = cloudAt(p.height_m); in >= 0) {
    const AirShell& c = clouds_[static_cast<size_t>(in)];
    const double half = 0.5 * (c.high_m - c.low_m), above = p.height_m - c.low_m, amount = c.per_m * std::min(above, 2.0 * half - above);
    const double steps = std::max(std::round(std::log(std::max(amount, 1e-3) / kLeastWithin) / std::log(kNextWithin)), 0.0);
    const double within = std::min(kLeastWithin * std::pow(kNextWithin, steps) / c.per_m, half);
    height_m = above < half ? c.low_m + within : c.high_m - within;
  } else if (const int met = cloudAt(height_m); met >= 0) {
    const AirShell& c = clouds_[static_cast<size_t>(met)];
    height_m = p.height_m < c.low_m ? c.low_m - 1.0 : c.high_m + 1.0;
  }
  return {height_m, nearest(p.sine, kSineStep), nearest(p.cosAzimuth, kAzimuthStep), nearest(p.temperature_K, step_K)};
}

double DiffuseOnGrids::at(const FineGrid& grid, size_t i, const Place& place, size_t absorber) {
  std::shared_ptr<OnGrid> own;
  {
    const std::scoped_lock lock(busy_);
    auto& kept = grids_[&grid];
    if (!kept) kept = std::make_shared<OnGrid>();
    own = kept;
  }
  const std::scoped_lock lock(own->busy);
  if (!own->light) {
    for (size_t k = 0; k < grid.wavelength_um.size(); ++k) {
      own->nodes.emplace_back();
      own->nodes.back().members = {{grid.wavelength_um[k], 1.0}};
      own->nodes.back().air = grid.air[k];
      own->irradiance.push_back(simulation_.sun ? simulation_.sun->irradiance(grid.wavelength_um[k]) : 0.0);
    }
    own->light = std::make_unique<NodeDiffuse>(light_, own->nodes, NodeDiffuse::Nodes::Together);
  }
  const auto [at, isNew] = own->turned.try_emplace(place);
  TurnedLight& t = at->second;
  DiffuseMemory memory;
  if (isNew) own->light->at(place.height_m, place.sine, place.cosAzimuth, {}, memory, t);
  const AirNode& air = grid.air[i];
  const double black = place.temperature_K > 0.0 ? physics::planckRadiance(grid.wavelength_um[i], place.temperature_K) : 0.0;
  const double sun = light_->sunlit() ? own->irradiance[i] : 0.0;
  const auto turned = [&](size_t kind) { return t.thermal[kind][i] - black + (sun > 0.0 ? sun * t.solar[kind][i] : 0.0); };
  double sum = air.molecules[absorber] > 0.0 ? air.molecules[absorber] * turned(0) : 0.0;
  const ParticleKinds& kinds = own->light->particles();
  for (size_t k = 0; k < kinds.size(); ++k)
    if (std::find(kinds[k].begin(), kinds[k].end(), absorber) != kinds[k].end()) sum += air.haze[absorber] * turned(k + 1);
  return sum;
}

}  // namespace pitviper
