#pragma once
// Lines of sight of a scene, drawn at random over its time, and what each pixel's radiance is a sum of: what a plan's wavelengths must integrate.
//
// Terms as the renderer has them: emission and reflected ambient light of surfaces, reflected light of the sun and of points, the air's emission and
// scattered sunlight cut at stations, media and transparent surfaces on the way. Two things are simpler here: the air's emission takes no heed of
// what share of its extinction is absorption, and spectra that meet in threes are multiplied two at a time.
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/plan/opacity_groups.hpp"
#include "sim/plan/plan.hpp"
#include "sim/plan/sight_rays.hpp"

namespace pitviper {

/// Wavelengths of a channel's fine grid, and the air there.
struct FineGrid {
  std::vector<double> wavelength_um, weight;
  std::vector<AirNode> air;
};

/// A spectrum on a grid: value at its i-th wavelength.
using GridSpectrum = std::function<double(const FineGrid&, size_t)>;

/// Amounts on a part of a line of sight: of the air's absorbers, raised to their powers, and metres inside each material's medium.
struct SightPath {
  AirAmounts air;
  std::vector<double> media_m;  ///< one per material, or none at all
  double amount(int absorber) const {
    const auto k = static_cast<size_t>(absorber);
    if (k < kMostAirAmounts) return air.amount[k];
    return media_m.empty() ? 0.0 : media_m[k - kMostAirAmounts];
  }
};

struct SightTerm {
  int source = 0, second = -1, path = 0;  ///< as in ProductTerm, into Sights
  double coefficient = 1.0;
};

struct Sight {
  std::vector<SightTerm> terms;
  bool fromFilm = false;  ///< drawn evenly over the film, not aimed at something
};

/// Sights with the spectra and paths that their terms point to.
struct SightBook {
  std::vector<GridSpectrum> spectra;
  std::map<std::string, int> spectrumOf;  ///< the same name is the same spectrum
  std::vector<SightPath> paths;
  std::vector<Sight> sights;
  int spectrum(const std::string& name, GridSpectrum f);
};

class Sights {
 public:
  /// Draws `count` of them; the same for the same seed. All must outlive it. `plan`: what makePlan() says of terms.
  Sights(const Simulation& simulation, const Plan& plan, const Eye& eye, int count, unsigned long long seed);
  /// The absorbers that a channel meets: places in AirAmounts, and from kMostAirAmounts on the materials of media.
  std::vector<int> absorbers(const FineGrid& grid) const;
  /// The spectral problem of a channel, one column of extinction per absorber. Floors: 1e-3 of the 99th percentile of what the film sees.
  SpectralProblem problem(const FineGrid& grid, const std::vector<int>& absorbers) const;
  int size() const { return static_cast<int>(book_.sights.size()); }

 private:
  double coefficientOf(const FineGrid& grid, size_t i, int absorber) const;
  const Simulation& simulation_;
  SightBook book_;
};

FineGrid fineGridOf(const Simulation& simulation, const Spectrum& kernel);

}  // namespace pitviper
