#include "sim/radiance/node_sum.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Temperatures of air anywhere [K]; over the inverse a logarithm is all but straight: 256 entries are within 1e-6.
constexpr double kColdest_K = 140.0, kWarmest_K = 400.0;
constexpr int kTemperatures = 256;

/// (1 - exp(-d) (1 + d)) / d: weight of what grows linearly with depth over a stretch of depth d. The series where the difference would lose its
/// digits: d/2 - d^2/3, next term d^3/8 below 2e-10 of it.
double growing(double d, double left, double lost) { return d < 1e-3 ? d * (0.5 - d / 3.0) : (lost - d * left) / d; }

/// The absorbers that a coefficient is not zero of: most have one, few scatter.
double depthOf(const std::array<double, kMostAirAmounts>& coefficient, const AirAmounts& powered, size_t used) {
  double sum = 0.0;
  for (size_t k = 0; k < used; ++k) sum += coefficient[k] * powered.amount[k];
  return sum;
}

}  // namespace

NodeSpectra::NodeSpectra(const Simulation& simulation, std::span<const SpectralNode> nodes) : simulation_(simulation), nodes_(nodes) {
  if (!simulation.path || !simulation.path->isLayered()) return;
  if (std::all_of(nodes.begin(), nodes.end(), [](const SpectralNode& n) { return n.isWavelength(); })) return;
  for (int t = 0; t < kTemperatures; ++t) {
    const double inverse = 1.0 / kWarmest_K + (1.0 / kColdest_K - 1.0 / kWarmest_K) * t / (kTemperatures - 1);
    for (const SpectralNode& n : nodes) logPlanck_.push_back(std::log(std::max(n.planck(1.0 / inverse), 1e-300)));
  }
}

void NodeSpectra::planck(double temperature_K, std::span<double> into) const {
  const double t = (1.0 / temperature_K - 1.0 / kWarmest_K) / (1.0 / kColdest_K - 1.0 / kWarmest_K) * (kTemperatures - 1);
  if (logPlanck_.empty() || !(t >= 0.0 && t <= kTemperatures - 1)) {
    for (size_t i = 0; i < nodes_.size(); ++i)
      into[i] = nodes_[i].isWavelength() ? physics::planckRadiance(nodes_[i].members.front().wavelength_um, temperature_K) : nodes_[i].planck(temperature_K);
    return;
  }
  const auto low = std::min(static_cast<size_t>(t), static_cast<size_t>(kTemperatures - 2));
  const double f = t - static_cast<double>(low);
  const double *a = &logPlanck_[low * nodes_.size()], *b = a + nodes_.size();
  for (size_t i = 0; i < nodes_.size(); ++i) into[i] = std::exp((1.0 - f) * a[i] + f * b[i]);
}

std::vector<double> NodeSpectra::of(const Factor& factor) const {
  std::vector<double> all;
  all.reserve(nodes_.size());
  for (const SpectralNode& n : nodes_) all.push_back(n.mean([&](double w) { return valueOf(simulation_, factor, w); }));
  return all;
}

NodeSum::NodeSum(const NodeSpectra& spectra) : spectra_(spectra), count_(spectra.nodes().size()) {
  for (auto* v : {&nearDepth_, &nearBlack_, &farDepth_, &farBlack_}) v->resize(count_);
}

void NodeSum::begin() {
  radiance_.assign(count_, 0.0);
  if (keepsParts_)
    for (auto& p : parts_) p.assign(count_, 0.0);
  restart();
}

void NodeSum::restart() {
  panes_.assign(count_, 1.0);
  mediaDepth_.assign(count_, 0.0);
  std::fill(nearDepth_.begin(), nearDepth_.end(), 0.0);
  here_ = nullptr;
}

const std::vector<double>& NodeSum::values(const Factor& factor) {
  if (!factor.lasting) return scratch_ = spectra_.of(factor);
  const auto [at, isNew] = kept_.try_emplace(factor);
  if (isNew) at->second = spectra_.of(factor);
  return at->second;
}

void NodeSum::term(const Term& term) {
  std::vector<double> product(count_, term.coefficient);
  for (const Factor& f : term.factors) {
    const std::vector<double>& v = values(f);
    for (size_t i = 0; i < count_; ++i) product[i] *= v[i];
  }
  for (size_t i = 0; i < count_; ++i) {
    if (product[i] == 0.0) continue;
    const double air = term.air ? Path::depthOf(spectra_.nodes()[i].air, *term.air) : nearDepth_[i];
    send(term.kind, i, product[i] * panes_[i] * std::exp(-(air + mediaDepth_[i])));
  }
}

