// What is said of light scattered more than once: photons' ways against closed forms, and the factor against daylight and published skies.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <tuple>

#include "sim/camera/camera_renderer.hpp"
#include "sim/plan/photon_walk.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "sim/world/world.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Even air of a depth, its sunlight by Beer's law.
WalkAir evenAir(double depth, double albedo, double g, double sinSun, double ground) {
  constexpr int kLayers = 400;
  WalkAir air;
  for (int k = 0; k <= kLayers; ++k) {
    // Closer together at the top, where a thick layer's light is.
    const double t = 1.0 - static_cast<double>(k) / kLayers;
    air.above.push_back(depth * t * t);
    air.sunlight.push_back(std::exp(-air.above.back() / sinSun));
  }
  air.molecules.assign(kLayers, 0.0), air.haze.assign(kLayers, albedo);
  air.asymmetry = g, air.groundAlbedo = ground, air.toSun = {std::sqrt(1.0 - sinSun * sinSun), 0.0, sinSun};
  return air;
}

double radianceOf(const PhotonWalk& walk, double depthAbove, const glm::dvec3& direction, int count) {
  WalkDice dice(7);
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    const auto found = walk.from(depthAbove, direction, dice);
    sum += found.once + found.again + found.ground;
  }
  return sum / count;
}

/// Chandrasekhar's H of isotropic scattering, H = 1 + m H(m) w/2 integral of H(x) / (m + x) dx, by iteration.
double chandrasekharH(double m, double albedo) {
  const auto rule = gaussLegendre(64, 0.0, 1.0);
  std::vector<double> h(rule.size(), 1.0);
  const auto next = [&](double at) {
    double sum = 0.0;
    for (size_t k = 0; k < rule.size(); ++k) sum += rule[k].weight * rule[k].x * h[k] / (at + rule[k].x);
    return 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * sum);
  };
  for (int turn = 0; turn < 400; ++turn) {
    std::vector<double> better;
    for (const auto& n : rule) better.push_back(next(n.x));
    for (size_t k = 0; k < h.size(); ++k) h[k] = 0.5 * (h[k] + better[k]);
  }
  return next(m);
}

TEST(PhotonWalk, IsChandrasekharsHalfSpace) {
  // L = w / (4 pi) m0 / (m + m0) H(m) H(m0) for an irradiance of 1 across the beam. Source: Chandrasekhar 1960, Radiative Transfer, section 34.
  double moment = 0.0;
  for (const auto& n : gaussLegendre(64, 0.0, 1.0)) moment += n.weight * chandrasekharH(n.x, 0.9);
  figure("mean of H for an albedo of 0.9", moment, 2.0 / 0.9 * (1.0 - std::sqrt(0.1)), 1e-4, "closed form, Chandrasekhar's theorem 1 on H-functions");
  double worst = 0.0;
  for (double albedo : {0.5, 0.9, 0.98})
    for (const auto& [m0, m] : {std::pair{1.0, 1.0}, {0.6, 0.3}, {0.3, 0.8}}) {
      const PhotonWalk walk(evenAir(60.0, albedo, 0.0, m0, 0.0));
      const double expected = albedo / (4.0 * kPi) * m0 / (m + m0) * chandrasekharH(m, albedo) * chandrasekharH(m0, albedo),
                   found = radianceOf(walk, 0.0, {std::sqrt(1.0 - m * m), 0.0, -m}, 100000);
      worst = std::max(worst, std::abs(found / expected - 1.0));
    }
  bound("light sent back by a deep layer of isotropic scattering against Chandrasekhar's H, relative", worst, 0.015,
        "100000 photons, layers of 0.3 of a depth at most");
}

TEST(PhotonWalk, LosesNothing) {
  // White ground under air that only scatters: what comes down evenly goes up evenly, flux by flux.
  double worst = 0.0;
  for (double g : {0.0, 0.7}) {
    const double m = 0.64, depth = 1.5;
    const PhotonWalk walk(evenAir(depth, 1.0, g, m, 1.0));
    WalkDice dice(3);
    double up = 0.0;
    constexpr int kWays = 60000;
    for (int k = 0; k < kWays; ++k) {
      const auto d = PhotonWalk::evenlySent({0.0, 0.0, -1.0}, dice);
      const auto found = walk.from(0.0, d, dice);
      up += kPi * (found.once + found.again + found.ground) / kWays;
    }
    worst = std::max(worst, std::abs(up / m - 1.0));
  }
  bound("flux that leaves white air over white ground, of what came in", worst, 0.02, "60000 photons");
}

