#include "sim/radiance/node_sum.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/radiance/node_surroundings.hpp"
#include "sim/radiance/planck_table.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/exponentials.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Temperatures of air anywhere [K], and of gas that burns.
constexpr double kColdest_K = 140.0, kWarmest_K = 400.0, kAirStep_K = 1.0, kHottest_K = 3500.0, kGasStep_K = 5.0;
/// What lets less through than this sends nothing that anybody sees.
constexpr double kOpaque = 45.0;

NodeSpectra::AirRows rowsOf(
    std::span<const SpectralNode> nodes, size_t used, std::array<double, kMostAirAmounts> AirNode::*coefficient,
    const std::function<bool(size_t)>& takes = [](size_t) { return true; }) {
  NodeSpectra::AirRows rows;
  for (size_t k = 0; k < used; ++k) {
    if (!takes(k) || std::all_of(nodes.begin(), nodes.end(), [&](const SpectralNode& n) { return (n.air.*coefficient)[k] == 0.0; })) continue;
    rows.amounts.push_back(k);
    for (const SpectralNode& n : nodes) rows.coefficient.push_back((n.air.*coefficient)[k]);
  }
  return rows;
}

Eigen::Map<Eigen::ArrayXd> arrayOf(std::vector<double>& v) { return {v.data(), static_cast<Eigen::Index>(v.size())}; }

/// exp(-x) of each.
void passedOf(const std::vector<double>& x, std::vector<double>& passed) {
  passed.resize(x.size());
  std::transform(x.begin(), x.end(), passed.begin(), std::negate<>());
  exponentials(passed.data(), static_cast<int>(passed.size()));
}

/// Per node, sum over amounts of coefficient x amount.
void weigh(const NodeSpectra::AirRows& rows, const AirAmounts& amounts, std::vector<double>& into) {
  std::array<double, kMostAirAmounts> some{};
  for (size_t k = 0; k < rows.amounts.size(); ++k) some[k] = amounts.amount[rows.amounts[k]];
  const auto used = static_cast<Eigen::Index>(rows.amounts.size());
  arrayOf(into).matrix().noalias() = Eigen::Map<const Eigen::MatrixXd>(rows.coefficient.data(), static_cast<Eigen::Index>(into.size()), used) *
                                     Eigen::Map<const Eigen::VectorXd>(some.data(), used);
}

}  // namespace

NodeSpectra::NodeSpectra(const Simulation& simulation, std::span<const SpectralNode> nodes, const Terms& terms, const NodeSpectra* parts)
    : simulation_(simulation), nodes_(nodes) {
  if (simulation.surroundings)
    surroundings_ = std::make_shared<const NodeSurroundings>(simulation, nodes, terms.surroundings, parts ? parts->surroundings_.get() : nullptr);
  const size_t used = simulation.air ? simulation.air->exponents().size() : 0;
  extinction_ = rowsOf(nodes, used, &AirNode::extinction);
  molecules_ = rowsOf(nodes, used, &AirNode::molecules);
  haze_ = rowsOf(nodes, used, &AirNode::haze);
  for (const SpectralNode& n : nodes) airSource_.push_back(n.air.source);
  if (terms.air && terms.streams > 0)
    if (auto light = DiffuseLight::of(columnOf(simulation), terms.streams))
      diffuse_.emplace(std::move(light), nodes, parts ? NodeDiffuse::Nodes::Together : NodeDiffuse::Nodes::Kept);
  if (diffuse_) {
    scattered_.push_back(molecules_);
    for (const auto& kind : diffuse_->particles())
      scattered_.push_back(rowsOf(nodes, used, &AirNode::haze, [&](size_t k) { return std::find(kind.begin(), kind.end(), k) != kind.end(); }));
  }
  for (size_t m = 0; !nodes.empty() && m < nodes.front().absorption_per_m.size(); ++m)
    for (const SpectralNode& n : nodes) absorption_per_m_.push_back(n.absorption_per_m[m]);
  const auto table = [&](std::shared_ptr<const PlanckTable> NodeSpectra::*of, double first, double last, double step) {
    if (parts) this->*of = PlanckTable::averaged(nodes, parts->*of, parts->nodes_);
    if (!(this->*of)) this->*of = std::make_shared<const PlanckTable>(nodes, first, last, step);
  };
  if (!simulation.fields.empty()) table(&NodeSpectra::ofGas_, kWarmest_K, kHottest_K, kGasStep_K);
  if (!simulation.fields.empty() || (simulation.air && simulation.air->traits().variesAlongWay))
    table(&NodeSpectra::ofAir_, kColdest_K, kWarmest_K, kAirStep_K);
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
        if (field.source->droplets()) rows.drops = CloudLights(simulation, field).of(nodes);
      }
}

