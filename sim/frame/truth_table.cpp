#include "sim/frame/truth_table.hpp"

#include <algorithm>
#include <cmath>

#include "sim/camera/small_bodies.hpp"
#include "sim/camera/visible_lights.hpp"
#include "sim/camera/zoomed_lines.hpp"
#include "sim/frame/truth_work.hpp"
#include "sim/model/stage.hpp"
#include "sim/plan/budget.hpp"
#include "sim/plan/measured_outputs.hpp"
#include "sim/plan/planner.hpp"
#include "sim/render/reference/reference_pixel.hpp"
#include "sim/render/reference/zoomed_tile.hpp"
#include "sim/world/field_states.hpp"
#include "sim/world/light_legs.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// Times between which rates are differences.
constexpr double kApart_s = 1e-3;

/// Where no accuracy is asked for, and of the reference, which has none.
constexpr double kAskedOtherwise = 0.002;
/// Lines across a body for 1 %, and between two of them where what they meet changes: an area of a thirtieth of its diameter is then off by 1 % (see
/// zoomedLines()).
constexpr double kLinesAtOnePercent = 128.0;
constexpr int kWithin = 6;

bool meets(const RayHits& hits, int entity) {
  return hits.solid.entity == entity || std::any_of(hits.layers.begin(), hits.layers.end(), [&](const Hit& h) { return h.entity == entity; }) ||
         std::any_of(hits.stretches.begin(), hits.stretches.end(), [&](const Stretch& s) { return s.entity == entity; });
}

bool isRadiance(const ChannelOutput& o) { return o.quantity == "radiance"; }

}  // namespace

TruthMeter::TruthMeter(const Simulation& simulation, const Camera& camera)
    : simulation_(simulation),
      camera_(camera),
      measured_(measuredOutputs(simulation, camera)),
      asked_(camera.spectral.accuracy > 0.0 ? camera.spectral.accuracy : kAskedOtherwise),
      lines_(std::clamp(kLinesAtOnePercent * std::pow(0.01 / asked_, 2.0 / 3.0), 48.0, 256.0)),
      present_(simulation.entities.size(), 1),
      plan_(measuredPlanFor(simulation, drawnCamera(camera))),
      spectra_(std::make_shared<const NodeSpectra>(simulation, plan_.nodes, plan_.terms)),
      lost_(simulation, camera, measured_, plan_, spectra_) {
  if (camera.mount.carrier >= 0) present_[static_cast<std::size_t>(camera.mount.carrier)] = 0;
  for (std::size_t o = 0; o < measured_.size(); ++o)
    if (isRadiance(measured_[o])) radianceOf_.push_back(o);
}

TargetRow TruthMeter::placed(const std::string& name, const char* kind, const Moment& now, const Moment& before, const Moment& after) const {
  TargetRow row;
  row.name = name;
  row.kind = kind;
  row.left = row.top = row.right = row.bottom = row.column = row.row = NAN;
  const CameraState eye = cameraAt(camera_, now.state);
  const glm::dvec3 line = now.place - eye.pose.position, lineBefore = before.place - cameraAt(camera_, before.state).pose.position,
                   lineAfter = after.place - cameraAt(camera_, after.state).pose.position;
  row.range_m = glm::length(line);
  row.rangeRate_m_s = (glm::length(lineAfter) - glm::length(lineBefore)) / (2.0 * kApart_s);
  const glm::dmat3 local = localFromCamera(eye.pose);
  if (glm::length(lineAfter) > 0.0 && glm::length(lineBefore) > 0.0) {
    const glm::dvec3 turn = (glm::normalize(lineAfter) - glm::normalize(lineBefore)) / (2.0 * kApart_s);
    row.sightRight_rad_s = glm::dot(turn, local[0]);
    row.sightUp_rad_s = glm::dot(turn, local[1]);
  }
  const glm::dvec3 seen = glm::transpose(local) * line;
  if (seen.z < 0.0) {
    const Pinhole& p = eye.pinhole;
    const glm::dvec2 at =
        placeOnFilm(camera_, p.focalLength_m,
                    {0.5 * p.width + seen.x / -seen.z * p.focalLength_m / p.pitchX_m, 0.5 * p.height - seen.y / -seen.z * p.focalLength_m / p.pitchY_m});
    row.column = at.x;
    row.row = at.y;
  }
  return row;
}

