#include "sim/radiance/node_air.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/radiance/diffuse_light.hpp"
#include "sim/radiance/node_planck.hpp"
#include "sim/radiometry/exponentials.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Temperatures of air anywhere [K] and entries over their inverse.
constexpr double kColdest_K = 140.0, kWarmest_K = 400.0;
constexpr Eigen::Index kTemperatures = 256;

/// Of nodes; most absorbers scatter nothing.
struct Coefficients {
  Eigen::MatrixXd of;                   ///< [node][absorber]
  std::vector<Eigen::Index> absorbers;  ///< whose are not all zero

  void findAbsorbers() {
    for (Eigen::Index k = 0; k < of.cols(); ++k)
      if (!of.col(k).isZero(0.0)) absorbers.push_back(k);
  }
};

/// Of each station, sum over absorbers of coefficient x amount, in their order: a node's sum is the same to the last bit whichever nodes stand beside it, which
/// a product of matrices does not promise.
template <class Into>
void weigh(const Coefficients& coefficients, const std::vector<AirAmounts>& amounts, Into&& into) {
  for (std::size_t s = 0; s < amounts.size(); ++s) {
    auto sum = into.col(static_cast<Eigen::Index>(s));
    sum.setZero();
    for (const Eigen::Index k : coefficients.absorbers)
      if (const double amount = amounts[s].amount[static_cast<std::size_t>(k)]; amount != 0.0) sum += amount * coefficients.of.col(k).array();
  }
}

/// exp(-x) of each.
void leave(const Eigen::ArrayXd& x, Eigen::ArrayXd& left) {
  left = -x;
  exponentials(left.data(), static_cast<int>(left.size()));
}

Eigen::Map<Eigen::ArrayXXd> sized(std::vector<double>& all, Eigen::Index nodes, Eigen::Index stations) {
  all.assign(static_cast<size_t>(nodes * stations), 0.0);
  return {all.data(), nodes, stations};
}

}  // namespace

struct NodeAir::Tables {
  std::span<const SpectralNode> nodes;
  Coefficients extinction, molecules, haze;
  std::vector<Coefficients> scattered;  ///< by molecules and each kind of particles that `diffuse` tells of
  std::vector<Eigen::Index> apart;      ///< absorbers of `haze` whose asymmetry is not the mean at some node
  Eigen::ArrayXd source;
  Eigen::ArrayXXd logPlanck;  ///< [node], over the inverse of the temperature
  std::optional<NodeDiffuse> diffuse;

  void planck(double temperature_K, Eigen::ArrayXd& into) const {
    if (!(temperature_K > 0.0)) {
      into.setZero(source.size());
      return;
    }
    const double t = (1.0 / temperature_K - 1.0 / kWarmest_K) / (1.0 / kColdest_K - 1.0 / kWarmest_K) * (kTemperatures - 1);
    if (!(t >= 0.0 && t <= kTemperatures - 1)) {
      into.resize(source.size());
      for (Eigen::Index i = 0; i < into.size(); ++i) into[i] = nodes[static_cast<size_t>(i)].planck(temperature_K);
      return;
    }
    const Eigen::Index k = std::min(static_cast<Eigen::Index>(t), kTemperatures - 2);
    const double f = t - static_cast<double>(k);
    into = (1.0 - f) * logPlanck.col(k) + f * logPlanck.col(k + 1);
    exponentials(into.data(), static_cast<int>(into.size()));
  }
};

NodeAir::NodeAir(std::span<const SpectralNode> all, std::shared_ptr<const DiffuseLight> diffuse, bool kept) {
  const auto nodes = static_cast<Eigen::Index>(all.size());
  Tables t;
  t.nodes = all;
  for (Coefficients* c : {&t.extinction, &t.molecules, &t.haze}) c->of.resize(nodes, kMostAirAmounts);
  t.source.resize(nodes);
  t.logPlanck.resize(nodes, kTemperatures);
  const auto row = [](const auto& coefficients) { return Eigen::Map<const Eigen::RowVectorXd>(coefficients.data(), kMostAirAmounts); };
  for (Eigen::Index i = 0; i < nodes; ++i) {
    const SpectralNode& n = all[static_cast<size_t>(i)];
    t.extinction.of.row(i) = row(n.air.extinction), t.molecules.of.row(i) = row(n.air.molecules), t.haze.of.row(i) = row(n.air.haze);
    t.source[i] = n.air.source;
  }
  for (Coefficients* c : {&t.extinction, &t.molecules, &t.haze}) c->findAbsorbers();
  for (const Eigen::Index k : t.haze.absorbers)
    if (std::any_of(all.begin(), all.end(), [&](const SpectralNode& n) { return n.air.asymmetry[static_cast<size_t>(k)] != n.air.meanAsymmetry; }))
      t.apart.push_back(k);
  const NodePlanck planck(all);
  std::vector<double> black(all.size());
  for (Eigen::Index k = 0; k < kTemperatures; ++k) {
    planck.at(1.0 / (1.0 / kWarmest_K + (1.0 / kColdest_K - 1.0 / kWarmest_K) * static_cast<double>(k) / (kTemperatures - 1)), black);
    for (Eigen::Index i = 0; i < nodes; ++i) t.logPlanck(i, k) = std::log(std::max(black[static_cast<size_t>(i)], 1e-300));
  }
  if (diffuse) {
    t.diffuse.emplace(std::move(diffuse), all, kept ? NodeDiffuse::Nodes::Kept : NodeDiffuse::Nodes::Apart);
    t.scattered.push_back(t.molecules);
    for (const auto& kind : t.diffuse->particles()) {
      t.scattered.push_back(t.haze);
      t.scattered.back().absorbers.assign(kind.begin(), kind.end());
    }
  }
  tables_ = std::make_shared<const Tables>(std::move(t));
}

