// Flares: intensity of what is seen of them, courses of their level, ballistics against closed forms, and scenarios.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "materials/fields/flares.hpp"
#include "materials/fields/smoke.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/launch_along.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::shared_ptr<const Trajectory> flying(double speed_m_s) {
  return std::make_shared<const Trajectory>(std::vector<TrajectoryPoint>{{0.0, {0, 0, 1000}, {speed_m_s, 0, 0}, {}, {1, 0, 0, 0}},
                                                                         {10.0, {10.0 * speed_m_s, 0, 1000}, {speed_m_s, 0, 0}, {}, {1, 0, 0, 0}}});
}

FlareCloud cloudOf(const FlareType& type, double speed_m_s, double level) {
  FlareCloudOptions o;
  o.path = flying(speed_m_s);
  o.level = TimeCourse(level);
  o.area_m2 = flareArea_m2(type);
  o.depth = type.depth;
  o.glow_s = type.glow_s;
  o.spread_m_s = type.spread_m_s;
  return FlareCloud(o);
}

/// Intensity over that of I(lambda), seen along a direction: own radiance of its steps, blended from the far end, over a plane.
double seen(const FieldState& state, const glm::dvec3& look, int side = 240) {
  const glm::dvec3 right = glm::normalize(glm::cross(look, glm::dvec3(0.1, 0.3, 1.0))), up = glm::cross(look, right);
  const glm::dvec3 middle = state.origin + 0.5 * (state.low + state.high);
  const double reach = 0.5 * glm::length(state.high - state.low);
  double sum = 0.0;
  std::vector<FieldStep> steps;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const glm::dvec3 at = middle + reach * ((2.0 * (i + 0.5) / side - 1.0) * right + (2.0 * (j + 0.5) / side - 1.0) * up);
      state.along({at - 100.0 * look, look, 0.0, 200.0}, 32, steps);
      double radiance = 0.0;
      for (std::size_t k = steps.size(); k-- > 0;) radiance = radiance * std::exp(-steps[k].amount[0]) - steps[k].gain * std::expm1(-steps[k].amount[0]);
      sum += radiance;
    }
  return sum * 4.0 * reach * reach / (side * side);
}

// Rationale: A/(pi R^2) = 2 int_0^1 (1 - exp(-d y^7)) y dy, by Simpson's rule in 20000 parts. Expected: equal to 1e-9, across where the series ends.
TEST(Flares, OpacityOfAPuff) {
  double worst = 0.0;
  for (double d : {1e-4, 0.3, 3.0, 8.0, 11.99, 12.01, 40.0, 500.0}) {
    constexpr int kParts = 20000;
    double sum = 0.0;
    for (int i = 0; i <= kParts; ++i) {
      const double y = static_cast<double>(i) / kParts;
      sum -= (i == 0 || i == kParts ? 1.0 : i % 2 ? 4.0 : 2.0) * std::expm1(-d * std::pow(y, 7)) * y;
    }
    worst = std::max(worst, std::abs(puffOpacity(d) / (2.0 * sum / (3.0 * kParts)) - 1.0));
  }
  bound("opacity of a puff by its depth", worst, 2e-6, "Simpson's rule; beyond 12 exp(-12) is left out");
}

// Rationale: what is seen of a cloud from the side of its way is I level, however it is drawn out. Expected: 0.1 %; from ahead less, by what it hides of
// itself, and never more.
TEST(Flares, TheCloudSendsWhatIsStated) {
  double worst = 0.0;
  for (const FlareType& type : flareTypes())
    for (double speed : {0.0, 1.0, 40.0, 250.0})
      for (double level : {1.0, 0.2}) {
        const FlareCloud cloud = cloudOf(type, speed, level);
        FieldWorld world;
        world.time_s = 0.7;
        const auto state = cloud.at(world);
        ASSERT_NE(state, nullptr);
        for (const glm::dvec3& look : {glm::dvec3(0, 1, 0), glm::normalize(glm::dvec3(0, 0.3, -1))})
          worst = std::max(worst, std::abs(seen(*state, look) / level - 1.0));
        const double ahead = seen(*state, {1, 0, 0}, 160) / level;
        EXPECT_LT(ahead, 1.002) << type.name << ' ' << speed;
        EXPECT_GT(ahead, 0.2) << type.name << ' ' << speed;
        if (speed == 0.0) {
          EXPECT_NEAR(ahead, 1.0, 2e-3);
        }
      }
  bound("intensity of burning clouds from the side against what is stated", worst, 1e-3, "midpoint rule over a plane, 240 x 240, steps along lines");
}

