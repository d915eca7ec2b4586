#include "sim/plan/sight_writer.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/model/ground.hpp"
#include "sim/model/light_legs.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Places along a line of sight between which the air's emission is taken as one black body's.
constexpr size_t kStations = 9, kFineStations = 18;  ///< the second below kFine
constexpr double kFine = 0.003;
/// Black bodies of textures and air are mixtures of those at these steps [K], surfaces at other view angles like those at these steps.
constexpr double kTemperatureStep_K = 4.0, kAngleStep_rad = kPi / 36.0;

std::string name(const char* what, const void* of, double x = 0.0, double y = 0.0) {
  char text[96];
  std::snprintf(text, sizeof text, "%s %p %.9g %.9g", what, of, x, y);
  return text;
}

/// About evenly spread members of a list with its first and last.
std::vector<AirStation> thinned(const std::vector<AirStation>& all, size_t count) {
  if (all.size() <= count) return all;
  std::vector<AirStation> some;
  for (size_t k = 0; k < count; ++k) some.push_back(all[k * (all.size() - 1) / (count - 1)]);
  return some;
}

/// Terms of the same spectra on the same path as one.
std::vector<SightTerm> merged(std::vector<SightTerm> terms) {
  std::map<std::tuple<int, int, int, TermKind>, size_t> placeOf;
  std::vector<SightTerm> out;
  for (const SightTerm& t : terms) {
    const auto [at, isNew] = placeOf.try_emplace({t.source, t.second, t.path, t.kind}, out.size());
    if (isNew) out.push_back(t);
    else out[at->second].coefficient += t.coefficient;
  }
  std::erase_if(out, [](const SightTerm& t) { return t.coefficient == 0.0; });
  return out;
}

/// The nearest texel.
double texel(const Texture& t, glm::dvec2 uv) {
  auto at = [&](double x, int n) {
    const double k = std::floor(t.repeats ? (x - std::floor(x)) * n : x * n);
    return static_cast<size_t>(std::clamp(k, 0.0, n - 1.0));
  };
  return static_cast<double>(t.texels[at(uv.y, t.height) * static_cast<size_t>(t.width) + at(uv.x, t.width)]);
}

}  // namespace

SightWriter::SightWriter(const Simulation& simulation, const Plan& plan, SightBook& book, const SightRay& ray, RayHits hits, Dice& dice)
    : sim_(simulation), plan_(plan), book_(book), ray_(ray), hits_(std::move(hits)), dice_(dice) {
  airRay_ = {sim_.frame.height(ray.origin), glm::dot(ray.direction, sim_.frame.up(ray.origin)), sim_.frame.earthRadius_m()};
  if (plan.terms.air) {
    const AirNode node = sim_.path->node(std::clamp(1.0, sim_.path->validLow_um(), sim_.path->validHigh_um()));
    for (size_t k = 0; k < kMostAirAmounts; ++k)
      if (node.molecules[k] + node.haze[k] > 0.0) scatterers_.push_back(k);
  }
  for (const Hit& h : hits_.layers) {
    const Material& m = sim_.materialOf(sim_.entities[static_cast<size_t>(h.entity)].surfaces[static_cast<size_t>(h.surface)]);
    const double angle = kAngleStep_rad * std::round(std::acos(std::clamp(-glm::dot(h.normal, ray.direction), 0.0, 1.0)) / kAngleStep_rad);
    const int through =
        book.spectrum(name("transmittance", &m, angle), [&m, angle](const FineGrid& g, size_t i) { return m.transmittance(g.wavelength_um[i], angle); });
    const int texture = m.transmission ? m.transmission->modifier : -1;
    filters_.push_back({h.distance, through, texture < 0 ? 1.0 : texel(sim_.textures[static_cast<size_t>(texture)], h.uv)});
  }
}

