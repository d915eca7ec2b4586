#include "sim/radiance/source_iteration.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

using Eigen::ArrayXd, Eigen::ArrayXXd, Eigen::Index, Eigen::MatrixXd;

/// Of the sun's light, moments of the phase function to this degree: what forward peaks have beyond goes on as before.
constexpr int kSunDegree = 40;
/// Depth that no light passes.
constexpr double kNone = 1e9;

/// All layers as the directions cross them, [direction][layer]: by the law of a segment (sim/radiometry/glsl/segment.glsl), and of sunlight that is turned
/// once.
struct Crossing {
  ArrayXXd left, lost, growth;
  ArrayXXd sunDown, sunUp;
};

/// `toSun`: optical depth at each edge.
Crossing crossingOf(const PlaneLayers& layers, const ArrayXd& sine, const std::vector<double>& toSun) {
  const auto count = std::ssize(layers.layers);
  Crossing c;
  for (ArrayXXd* a : {&c.left, &c.lost, &c.growth, &c.sunDown, &c.sunUp}) a->setZero(sine.size(), count);
  for (Index k = 0; k < count; ++k) {
    const auto n = static_cast<std::size_t>(k);
    const double sun = layers.irradiance * std::exp(-toSun[n]), fall = std::min(toSun[n + 1] - toSun[n], kNone);
    for (Index i = 0; i < sine.size(); ++i) {
      const double d = layers.layers[n].depth / sine[i], left = std::exp(-d);
      c.left(i, k) = left, c.lost(i, k) = physics::lostOf(d, left), c.growth(i, k) = physics::growthOf(d, left, c.lost(i, k));
      if (!(sun > 0.0)) continue;
      c.sunDown(i, k) = sun * d * physics::meanPassedBetween(d, fall), c.sunUp(i, k) = sun * d * physics::meanPassedBetween(0.0, fall + d);
    }
  }
  return c;
}

/// Lambda_lm of the Gauss points of a hemisphere, [direction][l - m], to the highest degree there is. Kept.
const MatrixXd& lambdaOf(int hemisphere, int m) {
  constexpr int kMost = 64;
  static std::mutex busy;
  static std::map<std::pair<int, int>, MatrixXd> all;
  const std::scoped_lock lock(busy);
  const auto [at, isNew] = all.try_emplace({hemisphere, m});
  if (!isNew) return at->second;
  at->second.resize(hemisphere, kMost - m);
  std::vector<double> row(static_cast<std::size_t>(kMost - m));
  Index i = 0;
  for (const QuadratureNode& n : gaussLegendre(hemisphere, 0.0, 1.0)) {
    legendreTerms(n.x, m, kMost, row.data());
    for (std::size_t l = 0; l < row.size(); ++l) at->second(i, static_cast<Index>(l)) = row[l];
    ++i;
  }
  return at->second;
}

/// Radiance at the edges, [direction][edge]: of sources at both edges of each layer.
struct Swept {
  MatrixXd down, up;
};

}  // namespace