/// Light on the ground under a layer by photons: Henyey and Greenstein's directions drawn from equal steps of their integral.
double onGroundByPhotons(double depth, double albedo, double g, double sinSun, int photons) {
  std::uint64_t seed = 12345;
  const auto dice = [&seed] {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (static_cast<double>(seed >> 11) + 0.5) * 0x1p-53;
  };
  double landed = 0.0;
  for (int n = 0; n < photons; ++n) {
    double t = 0.0, weight = 1.0;
    glm::dvec3 d(std::sqrt(1.0 - sinSun * sinSun), 0.0, sinSun);  // z down
    while (weight > 1e-4) {
      t -= std::log(dice()) * d.z;
      if (t >= depth) landed += weight;
      if (t >= depth || t <= 0.0) break;
      weight *= albedo;
      const double u = 2.0 * dice() - 1.0, s = (1.0 - g * g) / (1.0 + g * u), c = (1.0 + g * g - s * s) / (2.0 * g),
                   across = std::sqrt(std::max(1.0 - c * c, 0.0)), phi = 2.0 * kPi * dice();
      const glm::dvec3 x = glm::normalize(glm::cross(std::abs(d.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), d)), y = glm::cross(d, x);
      d = glm::normalize(c * d + across * (std::cos(phi) * x + std::sin(phi) * y));
    }
  }
  return sinSun * landed / photons;
}

TEST(PhotonWalk, IsWhatPhotonsDoForwards) {
  double worst = 0.0, eddington = 0.0;
  for (const auto& [depth, albedo, sun] : {std::tuple{0.5, 0.95, 0.64}, {2.0, 0.95, 0.64}, {6.0, 0.94, 0.64}, {6.0, 1.0, 0.64}, {1.0, 0.9, 0.3}}) {
    const PhotonWalk walk(evenAir(depth, albedo, 0.66, sun, 0.0));
    WalkDice dice(5);
    double down = sun * std::exp(-depth / sun);
    constexpr int kWays = 40000;
    for (int k = 0; k < kWays; ++k) {
      const auto d = PhotonWalk::evenlySent({0.0, 0.0, 1.0}, dice);
      const auto found = walk.from(depth, d, dice);
      down += kPi * (found.once + found.again + found.ground) / kWays;
    }
    worst = std::max(worst, std::abs(down / onGroundByPhotons(depth, albedo, 0.66, sun, 40000) - 1.0));
    // Without loss: 1 / (1 + 3/4 (1 - g) t) of a sun at cos 2/3 comes through (Joseph, Wiscombe and Weinman 1976).
    if (albedo == 1.0) eddington = std::abs(down / sun * (1.0 + 0.75 * 0.34 * depth) - 1.0);
  }
  bound("light on the ground under layers of depth 0.5 to 6, followed back against 40000 photons sent down, relative", worst, 0.03, "1 % each");
  bound("the same without loss against Eddington's closed form, relative", eddington, 0.06, "two streams; sun at 0.64 for 0.667");
}

double again(const Frame& frame, const std::string& channel) {
  for (const auto& a : frame.attributes)
    if (a.name == "pitviper.scattered_again." + channel) return std::get<double>(a.value);
  return 1.0;
}

