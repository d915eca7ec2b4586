// Lights that do not send alike to all sides: spots and areas, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/world/light_legs.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;

std::string text(double v) { return std::to_string(v); }

/// Accuracies, and what single precision or they allow.
const std::vector<std::pair<std::string, double>> kWays = {{"", 1e-5}, {"accuracy: 1 %\n", 0.01}, {"accuracy: reference\n", 1e-5}};

const std::string kWall =
    "materials: {m: {components: [{reflection: lambertian, reflectance: 0.5}]}}\n"
    "entities: [{name: p, shape: {model: plate, width: 200 m, height: 200 m}, material: m, temperature: 0 K}";

std::string eyeOn(double y, double z, double side = 1.0) {
  const std::string at = text(y) + " m, " + text(z) + " m]";
  return "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [" + text(20.0 * side) + " m, " + at +
         ", look_at: [0 m, " + at + ", channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
}

double radianceOf(const std::string& yaml, int frame = 0) {
  const Frame f = renderFrame(scene(yaml), frame);
  return at(layer(f, "mw.radiance"), f, 4, 4);
}

/// cos^n of a beam angle in degrees.
double beam(double beam_deg, double off_deg) {
  return off_deg < 90.0 ? std::pow(std::cos(off_deg * kDegree), std::log(0.5) / std::log(std::cos(0.5 * beam_deg * kDegree))) : 0.0;
}

std::string spot(double beam_deg, const std::string& rest) {
  return "lights: [{name: l, model: spot, intensity: 7 W/(sr um), beam_angle: " + text(beam_deg) + " deg, " + rest + "}]\n";
}

// A wall 10 m from a spot that shines on it straight, at several angles off its axis: L = rho / pi I cos^n cos^3 / d^2 x 2 um.
TEST(Spot, LightsAWall) {
  for (const auto& [accuracy, allowed] : kWays)
    for (const auto& [beam_deg, off_deg] : {std::pair{40.0, 0.0}, {40.0, 20.0}, {40.0, 35.0}, {120.0, 50.0}, {6.0, 3.0}, {0.5, 0.25}}) {
      const double y = 10.0 * std::tan(off_deg * kDegree), c = std::cos(off_deg * kDegree), share = off_deg == 0.5 * beam_deg ? 0.5 : beam(beam_deg, off_deg);
      figure("under a spot of " + text(beam_deg).substr(0, 5) + " deg, " + text(off_deg).substr(0, 5) + " deg off its axis " + accuracy,
             radianceOf(accuracy + kWall + "]\n" + spot(beam_deg, "position: [10 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m]") + eyeOn(y, 0.0)),
             0.5 / kPi * 7.0 * 2.0 * share * c * c * c / 100.0, std::max(allowed, off_deg < 0.3 ? 2e-4 : 1e-5),
             "rho I cos^n cos^3 / (pi d^2), half of it at half the beam angle; single precision (1e-7 rad of a narrow beam) or the accuracy");
    }
  for (const auto& [accuracy, allowed] : kWays)
    EXPECT_EQ(radianceOf(accuracy + kWall + "]\n" + spot(40.0, "position: [10 m, 0 m, 0 m], look_at: [30 m, 0 m, 0 m]") + eyeOn(3.0, 0.0)), 0.0) << "behind it";
}

// What a pattern sends in all: the integral over directions of cos^n is 2 pi / (n + 1), of a face pi.
TEST(Spot, SendsItsPower) {
  for (const double beam_deg : {0.2, 3.0, 60.0, 120.0, 170.0}) {
    const Simulation sim = scene(kWall + "]\n" + spot(beam_deg, "heading: 0 deg") + eyeOn(0, 0));
    const LightPattern& p = sim.lights[0].pattern;
    const double n = std::log(0.5) / std::log(std::cos(0.5 * beam_deg * kDegree));
    double sum = 0.0;  // over t = (1 - cos) in parts that double
    for (double high = 2.0; high > 1e-14; high *= 0.5)
      for (const auto& t : gaussLegendre(64, 0.5 * high, high)) {
        const double sine = std::sqrt(t.x * (2.0 - t.x));
        sum += 2.0 * kPi * t.weight * p.body(p.parameters, {1.0 - t.x, sine * std::cos(1.0), sine * std::sin(1.0)});
      }
    figure("directions that a spot of " + text(beam_deg).substr(0, 5) + " deg fills [sr]", sum, 2.0 * kPi / (n + 1.0), 1e-5,
           "2 pi / (n + 1); 64 points an octave of 1 - cos");
  }
}