void TruthMeter::addChannels(TargetRow& row, const std::vector<double>& own, const std::vector<double>& total, const std::vector<double>& contrast,
                             double body_sr, const WorldState& state, const std::vector<double>& faces_sr) const {
  const CameraState eye = cameraAt(camera_, state);
  const Pinhole& p = eye.pinhole;
  const double pixel_sr = p.projectedSolidAngle_sr(p.width / 2, p.height / 2), range2 = row.range_m * row.range_m;
  for (std::size_t r : radianceOf_) {
    const auto slot = static_cast<std::size_t>(plan_.slotOfOutput[r]);
    TargetRow::Channel c;
    c.channel = measured_[r].channel;
    c.unit = "W/sr";
    c.own = own[slot], c.total = total[slot], c.contrast = contrast[slot];
    c.signalToNoise = NAN;
    const DetectorLaw* law = detectorOf(camera_, c.channel);
    const double exposure_s = eye.exposures_s.of(c.channel);
    const auto detected = std::find_if(measured_.begin(), measured_.end(), [&](const ChannelOutput& o) { return o.detected && o.channel == c.channel; });
    if (law && detected != measured_.end() && range2 > 0.0) {
      const auto counted = static_cast<std::size_t>(plan_.slotOfOutput[static_cast<std::size_t>(detected - measured_.begin())]);
      const double perFlux = law->fillFactor * detected->scale * exposure_s;  // electrons of kernel integral x sr
      // All of it in one pixel where it is smaller than one, but for what the lens spreads; else a pixel's part of its face.
      const double face_sr = faces_sr.empty() ? body_sr : faces_sr[row.channels.size()];
      const double pixels = std::max(face_sr / pixel_sr, 1.0 / pixelShareOf(camera_, *detected, p.focalLength_m)),
                   signal = perFlux * contrast[counted] / range2 / pixels;
      const double behind = body_sr > 0.0 ? perFlux * pixel_sr * (total[counted] - contrast[counted]) / range2 / body_sr : 0.0;
      const double own_e = law->fillFactor * ownLightOf(camera_, *detected, pixel_sr, exposure_s), dark = law->darkCurrent_per_s * exposure_s;
      const double variance = std::max(0.0, behind + std::max(0.0, signal)) + own_e + dark + law->readoutVariance(simulation_.time.step_s);
      // A best pixel that is full tells nothing of it.
      if (std::max(0.0, behind + std::max(0.0, signal)) + own_e + dark < law->saturation(eye.gains.of(c.channel)))
        c.signalToNoise = signal / std::sqrt(variance);
    }
    row.channels.push_back(c);
  }
}

