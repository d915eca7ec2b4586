// Shadows of the sun and of point lights against lines drawn by hand: where they lie, how large they are, and that nothing else darkens.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "scenarios/commands/commands.hpp"
#include "sim/camera/small_bodies.hpp"
#include "sim/render/direct_pass.hpp"
#include "sim/scene/triangle_tree.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Radiance of the solid scene in the first slot of camera 0, row 0 at the bottom, with the view it was drawn in.
struct Picture {
  View view;
  std::vector<float> radiance;
  std::vector<int> entity;
};

Picture draw(const Simulation& sim) {
  needContext();
  const Camera& camera = sim.cameras[0];
  const Plan plan = makePlan(sim, camera.outputs, camera.spectral, camera.where);
  const WorldState state = advance(sim, 0.0);
  Picture picture;
  picture.view = cameraView(camera, state, 1);
  const auto pass = makeScenePass(sim, plan, shaderLibrary(), std::make_shared<const GpuScene>(sim), false, 1.0);
  pass->setState(state);
  pass->draw(picture.view, state, std::vector<char>(sim.entities.size(), 1));
  pass->startReadback(true);
  const RawImage raw = pass->finishReadback();
  for (size_t p = 0; p < raw.entity.size(); ++p) picture.radiance.push_back(raw.groups[0][4 * p]);
  picture.entity = raw.entity;
  return picture;
}

std::string number(double v) { return std::to_string(v); }

constexpr const char* kGrey = "materials: {m: {components: [{reflection: lambertian, reflectance: 0.5}]}}\n";
constexpr const char* kChannel = ", small_bodies: 0, channels: [{name: a, response: {band: [3 um, 4 um]}}]}]\n";

std::string camera(int pixels, double field_deg, const std::string& position, const std::string& at) {
  return "cameras: [{name: c, film: {width: " + std::to_string(pixels) + ", height: " + std::to_string(pixels) +
         "}, aperture: 5 mm, field_of_view: " + number(field_deg) + " deg, position: " + position + ", look_at: " + at + kChannel;
}

std::string ground(double size) {
  return "  - {name: ground, shape: {model: plate, width: " + number(size) + " m, height: " + number(size) +
         " m}, material: m, temperature: 0 K, pitch: 90 deg}\n";
}

/// Of the ground, entity 0 in z = 0: pixels against where the shadow is by hand, signed distance outside its edge in metres; those nearer to
/// the edge than `edge_m` may fall either way. Nothing else shines: shade is 0.
struct GroundTally {
  long wrong = 0, right = 0, atEdge = 0;
  double area_m2 = 0.0;  ///< of the pixels in shade
};

GroundTally onGround(const Picture& p, double edge_m, const std::function<double(glm::dvec2)>& outside_m) {
  GroundTally t;
  const View& v = p.view;
  auto meets = [&](double x, double y) {
    const glm::dvec3 d = v.localFromCamera * v.ray(x, y);
    return glm::dvec2(v.position - d * (v.position.z / d.z));
  };
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) {
      const size_t q = static_cast<size_t>(y * v.width + x);
      if (p.entity[q] != 0) continue;
      const bool shade = p.radiance[q] == 0.0f;
      const double outside = outside_m(meets(x + 0.5, y + 0.5));
      const glm::dvec2 a = meets(x + 1, y + 1) - meets(x, y), b = meets(x, y + 1) - meets(x + 1, y);
      if (shade) t.area_m2 += 0.5 * std::abs(a.x * b.y - a.y * b.x);
      if (std::abs(outside) < edge_m) ++t.atEdge;
      else ++(shade == (outside < 0.0) ? t.right : t.wrong);
    }
  return t;
}

