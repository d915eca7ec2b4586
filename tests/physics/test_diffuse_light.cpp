// Light that the air scatters any number of times: pictures against photons followed through layers made anew, and photons against closed forms.
//
// Rationale: pictures, planner and reference take it from the same moments (sim/radiance/diffuse_light.hpp); photons know nothing of these.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <tuple>

#include "sim/camera/camera_renderer.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/photon_walk.hpp"
#include "tests/support/print.hpp"
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

/// By as many photons as tell it to a standard error, relative, at most `most`.
double radianceOf(const PhotonWalk& walk, double depthAbove, const glm::dvec3& direction, double error, int most) {
  constexpr int kLook = 2500;
  WalkDice dice(7);
  double sum = 0.0, squares = 0.0;
  for (int k = 1;; ++k) {
    const auto found = walk.from(depthAbove, direction, dice);
    const double v = found.once + found.again + found.ground;
    sum += v, squares += v * v;
    if (k % kLook != 0) continue;
    const double mean = sum / k;
    if (k >= most || squares / k - mean * mean <= k * error * error * mean * mean) return mean;
  }
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
                   found = radianceOf(walk, 0.0, {std::sqrt(1.0 - m * m), 0.0, -m}, 0.004, 100000);
      worst = std::max(worst, std::abs(found / expected - 1.0));
    }
  bound("light sent back by a deep layer of isotropic scattering against Chandrasekhar's H, relative", worst, 0.015,
        "photons 0.4 %, of nine the worst at most 1.2; layers of 0.3 of a depth at most");
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
  air.asymmetry = node.meanAsymmetry;
  air.toSun = {std::sqrt(1.0 - sine * sine), 0.0, sine};
  return PhotonWalk(air);
}

/// Radiance along lines of a scene, in double precision, at single wavelengths, by so many streams.
class Lines {
 public:
  Lines(const Simulation& sim, const std::vector<double>& um, int streams) : sim_(sim), terms_(termsOf(sim)), state_(advance(sim, 0.0)) {
    for (double w : um) nodes_.push_back(nodeAt(sim, w));
    terms_.streams = streams;
    spectra_.emplace(sim, nodes_, terms_);
    legs_ = SunLegs::of(sim.air, sim.sun->toSun.z, sim.frame.earthRadius_m());
  }
  std::vector<double> along(const glm::dvec3& origin, const glm::dvec3& direction) const {
    NodeSum sum(*spectra_);
    sum.begin();
    LineOfSight line{origin, direction, castRay(sim_, state_, origin, direction, 0.1), 0.0};
    radianceAlong({sim_, terms_, legs_.get(), state_, {}}, line, sum);
    return {sum.radiance().begin(), sum.radiance().end()};
  }

 private:
  const Simulation& sim_;
  Terms terms_;
  WorldState state_;
  std::vector<SpectralNode> nodes_;
  std::optional<NodeSpectra> spectra_;
  std::shared_ptr<const SunLegs> legs_;
};

std::string airScene(const std::string& air, double sunElevation_deg, const std::string& ground = "") {
  return "atmosphere: " + air + "\nsun: {azimuth: 0 deg, elevation: " + print("%g", sunElevation_deg) + " deg, temperature: 5772 K}\n" + ground +
         "cameras: [{name: e, film: {width: 3, height: 3}, field_of_view: 0.1 deg, aperture: 5 mm, position: [0 m, 0 m, 10 m], heading: 0 deg, pitch: 10 deg, "
         "channels: [{name: b, response: {band: [0.449 um, 0.451 um]}, output: radiance_per_um}]}]\n";
}