void NodeSum::pane(const Factor& transmittance, double modifier) {
  const std::vector<double>& v = values(transmittance);
  for (size_t i = 0; i < count_; ++i) panes_[i] *= modifier * v[i];
}

void NodeSum::place(const AirPlace& at, std::vector<double>& depth, std::vector<double>& black) {
  const size_t used = spectra_.simulation().path->exponents().size();
  for (size_t i = 0; i < count_; ++i) depth[i] = depthOf(spectra_.nodes()[i].air.extinction, at.powered, used);
  if (at.temperature_K > 0.0) spectra_.planck(at.temperature_K, black);
  else std::fill(black.begin(), black.end(), 0.0);
}

// J = (x S + y B) / (x + y) with S of the media and B of the air, B linear in depth from one end to the other:
//   integral of J exp(-t) dt = J_near (1 - exp(-d)) + (J_far - J_near) g(d), d = x + y.
void NodeSum::segment(const Segment& s) {
  if (s.air) {
    if (here_ != &s.near) place(s.near, nearDepth_, nearBlack_);
    place(s.far, farDepth_, farBlack_);
  }
  const auto nodes = spectra_.nodes();
  const size_t used = s.air ? spectra_.simulation().path->exponents().size() : 0;
  // Where one end sees no sun, the other's way to it holds for the segment.
  const double sun = s.sunlit ? 0.5 * (s.near.sun + s.far.sun) : 0.0;
  const bool sunlit = sun > 0.0;
  const AirAmounts &nearBoth = s.near.sun > 0.0 ? s.near.both : s.far.both, &farBoth = s.far.sun > 0.0 ? s.far.both : s.near.both;
  const std::vector<double>* irradiance = sunlit ? &values(Factor::sun()) : nullptr;
  const double rayleigh = sunlit ? rayleighPhase(s.cosScatter) : 0.0;
  std::vector<const std::vector<double>*> sources;
  for (const MediumInside& m : s.media) sources.push_back(&values(Factor::medium(*m.medium, m.temperature_K)));
  for (size_t i = 0; i < count_; ++i) {
    const double seen = panes_[i] * std::exp(-(s.air ? nearDepth_[i] : 0.0) - mediaDepth_[i]);
    double x = 0.0, emitted = 0.0;
    for (size_t m = 0; m < s.media.size(); ++m) {
      const double own = nodes[i].absorption_per_m[static_cast<size_t>(s.media[m].material)] * s.media[m].length_m;
      x += own;
      emitted += own * (*sources[m])[i];
    }
    const double y = s.air ? std::max(farDepth_[i] - nearDepth_[i], 0.0) : 0.0, d = x + y;
    if (d > 0.0 && seen > 0.0 && !s.dark) {
      const double left = std::exp(-d), lost = physics::oneMinusExp(d), g = growing(d, left, lost);
      if (x > 0.0) send(TermKind::Media, i, seen * emitted / d * lost);
      if (y > 0.0) {
        const double near = nearBlack_[i] + nodes[i].air.source, far = farBlack_[i] + nodes[i].air.source;
        send(TermKind::AirEmission, i, seen * (y / d) * (near * lost + (far - near) * g));
      }
      if (sunlit) {
        const double molecules = depthOf(nodes[i].air.molecules, s.far.powered, used) - depthOf(nodes[i].air.molecules, s.near.powered, used);
        const double haze = depthOf(nodes[i].air.haze, s.far.powered, used) - depthOf(nodes[i].air.haze, s.near.powered, used);
        const double from = depthOf(nodes[i].air.extinction, nearBoth, used), to = depthOf(nodes[i].air.extinction, farBoth, used) + x;
        const double change = to - from, mean = std::abs(change) < 1e-8 ? 1.0 - 0.5 * change : -std::expm1(-change) / change;
        send(TermKind::ScatteredSun, i, sun * panes_[i] * std::exp(-mediaDepth_[i] - from) * mean * (*irradiance)[i] *
                 (rayleigh * std::max(molecules, 0.0) + henyeyGreensteinPhase(s.cosScatter, nodes[i].air.asymmetry) * std::max(haze, 0.0)));
      }
    }
    mediaDepth_[i] += x;
  }
  if (s.air) {
    std::swap(nearDepth_, farDepth_);
    std::swap(nearBlack_, farBlack_);
  }
  here_ = &s.far;
}

std::vector<double> NodeSum::transmittance() const {
  std::vector<double> all(count_);
  for (size_t i = 0; i < count_; ++i) all[i] = panes_[i] * std::exp(-mediaDepth_[i]);
  return all;
}

}  // namespace pitviper