/// Irradiance per micrometre on a plane [W/(m2 um)].
double irradiance(const Simulation& sim, const glm::dvec3& point, const glm::dvec3& normal) {
  const WorldState state = advance(sim, 0.0);
  Hit hit;
  hit.point = point, hit.normal = normal;
  double sum = 0.0;
  for (std::size_t l = 0; l < sim.lights.size(); ++l) sum += lightLeg(sim, state, hit, l).factor * state.lightLevels[l] * sim.lights[l].intensity(4.0);
  return sum;
}

/// Of a rectangle from its corner, facing a parallel element at a distance. Source: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3.
double cornerFactor(double x, double y, double h) {
  const double a = x / h, b = y / h, p = std::sqrt(1.0 + a * a), q = std::sqrt(1.0 + b * b);
  return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2.0 * kPi);
}
double rectangleFactor(double width, double height, double y, double z, double h) {
  const double l = -0.5 * width - y, r = 0.5 * width - y, b = -0.5 * height - z, t = 0.5 * height - z;
  return cornerFactor(r, t, h) - cornerFactor(l, t, h) - cornerFactor(r, b, h) + cornerFactor(l, b, h);
}
/// Of a disc, facing a parallel element off its axis. Source: the same, B-13.
double discFactor(double radius, double off, double h) {
  if (off == 0.0) return radius * radius / (radius * radius + h * h);
  const double hh = h / off, rr = radius / off, z = 1.0 + hh * hh + rr * rr;
  return 0.5 * (1.0 - (z - 2.0 * rr * rr) / std::sqrt(z * z - 4.0 * rr * rr));
}

std::string area(const std::string& form, const std::string& rest = "position: [0 m, 0 m, 0 m], heading: 90 deg") {
  return "lights: [{name: l, model: area, radiance: 11 W/(m2 sr um), " + form + ", " + rest + "}]\n";
}

// E = pi L F, near and far, on the axis and beside the face.
TEST(Area, LightsAsItsFace) {
  struct Case {
    const char* points;
    double distance, allowed;
  };
  for (const Case& c :
       {Case{"", 1.0, 2e-4}, Case{"", 0.5, 1e-2}, Case{", points: 6", 0.5, 4e-4}, Case{", points: 6", 1.0, 1e-6}, Case{", points: 12", 0.25, 1e-3}})
    for (const double off : {0.0, 0.3, 0.5, 1.0, 3.0}) {
      const std::string where = " of " + std::string(c.points[0] ? c.points + 2 : "points: 4") + " at " + text(c.distance).substr(0, 4) + " of its side, " +
                                text(off).substr(0, 3) + " off its axis [W/(m2 um)]";
      const std::string points = c.points, source = "pi L F (Howell); Gauss points, what its key says";
      figure("square" + where,
             irradiance(scene(kWall + "]\n" + area("width: 2 m, height: 2 m" + points) + eyeOn(0, 0)), {2 * c.distance, 2 * off, 0}, {-1, 0, 0}),
             kPi * 11.0 * rectangleFactor(2, 2, 2 * off, 0, 2 * c.distance), c.allowed, source);
      figure("strip" + where,
             irradiance(scene(kWall + "]\n" + area("width: 2 m, height: 40 cm" + points) + eyeOn(0, 0)), {2 * c.distance, 2 * off, 0.6}, {-1, 0, 0}),
             kPi * 11.0 * rectangleFactor(2, 0.4, 2 * off, 0.6, 2 * c.distance), c.allowed, source);
      figure("disc" + where, irradiance(scene(kWall + "]\n" + area("diameter: 2 m" + points) + eyeOn(0, 0)), {2 * c.distance, 0, 2 * off}, {-1, 0, 0}),
             kPi * 11.0 * discFactor(1, 2 * off, 2 * c.distance), c.allowed, source);
    }
  EXPECT_EQ(irradiance(scene(kWall + "]\n" + area("diameter: 2 m") + eyeOn(0, 0)), {-2, 0, 0}, {1, 0, 0}), 0.0) << "behind it";
}

