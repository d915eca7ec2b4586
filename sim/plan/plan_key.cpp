// What a plan depends on, as bytes for its key.
#include <bit>
#include <cstring>

#include "sim/plan/fine_grid.hpp"
#include "sim/plan/plan_cache.hpp"

namespace pitviper {
namespace {

/// A change of the planner makes old plans strangers.
constexpr double kPlannerVersion = 13;
/// Times at which poses are looked at.
constexpr int kTimes = 17;

class Bytes {
 public:
  void add(double v) { text_.append(reinterpret_cast<const char*>(&v), sizeof v); }
  void add(const glm::dvec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(const glm::dquat& q) { add(q.w), add(q.x), add(q.y), add(q.z); }
  void add(const std::string& s) { add(static_cast<double>(s.size())), text_ += s; }
  template <class T>
  void raw(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(static_cast<double>(values.size()));
    if (!values.empty()) text_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void addMaterial(Bytes& b, const Material& m, const std::vector<double>& grid) {
  for (int texture : m.modifiers) b.add(texture);
  b.add(m.given ? m.given->modifier : -2), b.add(m.transmission ? m.transmission->modifier : -2);
  for (const auto& r : m.reflections) {
    b.add(r->lobeExponent());
    for (const AngleAxis& a : r->axes()) b.add(static_cast<int>(a.angle)), b.add(a.count), b.add(a.last_rad);
  }
  constexpr double kAngles[] = {0.0, 0.4, 0.9, 1.4};
  for (double w : grid) {
    for (double angle : kAngles) {
      for (const auto& r : m.reflections) {
        const auto axes = r->axes();
        b.add(r->column(w, std::min(angle, axes[0].last_rad), std::min(0.7 * angle, axes[1].last_rad)));
      }
      if (m.given) b.add(m.given->at(w, angle));
      if (m.transmission) b.add(m.transmission->at(w, angle));
      if (!m.hemisphericalVaries() && !m.needsAngles()) break;
    }
    if (m.medium) b.add(m.medium->absorption_per_m(w)), b.add(m.medium->radiance ? (*m.medium->radiance)(w) : 0.0);
  }
}

void addBodies(Bytes& b, const Simulation& sim) {
  for (const Entity& e : sim.entities) {
    b.raw(e.mesh->positions), b.raw(e.mesh->triangles);
    b.add(static_cast<int>(e.form.kind)), b.add(e.form.size);
    for (const Surface& s : e.surfaces) b.add(s.meshPart), b.add(s.material), b.add(s.temperature_K), b.add(s.temperatureTexture);
  }
  for (const Texture& t : sim.textures) b.raw(t.texels), b.add(t.width), b.add(t.repeats);
}

void addTimes(Bytes& b, const Simulation& sim, const Eye& eye) {
  const TimeAxis& time = sim.time;
  b.add(time.start_s), b.add(time.step_s), b.add(time.frames);
  for (int k = 0; k < kTimes; ++k) {
    const WorldState state = advance(sim.entities, sim.lights, time.start_s + time.step_s * (time.frames - 1) * k / (kTimes - 1.0));
    for (const Pose& p : state.entities) b.add(p.position), b.add(p.orientation);
    for (const glm::dvec3& p : state.lights) b.add(p);
    for (double level : state.lightLevels) b.add(level);
    if (!eye.camera) continue;
    const Pose pose = cameraPose(eye.camera->mount, state);
    b.add(pose.position), b.add(pose.orientation);
  }
}

}  // namespace

ContentKey planKey(const Simulation& sim, const Plan& outline, const Eye& eye) {
  Bytes b;
  b.add(kPlannerVersion), b.add(static_cast<double>(sim.seed));
  const auto& outputs = eye.camera ? eye.camera->outputs : eye.probe->outputs;
  b.add((eye.camera ? eye.camera->spectral : eye.probe->spectral).accuracy);
  if (eye.camera) {
    const Pinhole& p = eye.camera->pinhole;
    for (double v : {p.tanX(p.width), p.tanY(0), p.pitchX_m / p.focalLength_m, p.pitchY_m / p.focalLength_m, eye.camera->near_m}) b.add(v);
    b.add(eye.camera->samples), b.add(eye.camera->mount.carrier);
  } else {
    b.add(eye.probe->position), b.add(eye.probe->normal), b.add(eye.probe->resolution);
  }
  std::vector<double> grid;
  for (size_t o = 0; o < outputs.size(); ++o) {
    b.add(outline.slotOfOutput[o]);
    for (const QuadratureNode& n : fineGrid(outputs[o].kernel, sim)) b.add(n.x), b.add(n.weight), grid.push_back(n.x);
  }
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  for (const auto& m : sim.materials) addMaterial(b, *m, grid);
  addBodies(b, sim);
  addTimes(b, sim, eye);
  for (double w : grid) {
    if (sim.path) {
      const AirNode n = sim.path->node(w);
      for (size_t k = 0; k < kMostAirAmounts; ++k) b.add(n.extinction[k]), b.add(n.molecules[k]), b.add(n.haze[k]);
      b.add(n.asymmetry), b.add(n.source);
    }
    for (const PointLight& l : sim.lights) b.add(l.intensity(w));
    if (sim.sun) b.add(sim.sun->irradiance(w));
    if (sim.ambient) b.add((*sim.ambient)(w));
    b.add(sim.background(w));
  }
  const Limits& limits = sim.limits;
  for (double v : {limits.nearest_m, limits.farthest_m, limits.coldest_K, limits.hottest_K, limits.lightLevel}) b.add(v);
  for (const PointLight& l : sim.lights) b.add(l.radius_m), b.add(l.visible);
  if (sim.sun) b.add(sim.sun->toSun);
  b.add(sim.ground ? sim.ground->material : -1), b.add(sim.ground ? sim.ground->temperature_K : -1.0);
  b.add(sim.frame.earthRadius_m()), b.add(sim.frame.origin().height_m);
  if (sim.path) {
    // Amounts and temperatures along one line: two airs with the same spectra may differ in their layers.
    b.add(sim.path->top_m());
    for (const AirStation& s : sim.path->stations({sim.frame.height(glm::dvec3(0.0)), 0.1, sim.frame.earthRadius_m()}, 50e3)) {
      b.add(s.height_m), b.add(s.temperature_K);
      for (double a : s.amounts.amount) b.add(a);
    }
    for (double p : sim.path->exponents()) b.add(p);
  }
  return contentKey(b.text());
}

}  // namespace pitviper