void NodeSpectra::planck(double temperature_K, std::span<double> into) const {
  if ((ofAir_ && ofAir_->at(temperature_K, into)) || (ofGas_ && ofGas_->at(temperature_K, into))) return;
  for (size_t i = 0; i < nodes_.size(); ++i) into[i] = nodes_[i].planck(temperature_K);
}

std::vector<double> NodeSpectra::of(const Factor& factor) const {
  if (factor.kind == Factor::Kind::Reflected) return surroundings_->reflected(*static_cast<const ReflectionComponent*>(factor.of), *factor.seen);
  std::vector<double> all;
  all.reserve(nodes_.size());
  if (factor.kind == Factor::Kind::SunShade) {
    const auto material = static_cast<size_t>(simulation_.sunShade->material);
    for (const SpectralNode& n : nodes_) all.push_back(std::exp(-factor.x * n.absorption_per_m[material]));
    return all;
  }
  for (const SpectralNode& n : nodes_) all.push_back(n.mean([&](double w) { return valueOf(simulation_, factor, w); }));
  return all;
}

NodeSum::NodeSum(const NodeSpectra& spectra) : spectra_(spectra), count_(spectra.nodes().size()), none_(count_, 0.0), all_(count_, 1.0) {
  for (At* at : {&near_, &far_})
    for (auto* v : {&at->depth, &at->passed, &at->black, &at->sunDepth, &at->sunPassed}) v->assign(count_, 0.0);
  for (auto* v : {&turned_, &turnedByHaze_, &phase_}) v->assign(count_, 0.0);
}

void NodeSum::begin() {
  radiance_.assign(count_, 0.0);
  memory_.forget();  // a line's figures are the same whichever was told before
  if (watchesOne()) ofEntity_.assign(count_, 0.0);
  isParted_ = false;
  if (keepsParts_) {
    for (auto& p : parts_) p.assign(count_, 0.0);
    ofLamp_.assign(spectra_.simulation().lights.size(), std::vector<double>(count_, 0.0));
  }
  restart();
}

void NodeSum::restart() {
  panes_.assign(count_, 1.0);
  mediaDepth_.assign(count_, 0.0);
  mediaPassed_.assign(count_, 1.0);
  if (isParted_) without_.depth = mediaDepth_, without_.passed = mediaPassed_;
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
  if (term.air) {
    termDepth_.resize(count_);
    weigh(spectra_.extinction(), *term.air, termDepth_);
    passedOf(termDepth_, termPassed_);
  }
  for (size_t i = 0; i < count_; ++i) {
    if (product[i] == 0.0) continue;
    const double reaching = product[i] * panes_[i] * (term.air ? termPassed_ : near_.passed)[i], sent = reaching * mediaPassed_[i];
    if (taken) send(term.kind, i, sent);
    if (taken && isParted_) without_.radiance[i] += reaching * without_.passed[i];
    if (watched) ofEntity_[i] += sent;
    if (keepsParts_ && taken && term.kind == TermKind::Lights) ofLamp_[static_cast<size_t>(term.light)][i] += sent;
  }
}