// A disc 2 m over the ground: its own outline, moved by h / tan(elevation) away from the sun.
TEST(Shadows, DiscInTheSun) {
  const double radius = 1.0, height = 2.0;
  for (double elevation : {12.0, 40.0, 75.0}) {
    const double away = height / std::tan(elevation * M_PI / 180.0);  // sun in the west: the shadow lies east
    const Picture p = draw(
        scene(std::string(kGrey) + "sun: {azimuth: 270 deg, elevation: " + number(elevation) + " deg, temperature: 5772 K}\nentities:\n" + ground(60) +
              "  - {name: disc, shape: {model: disc, radius: 1 m, segments: 512}, material: m, temperature: 0 K, pitch: 90 deg, position: [0 m, 0 m, 2 m]}\n" +
              camera(256, 9, "[" + number(away) + " m, -20 m, 12 m]", "[" + number(away) + " m, 0 m, 0 m]")));
    const GroundTally t = onGround(p, 1e-4, [&](glm::dvec2 at) { return glm::length(at - glm::dvec2(away, 0.0)) - radius; });
    EXPECT_GT(t.right, 50000);
    bound("disc in the sun at " + number(elevation).substr(0, 2) + " deg, ground pixels on the wrong side of its shadow's edge", static_cast<double>(t.wrong),
          0, "beyond 0.1 mm of the outline: 512 facets and single precision");
    figure("disc in the sun at " + number(elevation).substr(0, 2) + " deg, area of the shadow [m2]", t.area_m2, M_PI, 2e-3,
           "pi r2; outline on pixels of 13 mm");
  }
}

// A ball under a lamp: the ground inside the cone of its tangents.
TEST(Shadows, BallUnderALamp) {
  const glm::dvec3 lamp(1.0, 0.5, 6.0), centre(0.0, 0.0, 2.0);
  const Picture p =
      draw(scene(std::string(kGrey) + "lights: [{name: l, visible: false, intensity: 100 W/(sr um), position: [1 m, 0.5 m, 6 m]}]\nentities:\n" + ground(60) +
                 "  - {name: ball, shape: {model: sphere, radius: 0.8 m, segments: 256}, material: m, temperature: 0 K, position: [0 m, 0 m, 2 m]}\n" +
                 camera(256, 20, "[-2 m, -14 m, 9 m]", "[-0.5 m, -0.25 m, 0 m]")));
  const GroundTally t = onGround(p, 2e-3, [&](glm::dvec2 at) {
    const glm::dvec3 from(at, 0.0), line = glm::normalize(lamp - from);
    const glm::dvec3 to = centre - from;
    return glm::length(to - glm::dot(to, line) * line) - 0.8;  // how far the ray passes the ball
  });
  EXPECT_GT(t.right, 40000);
  bound("ball under a lamp, ground pixels on the wrong side of its shadow's edge", static_cast<double>(t.wrong), 0,
        "beyond 2 mm: 256 facets, 1.2 of 2e-4 of the radius");
}

// A square under a lamp: itself, enlarged by H / (H - h).
TEST(Shadows, SquareUnderALamp) {
  const Picture p = draw(
      scene(std::string(kGrey) + "lights: [{name: l, visible: false, intensity: 100 W/(sr um), position: [0 m, 0 m, 5 m]}]\nentities:\n" + ground(40) +
            "  - {name: square, shape: {model: plate, width: 1 m, height: 1 m}, material: m, temperature: 0 K, pitch: 90 deg, position: [0.5 m, 0 m, 3 m]}\n" +
            camera(256, 16, "[1 m, -16 m, 12 m]", "[1.25 m, 0 m, 0 m]")));
  const double scale = 5.0 / (5.0 - 3.0);
  const GroundTally t = onGround(p, 1e-4, [&](glm::dvec2 at) { return std::max(std::abs(at.x - scale * 0.5), std::abs(at.y)) - 0.5 * scale; });
  EXPECT_GT(t.right, 50000);
  bound("square under a lamp, ground pixels on the wrong side of its shadow's edge", static_cast<double>(t.wrong), 0,
        "beyond 0.1 mm: single precision at 20 m");
  figure("square under a lamp, area of the shadow [m2]", t.area_m2, scale * scale, 3e-3, "(H / (H - h))2; outline on pixels of 20 mm");
}

