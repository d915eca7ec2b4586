#include "sim/radiance/node_sum.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "sim/radiance/node_planck.hpp"
#include "sim/radiance/node_surroundings.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Temperatures of air anywhere [K], and of gas that burns.
constexpr double kColdest_K = 140.0, kWarmest_K = 400.0, kAirStep_K = 1.0, kHottest_K = 3500.0, kGasStep_K = 5.0;
/// What lets less through than this sends nothing that anybody sees.
constexpr double kOpaque = 45.0;

/// (1 - exp(-d)) for a depth and its transmittance: the series where the difference would lose its digits (next term d^4/24: 4e-22).
double lostOf(double d, double left) { return d < 1e-5 ? d * (1.0 - d * (0.5 - d / 6.0)) : 1.0 - left; }

/// (1 - exp(-d) (1 + d)) / d: weight of what grows linearly with depth over a segment of depth d. The series where the difference would lose its
/// digits: d/2 - d^2/3, next term d^3/8 below 2e-10 of it.
double growing(double d, double left, double lost) { return d < 1e-3 ? d * (0.5 - d / 3.0) : (lost - d * left) / d; }

/// Mean of exp(-t) between two depths, given both: the series where the difference would lose its digits.
double meanPassed(double from, double to, double fromPassed, double toPassed) {
  const double change = to - from;
  return std::abs(change) < 1e-4 ? fromPassed * (1.0 - change * (0.5 - change * (1.0 / 6.0 - change / 24.0))) : (fromPassed - toPassed) / change;
}

/// A coefficient per node and amount of air, as arithmetic likes it.
std::vector<double> coefficientsOf(std::span<const SpectralNode> nodes, size_t used, std::array<double, kMostAirAmounts> AirNode::*coefficient) {
  std::vector<double> all;
  for (size_t k = 0; k < used; ++k)
    for (const SpectralNode& n : nodes) all.push_back((n.air.*coefficient)[k]);
  return all;
}

Eigen::Map<Eigen::ArrayXd> arrayOf(std::vector<double>& v) { return {v.data(), static_cast<Eigen::Index>(v.size())}; }

/// Per node, sum over amounts of coefficient x amount.
void weigh(std::span<const double> coefficient, const AirAmounts& amounts, std::vector<double>& into) {
  const auto nodes = static_cast<Eigen::Index>(into.size()), used = nodes > 0 ? static_cast<Eigen::Index>(coefficient.size()) / nodes : 0;
  arrayOf(into).matrix().noalias() =
      Eigen::Map<const Eigen::MatrixXd>(coefficient.data(), nodes, used) * Eigen::Map<const Eigen::VectorXd>(amounts.amount.data(), used);
}

}  // namespace

NodeSpectra::NodeSpectra(const Simulation& simulation, std::span<const SpectralNode> nodes, int surroundings, const NodeSpectra* parts)
    : simulation_(simulation), nodes_(nodes) {
  if (simulation.surroundings)
    surroundings_ = std::make_shared<const NodeSurroundings>(simulation, nodes, surroundings, parts ? parts->surroundings_.get() : nullptr);
  const size_t used = simulation.air ? simulation.air->exponents().size() : 0;
  extinction_ = coefficientsOf(nodes, used, &AirNode::extinction);
  molecules_ = coefficientsOf(nodes, used, &AirNode::molecules);
  haze_ = coefficientsOf(nodes, used, &AirNode::haze);
  if (!simulation.fields.empty() && !(parts && ofGas_.average(nodes, parts->ofGas_, parts->nodes_))) ofGas_.make(nodes, kWarmest_K, kHottest_K, kGasStep_K);
  if (!simulation.fields.empty() || (simulation.air && simulation.air->traits().variesAlongWay))
    if (!(parts && ofAir_.average(nodes, parts->ofAir_, parts->nodes_))) ofAir_.make(nodes, kColdest_K, kWarmest_K, kAirStep_K);
  for (const FieldBody& field : simulation.fields)
    for (const FieldGas& gas : field.gases)
      for (const FieldGas::Level& level : gas.levels) {
        const Medium& m = *simulation.materials[static_cast<size_t>(level.material)]->medium;
        if (!m.albedo && !m.radiance) continue;
        MediumRows& rows = mediumRows_[level.material];
        if (!rows.thermal.empty()) continue;
        for (const SpectralNode& n : nodes) {
          rows.thermal.push_back(n.mean([&](double w) { return 1.0 - m.albedoAt(w); }));
          rows.radiance.push_back(m.radiance ? n.mean(*m.radiance) : 0.0);
          rows.around.push_back(m.albedo && simulation.ambient ? n.mean([&](double w) { return m.albedoAt(w) * (*simulation.ambient)(w); }) : 0.0);
          rows.sunlight.push_back(m.albedo && simulation.sun ? n.mean([&](double w) { return m.albedoAt(w) * simulation.sun->irradiance(w); }) : 0.0);
          rows.asymmetry.push_back(m.asymmetry ? n.mean(*m.asymmetry) : 0.0);
        }
      }
}

