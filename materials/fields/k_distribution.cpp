#include "materials/fields/k_distribution.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pitviper {
namespace {

/// Shares and orders were found by simulated annealing: least error of each gas's transmittance and of the product of two, over overlaps
/// from 0.012 to 0.6 (carbon dioxide: 0.017 to 1.5, in 8 cells 0.06 to 3).
struct Division {
  std::vector<double> shares;
  std::array<std::vector<std::size_t>, 3> order;  ///< by BandAbsorber: the cell of each rank
};

const Division& division(std::size_t cells) {
  static const Division one{{1.0}, {{{0}, {0}, {0}}}};
  static const Division alone{{0.1528, 0.3668, 0.2665, 0.1022, 0.0756, 0.0361}, {{{0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 5}}}};
  static const Division two{{0.1227, 0.1519, 0.0406, 0.124, 0.2796, 0.0921, 0.1312, 0.0579},
                            {{{0, 1, 2, 3, 4, 5, 6, 7}, {3, 6, 0, 4, 7, 1, 5, 2}, {0, 1, 2, 3, 4, 5, 6, 7}}}};
  static const Division three{{0.1032, 0.0654, 0.0941, 0.1085, 0.0741, 0.2023, 0.0387, 0.0427, 0.045, 0.1004, 0.0795, 0.0461},
                              {{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, {8, 3, 10, 0, 7, 5, 11, 4, 2, 9, 1, 6}, {4, 3, 11, 9, 6, 0, 5, 1, 10, 8, 2, 7}}}};
  switch (cells) {
    case 1:
      return one;
    case 6:
      return alone;
    case 8:
      return two;
    case 12:
      return three;
    default:
      throw std::invalid_argument("a band is divided into 1, 6, 8 or 12 cells");
  }
}

constexpr double kLeastOverlap = 0.004, kMostOverlap = 100.0;
constexpr int kNodes = 41;  ///< a quarter apart in the logarithm of the overlap

std::vector<double> sharesByRank(const Division& d, BandAbsorber gas) {
  std::vector<double> weights;
  for (std::size_t cell : d.order[static_cast<std::size_t>(gas)]) weights.push_back(d.shares[cell]);
  return weights;
}

using Ladder = std::array<RankCurve, kNodes>;

/// From lines that overlap altogether, where all is nearly the mean (relative variance 1/(4 overlap)), to lines far apart: each fit starts at the one before.
Ladder ladderOf(const Division& d, BandAbsorber gas) {
  const std::vector<double> weights = sharesByRank(d, gas);
  Ladder ladder;
  RankCurve curve{0.0, 2.0 * std::sqrt(0.25 / kMostOverlap), 0.0, 0.0};
  for (int node = 0; node < kNodes; ++node) {
    const double overlap = kMostOverlap * std::pow(kLeastOverlap / kMostOverlap, node / (kNodes - 1.0));
    curve = fitRankCurve([overlap](double x) { return std::exp(-curveOfGrowth(1.0, overlap, x)); }, weights, curve);
    ladder[static_cast<std::size_t>(node)] = curve;
  }
  return ladder;
}

const Ladder& ladder(std::size_t cells, BandAbsorber gas) {
  static const auto all = [] {
    std::array<std::array<Ladder, 3>, 3> made;
    for (std::size_t i = 0; i < made.size(); ++i)
      for (std::size_t g = 0; g < 3; ++g) made[i][g] = ladderOf(division(std::array<std::size_t, 3>{6, 8, 12}[i]), static_cast<BandAbsorber>(g));
    return made;
  }();
  return all[cells == 6 ? 0 : cells == 8 ? 1 : 2][static_cast<std::size_t>(gas)];
}

/// The normal deviate below which a share lies: bisection, within 2e-15 of it.
double normalDeviate(double share) {
  double low = -8.0, high = 8.0;
  for (int i = 0; i < 52; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle * std::sqrt(0.5)) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Row by weight: the Chebyshev polynomials at its middle.
Eigen::Matrix<double, Eigen::Dynamic, 4> basisOf(std::span<const double> weights) {
  Eigen::Matrix<double, Eigen::Dynamic, 4> basis(static_cast<Eigen::Index>(weights.size()), 4);
  double below = 0.0;
  for (Eigen::Index i = 0; i < basis.rows(); ++i) {
    const double weight = weights[static_cast<std::size_t>(i)], z = 0.5 * normalDeviate(below + 0.5 * weight);
    basis.row(i) << 1.0, z, 2.0 * z * z - 1.0, z * (4.0 * z * z - 3.0);
    below += weight;
  }
  return basis;
}

}  // namespace

double curveOfGrowth(double mean_per_atm_m, double overlap, double path_atm_m) {
  const double x = mean_per_atm_m * path_atm_m;
  return x / std::sqrt(1.0 + 0.25 * x / overlap);
}

bool isCellCount(std::size_t cells) { return cells == 1 || cells == 6 || cells == 8 || cells == 12; }
std::span<const double> cellShares(std::size_t cells) { return division(cells).shares; }
std::span<const std::size_t> cellOfRank(std::size_t cells, BandAbsorber gas) { return division(cells).order[static_cast<std::size_t>(gas)]; }

std::vector<double> levelsOf(const RankCurve& curve, std::span<const double> weights) {
  const Eigen::VectorXd levels = (basisOf(weights) * Eigen::Map<const Eigen::Vector4d>(curve.data())).array().exp();
  return {levels.data(), levels.data() + levels.size()};
}

RankCurve fitRankCurve(const std::function<double(double)>& transmittance, std::span<const double> weights, const RankCurve& start) {
  // Four x a decade. Below 0.01 the mean alone counts, which has its own row; beyond a transmittance of 0.002 nothing is seen.
  std::vector<double> xs, wanted;
  for (double x = 0.01; x < 1e7; x *= std::pow(10.0, 0.25)) {
    wanted.push_back(transmittance(x));
    xs.push_back(x);
    if (wanted.back() < 0.002) break;
  }
  const Eigen::Index n = static_cast<Eigen::Index>(xs.size()), m = static_cast<Eigen::Index>(weights.size());
  const auto basis = basisOf(weights);
  constexpr double kMeanWeight = 0.3;  // a mean off by 0.01 counts as a transmittance off by 0.003
  constexpr double kStraight = 1e-4;   // where lines overlap so much that the bend is not seen, there is none
  Eigen::MatrixXd byLevel(n + 1, m), slopes(n + 3, 4);
  slopes.bottomRows(2) << 0.0, 0.0, kStraight, 0.0, 0.0, 0.0, 0.0, kStraight;
  const auto errors = [&](const Eigen::Vector4d& at) {
    const Eigen::VectorXd levels = (basis * at).array().exp();
    Eigen::VectorXd error(n + 3);
    error.tail(2) = kStraight * at.tail(2);
    error[n] = -kMeanWeight;
    for (Eigen::Index k = 0; k < n; ++k) error[k] = -wanted[static_cast<std::size_t>(k)];
    for (Eigen::Index i = 0; i < m; ++i) {
      const double weight = weights[static_cast<std::size_t>(i)];
      error[n] += byLevel(n, i) = kMeanWeight * weight * levels[i];
      for (Eigen::Index k = 0; k < n; ++k) {
        const double depth = levels[i] * xs[static_cast<std::size_t>(k)], passed = weight * std::exp(-depth);
        error[k] += passed;
        byLevel(k, i) = -depth * passed;
      }
    }
    return error;
  };
  // Levenberg-Marquardt.
  Eigen::Vector4d curve(start.data());
  Eigen::VectorXd error = errors(curve);
  slopes.topRows(n + 1) = byLevel * basis;
  double damping = 1e-3;
  for (int step = 0; step < 60 && damping < 1e6; ++step) {
    Eigen::Matrix4d normal = slopes.transpose() * slopes;
    normal.diagonal() += damping * normal.diagonal() + Eigen::Vector4d::Constant(1e-10);  // a column may be zero: a band of one level
    const Eigen::Vector4d change = normal.ldlt().solve(-(slopes.transpose() * error)).cwiseMax(-0.7).cwiseMin(0.7);
    const Eigen::VectorXd then = errors(curve + change);
    if (then.squaredNorm() >= error.squaredNorm()) {
      damping *= 4.0;
      continue;
    }
    curve += change;
    error = then;
    slopes.topRows(n + 1) = byLevel * basis;
    damping = std::max(0.3 * damping, 1e-9);
    if (change.cwiseAbs().maxCoeff() < 1e-7) break;
  }
  return {curve[0], curve[1], curve[2], curve[3]};
}

std::vector<double> cellAbsorption(std::size_t cells, BandAbsorber gas, double overlap) {
  const Division& d = division(cells);
  if (cells == 1) return {1.0};
  const Ladder& nodes = ladder(cells, gas);
  const double at = std::log(std::clamp(overlap, kLeastOverlap, kMostOverlap) / kMostOverlap) / std::log(kLeastOverlap / kMostOverlap) * (kNodes - 1.0);
  const std::size_t node = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kNodes - 2));
  RankCurve curve;
  for (std::size_t i = 0; i < curve.size(); ++i) curve[i] = nodes[node][i] + (at - static_cast<double>(node)) * (nodes[node + 1][i] - nodes[node][i]);
  const std::vector<double> weights = sharesByRank(d, gas), levels = levelsOf(curve, weights);
  double mean = 0.0;
  for (std::size_t rank = 0; rank < cells; ++rank) mean += weights[rank] * levels[rank];
  std::vector<double> byCell(cells);
  for (std::size_t rank = 0; rank < cells; ++rank) byCell[d.order[static_cast<std::size_t>(gas)][rank]] = levels[rank] / mean;
  return byCell;
}

}  // namespace pitviper
