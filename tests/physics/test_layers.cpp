// Transparent surfaces through the whole pipeline, against the closed form of N-fold attenuation and emission, in air with camera-origin
// quantities, and against radiance marched along each pixel's ray. All spectra are grey, so that both hold for whole bands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/ray_march.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
const std::string kLw = "[{name: lw, response: {band: [8 um, 12 um]}}]";
double B(double kelvin) { return blackBodyBand(8, 12, kelvin); }

/// A grey layer across the x axis, seen face on.
struct Pane {
  double x = 0.0;  ///< [m]
  double transmittance = 1.0, reflectance = 0.0, kelvin = 0.0;
};

std::string entity(const Pane& p, const std::string& name, double width) {
  std::string material = "{transmission: {transmittance: " + text(p.transmittance) + "}";
  if (p.reflectance > 0.0) material += ", components: [{reflection: lambertian, reflectance: " + text(p.reflectance) + "}]";
  return "  - {name: " + name + ", shape: {model: plate, width: " + text(width) + " m, height: " + text(width) + " m}, material: " + material +
         "}, temperature: " + text(p.kelvin) + " K, position: " + text(glm::dvec3(p.x, 0, 0)) + "}\n";
}

/// N layers before a black plate.
struct Stack {
  std::vector<Pane> panes;  ///< nearest first
  double plate_m = 0.0, plate_K = 400.0, ambient_K = 0.0;
  double extinction_per_m = 0.0, air_K = 0.0;

  std::string yaml(const Eye& eye, double width, unsigned shuffle) const {
    std::vector<std::string> all;
    for (size_t i = 0; i < panes.size(); ++i) all.push_back(entity(panes[i], "p" + std::to_string(i), width));
    all.push_back("  - {name: plate, shape: {model: plate, width: " + text(width) + " m, height: " + text(width) +
                  " m}, material: blackbody, temperature: " + text(plate_K) + " K, position: " + text(glm::dvec3(plate_m, 0, 0)) + "}\n");
    std::shuffle(all.begin(), all.end(), std::mt19937(shuffle));
    std::string y;
    if (extinction_per_m > 0.0) y += "atmosphere: {extinction: " + text(extinction_per_m) + " /m, temperature: " + text(air_K) + " K}\n";
    if (ambient_K > 0.0) y += "ambient: {temperature: " + text(ambient_K) + " K}\n";
    y += "entities:\n";
    for (const auto& e : all) y += e;
    return y + eye.yaml(kLw, "    small_bodies: 0\n");
  }

  double own(const Pane& p) const {
    return (1.0 - p.transmittance - p.reflectance) * (p.kelvin > 0.0 ? B(p.kelvin) : 0.0) + p.reflectance * (ambient_K > 0.0 ? B(ambient_K) : 0.0);
  }
  double tau(double range) const { return std::exp(-extinction_per_m * range); }

  /// Every emitter's radiance times what lies before it, and of each stretch of air L_m (tau(near) - tau(far)) through the panes before it.
  double closedForm(double slant) const {
    const double air = air_K > 0.0 ? B(air_K) : 0.0;
    double sum = 0.0, before = 1.0, from = 0.0;
    for (const Pane& p : panes) {
      sum += before * (air * tau(from * slant) * -std::expm1(-extinction_per_m * (p.x - from) * slant) + own(p) * tau(p.x * slant));
      before *= p.transmittance;
      from = p.x;
    }
    return sum + before * (air * tau(from * slant) * -std::expm1(-extinction_per_m * (plate_m - from) * slant) + B(plate_K) * tau(plate_m * slant));
  }

  double marched(double slant) const {
    std::vector<Sheet> sheets;
    for (const Pane& p : panes) sheets.push_back({p.x * slant, p.transmittance, own(p)});
    const double end = plate_m * slant;
    return march(end, B(plate_K), {{{0.0, end}, extinction_per_m, air_K > 0.0 ? B(air_K) : 0.0}}, sheets);
  }
};