std::vector<double> NodeAir::planck(double temperature_K) const {
  Eigen::ArrayXd all;
  tables_->planck(temperature_K, all);
  return {all.begin(), all.end()};
}

std::vector<double> lostOf(std::span<const double> x) {
  const Eigen::ArrayXd from = Eigen::Map<const Eigen::ArrayXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  Eigen::ArrayXd left;
  leave(from, left);
  std::vector<double> all(x.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = physics::lostOf(x[i], left[static_cast<Eigen::Index>(i)]);
  return all;
}

/// What is turned into a line at one station, and into a step between two of them.
struct NodeAir::Again {
  TurnedLight near, far;
  std::shared_ptr<DiffuseMemory> memory;
  std::vector<Eigen::ArrayXXd> depths;  ///< of scattering by molecules and by each kind of particles, by station
  std::vector<Eigen::ArrayXd> by;

  Again(const Tables& t, const SunlitAir& air, Eigen::Index nodes, std::shared_ptr<DiffuseMemory> known)
      : memory(known ? std::move(known) : std::make_shared<DiffuseMemory>()),
        depths(t.scattered.size(), Eigen::ArrayXXd(nodes, std::ssize(air.stations))),
        by(t.scattered.size()) {
    memory->again();
    for (std::size_t k = 0; k < depths.size(); ++k) weigh(t.scattered[k], air.powered, depths[k]);
  }
  void at(const Tables& t, const SunlitAir& air, Eigen::Index s, bool sunlit, bool thermal, TurnedLight& out) {
    const auto k = static_cast<size_t>(s);
    t.diffuse->at(air.stations[k].height_m, air.sine[k], air.cosAzimuth, {thermal, sunlit}, *memory, out);
  }
  /// Shares of a step's depth that scatter.
  void step(Eigen::Index s, const Eigen::ArrayXd& d) {
    for (std::size_t k = 0; k < by.size(); ++k) by[k] = (d > 0.0).select((depths[k].col(s) - depths[k].col(s - 1)).max(0.0) / d.max(1e-300), 0.0);
  }
};

// Step by step by the law of a segment. Of sunlight scattered once molecules and haze have in common the mean of lit exp(-both) over a step, `both` the depth
// from the eye to a place and on to the sun. Where one end of a step sees no sun, the other's depth holds for it.
NodeRadiance NodeAir::along(const SunlitAir& air, SameWay* way) const {
  const bool isKnown = way && !way->depth.empty();
  const Tables& t = *tables_;
  const auto stations = static_cast<Eigen::Index>(air.stations.size()), nodes = t.source.size();
  const bool sunlit = !air.lit.empty();
  NodeRadiance out;
  if (isKnown) out.depth = way->depth, out.thermal = way->thermal;
  else sized(out.depth, nodes, stations), sized(out.thermal, nodes, stations);
  Eigen::Map<Eigen::ArrayXXd> depth(out.depth.data(), nodes, stations), thermal(out.thermal.data(), nodes, stations);
  if (!isKnown) weigh(t.extinction, air.powered, depth);
  std::optional<Again> again;
  if (t.diffuse) again.emplace(t, air, nodes, way ? way->turned : nullptr);
  const bool turns = t.diffuse && sunlit && t.diffuse->sunlit();
  if (t.diffuse) again->at(t, air, 0, turns, !isKnown, again->near);
  if (sunlit) sized(out.molecules, nodes, stations), sized(out.haze, nodes, stations);
  if (turns) sized(out.again, nodes, stations);
  Eigen::Map<Eigen::ArrayXXd> molecules(out.molecules.data(), sunlit ? nodes : 0, sunlit ? stations : 0),
      haze(out.haze.data(), sunlit ? nodes : 0, sunlit ? stations : 0), byHaze(out.again.data(), turns ? nodes : 0, turns ? stations : 0);
  // Rows of tables may lie beyond the sun's own azimuth, where angles have no cosine.
  const double cosScatter = std::clamp(air.cosScatter, -1.0, 1.0), perPhase = 1.0 / physics::rayleighPhase(cosScatter);
  Eigen::ArrayXd hazePhase(turns ? nodes : 0);
  for (Eigen::Index i = 0; i < hazePhase.size(); ++i) hazePhase[i] = hazeAgainPhase(cosScatter, t.nodes[static_cast<size_t>(i)].air.meanAsymmetry);
  Eigen::ArrayXd seen, before, source, d = depth.col(0), left, lost(nodes), share, from, to;  // with room of their own for all steps
  leave(d, seen);
  if (!isKnown) t.planck(air.stations[0].temperature_K, before), before += t.source;
  const auto send = [&](const Eigen::ArrayXd& near, const Eigen::ArrayXd& far, double scale, auto&& into) {
    for (Eigen::Index i = 0; i < nodes; ++i) into[i] += scale * seen[i] * physics::segmentRadiance(near[i], far[i], d[i], left[i], lost[i]);
  };
  for (Eigen::Index s = 1; s < stations && (turns || !isKnown); ++s) {
    d = (depth.col(s) - depth.col(s - 1)).max(0.0);
    leave(d, left);
    for (Eigen::Index i = 0; i < nodes; ++i) lost[i] = physics::lostOf(d[i], left[i]);
    if (!isKnown) {
      t.planck(air.stations[static_cast<size_t>(s)].temperature_K, source);
      source += t.source;
      thermal.col(s) = thermal.col(s - 1);
    }
    if (!t.diffuse) {
      send(before, source, 1.0, thermal.col(s));
    } else {
      again->step(s, d);
      again->at(t, air, s, turns, !isKnown, again->far);
      const auto of = [](const std::vector<double>& v) { return Eigen::Map<const Eigen::ArrayXd>(v.data(), std::ssize(v)); };
      const TurnedLight &near = again->near, &far = again->far;
      if (!isKnown) {
        from = before, to = source;
        for (std::size_t k = 0; k < again->by.size(); ++k) {
          from += again->by[k] * (of(near.thermal[k]) - before);
          to += again->by[k] * (of(far.thermal[k]) - source);
        }
        send(from, to, 1.0, thermal.col(s));
      }
      if (turns) {
        molecules.col(s) = molecules.col(s - 1);
        from = again->by[0] * of(near.solar[0]), to = again->by[0] * of(far.solar[0]);
        send(from, to, perPhase, molecules.col(s));
        byHaze.col(s) = byHaze.col(s - 1);
        from.setZero(), to.setZero();
        for (std::size_t k = 1; k < again->by.size(); ++k) from += again->by[k] * of(near.solar[k]), to += again->by[k] * of(far.solar[k]);
        from /= hazePhase, to /= hazePhase;
        send(from, to, 1.0, byHaze.col(s));
      }
      std::swap(again->near, again->far);
    }
    seen *= left;
    before.swap(source);
  }
  if (way && !isKnown) *way = {out.depth, out.thermal, again ? again->memory : nullptr};
  if (!sunlit) return out;
  Eigen::ArrayXXd both(nodes, stations);
  Eigen::ArrayXd nearest, reaching, once = Eigen::ArrayXd::Zero(nodes);
  share.resize(nodes);
  weigh(t.extinction, air.both, both);
  // Scattered by molecules and by particles: known where light scattered again is told and particles are alike.
  const bool isTold = again && again->depths.size() == 2 && t.apart.empty();
  Eigen::ArrayXXd ownSmall, ownLarge;
  const Eigen::ArrayXXd &small = isTold ? again->depths[0] : ownSmall, &large = isTold ? again->depths[1] : ownLarge;
  if (!isTold) ownSmall.resize(nodes, stations), weigh(t.molecules, air.powered, ownSmall), ownLarge.resize(nodes, stations);
  if (!isTold && t.apart.empty()) {
    weigh(t.haze, air.powered, ownLarge);
  } else if (!isTold) {
    Coefficients turned = t.haze;
    for (Eigen::Index i = 0; i < nodes; ++i) {
      const AirNode& n = t.nodes[static_cast<size_t>(i)].air;
      const double mean = physics::henyeyGreensteinPhase(cosScatter, n.meanAsymmetry);
      for (const Eigen::Index k : t.apart) turned.of(i, k) *= physics::henyeyGreensteinPhase(cosScatter, n.asymmetry[static_cast<size_t>(k)]) / mean;
    }
    weigh(turned, air.powered, ownLarge);
  }
  for (Eigen::Index s = 1; s < stations; ++s) {
    haze.col(s) = haze.col(s - 1);
    const double here = air.lit[static_cast<size_t>(s - 1)], there = air.lit[static_cast<size_t>(s)], sun = 0.5 * (here + there);
    if (sun > 0.0) {
      const auto near = both.col(here > 0.0 ? s - 1 : s), far = both.col(there > 0.0 ? s : s - 1);
      d = (far - near).abs();
      leave(d, left);
      nearest = near.min(far);
      leave(nearest, reaching);
      for (Eigen::Index i = 0; i < nodes; ++i) share[i] = sun * reaching[i] * physics::meanDecayOf(d[i], left[i]);
      once += (small.col(s) - small.col(s - 1)).max(0.0) * share;
      haze.col(s) += (large.col(s) - large.col(s - 1)).max(0.0) * share;
    }
    molecules.col(s) += once;
  }
  return out;
}

}  // namespace pitviper
