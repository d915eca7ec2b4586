#pragma once
// What shines on a scene from all around: radiance by direction, at heights. Axes: those of the scenario's local frame.
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "sim/model/atmosphere.hpp"
#include "sim/model/direction_grid.hpp"
#include "sim/model/harmonic_response.hpp"
#include "sim/model/material.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// One for each height at which it is known, rising; between two its light is linear, beyond them held.
  const std::vector<DirectionGrid>& grids() const { return grids_; }
  /// Between the height of a number and the next, so far on.
  struct Place {
    std::size_t height = 0;
    double share = 0.0;
    auto operator<=>(const Place&) const = default;
  };
  Place placeAt(double height_m) const;
  /// At the entries of the grid of one of the heights [W/(m2 sr um)], in single precision, and its harmonics; kept.
  struct Light {
    std::vector<float> radiance;
    Harmonics harmonics;
  };
  const Light& light(double wavelength_um, std::size_t height) const;
  /// The same of many, which costs less than one by one; on all threads.
  void prepare(std::span<const double> wavelengths_um, std::size_t height) const;
  const std::vector<Harmonics>& projection(std::size_t height) const;
  /// What blurs values on the grid onto its finer one, by exp((cos - 1) / sigma^2) over the sphere, or by a cosine, as matt surfaces do: of [finer ring][finer
  /// azimuth up to the second of the grid], shares of [ring][azimuth], of sum 1; kept. All around it goes on the same.
  struct Blur {
    std::vector<double> shares;
    std::array<double, kMostHarmonicOrder + 1> ofDegree;  ///< what is left of harmonics
  };
  static constexpr double kByCosine = -1.0;
  const Blur& blur(std::size_t height, double sigma_rad) const;
  /// How a component answers it; kept. Its aims are those of the column's mean over some wavelengths, always the same.
  const HarmonicResponse& response(const ReflectionComponent& component, int order, std::span<const double> usual_um) const;
  virtual void addTo(Fingerprint& f) const = 0;

 protected:
  /// [wavelength][entry], of some, one at least; of each the same whatever the others.
  virtual std::vector<std::vector<double>> radiance(std::span<const double> wavelengths_um, std::size_t height) const = 0;
  Surroundings(std::vector<double> heights_m, std::vector<DirectionGrid> grids) : heights_m_(std::move(heights_m)), grids_(std::move(grids)) {}
  const std::vector<double>& heights_m() const { return heights_m_; }

 private:
  void keep(std::span<const double> wavelengths_um, std::size_t height) const;

  std::vector<double> heights_m_;
  std::vector<DirectionGrid> grids_;
  mutable std::mutex busy_;
  mutable std::map<std::size_t, std::vector<Harmonics>> projections_;
  mutable std::map<std::pair<std::size_t, double>, Blur> blurs_;
  mutable std::map<std::pair<std::size_t, double>, Light> kept_;
  mutable std::map<std::pair<const ReflectionComponent*, int>, std::unique_ptr<const HarmonicResponse>> responses_;
};

/// The sky of layered air by elevation and azimuth, and the ground below: emission of the air, sunlight it scatters once, the background behind it; ground of a
/// temperature that reflects the sun and the mean of the sky as a diffuse surface of its directional reflectance, seen through the air. Without the sun's disc.
/// Heights up to 60 km; Source of the terms: sim/radiance/sunlit_air.hpp.
std::shared_ptr<const Surroundings> skyAndGround(std::shared_ptr<const Atmosphere> air, const std::optional<Sun>& sun, const Spectrum& background,
                                                 std::shared_ptr<const Material> ground, double ground_K, double earthRadius_m);

/// Sums of some spectra, the same at all heights.
class MixedSurroundings final : public Surroundings {
 public:
  /// share[entry][spectrum].
  MixedSurroundings(const DirectionGrid& grid, std::vector<Spectrum> spectra, std::vector<std::vector<double>> share)
      : Surroundings({0.0}, {grid}), spectra_(std::move(spectra)), share_(std::move(share)) {}
  void addTo(Fingerprint& f) const override;
  /// Mean over all directions, as a table.
  Spectrum mean() const;

 private:
  std::vector<std::vector<double>> radiance(std::span<const double> wavelengths_um, std::size_t height) const override;
  std::vector<Spectrum> spectra_;
  std::vector<std::vector<double>> share_;
};

}  // namespace pitviper
