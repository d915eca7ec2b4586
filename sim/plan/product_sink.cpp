#include "sim/plan/product_sink.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/model/harmonic_response.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Temperatures of the air and of textures are rounded to these steps; to the finer ones where a channel sees less than kShort_um, as a step there changes the
/// shape of spectra.
constexpr double kStep_K = 4.0, kFineStep_K = 1.0, kShort_um = 3.0;
/// Optical depths of clouds before the sun are rounded to these steps.
constexpr double kShadeStep = 0.5;
constexpr double kAngleStep_rad = kPi / 36.0, kCosineStep = 0.1;
/// Temperatures of hot gases are rounded to steps of this ratio: what is fitted to one holds for its neighbours.
constexpr double kHotStep = 0.02;
/// Parts of a way through air that light scattered again is told of, and what of a part is not worth telling.
constexpr double kAgainParts = 8.0, kLittle = 1e-3;
/// Behind so much nothing is seen.
constexpr double kOpaque = 100.0;
/// Directions of light from all around are rounded: steps in half a turn.
constexpr double kElevationSteps = 12.0, kAzimuthSteps = 4.0;

/// A factor with its angles rounded to their steps.
Factor stepped(Factor f) {
  if (f.kind == Factor::Kind::SunShade) f.x = kShadeStep * std::round(f.x / kShadeStep);
  else if (f.kind != Factor::Kind::Planck && f.kind != Factor::Kind::Emission && f.kind != Factor::Kind::Medium)
    f.x = kAngleStep_rad * std::round(f.x / kAngleStep_rad), f.y = kAngleStep_rad * std::round(f.y / kAngleStep_rad);
  return f;
}

/// Terms of the same spectra on the same path as one.
std::vector<ProductTerm> merged(std::vector<ProductTerm> terms) {
  std::map<std::tuple<std::array<int, kMostFactors>, int, int, int>, size_t> placeOf;
  std::vector<ProductTerm> out;
  for (const ProductTerm& t : terms) {
    const auto [at, isNew] = placeOf.try_emplace({t.spectrum, t.count, t.path, t.tag}, out.size());
    if (isNew) out.push_back(t);
    else out[at->second].coefficient += t.coefficient;
  }
  std::erase_if(out, [](const ProductTerm& t) { return t.coefficient == 0.0; });
  return out;
}

}  // namespace

ProductSink::ProductSink(const Simulation& simulation, SightBook& book, double shortest_um, std::shared_ptr<DiffuseOnGrids> diffuse)
    : sim_(simulation), book_(book), diffuse_(std::move(diffuse)), step_K_(shortest_um < kShort_um ? kFineStep_K : kStep_K) {
  if (!sim_.air || !sim_.air->traits().any) return;
  scattered_ = sim_.air->node(std::clamp(1.0, sim_.air->validLow_um(), sim_.air->validHigh_um()));
  for (size_t k = 0; k < kMostAirAmounts; ++k)
    if (scattered_.molecules[k] + scattered_.haze[k] > 0.0) scatterers_.push_back(k);
}

void ProductSink::begin(bool fromFilm) {
  restart();
  sight_ = {};
  sight_.fromFilm = fromFilm;
}

void ProductSink::restart() {
  tellAgain();
  here_ = {};
  media_m_.clear();
  inside_m_.clear();
  panes_.clear();
  herePath_ = sunPath_ = -1;
}

Sight ProductSink::finish() {
  tellAgain();
  sight_.terms = merged(std::move(sight_.terms));
  return std::move(sight_);
}

/// Writes down a path: an amount of air, the media so far, a part of those of the segment being told, and more of one medium.
int ProductSink::pathOf(const AirAmounts& powered, double ownPart, std::pair<int, double> more) {
  SightPath path{powered, media_m_};
  if (more.second > 0.0) {
    path.media_m.resize(sim_.materials.size(), 0.0);
    path.media_m[static_cast<size_t>(more.first)] += more.second;
  }
  if (!inside_m_.empty() && ownPart > 0.0) {
    path.media_m.resize(inside_m_.size(), 0.0);
    for (size_t m = 0; m < inside_m_.size(); ++m) path.media_m[m] += ownPart * inside_m_[m];
  }
  book_.paths.push_back(std::move(path));
  return static_cast<int>(book_.paths.size()) - 1;
}

