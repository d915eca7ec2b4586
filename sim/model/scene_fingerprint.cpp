#include "sim/model/scene_fingerprint.hpp"

namespace pitviper {
namespace {

// What goes in is bound member by member: a new one does not compile until somebody has said whether pictures depend on it. Names, places in files and
// what follows from other members stay out.

void addTo(Fingerprint& f, const ViewSpectrum& v) {
  const auto& [spectrum, viewAngle_rad, factor, table, model, modifier] = v;
  const auto& [wavelength_um, view, values] = table;
  const auto& [angle, count, last_rad] = view;
  f.all(viewAngle_rad).all(factor).all(wavelength_um).all(values).add(modifier).add(static_cast<int>(angle)).add(count).add(last_rad);
  pitviper::addTo(f, spectrum);
  f.add(model ? model->fingerprint() : std::string());
}

void addTo(Fingerprint& f, const Sun& s);
void addTo(Fingerprint& f, const Medium& m);
void addTo(Fingerprint& f, const MaterialStates& s);

template <class T>
void addTo(Fingerprint& f, const std::optional<T>& value) {
  f.add(value.has_value());
  if (!value) return;
  if constexpr (std::is_same_v<T, Spectrum>) pitviper::addTo(f, *value);
  else addTo(f, *value);
}

void addTo(Fingerprint& f, const Mesh& m) {
  const auto& [positions, normals, uv, triangles, parts, closed, heightField, offset_m, notes] = m;
  f.all(positions).all(normals).all(uv).all(triangles).add(closed).add(offset_m);
  for (const auto& [name, firstTriangle, triangleCount] : parts) f.add(name).add(firstTriangle).add(triangleCount);
}

void addTo(Fingerprint& f, const Lifetime& l) {
  const auto& [begin_s, end_s] = l;
  f.add(begin_s).add(end_s);
}

void addTo(Fingerprint& f, const Entity& e) {
  const auto& [name, mesh, form, surfaces, motion, parent, boundingCentre, boundingRadius_m, meshFile, metresPerUnit, lifetime, flight] = e;
  addTo(f, lifetime);
  f.add(name);
  addTo(f, *mesh);
  const auto& [kind, size] = form;
  f.add(static_cast<int>(kind)).add(size).add(parent);
  for (const auto& [meshPart, material, temperature_K, temperatureTexture, temperature] : surfaces) {
    f.add(meshPart).add(material).add(temperature_K).add(temperatureTexture);
    pitviper::addTo(f, temperature);
  }
  pitviper::addTo(f, motion);
}

void addTo(Fingerprint& f, const Mount& m) {
  const auto& [motion, carrier, lookAtEntity, lookAtLight, looksAtPoint, lookAtPoint, steadied] = m;
  pitviper::addTo(f, motion);
  f.add(carrier).add(lookAtEntity).add(lookAtLight).add(looksAtPoint).add(lookAtPoint);
  f.add(steadied.heading).add(steadied.pitch).add(steadied.roll).add(steadied.heading_rad);
}

void addTo(Fingerprint& f, const PointLight& l) {
  const auto& [name, intensity, pattern, radius_m, visible, mount, offset_m, lamp, level, lifetime, store] = l;
  addTo(f, lifetime);
  f.add(name).add(store).add(radius_m).add(visible).add(offset_m).add(lamp);
  f.add(pattern.function).add(pattern.parameters.x).add(pattern.parameters.y).add(pattern.parameters.z).add(pattern.parameters.w);
  addTo(f, mount);
  pitviper::addTo(f, intensity);
  pitviper::addTo(f, level);
}

void addTo(Fingerprint& f, const Sun& s) {
  const auto& [toSun, irradiance] = s;
  f.add(toSun);
  pitviper::addTo(f, irradiance);
}

void addTo(Fingerprint& f, const Medium& m) {
  const auto& [absorption_per_m, radiance, albedo, asymmetry] = m;
  pitviper::addTo(f, absorption_per_m);
  addTo(f, radiance);
  addTo(f, albedo);
  addTo(f, asymmetry);
}

void addTo(Fingerprint& f, const MaterialStates& s) {
  const auto& [texture, low, high, entries] = s;
  f.add(texture).add(low).add(high).add(static_cast<double>(entries.size()));
  for (const auto& entry : entries) pitviper::addTo(f, *entry);
}

void addTo(Fingerprint& f, const std::vector<ChannelOutput>& outputs) {
  f.add(static_cast<double>(outputs.size()));
  for (const auto& [channel, quantity, unit, where, kernel, scale, perEtendue, perExposure, behindOptics, onFilm, onFilmScale, detected, asTemperature,
                    asSignalToNoise, asDisplay, asMark, temperature, bandLow_um, bandHigh_um, curves, cut, apart] : outputs) {
    f.add(channel).add(apart).add(quantity).add(scale).add(perEtendue).add(perExposure);
    pitviper::addTo(f, kernel);
  }
}

void addTo(Fingerprint& f, const SpectralSampling& s) {
  const auto& [samples, spacing, shared, accuracy, reference, atMost] = s;  // atMost: of streams, whose pictures are of one accuracy each
  f.add(samples).add(static_cast<int>(spacing)).add(shared).add(accuracy).add(reference);
}

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
  f.add(static_cast<int>(m.before())).add(static_cast<int>(m.after())).add(m.path() != nullptr).add(m.spin().has_value());
  if (m.path()) m.path()->addTo(f);
  if (!m.spin()) return;
  const auto& [axis, rate_rad_s, from_s, angle_rad] = *m.spin();
  f.add(axis).add(rate_rad_s).add(from_s);
  addTo(f, angle_rad);
}

void addTo(Fingerprint& f, const Material& m) {
  const auto& [name, provenance, notes, where, reflections, modifiers, given, transmission, medium, states] = m;
  f.add(static_cast<double>(reflections.size())).all(modifiers);
  for (const auto& r : reflections) f.add(r->fingerprint());
  addTo(f, given);
  addTo(f, transmission);
  addTo(f, states);
  addTo(f, medium);
}

void addTo(Fingerprint& f, const Simulation& sim) {
  const auto& [name, file, sha256, content, seed, mode, shadows, alone, audit, frame, time, limits, wind_m_s, textures, materials, entities, lights, fields,
               sun, stars, sunShade, ambient, surroundings, background, ground, air, cameras, probes, commands, stores, sinks] = sim;
  f.add(static_cast<double>(seed)).add(static_cast<int>(mode)).add(shadows);
  const auto& [latitude_rad, longitude_rad, height_m] = frame.origin();
  f.add(latitude_rad).add(longitude_rad).add(height_m).add(frame.ground_m()).add(frame.refraction());
  const auto& [start_s, step_s, frames, epoch_s] = time;
  f.add(start_s).add(step_s).add(frames);
  const auto& [nearest_m, farthest_m, coldest_K, hottest_K, lightLevel] = limits;
  f.add(nearest_m).add(farthest_m).add(coldest_K).add(hottest_K).add(lightLevel).add(wind_m_s);
  for (const auto& [title, width, height, texels, repeats, cells, levels] : textures) f.all(texels).add(width).add(repeats);
  for (const auto& m : materials) addTo(f, *m);
  f.add(static_cast<double>(entities.size()));
  for (const Entity& e : entities) addTo(f, e);
  f.add(static_cast<double>(lights.size()));
  for (const PointLight& p : lights) addTo(f, p);
  f.add(static_cast<double>(fields.size()));
  for (const auto& [title, where, gases, source] : fields) {
    f.add(static_cast<double>(gases.size()));
    for (const auto& [gas, levels] : gases) {
      f.add(static_cast<double>(levels.size()));
      for (const auto& [temperature_K, material] : levels) f.add(temperature_K).add(material);
    }
    source->addTo(f);
  }
  addTo(f, sun);
  f.add(static_cast<double>(stars.size()));
  for (const auto& [star, direction, irradiance] : stars) {
    f.add(direction);
    addTo(f, irradiance);
  }
  f.add(sunShade != nullptr);  // it is that of the fields
  addTo(f, ambient);
  f.add(surroundings != nullptr);
  if (surroundings) surroundings->addTo(f);
  addTo(f, background);
  f.add(ground.has_value());
  if (ground) f.add(ground->material).add(ground->temperature_K);
  f.add(air != nullptr);
  if (air) air->addTo(f);
  f.add(static_cast<double>(commands.size()));
  for (const auto& [at_s, words, change] : commands) f.add(at_s).add(words);
}

void addTo(Fingerprint& f, const Camera& c) {
  const auto& [name, where, pinhole, mount, exposure_s, focalLengthOverTime_m, exposureOverTime_s, near_m, samples, motionBlur, exposureParts, pointsApart,
               binning, window, sharesShading, smallBody_px, zoomedSamples, outlineAccuracy, textureAccuracy, spectral, learnt, plan, planFile, outputs, stages,
               ownChannels, spectralImage, truth, follower] = c;
  const auto& [width, height, focalLength_m, pitchX_m, pitchY_m, apertureDiameter_m] = pinhole;
  f.add(name).add(width).add(height).add(focalLength_m).add(pitchX_m).add(pitchY_m).add(apertureDiameter_m);
  addTo(f, focalLengthOverTime_m);
  addTo(f, exposureOverTime_s);
  addTo(f, mount);
  f.add(exposure_s).add(near_m).add(samples).add(smallBody_px).add(truth.any()).add(truth.solidAngles);
  for (const auto& [number, column, row, pose] : learnt) {
    f.add(number).add(column).add(row).add(pose.has_value());
    if (pose) f.add(pose->position).add(pose->orientation);
  }
  f.add(follower.has_value());
  if (follower) f.add(follower->fingerprint);
  addTo(f, spectral);
  addTo(f, outputs);
  for (const StageChoice& s : stages) f.add(s.fingerprint);
  for (const auto& [channel, own] : ownChannels) {
    f.add(channel).add(own.exposure_s.has_value()).add(own.exposure_s.value_or(0.0));
    addTo(f, own.exposureOverTime_s);
    for (const StageChoice& s : own.stages) f.add(s.fingerprint);
  }
}

void addTo(Fingerprint& f, const Probe& p) {
  const auto& [name, where, position, normal, resolution, spectral, outputs] = p;
  f.add(name).add(position).add(normal).add(resolution);
  addTo(f, spectral);
  addTo(f, outputs);
}

}  // namespace pitviper