std::string fogScene(double visibility_km) {
  return "atmosphere: {library: hazy_us76, visibility: " + print("%g", visibility_km) +
         " km}\nsun: {azimuth: 90 deg, elevation: 40 deg, irradiance: solar_e490}\nambient: {from: sky}\nentities:\n"
         "  - {name: white, shape: {model: plate, width: 3 m, height: 3 m}, material: white_lambertian, temperature: 288 K, position: [0 m, 0 m, 10 m], "
         "heading: 90 deg}\n"
         "  - {name: ground, shape: {model: plate, width: 30 km, height: 30 km}, heading: 180 deg, pitch: 90 deg, material: green_grass, temperature: 288 K}\n"
         "cameras: [{name: w, film: {width: 9, height: 9}, field_of_view: 1 deg, aperture: 50 mm, position: [100 m, 0 m, 10 m], look_at: white,\n"
         "  channels: [{name: vis, response: {band: [0.5 um, 0.6 um]}}, {name: lw, response: {band: [10 um, 10.1 um]}}]}]\n";
}

TEST(ScatteredAgain, FogIsDaylightAfterAll) {
  // A white plate 100 m off in the sun. Haze of 5 km takes little from daylight, what it scatters comes from elsewhere; haze of 1 km, six optical
  // depths of albedo 0.94, swallows most (a fifth comes through), where the picture has a thousandth.
  double daylight = 0.0, most = 1.0, least = 1.0, fog = 0.0, before = 1.0;
  for (double v : {50.0, 23.0, 5.0, 2.0, 1.0}) {
    const Frame frame = renderFrame(scene(fogScene(v)));
    const double once = at(frame.layers[0], frame, 4, 4), factor = again(frame, "vis");
    std::printf("visibility %g km: %.3g W/(m2 sr), times %.3g = %.3g\n", v, once, factor, once * factor);
    if (v == 50.0) daylight = once;
    if (v >= 5.0) most = std::max(most, once * factor / daylight), least = std::min(least, once * factor / daylight);
    else fog = std::max(fog, daylight / (once * factor));
    EXPECT_GE(factor, before * 0.99) << v;
    before = factor;
    EXPECT_EQ(again(frame, "lw"), 1.0);  // the sun does not light it
  }
  bound("white plate in haze of 5 to 50 km, with the factor stated, over daylight", most, 2.0, "a wall in haze sees half of its light from the grass's side");
  bound("daylight over the same", 1.0 / least, 2.5, "the same");
  bound("daylight over the same, haze of 1 and 2 km", fog, 14.0,
        "its own absorption, 6 optical depths of albedo 0.94; a wall faces half of what is left, and hardly any from the grass");
  EXPECT_GT(before, 100.0);
}

TEST(ScatteredAgain, HazySkies) {
  // Horizon of a hazy sky away from the sun at 0.55 um, over black ground: published skies have 100 W/(m2 sr um) over land; scattered once 15.
  const auto sky = [](const char* air, double pitch) {
    return renderFrame(scene(
        std::string("atmosphere: ") + air +
        "\nsun: {azimuth: 210 deg, elevation: 40 deg, temperature: 5772 K}\ncameras: [{name: e, film: {width: 3, height: 3}, field_of_view: 0.2 deg, "
        "aperture: 5 "
        "mm, position: [0 m, 0 m, 10 m], heading: 30 deg, pitch: " +
        print("%g", pitch) +
        " deg, channels: [{name: g, response: {band: [0.545 um, 0.555 um]}, output: radiance_per_um}, {name: lw, response: {band: [10 um, 10.1 um]}}]}]\n"));
  };
  for (double pitch : {0.3, 10.0, 30.0, 89.9}) {
    const Frame frame = sky("hazy_us76", pitch);
    const double once = at(frame.layers[0], frame, 1, 1), factor = again(frame, "g");
    std::printf("hazy sky at %g deg: %.3g, times %.3g = %.3g W/(m2 sr um)\n", pitch, once, factor, once * factor);
    if (pitch == 0.3) {
      EXPECT_GT(once * factor, 40.0);
      EXPECT_LT(once * factor, 200.0);
    }
    EXPECT_EQ(again(frame, "lw"), 1.0);
  }
}