void TruthMeter::addBody(TargetRow& row, int entity, const WorldState& state) const {
  const auto e = static_cast<std::size_t>(entity);
  const View film = cameraView(camera_, state, 1);
  const Ball ball = ballOf(simulation_, state, entity);
  const auto slots = static_cast<std::size_t>(plan_.slotCount);
  const glm::dvec3 ahead = glm::transpose(film.localFromCamera) * (ball.centre - film.position);
  if (glm::length(ahead) <= 1.01 * ball.radius_m) {
    const std::vector<double> none(slots, NAN);
    row.visible = NAN;
    addChannels(row, none, none, none, 0.0, state);
    return;
  }
  std::vector<double> own(slots, 0.0), total = own, contrast = own;
  // With all that is drawn around the film: a lens may bring it in.
  if (!mayShow(cameraView(drawnCamera(camera_), state, 1), ball.centre, ball.radius_m)) {
    addChannels(row, own, total, contrast, 0.0, state);
    return;
  }
  const int size = evenSize(lines_);
  View z = zoomedView(ball, film, size);
  z.onlyEntity = -1;
  const CameraState eye = cameraAt(camera_, state);
  const glm::dmat3 filmFromZoom = glm::transpose(film.localFromCamera) * z.localFromCamera;
  std::vector<char> others = present_;
  others[e] = 0;
  const ReferenceShader with(simulation_, plan_, z, state, present_, spectra_), without(simulation_, plan_, z, state, others, spectra_);
  const auto lineThrough = [&](double x, double y, const std::vector<char>& drawn) {
    const glm::dvec3 ray = z.ray(x, y);
    LineOfSight line{z.position, z.localFromCamera * ray / glm::length(ray), {}, 0.0};
    line.hits = castRay(simulation_, state, line.origin, line.direction, z.near_m * glm::length(ray), &drawn);
    return line;
  };
  // What it has of all, of the body, and of what it would have without it.
  const auto sumsThrough = [&](double x, double y, const Plan& plan, const ReferenceShader& all, const ReferenceShader& rest, NodeSum& sum, NodeSum& behind) {
    std::vector<double> sums = all.shade(lineThrough(x, y, present_), sum).slots;
    const std::vector<double> ofBody = slotsOf(plan, sum.ofEntity()), other = rest.shade(lineThrough(x, y, others), behind).slots;
    sums.insert(sums.end(), ofBody.begin(), ofBody.end());
    sums.insert(sums.end(), other.begin(), other.end());
    return sums;
  };
  const auto slotsThrough = [&](double x, double y, NodeSum& sum, NodeSum& behind) { return sumsThrough(x, y, plan_, with, without, sum, behind); };
  /// Where a direction before the film is on it, distorted.
  const auto onFilm = [&](const glm::dvec3& direction) {
    const glm::dvec2 at = filmPosition(film, direction);
    return placeOnFilm(camera_, eye.pinhole.focalLength_m, {at.x, film.height - at.y});
  };
  const glm::ivec4 window = camera_.window.value_or(glm::ivec4(0, 0, film.width, film.height));
  const auto isOnFilm = [&](const glm::dvec2& at) { return at.x >= window.x && at.y >= window.y && at.x < window.x + window.z && at.y < window.y + window.w; };
  double whole_sr = 0.0, visible_sr = 0.0, seen_sr = 0.0;
  const int columns = (size + ZoomedTile::kSize - 1) / ZoomedTile::kSize;
  struct Sums {
    std::vector<double> own, total, contrast;
    double whole = 0.0, visible = 0.0, seen = 0.0, left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
    std::vector<TargetLine> lines;
  };
  std::vector<Sums> pieces(static_cast<std::size_t>(columns * columns));
  eachPiece(columns * columns, [&](int piece) {
    NodeSum sum(*spectra_), behind(*spectra_);
    sum.watchEntity(entity);
    std::vector<double> ownHere(slots, 0.0), totalHere = ownHere, contrastHere = ownHere;
    double wholeHere = 0.0, visibleHere = 0.0, seenHere = 0.0, left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
    const auto solidAngle = [&](int x, int y) {
      const glm::dvec3 ray = z.ray(x + 0.5, y + 0.5);
      return z.tanPerPixelX * z.tanPerPixelY / std::pow(glm::dot(ray, ray), 1.5);
    };
    // What a line of a place between the grid's meets, with the body and without: 0 where it does not meet it, or is not on the film.
    const auto thingsAt = [&](double x, double y) -> std::size_t {
      const glm::dvec3 ray = z.ray(x, y), direction = z.localFromCamera * ray / glm::length(ray);
      const double near = z.near_m * glm::length(ray);
      if (!meetsBody(simulation_, state, z.position, direction, near, entity)) return 0;
      const glm::dvec3 seen = filmFromZoom * ray;
      if (seen.z >= 0.0) return 0;
      const glm::dvec2 at = onFilm(seen);
      if (!isOnFilm(at)) return 0;
      const RayHits hits = castRay(simulation_, state, z.position, direction, near, &present_, false, 0);
      if (!meets(hits, entity)) return 0;
      return ReferenceShader::things(hits) * 31 +
             ReferenceShader::things(castRay(simulation_, state, z.position, direction, near, &others, false, kPlannedFieldSteps));
    };
    const int x0 = piece % columns * ZoomedTile::kSize, y0 = piece / columns * ZoomedTile::kSize, w = std::min(ZoomedTile::kSize, size - x0),
              h = std::min(ZoomedTile::kSize, size - y0);
    std::vector<std::size_t> things(static_cast<std::size_t>(w * h), 0);
    std::vector<std::vector<double>> seen(things.size());
    const auto indexOf = [&](int x, int y) { return static_cast<std::size_t>((y - y0) * w + (x - x0)); };
    ZoomedTile tile(
        [&](int x, int y) -> std::size_t {
          const glm::dvec3 ray = z.ray(x + 0.5, y + 0.5);
          if (!meetsBody(simulation_, state, z.position, z.localFromCamera * ray / glm::length(ray), z.near_m * glm::length(ray), entity)) return 0;
          wholeHere += solidAngle(x, y);
          if (const glm::dvec3 place = filmFromZoom * ray; place.z < 0.0) {
            const glm::dvec2 at = onFilm(place);
            left = std::min(left, at.x), right = std::max(right, at.x), top = std::min(top, at.y), bottom = std::max(bottom, at.y);
          }
          const std::size_t met = thingsAt(x + 0.5, y + 0.5);
          things[indexOf(x, y)] = met;
          if (met != 0) visibleHere += solidAngle(x, y);
          return met;
        },
        [&](int x, int y) { return slotsThrough(x + 0.5, y + 0.5, sum, behind); }, budget::kTruthPlaces.of(asked_));
    tile.fill(x0, y0, w, h, [&](int x, int y, const std::vector<double>& all) { seen[indexOf(x, y)] = all; });
    std::vector<TargetLine> lines;
    const auto add = [&](const std::vector<double>& all, double sr, std::size_t met, const glm::dvec2& at) {
      seenHere += sr;
      TargetLine line{met, at, sr, std::vector<double>(slots)};
      for (std::size_t s = 0; s < slots; ++s) {
        line.contrast[s] = all[s] - all[2 * slots + s];
        totalHere[s] += sr * all[s];
        ownHere[s] += sr * all[slots + s];
        contrastHere[s] += sr * line.contrast[s];
      }
      lines.push_back(std::move(line));
    };
    for (int y = y0; y < y0 + h; ++y)
      for (int x = x0; x < x0 + w; ++x) {
        const std::size_t met = things[indexOf(x, y)];
        bool isEdge = false;
        const auto eachNeighbour = [&](const auto& visit) {
          for (int j = std::max(y - 1, y0); j <= std::min(y + 1, y0 + h - 1); ++j)
            for (int i = std::max(x - 1, x0); i <= std::min(x + 1, x0 + w - 1); ++i) visit(indexOf(i, j));
        };
        eachNeighbour([&](std::size_t k) { isEdge |= things[k] != met; });
        if (!isEdge) {
          if (met != 0) add(seen[indexOf(x, y)], solidAngle(x, y), met, {x + 0.5, y + 0.5});
          continue;
        }
        // Where a small hot part ends, areas are what counts: many lines say which, each has the light of a neighbour that meets the same.
        const double sr = solidAngle(x, y) / (kWithin * kWithin);
        for (int j = 0; j < kWithin; ++j)
          for (int i = 0; i < kWithin; ++i) {
            const glm::dvec2 at(x + (i + 0.5) / kWithin, y + (j + 0.5) / kWithin);
            const std::size_t here = thingsAt(at.x, at.y);
            if (here == 0) continue;
            const std::vector<double>* light = nullptr;
            if (here == met) light = &seen[indexOf(x, y)];
            else eachNeighbour([&](std::size_t k) { light = !light && things[k] == here ? &seen[k] : light; });
            add(light ? *light : slotsThrough(at.x, at.y, sum, behind), sr, here, at);
          }
      }
    pieces[static_cast<std::size_t>(piece)] = {ownHere, totalHere, contrastHere, wholeHere, visibleHere, seenHere, left, top, right, bottom, std::move(lines)};
  });
  // In their order, whichever was done first: the same bits every time.
  std::vector<TargetLine> lines;
  for (const Sums& p : pieces) {
    whole_sr += p.whole, visible_sr += p.visible, seen_sr += p.seen;
    if (p.left <= p.right) {
      row.left = std::fmin(row.left, p.left), row.right = std::fmax(row.right, p.right);
      row.top = std::fmin(row.top, p.top), row.bottom = std::fmax(row.bottom, p.bottom);
    }
    for (std::size_t s = 0; s < slots; ++s) own[s] += p.own[s], total[s] += p.total[s], contrast[s] += p.contrast[s];
    lines.insert(lines.end(), p.lines.begin(), p.lines.end());
  }
  lost_.addTo({&total, &own, &contrast}, lines, [&](const glm::dvec2& at, const Plan& plan, const std::shared_ptr<const NodeSpectra>& spectra) {
    const ReferenceShader all(simulation_, plan, z, state, present_, spectra), rest(simulation_, plan, z, state, others, spectra);
    NodeSum sum(*spectra), behind(*spectra);
    sum.watchEntity(entity);
    std::vector<double> sums = sumsThrough(at.x, at.y, plan, all, rest, sum, behind);
    const std::size_t count = sums.size() / 3;
    for (std::size_t s = 0; s < count; ++s) sums[2 * count + s] = sums[s] - sums[2 * count + s];
    return sums;
  });
  row.visible = whole_sr > 0.0 ? visible_sr / whole_sr : 0.0;
  const double range2 = row.range_m * row.range_m;
  for (auto* sums : {&own, &total, &contrast})
    for (double& v : *sums) v *= range2;
  addChannels(row, own, total, contrast, seen_sr, state);
}

