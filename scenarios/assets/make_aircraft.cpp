#include "scenarios/assets/make_aircraft.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/mesh_normals.hpp"
#include "sim/scene/mesh_tools.hpp"

namespace pitviper {
namespace {

constexpr double kCrease_rad = 35.0 * kPi / 180.0;  // smooths the lofts' facets, keeps lips and trailing edges sharp

using Ring = std::vector<glm::dvec3>;

/// Superellipse |y/a|^e + |z/b|^e = 1 in a plane across x: 2 is an ellipse, 5 nearly a box. `shear` moves x by shear * z.
struct Section {
  double x, y, z, halfWidth, halfHeight, exponent = 2.0, shear = 0.0;
};

Ring ringOf(const Section& s, int points) {
  Ring ring;
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * kPi * i / points, c = std::cos(angle), q = std::sin(angle);
    const double y = s.halfWidth * std::copysign(std::pow(std::abs(c), 2.0 / s.exponent), c);
    const double z = s.halfHeight * std::copysign(std::pow(std::abs(q), 2.0 / s.exponent), q);
    ring.push_back({s.x + s.shear * z, s.y + y, s.z + z});
  }
  return ring;
}

/// Section at `x` between given ones (x falling), by monotone cubic interpolation of every measure.
Section between(const std::vector<Section>& sections, double x) {
  const auto measure = [&](double Section::*m) {
    const std::size_t n = sections.size();
    const auto slope = [&](std::size_t i) { return (sections[i + 1].*m - sections[i].*m) / (sections[i + 1].x - sections[i].x); };
    std::size_t k = 0;
    while (k + 2 < n && x < sections[k + 1].x) ++k;
    const auto tangent = [&](std::size_t i) {
      if (i == 0) return slope(0);
      if (i + 1 == n) return slope(n - 2);
      const double a = slope(i - 1), b = slope(i);
      return a * b <= 0.0 ? 0.0 : 2.0 * a * b / (a + b);  // harmonic mean: no overshoot (Fritsch, Butland 1984)
    };
    const double h = sections[k + 1].x - sections[k].x, t = (x - sections[k].x) / h;
    const double a = sections[k].*m, b = sections[k + 1].*m;
    return a + t * t * (3.0 - 2.0 * t) * (b - a) + h * t * (1.0 - t) * ((1.0 - t) * tangent(k) - t * tangent(k + 1));
  };
  return {x,
          measure(&Section::y),
          measure(&Section::z),
          measure(&Section::halfWidth),
          measure(&Section::halfHeight),
          measure(&Section::exponent),
          measure(&Section::shear)};
}

/// `steps` rings between each two of the sections.
std::vector<Ring> ringsAlong(const std::vector<Section>& sections, int points, int steps) {
  std::vector<Ring> rings;
  for (std::size_t k = 0; k + 1 < sections.size(); ++k)
    for (int i = k == 0 ? 0 : 1; i <= steps; ++i)
      rings.push_back(ringOf(between(sections, std::lerp(sections[k].x, sections[k + 1].x, static_cast<double>(i) / steps)), points));
  return rings;
}

/// Skin over rings of equally many points. Ends are closed by fans, unless the last ring joins the first (`loop`).
Mesh loft(std::vector<Ring> rings, bool loop = false) {
  if (loop) rings.push_back(rings.front());
  const auto points = static_cast<std::uint32_t>(rings.front().size());
  Mesh mesh;
  const auto add = [&](const glm::dvec3& p, double u, double v) {
    mesh.positions.emplace_back(p);
    mesh.uv.emplace_back(u, v);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
  };
  for (std::size_t j = 0; j < rings.size(); ++j)
    for (std::uint32_t i = 0; i <= points; ++i)
      add(rings[j][i % points], static_cast<double>(j) / static_cast<double>(rings.size() - 1), static_cast<double>(i) / points);
  for (std::uint32_t j = 0; j + 1 < rings.size(); ++j)
    for (std::uint32_t i = 0; i < points; ++i) {
      const std::uint32_t a = j * (points + 1) + i, b = a + points + 1;
      mesh.triangles.emplace_back(a, a + 1, b + 1);
      mesh.triangles.emplace_back(a, b + 1, b);
    }
  for (int end = 0; end < 2 && !loop; ++end) {
    const Ring& ring = end == 0 ? rings.front() : rings.back();
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& p : ring) middle += p / static_cast<double>(points);
    const std::uint32_t centre = add(middle, end, 0.5);
    const auto first = static_cast<std::uint32_t>(end == 0 ? 0 : (rings.size() - 1) * (points + 1));
    for (std::uint32_t i = 0; i < points; ++i) mesh.triangles.emplace_back(centre, first + i + (end == 0 ? 1 : 0), first + i + (end == 0 ? 0 : 1));
  }
  if (signedVolume(mesh) < 0.0)
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0f, 0.0f, 1.0f));
  mesh.parts = {{"all", 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  validateMesh(mesh, {});
  computeNormals(mesh, kCrease_rad);
  mesh.closed = isClosed(mesh);
  return mesh;
}

/// Body around an axis along x: (x, radius) pairs in order; a zero radius is made a needle's, so that rings stay rings.
Mesh revolve(const std::vector<glm::dvec2>& profile, int points, glm::dvec2 axis = {0.0, 0.0}, bool loop = false) {
  std::vector<Ring> rings;
  for (const glm::dvec2& p : profile) rings.push_back(ringOf({p.x, axis.x, axis.y, std::max(p.y, 1e-4), std::max(p.y, 1e-4)}, points));
  return loft(std::move(rings), loop);
}

/// A wing from root to tip. Leading points, chords (backwards along -x), thickness relative to the chord, and the direction
/// in which the thickness goes.
struct Wing {
  glm::dvec3 root, tip;
  double rootChord, tipChord, rootThickness, tipThickness;
  glm::dvec3 up;
};

/// Symmetric four-digit NACA section of unit chord and thickness, trailing edge closed (NACA report 460 with the last
/// coefficient -0.1036), from the point on the trailing edge over the top, round the nose and back. Up to `chord`.
std::vector<glm::dvec2> airfoil(int side, double chord) {
  const auto half = [](double c) {
    return 5.0 * (0.2969 * std::sqrt(c) - 0.1260 * c - 0.3516 * c * c + 0.2843 * c * c * c - 0.1036 * c * c * c * c) + 0.02 * c;
  };  // 0.02: trailing edges have a thickness
  std::vector<glm::dvec2> points;
  for (int i = -side; i <= side; ++i) {
    const double s = std::abs(i) / static_cast<double>(side), c = chord * s * s * (i == 0 ? 0.0 : 1.0);
    points.emplace_back(c, i < 0 ? half(c) : -half(c));
  }
  return points;
}

Mesh loftWing(const Wing& wing, const std::vector<glm::dvec2>& section, double offset_m, const std::vector<double>& stations) {
  std::vector<Ring> rings;
  const glm::dvec3 span = glm::normalize(glm::dvec3(0.0, wing.tip.y - wing.root.y, wing.tip.z - wing.root.z));
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const double t = stations[k];
    // Beyond the tip, the section shrinks to a rounded end.
    const double beyond = std::max(t - 1.0, 0.0), inside = std::min(t, 1.0);
    const double chord = std::lerp(wing.rootChord, wing.tipChord, inside);
    const double thickness = std::lerp(wing.rootThickness, wing.tipThickness, inside) * chord * std::sqrt(std::max(1.0 - beyond * beyond, 0.0));
    const double stretch = 1.0 - 0.25 * beyond * beyond;
    const glm::dvec3 lead = glm::mix(wing.root, wing.tip, inside) + span * (beyond * 0.5 * wing.tipThickness * wing.tipChord);
    Ring ring;
    for (const glm::dvec2& p : section) {
      const glm::dvec2 out = offset_m * glm::dvec2(p.x < 0.02 ? -1.0 : 0.0, p.y > 0.0 ? 1.0 : p.y < 0.0 ? -1.0 : 0.0);
      ring.push_back(lead + glm::dvec3(-(p.x * stretch + 0.12 * (1.0 - stretch)) * chord - out.x, 0.0, 0.0) + wing.up * (p.y * thickness + out.y));
    }
    rings.push_back(std::move(ring));
  }
  return loft(std::move(rings));
}