// Rationale: sizes and brightness follow from the type's temperature. Expected: the band's intensity as stated; standing still no line of sight is brighter
// than a black body of that temperature times emissivity; a fireball of 0.3 to 1 m for the two that burn.
TEST(Flares, AreAsHotAsTheyAreSaidToBe) {
  for (const FlareType& type : flareTypes()) {
    const Spectrum intensity = flareIntensity(type);
    figure("intensity of " + std::string(type.name) + " from 3 to 5 um [W/sr]", intensity.integral(3.0, 5.0), type.intensity_W_sr, 1e-9, "as stated");
    const FlareCloud cloud = cloudOf(type, 0.0, 1.0);
    FieldWorld world;
    const auto state = cloud.at(world);
    const auto& puff = dynamic_cast<const PuffsState&>(*state).puffs().front();
    for (double um = 1.0; um < 14.0; um += 0.1)
      EXPECT_LE(puff.gain * intensity(um), physics::planckRadiance(um, type.temperature_K) * (1.0 + 1e-4)) << type.name << ' ' << um;
    if (type.temperature_K > 1500.0) {
      EXPECT_GT(cloud.radius_m(), 0.15) << type.name;
      EXPECT_LT(cloud.radius_m(), 0.5) << type.name;
    }
    EXPECT_NEAR(areaOf_m2(Spectrum(Spectrum::BlackBody{type.temperature_K, 0.3}), type.temperature_K), 0.3, 1e-9);
  }
  const auto ratio = [](const char* name) {
    const Spectrum i = flareIntensity(*findFlareType(name));
    return i.integral(3.0, 5.0) / i.integral(2.0, 3.0);
  };
  EXPECT_NEAR(ratio("mtv"), 0.69, 0.02);  // of a black body at 2000 K: 0.1764/0.2569 by tables of its fractions
  EXPECT_GT(ratio("spectrally_matched"), 4.0);
}

TEST(Flares, LevelsFollowTheirCourse) {
  const FlareType& type = *findFlareType("mtv");
  EXPECT_EQ(flareBurn(type, 0.0), 0.0);
  EXPECT_NEAR(flareBurn(type, 0.5 * type.rise_s), 0.5, 1e-12);
  EXPECT_EQ(flareBurn(type, 0.5 * type.burn_s), 1.0);
  EXPECT_NEAR(flareBurn(type, type.burn_s - 0.5 * type.fall_s), 0.5, 1e-12);
  EXPECT_EQ(flareBurn(type, type.burn_s), 0.0);
  EXPECT_EQ(flareInWind(type, 0.0), 1.0);
  EXPECT_EQ(flareAtPressure(type, 101325.0), 1.0);
  EXPECT_LT(flareInWind(type, 250.0), 0.35);
  EXPECT_LT(flareAtPressure(type, 26500.0), 0.7);  // 10 km

  FlightWorld world;
  world.uniform.emplace();
  const auto levelAt = [&](double speed, double t) { return flyFlare(type, launchAlong(0.0, {0, 0, 5000}, 0.0, 0.0, speed), world).level.at(t); };
  // Falling from rest it has some 10 m/s after a second.
  EXPECT_NEAR(levelAt(0.01, 1.0), flareInWind(type, 9.6), 0.01);
  EXPECT_LT(levelAt(250.0, 1.0), levelAt(100.0, 1.0));
  EXPECT_EQ(levelAt(100.0, -0.1), 0.0);
  EXPECT_EQ(levelAt(100.0, 20.0), 0.0);
  // Course and laws agree where it is sampled coarsest.
  const FlareFlight flown = flyFlare(type, launchAlong(2.0, {0, 0, 5000}, 0.0, 0.0, 250.0), world);
  double worst = 0.0;
  for (double t = 0.001; t < type.burn_s; t += 0.0137) {
    const double own = flareBurn(type, t) * flareInWind(type, glm::length(flown.path.velocityAt(flown.lit_s + t)));
    worst = std::max(worst, std::abs(flown.level.at(flown.lit_s + t) - own));
  }
  bound("course of a flare's level against its laws", worst, 1e-3, "straight between points");
}