void TruthMeter::addLamp(TargetRow& row, std::size_t light, const WorldState& state) const {
  const View film = cameraView(camera_, state, 1);
  const glm::dvec3 line = state.lights[light] - film.position;
  const double range = glm::length(line);
  const glm::dvec3 seen = glm::transpose(film.localFromCamera) * line;
  std::vector<double> sums(static_cast<std::size_t>(plan_.slotCount), 0.0);
  const glm::ivec4 window = camera_.window.value_or(glm::ivec4(0, 0, film.width, film.height));
  const bool isOnFilm = row.column >= window.x && row.row >= window.y && row.column < window.x + window.z && row.row < window.y + window.w;
  if (isOnFilm && -seen.z >= film.near_m && lightIsInView(simulation_, state, cameraView(drawnCamera(camera_), state, 1), light)) {
    const auto sumsBy = [&](const Plan& plan) {
      const auto way = WaysToLights(simulation_, plan).from(state, present_, film.position, line / range, range, film.near_m * range / -seen.z);
      return way.empty() ? std::vector<double>() : apparentIntensity(simulation_, plan, state, light, film.position, way);
    };
    if (std::vector<double> seenOf = sumsBy(plan_); !seenOf.empty()) {
      sums = std::move(seenOf);
      row.visible = 1.0;
      lost_.addTo({&sums}, {{0, {}, 1.0, sums}}, [&](const glm::dvec2&, const Plan& plan, const auto&) { return sumsBy(plan); });
    }
    row.left = row.right = row.column;
    row.top = row.bottom = row.row;
  }
  addChannels(row, sums, sums, sums, 0.0, state);
}