void NodeSum::pane(const Factor& transmittance, double modifier) {
  const std::vector<double>& v = values(transmittance);
  for (size_t i = 0; i < count_; ++i) panes_[i] *= modifier * v[i];
}

/// `both`: amounts with the way on to the sun, or null where nobody asks.
void NodeSum::place(const AirPlace& at, const Segment& of, const AirAmounts* both, At& out) {
  weigh(spectra_.extinction(), at.powered, out.depth);
  passedOf(out.depth, out.passed);
  if (both) {
    weigh(spectra_.extinction(), *both, out.sunDepth);
    passedOf(out.sunDepth, out.sunPassed);
  }
  if (at.temperature_K > 0.0) spectra_.planck(at.temperature_K, out.black);
  else std::fill(out.black.begin(), out.black.end(), 0.0);
  if (spectra_.diffuse() && !of.dark) spectra_.diffuse()->at(at.height_m, at.sine, of.cosAzimuth, {true, of.sunlit}, memory_, out.light);
}

/// What is turned into a segment of light that came there by more than one way: of thermal light, what it differs by from that of air of one temperature.
void NodeSum::turnAgain(const Segment& s) {
  AirAmounts passed;
  for (size_t k = 0; k < kMostAirAmounts; ++k) passed.amount[k] = s.far.powered.amount[k] - s.near.powered.amount[k];
  const bool sun = s.sunlit && spectra_.diffuse()->sunlit();
  const double* irradiance = sun ? values(Factor::sun()).data() : none_.data();
  againNear_.assign(count_, 0.0), againFar_.assign(count_, 0.0), scatters_.resize(count_);
  for (size_t kind = 0; kind < spectra_.scattered().size(); ++kind) {
    weigh(spectra_.scattered()[kind], passed, scatters_);
    for (size_t i = 0; i < count_; ++i) {
      const double depth = far_.depth[i] - near_.depth[i], part = depth > 0.0 ? std::max(scatters_[i], 0.0) / depth : 0.0;
      const auto source = [&](const At& at) {
        const double thermal = at.light.thermal[kind][i] - at.black[i];
        return part * (sun ? thermal + irradiance[i] * at.light.solar[kind][i] : thermal);
      };
      againNear_[i] += source(near_), againFar_[i] += source(far_);
    }
  }
}

const NodeSpectra::AirRows& NodeSum::hazeTurned(double cosScatter) {
  if (cosScatter == hazeTurnedAt_) return hazeTurned_;
  hazeTurnedAt_ = cosScatter;
  hazeTurned_ = spectra_.haze();
  for (size_t k = 0; k < hazeTurned_.amounts.size(); ++k)
    for (size_t i = 0; i < count_; ++i) {
      // Mostly all particles of a node are of one asymmetry.
      const AirNode& n = spectra_.nodes()[i].air;
      const double g = n.asymmetry[hazeTurned_.amounts[k]], before = k > 0 ? n.asymmetry[hazeTurned_.amounts[k - 1]] : 2.0;
      phase_[i] = g == before ? phase_[i] : physics::henyeyGreensteinPhase(cosScatter, g);
      hazeTurned_.coefficient[k * count_ + i] *= phase_[i];
    }
  return hazeTurned_;
}

/// What a medium turns of sunlight, per extinction: kept for the line, whose angle is the same all along.
const std::vector<double>& NodeSum::turnedBy(const MediumInside& m, double cosScatter) {
  const NodeSpectra::MediumRows* rows = spectra_.mediumRows(m.material);
  if (!rows) return values(Factor::mediumSun(*m.medium, cosScatter));
  if (cosScatter != turnedAt_) turnedOf_.clear();
  turnedAt_ = cosScatter;
  std::vector<double>& turned = turnedOf_[m.material];
  for (size_t i = turned.size(); i < count_; ++i) turned.push_back(rows->sunlight[i] * physics::henyeyGreensteinPhase(cosScatter, rows->asymmetry[i]));
  return turned;
}

