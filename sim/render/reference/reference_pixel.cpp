#include "sim/render/reference/reference_pixel.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"
#include "sim/world/field_states.hpp"
#include "sim/world/glint.hpp"
#include "sim/world/ground.hpp"

namespace pitviper {
namespace {

/// A glint below this part of a lobe's maximum is none; above, so many steps for a factor of two.
constexpr double kNoGlint = 1e-7;
constexpr double kGlintSteps = 2.0;

}  // namespace

ReferenceShader::ReferenceShader(const Simulation& simulation, const Plan& plan, const View& view, const WorldState& state, const std::vector<char>& drawn,
                                 std::shared_ptr<const NodeSpectra> spectra)
    : simulation_(simulation),
      plan_(plan),
      view_(view),
      state_(state),
      drawn_(drawn),
      transparent_(simulation.hasTransparent()),
      shadows_(simulation),
      spectra_(spectra ? std::move(spectra) : std::make_shared<const NodeSpectra>(simulation, plan.nodes, plan.terms)) {
  for (size_t f = 0; f < simulation.fields.size(); ++f)
    if (const FieldState* field = fieldOf(state, f))
      if (const FieldLines lines = fieldLines(view, *field); !lines.isEmpty()) fields_.push_back(lines);
}

RadianceScene ReferenceShader::scene() const {
  RadianceScene s{simulation_, plan_.terms, plan_.sunLegs.get(), state_, {}, airPlaces_, tapsFor(plan_.textureAccuracy)};
  if (plan_.terms.shadows)
    s.lit = [this](const Hit& hit, size_t light, const LightLeg& leg) {
      const double radius_m = light < simulation_.lights.size() ? simulation_.lights[light].radius_m : 0.0;
      return shadows_.lit(state_, hit, leg.toLight, leg.distance_m - radius_m) ? 1.0 : 0.0;
    };
  return s;
}

LineOfSight ReferenceShader::lineThrough(double x, double y) const {
  const glm::dvec3 ray = view_.ray(x, y);
  return {view_.position, view_.localFromCamera * ray / glm::length(ray), {}, 0.0};
}

double ReferenceShader::nearest_m(double x, double y) const { return view_.near_m * glm::length(view_.ray(x, y)); }

ReferencePixel ReferenceShader::pixel(int x, int y, NodeSum& sum) const {
  LineOfSight line = lineThrough(x + 0.5, y + 0.5);
  line.hits = castRay(simulation_, state_, line.origin, line.direction, nearest_m(x + 0.5, y + 0.5), &drawn_);
  addFootprints(line, x + 0.5, y + 0.5);
  return shadeOver(std::move(line), x, y, sum);
}

ReferencePixel ReferenceShader::place(double x, double y, NodeSum& sum) const {
  LineOfSight line = lineThrough(x, y);
  line.hits = castRay(simulation_, state_, line.origin, line.direction, nearest_m(x, y), &drawn_);
  return shade(line, sum);
}

ReferencePixel ReferenceShader::pixel(int x, int y) const {
  NodeSum sum(*spectra_);
  return pixel(x, y, sum);
}

/// Of meshed media, each inside what its triangles enclose, as often as they do; who is left more often than entered has the camera inside.
void ReferenceShader::addStretches(std::vector<Hit> borders, std::vector<Stretch>& stretches) {
  std::stable_sort(borders.begin(), borders.end(), [](const Hit& a, const Hit& b) {
    return a.entity != b.entity ? a.entity < b.entity : a.distance != b.distance ? a.distance < b.distance : a.front && !b.front;
  });
  for (auto from = borders.begin(); from != borders.end();) {
    const auto to = std::find_if(from, borders.end(), [&](const Hit& h) { return h.entity != from->entity; });
    const auto entered = std::count_if(from, to, [](const Hit& h) { return h.front; });
    auto inside = std::max<std::ptrdiff_t>((to - from) - 2 * entered, 0);
    double since = 0.0;
    for (; from != to; ++from) {
      for (std::ptrdiff_t n = 0; n < inside && from->distance > since; ++n) stretches.push_back({from->entity, since, from->distance});
      since = from->distance;
      inside += from->front ? 1 : -1;
    }
  }
}

LineOfSight ReferenceShader::line(int x, int y, const SeenLines& seen) const {
  LineOfSight line = lineThrough(x + 0.5, y + 0.5);
  RayHits& hits = line.hits;
  const size_t number = static_cast<size_t>(y) * static_cast<size_t>(view_.width) + static_cast<size_t>(x);
  const auto hitAt = [&](const SeenTriangle& t) { return hitOf(simulation_, state_, line.origin, line.direction, t.entity, t.triangle); };
  if (seen.solid[number].entity >= 0) hits.solid = hitAt(seen.solid[number]);
  if (transparent_) {
    // Media, before the solid surface that is known already; surfaces are known too.
    RayHits all = castRay(simulation_, state_, line.origin, line.direction, nearest_m(x + 0.5, y + 0.5), &drawn_, true, 0);
    for (Stretch& s : all.stretches) s.leave = std::min(s.leave, hits.solid.distance);
    std::erase_if(all.stretches, [](const Stretch& s) { return s.leave <= s.enter; });
    std::vector<Hit> borders;
    for (const SeenTriangle& pane : seen.panesOf(number)) {
      Hit hit = hitAt(pane);
      hit.distance = std::min(hit.distance, hits.solid.distance);
      (simulation_.mediumOf(simulation_.entities[static_cast<size_t>(pane.entity)]) ? borders : hits.layers).push_back(hit);
    }
    std::erase_if(all.stretches, [this](const Stretch& s) { return simulation_.entities[static_cast<size_t>(s.entity)].form.kind == BodyForm::Kind::Mesh; });
    hits.stretches = std::move(all.stretches);
    addStretches(std::move(borders), hits.stretches);
    hits.slabs = slabsAlong(simulation_, state_, line.origin, line.direction, hits.solid.distance, kReferenceFieldSteps);
  }
  addFootprints(line, x + 0.5, y + 0.5);
  return line;
}

void ReferenceShader::addFootprints(LineOfSight& line, double x, double y) const {
  if (!(plan_.textureAccuracy > 0.0) || simulation_.textures.empty()) return;
  const glm::dmat3& turned = view_.localFromCamera;
  const glm::dvec3 ray = turned * view_.ray(x, y), across = turned * glm::dvec3(view_.tanPerPixelX, 0.0, 0.0),
                   up = turned * glm::dvec3(0.0, view_.tanPerPixelY, 0.0);
  if (line.hits.solid.entity >= 0) line.hits.solid.footprint = footprintOf(simulation_, state_, line.hits.solid, ray, across, up);
  for (Hit& h : line.hits.layers) h.footprint = footprintOf(simulation_, state_, h, ray, across, up);
}

std::size_t ReferenceShader::things(const RayHits& hits) {
  const auto one = [](int entity, int surface) { return std::hash<long long>()((static_cast<long long>(entity) << 20) + surface + 2); };
  std::size_t all = 0x9e3779b97f4a7c15u ^ one(hits.solid.entity, hits.solid.surface) * 3;
  for (const Hit& h : hits.layers) all += one(h.entity, h.surface) * 0xff51afd7ed558ccdu;
  for (const Stretch& s : hits.stretches) all += one(s.entity, -2) * 0xc4ceb9fe1a85ec53u;
  for (size_t k = 0; k < hits.slabs.size(); ++k)  // a field's steps follow each other
    if (k == 0 || hits.slabs[k].field != hits.slabs[k - 1].field) all += one(hits.slabs[k].field, -3) * 0x9fb21c651e98df25u;
  return all | 1u;
}

std::size_t ReferenceShader::looks(const LineOfSight& line) const {
  std::size_t all = things(line.hits);
  const auto add = [&all](std::size_t number) { all = all * 0x9e3779b97f4a7c15u + number; };
  const auto look = [&](const Hit& hit) {
    if (hit.entity < 0 ||
        simulation_.materialOf(simulation_.entities[static_cast<size_t>(hit.entity)].surfaces[static_cast<size_t>(hit.surface)]).reflections.empty())
      return;
    for (size_t l = 0; l < countLights(simulation_); ++l) {
      const bool sun = l == simulation_.lights.size();
      if (!sun && !(state_.lightLevels[l] > 0.0)) continue;
      const double glint = glintOf(simulation_, state_, hit, line.direction, l);
      add(glint > kNoGlint ? static_cast<std::size_t>(kGlintSteps * (std::log2(glint / kNoGlint) + 1.0)) : 0);
      if (!plan_.terms.shadows) continue;
      const glm::dvec3 to = sun ? simulation_.sun->toSun : state_.lights[l] - hit.point;
      const double distance = glm::length(to);
      add(distance > 0.0 && glm::dot(to, hit.normal) > 0.0 &&
                  shadows_.lit(state_, hit, to / distance, sun ? INFINITY : distance - simulation_.lights[l].radius_m)
              ? 1
              : 0);
    }
  };
  if (!plan_.terms.lights) return all;
  look(line.hits.solid);
  for (const Hit& h : line.hits.layers) look(h);
  return all | 1u;
}

ReferencePixel ReferenceShader::shade(const LineOfSight& line, NodeSum& sum) const {
  sum.begin();
  radianceAlong(scene(), line, sum);
  ReferencePixel pixel;
  const Hit& solid = line.hits.solid;
  pixel.entity = solid.entity;
  pixel.surface = solid.surface;
  const auto ground = solid.entity >= 0 ? std::nullopt : groundHit(simulation_, line.origin, line.direction);
  pixel.range_m = ground ? ground->distance : solid.entity >= 0 ? solid.distance : physics::kFar;
  pixel.radiance.assign(sum.radiance().begin(), sum.radiance().end());
  pixel.slots.assign(static_cast<size_t>(plan_.slotCount), 0.0);
  for (size_t s = 0; s < pixel.slots.size(); ++s)
    for (size_t i = 0; i < plan_.nodes.size(); ++i) pixel.slots[s] += plan_.weight[s][i] * pixel.radiance[i];
  return pixel;
}

ReferencePixel ReferenceShader::shadeOver(LineOfSight line, int x, int y, NodeSum& sum) const {
  std::vector<const FieldLines*> fields;
  for (const FieldLines& f : fields_) fields.push_back(&f);
  const PixelLines lines = pixelLines(fields, x, y, kReferenceLines, kReferenceApart);
  if (lines.within.size() == 1 && lines.outside == 0.0) return shade(line, sum);
  ReferencePixel whole;
  const auto add = [&](double share) {
    ReferencePixel one = shade(line, sum);
    if (whole.slots.empty()) {
      whole = one;
      for (double& v : whole.slots) v = 0.0;
      for (double& v : whole.radiance) v = 0.0;
    }
    for (size_t s = 0; s < whole.slots.size(); ++s) whole.slots[s] += share * one.slots[s];
    for (size_t i = 0; i < whole.radiance.size(); ++i) whole.radiance[i] += share * one.radiance[i];
  };
  line.hits.slabs.clear();
  add(lines.outside);
  for (const FilmLine& through : lines.within) {
    // What is solid is where the pixel's middle sees it.
    const LineOfSight beside = lineThrough(through.at.x, through.at.y);
    line.hits.slabs = slabsAlong(simulation_, state_, beside.origin, beside.direction, line.hits.solid.distance, kReferenceFieldSteps);
    add(through.share);
  }
  return whole;
}

}  // namespace pitviper