std::vector<TargetRow> TruthMeter::targets(const WorldState& state, const StateAt& stateAt) const {
  std::vector<TargetRow> rows;
  const auto at = [&](double t) { return stateAt ? stateAt(t) : advance(simulation_, t); };
  const WorldState earlier = at(state.time_s - kApart_s), later = at(state.time_s + kApart_s);
  for (std::size_t e = 0; e < simulation_.entities.size(); ++e) {
    const Entity& body = simulation_.entities[e];
    if (!present_[e] || !state.isThere(e) || body.mesh->heightField) continue;
    const int entity = static_cast<int>(e);
    rows.push_back(placed(body.name, simulation_.mediumOf(body) ? "medium" : "body", {state, ballOf(simulation_, state, entity).centre},
                          {earlier, ballOf(simulation_, earlier, entity).centre}, {later, ballOf(simulation_, later, entity).centre}));
    addBody(rows.back(), entity, state);
  }
  for (std::size_t f = 0; f < simulation_.fields.size(); ++f) {
    const FieldState* now = fieldOf(state, f);
    const std::string kind = simulation_.fields[f].source->target();
    if (!now || kind.empty()) continue;
    const auto placeOf = [](const FieldState& field) { return field.origin + field.localFromField * field.source; };
    const FieldState *before = fieldOf(earlier, f), *after = fieldOf(later, f);
    const glm::dvec3 here = placeOf(*now),
                     from = before  ? placeOf(*before)
                            : after ? 2.0 * here - placeOf(*after)
                                    : here,
                     to = after ? placeOf(*after) : 2.0 * here - from;
    rows.push_back(placed(simulation_.fields[f].name, kind.c_str(), {state, here}, {earlier, from}, {later, to}));
    addField(rows.back(), f, state);
  }
  for (std::size_t l = 0; l < simulation_.lights.size(); ++l) {
    if (!simulation_.lights[l].visible) continue;
    rows.push_back(placed(simulation_.lights[l].name, "lamp", {state, state.lights[l]}, {earlier, earlier.lights[l]}, {later, later.lights[l]}));
    addLamp(rows.back(), l, state);
  }
  // Bodies, plumes and lamps may share a name: later ones say what they are.
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (std::any_of(rows.begin(), rows.begin() + static_cast<long>(k), [&](const TargetRow& r) { return r.name == rows[k].name; }))
      rows[k].name += "_" + rows[k].kind;
  return rows;
}