std::vector<double> SightWriter::mediaUpTo(double range_m) const {
  if (hits_.stretches.empty()) return {};
  std::vector<double> metres(sim_.materials.size(), 0.0);
  for (const Stretch& s : hits_.stretches) {
    const auto material = static_cast<size_t>(sim_.entities[static_cast<size_t>(s.entity)].surfaces.front().material);
    metres[material] += std::max(std::min(s.leave, range_m) - std::max(s.enter, 0.0), 0.0);
  }
  return metres;
}

int SightWriter::pathTo(double range_m, const AirAmounts& air) {
  book_.paths.push_back({sim_.path ? sim_.path->powered(air) : AirAmounts{}, mediaUpTo(range_m)});
  return static_cast<int>(book_.paths.size()) - 1;
}

int SightWriter::planck(double temperature_K) {
  return book_.spectrum(name("planck", nullptr, temperature_K),
                        [temperature_K](const FineGrid& g, size_t i) { return physics::planckRadiance(g.wavelength_um[i], temperature_K); });
}

int SightWriter::reflectance(const Material& material, size_t component, double viewAngle_rad) {
  const ReflectionComponent* r = material.reflections[component].get();
  const double angle = r->hemisphericalVaries() ? kAngleStep_rad * std::round(viewAngle_rad / kAngleStep_rad) : 0.0;
  return book_.spectrum(name("reflectance", r, angle), [r, angle](const FineGrid& g, size_t i) { return r->hemispherical(g.wavelength_um[i], angle); });
}

/// Through all transparent surfaces before a range.
void SightWriter::add(Sight& sight, double range_m, SightTerm term) {
  for (const Filter& f : filters_) {
    if (!(f.range_m < range_m)) continue;
    term.coefficient *= f.modifier;
    if (term.second < 0) {
      term.second = f.transmittance;
      continue;
    }
    const int a = term.second, b = f.transmittance;
    SightBook* book = &book_;
    term.second = book_.spectrum("both " + std::to_string(a) + " " + std::to_string(b), [book, a, b](const FineGrid& g, size_t i) {
      return book->spectra[static_cast<size_t>(a)](g, i) * book->spectra[static_cast<size_t>(b)](g, i);
    });
  }
  if (term.coefficient != 0.0) sight.terms.push_back(term);
}

/// A term times a black body, which is a mixture of two.
void SightWriter::addThermal(Sight& sight, double range_m, double temperature_K, SightTerm term) {
  const double at = temperature_K / kTemperatureStep_K, low = std::floor(at);
  for (int k = 0; k < 2; ++k) {
    SightTerm t = term;
    const int black = planck(kTemperatureStep_K * (low + k));
    (t.source < 0 ? t.source : t.second) = black;
    t.coefficient *= k == 0 ? 1.0 - (at - low) : at - low;
    if (low + k > 0.0) add(sight, range_m, t);
  }
}

void SightWriter::air(Sight& sight, double range_m) {
  if (!plan_.terms.air) return;
  const Path& path = *sim_.path;
  RaySun sun;
  if (sim_.sun) sun = {glm::dot(sim_.sun->toSun, sim_.frame.up(ray_.origin)), glm::dot(ray_.direction, sim_.sun->toSun)};
  const bool sunlit = plan_.terms.scatteredSun;
  const SunlitAir line(path, airRay_, thinned(path.stations(airRay_, range_m), plan_.accuracy < kFine ? kFineStations : kStations),
                       sunlit ? plan_.sunLegs.get() : nullptr, sun);
  int before = -1;
  for (size_t j = 0; j < line.stations.size(); ++j) {
    const AirStation& s = line.stations[j];
    if (j == 0) {
      before = pathTo(s.range_m, s.amounts);
      continue;
    }
    const AirStation& last = line.stations[j - 1];
    const int here = pathTo(s.range_m, s.amounts);
    // Both ends through what lies before the nearer one: a gas in between is not air.
    int end = here;
    if (book_.paths[static_cast<size_t>(here)].media_m != book_.paths[static_cast<size_t>(before)].media_m) end = pathTo(last.range_m, s.amounts);
    const double temperature_K = 0.5 * (last.temperature_K + s.temperature_K);
    const int black = temperature_K > 0.0 ? planck(kTemperatureStep_K * std::round(temperature_K / kTemperatureStep_K)) : -1;
    const int own = book_.spectrum("air's own", [](const FineGrid& g, size_t i) { return g.air[i].source; });
    for (int k = 0; k < 2; ++k) {
      const int at = k == 0 ? before : end;
      const double sign = k == 0 ? 1.0 : -1.0;
      if (black >= 0) add(sight, s.range_m, {black, -1, at, sign, TermKind::AirEmission});
      add(sight, s.range_m, {own, -1, at, sign, TermKind::AirEmission});
    }
    if (sunlit && line.lit[j - 1] > 0.0 && line.lit[j] > 0.0) scattered(sight, line, j, sun.cosScatter);
    before = here;
  }
}