/// What the media of a segment send per node [W/(m2 sr um)]: their own, and sunlight scattered once, through air and through what lies before the sun.
void NodeSum::tellSources(const Segment& s) {
  if (sources_.size() < s.media.size()) sources_.resize(s.media.size());
  double blackOf_K = -1.0;  // the gases of a field share a temperature, and the way to the sun
  bool sunAirKnown = false;
  for (size_t k = 0; k < s.media.size(); ++k) {
    const MediumInside& m = s.media[k];
    std::vector<double>& own = sources_[k];
    if (s.dark) {
      own.assign(count_, 0.0);
      continue;
    }
    const NodeSpectra::MediumRows* rows = spectra_.mediumRows(m.material);
    const bool drops = m.cloud && rows && !rows->drops.empty();
    if (m.lasting || (!rows && (m.medium->albedo || m.medium->radiance))) {
      own = values(m.source());
    } else {
      if (m.temperature_K != blackOf_K) {
        black_.resize(count_);
        spectra_.planck(m.temperature_K, black_);
        blackOf_K = m.temperature_K;
      }
      own = black_;
      for (size_t i = 0; rows && !drops && i < count_; ++i) own[i] = rows->thermal[i] * black_[i] + m.gain * rows->radiance[i] + rows->around[i];
    }
    if (m.sun > 0.0 && s.sunAir && !sunAirKnown) {
      shade_.resize(count_);
      sunAir_.resize(count_);
      weigh(spectra_.extinction(), *s.sunAir, sunAir_);
      weigh(spectra_.extinction(), s.near.powered, shade_);
      for (size_t i = 0; i < count_; ++i) shade_[i] = std::max(sunAir_[i] - shade_[i], 0.0);
      passedOf(shade_, sunAir_);
      sunAirKnown = true;
    }
    if (drops) {
      for (size_t i = 0; i < count_; ++i) {
        const CloudLight& light = rows->drops[i];
        const auto sent = physics::cloudSource(*m.cloud, light.optics, light.above, light.below, black_[i], s.cosScatter);
        own[i] = sent.y + (m.sun > 0.0 ? m.sun * light.sun * sent.x * (s.sunAir ? sunAir_[i] : 1.0) : 0.0);
      }
      continue;
    }
    if (!(m.sun > 0.0)) continue;
    const std::vector<double>& turned = turnedBy(m, s.cosScatter);
    shade_.resize(count_);
    const double* perLength = spectra_.absorption_per_m(m.material).data();
    for (size_t i = 0; i < count_; ++i) shade_[i] = -m.sunAmount * perLength[i];
    exponentials(shade_.data(), static_cast<int>(count_));
    for (size_t i = 0; i < count_; ++i) own[i] += m.sun * turned[i] * (s.sunAir ? sunAir_[i] : 1.0) * shade_[i];
  }
}

/// How much more black bodies send at a segment's far end than at its near end, of what its media send; whether any changes. No end sends less than nothing.
bool NodeSum::tellDrifts(const Segment& s) {
  if (s.dark || std::all_of(s.media.begin(), s.media.end(), [](const MediumInside& m) { return m.drift_perK == 0.0; })) return false;
  if (drifts_.size() < s.media.size()) drifts_.resize(s.media.size());
  const MediumInside* of = nullptr;  // whose temperatures are told: the gases of a field share them
  for (size_t k = 0; k < s.media.size(); ++k) {
    const MediumInside& m = s.media[k];
    drifts_[k].assign(count_, 0.0);
    if (m.drift_perK == 0.0) continue;
    if (!of || of->temperature_K != m.temperature_K || of->drift_perK != m.drift_perK) {
      black_.resize(count_);
      change_.resize(count_);
      spectra_.planck(1.0 / (1.0 / m.temperature_K + 0.5 * m.drift_perK), change_);
      spectra_.planck(1.0 / (1.0 / m.temperature_K - 0.5 * m.drift_perK), black_);
      for (size_t i = 0; i < count_; ++i) change_[i] -= black_[i];
      of = &m;
    }
    const NodeSpectra::MediumRows* rows = spectra_.mediumRows(m.material);
    const std::vector<double>& sent = sources_[k];
    for (size_t i = 0; i < count_; ++i) drifts_[k][i] = std::clamp((rows ? rows->thermal[i] : 1.0) * change_[i], -2.0 * sent[i], 2.0 * sent[i]);
  }
  return true;
}

