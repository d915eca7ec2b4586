#include "sim/radiance/radiance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/radiance/air_places.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/world/ground.hpp"

namespace pitviper {
namespace {

/// How far apart places are between which the air on their ways to the sun is taken as changing evenly, in height and along the line: of haze that falls to a
/// third in 300 m it is then off by (10/300)^2/8, 1e-4, of what there is.
constexpr double kSunHigher_m = 10.0, kSunFurther_m = 500.0;

/// Tells one line of sight to a sink.
class Teller {
 public:
  Teller(const RadianceScene& scene, const LineOfSight& line, double end_m, TermSink& sink)
      : scene_(scene), sim_(scene.simulation), line_(line), sink_(sink), air_(scene, line, placesOf(line, end_m)) {
    if (sim_.sun) cosScatter_ = glm::dot(line.direction, sim_.sun->toSun);
  }

  /// What is told of a line: what the way lets through; besides what it sends; or all, with what is at its end, where something solid may be met.
  enum class Told { Through, Way, All };
  void run(Told told, const Hit* solid = nullptr) {
    const bool shining = told != Told::Through;
    dark_ = !shining;
    sink_.restart();
    std::vector<const Hit*> panes;
    for (const Hit& h : line_.hits.layers) panes.push_back(&h);
    std::stable_sort(panes.begin(), panes.end(), [](const Hit* a, const Hit* b) { return a->distance < b->distance; });
    size_t next = 0;
    const auto& places = air_.places();
    for (size_t p = 0; p < places.size(); ++p) {
      if (p > 0) segment(places[p - 1], places[p]);
      for (; next < panes.size() && panes[next]->distance <= places[p].range_m; ++next) {
        if (shining) surface(*panes[next], places[p]);
        pane(*panes[next]);
      }
    }
    if (told != Told::All) return;
    const std::array behind{Factor::background()};
    if (solid) surface(*solid, places.back());
    else if (!sim_.background.isZero()) sink_.term({TermKind::Background, 1.0, behind, nullptr});
  }

 private:
  /// Where something begins or ends, rising, with the ends of the way.
  static std::vector<double> placesOf(const LineOfSight& line, double end_m) {
    std::vector<double> at = {0.0, end_m};
    for (const Hit& h : line.hits.layers) at.push_back(h.distance);
    for (const auto& s : line.hits.stretches) at.insert(at.end(), {s.enter, s.leave});
    for (const auto& s : line.hits.slabs) at.insert(at.end(), {s.step.enter_m, s.step.leave_m});
    std::erase_if(at, [&](double r) { return !(r >= 0.0 && r <= end_m); });
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    return at;
  }

  double modifier(int texture, const Hit& hit) const { return texture < 0 ? 1.0 : moments(texture, hit).mean; }

  TextureMoments moments(int texture, const Hit& hit) const {
    return textureMoments(sim_.textures[static_cast<size_t>(texture)], hit.uv, hit.footprint, scene_.taps);
  }

  /// Temperatures of a surface and the share of each: two where a pixel covers several texels.
  std::vector<std::pair<double, double>> temperaturesOf(const Surface& s, const Hit& hit) const {
    if (s.temperatureTexture < 0) return {{line_.temperature_K > 0.0 && hit.entity >= 0 ? line_.temperature_K : temperatureAt(sim_, scene_.state, hit), 1.0}};
    const TextureMoments m = moments(s.temperatureTexture, hit);
    const glm::dvec3 two = physics::twoTemperatures(m.mean, m.second, m.third);
    if (two.x == two.y) return {{two.x, 1.0}};
    return {{two.x, 1.0 - two.z}, {two.y, two.z}};
  }