/// The air of a scene in even layers, for its sun, as a walk has it: none of the check's own columns and lines.
PhotonWalk layersOf(const Simulation& sim, double um) {
  constexpr int kLayers = 240;
  const AirNode node = sim.air->node(um);
  const double sine = sim.sun->toSun.z, radius = sim.frame.earthRadius_m();
  WalkAir air;
  double small = 0.0, large = 0.0;
  for (int k = 0; k <= kLayers; ++k) {
    const double h = 60e3 * std::pow(k / double(kLayers), 2.5);
    const AirAmounts up = sim.air->powered(sim.air->amounts({h, 1.0, radius}, physics::kFar));
    air.above.push_back(Atmosphere::depthOf(node, up));
    air.sunlight.push_back(std::exp(-sim.air->opticalDepth(node, sim.air->amounts({h, sine, radius}, physics::kFar))));
    double s = 0.0, l = 0.0;
    for (size_t a = 0; a < kMostAirAmounts; ++a) s += node.molecules[a] * up.amount[a], l += node.haze[a] * up.amount[a];
    if (k > 0) {
      const double all = air.above[static_cast<size_t>(k) - 1] - air.above.back();
      air.molecules.push_back((small - s) / all), air.haze.push_back((large - l) / all);
    }
    small = s, large = l;
  }
  air.asymmetry = node.asymmetry;
  air.toSun = {std::sqrt(1.0 - sine * sine), 0.0, sine};
  return PhotonWalk(air);
}

TEST(ScatteredAgain, IsWhatWalksAlongTheWholeLineFind) {
  // Photons followed from the camera on, through layers made anew: light scattered once is the picture's own, and all of it over that the factor.
  double worst = 0.0, once = 0.0;
  for (const char* air : {"clear_us76", "hazy_us76", "{library: hazy_mls, visibility: 5 km}"})
    for (double pitch : {10.0, 35.0, 89.0}) {
      const Simulation sim = scene(std::string("atmosphere: ") + air +
                                   "\nsun: {azimuth: 0 deg, elevation: 35 deg, temperature: 5772 K}\ncameras: [{name: e, film: {width: 3, height: 3}, " +
                                   "field_of_view: 0.1 deg, aperture: 5 mm, position: [0 m, 0 m, 10 m], heading: 0 deg, pitch: " + print("%g", pitch) +
                                   " deg, channels: [{name: b, response: {band: [0.449 um, 0.451 um]}, output: radiance_per_um}, "
                                   "{name: r, response: {band: [0.649 um, 0.651 um]}, output: radiance_per_um}]}]\n");
      const Frame frame = renderFrame(sim);
      for (const auto& [um, channel, number] : {std::tuple{0.45, "b", size_t{0}}, {0.65, "r", size_t{1}}}) {
        const PhotonWalk walk = layersOf(sim, um);
        const double up = pitch * kPi / 180.0, height = 10.0;
        const glm::dvec3 direction(std::cos(up), 0.0, std::sin(up));
        const double above = sim.air->opticalDepth(sim.air->node(um), sim.air->amounts({height, 1.0, sim.frame.earthRadius_m()}, physics::kFar));
        WalkDice dice(11);
        double first = 0.0, rest = 0.0;
        constexpr int kWays = 30000;
        for (int k = 0; k < kWays; ++k) {
          const auto found = walk.from(above, direction, dice);
          first += found.once / kWays, rest += found.again / kWays;
        }
        const double drawn = at(frame.layers[number], frame, 1, 1), sun = sim.sun->irradiance(um);
        once = std::max(once, std::abs(first * sun / drawn - 1.0));
        worst = std::max(worst, std::abs(again(frame, channel) / (1.0 + rest / first) - 1.0));
      }
    }
  bound("light scattered once along 18 lines of sight through layers made anew, against the picture, relative", once, 0.05, "level layers; photons 1 %");
  bound("the factor stated against all that such photons find, relative", worst, 0.12, "400 ways each at two wavelengths: 5 % by chance");
}