/// Writes down a term as it is seen through all panes so far.
void ProductSink::add(ProductTerm term) {
  for (const Pane& p : panes_) {
    term.coefficient *= p.modifier;
    // One place is left for the ratio of kernels (Sights::problem).
    if (term.count + 1 < kMostFactors) term.spectrum[static_cast<size_t>(term.count++)] = p.transmittance;
    else term.spectrum[kMostFactors - 2] = book_.both(term.spectrum[kMostFactors - 2], p.transmittance);
  }
  if (term.coefficient != 0.0) sight_.terms.push_back(term);
}

/// Writes down a term times further factors, where the black body of a texture is a mixture of those at two steps.
void ProductSink::addFactor(const ProductTerm& term, std::span<const Factor> rest) {
  if (rest.empty()) {
    add(term);
    return;
  }
  const auto with = [&](const Factor& f, double part) {
    ProductTerm t = term;
    t.coefficient *= part;
    t.spectrum[static_cast<size_t>(t.count++)] = book_.spectrum(f, sim_);
    if (part > 0.0) addFactor(t, rest.subspan(1));
  };
  const Factor& f = rest.front();
  if (f.kind != Factor::Kind::Planck || f.lasting) {
    with(stepped(f), 1.0);
    return;
  }
  const double at = f.x / step_K_, low = std::floor(at);
  if (low > 0.0) with(Factor::planck(step_K_ * low, true), 1.0 - (at - low));
  with(Factor::planck(step_K_ * (low + 1.0), true), at - low);
}

/// What a component reflects of the light from all around, as two spectra: that light from about the normal, or of a lobe from the mirrored direction, and the
/// reflectance for light from all sides. Fits ask for its spectrum alone.
static std::array<Factor, 2> evenly(const Simulation& sim, const Factor& f) {
  const auto& component = *static_cast<const ReflectionComponent*>(f.of);
  const SurfaceView& v = *f.seen;
  const double cosine = std::clamp(glm::dot(v.normal, v.toViewer), 0.0, 1.0);
  const glm::dvec3 to = HarmonicResponse::isPlain(component) ? v.normal : 2.0 * cosine * v.normal - v.toViewer;
  const auto step = [](double angle, double steps) { return kPi / steps * std::round(angle * steps / kPi); };
  const auto place = sim.surroundings->placeAt(v.height_m);
  return {Factor::around(step(std::asin(std::clamp(to.z, -1.0, 1.0)), kElevationSteps), step(std::atan2(to.y, to.x), kAzimuthSteps),
                         place.height + (place.share > 0.5 ? 1 : 0)),
          stepped(Factor::hemispherical(component, std::acos(cosine)))};
}

void ProductSink::term(const Term& t) {
  ProductTerm term;
  term.tag = static_cast<int>(t.kind);
  term.count = 0;
  term.coefficient = t.coefficient;
  if (!t.air && herePath_ < 0) herePath_ = pathOf(here_, 0.0);
  term.path = t.air ? pathOf(*t.air, 0.0) : herePath_;
  if (t.factors.size() == 1 && t.factors.front().kind == Factor::Kind::Reflected) addFactor(term, evenly(sim_, t.factors.front()));
  else addFactor(term, t.factors);
}

void ProductSink::pane(const Factor& transmittance, double modifier) {
  tellAgain();
  panes_.push_back({book_.spectrum(stepped(transmittance), sim_), modifier});
}

void ProductSink::segment(const Segment& s) {
  inside_m_.clear();
  if (!s.media.empty()) inside_m_.assign(sim_.materials.size(), 0.0);
  for (const MediumInside& m : s.media) inside_m_[static_cast<size_t>(m.material)] += m.length_m;
  if (!s.dark) {
    emission(s);
    if (s.sunlit && s.near.sun + s.far.sun > 0.0) scattered(s);
    if (s.air && diffuse_) scatteredAgain(s);
  }
  if (!inside_m_.empty()) {
    media_m_.resize(inside_m_.size(), 0.0);
    for (size_t m = 0; m < inside_m_.size(); ++m) media_m_[m] += inside_m_[m];
    inside_m_.clear();
  }
  here_ = s.far.powered;
  if (s.dark || !s.air || !s.media.empty()) herePath_ = -1;
  if (s.dark || !(s.far.sun > 0.0) || !s.media.empty()) sunPath_ = -1;
}

