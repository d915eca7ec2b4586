#include "sim/plan/sights.hpp"

#include <algorithm>
#include <cmath>

#include "sim/plan/fine_grid.hpp"
#include "sim/plan/sight_writer.hpp"

namespace pitviper {
namespace {

/// A lamp in view for so many pixels.
constexpr int kPixelsPerLamp = 24;
/// Terms that, with nothing in their way, would be below this part of the floor are left out.
constexpr double kNegligible = 1e-4;
/// Part of the film's brightest that an error is measured against where it is dark.
constexpr double kDark = 1e-3;

}  // namespace

FineGrid fineGridOf(const Simulation& simulation, const Spectrum& kernel) {
  FineGrid grid;
  for (const QuadratureNode& n : fineGrid(kernel, simulation)) {
    grid.wavelength_um.push_back(n.x);
    grid.weight.push_back(n.weight);
    grid.air.push_back(simulation.path ? simulation.path->node(n.x) : AirNode{});
  }
  return grid;
}

int SightBook::spectrum(const std::string& name, GridSpectrum f) {
  const auto [at, isNew] = spectrumOf.try_emplace(name, static_cast<int>(spectra.size()));
  if (isNew) spectra.push_back(std::move(f));
  return at->second;
}

const char* nameOf(TermKind kind) {
  constexpr const char* kNames[kTermKinds] = {"emission of surfaces", "reflected ambient light", "reflected sunlight", "reflected light of lamps",
                                              "emission of the air",  "scattered sunlight",      "background",         "media",
                                              "lamps in view"};
  return kNames[static_cast<int>(kind)];
}

void Sights::draw(int count) {
  for (int n = 0; n < count; ++n, ++drawn_) {
    const SightRay ray = rays_.draw();
    SightWriter writer(simulation_, plan_, book_, ray, castRay(simulation_, ray.state, ray.origin, ray.direction, ray.nearest_m, &rays_.drawn()), rays_.dice());
    book_.sights.push_back(writer.pixel());
    if (drawn_ % kPixelsPerLamp != 0) continue;
    for (size_t l = 0; l < simulation_.lights.size(); ++l)
      if (Sight lamp = writer.lamp(l, rays_.pixel_sr()); simulation_.lights[l].visible && !lamp.terms.empty()) book_.sights.push_back(std::move(lamp));
  }
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
    bool absorbs = false;
    for (size_t i = 0; i < grid.weight.size() && !absorbs; ++i) absorbs = coefficientOf(grid, i, a) > 0.0;
    if (absorbs) found.push_back(a);
  }
  return found;
}

SpectralProblem Sights::whole(const FineGrid& grid, const std::vector<int>& absorbers, size_t first) const {
  SpectralProblem p;
  p.wavelength_um = grid.wavelength_um;
  p.weight = grid.weight;
  const size_t fine = grid.weight.size();
  for (const GridSpectrum& f : book_.spectra) {
    std::vector<double> values(fine);
    for (size_t i = 0; i < fine; ++i) values[i] = f(grid, i);
    p.spectra.push_back(std::move(values));
  }
  for (int a : absorbers) {
    p.extinction.emplace_back(fine);
    for (size_t i = 0; i < fine; ++i) p.extinction.back()[i] = coefficientOf(grid, i, a);
  }
  for (const SightPath& path : book_.paths) {
    std::vector<double> u;
    for (int a : absorbers) u.push_back(path.amount(a));
    p.paths.push_back(std::move(u));
  }
  for (size_t m = first; m < book_.sights.size(); ++m) {
    SpectralProduct product;
    for (const SightTerm& t : book_.sights[m].terms) product.terms.push_back({t.source, t.second, t.path, t.coefficient});
    p.products.push_back(std::move(product));
  }

  return p;
}

double Sights::floorOf(const FineGrid& grid, const std::vector<int>& absorbers) const {
  const std::vector<double> seen = fineIntegrals(whole(grid, absorbers, 0));
  std::vector<double> film;
  for (size_t m = 0; m < seen.size(); ++m)
    if (book_.sights[m].fromFilm) film.push_back(seen[m]);
  std::sort(film.begin(), film.end());
  return film.empty() ? 0.0 : kDark * film[std::min(film.size() - 1, film.size() * 99 / 100)];
}

SpectralProblem Sights::problem(const FineGrid& grid, const std::vector<int>& absorbers, double floor, size_t first) const {
  SpectralProblem p = whole(grid, absorbers, first);
  std::map<std::pair<int, int>, double> bound;
  for (SpectralProduct& product : p.products) {
    product.floor = floor;
    std::erase_if(product.terms, [&](const ProductTerm& t) {
      auto [at, isNew] = bound.try_emplace({t.source, t.second}, 0.0);
      if (isNew)
        for (size_t i = 0; i < p.weight.size(); ++i)
          at->second +=
              p.weight[i] * std::abs(p.spectra[static_cast<size_t>(t.source)][i] * (t.second < 0 ? 1.0 : p.spectra[static_cast<size_t>(t.second)][i]));
      return std::abs(t.coefficient) * at->second < kNegligible * floor;
    });
  }
  return p;
}

std::vector<double> Sights::shares(const FineGrid& grid, const std::vector<int>& absorbers, double floor) const {
  SpectralProblem p = whole(grid, absorbers, 0);
  const std::vector<double> all = fineIntegrals(p);
  std::vector<double> most(kTermKinds, 0.0);
  for (int kind = 0; kind < kTermKinds; ++kind) {
    SpectralProblem part = p;
    for (size_t m = 0; m < part.products.size(); ++m) {
      auto& terms = part.products[m].terms;
      terms.clear();
      for (size_t k = 0; k < p.products[m].terms.size(); ++k)
        if (book_.sights[m].terms[k].kind == static_cast<TermKind>(kind)) terms.push_back(p.products[m].terms[k]);
    }
    const std::vector<double> own = fineIntegrals(part);
    for (size_t m = 0; m < own.size(); ++m)
      if (const double size = std::max(std::abs(all[m]), floor); size > 0.0)
        most[static_cast<size_t>(kind)] = std::max(most[static_cast<size_t>(kind)], std::abs(own[m]) / size);
  }
  return most;
}

}  // namespace pitviper