// Drawn: the same on a wall, by GL, planned, and in double.
TEST(Area, LightsAWall) {
  for (const auto& [accuracy, allowed] : kWays)
    for (const double y : {0.0, 1.5}) {
      const std::string there = "position: [3 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m]";
      figure("a wall 3 m from a disc of 2 m, " + text(y).substr(0, 3) + " m off its axis " + accuracy,
             radianceOf(accuracy + kWall + "]\n" + area("diameter: 2 m, points: 6", there) + eyeOn(y, 0.0)), 0.5 * 11.0 * discFactor(1.0, y, 3.0) * 2.0,
             allowed, "rho L F; single precision or the accuracy");
      figure("a wall 3 m from a panel of 2 m by 1 m, " + text(y).substr(0, 3) + " m off its axis " + accuracy,
             radianceOf(accuracy + kWall + "]\n" + area("width: 2 m, height: 1 m, points: 6", there) + eyeOn(y, 0.0)),
             0.5 * 11.0 * rectangleFactor(2.0, 1.0, y, 0.0, 3.0) * 2.0, allowed, "rho L F; single precision or the accuracy");
    }
}

// Whole pictures of rounded, glossy bodies under several lights at once, each kind of program: GL against double.
TEST(Spot, DrawnAsInDouble) {
  const std::string panel = ", {name: d, model: area, radiance: 4 W/(m2 sr um), width: 1 m, height: 50 cm, points: 2, position: [3 m, -2 m, 0 m], look_at: b}",
                    sun = "sun: {azimuth: 60 deg, elevation: 30 deg, irradiance: 3 W/(m2 um)}\n", haze = "atmosphere: {extinction: 50 /km}\n",
                    pane = ", {name: w, shape: {model: plate, width: 2 m, height: 2 m}, material: glass, temperature: 0 K, position: [2 m, 1 m, 0 m]}";
  struct Case {
    const char* name;
    std::string lights, bodies, world;
  };
  for (const Case& c : {Case{"spots and a lamp", "", "", ""},
                        {"spots, a lamp and an area", panel, "", ""},
                        {"the same behind a pane", panel, pane, ""},
                        {"spots behind a pane", "", pane, ""},
                        {"spots in haze", "", "", haze},
                        {"spots, an area and the sun", panel, "", sun}}) {
    const std::string yaml =
        c.world +
        "materials: {m: {components: [{reflection: lambertian, reflectance: 0.3}, {reflection: phong, reflectance: 0.3, exponent: 30}]}, "
        "glass: {components: [{reflection: lambertian, reflectance: 0.2}], transmission: {transmittance: 0.5}}}\n"
        "entities: [{name: b, shape: {model: sphere, radius: 1 m}, material: m, temperature: 0 K}" +
        c.bodies +
        "]\n"
        "lights: [{name: a, model: spot, intensity: 7 W/(sr um), beam_angle: 12 deg, position: [6 m, 2 m, 1 m], look_at: [0 m, 0.4 m, 0.3 m], visible: false}, "
        "{name: b, intensity: 2 W/(sr um), position: [2 m, 0 m, 5 m], visible: false}, "
        "{name: c, model: spot, intensity: 9 W/(sr um), beam_angle: 3 deg, position: [4 m, -3 m, 2 m], look_at: b, visible: false}" +
        c.lights +
        "]\n"
        "cameras: [{name: c, film: {width: 48, height: 48}, field_of_view: 15 deg, aperture: 20 mm, position: [9 m, 0 m, 0 m], look_at: b, "
        "channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
    const Frame drawn = renderFrame(scene(yaml)), told = renderFrame(scene("accuracy: reference\n" + yaml));
    const auto &a = layer(drawn, "mw.radiance").pixels, &b = layer(told, "mw.radiance").pixels;
    const float most = *std::max_element(b.begin(), b.end());
    double worst = 0.0, lit = 0.0;
    for (std::size_t p = 0; p < a.size(); ++p) worst = std::max(worst, static_cast<double>(std::abs(a[p] - b[p]) / most)), lit += b[p] > 0.1f * most;
    EXPECT_GT(lit, 50.0) << c.name;
    bound(std::string("a sphere under ") + c.name + ", of the brightest", worst, 5e-5, "single against double precision");
  }
}

