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
/// A line of absorption narrower than a bin is cut where it has fallen by this factor each, down to this part of it: within them exp(-k s) is off its mean by
/// 0.54 (1/2.5)^2 / 24 at most, whatever the length s.
constexpr double kWing = 1.5, kFaintest = 300.0;
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

using Kernels = std::span<const Spectrum* const>;

/// Where any of them bends, rising.
std::vector<double> knotsOf(Kernels kernels) {
  std::vector<double> all;
  for (const Spectrum* k : kernels) {
    const std::vector<double> own = k->knots();
    all.insert(all.end(), own.begin(), own.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// From edge to edge, at least at the responses' own: `own` are further ones where they leave room.
std::vector<Bin> usualBins(Kernels kernels, std::span<const double> own) {
  const double low = kernels.front()->supportLow(), high = kernels.front()->supportHigh();
  std::vector<double> edges = {low, high};
  for (double k : knotsOf(kernels))
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
      all.push_back(
          {bin.from + (bin.to - bin.from) * b / parts, bin.from + (bin.to - bin.from) * (b + 1) / parts, bin.from + (bin.to - bin.from) * (b + 0.5) / parts});
  }
  return all;
}

/// Mean of what is about linear between bends: two Gauss points each, so that at a step the values on both sides count.
template <class F>
double meanBetween(const F& f, double from, double to, std::span<const double> bends) {
  double sum = 0.0, at = from;
  const auto add = [&](double next) {
    for (double place : {0.2113248654051871, 0.7886751345948129}) sum += 0.5 * (next - at) * f(at + place * (next - at));
    at = next;
  };
  for (double b : bends) add(b);
  add(to);
  return sum / (to - from);
}

/// Of a line of absorption narrower than a bin, where it has fallen by so much each: light through any length of it sees its wings (curve of growth).
void addWings(const BentSpectrum& s, const Bin& bin, const std::vector<double>& knots, std::vector<double>& cuts) {
  std::vector<double> edges = {bin.from};
  edges.insert(edges.end(), knots.begin(), knots.end());
  edges.push_back(bin.to);
  for (size_t i = 0; i + 1 < edges.size(); ++i) {
    // A hair inside: bends may be steps.
    const double hair = 1e-9 * (edges[i + 1] - edges[i]), a = s.at(edges[i] + hair), b = s.at(edges[i + 1] - hair), most = std::max(a, b),
                 least = std::min(a, b);
    for (double k = most / kWing; k > std::max(least * kWing, most / kFaintest); k /= kWing)
      cuts.push_back(edges[i] + (k - a) / (b - a) * (edges[i + 1] - edges[i]));
  }
}

struct Cuts {
  std::vector<double> at_um;
  const BentSpectrum* rough = nullptr;  ///< bends more often than there are cuts
  int spectra = 0;                      ///< that asked for cuts
};

/// Where spectra bend within a bin so that its middle does not stand for it.
Cuts cutsOf(const Bin& bin, std::span<const BentSpectrum> spectra) {
  Cuts cuts;
  for (const BentSpectrum& s : spectra) {
    const auto knots = knotsWithin(s, bin.from, bin.to);
    if (knots.empty()) continue;
    const double mean = meanBetween(s.at, bin.from, bin.to, knots), middle = s.at(bin.at);
    if (std::abs(mean - middle) <= kBent * std::max(std::abs(mean), std::abs(middle))) continue;
    ++cuts.spectra;
    const size_t step = (knots.size() + kMostCuts - 1) / kMostCuts;
    if (step > 1) cuts.rough = &s;
    for (size_t k = 0; k < knots.size(); k += step) cuts.at_um.push_back(knots[k]);
    if (s.isDepth && step == 1) addWings(s, bin, knots, cuts.at_um);
  }
  std::sort(cuts.at_um.begin(), cuts.at_um.end());
  cuts.at_um.erase(std::unique(cuts.at_um.begin(), cuts.at_um.end()), cuts.at_um.end());
  return cuts;
}

/// The place between two, nearest to their middle, at which a spectrum is its mean over them.
double placeOfMean(const BentSpectrum& s, double from, double to) {
  const auto knots = knotsWithin(s, from, to);
  const double middle = 0.5 * (from + to), mean = meanBetween(s.at, from, to, knots);
  double best = middle, away = INFINITY, at = from, off = s.at(from) - mean;
  const auto look = [&](double next) {
    const double there = s.at(next) - mean;
    if (off * there <= 0.0 && off != there) {
      const double crossing = at + off / (off - there) * (next - at);
      if (std::abs(crossing - middle) < away) best = crossing, away = std::abs(crossing - middle);
    }
    at = next, off = there;
  };
  for (double k : knots) look(k);
  look(to);
  return best;
}

/// A bin of thousands of lines of a gas by how much they absorb: so many equal parts of it, each where it is their mean (a k-distribution).
std::vector<QuadratureNode> byStrength(const BentSpectrum& s, const Bin& bin, double weight) {
  struct Piece {
    double absorbs, at, width;
  };
  std::vector<Piece> pieces;
  double from = bin.from;
  const auto add = [&](double to) {
    // Of even measure: from one row to the next it may change by decades.
    constexpr int kParts = 8;
    for (int p = 0; p < kParts; ++p) {
      const double at = from + (p + 0.5) / kParts * (to - from);
      pieces.push_back({s.at(at), at, (to - from) / kParts});
    }
    from = to;
  };
  for (double k : knotsWithin(s, bin.from, bin.to)) add(k);
  add(bin.to);
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.absorbs < b.absorbs; });
  std::vector<QuadratureNode> nodes;
  const double whole = bin.to - bin.from;
  double passed = 0.0;
  for (size_t i = 0; i < pieces.size();) {
    const size_t first = i;
    const double end = whole * static_cast<double>(nodes.size() + 1) / kMostCuts;
    double width = 0.0, sum = 0.0;
    do width += pieces[i].width, sum += pieces[i].width * pieces[i].absorbs, ++i;
    while (i < pieces.size() && (passed + width < end || nodes.size() + 1 == kMostCuts));
    passed += width;
    const auto nearest =
        std::min_element(pieces.begin() + static_cast<std::ptrdiff_t>(first), pieces.begin() + static_cast<std::ptrdiff_t>(i),
                         [mean = sum / width](const Piece& a, const Piece& b) { return std::abs(a.absorbs - mean) < std::abs(b.absorbs - mean); });
    nodes.push_back({nearest->at, weight * width / whole});
  }
  return nodes;
}