std::vector<FrameLayer> TruthMeter::terms(const WorldState& state) const {
  const View film = cameraView(camera_, state, 1);
  const ReferenceShader shader(simulation_, plan_, film, state, present_, spectra_);
  constexpr const char* kNames[kTermKinds] = {"emission",      "ambient",    "sun",   "lamps",         "air_emission",
                                              "scattered_sun", "background", "media", "lamps_in_view", "scattered_again"};
  const std::size_t lamps = simulation_.lights.size(), parts = kTermKinds + lamps,
                    pixels = static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height);
  std::vector<std::vector<float>> layers(radianceOf_.size() * parts, std::vector<float>(pixels, 0.0f));
  eachPiece(film.height, [&](int y) {
    NodeSum sum(*spectra_);
    sum.keepParts();
    for (int x = 0; x < film.width; ++x) {
      shader.pixel(x, y, sum);
      const std::size_t at = static_cast<std::size_t>(film.height - 1 - y) * static_cast<std::size_t>(film.width) + static_cast<std::size_t>(x);
      for (std::size_t part = 0; part < parts; ++part) {
        if (part == static_cast<std::size_t>(TermKind::Lights)) continue;  // lamp by lamp
        const auto radiance = part < kTermKinds ? sum.part(static_cast<TermKind>(part)) : sum.ofLamp(part - kTermKinds);
        const std::vector<double> slots = slotsOf(plan_, radiance);
        for (std::size_t c = 0; c < radianceOf_.size(); ++c)
          layers[c * parts + part][at] = static_cast<float>(slots[static_cast<std::size_t>(plan_.slotOfOutput[radianceOf_[c]])]);
      }
    }
  });
  const WaysToLights ways(simulation_, plan_);
  const Pinhole now = cameraAt(camera_, state).pinhole;
  for (std::size_t l = 0; l < lamps; ++l) {
    if (!lightIsInView(simulation_, state, film, l)) continue;
    const glm::dvec3 line = state.lights[l] - film.position, seen = glm::transpose(film.localFromCamera) * line;
    const double range = glm::length(line);
    const auto way = ways.from(state, present_, film.position, line / range, range, film.near_m * range / -seen.z);
    if (way.empty()) continue;
    const glm::dvec2 at = filmPosition(film, seen);
    const int column = static_cast<int>(at.x), row = film.height - 1 - static_cast<int>(at.y);
    const auto sums = apparentIntensity(simulation_, plan_, state, l, film.position, way);
    const double perIntensity = -seen.z / range / (range * range) / now.projectedSolidAngle_sr(column, row);
    for (std::size_t c = 0; c < radianceOf_.size(); ++c)
      layers[c * parts + static_cast<std::size_t>(TermKind::LampsInView)]
            [static_cast<std::size_t>(row) * static_cast<std::size_t>(film.width) + static_cast<std::size_t>(column)] +=
          static_cast<float>(perIntensity * sums[static_cast<std::size_t>(plan_.slotOfOutput[radianceOf_[c]])]);
  }
  // By the scene, not by what is in view: all frames have the same layers.
  const auto mayHave = [&](std::size_t part) {
    const Terms t = termsOf(simulation_);
    switch (part < kTermKinds ? static_cast<TermKind>(part) : TermKind::Lights) {
      case TermKind::Ambient:
        return t.ambient;
      case TermKind::Sun:
        return simulation_.sun.has_value();
      case TermKind::AirEmission:
        return t.air;
      case TermKind::ScatteredSun:
        return t.scatteredSun;
      case TermKind::ScatteredAgain:
        return t.streams > 0;
      case TermKind::Media:
        return t.media;
      case TermKind::LampsInView:
        return std::any_of(simulation_.lights.begin(), simulation_.lights.end(), [](const PointLight& l) { return l.visible; });
      default:
        return true;
    }
  };
  std::vector<FrameLayer> told;
  for (std::size_t c = 0; c < radianceOf_.size(); ++c)
    for (std::size_t part = 0; part < parts; ++part) {
      std::vector<float>& layer = layers[c * parts + part];
      if (part == static_cast<std::size_t>(TermKind::Lights) || !mayHave(part)) continue;
      if (part >= kTermKinds && lampOf(simulation_, part - kTermKinds) != part - kTermKinds) continue;
      const std::string name = part < kTermKinds ? std::string(kNames[part]) : "lamp." + simulation_.lights[part - kTermKinds].name;
      told.push_back({"truth.terms." + measured_[radianceOf_[c]].channel + "." + name, "W/(m2 sr)", std::move(layer)});
    }
  return told;
}

}  // namespace pitviper