void NodeSpectra::Planck::make(std::span<const SpectralNode> nodes, double first, double last, double step) {
  first_K = first, step_K = step;
  const int count = static_cast<int>(std::lround((last - first) / step));
  const NodePlanck planck(nodes);
  const std::size_t each = nodes.size();
  value.resize(static_cast<std::size_t>(count + 1) * each), slope.resize(value.size());
  for (int k = 0; k <= count; ++k) {
    const std::size_t begin = static_cast<std::size_t>(k) * each;
    planck.at(first + step * k, std::span(value).subspan(begin, each), std::span(slope).subspan(begin, each));
  }
  for (double& s : slope) s *= step;
}

bool NodeSpectra::Planck::average(std::span<const SpectralNode> nodes, const Planck& parts, std::span<const SpectralNode> partNodes) {
  if (partNodes.empty()) return false;
  std::map<double, std::size_t> at_um;
  for (std::size_t i = 0; i < partNodes.size(); ++i)
    if (const auto& members = partNodes[i].members; members.size() == 1) at_um[members.front().wavelength_um] = i;
  std::vector<std::vector<std::pair<std::size_t, double>>> of(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const auto& m : nodes[i].members) {
      const auto found = at_um.find(m.wavelength_um);
      if (found == at_um.end()) return false;
      of[i].emplace_back(found->second, m.share);
    }
  first_K = parts.first_K, step_K = parts.step_K;
  const std::size_t count = parts.value.size() / partNodes.size();
  for (const auto& [from, into] : {std::pair{&parts.value, &value}, {&parts.slope, &slope}})
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        double sum = 0.0;
        for (const auto& [part, share] : of[i]) sum += share * (*from)[k * partNodes.size() + part];
        into->push_back(sum);
      }
  return true;
}

bool NodeSpectra::Planck::at(double temperature_K, std::span<double> into) const {
  const size_t n = into.size(), count = n > 0 ? value.size() / n : 0;
  const double t = (temperature_K - first_K) / step_K;
  if (count == 0 || !(t >= 0.0 && t <= static_cast<double>(count - 1))) return false;
  const auto low = std::min(static_cast<size_t>(t), count - 2);
  const double u = t - static_cast<double>(low), v = 1.0 - u;
  const double p0 = v * v * (1.0 + 2.0 * u), p1 = u * u * (1.0 + 2.0 * v), s0 = u * v * v, s1 = -u * u * v;
  for (size_t i = 0, k = low * n; i < n; ++i, ++k) into[i] = p0 * value[k] + p1 * value[k + n] + s0 * slope[k] + s1 * slope[k + n];
  return true;
}

void NodeSpectra::planck(double temperature_K, std::span<double> into) const {
  if (ofAir_.at(temperature_K, into) || ofGas_.at(temperature_K, into)) return;
  for (size_t i = 0; i < nodes_.size(); ++i) into[i] = nodes_[i].planck(temperature_K);
}

std::vector<double> NodeSpectra::of(const Factor& factor) const {
  if (factor.kind == Factor::Kind::Reflected) return surroundings_->reflected(*static_cast<const ReflectionComponent*>(factor.of), *factor.seen);
  std::vector<double> all;
  all.reserve(nodes_.size());
  for (const SpectralNode& n : nodes_) all.push_back(n.mean([&](double w) { return valueOf(simulation_, factor, w); }));
  return all;
}

NodeSum::NodeSum(const NodeSpectra& spectra) : spectra_(spectra), count_(spectra.nodes().size()) {
  for (At* at : {&near_, &far_})
    for (auto* v : {&at->depth, &at->passed, &at->black, &at->sunDepth, &at->sunPassed}) v->assign(count_, 0.0);
  for (auto* v : {&turned_, &turnedByHaze_}) v->assign(count_, 0.0);
}