// A spot in view has the flux that it sends that way: on its axis, at half, and none from outside its beam.
TEST(Spot, IsSeenByItsPattern) {
  const auto flux = [](double off_deg, const std::string& accuracy) {
    const std::string at = "[" + text(1000.0 * std::cos(off_deg * kDegree)) + " m, " + text(1000.0 * std::sin(off_deg * kDegree)) + " m, 0 m]";
    return sum(layer(renderFrame(scene(accuracy + spot(20.0, "position: [0 m, 0 m, 0 m], heading: 90 deg") +
                                       "cameras: [{name: c, film: {width: 32, height: 32}, field_of_view: 5 deg, aperture: 20 mm, position: " + at +
                                       ", look_at: [0 m, 0 m, 0 m], channels: [{name: mw, response: {band: [3 um, 5 um]}, output: irradiance}]}]\n")),
                     "mw.irradiance"));
  };
  for (const auto& [accuracy, allowed] : kWays) {
    for (const auto& [off_deg, share] : {std::pair{0.0, 1.0}, {10.0, 0.5}, {17.0, beam(20.0, 17.0)}})
      figure("a spot of 20 deg seen " + text(off_deg).substr(0, 4) + " deg off its axis " + accuracy, flux(off_deg, accuracy), share * 14.0 / 1e6, allowed,
             "I cos^n / R^2; single precision or the accuracy");
    for (const double off_deg : {95.0, 140.0, 180.0}) EXPECT_EQ(flux(off_deg, accuracy), 0.0) << off_deg;
  }
}

// On a body that turns and goes, at a body that goes, and by its own turning.
TEST(Spot, TurnsWithItsMount) {
  const std::string time = "time: {rate: 10 Hz, frames: 6}\n";
  const auto lit = [](double off_deg, double distance, double share) { return 0.5 / kPi * 14.0 * share * std::cos(off_deg * kDegree) / (distance * distance); };
  // A carrier at [10, 0, 0] turns from west (towards the wall) to the right, 100 deg/s: after k tenths its x axis is 10 k deg off.
  const std::string turret = kWall +
                             ", {name: car, shape: {model: sphere, radius: 1 mm}, material: m, temperature: 0 K, position: [10 m, 0 m, 0 m], heading: 270 deg, "
                             "spin: {axis: [0, 0, 1], rate: 100 deg/s}}]\n" +
                             spot(40.0, "attached_to: car, position: [0 m, 0 m, 0 m], heading: 0 deg");
  for (const int frame : {0, 2, 5})
    figure("a wall under a spot on a body that turns, frame " + std::to_string(frame), radianceOf(time + turret + eyeOn(0, 0, 0.25), frame),
           lit(0, 10, beam(40.0, 10.0 * frame)), 1e-5, "its axis 10 deg further every frame");
  // The target goes along the wall, 5 m a tenth: the middle is that far off the axis.
  const std::string tracking =
      kWall +
      ", {name: t, shape: {model: sphere, radius: 1 mm}, material: m, temperature: 0 K, motion: [{time: 0 s, position: [-1 m, 0 m, 0 m]}, {time: 1 s, "
      "position: [-1 m, 50 m, 0 m]}]}]\n" +
      spot(30.0, "position: [10 m, 0 m, 0 m], look_at: t");
  for (const int frame : {0, 1, 2})
    figure("a wall under a spot that looks at a body, frame " + std::to_string(frame), radianceOf(time + tracking + eyeOn(0, 0, 0.25), frame),
           lit(0, 10, beam(30.0, std::atan2(5.0 * frame, 11.0) / kDegree)), 1e-5, "off its axis by the body's angle");
  // By a spin of its own, about its z axis.
  const std::string turning = kWall + "]\n" + spot(30.0, "position: [10 m, 0 m, 0 m], heading: 270 deg, spin: {axis: [0, 0, 1], rate: 50 deg/s}");
  for (const int frame : {0, 3})
    figure("a wall under a spot that turns, frame " + std::to_string(frame), radianceOf(time + turning + eyeOn(0, 0, 0.25), frame),
           lit(0, 10, beam(30.0, 5.0 * frame)), 1e-5, "its axis 5 deg further every frame");
  // A panel on a body goes and turns with it, all its points.
  const std::string panel = kWall +
                            ", {name: car, shape: {model: sphere, radius: 1 mm}, material: m, temperature: 0 K, position: [0 m, 0 m, 5 m], heading: 0 deg}]\n" +
                            area("width: 2 m, height: 1 m, points: 6", "attached_to: car, position: [0 m, -3 m, -5 m], heading: -90 deg");
  figure("a wall under a panel that a body carries", radianceOf(time + panel + eyeOn(0.5, 0.0)), 0.5 * 11.0 * rectangleFactor(2.0, 1.0, 0.5, 0.0, 3.0) * 2.0,
         1e-5, "rho L F");
}