LayerLight finer(const PlaneLayers& layers, const LayerLight& coarse, const FineDirections& fine) {
  LayerLight out;
  const bool sunlit = layers.irradiance > 0.0;
  out.shape = {fine.degree, sunlit ? std::clamp(fine.azimuths, 1, fine.degree) : 1};
  const auto layerCount = std::ssize(layers.layers), edges = layerCount + 1;
  ArrayXd sine(fine.hemisphere), weight(fine.hemisphere);
  Index at = 0;
  for (const QuadratureNode& n : gaussLegendre(fine.hemisphere, 0.0, 1.0)) sine[at] = n.x, weight[at++] = n.weight;
  const auto moments = static_cast<std::size_t>(out.shape.moments());
  const int most = std::max({kSunDegree, coarse.shape.streams, fine.degree});
  out.solar.assign(static_cast<std::size_t>(edges) * moments, 0.0);
  out.thermal.assign(static_cast<std::size_t>(edges) * static_cast<std::size_t>(fine.degree), 0.0);
  const auto chi = [&](Index k, int l) {
    const PlaneLayer& own = layers.layers[static_cast<std::size_t>(k)];
    return l < std::ssize(own.moments) ? own.albedo * own.moments[static_cast<std::size_t>(l)] * (2.0 * l + 1.0) / (4.0 * kPi) : 0.0;
  };
  std::vector<double> toSun = layers.sunDepth;
  if (toSun.empty()) {
    toSun.push_back(0.0);
    for (const PlaneLayer& l : layers.layers) toSun.push_back(toSun.back() + l.depth / std::max(layers.sunSine, 1e-9));
  }
  for (double& d : toSun) d = std::min(d, kNone);
  const Crossing crossing = crossingOf(layers, sine, toSun);
  const double groundSun = layers.irradiance * std::exp(-toSun.back()) * std::max(layers.sunSine, 0.0);
  const auto sweep = [&](const MatrixXd& even, const MatrixXd& odd, const MatrixXd* sun, double space, double groundEmission, double groundSees, bool level) {
    // Columns: upper edge of each layer, then lower edge.
    Swept s{MatrixXd::Zero(fine.hemisphere, edges), MatrixXd::Zero(fine.hemisphere, edges)};
    s.down.col(0).setConstant(space);
    for (Index k = 0; k < layerCount; ++k) {
      const ArrayXd above = (even.col(k) - odd.col(k)).array(), below = (even.col(layerCount + k) - odd.col(layerCount + k)).array();
      s.down.col(k + 1) = (s.down.col(k).array() * crossing.left.col(k) + below * crossing.lost.col(k) + (above - below) * crossing.growth.col(k)).matrix();
      if (sun) s.down.col(k + 1).array() += (sun[0].col(k) - sun[1].col(k)).array() * crossing.sunDown.col(k);
    }
    if (level) {
      const double falls = 2.0 * kPi * (weight * sine * s.down.col(edges - 1).array()).sum() + groundSees;
      s.up.col(edges - 1).setConstant(groundEmission + layers.groundAlbedo / kPi * falls);
    }
    for (Index k = layerCount; k-- > 0;) {
      const ArrayXd above = (even.col(k) + odd.col(k)).array(), below = (even.col(layerCount + k) + odd.col(layerCount + k)).array();
      s.up.col(k) = (s.up.col(k + 1).array() * crossing.left.col(k) + above * crossing.lost.col(k) + (below - above) * crossing.growth.col(k)).matrix();
      if (sun) s.up.col(k).array() += (sun[0].col(k) + sun[1].col(k)).array() * crossing.sunUp.col(k);
    }
    return s;
  };
  // Azimuth terms go their ways apart.
  for (int m = 0; m < out.shape.azimuths; ++m) {
    // Of each direction, and of the sun's light.
    const MatrixXd& lambda = lambdaOf(fine.hemisphere, m);
    const MatrixXd weighed = (2.0 * kPi * weight).matrix().asDiagonal() * lambda.leftCols(std::max(fine.degree - m, 0));
    MatrixXd sun[2];
    if (sunlit) {
      std::vector<double> ofSun(static_cast<std::size_t>(most - m));
      legendreTerms(-layers.sunSine, m, most, ofSun.data());
      MatrixXd part[2];
      for (MatrixXd& p : part) p = MatrixXd::Zero(most - m, layerCount);
      for (Index k = 0; k < layerCount; ++k)
        for (int l = m; l < most; ++l) part[(l - m) % 2](l - m, k) = (m == 0 ? 1.0 : 2.0) * chi(k, l) * ofSun[static_cast<std::size_t>(l - m)];
      for (int odd : {0, 1}) sun[odd].noalias() = lambda.leftCols(most - m) * part[odd];
    }
    const auto tell = [&](bool solar, const LayerLight& from) {
      const int used = m < from.shape.azimuths || !solar ? std::max(from.shape.streams - m, 0) : 0;
      // Coefficients of each degree at the upper and lower edge of each layer, of even and of odd l + m.
      MatrixXd part[2];
      for (MatrixXd& p : part) p = MatrixXd::Zero(used, 2 * layerCount);
      for (int l = m; l < m + used; ++l)
        for (Index k = 0; k < layerCount; ++k) {
          const double turns = chi(k, l);
          if (turns == 0.0) continue;
          for (Index side = 0; side < 2; ++side) {
            const auto edge = static_cast<std::size_t>(k + side);
            const double light = solar ? from.solarAt(edge)[static_cast<std::size_t>(from.shape.at(l, m))] : from.thermalAt(edge)[static_cast<std::size_t>(l)];
            part[(l - m) % 2](l - m, side * layerCount + k) = turns * light;
          }
        }
      MatrixXd even = lambda.leftCols(used) * part[0], odd = lambda.leftCols(used) * part[1];
      if (!solar)
        for (Index k = 0; k < layerCount; ++k) {
          const PlaneLayer& own = layers.layers[static_cast<std::size_t>(k)];
          even.col(k).array() += (1.0 - own.albedo) * own.blackAbove, even.col(layerCount + k).array() += (1.0 - own.albedo) * own.blackBelow;
        }
      const Swept swept =
          solar ? sweep(even, odd, sun, 0.0, 0.0, groundSun, m == 0) : sweep(even, odd, nullptr, layers.spaceRadiance, layers.groundEmission, 0.0, true);
      const MatrixXd ofSums = weighed.transpose() * (swept.up + swept.down), ofDifferences = weighed.transpose() * (swept.up - swept.down);  // [l][edge]
      for (int l = m; l < fine.degree; ++l)
        for (Index e = 0; e < edges; ++e) {
          const double value = (l - m) % 2 == 0 ? ofSums(l - m, e) : ofDifferences(l - m, e);
          if (solar) out.solar[static_cast<std::size_t>(e) * moments + static_cast<std::size_t>(out.shape.at(l, m))] = value;
          else out.thermal[static_cast<std::size_t>(e * fine.degree + l)] = value;
        }
    };
    for (int pass = 0; pass < fine.passes; ++pass) {
      if (sunlit) tell(true, pass == 0 ? coarse : out);
      if (m == 0) tell(false, pass == 0 ? coarse : out);
    }
  }
  return out;
}

}  // namespace pitviper