void NodeSum::begin() {
  radiance_.assign(count_, 0.0);
  if (watchesOne()) ofEntity_.assign(count_, 0.0);
  if (keepsParts_) {
    for (auto& p : parts_) p.assign(count_, 0.0);
    ofLamp_.assign(spectra_.simulation().lights.size(), std::vector<double>(count_, 0.0));
  }
  restart();
}

void NodeSum::restart() {
  panes_.assign(count_, 1.0);
  mediaDepth_.assign(count_, 0.0);
  std::fill(near_.depth.begin(), near_.depth.end(), 0.0);
  std::fill(near_.passed.begin(), near_.passed.end(), 1.0);
  here_ = sunKnownAt_ = nullptr;
}

const std::vector<double>& NodeSum::values(const Factor& factor) {
  if (!factor.lasting) return scratch_ = spectra_.of(factor);
  const auto [at, isNew] = kept_.try_emplace(factor);
  if (isNew) at->second = spectra_.of(factor);
  return at->second;
}

void NodeSum::term(const Term& term) {
  const bool taken = takes(term.part()), watched = watched_ >= 0 && term.entity == watched_;
  if (!taken && !watched) return;
  std::vector<double> product(count_, term.coefficient);
  for (const Factor& f : term.factors) {
    const std::vector<double>& v = values(f);
    for (size_t i = 0; i < count_; ++i) product[i] *= v[i];
  }
  for (size_t i = 0; i < count_; ++i) {
    if (product[i] == 0.0) continue;
    const double air = term.air ? std::exp(-Atmosphere::depthOf(spectra_.nodes()[i].air, *term.air)) : near_.passed[i];
    const double sent = product[i] * panes_[i] * air * (mediaDepth_[i] > 0.0 ? std::exp(-mediaDepth_[i]) : 1.0);
    if (taken) send(term.kind, i, sent);
    if (watched) ofEntity_[i] += sent;
    if (keepsParts_ && taken && term.kind == TermKind::Lights) ofLamp_[static_cast<size_t>(term.light)][i] += sent;
  }
}

void NodeSum::pane(const Factor& transmittance, double modifier) {
  const std::vector<double>& v = values(transmittance);
  for (size_t i = 0; i < count_; ++i) panes_[i] *= modifier * v[i];
}

/// `both`: amounts with the way on to the sun, or null where nobody asks.
void NodeSum::place(const AirPlace& at, const AirAmounts* both, At& out) {
  weigh(spectra_.extinction(), at.powered, out.depth);
  arrayOf(out.passed) = (-arrayOf(out.depth)).exp();
  if (both) {
    weigh(spectra_.extinction(), *both, out.sunDepth);
    arrayOf(out.sunPassed) = (-arrayOf(out.sunDepth)).exp();
  }
  if (at.temperature_K > 0.0) spectra_.planck(at.temperature_K, out.black);
  else std::fill(out.black.begin(), out.black.end(), 0.0);
}

const std::vector<double>& NodeSum::hazePhase(double cosScatter) {
  if (cosScatter == hazePhaseOf_) return hazePhase_;
  hazePhaseOf_ = cosScatter;
  hazePhase_.clear();
  for (const SpectralNode& n : spectra_.nodes()) hazePhase_.push_back(henyeyGreensteinPhase(cosScatter, n.air.asymmetry));
  return hazePhase_;
}

/// What a medium turns of sunlight, per extinction: kept for the line, whose angle is the same all along.
const std::vector<double>& NodeSum::turnedBy(const MediumInside& m, double cosScatter) {
  const NodeSpectra::MediumRows* rows = spectra_.mediumRows(m.material);
  if (!rows) return values(Factor::mediumSun(*m.medium, cosScatter));
  if (cosScatter != turnedAt_) turnedOf_.clear();
  turnedAt_ = cosScatter;
  std::vector<double>& turned = turnedOf_[m.material];
  for (size_t i = turned.size(); i < count_; ++i) turned.push_back(rows->sunlight[i] * henyeyGreensteinPhase(cosScatter, rows->asymmetry[i]));
  return turned;
}