void ProductSink::emission(const Segment& s) {
  auto both = [&](int spectrum, int near, int far, TermKind kind) {
    for (const auto& [path, sign] : {std::pair{near, 1.0}, {far, -1.0}}) {
      ProductTerm t;
      t.tag = static_cast<int>(kind);
      t.spectrum[0] = spectrum, t.path = path, t.coefficient = sign;
      add(t);
    }
  };
  if (s.air && s.far.range_m > s.near.range_m) {
    const int near = herePath_ >= 0 && s.media.empty() ? herePath_ : pathOf(s.near.powered, 0.5), far = pathOf(s.far.powered, 0.5);
    herePath_ = far;
    const double temperature_K = 0.5 * (s.near.temperature_K + s.far.temperature_K);
    if (temperature_K > 0.0) {
      const double nearest_K = step_K_ * std::max(std::round(temperature_K / step_K_), 1.0);
      both(book_.spectrum(Factor::planck(nearest_K, true), sim_), near, far, TermKind::AirEmission);
    }
    both(book_.spectrum("air's own", [](const FineGrid& g, size_t i) { return g.air[i].source; }), near, far, TermKind::AirEmission);
  }
  if (s.media.empty()) return;
  emissionOfMedia(s);
}

/// About how much a unit of a medium absorbs: the mean over the knots of its spectrum.
double ProductSink::strengthOf(int material) {
  const auto [at, isNew] = strength_.try_emplace(material, 0.0);
  if (!isNew) return at->second;
  const Spectrum& absorption = sim_.materials[static_cast<size_t>(material)]->medium->absorption_per_m;
  const std::vector<double> knots = absorption.knots();
  double sum = 0.0;
  for (double w : knots) sum += absorption(w);
  const double middle = 0.5 * (std::max(absorption.validLow(), 1.0) + std::min(absorption.validHigh(), 14.0));
  return at->second = knots.empty() ? absorption(std::clamp(middle, absorption.validLow(), absorption.validHigh())) : sum / static_cast<double>(knots.size());
}

/// What drops send per scaled depth: of an irradiance of the sun, and the rest. Of each part of a line it is a spectrum of its own.
std::array<int, 2> ProductSink::drops(const MediumInside& m, double cosine) {
  auto& lights = book_.drops[m.field];
  if (!lights) lights = std::make_shared<const CloudLights>(sim_, sim_.fields[static_cast<size_t>(m.field)]);
  const std::string name = "drops " + std::to_string(book_.spectra.size()) + " ";
  const auto sent = [l = lights, step = *m.cloud, cosine, temperature_K = m.temperature_K](double w, bool sun) {
    const CloudLight light = l->at(w, !sun);
    const double black = sun ? 0.0 : physics::planckRadiance(w, temperature_K);
    const auto both = physics::cloudSource(step, light.optics, light.above, light.below, black, cosine);
    return sun ? light.sun * both.x : both.y;
  };
  return {book_.spectrum(name + "sun", [sent](const FineGrid& g, size_t i) { return sent(g.wavelength_um[i], true); }),
          book_.spectrum(name + "rest", [sent, l = lights](const FineGrid& g, size_t i) {
            if (i == 0) l->prepare(g.wavelength_um);
            return sent(g.wavelength_um[i], false);
          })};
}