// Rationale: without burning mass, drag and weight balance at sqrt(2 m g/(rho C A)); from a speed along the ground without gravity v = v0/(1 + v0 t/L),
// L = 2 m/(rho C A). Expected: 0.1 %.
TEST(Flares, FlyAsBallisticsHasIt) {
  FlareType type = *findFlareType("mtv");
  type.burntShare = 0.0;
  type.burn_s = 60.0;
  FlightWorld world;
  world.uniform.emplace();
  const FlareFlight fallen = flyFlare(type, launchAlong(0.0, {0, 0, 1e5}, 0.0, 0.0, 5.0), world);
  figure("terminal speed of a flare [m/s]", glm::length(fallen.path.velocityAt(55.0)), std::sqrt(2.0 * type.mass_kg * 9.80665 / (1.225 * type.dragArea_m2)),
         1e-3, "weight and drag");
  world.uniform->gravity_m_s2 = 0.0;
  const FlareFlight flown = flyFlare(type, launchAlong(0.0, {0, 0, 100}, 0.0, 0.0, 250.0), world);
  const double L = 2.0 * type.mass_kg / (1.225 * type.dragArea_m2);
  figure("speed of a flare after 1 s of drag [m/s]", glm::length(flown.path.velocityAt(1.0)), 250.0 / (1.0 + 250.0 / L), 1e-3, "quadratic drag alone");
  // Foils are braked within a hundredth of a second: the path has that too.
  FlareType foil = *findFlareType("pyrophoric");
  const FlareFlight foils = flyFlare(foil, launchAlong(0.0, {0, 0, 100}, 0.0, 0.0, 250.0), world);
  const double l = 2.0 * foil.mass_kg / (1.225 * foil.dragArea_m2);
  double worst = 0.0;
  for (double t = 0.0005; t < 1.0; t *= 1.3) worst = std::max(worst, std::abs(foils.path.at(t).position.y - l * std::log1p(250.0 * t / l)));
  bound("way of foils braked by drag [m]", worst, 1e-3, "L log(1 + v0 t/L); quintic between points");
  // One that burns away is braked harder.
  const FlareFlight burning = flyFlare(*findFlareType("mtv"), launchAlong(0.0, {0, 0, 100}, 0.0, 0.0, 250.0), world);
  EXPECT_LT(glm::length(burning.path.velocityAt(3.0)), 0.9 * glm::length(flown.path.velocityAt(3.0)));
}

const char* const kScene = R"(
time: {frames: 10, rate: 10 Hz}
entities:
  - name: jet
    shape: {model: sphere, radius: 1 m}
    material: blackbody
    temperature: 300 K
    end: 8 s
    motion: [{time: 0 s, position: [0 m, 0 m, 3000 m]}, {time: 10 s, position: [2500 m, 0 m, 3000 m]}]
cameras:
  - name: c
    film: {width: 8, height: 8}
    field_of_view: 20 deg
    aperture: 10 mm
    look_at: jet
    position: [0 m, -500 m, 3000 m]
    channels: [{name: mw, response: {band: [3 um, 5 um]}}]
)";