/// What the media of a segment send per node [W/(m2 sr um)]: their own, and sunlight scattered once, through air and through what lies before the sun.
std::vector<std::vector<double>> NodeSum::sourcesOf(const Segment& s) {
  std::vector<std::vector<double>> all;
  if (s.dark) return std::vector<std::vector<double>>(s.media.size(), std::vector<double>(count_, 0.0));
  std::vector<double> black, sunAir;  // of one temperature: the gases of a field share it
  double blackOf_K = -1.0;
  const auto nodes = spectra_.nodes();
  for (const MediumInside& m : s.media) {
    const NodeSpectra::MediumRows* rows = spectra_.mediumRows(m.material);
    if (m.lasting || (!rows && (m.medium->albedo || m.medium->radiance))) {
      all.push_back(values(m.source()));
    } else {
      if (m.temperature_K != blackOf_K) {
        black.resize(count_);
        spectra_.planck(m.temperature_K, black);
        blackOf_K = m.temperature_K;
      }
      all.push_back(black);
      for (size_t i = 0; rows && i < count_; ++i) all.back()[i] = rows->thermal[i] * black[i] + m.gain * rows->radiance[i] + rows->around[i];
    }
    if (!(m.sun > 0.0)) continue;
    if (s.sunAir && sunAir.empty()) {
      std::vector<double> near(count_);
      sunAir.resize(count_);
      weigh(spectra_.extinction(), *s.sunAir, sunAir);
      weigh(spectra_.extinction(), s.near.powered, near);
      for (size_t i = 0; i < count_; ++i) sunAir[i] = std::exp(std::min(near[i] - sunAir[i], 0.0));
    }
    const std::vector<double>& turned = turnedBy(m, s.cosScatter);
    for (size_t i = 0; i < count_; ++i)
      all.back()[i] += m.sun * turned[i] * (s.sunAir ? sunAir[i] : 1.0) * std::exp(-m.sunAmount * nodes[i].absorption_per_m[static_cast<size_t>(m.material)]);
  }
  return all;
}

/// How much more black bodies send at a segment's far end than at its near end, of what its media send: empty where none changes. No end sends less than
/// nothing.
std::vector<std::vector<double>> NodeSum::driftsOf(const Segment& s, const std::vector<std::vector<double>>& sources) {
  if (s.dark || std::all_of(s.media.begin(), s.media.end(), [](const MediumInside& m) { return m.drift_perK == 0.0; })) return {};
  std::vector<std::vector<double>> all(s.media.size(), std::vector<double>(count_, 0.0));
  std::vector<double> far(count_), near(count_);  // of one temperature: the gases of a field share it
  const MediumInside* of = nullptr;
  for (size_t k = 0; k < s.media.size(); ++k) {
    const MediumInside& m = s.media[k];
    if (m.drift_perK == 0.0) continue;
    if (!of || of->temperature_K != m.temperature_K || of->drift_perK != m.drift_perK) {
      spectra_.planck(1.0 / (1.0 / m.temperature_K + 0.5 * m.drift_perK), far);
      spectra_.planck(1.0 / (1.0 / m.temperature_K - 0.5 * m.drift_perK), near);
      of = &m;
    }
    const NodeSpectra::MediumRows* rows = spectra_.mediumRows(m.material);
    for (size_t i = 0; i < count_; ++i) all[k][i] = std::clamp((rows ? rows->thermal[i] : 1.0) * (far[i] - near[i]), -2.0 * sources[k][i], 2.0 * sources[k][i]);
  }
  return all;
}