const std::vector<double> kStations{0.0, 0.25, 0.5, 0.75, 1.0, 1.4, 1.75, 1.95};

/// The wing and, 4 mm proud of it, its leading edge as a body of its own.
void addWing(Mesh& skin, Mesh& edges, const Wing& wing, double edgeChord) {
  appendPart(skin, loftWing(wing, airfoil(12, 1.0), 0.0, kStations), "skin", glm::mat4(1.0f));
  if (edgeChord > 0.0) appendPart(edges, loftWing(wing, airfoil(7, edgeChord), 0.004, {0.0, 0.33, 0.67, 1.0}), "wing_edges", glm::mat4(1.0f));
}

/// Appends `half` and its mirror image across the x-z plane.
void appendBoth(Mesh& into, const Mesh& half, const char* name) {
  glm::mat4 mirror(1.0f);
  mirror[1][1] = -1.0f;
  appendPart(into, half, name, glm::mat4(1.0f));
  appendPart(into, half, name, mirror);
}

}  // namespace

Mesh makeJet() {
  const int around = 36;
  // Fuselage: nose to the beam between the engines.
  const std::vector<Section> fuselage{{7.55, 0, -0.12, 0.015, 0.015},   {7.2, 0, -0.11, 0.11, 0.11},      {6.6, 0, -0.09, 0.25, 0.25},
                                      {5.8, 0, -0.05, 0.40, 0.40},      {5.2, 0, -0.02, 0.48, 0.48},      {4.4, 0, 0.02, 0.55, 0.58, 2.1},
                                      {3.0, 0, 0.05, 0.62, 0.66, 2.3},  {1.5, 0, 0.08, 0.72, 0.66, 2.5},  {-0.5, 0, 0.08, 0.85, 0.60, 2.5},
                                      {-3.0, 0, 0.06, 0.85, 0.50, 2.5}, {-5.5, 0, 0.04, 0.46, 0.32, 2.5}, {-6.0, 0, 0.04, 0.35, 0.26, 2.4},
                                      {-7.0, 0, 0.03, 0.22, 0.12, 2.2}};
  std::vector<Section> nose, rest;
  for (const Section& s : fuselage) {
    if (s.x >= 5.8) nose.push_back(s);
    if (s.x <= 5.8) rest.push_back(s);
  }
  // The radome is as thick as the fuselage where they meet and ends inside it.
  std::vector<Ring> radome = ringsAlong(nose, around, 4);
  radome.push_back(ringOf({5.8 - 0.02, 0, -0.05, 0.36, 0.36}, around));
  std::vector<Ring> hull = ringsAlong(rest, around, 3);

  // One engine's nacelle: box-like at the intake, round at the nozzle; the intake's mouth is raked.
  const double rake = 0.45;
  const std::vector<Section> nacelle{{2.3, 0.98, -0.16, 0.36, 0.46, 7.0, rake}, {1.2, 1.02, -0.16, 0.43, 0.50, 6.0, 0.2},
                                     {-0.5, 1.02, -0.13, 0.52, 0.53, 4.5},      {-2.5, 0.96, -0.08, 0.58, 0.56, 3.2},
                                     {-4.5, 0.88, -0.02, 0.59, 0.58, 2.3},      {-5.96, 0.84, 0.0, 0.565, 0.565, 2.0}};
  // Lip and duct: the intake shows a dark hole.
  const auto intakeSection = [&](double x, double wall) { return Section{x, 0.98, -0.16, 0.366 - wall, 0.466 - wall, 7.0, rake}; };
  std::vector<Ring> intake;
  for (const auto& [x, wall] : {std::pair{2.15, 0.004}, {2.40, 0.0}, {2.44, 0.008}, {2.46, 0.02}, {2.44, 0.032}, {2.2, 0.05}, {1.8, 0.06}, {1.3, 0.07}})
    intake.push_back(ringOf(intakeSection(x, wall), around));
  // The nacelle's own front must not close the hole: it begins as the duct's outside.
  std::vector<Ring> nacelleRings;
  for (const double x : {1.28, 1.8, 2.2}) nacelleRings.push_back(ringOf(intakeSection(x, x < 1.3 ? 0.066 : 0.045), around));
  for (Ring& ring : ringsAlong(nacelle, around, 4)) nacelleRings.push_back(std::move(ring));

  const glm::dvec2 axis(0.84, 0.0);
  const std::vector<glm::dvec2> pipe{{-5.9, 0.50},  {-5.95, 0.55}, {-6.2, 0.565}, {-6.6, 0.545}, {-7.1, 0.485}, {-7.45, 0.43},
                                     {-7.46, 0.41}, {-7.2, 0.42},  {-6.8, 0.44},  {-6.2, 0.46},  {-6.0, 0.46}};
  const Mesh tailpipe = revolve(pipe, around, axis);
  const Mesh liner = revolve({{-6.1, 0.455}, {-7.0, 0.425}, {-7.3, 0.4165}, {-7.3, 0.406}, {-7.0, 0.408}, {-6.1, 0.435}}, around, axis, true);
  const Mesh holder = revolve({{-5.98, 0.45}, {-6.06, 0.45}, {-6.07, 0.25}, {-6.15, 0.24}, {-6.35, 0.17}, {-6.6, 0.07}, {-6.68, 0.0}}, around, axis);

  Mesh skin, edges;
  const glm::dvec3 up(0.0, 0.0, 1.0);
  addWing(skin, edges, {{2.0, 1.0, 0.10}, {-2.35, 5.2, 0.02}, 6.1, 1.35, 0.050, 0.040, up}, 0.06);
  addWing(skin, edges, {{5.0, 0.40, 0.16}, {1.9, 1.25, 0.12}, 6.0, 3.0, 0.020, 0.025, up}, 0.0);  // strake
  addWing(skin, edges, {{-4.55, 1.30, -0.02}, {-6.70, 3.25, -0.08}, 2.35, 0.85, 0.045, 0.040, up}, 0.07);
  const glm::dvec3 finSpan = glm::normalize(glm::dvec3(0.0, 0.75, 2.35));
  const glm::dvec3 finUp(0.0, -finSpan.z, finSpan.y);
  addWing(skin, edges, {{-2.9, 1.02, 0.28}, {-5.35, 1.77, 2.63}, 3.1, 1.15, 0.045, 0.040, finUp}, 0.07);
  appendPart(skin, loft(std::move(nacelleRings)), "skin", glm::mat4(1.0f));

  const std::vector<Section> glass{{4.95, 0, 0.46, 0.03, 0.02}, {4.7, 0, 0.47, 0.19, 0.15}, {4.2, 0, 0.50, 0.34, 0.34}, {3.4, 0, 0.55, 0.42, 0.52},
                                   {2.6, 0, 0.55, 0.40, 0.46},  {1.6, 0, 0.55, 0.28, 0.28}, {0.8, 0, 0.55, 0.10, 0.10}};
  const Mesh canopy = loft(ringsAlong(glass, 28, 3));

  Mesh jet;
  appendPart(jet, loft(std::move(hull)), "skin", glm::mat4(1.0f));
  appendBoth(jet, skin, "skin");
  appendBoth(jet, edges, "wing_edges");
  appendPart(jet, loft(std::move(radome)), "radome", glm::mat4(1.0f));
  appendPart(jet, canopy, "canopy", glm::mat4(1.0f));
  appendBoth(jet, loft(std::move(intake)), "intake");
  appendBoth(jet, tailpipe, "tailpipe");
  appendBoth(jet, liner, "nozzle");
  appendBoth(jet, holder, "nozzle");
  return jet;
}

