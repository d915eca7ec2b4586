// An atmosphere in one file and its formula (exponential_air.glsl): grey or coloured air of one temperature that thins out with height. No other file knows it.
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/models.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/model/scene_fingerprint.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/assembly/air_on_gpu.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "tests/extensions/exponential_air.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

constexpr double kOne[] = {1.0};

class ExponentialOnGpu final : public AirOnGpu {
 public:
  explicit ExponentialOnGpu(double scale_m) : scale_m_(scale_m) {}
  void addSlots(ShaderSlots& slots) const override {
    slots.generated["path"] =
        "//@use tests/extensions/exponential_air.glsl\nfloat airLength(float height_m, float sinElevation, float range_m) {\n"
        "  return exponentialAmount(height_m, sinElevation, range_m, float(AIR_SCALE_MM) * 1.0e-3);\n}\n//@use atmosphere/one_amount.glsl\n";
    slots.constants["AIR_SCALE_MM"] = std::llround(1e3 * scale_m_);
  }

 private:
  double scale_m_;
};

class ExponentialAir final : public Atmosphere {
 public:
  ExponentialAir(Spectrum extinction_per_m, double scale_m, double temperature_K)
      : extinction_per_m_(std::move(extinction_per_m)), scale_m_(scale_m), temperature_K_(temperature_K) {}
  std::unique_ptr<AirOnGpu> onGpu(const Simulation&, const Plan&, bool) const override { return std::make_unique<ExponentialOnGpu>(scale_m_); }
  std::span<const double> exponents() const override { return kOne; }
  AirNode node(double w) const override {
    AirNode n;
    n.extinction[0] = extinction_per_m_(w);
    n.source = physics::planckRadiance(w, temperature_K_);
    return n;
  }
  double top_m() const override { return physics::kFar; }
  AirAmounts amounts(const AirRay& ray, double range_m) const override {
    AirAmounts a;
    a.amount[0] = physics::exponentialAmount(ray.height_m, ray.sinElevation, std::min(range_m, physics::kFar), scale_m_);
    return a;
  }
  double groundTemperature_K() const override { return temperature_K_; }
  double validLow_um() const override { return extinction_per_m_.validLow(); }
  double validHigh_um() const override { return extinction_per_m_.validHigh(); }
  std::vector<double> knots_um() const override { return extinction_per_m_.knots(); }
  void addTo(Fingerprint& f) const override {
    f.add("exponential").add(scale_m_).add(temperature_K_);
    pitviper::addTo(f, extinction_per_m_);
  }

 private:
  Spectrum extinction_per_m_;
  double scale_m_, temperature_K_;
};

AirModel exponentialModel() {
  return {
      "exponential",
      "Air of one temperature that thins out with height, over flat ground.",
      {},
      {required(atLeast(spectrum("extinction", "1/m", "at height 0"), 0.0)),
       required(within(number("scale_height", "m", "in which it thins out to 1/e"), 1.0, 1e5)), withDefault(number("temperature", "K", "of the air"), "280 K")},
      [](const AirRecord& air) {
        return std::make_shared<ExponentialAir>(air.spectra.at("extinction"), air.record.number("scale_height"), air.record.number("temperature"));
      },
      {{"tests/extensions/exponential_air.glsl",
        readFileStart(std::filesystem::path(PITVIPER_SOURCE_DIR) / "tests/extensions/exponential_air.glsl", 1 << 20)}}};
}

[[maybe_unused]] const bool kRegistered = airModels().add(exponentialModel());

}  // namespace