Stack stackOf(int n, double nearest_m, double spacing_m, bool equal, bool air) {
  Stack s;
  std::mt19937 random(static_cast<unsigned>(n) + (equal ? 100u : 0u));
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double mean = std::pow(0.2, 1.0 / n);  // a fifth comes through all
  for (int i = 0; i < n; ++i) {
    Pane p;
    p.x = nearest_m + i * spacing_m;
    p.transmittance = equal ? mean : std::pow(mean, 2.0 * unit(random));
    p.reflectance = equal ? 0.3 * (1.0 - mean) : unit(random) * (1.0 - p.transmittance);
    p.kelvin = equal ? 320.0 : 250.0 + 200.0 * unit(random);
    s.panes.push_back(p);
  }
  s.plate_m = nearest_m + n * spacing_m;
  s.ambient_K = 290.0;
  if (air) s.extinction_per_m = 0.8 / s.plate_m, s.air_K = 270.0;
  return s;
}

void check(const Stack& s, const std::string& what) {
  const Eye eye{{0, 0, 0}, {1, 0, 0}, 0.6, 8};
  const double width = 0.03 * s.plate_m;
  double worst = 0.0, worstMarch = 0.0, worstOrder = 0.0;
  Frame first;
  for (unsigned shuffle : {1u, 2u, 3u}) {
    const Frame f = renderFrame(scene(s.yaml(eye, width, shuffle)));
    if (shuffle == 1) {
      first = f;
      worst = worstError(f, [&](int column, int row) { return s.closedForm(1.0 / eye.ray(column, row).direction.x); });
      worstMarch = worstError(f, [&](int column, int row) { return s.marched(1.0 / eye.ray(column, row).direction.x); });
    } else {
      worstOrder = std::max(worstOrder, worstError(f, [&](int column, int row) { return at(first.layers[0], first, column, row); }));
    }
  }
  bound(what + ", closed form", worst, 1e-5, "N-fold attenuation and emission, camera-origin air; a rounding per layer");
  bound(what + ", march", worstMarch, 1e-5, "Runge-Kutta along the ray");
  bound(what + ", order in the file", worstOrder, 0.0, "the same layers in the same order");
}

TEST(Layers, StacksOfGreyPanes) {
  for (int n : {1, 2, 4, 16, 64}) {
    check(stackOf(n, 10.0, 0.5, false, false), std::to_string(n) + " varied layers");
    check(stackOf(n, 10.0, 0.5, false, true), std::to_string(n) + " varied layers in air");
  }
  for (int n : {4, 64}) check(stackOf(n, 10.0, 0.5, true, true), std::to_string(n) + " equal layers in air");
}

TEST(Layers, SpacingAtAKilometre) {
  for (double spacing : {1.0, 0.03, 0.001}) check(stackOf(8, 1000.0, spacing, false, true), "8 layers at 1 km, spacing " + text(spacing) + " m");
}

// --- transmittance over view angle and place --------------------------------------------------------------------------------------

/// A window in front of a black wall of 400 K, turned by an angle, seen along the x axis at 10 m.
double throughWindow(const std::string& material, double turn_deg, const std::string& more = "", double eyeX = -10.0) {
  const Eye eye{{eyeX, 0, 0}, {0, 0, 0}, 0.02, 5};
  const auto sim =
      scene(more + "entities:\n  - {name: w, shape: {model: plate, width: 4 m, height: 4 m}, heading: " + text(90.0 + turn_deg) +
            " deg, material: " + material + ", temperature: 300 K}\n  - {name: wall, shape: {model: plate, width: 50 m, height: 50 m}, material: blackbody, " +
            "temperature: 400 K, position: [" + text(eyeX < 0 ? 20.0 : -20.0) + " m, 0 m, 0 m]}\n" + eye.yaml(kLw, "    small_bodies: 0\n"));
  const Frame f = renderFrame(sim);
  return at(f.layers[0], f, 2, 2);
}