void ProductSink::emissionOfMedia(const Segment& s) {
  AirAmounts middle;
  for (size_t k = 0; k < kMostAirAmounts; ++k) middle.amount[k] = 0.5 * (s.near.powered.amount[k] + s.far.powered.amount[k]);
  double total = 0.0;
  for (const MediumInside& m : s.media) total += strengthOf(m.material) * m.length_m;
  if (!(total > 0.0)) return;
  // Of several media in each other each sends a share by its strength, which is near enough for a fit.
  const auto addSource = [&](int spectrum, double share, int near, int far) {
    for (const auto& [path, sign] : {std::pair{near, 1.0}, {far, -1.0}}) {
      ProductTerm t;
      t.tag = static_cast<int>(TermKind::Media);
      t.spectrum[0] = spectrum, t.path = path, t.coefficient = sign * share;
      if (share > 0.0) add(t);
    }
  };
  const int near = pathOf(middle, 0.0), far = pathOf(middle, 1.0);
  std::map<double, double> black;  // share of what is a black body of a temperature: gases of a field
  for (const MediumInside& m : s.media) {
    const double share = strengthOf(m.material) * m.length_m / total;
    if (m.lasting) {
      addSource(book_.spectrum(m.source(), sim_), share, near, far);
      continue;
    }
    if (!m.medium->albedo && !m.medium->radiance) {
      black[m.temperature_K] += share;
      continue;
    }
    const double stepped_K = step_K_ * std::max(std::round(m.temperature_K / step_K_), 1.0);
    if (m.cloud) {
      const auto [sun, rest] = drops(m, s.cosScatter);
      const AirAmounts& way = s.sunAir ? *s.sunAir : middle;
      addSource(rest, share, near, far);
      if (m.sun > 0.0) addSource(sun, share * m.sun, pathOf(way, 0.0), pathOf(way, 1.0));
      continue;
    }
    addSource(book_.spectrum(Factor::medium(*m.medium, stepped_K, 0.0), sim_), share, near, far);
    if (m.medium->radiance && m.gain > 0.0)
      addSource(book_.spectrum("radiance " + std::to_string(m.material),
                               [medium = m.medium](const FineGrid& g, size_t i) { return (*medium->radiance)(g.wavelength_um[i]); }),
                share * m.gain, near, far);
    if (!(m.sun > 0.0)) continue;
    const int scatter = book_.spectrum(Factor::mediumSun(*m.medium, kCosineStep * std::round(s.cosScatter / kCosineStep)), sim_);
    const AirAmounts& way = s.sunAir ? *s.sunAir : middle;
    const std::pair before{m.material, m.sunAmount};
    addSource(scatter, share * m.sun, pathOf(way, 0.0, before), pathOf(way, 1.0, before));
  }
  for (const auto& [temperature_K, share] : black) {
    const double stepped_K = std::exp(kHotStep * std::round(std::log(std::max(temperature_K, 1.0)) / kHotStep));
    addSource(book_.spectrum(Factor::planck(stepped_K, true), sim_), share, near, far);
  }
}

/// Sunlight scattered between two places, by Simpson's rule over what scatters.
void ProductSink::scattered(const Segment& s) {
  const AirAmounts &from = s.near.sun > 0.0 ? s.near.both : s.far.both, &to = s.far.sun > 0.0 ? s.far.both : s.near.both;
  const double sun = 0.5 * (s.near.sun + s.far.sun);
  int way[3];
  for (int p = 0; p < 3; ++p) {
    AirAmounts both;
    for (size_t k = 0; k < kMostAirAmounts; ++k) both.amount[k] = from.amount[k] + 0.5 * p * (to.amount[k] - from.amount[k]);
    way[p] = p == 0 && sunPath_ >= 0 && s.near.sun > 0.0 && s.media.empty() ? sunPath_ : pathOf(both, 0.5 * p);
  }
  sunPath_ = s.far.sun > 0.0 ? way[2] : -1;
  const int irradiance = book_.spectrum(Factor::sun(), sim_);
  const double cosine = kCosineStep * std::round(s.cosScatter / kCosineStep);  // what matters here is the wavelength
  for (size_t k : scatterers_) {
    const double passed = s.far.powered.amount[k] - s.near.powered.amount[k];
    if (!(passed > 0.0)) continue;
    const int scatter = book_.spectrum("scatter " + std::to_string(k) + " " + std::to_string(cosine), [k, cosine](const FineGrid& g, size_t i) {
      const AirNode& n = g.air[i];
      return n.molecules[k] * physics::rayleighPhase(cosine) + n.haze[k] * physics::henyeyGreensteinPhase(cosine, n.asymmetry[k]);
    });
    for (int p = 0; p < 3; ++p) {
      ProductTerm t;
      t.tag = static_cast<int>(TermKind::ScatteredSun);
      t.spectrum[0] = irradiance, t.spectrum[1] = scatter, t.count = 2;
      t.path = way[p], t.coefficient = sun * passed * (p == 1 ? 4.0 : 1.0) / 6.0;
      add(t);
    }
  }
}

