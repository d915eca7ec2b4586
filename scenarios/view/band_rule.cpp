#include "scenarios/view/band_rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/parameters/on_threads.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

/// Cells of a 32nd of an octave: two Gauss points are off by (x ln(2) / 32)^4 / 4320 of Planck's law at x = c2 / (lambda T): 2e-5 at 25.
constexpr double kCell_octaves = 1.0 / 32.0;

struct FineRule {
  std::vector<double> x;
  std::vector<std::vector<double>> weight;
};

FineRule fineRule(const std::vector<Spectrum>& weights, std::vector<double> edges, const std::function<double(double)>& longest_um) {
  for (const Spectrum& w : weights) {
    if (w.isZero()) continue;
    const auto knots = w.knots();
    edges.insert(edges.end(), knots.begin(), knots.end());
    edges.push_back(w.supportLow());
    edges.push_back(w.supportHigh());
  }
  std::sort(edges.begin(), edges.end());
  FineRule fine;
  fine.weight.resize(weights.size());
  const double gauss = 0.5 / std::sqrt(3.0);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double a = edges[i], b = edges[i + 1], middle = 0.5 * (a + b);
    const auto seen = [&](const Spectrum& w) { return !w.isZero() && middle > w.supportLow() && middle < w.supportHigh(); };
    // Knots that are the same but for rounding leave no cell.
    if (b - a <= 1e-9 * b || std::none_of(weights.begin(), weights.end(), seen)) continue;
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::max(std::log2(b / a) / kCell_octaves, (b - a) / longest_um(middle)))));
    const double step = (b - a) / pieces;
    for (int k = 0; k < 2 * pieces; ++k) {
      const double x = a + step * (0.5 + k / 2 + (k % 2 ? gauss : -gauss));
      fine.x.push_back(x);
      for (std::size_t n = 0; n < weights.size(); ++n) fine.weight[n].push_back(seen(weights[n]) ? 0.5 * step * weights[n](x) : 0.0);
    }
  }
  return fine;
}

/// Keeps places of stretches that parabolas through three of them stand for.
class Thinned {
 public:
  Thinned(const FineRule& fine, const std::vector<BandProbe>& probes, double accuracy) : fine_(fine), accuracy_(accuracy) {
    rule_.weight.resize(fine.weight.size());
    for (const auto& w : fine.weight) {
      double sum = 0.0;
      for (double v : w) sum += std::abs(v);
      total_.push_back(sum);
    }
    for (const BandProbe& probe : probes) {
      std::vector<double> values(fine.x.size() * probe.count);
      onStretches(fine.x.size(), 16, [&](std::size_t from, std::size_t to) {
        std::vector<double> own(probe.count);
        for (std::size_t p = from; p < to; ++p) {
          probe.at(fine.x[p], own);
          for (std::size_t f = 0; f < probe.count; ++f) values[f * fine.x.size() + p] = own[f];
        }
      });
      for (std::size_t w : probe.weights) {
        const std::size_t first = pairs_.size();
        double most = 0.0;
        for (std::size_t f = 0; f < probe.count; ++f) {
          double whole = 0.0;
          for (std::size_t p = 0; p < fine.x.size(); ++p) whole += fine.weight[w][p] * values[f * fine.x.size() + p];
          most = std::max(most, std::abs(whole));
          pairs_.push_back({functions_.size() + f, w, std::abs(whole)});
        }
        // Tails of lobes don't count.
        for (std::size_t k = first; k < pairs_.size(); ++k) pairs_[k].scale = std::max(pairs_[k].scale, 1e-3 * most);
      }
      for (std::size_t f = 0; f < probe.count; ++f) {
        const double* value = values.data() + static_cast<std::ptrdiff_t>(f * fine.x.size());
        functions_.emplace_back(value, value + fine.x.size());
      }
    }
  }

  BandRule of() {
    // Weights end where channels do: no parabola goes on there.
    for (std::size_t from = 0, to = 0; from < fine_.x.size(); from = to) {
      for (to = from + 1; to < fine_.x.size() && sameChannels(to - 1, to);) ++to;
      stretch(from, to);
    }
    return std::move(rule_);
  }