TEST(Layers, TransmittanceByViewAngle) {
  const std::string rows = "{transmission: {transmittance: 0.8, angular: [[0 deg, 1], [60 deg, 0.5], [90 deg, 0]]}}";
  const std::string table =
      "{transmission: {wavelength: [7 um, 13 um], angles: [{angle: view, count: 4, last: 90 deg}], values: [[0.9, 0.9], [0.7, 0.7], [0.3, 0.3], "
      "[0, 0]]}}";
  for (double turn : {0.0, 17.3, 60.0, 71.25, 85.0, 180.0, 163.0}) {
    const double angle = turn > 90.0 ? 180.0 - turn : turn;
    const double factor = angle < 60.0 ? 1.0 - angle / 120.0 : 0.5 - (angle - 60.0) / 60.0, t = 0.8 * factor;
    figure("window turned by " + text(turn) + " deg, angular rows [W/(m2 sr)]", throughWindow(rows, turn), t * B(400) + (1.0 - t) * B(300), 1e-5,
           "T B(wall) + (1 - T) B(window); linear between rows");
  }
  for (double turn : {0.0, 30.0, 41.0, 75.0}) {
    const double u[] = {0.9, 0.7, 0.3, 0.0};
    const int j = static_cast<int>(turn / 30.0);
    const double t = u[j] + (turn / 30.0 - j) * ((j < 3 ? u[j + 1] : 0.0) - u[j]);
    figure("window turned by " + text(turn) + " deg, table [W/(m2 sr)]", throughWindow(table, turn), t * B(400) + (1.0 - t) * B(300), 1e-5,
           "T B(wall) + (1 - T) B(window); linear between entries");
  }
}

TEST(Layers, EmissivityIsWhatIsLeftUnlessGiven) {
  const std::string ambient = "ambient: {temperature: 280 K}\n", grey = "components: [{reflection: lambertian, reflectance: 0.2}]";
  figure("window of rho 0.2, tau 0.5 [W/(m2 sr)]", throughWindow("{" + grey + ", transmission: {transmittance: 0.5}}", 0.0, ambient),
         0.5 * B(400) + 0.3 * B(300) + 0.2 * B(280), 1e-5, "eps = 1 - rho - tau");
  figure("window of rho 0.2, tau 0.5, eps 0.1 given [W/(m2 sr)]",
         throughWindow("{" + grey + ", transmission: {transmittance: 0.5}, emission: {emissivity: 0.1}}", 0.0, ambient),
         0.5 * B(400) + 0.1 * B(300) + 0.2 * B(280), 1e-5, "eps as given");
  figure("filter that neither emits nor reflects [W/(m2 sr)]", throughWindow("{transmission: {transmittance: 0.25}, emission: {emissivity: 0}}", 0.0),
         0.25 * B(400), 1e-5, "T B(wall)");
  figure("clear window [W/(m2 sr)]", throughWindow("{transmission: {transmittance: 1}}", 0.0), B(400), 1e-5, "B(wall)");
  figure("transmittance 0 [W/(m2 sr)]", throughWindow("{transmission: {transmittance: 0}}", 0.0), B(300), 1e-5, "B(window)");
  figure("mirrored side, emissivity by angle [W/(m2 sr)]",
         throughWindow("{transmission: {transmittance: 0.5}, emission: {emissivity: 0.4, angular: [[0 deg, 1], [60 deg, 0.5]]}}", 150.0),
         0.5 * B(400) + 0.4 * 0.75 * B(300), 1e-5, "eps(30 deg) = 0.4 x 0.75, from behind");
}