/// Nodes for each kernel, at the same wavelengths. `free`: bins may be looked at beside their middle where that stands better for them: where a response's
/// narrow peaks are.
std::vector<std::vector<QuadratureNode>> weighted(Kernels kernels, const std::vector<Bin>& bins, std::span<const BentSpectrum> spectra, bool free) {
  std::vector<std::vector<QuadratureNode>> nodes(kernels.size());
  const std::vector<double> peaks = free ? knotsOf(kernels) : std::vector<double>();
  const double low = kernels.front()->supportLow(), high = kernels.front()->supportHigh();
  // Of several, their mean shape.
  std::vector<double> scale = {1.0};
  for (size_t k = 1; k < kernels.size(); ++k) scale.push_back(kernels.front()->integral(low, high) / kernels[k]->integral(low, high));
  const auto shape = [&](double w) {
    double sum = 0.0;
    for (size_t k = 0; k < kernels.size(); ++k) sum += scale[k] * (*kernels[k])(w);
    return sum;
  };
  const auto centroid = [&](double from, double to, double at, bool piece) {
    const std::vector<double> within(std::upper_bound(peaks.begin(), peaks.end(), from), std::lower_bound(peaks.begin(), peaks.end(), to));
    if (within.empty() && !(piece && free)) return at;
    const double mean = meanBetween(shape, from, to, within), moment = meanBetween([&](double w) { return (w - from) * shape(w); }, from, to, within);
    return mean > 0.0 && moment >= 0.0 && moment <= mean * (to - from) ? from + moment / mean : at;
  };
  const auto weights = [&](double from, double to) {
    std::vector<double> all;
    for (const Spectrum* k : kernels) all.push_back(from < to ? k->integral(from, to) : 0.0);
    return all;
  };
  const auto isSeen = [](const std::vector<double>& all) { return std::any_of(all.begin(), all.end(), [](double w) { return w != 0.0; }); };
  const auto add = [&](double from, double to, double at, bool piece, const BentSpectrum* rough) {
    const std::vector<double> all = weights(from, to);
    if (!isSeen(all)) return;
    const double place = rough ? placeOfMean(*rough, from, to) : centroid(from, to, at, piece);
    for (size_t k = 0; k < kernels.size(); ++k) nodes[k].push_back({place, all[k]});
  };
  for (const Bin& bin : bins) {
    const Cuts cuts = cutsOf(bin, spectra);
    if (cuts.at_um.empty()) {
      add(bin.from, bin.to, bin.at, false, nullptr);
      continue;
    }
    if (cuts.rough && cuts.rough->isDepth && cuts.spectra == 1) {
      const std::vector<double> all = weights(bin.from, bin.to);
      for (size_t k = 0; isSeen(all) && k < kernels.size(); ++k)
        for (const QuadratureNode& n : byStrength(*cuts.rough, bin, all[k])) nodes[k].push_back(n);
      continue;
    }
    double from = bin.from;
    for (double c : cuts.at_um) add(from, c, 0.5 * (from + c), true, cuts.rough), from = c;
    add(from, bin.to, 0.5 * (from + bin.to), true, cuts.rough);
  }
  return nodes;
}

}  // namespace

std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, std::span<const double> table) {
  const Spectrum* const one[] = {&kernel};
  return weighted(one, table.empty() ? usualBins(one, {}) : tableBins(table, kernel.supportLow(), kernel.supportHigh()), {}, table.empty()).front();
}

std::vector<std::vector<QuadratureNode>> fineGrids(Kernels kernels, const Simulation& sim) {
  auto spectra = spectraOf(sim);
  if (!sim.air || !sim.air->traits().any) return weighted(kernels, followed(usualBins(kernels, {}), sim), spectra, true);
  const std::vector<double> knots = sim.air->knots_um();
  // Air from a table keeps its table's wavelengths.
  if (sim.air->traits().linearBetweenKnots)
    return weighted(kernels, followed(tableBins(knots, kernels.front()->supportLow(), kernels.front()->supportHigh()), sim), spectra, false);
  std::vector<double> own;
  for (size_t k = 1; k + 1 < knots.size(); ++k)
    if (std::min(knots[k] - knots[k - 1], knots[k + 1] - knots[k]) >= kOwnBins * referenceWidth_um(knots[k])) own.push_back(knots[k]);
  spectra.push_back(airSpectrum(*sim.air));
  return weighted(kernels, followed(usualBins(kernels, own), sim), spectra, true);
}

std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, const Simulation& sim) {
  const Spectrum* const one[] = {&kernel};
  return fineGrids(one, sim).front();
}

}  // namespace pitviper
