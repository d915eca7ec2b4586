// Shadows of what touches: a plate that stands on the ground, a body that lies on it or in it, rays that graze an edge or run in a plane.
#include "sim/radiometry/constants.hpp"
#include "tests/extremes/extremes.hpp"

namespace pitviper::test {
namespace {

constexpr const char* kModes[] = {"render: {mode: direct}\n", "render: {mode: buffered}\n", "accuracy: reference\n"};
const std::string kGround =
    "  - {name: ground, shape: {model: plate, width: 40 m, height: 40 m}, pitch: 90 deg, material: white_lambertian, temperature: 0 K}\n";

std::string sun(double azimuth_deg, double elevation_deg) {
  return "sun: {azimuth: " + text(azimuth_deg) + " deg, elevation: " + text(elevation_deg) + " deg, irradiance: 10 W/(m2 um)}\nentities:\n";
}
double lit(double elevation_deg) { return 40.0 / kPi * std::sin(elevation_deg * kPi / 180.0); }

/// From 10 m above the origin, a little south of it, a square metre and more.
const Look kAbove{.from = "[0 m, -0.001 m, 10 m]", .at = "[0 m, 0 m, 0 m]", .pixels = 64, .field_deg = 12, .more = "small_bodies: 0, truth: [range, entity], "};

struct Tally {
  int lit = 0, dark = 0, wrong = 0;
};

/// Pixels of the ground (entity 1) that are lit, dark, or otherwise than `shade` says; shade(x, y): 1 dark, 0 lit, -1 either.
template <class Shade>
Tally tally(const Frame& f, double full, Shade shade) {
  Tally t;
  const double perPixel = 2.0 * std::tan(6.0 * kPi / 180.0) / 64.0;
  for (int row = 0; row < f.height; ++row)
    for (int column = 0; column < f.width; ++column) {
      if (at(layer(f, "truth.entity"), f, column, row) != 1.0) continue;
      const double x = 10.0 * perPixel * (column + 0.5 - 32.0), y = -10.0 * perPixel * (row + 0.5 - 32.0), v = at(f.layers[0], f, column, row);
      const bool bright = std::abs(v / full - 1.0) < 1e-4, dark = v == 0.0;
      t.lit += bright, t.dark += dark;
      const int want = shade(x, y);
      t.wrong += !(bright || dark) || (want == 1 && !dark) || (want == 0 && !bright);
    }
  return t;
}

// An upright plate across the x axis with its foot on the ground at x = 0, sun in the east: dark to the west from the very foot on. The two pixels nearest to
// the shadow's outline may fall either way.
TEST(Contact, PlateStandingOnTheGround) {
  int all = 0;
  for (const char* mode : kModes)
    for (double elevation : {5.0, 45.0, 80.0}) {
      const double reach = 1.0 / std::tan(elevation * kPi / 180.0), edge = 0.07;
      const Frame f = finiteFrame(
          mode + sun(90, elevation) + kGround +
          "  - {name: plate, shape: {model: plate, width: 1 m, height: 1 m}, material: white_lambertian, temperature: 0 K, position: [0 m, 0 m, 0.5 m]}\n" +
          kAbove.yaml());
      const Tally t = tally(f, lit(elevation), [&](double x, double y) {
        if (std::abs(std::abs(y) - 0.5) < edge || std::abs(x + reach) < edge || std::abs(x) < 0.035) return -1;
        return x < 0.0 && x > -reach && std::abs(y) < 0.5 ? 1 : 0;
      });
      all += t.wrong;
      EXPECT_EQ(t.wrong, 0) << mode << elevation;
      EXPECT_GT(t.dark, elevation > 60.0 ? 60 : 300) << mode << elevation;
      EXPECT_GT(t.lit, 1000) << mode << elevation;
    }
  bound("pixels wrongly lit or dark about a plate standing on the ground, sun 5-80 deg high", all, 0,
        "outline of the shadow; a pixel and a half about it is left out; direct, buffered, in double");
}

// Sun in the plate's own plane: no shadow but the line under it.
TEST(Contact, SunInThePlaneOfAPlate) {
  int all = 0;
  for (const char* mode : kModes)
    for (double azimuth : {0.0, 180.0}) {
      const Frame f = finiteFrame(
          mode + sun(azimuth, 30) + kGround +
          "  - {name: plate, shape: {model: plate, width: 1 m, height: 1 m}, material: white_lambertian, temperature: 0 K, position: [0 m, 0 m, 0.5 m]}\n" +
          kAbove.yaml());
      const Tally t = tally(f, lit(30), [](double x, double) { return std::abs(x) < 0.035 ? -1 : 0; });
      all += t.wrong;
      EXPECT_EQ(t.wrong, 0) << mode << azimuth;
      EXPECT_GT(t.lit, 3000) << mode << azimuth;
    }
  bound("pixels wrongly lit or dark about a plate standing on the ground, sun in its plane", all, 0, "no shadow but under it; direct, buffered, in double");
}

// A box on the ground shades what its side hides; sun straight above: nothing but what it stands on.
TEST(Contact, BoxOnTheGround) {
  int all = 0;
  for (const char* mode : kModes)
    for (double elevation : {30.0, 90.0})
      for (double sunk : {0.0, 0.2}) {
        const double reach = (1.0 - sunk) / std::tan(elevation * kPi / 180.0), edge = 0.07;
        const Frame f = finiteFrame(mode + sun(90, elevation) + kGround +
                                    "  - {name: box, shape: {model: box, length: 0.5 m, width: 0.5 m, height: 1 m}, material: white_lambertian, temperature: 0 "
                                    "K, position: [0 m, 0 m, " +
                                    text(0.5 - sunk) + " m]}\n" + kAbove.yaml());
        const Tally t = tally(f, lit(elevation), [&](double x, double y) {
          if (std::abs(std::abs(y) - 0.25) < edge || std::abs(x + 0.25 + reach) < edge || std::abs(std::abs(x) - 0.25) < edge) return -1;
          return x < 0.25 && x > -0.25 - reach && std::abs(y) < 0.25 ? 1 : 0;
        });
        all += t.wrong;
        EXPECT_EQ(t.wrong, 0) << mode << elevation << ", sunk " << sunk;
        EXPECT_GT(t.lit, 1000) << mode << elevation;
        if (elevation < 60.0) {
          EXPECT_GT(t.dark, 100) << mode << elevation;
        }
      }
  bound("pixels wrongly lit or dark about a box on the ground, and sunk into it", all, 0, "outline of the shadow; direct, buffered, in double");
}

// A sheet that lies on the ground in the very same plane: whichever of the two a pixel shows, it is lit as it is, without a speck.
TEST(Contact, SheetInThePlaneOfTheGround) {
  int all = 0;
  for (const char* mode : kModes)
    for (double elevation : {1.0, 30.0, 90.0})
      for (double turn : {0.0, 27.0}) {
        const Frame f = finiteFrame(mode + sun(70, elevation) + kGround +
                                    "  - {name: sheet, shape: {model: plate, width: 1 m, height: 1 m}, pitch: 90 deg, heading: " + text(turn) +
                                    " deg, material: white_lambertian, temperature: 0 K, position: [0.13 m, 0.07 m, 0 m]}\n" + kAbove.yaml());
        int wrong = 0;
        for (float v : f.layers[0].pixels) wrong += !(std::abs(static_cast<double>(v) / lit(elevation) - 1.0) < 1e-4);
        all += wrong;
        EXPECT_EQ(wrong, 0) << mode << elevation << ", turned by " << turn;
      }
  bound("dark pixels on a sheet in the very plane of the ground, sun 1-90 deg high", all, 0, "it lies in the light; direct, buffered, in double");
}

// The same on a slope, far from the origin, where no coordinate is exact.
TEST(Contact, SheetInThePlaneOfASlope) {
  int all = 0;
  for (const char* mode : kModes)
    for (double azimuth : {100.0, 190.0})
      for (double size : {1.0, 7.0}) {
        auto body = [&](const char* name, double width, double roll) {
          return "  - {name: " + std::string(name) + ", shape: {model: plate, width: " + text(width) + " m, height: " + text(width) +
                 " m}, pitch: 61 deg, heading: 77 deg, roll: " + text(roll) +
                 " deg, material: white_lambertian, temperature: 0 K, position: [3000.1 m, 700.7 m, 50.3 m]}\n";
        };
        Look look = kAbove;
        look.from = "[3000.3 m, 700.8 m, 60 m]", look.at = "[3000.1 m, 700.7 m, 50.3 m]";
        const Frame f = finiteFrame(mode + sun(azimuth, 40) + body("ground", 40, 0) + body("sheet", size, 33) + look.yaml());
        const double a = azimuth * kPi / 180.0, h = 77 * kPi / 180.0, e = 40 * kPi / 180.0, p = 61 * kPi / 180.0;
        const double full = 40.0 / kPi * (std::cos(e) * std::cos(p) * std::cos(a - h) + std::sin(e) * std::sin(p));
        int wrong = 0;
        for (float v : f.layers[0].pixels) wrong += !(std::abs(static_cast<double>(v) / full - 1.0) < 1e-4);
        all += wrong;
        EXPECT_EQ(wrong, 0) << mode << azimuth << ", " << size << " m: " << middleOf(f) << ", not " << full;
      }
  bound("dark pixels on a sheet in the plane of a slope 3 km from the origin", all, 0, "it lies in the light; direct, buffered, in double");
}

// Sheets from 1 cm to 10 um above the ground: both are lit, and the ground in their shadow is dark up to their outline.
TEST(Contact, SheetJustAboveTheGround) {
  int all = 0;
  for (const char* mode : kModes)
    for (double height : {1e-2, 1e-3, 1e-4, 1e-5}) {
      const Frame f =
          finiteFrame(mode + sun(70, 30) + kGround +
                      "  - {name: sheet, shape: {model: plate, width: 1 m, height: 1 m}, pitch: 90 deg, material: white_lambertian, temperature: 0 K, "
                      "position: [0 m, 0 m, " +
                      text(height) + " m]}\n" + kAbove.yaml());
      int wrong = 0, sheet = 0;
      for (int row = 0; row < f.height; ++row)
        for (int column = 0; column < f.width; ++column) {
          const double v = at(f.layers[0], f, column, row) / lit(30), entity = at(layer(f, "truth.entity"), f, column, row);
          if (entity == 2.0) ++sheet, wrong += !(std::abs(v - 1.0) < 1e-4);
          else wrong += !(std::abs(v - 1.0) < 1e-4 || v == 0.0);
        }
      all += wrong;
      EXPECT_EQ(wrong, 0) << mode << height;
      EXPECT_GT(sheet, 800) << mode << height;
    }
  bound("pixels neither lit nor dark, sheet 10 um to 1 cm above the ground", all, 0, "lit or dark, the sheet itself lit; direct, buffered, in double");
}

}  // namespace
}  // namespace pitviper::test