// Transmittance times a texture: 0 to 1 across the width, linear between the middles of two texels. Temperature of the window by texture.
TEST(Layers, ModifierTexture) {
  const Eye eye{{20, 0, 0}, {0, 0, 0}, 10.0, 24};
  const auto sim = scene(
      "entities:\n  - {name: w, shape: {model: plate, width: 4 m, height: 4 m}, material: {transmission: {transmittance: 0.8, modifier: {rows: [[0, 1]]}}}, "
      "temperature: {rows: [[350 K]]}}\n"
      "  - {name: wall, shape: {model: plate, width: 50 m, height: 50 m}, material: blackbody, temperature: 400 K, position: [-5 m, 0 m, 0 m]}\n" +
      eye.yaml(kLw, "    small_bodies: 0\n"));
  const double worst = worstError(renderFrame(sim), [&](int column, int row) {
    const Line ray = eye.ray(column, row);
    const glm::dvec3 p = ray.at(-20.0 / ray.direction.x);
    if (std::max(std::abs(p.y), std::abs(p.z)) > 2.0) return B(400);
    const double t = 0.8 * std::clamp(2.0 * (0.5 + p.y / 4.0) - 0.5, 0.0, 1.0);
    return t * B(400) + (1.0 - t) * B(350);
  });
  bound("window with a textured transmittance, worst pixel", worst, 1e-5, "T(u) B(wall) + (1 - T) B(window); texture coordinates in single precision");
}

// --- light ------------------------------------------------------------------------------------------------------------------------

// f = rho_d/pi + rho_s (n + 2)/(2 pi) cos^n(alpha), air on both legs: L = f I cos/d2 exp(-g (d + R)) + T B(wall) tau + air.
TEST(Layers, LitPaneInAir) {
  const double g = 0.02, n = 20.0, rhoD = 0.3, rhoS = 0.2, t = 0.4;
  for (double lampX : {4.0, -4.0}) {
    const Eye eye{{12, 0, 0}, {0, 0, 0}, 0.02, 5};
    const auto sim =
        scene("atmosphere: {extinction: " + text(g) +
              " /m, temperature: 280 K}\n"
              "lights: [{name: lamp, intensity: 50 W/(sr um), visible: false, position: [" +
              text(lampX) +
              " m, 3 m, 0 m]}]\n"
              "entities:\n  - {name: w, shape: {model: plate, width: 4 m, height: 4 m}, temperature: 0 K, material: {transmission: {transmittance: 0.4}, "
              "components: [{reflection: lambertian, reflectance: 0.3}, {reflection: phong, reflectance: 0.2, exponent: 20}]}}\n"
              "  - {name: wall, shape: {model: plate, width: 50 m, height: 50 m}, material: blackbody, temperature: 330 K, position: [-8 m, 0 m, 0 m]}\n" +
              eye.yaml(kLw, "    small_bodies: 0\n"));
    const Frame f = renderFrame(sim);
    const double d = 5.0, cosine = 0.8;  // mirrored light makes acos(0.8) with the viewer, who looks along the normal
    const double brdf = rhoD / kPi + rhoS * (n + 2.0) / (2.0 * kPi) * std::pow(cosine, n);
    const double lit = lampX > 0.0 ? brdf * 50.0 * 4.0 * cosine / (d * d) * std::exp(-g * (d + 12.0)) : 0.0;
    const double air = B(280) * (-std::expm1(-g * 12.0) + t * std::exp(-g * 12.0) * -std::expm1(-g * 8.0));
    figure(lampX > 0.0 ? "pane lit from the camera's side [W/(m2 sr)]" : "pane lit from behind [W/(m2 sr)]", at(f.layers[0], f, 2, 2),
           lit + t * B(330) * std::exp(-g * 20.0) + air, 1e-5, "Lambertian + Phong, Beer-Lambert on d + R, T behind; a pixel's own size");
  }
}

