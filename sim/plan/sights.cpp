#include "sim/plan/sights.hpp"

#include <algorithm>
#include <cmath>

#include "sim/plan/fine_grid.hpp"
#include "sim/plan/product_sink.hpp"

namespace pitviper {
namespace {

/// Terms that, with nothing in their way, would be below this part of the floor are left out.
constexpr double kNegligible = 1e-4;
/// No amount at all: tables of ways to the sun have 1e-30 where there is nothing.
constexpr double kNone = 1e-20;
/// Of the extinction of drops at 0.55 um, what a line of sight sees of it at most wavelengths: scaled, 0.25 to 1.
constexpr double kDropsSeen = 0.4;
}  // namespace

std::vector<Slab> inParts(const std::vector<Slab>& all) {
  std::vector<Slab> some;
  for (std::size_t from = 0, to = 0; from < all.size(); from = to) {
    while (to < all.size() && all[to].field == all[from].field) ++to;
    const std::size_t most = all[from].step.cloud ? kDropParts : kFieldParts;
    if (to - from <= most) {
      some.insert(some.end(), all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(to));
      continue;
    }
    std::array<double, kMostGases> whole{};
    for (std::size_t k = from; k < to; ++k)
      for (std::size_t g = 0; g < whole.size(); ++g) whole[g] += all[k].step.amount[g];
    std::vector<double> part;
    double sum = 0.0;
    for (std::size_t k = from; k < to; ++k) {
      part.push_back(0.0);
      for (std::size_t g = 0; g < whole.size(); ++g)
        if (whole[g] > 0.0) part.back() += all[k].step.amount[g] / whole[g];
      if (all[k].step.cloud) part.back() *= std::exp(-kDropsSeen * all[k].step.cloud->depth.y);
      sum += part.back();
    }
    double before = 0.0, weight = 0.0;
    int last = -1;
    for (std::size_t k = from; k < to; ++k) {
      const double own = part[k - from];
      const int place = std::min(static_cast<int>(static_cast<double>(most) * (before + 0.5 * own) / sum), static_cast<int>(most) - 1);
      before += own;
      const FieldStep& s = all[k].step;
      if (place != last) {
        some.push_back(all[k]);
        weight = own, last = place;
        continue;
      }
      FieldStep& m = some.back().step;
      const double share = weight + own > 0.0 ? own / (weight + own) : 0.5;
      weight += own;
      m.leave_m = s.leave_m;
      for (std::size_t g = 0; g < whole.size(); ++g) m.amount[g] += s.amount[g];
      m.temperature_K += share * (s.temperature_K - m.temperature_K);
      m.drift_perK += s.drift_perK;
      m.gain += share * (s.gain - m.gain);
      m.sun += share * (s.sun - m.sun);
      m.sunAmount += share * (s.sunAmount - m.sunAmount);
      if (m.cloud && s.cloud) {
        const auto mix = [share](auto& mean, const auto& other) { mean += share * (other - mean); };
        mix(m.cloud->depth, s.cloud->depth), mix(m.cloud->sun, s.cloud->sun), mix(m.cloud->sunSlope, s.cloud->sunSlope);
        mix(m.cloud->around, s.cloud->around), mix(m.cloud->aroundSlope, s.cloud->aroundSlope), mix(m.cloud->across, s.cloud->across);
      }
    }
  }
  return some;
}

FineGrid fineGridOf(const Simulation& simulation, std::span<const Spectrum* const> kernels) {
  FineGrid grid;
  const auto nodes = fineGrids(kernels, simulation);
  for (const QuadratureNode& n : nodes.front()) {
    grid.wavelength_um.push_back(n.x);
    grid.weight.push_back(n.weight);
    grid.air.push_back(simulation.air ? simulation.air->node(n.x) : AirNode{});
  }
  for (size_t k = 1; k < kernels.size(); ++k) {
    std::vector<double>& ratio = grid.ratio.emplace_back();
    for (size_t i = 0; i < grid.weight.size(); ++i) ratio.push_back(grid.weight[i] > 0.0 ? nodes[k][i].weight / grid.weight[i] : 0.0);
  }
  return grid;
}

int SightBook::spectrum(const std::string& name, GridSpectrum f) {
  const auto [at, isNew] = named_.try_emplace(name, static_cast<int>(spectra.size()));
  if (isNew) spectra.push_back(std::move(f));
  return at->second;
}

int SightBook::spectrum(const Factor& factor, const Simulation& sim) {
  const auto [at, isNew] = factors_.try_emplace(factor, static_cast<int>(spectra.size()));
  if (isNew)
    spectra.push_back([factor, &sim](const FineGrid& g, size_t i) {
      // Of a whole grid that costs less than of one wavelength after the other.
      if (factor.kind == Factor::Kind::Around && i == 0) sim.surroundings->prepare(g.wavelength_um, static_cast<size_t>(factor.z));
      return valueOf(sim, factor, g.wavelength_um[i]);
    });
  return at->second;
}

int SightBook::both(int a, int b) {
  return spectrum("both " + std::to_string(a) + " " + std::to_string(b),
                  [fa = spectra[static_cast<size_t>(a)], fb = spectra[static_cast<size_t>(b)]](const FineGrid& g, size_t i) { return fa(g, i) * fb(g, i); });
}

Sights::Sights(const Simulation& simulation, const Plan& plan, SightRays& rays, double shortest_um, int airPlaces, size_t kernels)
    : simulation_(simulation), plan_(plan), rays_(rays), shortest_um_(shortest_um), airPlaces_(airPlaces) {
  if (plan.terms.streams > 0) diffuse_ = std::make_shared<DiffuseOnGrids>(simulation, plan.terms.streams);
  for (size_t k = 0; k + 1 < kernels; ++k)
    ratios_.push_back(book_.spectrum("kernel " + std::to_string(k + 1), [k](const FineGrid& g, size_t i) { return k < g.ratio.size() ? g.ratio[k][i] : 0.0; }));
}

void Sights::add(const SightRay& ray, bool inFull) {
  RadianceScene scene{simulation_, plan_.terms, plan_.sunLegs.get(), *ray.state, {}, airPlaces_};
  // In shade, half in it, or lit: other lights of a pixel then count for more.
  scene.lit = [this, &ray](const Hit&, size_t, const LightLeg&) {
    if (ray.glints) return 1.0;
    const double shade = rays_.dice().unit();
    return shade < 0.25 ? 0.0 : shade < 0.5 ? rays_.dice().unit() : 1.0;
  };
  ProductSink sink(simulation_, book_, shortest_um_, diffuse_);
  sink.begin(ray.fromFilm);
  LineOfSight line = ray.line;
  if (!inFull) line.hits.slabs = inParts(line.hits.slabs);
  radianceAlong(scene, line, sink);
  if (ray.lamp >= 0) lampAlong(scene, line, static_cast<size_t>(ray.lamp), ray.pixel_sr, sink);
  book_.sights.push_back(sink.finish());
}

void Sights::begin(int count, const std::vector<FilmPlace>& learnt) {
  for (const SightRay& ray : rays_.extremes()) add(ray);
  for (const FilmPlace& place : learnt) add(rays_.through(place));
  draw(count);
}

void Sights::draw(int count) {
  // Where limits let more come than the scenario shows, aimed lines are those that know it.
  const int ofCombinations = simulation_.limits.any() ? 8 : 4;
  for (int n = 0; n < count; ++n) add(n % 2 == 0 ? rays_.fromFilm() : n % ofCombinations == 1 ? rays_.ofCombination() : rays_.aimed());
}

double Sights::coefficientOf(const FineGrid& grid, size_t i, int absorber) const {
  const auto k = static_cast<size_t>(absorber);
  if (k < kMostAirAmounts) return grid.air[i].extinction[k];
  const Material& m = *simulation_.materials[k - kMostAirAmounts];
  return m.medium ? m.medium->absorption_per_m(grid.wavelength_um[i]) : 0.0;
}

std::vector<int> Sights::absorbers(const FineGrid& grid) const {
  std::vector<int> found;
  for (int a = 0; a < kMostAirAmounts + static_cast<int>(simulation_.materials.size()); ++a) {
    // What no line has any of (haze of clear air) can't be fitted: whatever extinction it got would do.
    const auto k = static_cast<size_t>(a);
    if (k < kMostAirAmounts && std::none_of(book_.paths.begin(), book_.paths.end(), [k](const SightPath& p) { return p.air.amount[k] > kNone; })) continue;
    bool absorbs = false;
    for (size_t i = 0; i < grid.weight.size() && !absorbs; ++i) absorbs = coefficientOf(grid, i, a) > 0.0;
    if (absorbs) found.push_back(a);
  }
  return found;
}

SpectralProblem Sights::spectra(const FineGrid& grid, const std::vector<int>& absorbers) const {
  SpectralProblem p;
  p.wavelength_um = grid.wavelength_um;
  p.weight = grid.weight;
  const size_t fine = grid.weight.size();
  for (size_t s = grid.known.size(); s < book_.spectra.size(); ++s) {
    grid.known.emplace_back(fine);
    for (size_t i = 0; i < fine; ++i) grid.known.back()[i] = book_.spectra[s](grid, i);
  }
  p.spectra = grid.known;
  for (int a : absorbers) {
    p.extinction.emplace_back(fine);
    for (size_t i = 0; i < fine; ++i) p.extinction.back()[i] = coefficientOf(grid, i, a);
  }
  for (const SightPath& path : book_.paths) {
    std::vector<double> u;
    for (int a : absorbers) u.push_back(path.amount(a));
    p.paths.push_back(std::move(u));
  }
  return p;
}

SpectralProblem Sights::problem(const FineGrid& grid, std::span<const size_t> kernels, const std::vector<int>& absorbers, std::span<const double> floors,
                                size_t first) const {
  SpectralProblem p = spectra(grid, absorbers);
  std::map<std::pair<int, std::array<int, kMostFactors>>, double> bound;
  const auto isNegligible = [&](const ProductTerm& t, double floor) {
    auto [at, isNew] = bound.try_emplace({t.count, t.spectrum}, 0.0);
    if (isNew)
      for (size_t i = 0; i < p.weight.size(); ++i) {
        double value = p.weight[i];
        for (int s : t.spectra()) value *= p.spectra[static_cast<size_t>(s)][i];
        at->second += std::abs(value);
      }
    return std::abs(t.coefficient) * at->second < kNegligible * floor;
  };
  for (size_t n = first; n < book_.sights.size(); ++n)
    for (size_t k : kernels) {
      SpectralProduct product{{}, floors[k]};
      for (ProductTerm t : book_.sights[n].terms) {
        // A group's weight in a further kernel is the first's times the ratio's average, whatever else is averaged.
        if (k > 0) t.spectrum[static_cast<size_t>(t.count++)] = ratios_[k - 1];
        if (!isNegligible(t, product.floor)) product.terms.push_back(t);
      }
      p.products.push_back(std::move(product));
    }
  return p;
}

}  // namespace pitviper