/// What a segment's media take and send, per node.
void NodeSum::gather(const Segment& s) {
  tellSources(s);
  const bool drifts = tellDrifts(s);
  for (auto* v : {&own_.depth, &own_.emitted, &own_.drifting, &own_.watched, &own_.driftingOfWatched, &own_.otherDepth}) v->assign(count_, 0.0);
  bool isOfField = false;
  const auto add = [&](const std::vector<double>& depth, const std::vector<double>& sent, std::vector<double>& into) {
    for (size_t i = 0; i < count_; ++i) into[i] += depth[i] * sent[i];
  };
  each_.resize(count_);  // depth of one medium
  for (size_t m = 0; m < s.media.size(); ++m) {
    const MediumInside& of = s.media[m];
    const double* perLength = spectra_.absorption_per_m(of.material).data();
    for (size_t i = 0; i < count_; ++i) own_.depth[i] += each_[i] = perLength[i] * of.length_m;
    add(each_, sources_[m], own_.emitted);
    if (drifts) add(each_, drifts_[m], own_.drifting);
    if (!watchesOne() || of.entity != watched_ || of.field != watchedField_) continue;
    isOfField |= watchedField_ >= 0;
    for (size_t i = 0; i < count_; ++i) own_.otherDepth[i] -= each_[i];
    add(each_, sources_[m], own_.watched);
    if (drifts) add(each_, drifts_[m], own_.driftingOfWatched);
  }
  passedOf(own_.depth, own_.passed);
  if (isOfField && !isParted_) without_ = {radiance_, mediaDepth_, mediaPassed_}, isParted_ = true;
  if (!isParted_) return;
  for (size_t i = 0; i < count_; ++i) own_.otherDepth[i] = std::max(own_.otherDepth[i] + own_.depth[i], 0.0);
  passedOf(own_.otherDepth, own_.otherPassed);
}