// The wall behind a pane is lit too: what it reflects comes through.
TEST(Layers, LitWallBehindAPane) {
  const Eye eye{{12, 0, 0}, {0, 0, 0}, 0.02, 5};
  const auto sim = scene(
      "lights: [{name: lamp, intensity: 50 W/(sr um), visible: false, position: [-5 m, 4 m, 0 m]}]\n"
      "entities:\n  - {name: w, shape: {model: plate, width: 4 m, height: 4 m}, temperature: 300 K, material: {transmission: {transmittance: 0.7}}}\n"
      "  - {name: wall, shape: {model: plate, width: 50 m, height: 50 m}, material: white_lambertian, temperature: 0 K, position: [-8 m, 0 m, 0 m]}\n" +
      eye.yaml(kLw, "    small_bodies: 0\n"));
  const Frame f = renderFrame(sim);
  figure("lit wall behind a pane that is in the dark [W/(m2 sr)]", at(f.layers[0], f, 2, 2), 0.7 / kPi * 50.0 * 4.0 * 0.6 / 25.0 + 0.3 * B(300), 1e-5,
         "T rho/pi I cos/d2 + (1 - T) B");
}

// --- everything at one temperature -------------------------------------------------------------------------------------------------

TEST(Layers, IsothermalEnclosureWithPanesAndMedia) {
  const auto sim = scene(
      "ambient: {temperature: 350 K}\natmosphere: {extinction: 20 /km, temperature: 350 K}\n"
      "materials:\n  glassy: {components: [{reflection: phong, reflectance: 0.2, exponent: 200}, {reflection: lambertian, reflectance: 0.1, modifier: {rows: "
      "[[0, 1], [0.5, 0.2]]}}], transmission: {transmittance: 0.6, angular: [[0 deg, 1], [75 deg, 0.4], [90 deg, 0]], modifier: {rows: [[1, 0.2]]}}}\n"
      "  smoke: {absorption: 0.4 /m}\n  thin: {absorption: 0.001 /m}\n"
      "entities:\n  - {name: wall, shape: {model: sphere, radius: 40 m}, material: white_lambertian, temperature: 350 K}\n"
      "  - {name: a, shape: {model: sphere, radius: 1 m}, material: glassy, temperature: 350 K, position: [-6 m, 1 m, 0 m]}\n"
      "  - {name: b, shape: {model: cone, radius: 1 m, length: 3 m}, material: smoke, temperature: 350 K, position: [-7 m, -2 m, 0 m], heading: 20 deg}\n"
      "  - {name: c, shape: {model: ellipsoid, length: 3 m, width: 2 m, height: 1 m}, material: thin, temperature: 350 K, position: [-5 m, 0 m, 1 m]}\n"
      "  - {name: d, shape: {model: box, length: 3 m, width: 2 m, height: 1 m}, material: smoke, temperature: 350 K, position: [-9 m, 1 m, -2 m], heading: 33 "
      "deg}\n"
      "  - {name: e, shape: {model: plate, width: 6 m, height: 1 m}, material: glassy, temperature: 350 K, position: [-4 m, 0 m, -0.7 m], heading: 60 deg}\n"
      "  - {name: f, shape: {model: sphere, radius: 0.5 m}, material: titanium, temperature: 350 K, position: [-9 m, 1 m, -1.5 m]}\n"
      "  - {name: g, shape: {model: box, length: 20 m, width: 20 m, height: 20 m}, material: thin, temperature: 350 K, heading: 15 deg}\n"
      "cameras:\n  - {name: c, film: {width: 48, height: 48}, field_of_view: 60 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], look_at: [-10 m, 0 m, 0 m], "
      "small_bodies: 0, channels: [{name: lw, response: {band: [8 um, 12 um]}}]}\n");
  const double worst = worstError(renderFrame(sim), [](int, int) { return B(350); });
  bound("isothermal enclosure with transparent surfaces and media, worst pixel", worst, 1e-5, "B(T), flat; a rounding per layer");
}

// --- which is in front ------------------------------------------------------------------------------------------------------------

/// Distance at which a ray meets a rectangle across its own x axis, or NaN.
double meets(const Line& ray, const glm::dvec3& place, const glm::dmat3& axes, double width, double height) {
  const double s = glm::dot(place - ray.origin, axes[0]) / glm::dot(ray.direction, axes[0]);
  const glm::dvec3 p = glm::transpose(axes) * (ray.at(s) - place);
  return s > 0.0 && std::abs(p.y) < 0.5 * width && std::abs(p.z) < 0.5 * height ? s : kNone;
}