/// Sunlight scattered between two places, by Simpson's rule over what scatters.
void SightWriter::scattered(Sight& sight, const SunlitAir& line, size_t station, double cosScatter) {
  const double range = line.stations[station].range_m;
  const AirAmounts &from = line.both[station - 1], &to = line.both[station];
  int way[3];
  for (int p = 0; p < 3; ++p) {
    SightPath both{{}, mediaUpTo(range)};
    for (size_t k = 0; k < kMostAirAmounts; ++k) both.air.amount[k] = from.amount[k] + 0.5 * p * (to.amount[k] - from.amount[k]);
    book_.paths.push_back(std::move(both));
    way[p] = static_cast<int>(book_.paths.size()) - 1;
  }
  const int irradiance = book_.spectrum("sun", [&sim = sim_](const FineGrid& g, size_t i) { return sim.sun->irradiance(g.wavelength_um[i]); });
  // Steps of a tenth in the cosine: what matters here is the wavelength.
  const double cosine = 0.1 * std::round(10.0 * cosScatter);
  for (size_t k : scatterers_) {
    const double lit = 0.5 * (line.lit[station - 1] + line.lit[station]);
    const double passed = lit * (line.powered[station].amount[k] - line.powered[station - 1].amount[k]);
    if (!(passed > 0.0)) continue;
    const int scatter = book_.spectrum("scatter " + std::to_string(k) + " " + std::to_string(cosine), [k, cosine](const FineGrid& g, size_t i) {
      const AirNode& n = g.air[i];
      return n.molecules[k] * rayleighPhase(cosine) + n.haze[k] * henyeyGreensteinPhase(cosine, n.asymmetry);
    });
    for (int p = 0; p < 3; ++p) add(sight, range, {irradiance, scatter, way[p], passed * (p == 1 ? 4.0 : 1.0) / 6.0, TermKind::ScatteredSun});
  }
}

void SightWriter::reflected(Sight& sight, const Hit& hit, const Material& material, const double* modifier) {
  glm::dvec3 view = inNormalFrame(hit.normal, -ray_.direction);
  view.z = std::max(view.z, 1e-6);
  const AirAmounts toCamera = plan_.terms.air ? sim_.path->amounts(airRay_, hit.distance) : AirAmounts{};
  for (size_t l = 0; l < sim_.lights.size() + (sim_.sun ? 1 : 0); ++l) {
    const bool sun = l == sim_.lights.size();
    const double level = sun ? 1.0 : ray_.state.lightLevels[l];
    const LightLeg leg = lightLeg(sim_, ray_.state, hit, l);
    if (!(level * leg.factor > 0.0) || (hit.entity < 0 && !sun)) continue;  // lamps do not light the ground beyond all bodies
    // In shade, half in it, or lit: other lights of a pixel then count for more.
    const double shade = dice_.unit(), strength = shade < 0.25 ? 0.0 : shade < 0.5 ? dice_.unit() : 1.0;
    if (strength <= 0.0) continue;
    const int path = pathTo(hit.distance, toCamera + leg.air);
    const glm::dvec3 light = inNormalFrame(hit.normal, leg.toLight);
    const Spectrum* shine = sun ? &sim_.sun->irradiance : &sim_.lights[l].intensity;
    const int source = book_.spectrum(name("light", shine), [shine](const FineGrid& g, size_t i) { return (*shine)(g.wavelength_um[i]); });
    for (size_t k = 0; k < material.reflections.size(); ++k) {
      const ReflectionComponent* r = material.reflections[k].get();
      const auto axes = r->axes();
      double angle[2];
      bool plain = true;
      for (size_t a = 0; a < 2; ++a) {
        angle[a] = axes[a].angle == Angle::None ? 0.0 : angleBetween(axes[a].angle, light, view);
        plain &= axes[a].angle == Angle::None;
      }
      const int column = book_.spectrum(plain ? name("column", r) : name("column", r, angle[0], angle[1]),
                                        [r, a = angle[0], b = angle[1]](const FineGrid& g, size_t i) { return r->column(g.wavelength_um[i], a, b); });
      add(sight, hit.distance,
          {column, source, path, modifier[k] * level * leg.factor * strength * r->lobe(light, view), sun ? TermKind::Sun : TermKind::Lights});
    }
  }
}