// J = (x S + y B) / (x + y) with S of the media and B of the air, B linear in depth from one end to the other:
//   integral of J exp(-t) dt = J_near (1 - exp(-d)) + (J_far - J_near) g(d), d = x + y.
// S is that in the middle, and changes by D to the far end in a field: S (1 - exp(-d)) + D (g(d) - (1 - exp(-d))/2).
void NodeSum::segment(const Segment& s) {
  const auto nodes = spectra_.nodes();
  // Where one end sees no sun, the other's way to it holds for the segment.
  const double sun = s.sunlit && !s.dark ? 0.5 * (s.near.sun + s.far.sun) : 0.0;
  const bool sunlit = sun > 0.0;
  if (s.air) {
    const AirAmounts &nearBoth = s.near.sun > 0.0 ? s.near.both : s.far.both, &farBoth = s.far.sun > 0.0 ? s.far.both : s.near.both;
    if (here_ != &s.near || (sunlit && sunKnownAt_ != &s.near)) place(s.near, sunlit ? &nearBoth : nullptr, near_);
    place(s.far, sunlit ? &farBoth : nullptr, far_);
  }
  const std::vector<double>* irradiance = sunlit ? &values(Factor::sun()) : nullptr;
  // Per node, what the segment turns towards the eye.
  if (sunlit) {
    AirAmounts passed;
    for (size_t k = 0; k < kMostAirAmounts; ++k) passed.amount[k] = s.far.powered.amount[k] - s.near.powered.amount[k];
    const double rayleigh = rayleighPhase(s.cosScatter);
    const std::vector<double>& phase = hazePhase(s.cosScatter);
    weigh(spectra_.molecules(), passed, turned_);
    weigh(spectra_.haze(), passed, turnedByHaze_);
    for (size_t i = 0; i < count_; ++i) turned_[i] = rayleigh * std::max(turned_[i], 0.0) + phase[i] * std::max(turnedByHaze_[i], 0.0);
  }
  const bool media = !s.media.empty() && takes({TermKind::Media}), air = s.air && takes({TermKind::AirEmission}),
             turned = sunlit && takes({TermKind::ScatteredSun});
  const auto sources = sourcesOf(s), drifts = driftsOf(s, sources);
  for (size_t i = 0; i < count_; ++i) {
    double x = 0.0, emitted = 0.0, ofWatched = 0.0, drifting = 0.0, driftingOfWatched = 0.0;
    for (size_t m = 0; m < s.media.size(); ++m) {
      const double own = nodes[i].absorption_per_m[static_cast<size_t>(s.media[m].material)] * s.media[m].length_m;
      x += own;
      emitted += own * sources[m][i];
      if (!drifts.empty()) drifting += own * drifts[m][i];
      if (watchesOne() && s.media[m].entity == watched_ && s.media[m].field == watchedField_) {
        ofWatched += own * sources[m][i];
        if (!drifts.empty()) driftingOfWatched += own * drifts[m][i];
      }
    }
    const double before = mediaDepth_[i];
    mediaDepth_[i] += x;
    if (s.dark || (s.air ? near_.depth[i] : 0.0) + before > kOpaque) continue;
    const double y = s.air ? std::max(far_.depth[i] - near_.depth[i], 0.0) : 0.0, d = x + y;
    if (!(d > 0.0)) continue;
    const double reaching = panes_[i] * (before > 0.0 ? std::exp(-before) : 1.0), seen = reaching * (s.air ? near_.passed[i] : 1.0);
    const double left = (s.air ? far_.passed[i] / near_.passed[i] : 1.0) * (x > 0.0 ? std::exp(-x) : 1.0), lost = lostOf(d, left);
    const auto sent = [&](double even, double change) { return seen / d * (even * lost + (change != 0.0 ? change * (growing(d, left, lost) - 0.5 * lost) : 0.0)); };
    if (ofWatched > 0.0) ofEntity_[i] += sent(ofWatched, driftingOfWatched);
    if (media && x > 0.0) send(TermKind::Media, i, sent(emitted, drifting));
    if (air && y > 0.0) {
      const double near = near_.black[i] + nodes[i].air.source, far = far_.black[i] + nodes[i].air.source;
      send(TermKind::AirEmission, i, seen * (y / d) * (near * lost + (far - near) * growing(d, left, lost)));
    }
    if (!turned) continue;
    const double mean = meanPassed(near_.sunDepth[i], far_.sunDepth[i] + x, near_.sunPassed[i], far_.sunPassed[i] * (x > 0.0 ? std::exp(-x) : 1.0));
    send(TermKind::ScatteredSun, i, sun * reaching * mean * (*irradiance)[i] * turned_[i]);
  }
  if (s.air) std::swap(near_, far_);
  here_ = &s.far;
  sunKnownAt_ = sunlit && s.far.sun > 0.0 ? &s.far : nullptr;
}

std::vector<double> NodeSum::transmittance() const {
  std::vector<double> all(count_);
  for (size_t i = 0; i < count_; ++i) all[i] = panes_[i] * std::exp(-mediaDepth_[i]);
  return all;
}

std::vector<double> NodeSum::reach() const {
  std::vector<double> all = transmittance();
  for (size_t i = 0; i < count_; ++i) all[i] *= near_.passed[i];
  return all;
}

}  // namespace pitviper
