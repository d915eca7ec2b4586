// Ranges from 0.1 m to 2000 km in one picture, millimetres at the size of the earth, the poles and the date line.
#include "sim/radiometry/constants.hpp"
#include "tests/extremes/extremes.hpp"

namespace pitviper::test {
namespace {

constexpr double kRange_m[] = {0.1, 1.0, 100.0, 1e4, 4e5, 2e6};
constexpr int kColumns = 10;  ///< of the picture, for each

// Upright plates one behind the other, each reaching one step farther to the right than those before it: what is nearest hides the rest.
std::string stairs(const std::string& air) {
  std::string yaml = air + "entities:\n";
  for (size_t k = 0; k < std::size(kRange_m); ++k) {
    const double across = 2.0 * std::tan(6.0 * kPi / 180.0) * kRange_m[k],
                 width = across * static_cast<double>(k + 1) / static_cast<double>(std::size(kRange_m));
    yaml += "  - {name: p" + std::to_string(k) + ", shape: {model: plate, width: " + text(width) + " m, height: " + text(across) +
            " m}, material: blackbody, temperature: " + text(250.0 + 50.0 * static_cast<double>(k)) +
            " K, position: " + text(glm::dvec3(kRange_m[k], 0.5 * (across - width), 0)) + "}\n";
  }
  return yaml;
}

TEST(Ranges, TenCentimetresToTwoThousandKilometres) {
  const Eye eye{{0, 0, 0}, {1, 0, 0}, 12.0, 60};
  Range range("range of plates 0.1 m to 2000 km off in one picture", 1e-6, "plane over cosine; single precision"),
      direct("radiance of plates 0.1 m to 2000 km off through air, optical depth 1e-7 to 2", 1e-5, "B(T) exp(-x) + B(280 K) (1 - exp(-x))"),
      reference("radiance of plates 0.1 m to 2000 km off through air, in double", 2e-5, "B(T) exp(-x) + B(280 K) (1 - exp(-x)); bins of 5 1/cm");
  const std::string yaml = stairs("atmosphere: {extinction: 1e-6 /m, temperature: 280 K}\n");
  for (const std::string mode : {"direct", "buffered", "reference"}) {
    const Frame f = finiteFrame((mode == "reference" ? "accuracy: reference\n" : "render: {mode: " + mode + "}\n") + yaml +
                                eye.yaml("[{name: a, response: {band: [8 um, 12 um]}}]", "    near: 0.05 m\n    small_bodies: 0\n    truth: [range]\n"));
    for (size_t k = 0; k < std::size(kRange_m); ++k)
      for (int column : {1, 5, 8})
        for (int row : {3, 30, 56}) {
          const int x = static_cast<int>(k) * kColumns + column;
          const double r = kRange_m[k] / eye.ray(x, row).direction.x, depth = 1e-6 * r,
                       want = blackBodyBand(8, 12, 250.0 + 50.0 * static_cast<double>(k)) * std::exp(-depth) - blackBodyBand(8, 12, 280) * std::expm1(-depth);
          range.add(at(layer(f, "truth.range"), f, x, row), r, mode + ", " + text(r) + " m");
          (mode == "reference" ? reference : direct).add(at(f.layers[0], f, x, row), want, mode + ", " + text(r) + " m");
        }
  }
}

// What stands out of reversed depth at 2000 km: a plate a few metres before another still hides it.
TEST(Ranges, NearerOfTwoAtTwoThousandKilometres) {
  for (double gap_m : {100.0, 10.0, 1.0})
    for (const char* order : {"near first", "far first"}) {
      auto body = [&](const char* name, double x, double kelvin) {
        return "  - {name: " + std::string(name) + ", shape: {model: plate, width: 900 km, height: 900 km}, material: blackbody, temperature: " + text(kelvin) +
               " K, position: [" + text(x) + " m, 0 m, 0 m]}\n";
      };
      const std::string near = body("near", -2e6 + gap_m, 300), far = body("far", -2e6, 400);
      const std::string yaml =
          "entities:\n" + (std::string(order) == "near first" ? near + far : far + near) + Look{.from = "[0 m, 0 m, 0 m]", .at = "[-1 m, 0 m, 0 m]"}.yaml();
      EXPECT_NEAR(middle(yaml) / blackBodyBand(8, 12, 300), 1.0, 1e-5) << gap_m << " m, " << order;
    }
}

std::string geodetic(double latitude, double longitude, double height) {
  char text[160];
  std::snprintf(text, sizeof text, "geodetic: {latitude: %.12f deg, longitude: %.12f deg, height: %.6f m}", latitude, longitude, height);
  return text;
}

double rangeBetween(const std::string& origin, const std::string& body, const std::string& camera, double* radiance = nullptr) {
  const Frame f = finiteFrame(
      "origin: " + origin +
      "\natmosphere: {extinction: 2 /km, temperature: 280 K}\n"
      "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 300 K, heading: 37 deg, pitch: 41 deg, " +
      body + "}]\ncameras: [{name: c, film: {width: 5, height: 5}, field_of_view: 1 deg, aperture: 20 mm, small_bodies: 0, look_at: p, " + camera +
      ", truth: [range], channels: [{name: a, response: {band: [8 um, 12 um]}}]}]\n");
  if (radiance) *radiance = middleOf(f);
  return at(layer(f, "truth.range"), f, 2, 2);
}

constexpr const char* kOrigins[] = {"{latitude: 0 deg, longitude: 0 deg}", "{latitude: 90 deg, longitude: 0 deg}", "{latitude: -90 deg, longitude: 123 deg}",
                                    "{latitude: 12 deg, longitude: 180 deg}", "{latitude: 12 deg, longitude: -180 deg}"};

// Above one place on the ellipsoid heights are lengths; the frame's origin may be anywhere, the far side of the earth included.
TEST(Ranges, MillimetresOfHeightAnywhere) {
  Range step("millimetre steps of height, poles, date line and antipodes, origin anywhere", 2e-7, "difference of heights; float of 10 m");
  Range seen("radiance of a plate through 10 m of air at poles, date line and antipodes", 1e-5, "Beer-Lambert");
  for (const char* origin : kOrigins)
    for (const auto& [latitude, longitude] :
         {std::pair{0.0, 0.0}, {90.0, 0.0}, {90.0, 211.0}, {-90.0, -77.0}, {12.0, 180.0}, {12.0, -180.0}, {-47.3, 359.9999}})
      for (int mm : {0, 1, 2, 5}) {
        double radiance = 0.0;
        const double want = 10.0 + mm * 1e-3, depth = 2e-3 * want;
        const double got = rangeBetween(origin, geodetic(latitude, longitude, 0), geodetic(latitude, longitude, want), &radiance);
        const std::string at = text(latitude) + ", " + text(longitude) + " from " + origin;
        step.add(got, want, at);
        seen.add(radiance, blackBodyBand(8, 12, 300) * std::exp(-depth) - blackBodyBand(8, 12, 280) * std::expm1(-depth), at);
      }
}

// A degree of longitude on the equator is a chord of a circle of 6378137 m, across the date line and whichever way it is written; on a pole it is nothing.
TEST(Ranges, AcrossTheDateLineAndRoundAPole) {
  Range chord("steps of 1e-8 deg (1.1 mm) across the date line", 2e-7, "chord of the equator; float of 11 m");
  for (const char* origin : kOrigins)
    for (double turn : {0.0, 360.0})
      for (int step = 0; step < 4; ++step) {
        const double degrees = 1e-4 + step * 1e-8;
        chord.add(rangeBetween(origin, geodetic(0, 180, 0), geodetic(0, turn - 180.0 + degrees, 0)), 2.0 * 6378137.0 * std::sin(0.5 * degrees * kPi / 180.0),
                  origin);
      }
  Range pole("10 m over a pole, whatever its longitude", 2e-7, "difference of heights");
  for (double sign : {-1.0, 1.0})
    for (double longitude : {-180.0, -33.0, 0.0, 90.0, 359.0})
      pole.add(rangeBetween(kOrigins[3], geodetic(90 * sign, 12, 0), geodetic(90 * sign, longitude, 10)), 10.0, text(longitude));
}

// In the local frame, far from where it stands.
TEST(Ranges, MillimetreStepsFarFromTheOrigin) {
  Range step("millimetre steps 60 km and 2000 km from the origin", 2e-7, "difference of positions; float of 10 m");
  for (double far : {60e3, 2000e3})
    for (int mm : {0, 1, 2, 5}) {
      char places[200];
      std::snprintf(places, sizeof places, "[0 m, %.6f m, 0 m]", far + mm * 1e-3);
      const Frame f = finiteFrame(
          "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 300 K, position: " + std::string(places) +
          ", heading: 180 deg}]\ncameras: [{name: c, film: {width: 17, height: 17}, field_of_view: 2 deg, aperture: 20 mm, position: [0 m, " +
          text(far - 10.0) + " m, 0 m], heading: 0 deg, truth: [range], channels: [{name: a, response: {band: [8 um, 12 um]}}]}]\n");
      step.add(at(layer(f, "truth.range"), f, 8, 8), 10.0 + mm * 1e-3, places);
    }
}

}  // namespace
}  // namespace pitviper::test