struct Placed {
  std::string name;
  glm::dvec3 place{0.0};
  double heading = 90.0, pitch = 0.0, width = 1.0, height = 1.0, transmittance = 1.0, kelvin = 300.0;
  std::string yaml() const {
    return "  - {name: " + name + ", shape: {model: plate, width: " + text(width) + " m, height: " + text(height) + " m}, heading: " + text(heading) +
           " deg, pitch: " + text(pitch) + " deg, position: " + text(place) + ", temperature: " + text(kelvin) +
           " K, material: " + (transmittance > 0.0 ? "{transmission: {transmittance: " + text(transmittance) + "}}" : "blackbody") + "}\n";
  }
};

/// What a ray sees of plates over a black background of 280 K at infinity; transmittance 0 ends it.
double seen(const Line& ray, const std::vector<Placed>& all) {
  std::vector<Sheet> sheets;
  double end = 1e6;
  for (const auto& p : all) {
    const double s = meets(ray, p.place, axesOf(p.heading, p.pitch), p.width, p.height);
    if (!std::isnan(s)) sheets.push_back({s, p.transmittance, (1.0 - p.transmittance) * B(p.kelvin)});
  }
  return march(end, B(280), {}, sheets);
}

/// True where a ray passes within a hundredth of a pixel of an outline: rasterisers place vertices on a grid of 1/256 pixel.
bool atEdge(const Eye& eye, int column, int row, const std::vector<Placed>& all) {
  const Line middle = eye.ray(column, row), right = eye.ray(column + 1, row), up = eye.ray(column, row - 1);
  for (const auto& p : all) {
    int in = 0;
    for (int k = 0; k < 4; ++k) {
      const glm::dvec3 off = 0.01 * ((k & 1) ? right.direction - middle.direction : middle.direction - right.direction) +
                             0.01 * ((k & 2) ? up.direction - middle.direction : middle.direction - up.direction);
      const Line near{middle.origin, glm::normalize(middle.direction + off)};
      in += std::isnan(meets(near, p.place, axesOf(p.heading, p.pitch), p.width, p.height)) ? 0 : 1;
    }
    if (in != 0 && in != 4) return true;
  }
  return false;
}

double worstOf(const Eye& eye, const std::vector<Placed>& all, unsigned shuffle) {
  std::vector<Placed> listed = all;
  std::shuffle(listed.begin(), listed.end(), std::mt19937(shuffle));
  std::string y = "background: {temperature: 280 K}\nentities:\n";
  for (const auto& p : listed) y += p.yaml();
  return worstError(renderFrame(scene(y + eye.yaml(kLw, "    small_bodies: 0\n"))),
                    [&](int column, int row) { return atEdge(eye, column, row, all) ? kNone : seen(eye.ray(column, row), all); });
}