void SightWriter::surface(Sight& sight, const Hit& hit) {
  const Surface& surface = surfaceAt(sim_, hit);
  const Material& material = sim_.materialOf(surface);
  const bool general = (material.transmission ? plan_.terms.layer : plan_.terms.solid).isGeneral();
  auto modifierOf = [&](int texture) { return texture < 0 ? 1.0 : texel(sim_.textures[static_cast<size_t>(texture)], hit.uv); };
  double modifier[3] = {1.0, 1.0, 1.0};
  for (size_t k = 0; k < material.modifiers.size(); ++k) modifier[k] = modifierOf(material.modifiers[k]);
  const int path = pathTo(hit.distance, plan_.terms.air ? sim_.path->amounts(airRay_, hit.distance) : AirAmounts{});
  const double temperature_K = surface.temperatureTexture >= 0 ? texel(sim_.textures[static_cast<size_t>(surface.temperatureTexture)], hit.uv)
                               : ray_.temperature_K > 0.0 && hit.entity >= 0 ? ray_.temperature_K
                                                               : surface.temperature_K;

  if (!general) {
    // Both are one row of the program's tables, but whether the dome's light matters is asked by itself.
    const int self = book_.spectrum(name("self", &surface, temperature_K), [&material, temperature_K](const FineGrid& g, size_t i) {
      return material.emissivity(g.wavelength_um[i], 0.0) * physics::planckRadiance(g.wavelength_um[i], temperature_K);
    });
    add(sight, hit.distance, {self, -1, path, 1.0});
    if (plan_.terms.ambient) {
      const int dome = book_.spectrum(name("dome", &material), [&sim = sim_, &material](const FineGrid& g, size_t i) {
        const double sky = (*sim.ambient)(g.wavelength_um[i]);
        return sky > 0.0 ? material.reflectance(g.wavelength_um[i], 0.0) * sky : 0.0;
      });
      add(sight, hit.distance, {dome, -1, path, 1.0, TermKind::Ambient});
    }
    reflected(sight, hit, material, modifier);
    return;
  }
  const double viewAngle = std::acos(std::clamp(-glm::dot(hit.normal, ray_.direction), 0.0, 1.0));
  const bool textured = surface.temperatureTexture >= 0;
  auto emit = [&](int factor, double coefficient) {
    SightTerm term{factor, -1, path, coefficient};
    if (textured) {
      addThermal(sight, hit.distance, temperature_K, term);
      return;
    }
    (factor < 0 ? term.source : term.second) = planck(temperature_K);
    add(sight, hit.distance, term);
  };
  if (material.given) {
    const double angle = material.given->varies() ? kAngleStep_rad * std::round(viewAngle / kAngleStep_rad) : 0.0;
    emit(book_.spectrum(name("emissivity", &material, angle),
                        [&material, angle](const FineGrid& g, size_t i) { return material.given->at(g.wavelength_um[i], angle); }),
         modifierOf(material.given->modifier));
  } else {
    // Kirchhoff: 1 - reflectance - transmittance, each with its texture.
    emit(-1, 1.0);
    for (size_t k = 0; k < material.reflections.size(); ++k) emit(reflectance(material, k, viewAngle), -modifier[k]);
    for (const Filter& f : filters_)
      if (f.range_m == hit.distance) emit(f.transmittance, -f.modifier);
  }
  if (plan_.terms.ambient) {
    const int sky = book_.spectrum("ambient", [&sim = sim_](const FineGrid& g, size_t i) { return (*sim.ambient)(g.wavelength_um[i]); });
    for (size_t k = 0; k < material.reflections.size(); ++k)
      add(sight, hit.distance, {reflectance(material, k, viewAngle), sky, path, modifier[k], TermKind::Ambient});
  }
  reflected(sight, hit, material, modifier);
}