  void segment(const AirPlace& near, const AirPlace& far) {
    inside_.clear();
    const double middle = 0.5 * (near.range_m + far.range_m);
    for (const auto& s : line_.hits.stretches) {
      if (!(s.enter < middle && s.leave > middle)) continue;
      const Entity& body = sim_.entities[static_cast<size_t>(s.entity)];
      const Surface& surface = body.surfaces.front();
      inside_.push_back({sim_.mediumOf(body), s.entity, surface.material,
                         line_.temperature_K > 0.0 ? line_.temperature_K : scene_.state.temperatures_K[static_cast<size_t>(s.entity)][0],
                         far.range_m - near.range_m});
    }
    const bool scatters = addFields(middle, far.range_m - near.range_m);
    AirAmounts toSun;
    if (scatters && scene_.terms.air) toSun = sim_.air->powered(air_.amounts(near) + airToSun(middle, far.range_m - near.range_m));
    sink_.segment(
        {near, far, inside_, scene_.terms.air, air_.sunlit(), cosScatter_, air_.cosAzimuth(), dark_, scatters && scene_.terms.air ? &toSun : nullptr});
  }

  /// From a place on the line to the sun: linear between places that stand close together (kSunHigher_m, kSunFurther_m).
  AirAmounts airToSun(double range_m, double length_m) {
    const double sine = glm::dot(line_.direction, sim_.frame.up(line_.origin)), apart = std::min(kSunFurther_m, kSunHigher_m / std::max(std::abs(sine), 1e-9)),
                 number = std::floor(range_m / apart), share = range_m / apart - number;
    const auto at = [&](double r) { return sunHere(sim_, line_.origin + r * line_.direction); };
    if (length_m >= apart) return at(range_m).air;
    for (const double n : {number, number + 1.0})
      if (SunPlace& place = sunPlaces_[std::fmod(n, 2.0) == 0.0 ? 0 : 1]; place.number != n) place = {n, at(n * apart)};
    const SunPlace &first = sunPlaces_[std::fmod(number, 2.0) == 0.0 ? 0 : 1], &second = sunPlaces_[std::fmod(number, 2.0) == 0.0 ? 1 : 0];
    if (!(first.sun.share > 0.0 && second.sun.share > 0.0)) return at(range_m).air;
    AirAmounts mixed;
    for (size_t k = 0; k < mixed.amount.size(); ++k) mixed.amount[k] = (1.0 - share) * first.sun.air.amount[k] + share * second.sun.air.amount[k];
    return mixed;
  }

  /// What fields have on a stretch; whether sunlight falls on some of it that scatters.
  bool addFields(double middle_m, double length_m) {
    bool scatters = false;
    for (const Slab& slab : line_.hits.slabs) {
      const FieldStep& s = slab.step;
      if (!(s.enter_m < middle_m && s.leave_m > middle_m)) continue;
      const double share = length_m / (s.leave_m - s.enter_m);
      const std::vector<FieldGas>& gases = sim_.fields[static_cast<size_t>(slab.field)].gases;
      for (size_t g = 0; g < gases.size(); ++g) {
        if (!(s.amount[g] > 0.0)) continue;
        gases[g].at(s.temperature_K, [&](int material, double part) {
          const Medium& medium = *sim_.materials[static_cast<size_t>(material)]->medium;
          const double sun = medium.albedo && sim_.sun ? s.sun : 0.0;
          scatters |= sun > 0.0;
          inside_.push_back({&medium, -1, material, s.temperature_K, share * part * s.amount[g], false, s.gain, sun, s.sunAmount, share * s.drift_perK,
                             slab.field, s.cloud ? &*s.cloud : nullptr});
        });
      }
    }
    return scatters;
  }

  /// Height of the body that a hit belongs to; the ground lies at 0.
  double heightOf(const Hit& hit) const { return hit.entity < 0 ? 0.0 : sim_.frame.height(scene_.state.entities[static_cast<size_t>(hit.entity)].position); }
  double viewAngle(const Hit& hit) const { return std::acos(std::clamp(-glm::dot(hit.normal, line_.direction), 0.0, 1.0)); }

  void pane(const Hit& hit) {
    const Material& m = sim_.materialOf(surfaceAt(sim_, hit));
    sink_.pane(Factor::transmittance(m, viewAngle(hit)), m.transmission ? modifier(m.transmission->modifier, hit) : 1.0);
  }