// A plate 1 cm above the ground, on a floor of 20 m and on one of 50 km: the shadow begins at its very foot.
TEST(Shadows, APlateACentimetreAboveGround) {
  for (double size : {20.0, 50000.0}) {
    const double far = 0.3 * size, height = 0.01;  // of a place away from the floor's middle
    const Picture p = draw(
        scene(std::string(kGrey) + "sun: {azimuth: 270 deg, elevation: 30 deg, temperature: 5772 K}\nentities:\n" + ground(size) +
              "  - {name: plate, shape: {model: plate, width: 0.2 m, height: 0.2 m}, material: m, temperature: 0 K, pitch: 90 deg, position: [" + number(far) +
              " m, 0 m, 1 cm]}\n" + camera(256, 12, "[" + number(far + 1.5) + " m, 0 m, 1.2 m]", "[" + number(far + 0.05) + " m, 0 m, 0 m]")));
    const double away = height / std::tan(M_PI / 6.0);
    // A place on a floor is where a ray meets it, in single precision from the floor's origin: 2e-6 of 15 km.
    const double edge_m = size > 1000.0 ? 3e-2 : 1e-5;
    const GroundTally t = onGround(p, edge_m, [&](glm::dvec2 at) { return std::max(std::abs(at.x - far - away), std::abs(at.y)) - 0.1; });
    EXPECT_GT(t.right, 40000);
    bound("plate 1 cm above a floor of " + std::to_string(static_cast<int>(size)) + " m, pixels on the wrong side of its shadow's edge",
          static_cast<double>(t.wrong), 0, size > 1000.0 ? "beyond 3 cm: 2e-6 of the 15 km from the floor's origin" : "beyond 0.01 mm: single precision");
  }
}

// A wall: a shadow of H / tan(elevation) behind it, no light at its foot.
TEST(Shadows, WallAtLowSun) {
  const Picture p =
      draw(scene(std::string(kGrey) + "sun: {azimuth: 270 deg, elevation: 10 deg, temperature: 5772 K}\nentities:\n" + ground(200) +
                 "  - {name: wall, shape: {model: box, length: 0.5 m, width: 60 m, height: 2 m}, material: m, temperature: 0 K, position: [0 m, 0 m, 1 m]}\n" +
                 camera(256, 40, "[25 m, -6 m, 12 m]", "[6 m, 0 m, 0 m]")));
  const double length = 2.0 / std::tan(10.0 * M_PI / 180.0);
  // From the wall's eastern side, 0.25 m, to where its eastern upper edge falls.
  const GroundTally t = onGround(p, 1e-4, [&](glm::dvec2 at) { return std::abs(at.x - 0.25 - 0.5 * length) - 0.5 * length; });
  EXPECT_GT(t.right, 40000);
  bound("wall at a sun of 10 deg, ground pixels on the wrong side of its shadow's edge", static_cast<double>(t.wrong), 0, "beyond 0.1 mm");
}

// Nothing darkens of itself: height fields, balls, tubes and missiles are as bright as without shadows, from grazing sun to the zenith.
TEST(Shadows, NothingLitIsDarkened) {
  const struct {
    const char* name;
    const char* shape;
  } bodies[] = {{"flat height field of 50 km", "{model: terrain, size: 50 km, relief: 0 m, columns: 250}"},
                {"flat height field of 40 m", "{model: terrain, size: 40 m, relief: 0 m, columns: 100}"},
                {"ball", "{model: sphere, radius: 4 m}"},
                {"tube from outside", "{model: cylinder, radius: 3 m, length: 8 m, capped: false}"}};
  long wrong = 0, lit = 0;
  for (const auto& body : bodies)
    for (double elevation : {1.0, 2.0, 5.0, 15.0, 40.0, 70.0, 90.0}) {
      auto picture = [&](bool shadows) {
        return draw(scene(std::string(kGrey) + "render: {shadows: " + (shadows ? "true" : "false") + "}\nsun: {azimuth: 200 deg, elevation: " +
                          number(elevation) + " deg, temperature: 5772 K}\nentities:\n  - {name: body, shape: " + body.shape +
                          ", material: m, temperature: 0 K}\n  - {name: far, shape: {model: sphere, radius: 1 m}, material: m, temperature: 0 K, position: [0 "
                          "m, 90 km, 0 m]}\n" +
                          camera(96, 40, "[3 m, -14 m, 9 m]", "[0 m, 0 m, 0 m]")));
      };
      const Picture with = picture(true), without = picture(false);
      const float brightest = *std::max_element(without.radiance.begin(), without.radiance.end());
      for (size_t p = 0; p < with.radiance.size(); ++p) {
        lit += without.radiance[p] > 0.0f;
        wrong += std::abs(with.radiance[p] - without.radiance[p]) > 2e-6f * brightest;
      }
    }
  EXPECT_GT(lit, 100000);
  bound("surfaces that nothing shades, 1 to 90 deg of sun, pixels changed by shadows", static_cast<double>(wrong), 0,
        "but for the rounding of another program, 2e-6 of the brightest; " + std::to_string(lit) + " lit pixels");
}