Mesh makeMissile() {
  const int around = 40;
  const double r = 0.0635;
  Mesh missile;
  // A seeker's dome is a hemisphere a little narrower than the body; a short cone leads from it to the full diameter.
  std::vector<glm::dvec2> dome{{1.36, 0.036}};
  const double domeRadius = 0.044;
  for (int i = 0; i <= 12; ++i) {
    const double angle = 0.5 * kPi * i / 12.0;
    dome.emplace_back(1.40 + domeRadius * std::sin(angle), domeRadius * std::cos(angle));
  }
  appendPart(missile, revolve(dome, around), "dome", glm::mat4(1.0f));
  const std::vector<glm::dvec2> tube{{1.402, 0.040}, {1.402, 0.0455},     {1.39, 0.0465},      {1.30, 0.0545}, {1.20, 0.0605}, {1.10, r},
                                     {0.6, r},       {0.598, r + 0.0015}, {0.582, r + 0.0015}, {0.58, r},      {0.0, r},       {-0.7, r},
                                     {-1.40, r},     {-1.44, 0.058},      {-1.45, 0.052},      {-1.43, 0.046}, {-1.36, 0.032}, {-1.34, 0.030}};
  const Mesh body = revolve(tube, around);
  appendPart(missile, body, "body", glm::mat4(1.0f));
  const auto finSet = [&](const Wing& fin) {
    for (int k = 0; k < 4; ++k) {
      const double angle = 0.25 * kPi + 0.5 * kPi * k;
      glm::mat4 turn(1.0f);
      turn[1] = glm::vec4(0.0f, std::cos(angle), std::sin(angle), 0.0f);
      turn[2] = glm::vec4(0.0f, -std::sin(angle), std::cos(angle), 0.0f);
      appendPart(missile, loftWing(fin, airfoil(8, 1.0), 0.0, kStations), "fins", turn);
    }
  };
  const glm::dvec3 up(0.0, 0.0, 1.0);
  finSet({{1.06, 0.05, 0.0}, {0.88, 0.19, 0.0}, 0.26, 0.06, 0.035, 0.06, up});
  finSet({{-0.86, 0.05, 0.0}, {-1.10, 0.315, 0.0}, 0.56, 0.28, 0.018, 0.022, up});
  const Mesh liner = revolve({{-1.345, 0.0325}, {-1.428, 0.0475}, {-1.428, 0.0435}, {-1.36, 0.0300}, {-1.345, 0.0240}}, around, {0.0, 0.0}, true);
  appendPart(missile, liner, "nozzle", glm::mat4(1.0f));
  appendPart(missile, revolve({{-1.33, 0.026}, {-1.35, 0.026}}, around), "nozzle", glm::mat4(1.0f));
  return missile;
}

}  // namespace pitviper
