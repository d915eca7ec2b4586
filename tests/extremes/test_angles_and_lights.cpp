// Grazing view and incidence to 89.999 degrees; lights at, in and behind a surface.
#include "sim/radiometry/constants.hpp"
#include "tests/extremes/extremes.hpp"

namespace pitviper::test {
namespace {

constexpr double kGrazing_deg[] = {80, 89, 89.9, 89.99, 89.999};
double rad(double degrees) { return degrees * kPi / 180.0; }
std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.12f", value);
  return text;
}
constexpr const char* kModes[] = {"render: {mode: direct}\n", "render: {mode: buffered}\n", "accuracy: reference\n"};
const std::string kGround = "entities: [{name: p, shape: {model: plate, width: 1 km, height: 1 km}, pitch: 90 deg, ";

/// 5 m from the origin, so many degrees from straight above, towards the south.
Look grazing(double degrees) {
  return {.from = "[0 m, " + digits(-5.0 * std::sin(rad(degrees))) + " m, " + digits(5.0 * std::cos(rad(degrees))) + " m]", .more = "near: 0.01 m, "};
}

TEST(Grazing, ViewOfALitPlate) {
  Range lit("lit plate seen at 80 to 89.999 deg", 2e-5, "same radiance at any angle; bins of 5 1/cm in double");
  for (const char* mode : kModes)
    for (double a : kGrazing_deg)
      lit.add(middle(mode + std::string("sun: {azimuth: 90 deg, elevation: 90 deg, irradiance: 10 W/(m2 um)}\n") + kGround +
                     "material: {components: [{reflection: lambertian, reflectance: 0.5}]}, temperature: 300 K}]\n" + grazing(a).yaml()),
              0.5 * blackBodyBand(8, 12, 300) + 0.5 / kPi * 10.0 * 4.0, mode + text(a));
}

// The angle of a table is met by its cosine: near 90 deg a cosine of single precision, 1e-5 wrong by 6e-8 of rotation, is nothing to the angle.
TEST(Grazing, ViewOfAnAngularTable) {
  Range emitted("emissivity over angle seen at 80 to 89.999 deg", 1e-4, "linear between 80 and 90 deg, as given; the picture's table has a step of 0.5 deg");
  Range through("pane over angle seen at 80 to 89.999 deg", 1e-4, "linear between 80 and 90 deg, as given; the picture's table has a step of 0.5 deg");
  for (const char* mode : kModes)
    for (double a : kGrazing_deg) {
      const double factor = 0.1 + 0.9 * (90.0 - a) / 10.0;
      emitted.add(middle(mode + kGround + "material: {emission: {emissivity: 0.8, angular: [[0 deg, 1], [80 deg, 1], [90 deg, 0.1]]}}, temperature: 300 K}]\n" +
                         grazing(a).yaml()),
                  0.8 * factor * blackBodyBand(8, 12, 300), mode + text(a));
      if (std::string(mode) == kModes[0]) continue;  // panes are drawn buffered
      through.add(
          middle(mode + std::string("background: {temperature: 400 K}\n") + kGround +
                 "material: {transmission: {transmittance: 0.8, angular: [[0 deg, 1], [80 deg, 1], [90 deg, 0.1]]}}, temperature: 0 K}]\n" + grazing(a).yaml()),
          0.8 * factor * blackBodyBand(8, 12, 400), mode + text(a));
    }
}

// Cosines of directions in single precision: 1e-7 of 1 over the cosine. In double nothing is lost.
TEST(Grazing, Incidence) {
  Range sun("plate lit at 80 to 89.999 deg by the sun, times its cosine", 2e-7, "E cos / pi; directions are rotated in single precision"),
      lamp("plate lit at 80 to 89.999 deg by a lamp 100 m off, times its cosine", 1e-6, "I cos / (pi d2); a point of a plate of 1 km is known to 6e-5 m");
  Range exactSun("plate lit at 80 to 89.999 deg by the sun, in double", 1e-6, "E cos / pi"),
      exactLamp("plate lit at 80 to 89.999 deg by a lamp 100 m off, in double", 1e-6, "I cos / (pi d2)");
  const std::string look = Look{.from = "[0 m, 0.1 m, 5 m]"}.yaml();
  for (const char* mode : kModes)
    for (double heading : {0.0, 33.0})
      for (double a : kGrazing_deg) {
        const bool inDouble = std::string(mode) == kModes[2];
        const std::string ground = kGround + "heading: " + text(heading) + " deg, material: white_lambertian, temperature: 0 K}]\n", at = mode + text(a);
        const double cosine = std::cos(rad(a));
        const double sunny =
            middle(mode + std::string("sun: {azimuth: 77 deg, elevation: ") + digits(90.0 - a) + " deg, irradiance: 10 W/(m2 um)}\n" + ground + look) /
            (4.0 * 10.0 / kPi);
        const double lit = middle(mode + std::string("lights: [{name: l, intensity: 10 kW/(sr um), visible: false, position: [") +
                                  digits(100.0 * std::sin(rad(a))) + " m, 0 m, " + digits(100.0 * cosine) + " m]}]\n" + ground + look) /
                           (4.0 * 1.0 / kPi);
        (inDouble ? exactSun : sun).add(inDouble ? sunny : 1.0 + sunny - cosine, inDouble ? cosine : 1.0, at);
        (inDouble ? exactLamp : lamp).add(inDouble ? lit : 1.0 + lit - cosine, inDouble ? cosine : 1.0, at);
      }
}

// A light nearer than its own radius shines as from that distance: I / r2; behind the surface it does not shine.
TEST(Lights, AtAndInASurface) {
  Range before("lamp 1 um to 0.1 m before a white plate, radius 0.1 m", 1e-5, "I / (pi r2) at the bound r = 0.1 m");
  for (const char* mode : kModes) {
    auto lit = [&](double x) {
      return middle(mode + std::string("lights: [{name: l, intensity: 10 W/(sr um), visible: false, radius: 0.1 m, position: [") + digits(x) +
                    " m, 0 m, 0 m]}]\n" + plate(0, "white_lambertian") + Look{}.yaml());
    };
    const double most = 10.0 * 4.0 / 0.01 / kPi;
    for (double x : {1e-6, 1e-4, 1e-2, 0.1}) before.add(lit(x), most, mode + text(x));
    const double within = lit(0.0);  // in the very surface: no direction, but finite
    EXPECT_GE(within, 0.0) << mode;
    EXPECT_LE(within, most * 1.00001) << mode;
    for (double x : {-1e-4, -1.0}) EXPECT_EQ(lit(x), 0.0) << mode << x;
  }
}

// The least radius a light can have, a micrometre before the surface: 1e12 times its intensity.
TEST(Lights, OfTheLeastRadius) {
  for (const char* mode : kModes)
    for (double x : {0.0, 1e-6, 1e-3}) {
      const double got = middle(
          mode + std::string("lights: [{name: l, intensity: 10 W/(sr um), radius: 0.000001 m, visible: false, position: [") + digits(x) + " m, 0 m, 0 m]}]\n" +
          plate(0, "{components: [{reflection: phong, reflectance: 0.5, exponent: 1e7}, {reflection: lambertian, reflectance: 0.5}]}") + Look{}.yaml());
      EXPECT_GE(got, 0.0) << mode << x;
      EXPECT_LE(got, 40.0 * 1e12 * (0.5 / kPi + 0.5 * (1e7 + 2) / (2 * kPi)) * 1.00001) << mode << x;
    }
}

// In the middle of a hollow sphere all of it is lit, from outside none of it: a closed body hides its lamp.
TEST(Lights, InsideABody) {
  Range inside("lamp in the middle of a white sphere, seen from inside", 3e-3, "I / (pi r2); facets lie up to 1.2e-3 within the sphere");
  for (const char* mode : kModes) {
    const std::string yaml =
        mode + std::string(
                   "lights: [{name: l, intensity: 10 W/(sr um), visible: false, position: [0 m, 0 m, 0 m]}]\n"
                   "entities: [{name: p, shape: {model: sphere, radius: 2 m, segments: 128, fit: inscribed}, material: white_lambertian, temperature: 0 K}]\n");
    inside.add(middle(yaml + Look{.from = "[1 m, 0.3 m, 0.1 m]", .at = "[-1 m, 0 m, 0 m]"}.yaml()), 10.0 * 4.0 / (4.0 * kPi), mode);
    EXPECT_EQ(middle(yaml + Look{}.yaml()), 0.0) << mode;
  }
}

TEST(Emissivity, NoneAndAll) {
  Range all("emissivity 1, by no components, by a spectrum, by a texture", 2e-5, "Planck series; bins of 5 1/cm in double");
  for (const char* mode : kModes) {
    for (const char* black : {"{}", "{emission: {emissivity: 1}}", "{emission: {emissivity: 1, modifier: {rows: [[1, 1]]}}}"})
      all.add(middle(mode + plate(500, black) + Look{}.yaml()), blackBodyBand(8, 12, 500), mode + std::string(black));
    for (const char* white :
         {"{components: [{reflection: lambertian, reflectance: 1}]}", "{emission: {emissivity: 0}}", "{emission: {emissivity: 1, modifier: {rows: [[0, 0]]}}}"})
      EXPECT_EQ(middle(mode + plate(500, white) + Look{}.yaml()), 0.0) << mode << white;
  }
}

}  // namespace
}  // namespace pitviper::test