// A jet 200 m above terrain of 50 km, 10 km from its middle: area of its shadow is its outline's along the sun over sin(elevation).
TEST(Shadows, JetOverTerrain) {
  const double elevation = 50.0, up = 200.0, away = up / std::tan(elevation * M_PI / 180.0);
  const std::string y =
      std::string(kGrey) +
      "sun: {azimuth: 270 deg, elevation: 50 deg, temperature: 5772 K}\nentities:\n"
      "  - {name: ground, shape: {model: terrain, size: 50 km, relief: 0 m, columns: 250}, material: m, temperature: 0 K, position: [0 m, 10 km, 0 m]}\n"
      "  - {name: jet, shape: {model: jet}, material: m, temperature: 0 K, position: [0 m, 0 m, 200 m], heading: 30 deg}\n";
  const auto sim = scene(y + camera(256, 4.2, "[" + number(away) + " m, -260 m, 200 m]", "[" + number(away) + " m, 0 m, 0 m]"));
  const Picture p = draw(sim);
  const GroundTally t = onGround(p, 0.0, [](glm::dvec2) { return 1.0; });
  // The outline along the sun, on a grid of 2 cm.
  const WorldState state = advance(sim, 0.0);
  const auto tree = treeOf(sim.entities[1].mesh);
  const glm::dmat3 body = glm::transpose(glm::mat3_cast(state.entities[1].orientation));
  const glm::dvec3 toSun = body * sim.sun->toSun, x = glm::normalize(glm::cross(toSun, glm::dvec3(0.3, 0.9, 0.1))), z = glm::cross(x, toSun);
  constexpr double kStep = 0.02;
  long met = 0;
  const double endless = INFINITY;
  for (int i = -500; i <= 500; ++i)
    for (int j = -500; j <= 500; ++j) {
      const glm::dvec3 from = kStep * (static_cast<double>(i) * x + static_cast<double>(j) * z);
      bool hit = false;
      tree->along(from, toSun, -INFINITY, endless, [&](std::uint32_t n) { return hit = meetTriangle(*sim.entities[1].mesh, n, from, toSun).met; });
      met += hit;
    }
  figure("jet 200 m above terrain of 50 km, area of its shadow [m2]", t.area_m2, static_cast<double>(met) * kStep * kStep / std::sin(elevation * M_PI / 180.0),
         0.01, "outline along the sun over sin(elevation); pixels of 7 cm by 11 cm, outline of about 60 m");
}

// A far ball in the shade of a screen, drawn through a zoomed view of its own, keeps only what the sun does not give.
TEST(Shadows, FarBallBehindAScreen) {
  auto flux = [](double across) {
    const auto sim = scene(
        std::string(kGrey) +
        "sun: {azimuth: 90 deg, elevation: 30 deg, temperature: 5772 K}\nentities:\n"
        "  - {name: ball, shape: {model: sphere, radius: 1 m}, material: m, temperature: 0 K}\n"
        "  - {name: screen, shape: {model: plate, width: 4 m, height: 4 m}, material: m, temperature: 0 K, pitch: 30 deg, position: [" +
        number(8.66 + across) + " m, " + number(across) +
        " m, 5 m], heading: 90 deg}\n"
        "cameras: [{name: c, film: {width: 32, height: 32}, aperture: 5 cm, field_of_view: 10 deg, position: [-500 m, -2.5 km, 0 m], look_at: [0 m, 0 m, 0 m], "
        "channels: [{name: a, response: {band: [3 um, 4 um]}, output: flux}]}]\n");
    return sum(renderFrame(sim).layers[0]);
  };
  EXPECT_EQ(flux(0.0), 0.0);
  const double open = flux(30.0);
  EXPECT_GT(open, 0.0);
}

