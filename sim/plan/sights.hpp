#pragma once
// Lines of sight of a scene as sums of products: what a plan's wavelengths must integrate.
#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/plan/opacity_groups.hpp"
#include "sim/plan/plan.hpp"
#include "sim/plan/sight_rays.hpp"
#include "sim/radiance/cloud_lights.hpp"
#include "sim/radiance/diffuse_light.hpp"

namespace pitviper {

/// Wavelengths of the fine grid of a channel, or of alike ones, and the air there.
struct FineGrid {
  std::vector<double> wavelength_um, weight;  ///< of the first kernel
  std::vector<std::vector<double>> ratio;     ///< of each further kernel's weights to the first's
  std::vector<AirNode> air;
  mutable std::vector<std::vector<double>> known;  ///< of a SightBook's spectra, the first so many
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

struct Sight {
  std::vector<ProductTerm> terms;  ///< their indices into a SightBook, their tags kinds of terms
  bool fromFilm = false;           ///< drawn evenly over the film, not aimed at something
};

/// Sights with the spectra and paths that their terms point to.
struct SightBook {
  std::vector<GridSpectrum> spectra;
  std::vector<SightPath> paths;
  std::vector<Sight> sights;
  std::map<int, std::shared_ptr<const CloudLights>> drops;  ///< of fields that have them, as lines meet them
  int spectrum(const Factor& factor, const Simulation& simulation);
  int spectrum(const std::string& name, GridSpectrum f);  ///< the same name is the same spectrum
  int both(int a, int b);                                 ///< their product

 private:
  std::map<Factor, int> factors_;
  std::map<std::string, int> named_;
};

/// What is turned into a line of light scattered again, on the grids of channels. May be shared between threads.
class DiffuseOnGrids {
 public:
  /// The simulation must outlive it.
  DiffuseOnGrids(const Simulation& simulation, int streams);
  struct Place {
    double height_m = 0.0, sine = 0.0, cosAzimuth = 0.0, temperature_K = 0.0;  ///< of a line and of the air there
    auto operator<=>(const Place&) const = default;
  };
  /// The nearest of few places; in clouds closer together towards their edges, where light changes, and never on the other side of one.
  Place stepped(Place place, double step_K) const;
  /// The number of the cloud that a height lies in; -1: none.
  int cloudAt(double height_m) const;
  /// By an absorber of the air, per unit of its amount, at the i-th wavelength of a grid, which must outlive it [W/(m2 sr um)].
  double at(const FineGrid& grid, size_t i, const Place& place, size_t absorber);

 private:
  struct OnGrid;
  const Simulation& simulation_;
  std::shared_ptr<const DiffuseLight> light_;
  std::vector<AirShell> clouds_;  ///< shells of what scatters
  std::mutex busy_;
  std::map<const FineGrid*, std::shared_ptr<OnGrid>> grids_;
};

class Sights {
 public:
  /// All must outlive it. `plan`: what makePlan() says of terms. `shortest_um`: the shortest wavelength that any channel sees thermal light at; `airPlaces`:
  /// at which air is looked at, between which its emission is taken as one black body's. `kernels`: of a grid at most.
  Sights(const Simulation& simulation, const Plan& plan, SightRays& rays, double shortest_um, int airPlaces, size_t kernels);
  /// The extremes, what was learnt, and so many others: half of them as the film draws pixels, a quarter of all combinations of things alike, a quarter aimed
  /// at bodies.
  void begin(int count, const std::vector<FilmPlace>& learnt);
  /// More of the others.
  void draw(int count);
  /// A line; `inFull`, one that turned out to matter: with every step through fields.
  void add(const SightRay& ray, bool inFull = false);
  /// Of lines from here on.
  void setAirPlaces(int places) { airPlaces_ = places; }
  size_t size() const { return book_.sights.size(); }
  /// The absorbers that a channel may meet: places in AirAmounts, and from kMostAirAmounts on the materials of media.
  std::vector<int> absorbers(const FineGrid& grid) const;
  /// The spectral problem of some of a grid's kernels, of sights from a number on, one column of extinction per absorber: sight by sight a product of each
  /// kernel. Terms that with nothing in their way would be far below the kernel's floor are left out.
  SpectralProblem problem(const FineGrid& grid, std::span<const size_t> kernels, const std::vector<int>& absorbers, std::span<const double> floors,
                          size_t first = 0) const;

 private:
  double coefficientOf(const FineGrid& grid, size_t i, int absorber) const;
  SpectralProblem spectra(const FineGrid& grid, const std::vector<int>& absorbers) const;
  const Simulation& simulation_;
  const Plan& plan_;
  SightRays& rays_;
  SightBook book_;
  std::vector<int> ratios_;  ///< spectra of the book: of each further kernel
  double shortest_um_;
  int airPlaces_;
  std::shared_ptr<DiffuseOnGrids> diffuse_;  ///< null: light is scattered once
};

/// Parts of a line's way through a field at most: what a fit learns of a line along which more change is the same.
constexpr std::size_t kFieldParts = 8;
/// Of drops, each of whose parts has spectra of its own.
constexpr std::size_t kDropParts = 4;

/// Neighbouring steps of a field as one, of about as much of all gases each, of drops of as much that is seen; amounts add up, temperatures are means by
/// amount.
std::vector<Slab> inParts(const std::vector<Slab>& all);

FineGrid fineGridOf(const Simulation& simulation, std::span<const Spectrum* const> kernels);

}  // namespace pitviper
