#include "sim/model/scene_fingerprint.hpp"

namespace pitviper {
namespace {

void addTo(Fingerprint& f, const ViewSpectrum& v) {
  f.all(v.viewAngle_rad).all(v.factor).all(v.table.wavelength_um).all(v.table.values).add(v.modifier);
  f.add(static_cast<int>(v.table.view.angle)).add(v.table.view.count).add(v.table.view.last_rad);
  pitviper::addTo(f, v.spectrum);
}

template <class T>
void addTo(Fingerprint& f, const std::optional<T>& value) {
  f.add(value.has_value());
  if (!value) return;
  if constexpr (std::is_same_v<T, Spectrum>) pitviper::addTo(f, *value);
  else addTo(f, *value);
}

void addTo(Fingerprint& f, const Entity& e) {
  const Mesh& m = *e.mesh;
  f.add(e.name).all(m.positions).all(m.normals).all(m.uv).all(m.triangles).add(m.closed);
  for (const MeshPart& p : m.parts) f.add(p.name).add(p.firstTriangle).add(p.triangleCount);
  f.add(static_cast<int>(e.form.kind)).add(e.form.size).add(e.parent);
  for (const Surface& s : e.surfaces) f.add(s.meshPart).add(s.material).add(s.temperature_K).add(s.temperatureTexture);
  pitviper::addTo(f, e.motion);
}

void addTo(Fingerprint& f, const PointLight& l) {
  f.add(l.name).add(l.radius_m).add(l.visible).add(l.parent);
  pitviper::addTo(f, l.intensity);
  pitviper::addTo(f, l.motion);
  f.add(static_cast<double>(l.level.size()));
  for (const auto& [time_s, factor] : l.level) f.add(time_s).add(factor);
}

void addTo(Fingerprint& f, const std::vector<ChannelOutput>& outputs) {
  f.add(static_cast<double>(outputs.size()));
  for (const ChannelOutput& o : outputs) {
    f.add(o.channel).add(o.quantity).add(o.scale).add(o.perEtendue).add(o.perExposure);
    pitviper::addTo(f, o.kernel);
  }
}

void addTo(Fingerprint& f, const SpectralSampling& s) { f.add(s.samples).add(static_cast<int>(s.spacing)).add(s.shared).add(s.accuracy).add(s.reference); }

}  // namespace

void addTo(Fingerprint& f, const Spectrum& s) {
  f.add(static_cast<double>(s.factors().size()));
  for (const Spectrum::Factor& factor : s.factors()) {
    f.add(static_cast<double>(factor.index()));
    if (const auto* c = std::get_if<Spectrum::Constant>(&factor)) f.add(c->value);
    else if (const auto* b = std::get_if<Spectrum::BlackBody>(&factor)) f.add(b->temperature_K).add(b->scale);
    else if (const auto* t = std::get_if<Spectrum::Table>(&factor)) f.all(t->wavelength_um).all(t->value).add(static_cast<int>(t->outside));
  }
}

void addTo(Fingerprint& f, const Motion& m) {
  f.add(m.fixed().position).add(m.fixed().orientation).add(static_cast<int>(m.interpolation())).add(static_cast<double>(m.waypoints().size()));
  for (const Waypoint& w : m.waypoints()) {
    f.add(w.time_s).add(w.position).add(w.roll_rad).add(w.attitude.has_value());
    if (w.attitude) f.add(w.attitude->heading_rad).add(w.attitude->pitch_rad).add(w.attitude->roll_rad);
  }
}

void addTo(Fingerprint& f, const Material& m) {
  f.add(static_cast<double>(m.reflections.size())).all(m.modifiers);
  for (const auto& r : m.reflections) f.add(r->fingerprint());
  addTo(f, m.given);
  addTo(f, m.transmission);
  f.add(m.states.has_value());
  if (m.states) {
    f.add(m.states->texture).add(m.states->low).add(m.states->high).add(static_cast<double>(m.states->entries.size()));
    for (const auto& entry : m.states->entries) addTo(f, *entry);
  }
  f.add(m.medium.has_value());
  if (!m.medium) return;
  addTo(f, m.medium->absorption_per_m);
  addTo(f, m.medium->radiance);
}

void addTo(Fingerprint& f, const Simulation& sim) {
  f.add(static_cast<double>(sim.seed)).add(static_cast<int>(sim.mode)).add(sim.shadows);
  const Geodetic& o = sim.frame.origin();
  f.add(o.latitude_rad).add(o.longitude_rad).add(o.height_m);
  f.add(sim.time.start_s).add(sim.time.step_s).add(sim.time.frames);
  const Limits& l = sim.limits;
  f.add(l.nearest_m).add(l.farthest_m).add(l.coldest_K).add(l.hottest_K).add(l.lightLevel);
  for (const Texture& t : sim.textures) f.all(t.texels).add(t.width).add(t.repeats);
  for (const auto& m : sim.materials) addTo(f, *m);
  f.add(static_cast<double>(sim.entities.size()));
  for (const Entity& e : sim.entities) addTo(f, e);
  f.add(static_cast<double>(sim.lights.size()));
  for (const PointLight& p : sim.lights) addTo(f, p);
  f.add(sim.sun.has_value());
  if (sim.sun) {
    f.add(sim.sun->toSun);
    addTo(f, sim.sun->irradiance);
  }
  addTo(f, sim.ambient);
  addTo(f, sim.background);
  f.add(sim.ground.has_value());
  if (sim.ground) f.add(sim.ground->material).add(sim.ground->temperature_K);
  f.add(sim.air != nullptr);
  if (sim.air) sim.air->addTo(f);
  f.add(static_cast<double>(sim.commands.size()));
  for (const Command& c : sim.commands) f.add(c.at_s).add(c.words);
}

void addTo(Fingerprint& f, const Camera& c) {
  const Pinhole& p = c.pinhole;
  f.add(c.name).add(p.width).add(p.height).add(p.focalLength_m).add(p.pitchX_m).add(p.pitchY_m).add(p.apertureDiameter_m);
  addTo(f, c.mount.motion);
  f.add(c.mount.carrier).add(c.mount.lookAtEntity).add(c.mount.looksAtPoint).add(c.mount.lookAtPoint);
  f.add(c.exposure_s).add(c.near_m).add(c.samples).add(c.smallBody_px).add(c.truth.any()).add(c.truth.solidAngles);
  for (const FilmPlace& l : c.learnt) f.add(l.frame).add(l.column).add(l.row);
  addTo(f, c.spectral);
  addTo(f, c.outputs);
}

void addTo(Fingerprint& f, const Probe& p) {
  f.add(p.name).add(p.position).add(p.normal).add(p.resolution);
  addTo(f, p.spectral);
  addTo(f, p.outputs);
}

}  // namespace pitviper
