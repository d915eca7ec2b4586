#pragma once
// Bodies of grey medium, panes and walls, as a scenario and as what a ray meets: what the tests of media share.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "tests/support/ray_march.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
inline const std::string kLw = "[{name: lw, response: {band: [8 um, 12 um]}}]";
inline double B(double kelvin) { return kelvin > 0.0 ? blackBodyBand(8, 12, kelvin) : 0.0; }

/// A body of grey medium.
struct Cloud {
  std::string shape;
  std::vector<Gauge> gauges{};  ///< convex pieces that don't overlap ...
  std::vector<glm::dvec3> offsets{glm::dvec3(0.0)};  ///< ... and where their middles stand in the body
  double reach = 0.0;
  glm::dvec3 place{0.0};
  double heading = 90.0, pitch = 0.0;
  double absorption = 1.0, kelvin = 400.0, extra = 0.0;  ///< extra radiance, over the band

  double source() const { return B(kelvin) + extra; }
  std::string yaml(const std::string& name) const {
    return "  - {name: " + name + ", shape: " + shape + ", material: {absorption: " + text(absorption) + " /m" +
           (extra > 0.0 ? ", radiance: " + text(extra / 4.0) + " W/(m2 sr um)" : "") + "}, temperature: " + text(kelvin) + " K, position: " + text(place) +
           ", heading: " + text(heading) + " deg, pitch: " + text(pitch) + " deg}\n";
  }
  /// Inside it, from the camera on.
  std::vector<Stretch> stretches(const Line& ray) const {
    std::vector<Stretch> all;
    for (size_t i = 0; i < gauges.size(); ++i) {
      const glm::dmat3 axes = axesOf(heading, pitch);
      Stretch s = chordOf(gauges[i], ray, place + axes * offsets[i], axes, reach);
      s.enter = std::max(s.enter, 0.0);
      if (s.leave > s.enter) all.push_back(s);
    }
    return all;
  }
  double depthOf(const Line& ray) const {
    double sum = 0.0;
    for (const auto& s : stretches(ray)) sum += s.length();
    return absorption * sum;
  }
};

inline Cloud sphere(double radius) {
  return {.shape = "{model: sphere, radius: " + text(radius) + " m}", .gauges = {ellipsoidGauge(glm::dvec3(radius))}, .reach = 2.0 * radius};
}
inline Cloud ellipsoid(double l, double w, double h) {
  return {.shape = "{model: ellipsoid, length: " + text(l) + " m, width: " + text(w) + " m, height: " + text(h) + " m}",
          .gauges = {ellipsoidGauge(0.5 * glm::dvec3(l, w, h))}, .reach = l + w + h};
}
inline Cloud cylinder(double radius, double length) {
  return {.shape = "{model: cylinder, radius: " + text(radius) + " m, length: " + text(length) + " m}", .gauges = {frustumGauge(0.5 * length, radius, radius)},
          .reach = 2.0 * radius + length};
}
inline Cloud cone(double radius, double top, double length) {
  return {.shape = "{model: cone, radius: " + text(radius) + " m, top_radius: " + text(top) + " m, length: " + text(length) + " m}",
          .gauges = {frustumGauge(0.5 * length, radius, top)}, .reach = 2.0 * std::max(radius, top) + length};
}
inline Cloud box(double l, double w, double h) {
  return {.shape = "{model: box, length: " + text(l) + " m, width: " + text(w) + " m, height: " + text(h) + " m}",
          .gauges = {boxGauge(0.5 * glm::dvec3(l, w, h))},
          .reach = l + w + h};
}
inline Cloud placed(Cloud c, const glm::dvec3& place, double heading = 90.0, double pitch = 0.0) {
  c.place = place, c.heading = heading, c.pitch = pitch;
  return c;
}
inline Cloud of(Cloud c, double absorption, double kelvin = 400.0) {
  c.absorption = absorption, c.kelvin = kelvin;
  return c;
}

/// Plates across the x axis that don't end within the picture; transmittance 0: solid.
struct Wall {
  double x = 0.0, transmittance = 0.0, kelvin = 300.0, low = -1e6, high = 1e6;  ///< extent along y
  std::string yaml(const std::string& name, double size) const {
    const double from = std::max(low, -0.5 * size), to = std::min(high, 0.5 * size);
    return "  - {name: " + name + ", shape: {model: plate, width: " + text(to - from) + " m, height: " + text(size) + " m}, material: " +
           (transmittance > 0.0 ? "{transmission: {transmittance: " + text(transmittance) + "}}" : "blackbody") + ", temperature: " + text(kelvin) +
           " K, position: " + text(glm::dvec3(x, 0.5 * (from + to), 0)) + "}\n";
  }
};

struct World {
  Eye eye{{0, 0, 0}, {1, 0, 0}, 12.0, 24};
  std::vector<Cloud> clouds{};
  std::vector<Wall> walls{};
  double background_K = 0.0, extinction = 0.0, air_K = 0.0, wallSize = 1000.0;
  std::string more{};