// Sorting by middles would put the small panes before the window, or behind it, wrongly: each lies at an end that is turned away.
TEST(Layers, LargePaneObliquelyAmongSmallOnes) {
  const Eye eye{{0, 0, 0}, {1, 0, 0}, 36.0, 40};
  // The window's right end (y = -4) is 16.8 m away, its left one 23.2 m.
  const Placed window{.name = "window", .place = {20, 0, 0}, .heading = 90.0 - 38.66, .width = 10, .height = 6, .transmittance = 0.3, .kelvin = 420};
  for (double side : {-1.0, 1.0}) {
    const double at = 3.2 * side, depth = 20.0 + at * std::tan(38.66 * kPi / 180.0);
    for (double off : {-0.6, 0.6}) {
      const Placed small{.name = "small", .place = {depth + off, at, 0.5}, .width = 0.8, .height = 0.8, .transmittance = 0.5, .kelvin = 330};
      for (unsigned shuffle : {1u, 4u})
        bound(
            std::string("small pane ") + (off < 0.0 ? "before" : "behind") + " the " + (side < 0.0 ? "near" : "far") + " end of an oblique window, worst pixel",
            worstOf(eye, {window, small}, shuffle), 1e-5, "march; rays through the edges left out");
    }
  }
  // Many small ones on both sides, and a larger pane behind all.
  std::vector<Placed> all{window, {.name = "back", .place = {40, 0, 0}, .width = 12, .height = 12, .transmittance = 0.8, .kelvin = 390}};
  for (int i = 0; i < 14; ++i) {
    const double y = -3.6 + 7.2 * i / 13.0, depth = 20.0 + y * std::tan(38.66 * kPi / 180.0);
    all.push_back({.name = "s" + std::to_string(i),
                   .place = {depth + (i % 2 ? 0.9 : -0.9), y, -1.0 + 0.15 * i},
                   .width = 0.9,
                   .height = 1.4,
                   .transmittance = 0.4 + 0.03 * i,
                   .kelvin = 250.0 + 15.0 * i});
  }
  for (unsigned shuffle : {1u, 2u, 3u}) bound("14 small panes along an oblique window, worst pixel", worstOf(eye, all, shuffle), 1e-5, "march");
}

// Each over the next, the last over the first: no order is right for whole panes. The picture stays what some order gives.
TEST(Layers, RingAndCrossing) {
  const Eye eye{{0, 0, 0}, {1, 0, 0}, 14.0, 40};
  std::vector<Placed> ring;
  // Three strips along the sides of a triangle, one end of each nearer: pitch turns a strip's far end up.
  for (int i = 0; i < 3; ++i) {
    const double turn = 2.0 * kPi * i / 3.0;
    ring.push_back({.name = "r" + std::to_string(i),
                    .place = glm::dvec3(20.0, 0.9 * std::cos(turn), 0.9 * std::sin(turn)),
                    .transmittance = 0.5,
                    .kelvin = 300.0 + 60.0 * i});
  }
  std::string y = "background: {temperature: 280 K}\nentities:\n";
  for (int i = 0; i < 3; ++i)
    y += "  - {name: r" + std::to_string(i) + ", shape: {model: plate, width: 5 m, height: 0.6 m}, heading: 75 deg, roll: " + text(-120.0 * i - 90.0) +
         " deg, position: " + text(ring[static_cast<size_t>(i)].place) + ", temperature: " + text(300.0 + 60.0 * i) +
         " K, material: {transmission: {transmittance: 0.5}}}\n";
  const Frame f = renderFrame(scene(y + eye.yaml(kLw, "    small_bodies: 0\n")));
  double low = 1e30, high = 0.0;
  for (float v : f.layers[0].pixels) low = std::min(low, static_cast<double>(v)), high = std::max(high, static_cast<double>(v));
  EXPECT_GE(low, B(280) * (1.0 - 1e-6));
  EXPECT_LE(high, B(420));
  EXPECT_GT(high, 0.5 * B(420));

  const std::vector<Placed> cross{{.name = "a", .place = {20, 0, 0}, .heading = 50, .width = 6, .height = 4, .transmittance = 0.5, .kelvin = 400},
                                  {.name = "b", .place = {20, 0, 0}, .heading = 130, .width = 6, .height = 4, .transmittance = 0.25, .kelvin = 320}};
  const Frame g =
      renderFrame(scene("background: {temperature: 280 K}\nentities:\n" + cross[0].yaml() + cross[1].yaml() + eye.yaml(kLw, "    small_bodies: 0\n")));
  int neither = 0;
  for (int row = 0; row < g.height; ++row)
    for (int column = 0; column < g.width; ++column) {
      if (atEdge(eye, column, row, cross)) continue;
      const Line ray = eye.ray(column, row);
      const double got = at(g.layers[0], g, column, row);
      const bool a = !std::isnan(meets(ray, cross[0].place, axesOf(50), 6, 4)), b = !std::isnan(meets(ray, cross[1].place, axesOf(130), 6, 4));
      const double la = 0.5 * B(400), lb = 0.75 * B(320);
      const double one = !a ? (b ? 0.25 * B(280) + lb : B(280)) : b ? 0.5 * (0.25 * B(280) + lb) + la : 0.5 * B(280) + la;
      const double other = a && b ? 0.25 * (0.5 * B(280) + la) + lb : one;
      if (std::abs(got / one - 1.0) > 1e-5 && std::abs(got / other - 1.0) > 1e-5) ++neither;
    }
  bound("panes that cross: pixels that neither order gives", neither, 0, "one is drawn before the other as a whole");
}

