#pragma once
// Spectral problems of whole scenes, for opacity groups: the library's air and plumes, structured surfaces, and random products of them.
#include <memory>
#include <string>

#include "sim/plan/opacity_groups.hpp"

namespace pitviper::test {

enum class SceneBand { Midwave, MidwavePlume, Longwave, Shortwave };

struct GroupScene {
  std::string name;
  SceneBand band;
  double low_um, high_um;
  double step_per_cm;  ///< fine grid
};

/// The four cases: 3-5.2 um, the same with hot gas, 7.5-12.5 um, 1-2.5 um.
const GroupScene& groupScene(SceneBand band);

/// What is random about a set of products. With `fresh` temperatures, ranges, heights and mixtures of spectra are others than without.
struct ProductDraw {
  unsigned seed = 1;
  int products = 5000;
  bool fresh = false;
};

/// Fine grid, columns (absorbers of the US standard air; gases) and products of a scene: thermal emission of surfaces at 220-1200 K, reflected sun
/// (its leg to space and the camera's), reflected ambient light, air's own radiance, and with a plume its emission and bodies behind it.
/// Floors: 1e-4 of the product without absorbers on its path.
SpectralProblem drawProblem(const GroupScene& scene, const ProductDraw& draw);

/// Without planning: wavelengths in the middle of `count` even bins. Largest relative error over the products, as GroupFit::maximum.
double evenSamplesError(const SpectralProblem& problem, int count);

/// The other way without planning: even bins, spectra averaged in each, and the transmittance of each path too, exactly, weighted with the
/// response: of air with all its absorbers (both legs of reflected light) and of each gas by itself, as layers are drawn one over the other.
class EvenBins {
 public:
  /// Keeps a reference.
  explicit EvenBins(const SpectralProblem& problem);
  /// Largest relative error over the products.
  double error(int count) const;

 private:
  /// Products with bins between places on the fine grid.
  std::vector<double> planned(const std::vector<double>& edges) const;

  const SpectralProblem& problem_;
  std::vector<double> weight_;  ///< running sums over the fine grid, here and below
  std::vector<std::vector<double>> spectra_;
  std::vector<std::vector<std::vector<double>>> paths_;  ///< [path][air, each gas]
  std::vector<double> fine_;
};

}  // namespace pitviper::test
