#include "sim/model/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/parameters/on_threads.hpp"
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
  const auto find = [&]() -> const Light* {
    const std::lock_guard lock(busy_);
    const auto at = kept_.find({height, wavelength_um});
    return at != kept_.end() ? &at->second : nullptr;
  };
  if (const Light* known = find()) return *known;
  keep({&wavelength_um, 1}, height);
  return *find();
}

void Surroundings::keep(std::span<const double> wavelengths_um, std::size_t height) const {
  const std::vector<std::vector<double>> all = radiance(wavelengths_um, height);
  const std::vector<Harmonics>& each = projection(height);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Light sum{{all[i].begin(), all[i].end()}, {}};
    for (std::size_t g = 0; g < all[i].size(); ++g)
      for (std::size_t c = 0; c < sum.harmonics.size(); ++c) sum.harmonics[c] += all[i][g] * each[g][c];
    const std::lock_guard lock(busy_);
    kept_.try_emplace({height, wavelengths_um[i]}, std::move(sum));
  }
}

void Surroundings::prepare(std::span<const double> wavelengths_um, std::size_t height) const {
  constexpr std::size_t kTogether = 32;
  std::vector<double> missing;
  {
    const std::lock_guard lock(busy_);
    for (double w : wavelengths_um)
      if (!kept_.contains({height, w})) missing.push_back(w);
  }
  onAllThreads((missing.size() + kTogether - 1) / kTogether, [&](const auto& next) {
    for (std::size_t k = next(); k * kTogether < missing.size(); k = next())
      keep(std::span(missing).subspan(k * kTogether, std::min(kTogether, missing.size() - k * kTogether)), height);
  });
}

const Surroundings::Blur& Surroundings::blur(std::size_t height, double sigma_rad) const {
  const std::lock_guard lock(busy_);
  const auto [at, isNew] = blurs_.try_emplace({height, sigma_rad});
  Blur& blur = at->second;
  if (!isNew) return blur;
  const DirectionGrid &grid = grids_[height], finer = grid.finer();
  const std::size_t size = grid.size(), rings = static_cast<std::size_t>(finer.above + finer.below), round = static_cast<std::size_t>(finer.azimuths),
                    phases = round / static_cast<std::size_t>(grid.azimuths);
  // Of the kernel's Legendre series, which goes over from degree to degree as spherical Bessel functions do. A cosine: Ramamoorthi and Hanrahan 2001.
  const double variance = sigma_rad * sigma_rad, opposite = sigma_rad > 0.0 ? std::exp(-2.0 / variance) : 0.0;
  blur.ofDegree = {1.0, 2.0 / 3.0, 0.25, 0.0, -1.0 / 24.0};
  if (sigma_rad >= 0.0) {
    blur.ofDegree[1] = (1.0 + opposite) / (1.0 - opposite) - variance;
    for (size_t l = 1; l + 1 < blur.ofDegree.size(); ++l)
      blur.ofDegree[l + 1] = blur.ofDegree[l - 1] - (2.0 * static_cast<double>(l) + 1.0) * variance * blur.ofDegree[l];
  }
  blur.shares.assign(rings * phases * size, 0.0);
  // Wide ones by a rule of the whole sphere, which knows the grid's cells; narrow ones along a spiral of the golden angle, no two points at one elevation.
  constexpr double kWide_rad = 0.15;
  const bool wide = sigma_rad < 0.0 || sigma_rad > kWide_rad;
  const std::vector<DirectionGrid::Sample> samples = wide ? grid.samples(3) : std::vector<DirectionGrid::Sample>{};
  const int count = sigma_rad == 0.0 ? 1 : 1500;
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  std::vector<glm::dvec3> spiral;  // about the z axis
  for (int k = 0; k < count && !wide; ++k) {
    const double cosine = count == 1 ? 1.0 : 1.0 + variance * std::log1p((k + 0.5) / count * (opposite - 1.0)),
                 sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    spiral.emplace_back(sine * std::cos(golden * k), sine * std::sin(golden * k), cosine);
  }
  onAllThreads(rings, [&](const auto& next) {
    for (std::size_t r = next(); r < rings; r = next())
      for (std::size_t phase = 0; phase < phases; ++phase) {
        const glm::dvec3 middle = finer.direction(r * round + phase);
        double* row = blur.shares.data() + (r * phases + phase) * size;
        const auto add = [&](const DirectionGrid::Reading& reading, double weight) {
          for (std::size_t e = 0; e < 4; ++e) row[reading.at[e]] += weight * reading.weight[e];
        };
        if (wide) {
          double whole = 0.0;
          for (const DirectionGrid::Sample& s : samples) {
            const double cosine = glm::dot(middle, s.direction), weight = s.solidAngle * (sigma_rad < 0.0 ? cosine : std::exp((cosine - 1.0) / variance));
            if (weight > 0.0) add(s.reading, weight), whole += weight;
          }
          for (std::size_t h = 0; h < size; ++h) row[h] /= whole;
          continue;
        }
        const glm::dvec3 aside = glm::normalize(glm::cross(middle, std::abs(middle.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0))),
                         up = glm::cross(aside, middle);
        for (const glm::dvec3& s : spiral) {
          glm::dvec3 to = s.z * middle + (s.x * aside + s.y * up);
          // The horizon is seen from the side that its ring is of.
          if (count == 1) to.z += r < static_cast<std::size_t>(finer.above) ? 1e-9 : -1e-9;
          add(grid.at(to), 1.0 / count);
        }
      }
  });
  return blur;
}

const HarmonicResponse& Surroundings::response(const ReflectionComponent& component, int order, std::span<const double> usual_um) const {
  {
    const std::lock_guard lock(busy_);
    if (const auto at = responses_.find({&component, order}); at != responses_.end()) return *at->second;
  }
  std::vector<double> usual(columnEntries(component), 0.0);
  for (const double w : usual_um) {
    const std::vector<double> own = columnsAt(component, std::clamp(w, component.validLow_um(), component.validHigh_um()));
    for (size_t e = 0; e < usual.size(); ++e) usual[e] += own[e];
  }
  auto made = std::make_unique<const HarmonicResponse>(component, order, usual);
  const std::lock_guard lock(busy_);
  return *responses_.try_emplace({&component, order}, std::move(made)).first->second;
}

std::vector<std::vector<double>> MixedSurroundings::radiance(std::span<const double> wavelengths_um, std::size_t) const {
  std::vector<std::vector<double>> all;
  for (double w : wavelengths_um) {
    std::vector<double> values;
    for (const Spectrum& s : spectra_) values.push_back(s(w));
    auto& own = all.emplace_back();
    for (const auto& share : share_) {
      double sum = 0.0;
      for (std::size_t k = 0; k < values.size(); ++k) sum += share[k] * values[k];
      own.push_back(sum);
    }
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