/// By heading from the sun and elevation.
glm::dvec3 towards(double heading_deg, double elevation_deg) {
  const double a = heading_deg * kPi / 180.0, e = elevation_deg * kPi / 180.0;
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

/// What 8, 12 and 16 streams lose of a line's radiance: against twice as many as are ever chosen, upwards, level and downwards, of the sun and thermal.
std::vector<double> lostByStreams(const std::vector<std::string>& airs) {
  const std::vector<double> um{0.42, 0.9, 4.0, 10.0};
  const std::vector<int> all{8, 12, 16};
  std::vector<double> worst(all.size(), 0.0);
  for (const std::string& air : airs)
    for (double sun : {3.0, 15.0, 60.0}) {
      const Simulation sim = scene(airScene(air, sun, "ground: {material: dry_grass}\n"));
      const Lines exact(sim, um, 32);
      std::vector<Lines> some;
      for (int n : all) some.emplace_back(sim, um, n);
      for (double height : {2.0, 1000.0, 9000.0})
        for (double heading : {0.0, 40.0, 180.0})
          for (double pitch : {-80.0, -20.0, -3.0, 0.5, 10.0, 40.0, 85.0}) {
            const std::vector<double> right = exact.along({0, 0, height}, towards(heading, pitch));
            for (size_t n = 0; n < all.size(); ++n) {
              const std::vector<double> found = some[n].along({0, 0, height}, towards(heading, pitch));
              for (size_t i = 0; i < um.size(); ++i) worst[n] = std::max(worst[n], std::abs(found[i] / right[i] - 1.0));
            }
          }
    }
  return worst;
}

TEST(DiffuseLight, StreamsLose) {
  const std::vector<double> clear =
                                lostByStreams({"clear_us76", "hazy_us76", "{library: hazy_mls, visibility: 5 km}", "{library: hazy_us76, visibility: 1 km}"}),
                            fog = lostByStreams({"{library: hazy_us76, aerosol: advection_fog, visibility: 1 km, haze_top: 300 m}"});
  const double most[] = {0.005, 0.002, 0.001}, mostInFog[] = {0.95, 0.05, 0.01};
  const int all[] = {8, 12, 16};
  for (size_t n = 0; n < std::size(all); ++n) {
    bound(print("what %d streams lose of a line's radiance", all[n]), clear[n], most[n], "32 streams; a sun 3 to 60 degrees up, visibilities from 1 to 100 km");
    bound(print("what %d streams lose in fog", all[n]), fog[n], mostInFog[n],
          "forward peaks, worst along its top away from a sun 3 degrees up; plans choose by a camera's own lines");
  }
}

TEST(DiffuseLight, IsWhatWalksAlongTheWholeLineFind) {
  // Photons followed from the camera on, through layers made anew: light scattered once is the picture's own, and all of it over that the factor.
  double worst = 0.0;
  for (const char* air :
       {"clear_us76", "hazy_us76", "{library: hazy_mls, visibility: 5 km}", "{library: hazy_us76, aerosol: radiation_fog, visibility: 1 km, haze_top: 300 m}"})
    for (double pitch : {10.0, 35.0, 89.0}) {
      const Simulation sim = scene(std::string("atmosphere: ") + air +
                                   "\nsun: {azimuth: 0 deg, elevation: 35 deg, temperature: 5772 K}\ncameras: [{name: e, film: {width: 3, height: 3}, " +
                                   "field_of_view: 0.1 deg, aperture: 5 mm, position: [0 m, 0 m, 10 m], heading: 3 deg, pitch: " + print("%g", pitch) +
                                   " deg, channels: [{name: b, response: {band: [0.449 um, 0.451 um]}, output: radiance_per_um}, "
                                   "{name: r, response: {band: [0.649 um, 0.651 um]}, output: radiance_per_um}]}]\n");
      const Frame frame = renderFrame(sim);
      for (const auto& [um, number] : {std::pair{0.45, size_t{0}}, {0.65, size_t{1}}}) {
        const PhotonWalk walk = layersOf(sim, um);
        // Beside the sun's disc.
        const double up = pitch * kPi / 180.0, aside = 3.0 * kPi / 180.0, height = 10.0;
        const glm::dvec3 direction(std::cos(up) * std::cos(aside), std::cos(up) * std::sin(aside), std::sin(up));
        const double above = sim.air->opticalDepth(sim.air->node(um), sim.air->amounts({height, 1.0, sim.frame.earthRadius_m()}, physics::kFar));
        const double found = radianceOf(walk, above, direction, 0.01, 60000) * sim.sun->irradiance(um), drawn = at(frame.layers[number], frame, 1, 1);
        std::printf("%s at %g deg, %g um: drawn %.4g, photons %.4g, %+.2f %%\n", air, pitch, um, drawn, found, 100.0 * (drawn / found - 1.0));
        worst = std::max(worst, std::abs(drawn / found - 1.0));
      }
    }
  bound("skies along 24 lines of sight against photons through layers made anew, relative", worst, 0.04, "level layers at 10 degrees 2 %; photons 1 %");
}

}  // namespace
}  // namespace pitviper::test