// A beam that sweeps while a camera exposes lights by its mean over the exposure.
TEST(Spot, SweepsWhileACameraExposes) {
  const std::string yaml = kWall + "]\n" + spot(10.0, "position: [10 m, 0 m, 0 m], heading: 270 deg, spin: {axis: [0, 0, 1], rate: 400 deg/s}");
  std::string eye = eyeOn(0, 0);
  eye.insert(eye.find("aperture"), "exposure: 50 ms, motion_blur: true, ");
  eye.replace(eye.find("0.02 deg"), 8, "8 deg");
  double mean = 0.0;
  for (const auto& t : gaussLegendre(32, -0.025, 0.025)) mean += t.weight / 0.05 * beam(10.0, std::abs(400.0 * t.x));
  figure("a wall that a beam sweeps over in an exposure", radianceOf("accuracy: 1 %\n" + yaml + eye), 0.5 / kPi * 14.0 * mean / 100.0, 0.012,
         "the beam's mean; the accuracy, and a pixel of 0.9 deg");
}

TEST(Spot, LightsAProbe) {
  const double y = 4.0, d2 = 100.0 + y * y;
  figure("a probe under a spot [W/m2]",
         probeReading(scene(spot(60.0, "position: [10 m, 0 m, 0 m], heading: 270 deg") +
                            "probes: [{name: p, position: [0 m, 4 m, 0 m], normal: [1, 0, 0], channels: "
                            "[{name: a, response: {band: [3 um, 5 um]}, output: irradiance}]}]\n"))[0],
         14.0 * beam(60.0, std::atan2(y, 10.0) / kDegree) * 10.0 / std::sqrt(d2) / d2, 1e-6, "I cos^n cos / d^2");
}

// Commands, levels and terms are of the whole lamp, whatever its points are.
TEST(Area, IsOneLamp) {
  const std::string yaml = "time: {rate: 10 Hz, frames: 3}\n" + kWall + "]\n" +
                           area("diameter: 2 m, points: 2", "position: [3 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m]") +
                           "commands: [{command: light, light: l, level: 0.25, at: 0.1 s}]\n";
  std::string eye = eyeOn(0.0, 0.0);
  eye.insert(eye.find("aperture"), "truth: [terms], ");
  const Simulation sim = scene(yaml + eye);
  const Frame before = renderFrame(sim, 0), after = renderFrame(sim, 1);
  figure("an area that a command turns down", at(layer(after, "mw.radiance"), after, 4, 4), 0.25 * at(layer(before, "mw.radiance"), before, 4, 4), 1e-6,
         "a quarter");
  figure("its term beside the whole", at(layer(before, "truth.terms.mw.lamp.l"), before, 4, 4), at(layer(before, "mw.radiance"), before, 4, 4), 1e-5,
         "all there is; double against single precision");
  EXPECT_EQ(std::count_if(before.layers.begin(), before.layers.end(), [](const FrameLayer& l) { return l.name.find("terms.mw.lamp.") != std::string::npos; }),
            1);
}