// The law of a segment (segment.glsl) with J = (x S + y B) / (x + y): S of the media, of depth x, told in the middle with what it changes by in a field; B of
// the air, of depth y, told at both ends.
void NodeSum::segment(const Segment& s) {
  // Where one end sees no sun, the other's way to it holds for the segment.
  const double sun = s.sunlit && !s.dark ? 0.5 * (s.near.sun + s.far.sun) : 0.0;
  const bool sunlit = sun > 0.0;
  if (s.air) {
    const AirAmounts &nearBoth = s.near.sun > 0.0 ? s.near.both : s.far.both, &farBoth = s.far.sun > 0.0 ? s.far.both : s.near.both;
    if (here_ != &s.near || (sunlit && sunKnownAt_ != &s.near)) place(s.near, s, sunlit ? &nearBoth : nullptr, near_);
    place(s.far, s, sunlit ? &farBoth : nullptr, far_);
  }
  const std::vector<double>* irradiance = sunlit ? &values(Factor::sun()) : nullptr;
  // Per node, what the segment turns towards the eye.
  if (sunlit) {
    AirAmounts passed;
    for (size_t k = 0; k < kMostAirAmounts; ++k) passed.amount[k] = s.far.powered.amount[k] - s.near.powered.amount[k];
    const double rayleigh = physics::rayleighPhase(s.cosScatter);
    weigh(spectra_.molecules(), passed, turned_);
    weigh(hazeTurned(s.cosScatter), passed, turnedByHaze_);
    for (size_t i = 0; i < count_; ++i) turned_[i] = rayleigh * std::max(turned_[i], 0.0) + std::max(turnedByHaze_[i], 0.0);
  }
  const bool inMedia = !s.media.empty(), media = inMedia && takes({TermKind::Media}), air = s.air && takes({TermKind::AirEmission}),
             turned = sunlit && takes({TermKind::ScatteredSun}), again = s.air && !s.dark && spectra_.diffuse() && takes({TermKind::ScatteredAgain});
  if (again) turnAgain(s);
  if (inMedia) gather(s);
  const double *none = none_.data(), *all = all_.data();
  SegmentAt at{none, none, all, all, none, all, mediaDepth_.data(), mediaPassed_.data(), panes_.data(), kOpaque};
  if (s.air) at.nearDepth = near_.depth.data(), at.farDepth = far_.depth.data(), at.nearPassed = near_.passed.data(), at.farPassed = far_.passed.data();
  if (inMedia) at.depth = own_.depth.data(), at.passed = own_.passed.data();
  const auto tell = [&](const std::vector<double>& emitted, const std::vector<double>& drifting, const auto& into) {
    law_.set(at, count_);
    if (media) into(TermKind::Media, [&](double* sum) { law_.addMedia(emitted.data(), drifting.data(), sum); });
    if (air) into(TermKind::AirEmission, [&](double* sum) { law_.addAir(near_.black.data(), far_.black.data(), spectra_.airSource().data(), sum); });
    if (again) into(TermKind::ScatteredAgain, [&](double* sum) { law_.addAir(againNear_.data(), againFar_.data(), none_.data(), sum); });
    if (turned)
      into(TermKind::ScatteredSun, [&](double* sum) {
        law_.addSun(sun, {near_.sunDepth.data(), far_.sunDepth.data(), near_.sunPassed.data(), far_.sunPassed.data(), irradiance->data(), turned_.data()}, sum);
      });
  };
  const auto pass = [&](std::vector<double>& depth, std::vector<double>& passed) {
    for (size_t i = 0; inMedia && i < count_; ++i) depth[i] += at.depth[i], passed[i] *= at.passed[i];
  };
  if (!s.dark) {
    tell(own_.emitted, own_.drifting, [&](TermKind kind, const auto& add) {
      add(radiance_.data());
      if (keepsParts_) add(parts_[static_cast<size_t>(kind)].data());
    });
    if (inMedia && watchesOne()) law_.addMedia(own_.watched.data(), own_.driftingOfWatched.data(), ofEntity_.data());
  }
  pass(mediaDepth_, mediaPassed_);
  if (isParted_) {
    if (inMedia) at.depth = own_.otherDepth.data(), at.passed = own_.otherPassed.data();
    at.before = without_.depth.data(), at.beforePassed = without_.passed.data();
    each_.resize(count_), change_.resize(count_);
    for (size_t i = 0; inMedia && i < count_; ++i) each_[i] = own_.emitted[i] - own_.watched[i], change_[i] = own_.drifting[i] - own_.driftingOfWatched[i];
    if (!s.dark) tell(each_, change_, [&](TermKind, const auto& add) { add(without_.radiance.data()); });
    pass(without_.depth, without_.passed);
  }
  if (s.air) std::swap(near_, far_);
  here_ = &s.far;
  sunKnownAt_ = sunlit && s.far.sun > 0.0 ? &s.far : nullptr;
}

std::vector<double> NodeSum::transmittance() const {
  std::vector<double> all(count_);
  for (size_t i = 0; i < count_; ++i) all[i] = panes_[i] * mediaPassed_[i];
  return all;
}

std::vector<double> NodeSum::reach() const {
  std::vector<double> all = transmittance();
  for (size_t i = 0; i < count_; ++i) all[i] *= near_.passed[i];
  return all;
}

}  // namespace pitviper