TEST(Layers, BehindAndBesideSolids) {
  const Eye eye{{0, 0, 0}, {1, 0, 0}, 20.0, 32};
  const std::vector<Placed> all{{.name = "front", .place = {18, 2, 0.3}, .heading = 80, .width = 3, .height = 9, .transmittance = 0.7, .kelvin = 350},
                                {.name = "solid", .place = {20, 1, 0}, .width = 3, .height = 3, .transmittance = 0.0, .kelvin = 310},
                                {.name = "hidden", .place = {22, 1, 0}, .width = 2, .height = 2, .transmittance = 0.4, .kelvin = 500},
                                {.name = "partly", .place = {25, 0, 0}, .heading = 100, .width = 6, .height = 6, .transmittance = 0.6, .kelvin = 450}};
  for (unsigned shuffle : {1u, 2u}) bound("panes before, behind and beside a solid, worst pixel", worstOf(eye, all, shuffle), 1e-5, "march; edges left out");
  // A millimetre before and behind a wall.
  for (double gap : {0.001, -0.001}) {
    const double got = worstOf({{0, 0, 0}, {1, 0, 0}, 0.3, 8},
                               {{.name = "wall", .place = {100, 0, 0}, .width = 4, .height = 4, .transmittance = 0.0, .kelvin = 310},
                                {.name = "pane", .place = {100 - gap, 0, 0}, .width = 4, .height = 4, .transmittance = 0.5, .kelvin = 400}},
                               1);
    bound(std::string("pane 1 mm ") + (gap > 0.0 ? "before" : "behind") + " a wall at 100 m, worst pixel", got, 1e-5, "reversed floating-point depth");
  }
}

// A pane that reaches behind the camera, and one nearer than the near plane.
TEST(Layers, AcrossTheNearPlane) {
  const Eye eye{{0, 0, 0}, {1, 0, 0}, 40.0, 24};
  const std::vector<Placed> all{{.name = "aside", .place = {0, 0.4, 0}, .heading = 5, .width = 30, .height = 30, .transmittance = 0.5, .kelvin = 350},
                                {.name = "wall", .place = {30, 0, 0}, .width = 90, .height = 90, .transmittance = 0.0, .kelvin = 310},
                                {.name = "before", .place = {2, -0.2, 0}, .width = 0.6, .height = 0.6, .transmittance = 0.3, .kelvin = 420},
                                {.name = "behind", .place = {6, 0.6, 0.3}, .width = 0.8, .height = 1, .transmittance = 0.6, .kelvin = 290}};
  bound("pane along the line of sight, past the camera, worst pixel", worstOf(eye, all, 1), 1e-5, "march; edges left out");
  const Frame f =
      renderFrame(scene("background: {temperature: 280 K}\nentities:\n" +
                        Placed{.name = "near", .place = {0.05, 0, 0}, .transmittance = 0.5, .kelvin = 400}.yaml() + eye.yaml(kLw, "    small_bodies: 0\n")));
  bound("pane nearer than the near plane is not drawn", worstError(f, [](int, int) { return B(280); }), 1e-6, "near: 0.1 m");
}

}  // namespace
}  // namespace pitviper::test