TEST(Flares, ScenariosHaveThem) {
  const Simulation sim = scene(std::string(kScene) + R"(
flares:
  - name: f
    type: mtv
    from: jet
    time: 0.4 s
    position: [-3 m, 1 m, 0 m]
    direction: {azimuth: -90 deg, elevation: 0 deg}
    speed: 30 m/s
    sequence: {count: 3, interval: 0.2 s, alternate: true}
  - {name: foil, type: pyrophoric, from: jet, time: 1 s, light: false}
)");
  ASSERT_EQ(sim.lights.size(), 3u);
  ASSERT_EQ(sim.fields.size(), 7u);  // three clouds with smoke, one without
  EXPECT_EQ(sim.fields[0].name, "f_0");
  EXPECT_EQ(sim.fields[1].name, "f_0 smoke");
  EXPECT_FALSE(sim.lights[1].visible);
  EXPECT_NEAR(sim.lights[1].intensity.integral(3.0, 5.0), 5000.0, 1e-6);
  // At its ejection: where the jet is, and as fast, with what it was thrown with to the left; the second to the right.
  for (int k : {0, 1}) {
    const Motion& motion = sim.lights[static_cast<std::size_t>(k)].mount.motion;
    const double t = 0.4 + 0.2 * k, side = k == 0 ? 1.0 : -1.0;
    EXPECT_NEAR(glm::length(motion.at(t).position - glm::dvec3(250.0 * t - 3.0, side, 3000.0)), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(motion.velocityAt(t) - glm::dvec3(250.0, side * 30.0, 0.0)), 0.0, 1e-6);
  }
  EXPECT_EQ(sim.lights[0].levelAt(0.39), 0.0);
  EXPECT_GT(sim.lights[0].levelAt(1.0), 0.1);
  // The mass of its smoke: 0.2 kg x 0.8 burnt x 0.8.
  const auto& smoke = dynamic_cast<const SmokeSource&>(*sim.fields[1].source);
  EXPECT_NEAR(smoke.released_kg(0.0, 100.0), 0.128, 1e-9);
  FieldWorld world;
  world.simulation = &sim;
  world.time_s = 2.0;
  EXPECT_NE(smoke.at(world), nullptr);
  EXPECT_NE(sim.fields[0].source->at(world), nullptr);
  world.time_s = 0.2;
  EXPECT_EQ(sim.fields[0].source->at(world), nullptr);
}

TEST(Flares, MistakesAreNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"flares: [{name: f, type: mtv, time: 1 s}]", "from nowhere"},
      {"flares: [{name: f, type: mvt, from: jet, time: 1 s}]", "mtv"},
      {"flares: [{name: f, type: mtv, from: jut, time: 1 s}]", "no entity 'jut'"},
      {"flares: [{name: f, type: mtv, from: jet, time: 9 s}]", "isn't there at 9 s"},
      {"flares: [{name: f, type: mtv, from: jet, time: 1 s, direction: [0, 0, 0]}]", "direction of no length"},
      {"flares: [{name: f, type: mtv, from: jet, time: 1 s, smoke: grean}]", "no smoke 'grean'"},
      {"flares: [{name: f, type: pyrophoric, from: jet, time: 1 s, smoke: true}]", "leaves no smoke"},
      {"flares: [{name: f, type: mtv, from: jet, time: 1 s}, {name: f, type: mtv, from: jet, time: 2 s}]", "second light"},
      {"flares: [{name: f, type: mtv, from: jet, time: 1 s, sequence: {interval: 1 s}}]", "count"},
      {"flares: [{name: f, type: mtv, from: jet, time: 1}]", "time"},
      {"flares: [{name: f, type: mtv, from: jet, time: 1 s, sequence: {count: 257, interval: 0 s}}]", "count"},
      {"flares: [{name: f, type: mtv, from: jet, time: 1 s, mass: 2 g, drag_area: 10 m2}]", "cannot fly"},
      {"flares: [{name: f, type: mtv, from: jet, time: 1 s, spectrum: {band: [20 um, 25 um]}}]", "from 1 to 14 um"}};
  for (const auto& [text, says] : cases) {
    std::string told;
    try {
      scene(std::string(kScene) + text);
    } catch (const UserError& e) {
      told = e.what();
    }
    EXPECT_NE(told.find(says), std::string::npos) << text << "\n" << told;
    EXPECT_NE(told.find(":18:"), std::string::npos) << told;  // the line that the text is at
  }
}

/// The first block of a section of scenarios/README.md that is YAML.
std::string example(const std::string& title) {
  std::ifstream in(std::string(PITVIPER_SOURCE_DIR) + "/scenarios/README.md");
  std::stringstream all;
  all << in.rdbuf();
  const std::string text = all.str();
  const std::size_t section = text.find("\n## " + title + "\n"), from = text.find("```yaml\n", section), to = text.find("```", from + 8);
  return section == std::string::npos || from == std::string::npos ? "" : text.substr(from + 8, to - from - 8);
}

// Expected: what the README shows is read.
TEST(Flares, TheReadmesExamplesAreRead) {
  for (const char* title : {"Smoke", "Flares"}) {
    const std::string text = example(title);
    ASSERT_FALSE(text.empty()) << title;
    EXPECT_FALSE(scene(std::string(kScene) + text).fields.empty()) << title;
  }
}

}  // namespace
}  // namespace pitviper::test