TEST(Shadows, OnlyWhereTheSceneHasThem) {
  auto terms = [](const std::string& y) {
    const auto sim = scene(kGrey + y + camera(16, 20, "[0 m, -20 m, 5 m]", "[0 m, 0 m, 0 m]"));
    return makePlan(sim, sim.cameras[0].outputs, sim.cameras[0].spectral, sim.cameras[0].where).terms.shadows;
  };
  const std::string sun = "sun: {azimuth: 0 deg, elevation: 40 deg, temperature: 5772 K}\n",
                    ball = "  - {name: b, shape: {model: sphere, radius: 1 m}, material: m, temperature: 1 K}\n", two = "entities:\n" + ball + ground(9);
  EXPECT_TRUE(terms(sun + two));
  EXPECT_TRUE(terms("lights: [{name: l, intensity: 1 W/(sr um), position: [0 m, 0 m, 5 m]}]\n" + two));
  EXPECT_FALSE(terms(two)) << "no light";
  EXPECT_FALSE(terms("render: {shadows: false}\n" + sun + two));
  EXPECT_FALSE(terms(sun + "entities:\n" + ball)) << "a convex body hides nothing of itself";
  EXPECT_FALSE(terms(sun + "entities:\n" + ground(9)));
  EXPECT_TRUE(terms(sun + "entities:\n  - {name: b, shape: {model: sphere, radius: 30 m}, material: m, temperature: 1 K}\n")) << "seen from inside";
  EXPECT_TRUE(terms(sun + "entities:\n  - {name: b, shape: {model: jet}, material: m, temperature: 1 K}\n"));
}

// A closed room has no sun in it; a lamp inside lights it.
TEST(Shadows, InsideAClosedRoom) {
  const std::string room = "entities: [{name: room, shape: {model: box, length: 8 m, width: 8 m, height: 4 m}, material: m, temperature: 0 K}]\n" +
                           camera(32, 60, "[2 m, -3 m, 0 m]", "[0 m, 3 m, -1 m]");
  for (float v : draw(scene(kGrey + std::string("sun: {azimuth: 0 deg, elevation: 40 deg, temperature: 5772 K}\n") + room)).radiance) EXPECT_EQ(v, 0.0f);
  for (float v : draw(scene(kGrey + std::string("lights: [{name: l, visible: false, intensity: 1 W/(sr um), position: [0 m, 0 m, 1 m]}]\n") + room)).radiance)
    EXPECT_GT(v, 0.0f);
}

// Parallel light: the shadow of a box of 2 m is the same however far off it is. (Told by differences of squares, a caster at 5 km lost most of its shadow.)
TEST(Shadows, OfACasterFarOff) {
  const double azimuth = 40.0 * kPi / 180.0, elevation = 60.0 * kPi / 180.0;
  const auto floor = [&](double range_m) {
    const glm::dvec3 to(std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), std::sin(elevation));
    const glm::dvec3 at = range_m * to;
    const Picture p =
        draw(scene("sun: {azimuth: 40 deg, elevation: 60 deg, temperature: 5772 K}\n" + std::string(kGrey) + "entities:\n" + ground(40.0) +
                   "  - {name: box, shape: {model: box, length: 2 m, width: 2 m, height: 2 m}, material: m, temperature: 0 K, position: [" + number(at.x) +
                   " m, " + number(at.y) + " m, " + number(at.z) + " m]}\n" + camera(128, 12.0, "[0 m, 0 m, 100 m]", "[0.01 m, 0 m, 0 m]")));
    long dark = 0;
    for (float l : p.radiance) dark += l == 0.0f;
    return static_cast<double>(dark);
  };
  const double near = floor(150.0);
  EXPECT_GT(near, 100.0);
  for (double range_m : {2e3, 5e3, 2e4, 5e4})
    bound("shaded pixels by a box at " + number(range_m) + " m against 150 m, of " + number(near), std::abs(floor(range_m) - near), 0.04 * near,
          "outline in single precision: 4 mm of place at 50 km, pixels of 0.16 m");
}

}  // namespace
}  // namespace pitviper::test
