#include "sim/plan/scene_spectra.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// A rule that is within this of a spectrum's integral over the response sees it well enough: what 16 Gauss points promise.
constexpr double kWellSampled = 1e-3;
/// Bends closer than this part of the band over the number of samples belong to a line.
constexpr double kClose = 0.5;
/// Greatest part of the band that lines may be, and their number of nodes.
constexpr double kMostOfBand = 0.05;
constexpr size_t kMostNodes = 96;
/// Gauss points between two bends: a lamp's slope times a response's times what is smooth besides.
constexpr int kLinePoints = 3;

}  // namespace

std::vector<BentSpectrum> spectraOf(const Simulation& sim) {
  std::vector<BentSpectrum> all;
  const auto add = [&all](std::vector<double> knots, std::function<double(double)> at) {
    if (!knots.empty()) all.push_back({std::move(knots), std::move(at)});
  };
  const auto addSpectrum = [&add](const Spectrum& s) { add(s.knots(), [&s](double w) { return s(w); }); };
  for (const PointLight& l : sim.lights) addSpectrum(l.intensity);
  if (sim.sun) addSpectrum(sim.sun->irradiance);
  if (sim.ambient) addSpectrum(*sim.ambient);
  addSpectrum(sim.background);
  for (const auto& material : sim.materials) {
    const Material& m = *material;
    for (const auto& r : m.reflections)
      add(r->knots_um(), [r](double w) { return r->hemisphericalVaries() ? r->column(w, 0.0, 0.0) : r->hemispherical(w, 0.0); });
    if (m.given) add(m.given->knots_um(), [&m](double w) { return m.given->at(w, 0.0); });
    if (m.transmission) add(m.transmission->knots_um(), [&m](double w) { return m.transmission->at(w, 0.0); });
    if (!m.medium) continue;
    addSpectrum(m.medium->absorption_per_m);
    if (!m.medium->absorption_per_m.knots().empty()) all.back().isDepth = true;
    if (m.medium->radiance) addSpectrum(*m.medium->radiance);
  }
  return all;
}

std::vector<const HasFringes*> fringedOf(const Simulation& sim) {
  std::vector<const HasFringes*> all;
  const auto add = [&all](const Material& m) {
    for (const auto& r : m.reflections)
      if (const auto* fringed = dynamic_cast<const HasFringes*>(r.get())) all.push_back(fringed);
  };
  for (const auto& m : sim.materials) {
    add(*m);
    if (!m->states) continue;
    // The last has the thickest film.
    add(*m->states->entries.back());
  }
  return all;
}

BentSpectrum airSpectrum(const Atmosphere& air) {
  return {air.knots_um(), [&air](double w) {
            double sum = 0.0;
            for (double c : air.node(w).extinction) sum += c;
            return sum;
          }};
}

std::vector<double> knotsWithin(const BentSpectrum& spectrum, double low_um, double high_um) {
  const auto& k = spectrum.knots_um;
  return {std::upper_bound(k.begin(), k.end(), low_um), std::lower_bound(k.begin(), k.end(), high_um)};
}

std::vector<SpectralLine> narrowLines(const std::vector<BentSpectrum>& spectra, const Spectrum& kernel, const std::vector<QuadratureNode>& rule) {
  const double low = kernel.supportLow(), high = kernel.supportHigh(), close = kClose * (high - low) / static_cast<double>(rule.size());
  std::vector<double> bends;
  for (const BentSpectrum& s : spectra) {
    const auto knots = knotsWithin(s, low, high);
    if (knots.size() < 2) continue;
    auto all = kernel.knots();
    all.insert(all.end(), knots.begin(), knots.end());
    std::sort(all.begin(), all.end());
    double sampled = 0.0;
    for (const QuadratureNode& n : rule) sampled += n.weight * s.at(n.x);
    const double whole = integrate([&](double w) { return kernel(w) * s.at(w); }, low, high, all);
    if (std::abs(sampled - whole) > kWellSampled * std::abs(whole)) bends.insert(bends.end(), knots.begin(), knots.end());
  }
  std::sort(bends.begin(), bends.end());
  bends.erase(std::unique(bends.begin(), bends.end()), bends.end());
  std::vector<SpectralLine> lines;
  double width = 0.0;
  size_t nodes = 0;
  for (size_t i = 0; i + 1 < bends.size(); ++i) {
    if (bends[i + 1] - bends[i] > close) continue;
    if (lines.empty() || lines.back().knots_um.back() != bends[i]) lines.push_back({{bends[i]}});
    lines.back().knots_um.push_back(bends[i + 1]);
    width += bends[i + 1] - bends[i], nodes += kLinePoints;
  }
  return width > kMostOfBand * (high - low) || nodes > kMostNodes ? std::vector<SpectralLine>() : lines;
}

std::vector<QuadratureNode> lineNodes(const std::vector<SpectralLine>& lines, const Spectrum& kernel) {
  std::vector<QuadratureNode> nodes;
  for (const SpectralLine& line : lines)
    for (size_t i = 0; i + 1 < line.knots_um.size(); ++i)
      for (QuadratureNode n : gaussLegendre(kLinePoints, line.knots_um[i], line.knots_um[i + 1])) {
        n.weight *= kernel(n.x);
        if (n.weight != 0.0) nodes.push_back(n);
      }
  return nodes;
}

Spectrum betweenLines(const std::vector<SpectralLine>& lines) {
  Spectrum::Table mask;
  mask.outside = Outside::Hold;
  for (const SpectralLine& line : lines) {
    const double a = line.knots_um.front(), b = line.knots_um.back();
    mask.wavelength_um.insert(mask.wavelength_um.end(), {a, a, b, b});
    mask.value.insert(mask.value.end(), {1.0, 0.0, 0.0, 1.0});
  }
  return Spectrum(std::move(mask));
}

}  // namespace pitviper