namespace test {
namespace {

const std::string kAir = "atmosphere: {model: exponential, extinction: 0.2 /km, scale_height: 2 km, temperature: 260 K}\nground: {temperature: 290 K}\n";

/// A camera at a height looks `range_m` far under an elevation at a black sphere of 500 K.
Frame sphereAt(double height_m, double elevation_deg, double range_m, const std::string& accuracy, const std::string& air = kAir) {
  const double e = elevation_deg * kPi / 180.0;
  const std::string place = std::to_string(range_m * std::cos(e)) + " m, 0 m, " + std::to_string(height_m + range_m * std::sin(e)) + " m]";
  return renderFrame(scene(accuracy + air + "materials: {m: {components: [{reflection: lambertian, reflectance: 0}]}}\n" +
                           "entities: [{name: p, shape: {model: sphere, radius: 200 m}, material: m, temperature: 500 K, position: [" + place + "}]\n" +
                           "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.05 deg, aperture: 20 mm, position: [0 m, 0 m, " +
                           std::to_string(height_m) + " m], look_at: p, channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n"));
}

// L = B(500 K) tau + B(260 K) (1 - tau), tau = exp(-gamma exp(-h/H) s (1 - exp(-x)) / x); grey air. Level, up, down and from high up.
TEST(ExponentialAir, DimsByItsAmount) {
  for (const char* accuracy : {"", "accuracy: 1 %\n", "accuracy: reference\n"})
    for (const auto& [height_m, elevation_deg] : {std::pair{100.0, 0.0}, {100.0, 30.0}, {3000.0, -20.0}, {5000.0, 5.0}}) {
      const double range_m = 6000.0, near_m = range_m - 200.0, x = near_m * std::sin(elevation_deg * kPi / 180.0) / 2000.0;
      const double amount = std::exp(-height_m / 2000.0) * near_m * (x == 0.0 ? 1.0 : -std::expm1(-x) / x), tau = std::exp(-2e-4 * amount);
      const Frame f = sphereAt(height_m, elevation_deg, range_m, accuracy);
      figure("a sphere through exponential air, " + std::to_string(static_cast<int>(elevation_deg)) + " deg up from " +
                 std::to_string(static_cast<int>(height_m)) + " m, " + (*accuracy ? "accuracy " + std::string(accuracy + 10, 3) : "sampled"),
             at(layer(f, "mw.radiance"), f, 4, 4), blackBodyBand(3, 5, 500) * tau + blackBodyBand(3, 5, 260) * (1.0 - tau),
             *accuracy && accuracy[10] == '1' ? 0.01 : 1e-4, "closed form; up to 0.8 m of a sphere's faces in 6 km");
    }
}

// A lamp's light comes and goes through it: both legs.
TEST(ExponentialAir, OnTheWayToALamp) {
  const Frame f = renderFrame(
      scene("atmosphere: {model: exponential, extinction: 0.5 /km, scale_height: 1 km, temperature: 1 K}\nground: {temperature: 0 K}\n"
            "materials: {m: {components: [{reflection: lambertian, reflectance: 0.5}]}}\n"
            "lights: [{name: lamp, intensity: 5 kW/(sr um), position: [900 m, 0 m, 700 m], visible: false}]\n"
            "entities: [{name: p, shape: {model: plate, width: 40 m, height: 40 m}, material: m, temperature: 0 K, position: [0 m, 0 m, 100 m]}]\n"
            "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.02 deg, aperture: 20 mm, position: [1000 m, 0 m, 100 m], look_at: p, "
            "channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n"));
  const double d2 = 900.0 * 900.0 + 600.0 * 600.0, d = std::sqrt(d2), x = 0.6, thin = std::exp(-0.1);
  const double amount = thin * (1000.0 + d * -std::expm1(-x) / x), tau = std::exp(-5e-4 * amount);
  figure("a plate under a lamp, both ways through exponential air [W/(m2 sr)]", at(layer(f, "mw.radiance"), f, 4, 4),
         2.0 * 0.5 / kPi * 5000.0 * (900.0 / d) / d2 * tau, 1e-4, "rho I cos / (pi d^2) tau of both legs; a curved earth under both");
}

// What is in its table of parameters holds, and what is of other airs is refused.
TEST(ExponentialAir, IsReadByItsTable) {
  EXPECT_NE(keyReference().find("### atmosphere: exponential"), std::string::npos);
  const auto refusal = [](const std::string& air) -> std::string {
    try {
      sphereAt(100.0, 0.0, 6000.0, "", "atmosphere: " + air + "\n");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{model: exponential, extinction: 1 /km}").find("missing key 'scale_height'"), std::string::npos);
  EXPECT_NE(refusal("{model: exponental, extinction: 1 /km}").find("exponential"), std::string::npos);
  EXPECT_NE(refusal("{model: exponential, extinction: 1 /km, scale_height: 1 km, visibility: 5 km}")
                .find("'visibility' is of layered air, and this air is exponential"),
            std::string::npos)
      << refusal("{model: exponential, extinction: 1 /km, scale_height: 1 km, visibility: 5 km}");
  EXPECT_NE(refusal("{extinction: 1 /km, scale_height: 1 km}").find("'scale_height' is of exponential air, and this air is homogeneous"), std::string::npos);
  EXPECT_NE(refusal("{extinction: -1 /km}").find("range"), std::string::npos) << refusal("{extinction: -1 /km}");
}

TEST(AirModels, TwoOfOneNameAreRefused) {
  Registry<AirModel> two("air", {exponentialModel(), exponentialModel()});
  EXPECT_THROW(two.all(), std::logic_error);
}

}  // namespace
}  // namespace test
}  // namespace pitviper