  void add(TermKind kind, double coefficient, std::initializer_list<Factor> factors, const AirAmounts* air = nullptr, int light = -1) {
    if (coefficient * share_ != 0.0) sink_.term({kind, coefficient * share_, {factors.begin(), factors.size()}, air, entity_, light});
  }

  void surface(const Hit& hit, const AirPlace& place) {
    const Material& m = sim_.materialOf(surfaceAt(sim_, hit));
    entity_ = hit.entity;
    share_ = 1.0;
    if (!m.states) return surface(hit, m, place);
    const MaterialStates& states = *m.states;
    const double last = static_cast<double>(states.entries.size() - 1);
    double state = 0.0;
    if (states.texture >= 0) state = modifier(states.texture, hit);
    else
      for (const auto& [temperature_K, part] : temperaturesOf(surfaceAt(sim_, hit), hit)) state += part * temperature_K;
    const double x = std::clamp((state - states.low) / (states.high - states.low), 0.0, 1.0) * last, low = std::min(std::floor(x), last - 1.0);
    share_ = 1.0 - (x - low);
    surface(hit, *states.entries[static_cast<size_t>(low)], place);
    share_ = x - low;
    surface(hit, *states.entries[static_cast<size_t>(low) + 1], place);
  }

  void surface(const Hit& hit, const Material& m, const AirPlace& place) {
    const Surface& s = surfaceAt(sim_, hit);
    std::vector<double> modifiers;
    for (int texture : m.modifiers) modifiers.push_back(modifier(texture, hit));
    const bool textured = s.temperatureTexture >= 0, general = (m.transmission ? scene_.terms.layer : scene_.terms.solid).isGeneral();
    const double angle = viewAngle(hit);
    for (const auto& [temperature_K, part] : temperaturesOf(s, hit)) {
      if (!general) {
        add(TermKind::Emission, part, {Factor::emission(m, temperature_K)});
        continue;
      }
      const Factor black = Factor::planck(temperature_K, !textured);
      if (m.given || !m.hasModifiers()) {
        add(TermKind::Emission, part * (m.given ? modifier(m.given->modifier, hit) : 1.0), {black, Factor::emissivity(m, angle)});
        continue;
      }
      // Kirchhoff: 1 - reflectance - transmittance, each with its texture.
      add(TermKind::Emission, part, {black});
      for (size_t k = 0; k < m.reflections.size(); ++k) add(TermKind::Emission, -part * modifiers[k], {black, Factor::hemispherical(*m.reflections[k], angle)});
      if (m.transmission) add(TermKind::Emission, -part * modifier(m.transmission->modifier, hit), {black, Factor::transmittance(m, angle)});
    }
    if (scene_.terms.ambient && !general) add(TermKind::Ambient, 1.0, {Factor::dome(m)});
    const SurfaceView seen{hit.normal, -line_.direction, scene_.terms.surroundings != 0 ? heightOf(hit) : 0.0};
    for (size_t k = 0; scene_.terms.ambient && general && k < m.reflections.size(); ++k)
      if (scene_.terms.surroundings != 0) add(TermKind::Ambient, modifiers[k], {Factor::reflected(*m.reflections[k], seen)});
      else add(TermKind::Ambient, modifiers[k], {Factor::ambient(), Factor::hemispherical(*m.reflections[k], angle)});
    reflected(hit, m, modifiers, place);
  }