  std::string yaml(bool withClouds = true) const {
    std::string y = more;
    if (background_K > 0.0) y += "background: {temperature: " + text(background_K) + " K}\n";
    if (extinction > 0.0) y += "atmosphere: {extinction: " + text(extinction) + " /m, temperature: " + text(air_K) + " K}\n";
    y += "entities:\n";
    for (size_t i = 0; withClouds && i < clouds.size(); ++i) y += clouds[i].yaml("c" + std::to_string(i));
    for (size_t i = 0; i < walls.size(); ++i) y += walls[i].yaml("w" + std::to_string(i), wallSize);
    if (walls.empty() && (!withClouds || clouds.empty())) y += Wall{-500}.yaml("unseen", 1.0);
    return y + eye.yaml(kLw, "    small_bodies: 0\n");
  }

  double expected(const Line& ray) const {
    double end = 1e9;
    std::vector<Sheet> sheets;
    std::vector<Fog> fogs;
    double behind = B(background_K);
    for (const Wall& w : walls) {
      const double s = (w.x - ray.origin.x) / ray.direction.x, y = ray.at(s).y;
      if (s <= 0.0 || y < w.low || y > w.high) continue;
      if (w.transmittance > 0.0) sheets.push_back({s, w.transmittance, (1.0 - w.transmittance) * B(w.kelvin)});
      else if (s < end) end = s, behind = B(w.kelvin);
    }
    for (const Cloud& c : clouds)
      for (const auto& s : c.stretches(ray)) fogs.push_back({{s.enter, std::min(s.leave, end)}, c.absorption, c.source()});
    if (extinction > 0.0) fogs.push_back({{0.0, end}, extinction, B(air_K)});
    return march(end, behind, fogs, sheets);
  }

  /// Rays within a hundredth of a pixel of an outline: rasterisers place vertices on a grid of 1/256 pixel.
  bool atEdge(int column, int row) const {
    const Line middle = eye.ray(column, row);
    const glm::dvec3 right = eye.ray(column + 1, row).direction - middle.direction, up = eye.ray(column, row - 1).direction - middle.direction;
    std::array<Line, 4> near;
    for (int k = 0; k < 4; ++k)
      near[static_cast<size_t>(k)] = {middle.origin, glm::normalize(middle.direction + (k & 1 ? 0.01 : -0.01) * right + (k & 2 ? 0.01 : -0.01) * up)};
    for (const Cloud& c : clouds)
      for (size_t i = 0; i < c.gauges.size(); ++i) {
        Cloud one = c;
        one.gauges = {c.gauges[i]}, one.offsets = {c.offsets[i]};
        const auto hits = std::count_if(near.begin(), near.end(), [&](const Line& l) { return one.depthOf(l) > 0.0; });
        if (hits != 0 && hits != 4) return true;
      }
    for (const Wall& w : walls) {
      const auto hits = std::count_if(near.begin(), near.end(), [&](const Line& l) {
        const double y = l.at((w.x - l.origin.x) / l.direction.x).y;
        return y > w.low && y < w.high;
      });
      if (hits != 0 && hits != 4) return true;
    }
    return false;
  }

  double worst(int* covered = nullptr) const {
    return worstError(renderFrame(scene(yaml())), [&](int column, int row) { return atEdge(column, row) ? kNone : expected(eye.ray(column, row)); }, covered);
  }
};

// --- meshes

/// A polygon in the x-y plane (counter-clockwise) between z = 0 and 1, its top triangulated as told.
inline std::string prism(const std::vector<glm::dvec2>& outline, const std::vector<glm::ivec3>& top) {
  std::string obj;
  for (int z = 0; z < 2; ++z)
    for (const auto& p : outline) obj += "v " + text(p.x) + " " + text(p.y) + " " + std::to_string(z) + "\n";
  const int n = static_cast<int>(outline.size());
  auto face = [&](int a, int b, int c) { obj += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n"; };
  for (const auto& t : top) face(t.x + n, t.y + n, t.z + n), face(t.x, t.z, t.y);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    face(i, j, j + n), face(i, j + n, i + n);
  }
  return obj;
}

inline Cloud meshed(const std::string& file, std::vector<std::pair<glm::dvec3, glm::dvec3>> boxes) {
  Cloud c{.shape = "{model: mesh, file: " + file + ", unit: 1 m}", .offsets = {}, .reach = 20.0};
  for (const auto& [low, high] : boxes) c.gauges.push_back(boxGauge(0.5 * (high - low))), c.offsets.push_back(0.5 * (low + high));
  return c;
}

inline Cloud uShape(const TemporaryFolder& folder) {
  // Two arms and what joins them.
  const std::string file = folder.put("u.obj", prism({{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                                                     {{1, 2, 3}, {1, 3, 4}, {0, 1, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}}));
  return meshed(file, {{{0, 0, 0}, {1, 2, 1}}, {{2, 0, 0}, {3, 2, 1}}, {{1, 0, 0}, {2, 1, 1}}});
}

}  // namespace pitviper::test
