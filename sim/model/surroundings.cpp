#include "sim/model/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {

Surroundings::Place Surroundings::placeAt(double height_m) const {
  if (heights_m_.size() < 2 || !(height_m > heights_m_.front())) return {};
  const auto above = std::upper_bound(heights_m_.begin(), heights_m_.end(), height_m);
  if (above == heights_m_.end()) return {heights_m_.size() - 1, 0.0};
  const auto below = above - 1;
  return {static_cast<std::size_t>(below - heights_m_.begin()), (height_m - *below) / (*above - *below)};
}

const std::vector<Harmonics>& Surroundings::projection(std::size_t height) const {
  const std::lock_guard lock(busy_);
  const auto [at, isNew] = projections_.try_emplace(height);
  if (isNew) at->second = grids_[height].harmonics();
  return at->second;
}

const Surroundings::Light& Surroundings::light(double wavelength_um, std::size_t height) const {
  {
    const std::lock_guard lock(busy_);
    if (const auto at = kept_.find({height, wavelength_um}); at != kept_.end()) return at->second;
  }
  const std::vector<double> all = radiance(wavelength_um, height);
  const std::vector<Harmonics>& each = projection(height);
  Light sum{{all.begin(), all.end()}, {}};
  for (std::size_t g = 0; g < all.size(); ++g)
    for (std::size_t c = 0; c < sum.harmonics.size(); ++c) sum.harmonics[c] += all[g] * each[g][c];
  const std::lock_guard lock(busy_);
  return kept_.try_emplace({height, wavelength_um}, std::move(sum)).first->second;
}

const std::vector<float>& Surroundings::blur(std::size_t height, double sigma_rad) const {
  const std::lock_guard lock(busy_);
  const auto [at, isNew] = blurs_.try_emplace({height, sigma_rad});
  if (!isNew) return at->second;
  const DirectionGrid& grid = grids_[height];
  const std::size_t size = grid.size();
  const double kappa = 1.0 / (sigma_rad * sigma_rad);
  // Beyond 7 sigma nothing is left.
  const double nearest = sigma_rad < 0.0 ? 0.0 : std::cos(std::min(7.0 * sigma_rad, kPi));
  const auto samples = grid.samples(2);
  at->second.assign(size * size, 0.0f);
  for (std::size_t g = 0; g < size; ++g) {
    const glm::dvec3 middle = grid.direction(g);
    std::vector<double> row(size, 0.0);
    double whole = 0.0;
    for (const DirectionGrid::Sample& s : samples) {
      const double cosine = glm::dot(middle, s.direction);
      if (cosine < nearest) continue;
      const double weight = s.solidAngle * (sigma_rad < 0.0 ? cosine : std::exp(kappa * (cosine - 1.0)));
      whole += weight;
      for (std::size_t k = 0; k < 4; ++k) row[s.reading.at[k]] += weight * s.reading.weight[k];
    }
    for (std::size_t h = 0; h < size; ++h) at->second[g * size + h] = static_cast<float>(row[h] / whole);
  }
  return at->second;
}

std::vector<double> MixedSurroundings::radiance(double wavelength_um, std::size_t) const {
  std::vector<double> values, all;
  for (const Spectrum& s : spectra_) values.push_back(s(wavelength_um));
  for (const auto& share : share_) {
    double sum = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) sum += share[k] * values[k];
    all.push_back(sum);
  }
  return all;
}

void MixedSurroundings::addTo(Fingerprint& f) const {
  for (const Spectrum& s : spectra_) pitviper::addTo(f, s);
  for (const auto& share : share_) f.all(share);
}

Spectrum MixedSurroundings::mean() const {
  // Of a grid's entries, by their part of Y_00.
  std::vector<double> part(spectra_.size(), 0.0);
  const auto& each = projection(0);
  for (std::size_t g = 0; g < share_.size(); ++g)
    for (std::size_t k = 0; k < part.size(); ++k) part[k] += share_[g][k] * each[g][0] / std::sqrt(4.0 * kPi);
  Spectrum::Table table;
  table.name = "mean of the surroundings";
  double low = kShortestWavelength_um, high = kLongestWavelength_um;
  for (const Spectrum& s : spectra_) {
    low = std::max(low, s.validLow()), high = std::min(high, s.validHigh());
    for (double w : s.knots()) table.wavelength_um.push_back(w);
  }
  // A black body is straight to 1e-5 between wavelengths a two-hundredth apart.
  for (double w = low; w < high; w *= 1.005) table.wavelength_um.push_back(w);
  table.wavelength_um.push_back(high);
  std::erase_if(table.wavelength_um, [&](double w) { return w < low || w > high; });
  std::sort(table.wavelength_um.begin(), table.wavelength_um.end());
  table.wavelength_um.erase(std::unique(table.wavelength_um.begin(), table.wavelength_um.end()), table.wavelength_um.end());
  for (double w : table.wavelength_um) {
    double sum = 0.0;
    for (std::size_t k = 0; k < part.size(); ++k) sum += part[k] * spectra_[k](w);
    table.value.push_back(sum);
  }
  return Spectrum(std::move(table));
}

}  // namespace pitviper