/// Light scattered again between two places.
void ProductSink::scatteredAgain(const Segment& s) {
  // In a cloud what is seen is the near end: the place that stands for the segment is where exp(-depth) has its mean.
  Again own;
  double before = 0.0;
  for (size_t k : scatterers_) {
    const double each = scattered_.molecules[k] + scattered_.haze[k];
    own.passed.amount[k] = std::max(s.far.powered.amount[k] - s.near.powered.amount[k], 0.0);
    own.scatters += each * own.passed.amount[k], before += each * s.near.powered.amount[k];
  }
  const double mean = own.scatters > 0.0 ? -std::expm1(-own.scatters) / own.scatters : 1.0;
  own.weight = own.scatters * mean * std::exp(-before);
  const double at = own.scatters > 1e-6 ? -std::log(mean) / own.scatters : 0.5;
  const auto between = [at](double near, double far) { return near + at * (far - near); };
  for (size_t k = 0; k < kMostAirAmounts; ++k) own.middle.amount[k] = between(s.near.powered.amount[k], s.far.powered.amount[k]);
  own.place = {between(s.near.height_m, s.far.height_m), between(s.near.sine, s.far.sine), s.sunlit ? s.cosAzimuth : 0.0,
               between(s.near.temperature_K, s.far.temperature_K)};
  if (own.weight > 0.0) again_.push_back(own);
  if (!s.media.empty()) tellAgain();
}

/// As seen from the middle of each of a few parts that scatter about alike.
void ProductSink::tellAgain() {
  double all = 0.0;
  for (const Again& a : again_) all += a.weight;
  Again part;
  const auto tell = [&] {
    if (!(part.weight > 0.0)) return;
    for (double& m : part.middle.amount) m /= part.weight;
    // Seen from its middle a part is as bright as its segments together.
    double depth = 0.0;
    for (size_t k : scatterers_) depth += (scattered_.molecules[k] + scattered_.haze[k]) * part.middle.amount[k];
    const double seen = part.weight * std::exp(std::min(depth, kOpaque)) / part.scatters;
    DiffuseOnGrids::Place& mean = part.place;
    for (double* v : {&mean.height_m, &mean.sine, &mean.cosAzimuth, &mean.temperature_K}) *v /= part.weight;
    const DiffuseOnGrids::Place place = diffuse_->stepped(mean, step_K_);
    const std::string where = "again " + std::to_string(place.height_m) + " " + std::to_string(place.sine) + " " + std::to_string(place.cosAzimuth) + " " +
                              std::to_string(place.temperature_K) + " ";
    const int path = pathOf(part.middle, 0.5);
    for (size_t k : scatterers_) {
      if (!((scattered_.molecules[k] + scattered_.haze[k]) * part.passed.amount[k] > kLittle * part.scatters)) continue;
      ProductTerm t;
      t.tag = static_cast<int>(TermKind::ScatteredAgain);
      t.spectrum[0] = book_.spectrum(where + std::to_string(k), [all_ = diffuse_, place, k](const FineGrid& g, size_t i) { return all_->at(g, i, place, k); });
      t.count = 1;
      t.path = path, t.coefficient = seen * part.passed.amount[k];
      add(t);
    }
    part = {};
  };
  int cloud = -1;
  for (const Again& a : again_) {
    if (const int own = diffuse_->cloudAt(a.place.height_m); own != cloud) tell(), cloud = own;
    part.weight += a.weight, part.scatters += a.scatters;
    part.passed += a.passed;
    for (size_t k = 0; k < kMostAirAmounts; ++k) part.middle.amount[k] += a.weight * a.middle.amount[k];
    part.place.height_m += a.weight * a.place.height_m, part.place.sine += a.weight * a.place.sine;
    part.place.cosAzimuth += a.weight * a.place.cosAzimuth, part.place.temperature_K += a.weight * a.place.temperature_K;
    if (part.weight >= all / kAgainParts) tell();
  }
  tell();
  again_.clear();
}

}  // namespace pitviper