TEST(Spot, ReadmesExampleIsOne) {
  std::ifstream in(std::string(PITVIPER_SOURCE_DIR) + "/scenarios/README.md");
  std::stringstream all;
  all << in.rdbuf();
  const std::string readme = all.str(), mark = "```yaml spots\n";
  ASSERT_NE(readme.find(mark), std::string::npos);
  const std::size_t from = readme.find(mark) + mark.size();
  const Simulation sim = scene(readme.substr(from, readme.find("```", from) - from));
  ASSERT_EQ(sim.lights.size(), 4u + 15u);
  const WorldState state = advance(sim, 0.5);
  const auto axisOf = [&](std::size_t l) { return state.lightPoses[l].orientation * glm::dvec3(1, 0, 0); };
  EXPECT_NEAR(glm::distance(axisOf(0), state.entities[1].orientation * glm::dvec3(1, 0, 0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::dot(axisOf(1), glm::normalize(state.entities[1].position - state.lights[1])), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(axisOf(2), glm::dvec3(-1, 0, 0)), 1.0, 1e-12);
  double whole = 0.0;
  for (std::size_t l = 3; l < sim.lights.size(); ++l) whole += sim.lights[l].intensity(1.5);
  EXPECT_NEAR(whole, 12.0, 1e-9);
}

TEST(Spot, RefusesWhatCannotBe) {
  const auto refusal = [](const std::string& light) -> std::string {
    try {
      scene(kWall + "]\nlights: [" + light + "]\n" + eyeOn(0, 0));
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  const std::string spotHead = "{name: l, model: spot, intensity: 7 W/(sr um), ", areaHead = "{name: l, model: area, radiance: 7 W/(m2 sr um), ",
                    place = "position: [9 m, 0 m, 0 m], ";
  for (const auto& [light, says] : std::vector<std::pair<std::string, std::string>>{
           {spotHead + place + "look_at: p}", "missing key 'beam_angle'"},
           {spotHead + place + "beam_angle: 20 deg}", "light 'l' looks nowhere"},
           {spotHead + place + "beam_angle: 190 deg, look_at: p}", "'beam_angle'"},
           {spotHead + place + "beam_angle: 0 deg, look_at: p}", "'beam_angle'"},
           {spotHead + place + "beam_angle: 20, look_at: p}", "unit"},
           {spotHead + place + "beam_angle: 20 deg, look_at: q}", "there is no entity"},
           {spotHead + place + "beam_angle: 20 deg, look_at: l}", "there is no entity"},
           {spotHead + place + "beam_angle: 20 deg, look_at: p, heading: 3 deg}", "a heading and a look_at"},
           {spotHead + "attached_to: p, beam_angle: 20 deg, look_at: p}", "a light looks at the body that carries it"},
           {spotHead + place + "beam_angle: 20 deg, look_at: p, diameter: 1 m}", "'diameter'"},
           {areaHead + place + "look_at: p}", "neither a disc nor a rectangle"},
           {areaHead + place + "look_at: p, width: 1 m}", "neither a disc nor a rectangle"},
           {areaHead + place + "look_at: p, width: 1 m, height: 1 m, diameter: 1 m}", "a disc and a rectangle"},
           {areaHead + place + "look_at: p, diameter: 1 m, visible: true}", "an area light that is seen itself"},
           {areaHead + place + "look_at: p, diameter: 1 m, points: 1}", "'points'"},
           {"{name: l, intensity: 7 W/(sr um), " + place + "heading: 3 deg}", "'heading'"},
           {"{name: l, model: spots, intensity: 7 W/(sr um), " + place + "heading: 3 deg}", "did you mean 'spot'?"}}) {
    EXPECT_NE(refusal(light).find(says), std::string::npos) << light << "\n" << refusal(light);
    EXPECT_EQ(refusal(light).find('\n'), std::string::npos) << light;
  }
}

}  // namespace
}  // namespace pitviper::test
