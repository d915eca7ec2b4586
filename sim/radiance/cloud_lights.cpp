#include "sim/radiance/cloud_lights.hpp"

#include <algorithm>

#include "sim/model/surroundings.hpp"

namespace pitviper {

CloudLights::CloudLights(const Simulation& simulation, const FieldBody& field)
    : simulation_(simulation), drops_(*field.source->droplets()), material_(field.gases.front().levels.front().material) {
  if (!simulation.surroundings) return;
  const DirectionGrid& grid = simulation.surroundings->grids().front();
  shares_.assign(grid.size(), glm::dvec2(0.0));
  glm::dvec2 all(0.0);
  for (const DirectionGrid::Sample& s : grid.samples(2)) {
    const int side = s.direction.z >= 0.0 ? 0 : 1;
    all[side] += s.solidAngle;
    for (std::size_t k = 0; k < s.reading.at.size(); ++k) shares_[s.reading.at[k]][side] += s.solidAngle * s.reading.weight[k];
  }
  for (glm::dvec2& s : shares_) s /= all;
}

glm::dvec2 CloudLights::around(double wavelength_um) const {
  if (!simulation_.surroundings) return glm::dvec2(simulation_.ambient ? (*simulation_.ambient)(wavelength_um) : 0.0);
  {
    const std::lock_guard lock(busy_);
    if (const auto known = around_.find(wavelength_um); known != around_.end()) return known->second;
  }
  const Surroundings::Place place = simulation_.surroundings->placeAt(drops_.height_m);
  const auto mean = [&](std::size_t height) {
    const std::vector<float>& radiance = simulation_.surroundings->light(wavelength_um, height).radiance;
    glm::dvec2 sum(0.0);
    for (std::size_t k = 0; k < shares_.size(); ++k) sum += static_cast<double>(radiance[k]) * shares_[k];
    return sum;
  };
  glm::dvec2 both = mean(place.height);
  if (place.share > 0.0) both += place.share * (mean(place.height + 1) - both);
  const std::lock_guard lock(busy_);
  return around_.try_emplace(wavelength_um, both).first->second;
}

CloudLight CloudLights::at(double wavelength_um, bool withAround) const {
  const glm::dvec2 both = withAround ? around(wavelength_um) : glm::dvec2(0.0);
  const Medium& medium = *simulation_.materials[static_cast<std::size_t>(material_)]->medium;
  return {physics::cloudOptics(medium.absorption_per_m(wavelength_um), drops_.albedo(wavelength_um), drops_.asymmetry(wavelength_um)),
          simulation_.sun ? simulation_.sun->irradiance(wavelength_um) : 0.0, both.x, both.y};
}

void CloudLights::prepare(std::vector<double> wavelengths_um) const {
  if (!simulation_.surroundings) return;
  std::sort(wavelengths_um.begin(), wavelengths_um.end());
  wavelengths_um.erase(std::unique(wavelengths_um.begin(), wavelengths_um.end()), wavelengths_um.end());
  const Surroundings::Place place = simulation_.surroundings->placeAt(drops_.height_m);
  simulation_.surroundings->prepare(wavelengths_um, place.height);
  if (place.share > 0.0) simulation_.surroundings->prepare(wavelengths_um, place.height + 1);
}

std::vector<CloudLight> CloudLights::of(std::span<const SpectralNode> nodes) const {
  std::vector<double> all;
  for (const SpectralNode& n : nodes)
    for (const SpectralNode::Member& m : n.members) all.push_back(m.wavelength_um);
  prepare(std::move(all));
  std::vector<CloudLight> lights;
  lights.reserve(nodes.size());
  for (const SpectralNode& n : nodes) {
    const glm::dvec2 both = n.mean([&](double w) { return around(w); });
    lights.push_back({physics::cloudOptics(n.absorption_per_m[static_cast<std::size_t>(material_)], n.mean(drops_.albedo), n.mean(drops_.asymmetry)),
                      simulation_.sun ? n.mean([&](double w) { return simulation_.sun->irradiance(w); }) : 0.0, both.x, both.y});
  }
  return lights;
}

}  // namespace pitviper
