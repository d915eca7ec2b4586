#include "sim/plan/fine_grid.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/reference_width.hpp"

namespace pitviper {
namespace {

/// Even bins, as wide as is usual in the middle, over what widths grow by no more than this (8-12 um: 2.25); else over so many times a wavelength each.
constexpr double kEven = 2.5, kSteps = 1.1;
/// A bin is cut at a spectrum's bends where its middle is farther from its mean than this part of the larger of them: the grain of
/// air's own bands, of either sign, is averaged over a band's bins; lines are not.
constexpr double kBent = 5e-3;
/// Cuts of a bin that one spectrum may ask for; of more bends every second, third ... is taken.
constexpr size_t kMostCuts = 32;
/// Air's own bends are edges where they lie no closer than this part of a usual bin.
constexpr double kOwnBins = 0.9;

struct Bin {
  double from, to, at;
};

/// Bins of a table's own from `low` to `high`, wide ones cut into usual ones.
std::vector<Bin> tableBins(std::span<const double> table, double low, double high) {
  std::vector<Bin> bins;
  for (size_t k = 0; k < table.size(); ++k) {
    const double from = k == 0 ? low : std::max(low, 0.5 * (table[k - 1] + table[k]));
    const double to = k + 1 == table.size() ? high : std::min(high, 0.5 * (table[k] + table[k + 1]));
    if (!(from < to)) continue;
    if (to - from <= referenceWidth_um(table[k])) {
      bins.push_back({from, to, std::clamp(table[k], from, to)});
      continue;
    }
    const int parts = static_cast<int>((to - from) / referenceWidth_um(table[k]) + 0.999);
    for (int b = 0; b < parts; ++b)
      bins.push_back({from + (to - from) * b / parts, from + (to - from) * (b + 1) / parts, from + (to - from) * (b + 0.5) / parts});
  }
  return bins;
}

/// From edge to edge, at least at the response's own: `own` are further ones where they leave room.
std::vector<Bin> usualBins(const Spectrum& kernel, std::span<const double> own) {
  const double low = kernel.supportLow(), high = kernel.supportHigh();
  std::vector<double> edges = {low, high};
  for (double k : kernel.knots())
    if (k > low && k < high) edges.push_back(k);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  // A response with more bends than bins is averaged over the bins.
  std::vector<double> kept = {edges.front()};
  for (double e : edges)
    if (e - kept.back() > 0.25 * referenceWidth_um(e)) kept.push_back(e);
  if (kept.size() == 1) kept.push_back(high);
  else if (kept.back() != high) kept.back() = high;
  std::vector<double> all = kept;
  for (double o : own) {
    const auto above = std::upper_bound(kept.begin(), kept.end(), o);
    if (above == kept.begin() || above == kept.end()) continue;
    if (std::min(o - *(above - 1), *above - o) > 0.25 * referenceWidth_um(o)) all.push_back(o);
  }
  std::sort(all.begin(), all.end());
  std::vector<Bin> bins;
  const auto even = [&bins](double from, double to) {
    const int parts = std::max(1, static_cast<int>((to - from) / referenceWidth_um(0.5 * (from + to)) + 0.999));
    for (int b = 0; b < parts; ++b) {
      const double a = from + (to - from) * b / parts, e = from + (to - from) * (b + 1) / parts;
      bins.push_back({a, e, 0.5 * (a + e)});
    }
  };
  for (size_t i = 0; i + 1 < all.size(); ++i) {
    const double from = all[i], to = all[i + 1], grown = referenceWidth_um(to) / referenceWidth_um(from);
    const int parts = grown <= kEven ? 1 : static_cast<int>(std::ceil(std::log(to / from) / std::log(kSteps)));
    for (int p = 0; p < parts; ++p)
      even(p == 0 ? from : from * std::pow(to / from, static_cast<double>(p) / parts), p + 1 == parts ? to : from * std::pow(to / from, (p + 1.0) / parts));
  }
  return bins;
}

/// Bins cut into even parts where fringes are closer together than they show.
std::vector<Bin> followed(const std::vector<Bin>& bins, const Simulation& sim) {
  const auto fringed = fringedOf(sim);
  if (fringed.empty()) return bins;
  std::vector<Bin> all;
  for (const Bin& bin : bins) {
    double widest = bin.to - bin.from;
    for (const HasFringes* f : fringed) widest = std::min(widest, f->resolvedBy_um(bin.at));
    const int parts = static_cast<int>((bin.to - bin.from) / widest + 0.999);
    if (parts < 2) {
      all.push_back(bin);
      continue;
    }
    for (int b = 0; b < parts; ++b)
      all.push_back({bin.from + (bin.to - bin.from) * b / parts, bin.from + (bin.to - bin.from) * (b + 1) / parts,
                     bin.from + (bin.to - bin.from) * (b + 0.5) / parts});
  }
  return all;
}

/// Where spectra bend within a bin so that its middle does not stand for it.
std::vector<double> cutsOf(const Bin& bin, std::span<const BentSpectrum> spectra) {
  std::vector<double> cuts;
  for (const BentSpectrum& s : spectra) {
    auto knots = knotsWithin(s, bin.from, bin.to);
    if (knots.empty()) continue;
    // By two Gauss points between bends: at a step the values on both sides count.
    std::vector<double> edges = {bin.from};
    edges.insert(edges.end(), knots.begin(), knots.end());
    edges.push_back(bin.to);
    double sum = 0.0;
    for (size_t i = 0; i + 1 < edges.size(); ++i) {
      const double width = edges[i + 1] - edges[i];
      for (const auto& [place, weight] : {std::pair{0.2113248654051871, 0.5}, {0.7886751345948129, 0.5}}) {
        sum += weight * width * s.at(edges[i] + place * width);
      }
    }
    const double mean = sum / (bin.to - bin.from), middle = s.at(bin.at);
    if (std::abs(mean - middle) <= kBent * std::max(std::abs(mean), std::abs(middle))) continue;
    const size_t step = (knots.size() + kMostCuts - 1) / kMostCuts;
    for (size_t k = 0; k < knots.size(); k += step) cuts.push_back(knots[k]);
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

std::vector<QuadratureNode> weighted(const Spectrum& kernel, const std::vector<Bin>& bins, std::span<const BentSpectrum> spectra) {
  std::vector<QuadratureNode> nodes;
  const auto add = [&](double from, double to, double at) {
    const double weight = from < to ? kernel.integral(from, to) : 0.0;
    if (weight != 0.0) nodes.push_back({at, weight});
  };
  for (const Bin& bin : bins) {
    const auto cuts = cutsOf(bin, spectra);
    if (cuts.empty()) {
      add(bin.from, bin.to, bin.at);
      continue;
    }
    double from = bin.from;
    for (double c : cuts) add(from, c, 0.5 * (from + c)), from = c;
    add(from, bin.to, 0.5 * (from + bin.to));
  }
  return nodes;
}

}  // namespace

std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, std::span<const double> table) {
  return weighted(kernel, table.empty() ? usualBins(kernel, {}) : tableBins(table, kernel.supportLow(), kernel.supportHigh()), {});
}

std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, const Simulation& sim) {
  auto spectra = spectraOf(sim);
  if (!sim.air || !sim.air->traits().any) return weighted(kernel, followed(usualBins(kernel, {}), sim), spectra);
  const std::vector<double> knots = sim.air->knots_um();
  // Air from a table keeps its table's wavelengths.
  if (sim.air->traits().linearBetweenKnots) return weighted(kernel, followed(tableBins(knots, kernel.supportLow(), kernel.supportHigh()), sim), spectra);
  std::vector<double> own;
  for (size_t k = 1; k + 1 < knots.size(); ++k)
    if (std::min(knots[k] - knots[k - 1], knots[k + 1] - knots[k]) >= kOwnBins * referenceWidth_um(knots[k])) own.push_back(knots[k]);
  spectra.push_back(airSpectrum(*sim.air));
  return weighted(kernel, followed(usualBins(kernel, own), sim), spectra);
}

}  // namespace pitviper