 private:
  struct Pair {
    std::size_t function, weight;
    double scale;  ///< of its integral
  };

  bool sameChannels(std::size_t a, std::size_t b) const {
    return std::all_of(fine_.weight.begin(), fine_.weight.end(), [&](const auto& w) { return (w[a] != 0.0) == (w[b] != 0.0); });
  }

  void keep(std::size_t place) {
    rule_.wavelength_um.push_back(fine_.x[place]);
    for (std::size_t w = 0; w < fine_.weight.size(); ++w) rule_.weight[w].push_back(fine_.weight[w][place]);
  }

  void stretch(std::size_t from, std::size_t to) {
    const std::size_t count = to - from;
    if (count <= 3) {
      for (std::size_t p = from; p < to; ++p) keep(p);
      return;
    }
    // As Gauss would have them.
    const auto at = [&](double share) { return from + std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count))); };
    const std::array<std::size_t, 3> nodes{at(0.1127), at(0.5), at(0.8873)};
    std::vector<std::array<double, 3>> moments(fine_.weight.size(), {0.0, 0.0, 0.0});
    const double x0 = fine_.x[nodes[0]], x1 = fine_.x[nodes[1]], x2 = fine_.x[nodes[2]];
    for (std::size_t p = from; p < to; ++p) {
      const double x = fine_.x[p];
      const double l0 = (x - x1) * (x - x2) / ((x0 - x1) * (x0 - x2)), l1 = (x - x0) * (x - x2) / ((x1 - x0) * (x1 - x2)), l2 = 1.0 - l0 - l1;
      for (std::size_t w = 0; w < moments.size(); ++w) {
        const double weight = fine_.weight[w][p];
        moments[w][0] += weight * l0, moments[w][1] += weight * l1, moments[w][2] += weight * l2;
      }
    }
    if (standsFor(from, to, nodes, moments)) {
      for (std::size_t k = 0; k < 3; ++k) {
        rule_.wavelength_um.push_back(fine_.x[nodes[k]]);
        for (std::size_t w = 0; w < moments.size(); ++w) rule_.weight[w].push_back(moments[w][k]);
      }
      return;
    }
    // Pairs of one cell stay together.
    const std::size_t middle = from + count / 2 / 2 * 2;
    stretch(from, middle);
    stretch(middle, to);
  }

  /// Each stretch may be off by its share of the weight and of the places: in all, by `accuracy`.
  bool standsFor(std::size_t from, std::size_t to, const std::array<std::size_t, 3>& nodes, const std::vector<std::array<double, 3>>& moments) const {
    std::vector<double> share(moments.size(), 0.0);
    for (std::size_t w = 0; w < share.size(); ++w) {
      for (std::size_t p = from; p < to; ++p) share[w] += std::abs(fine_.weight[w][p]);
      if (total_[w] > 0.0) share[w] /= total_[w];
    }
    const double places = static_cast<double>(to - from) / static_cast<double>(fine_.x.size());
    return std::all_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
      const auto& f = functions_[pair.function];
      double off = 0.0;
      for (std::size_t k = 0; k < 3; ++k) off += moments[pair.weight][k] * f[nodes[k]];
      for (std::size_t p = from; p < to; ++p) off -= fine_.weight[pair.weight][p] * f[p];
      return std::abs(off) <= accuracy_ * 0.5 * (share[pair.weight] + places) * pair.scale;
    });
  }

  const FineRule& fine_;
  double accuracy_;
  std::vector<double> total_;
  std::vector<std::vector<double>> functions_;
  std::vector<Pair> pairs_;
  BandRule rule_;
};

}  // namespace

BandRule bandRule(const std::vector<Spectrum>& weights, const std::vector<double>& knots_um, const std::function<double(double)>& longest_um,
                  const std::vector<BandProbe>& probes, double accuracy) {
  const FineRule fine = fineRule(weights, knots_um, longest_um);
  return Thinned(fine, probes, accuracy).of();
}

}  // namespace pitviper