TEST(ScatteredAgain, IsToldWhereItIsMoreThanAskedForAndNowhereElse) {
  const auto told = [](const char* air, double sun, const char* camera, const char* head = "", const char* ambient = "{from: sky}") {
    const Frame frame = renderFrame(
        scene(std::string(head) + "atmosphere: " + air + print("\nsun: {azimuth: 90 deg, elevation: %g deg, temperature: 5772 K}\nambient: ", sun) + ambient +
              "\nentities: [{name: p, shape: {model: plate, width: 3 m, height: 3 m}, material: white_lambertian, temperature: 288 K, heading: 90 deg, "
              "position: [0 m, 0 m, 10 "
              "m]}]\ncameras: [{name: c, film: {width: 3, height: 3}, field_of_view: 0.5 deg, aperture: 5 mm, position: [50 m, 0 m, 10 m], " +
              camera + "}]\n"));
    return again(frame, "n");
  };
  const std::string plate = "look_at: p, channels: [{name: n, response: {band: ",
                    sky = "heading: 30 deg, pitch: 60 deg, channels: [{name: n, response: {band: ";
  const auto in = [](const std::string& what, const char* band) { return what + band + "}}]"; };
  // A clear visible sky, its optical depth of scattering a tenth.
  EXPECT_GT(told("clear_us76", 60.0, in(sky, "[0.5 um, 0.6 um]").c_str()), 1.08);
  EXPECT_GT(told("clear_us76", 60.0, in(sky, "[0.4 um, 0.5 um]").c_str()), 1.2);
  // Within what is asked for, at night, in thermal bands, without a sun to speak of: nothing.
  EXPECT_EQ(told("clear_us76", 60.0, in(plate, "[1.5 um, 1.7 um]").c_str()), 1.0);
  EXPECT_EQ(told("clear_us76", 60.0, in(plate, "[8 um, 12 um]").c_str()), 1.0);
  EXPECT_EQ(told("{library: hazy_us76, visibility: 1 km}", 60.0, in(plate, "[8 um, 12 um]").c_str()), 1.0);
  EXPECT_EQ(told("hazy_us76", -25.0, in(sky, "[0.5 um, 0.6 um]").c_str()), 1.0);
  EXPECT_EQ(told("clear_us76", 60.0, in(plate, "[0.6 um, 0.7 um]").c_str(), "accuracy: 10 %\n"), 1.0);
}

TEST(ScatteredAgain, IsThatOfTheSecondWhicheverPicturesAreDrawn) {
  // A camera that climbs by 500 m a second through haze and looks at the sky.
  const Simulation sim = scene(
      "time: {rate: 4 Hz, frames: 16}\natmosphere: hazy_us76\nsun: {azimuth: 90 deg, elevation: 40 deg, temperature: 5772 K}\n"
      "cameras: [{name: c, film: {width: 3, height: 3}, field_of_view: 0.5 deg, aperture: 5 mm, "
      "motion: [{time: 0 s, position: [0 m, 0 m, 10 m], heading: 30 deg, pitch: 30 deg}, "
      "{time: 4 s, position: [0 m, 0 m, 2010 m], heading: 30 deg, pitch: 30 deg}], "
      "channels: [{name: n, response: {band: [0.5 um, 0.6 um]}}]}]\n");
  const Camera& camera = sim.cameras.front();
  const Plan plan = cameraPlan(sim, camera);
  const ScatteringCheck check(sim, camera, plan);
  const auto factor = [](const std::vector<ScatteredAgain>& all) { return all.empty() ? 1.0 : all.front().factor; };
  ScatteringBySecond all(sim, camera, plan);
  double last = 0.0;
  for (int number = 0; number < 16; ++number) {
    const double time_s = sim.time.at(number);
    ScatteringBySecond alone(sim, camera, plan);
    all.begin(advance(sim, time_s));
    alone.begin(advance(sim, time_s));
    const double found = factor(all.finish());
    EXPECT_EQ(found, factor(alone.finish()));
    EXPECT_EQ(found, factor(check.at(advance(sim, std::floor(time_s)))));
    EXPECT_EQ(found != last, number % 4 == 0);
    last = found;
  }
  // Where a command has put it elsewhere, from there.
  WorldState moved = advance(sim, 2.6);
  moved.cameras["c"].position = glm::dvec3(0.0, 0.0, 9000.0);
  ScatteringBySecond there(sim, camera, plan);
  there.begin(moved);
  EXPECT_EQ(factor(there.finish()), factor(check.at(moved)));
  EXPECT_NE(factor(there.finish()), factor(check.at(advance(sim, 2.0))));
}

}  // namespace
}  // namespace pitviper::test