  void reflected(const Hit& hit, const Material& m, const std::vector<double>& modifiers, const AirPlace& place) {
    if (!scene_.terms.lights || m.reflections.empty()) return;
    glm::dvec3 view = inNormalFrame(hit.normal, -line_.direction);
    view.z = std::max(view.z, 1e-6);
    for (size_t l = 0; l < sim_.lights.size() + (sim_.sun ? 1 : 0); ++l) {
      const bool sun = l == sim_.lights.size();
      const LightLeg leg = lightLeg(sim_, scene_.state, hit, l);
      double strength = leg.factor * (sun ? 1.0 : scene_.state.lightLevels[l]);
      if (hit.entity < 0 && !sun) continue;  // lamps do not light the ground beyond all bodies, nor does anything shade it
      if (strength > 0.0 && scene_.lit && hit.entity >= 0) strength *= scene_.lit(hit, l, leg);
      if (!(strength > 0.0)) continue;
      const glm::dvec3 light = inNormalFrame(hit.normal, leg.toLight);
      AirAmounts both;
      if (scene_.terms.air) both = sim_.air->powered(air_.amounts(place) + leg.air);
      const double shade = sun && sim_.sunShade ? sim_.sunShade->grid().at(hit.point) : 0.0;
      for (size_t k = 0; k < m.reflections.size(); ++k) {
        const ReflectionComponent& r = *m.reflections[k];
        const double coefficient = modifiers[k] * strength * r.lobeAt(light, view);
        const AirAmounts* const air = scene_.terms.air ? &both : nullptr;
        const Factor column = Factor::column(r, light, view);
        if (shade > 0.0) add(TermKind::Sun, coefficient, {column, Factor::sun(), Factor::sunShade(sim_, shade)}, air);
        else if (sun) add(TermKind::Sun, coefficient, {column, Factor::sun()}, air);
        else add(TermKind::Lights, coefficient, {column, Factor::light(sim_.lights[l])}, air, static_cast<int>(lampOf(sim_, l)));
      }
    }
  }

  const RadianceScene& scene_;
  const Simulation& sim_;
  const LineOfSight& line_;
  TermSink& sink_;
  AirPlaces air_;
  std::vector<MediumInside> inside_;
  double cosScatter_ = 0.0;
  bool dark_ = false;
  struct SunPlace {
    double number = -1.0;
    SunHere sun;
  };
  std::array<SunPlace, 2> sunPlaces_;  ///< the two last: an even and an odd one
  int entity_ = -1;                    ///< of the surface that is told
  double share_ = 1.0;                 ///< of the state that is told
};

}  // namespace

const char* nameOf(TermKind kind) {
  constexpr const char* kNames[kTermKinds] = {"emission of surfaces", "reflected ambient light", "reflected sunlight", "reflected light of lamps",
                                              "emission of the air",  "scattered sunlight",      "background",         "media",
                                              "lamps in view",        "light scattered again"};
  return kNames[static_cast<int>(kind)];
}

void radianceAlong(const RadianceScene& scene, const LineOfSight& line, TermSink& sink) {
  const std::optional<Hit> ground = line.hits.solid.entity >= 0 ? std::nullopt : groundHit(scene.simulation, line.origin, line.direction);
  const Hit* solid = ground ? &*ground : line.hits.solid.entity >= 0 ? &line.hits.solid : nullptr;
  Teller(scene, line, solid ? solid->distance : physics::kFar, sink).run(Teller::Told::All, solid);
}

void wayAlong(const RadianceScene& scene, const LineOfSight& line, double range_m, TermSink& sink) {
  Teller(scene, line, range_m, sink).run(Teller::Told::Through);
}

void lightOfWay(const RadianceScene& scene, const LineOfSight& line, double range_m, TermSink& sink) {
  Teller(scene, line, range_m, sink).run(Teller::Told::Way);
}

void lampAlong(const RadianceScene& scene, const LineOfSight& line, std::size_t light, double pixel_sr, TermSink& sink) {
  const glm::dvec3 way = scene.state.lights[light] - line.origin;
  const double range = glm::length(way), level = scene.state.lightLevels[light];
  if (!(level > 0.0) || !(range > 0.0)) return;
  const double sent = level * patternTowards(scene.simulation, scene.state, light, -way / range);
  if (!(sent > 0.0)) return;
  wayAlong(scene, line, range, sink);
  const std::array shine{Factor::light(scene.simulation.lights[light])};
  sink.term({TermKind::LampsInView, sent / (range * range * pixel_sr), shine, nullptr, -1, static_cast<int>(lampOf(scene.simulation, light))});
}

}  // namespace pitviper