void SightWriter::media(Sight& sight) {
  for (const Stretch& s : hits_.stretches) {
    const Entity& body = sim_.entities[static_cast<size_t>(s.entity)];
    const Surface& surface = body.surfaces.front();
    const double enter = std::max(s.enter, 0.0);
    if (!(s.leave > enter)) continue;
    const Medium* medium = sim_.mediumOf(body);
    const double temperature_K = ray_.temperature_K > 0.0 ? ray_.temperature_K : surface.temperature_K;
    const int source = book_.spectrum(name("medium", medium, temperature_K),
                                      [medium, t = temperature_K](const FineGrid& g, size_t i) { return medium->source(g.wavelength_um[i], t); });
    const int path = pathTo(enter, plan_.terms.air ? sim_.path->amounts(airRay_, enter) : AirAmounts{});
    add(sight, enter, {source, -1, path, 1.0, TermKind::Media});
    SightPath behind = book_.paths[static_cast<size_t>(path)];
    behind.media_m[static_cast<size_t>(surface.material)] += s.leave - enter;
    book_.paths.push_back(std::move(behind));
    add(sight, enter, {source, -1, static_cast<int>(book_.paths.size()) - 1, -1.0, TermKind::Media});
  }
}

Sight SightWriter::pixel() {
  Sight sight;
  sight.fromFilm = ray_.fromFilm;
  const std::optional<Hit> end = hits_.solid.entity >= 0 ? hits_.solid : groundHit(sim_, ray_.origin, ray_.direction);
  const double range = end ? end->distance : physics::kFar;
  if (end) {
    surface(sight, *end);
  } else if (!sim_.background.isZero()) {
    const int behind = book_.spectrum("background", [&sim = sim_](const FineGrid& g, size_t i) { return sim.background(g.wavelength_um[i]); });
    add(sight, range, {behind, -1, pathTo(range, plan_.terms.air ? sim_.path->amounts(airRay_, range) : AirAmounts{}), 1.0, TermKind::Background});
  }
  for (const Hit& h : hits_.layers) surface(sight, h);
  media(sight);
  air(sight, range);
  sight.terms = merged(std::move(sight.terms));
  return sight;
}

Sight SightWriter::lamp(size_t light, double pixel_sr) {
  Sight sight;
  const glm::dvec3 line = ray_.state.lights[light] - ray_.origin;
  const double range = glm::length(line), level = ray_.state.lightLevels[light];
  if (!(level > 0.0) || !(range > 0.0)) return sight;
  AirAmounts amounts;
  if (plan_.terms.air) {
    const AirRay ray{airRay_.height_m, glm::dot(line, sim_.frame.up(ray_.origin)) / range, airRay_.earthRadius_m};
    amounts = sim_.path->amounts(ray, range);
  }
  book_.paths.push_back({sim_.path ? sim_.path->powered(amounts) : AirAmounts{}, {}});
  const Spectrum* shine = &sim_.lights[light].intensity;
  const int source = book_.spectrum(name("light", shine), [shine](const FineGrid& g, size_t i) { return (*shine)(g.wavelength_um[i]); });
  sight.terms.push_back({source, -1, static_cast<int>(book_.paths.size()) - 1, level / (range * range * pixel_sr), TermKind::LampsInView});
  return sight;
}

}  // namespace pitviper
