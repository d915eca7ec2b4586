// The reference as a mode of drawing, through the whole pipeline: against closed forms, and against the GPU where it samples the spectrum finely.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "sim/render/reference/reference_drawer.hpp"
#include "sim/run/spectral_renderer.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

Simulation withSampling(Simulation sim, const SpectralSampling& sampling) {
  for (Camera& c : sim.cameras) c.spectral = sampling;
  for (Probe& p : sim.probes) p.spectral = sampling;
  return sim;
}

SpectralSampling referenceSampling() {
  SpectralSampling s;
  s.reference = true;
  return s;
}

SpectralSampling evenly(int samples) { return {samples, Spacing::Even}; }

/// A Lambertian plate that fills the film, lit from where the camera is, in grey air; its channel and what else belongs to the camera as text.
std::string greyWall(const std::string& camera) {
  return "atmosphere: {extinction: 0.4 /km, temperature: 285 K}\nambient: {temperature: 270 K}\n"
         "entities: [{name: p, shape: {model: plate, width: 400 m, height: 400 m}, temperature: 315 K,\n"
         "  material: {components: [{reflection: lambertian, reflectance: 0.2}]}}]\n"
         "lights: [{name: l, intensity: {blackbody: 2500 K, area: 1 m2}, position: [700 m, 0 m, 0 m], visible: false}]\n"
         "cameras:\n- {name: c, film: {width: 3, height: 3, pitch: 20 um}, field_of_view: 0.1 deg, aperture: 30 mm, position: [700 m, 0 m, 0 m],\n"
         "   look_at: [0 m, 0 m, 0 m], " +
         camera + "}\n";
}

// Beer and Lambert on both legs, a black body's band by the classical series. What is left: Planck's law at the middles of bins of 5 1/cm.
TEST(ReferenceMode, LitWarmWallInGreyAir) {
  for (const auto& [low, high] : {std::pair{3.0, 5.0}, {8.0, 12.0}}) {
    const auto sim = withSampling(scene(greyWall("channels: [{name: a, response: {band: [" + std::to_string(low) + " um, " + std::to_string(high) + " um]}}]")),
                                  referenceSampling());
    const Frame frame = renderFrame(sim);
    const double tau = std::exp(-0.4 * 0.7), air = blackBodyBand(low, high, 285.0);
    // A radiance over an area of 1 m2 is an intensity; the wall is met at a right angle.
    const double lit = 0.2 / M_PI * blackBodyBand(low, high, 2500.0) / (700.0 * 700.0) * tau * tau;
    const double want = (0.8 * blackBodyBand(low, high, 315.0) + 0.2 * blackBodyBand(low, high, 270.0)) * tau + lit + air * (1.0 - tau);
    figure("reference mode, lit wall in grey air, " + std::to_string(static_cast<int>(low)) + "-" + std::to_string(static_cast<int>(high)) + " um [W/(m2 sr)]",
           at(frame.layers.at(0), frame, 1, 1), want, 2e-5, "series of the Planck integral, Beer-Lambert; middles of bins: h2/24 B''/B");
  }
}

constexpr const char* kScene = R"(
atmosphere: hazy_us76
sun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}
ambient: {from: sky}
materials:
  m: {components: [{reflection: lambertian, reflectance: 0.35}, {reflection: phong, reflectance: 0.1, exponent: 20}]}
  pane: {transmission: {transmittance: 0.7}, components: [{reflection: lambertian, reflectance: 0.1}]}
  gas: {absorption: {wavelength: um, unit: 1/m, outside: hold, values: [[2.9, 0.001], [4.2, 0.03], [5.2, 0.002]]}}
lights: [{name: l, intensity: {blackbody: 2500 K, area: 1 m2}, position: [3 m, 170 m, 310 m]}]
entities:
  - {name: ground, shape: {model: plate, width: 80 km, height: 80 km}, material: m, temperature: 290 K, pitch: 90 deg}
  - {name: near, shape: {model: sphere, radius: 10 m}, material: m, temperature: 320 K, position: [0 m, 150 m, 300 m]}
  - {name: far, shape: {model: sphere, radius: 900 m}, material: m, temperature: 270 K, position: [2 km, 25 km, 3 km]}
  - {name: small, shape: {model: cylinder, radius: 0.1 m, length: 2 m}, material: m, temperature: 500 K, position: [40 m, 600 m, 400 m], heading: 60 deg}
  - {name: window, shape: {model: plate, width: 20 m, height: 20 m}, material: pane, temperature: 280 K, position: [12 m, 100 m, 300 m], heading: 90 deg}
  - {name: puff, shape: {model: sphere, radius: 20 m}, material: gas, temperature: 600 K, position: [-40 m, 300 m, 310 m]}
cameras:
  - name: c
    film: {width: 40, height: 40}
    field_of_view: 30 deg
    aperture: 5 mm
    small_bodies: 4
    position: [0 m, 0 m, 300 m]
    look_at: [0 m, 10 km, 1200 m]
    truth: [range, entity, normal, temperature]
    channels: [{name: vis, response: {band: [0.5 um, 0.51 um]}}, {name: mw, response: {band: [4.1 um, 4.3 um]}}, {name: lw, response: {band: [9.2 um, 9.7 um]}}]
)";

// Ground, bodies large, far and smaller than pixels, a pane, hot gas, a light in view, the sun, its light in the air, the sky.
TEST(ReferenceMode, EveryTermAgainstTheGpu) {
  // The sky's light by direction is told by harmonics on the GPU: what that loses has its own test (tests/physics/test_surroundings.cpp).
  std::string text = kScene;
  const std::string sky = "{from: sky}";
  text.replace(text.find(sky), sky.size(), "{temperature: 250 K}");
  auto sim = scene(text);
  sim.cameras[0].zoomedSamples = 64;  // on both sides
  const Frame reference = renderFrame(withSampling(sim, referenceSampling())), gpu = renderFrame(withSampling(sim, evenly(96)));
  for (const char* name : {"vis.radiance", "mw.radiance", "lw.radiance"}) {
    std::vector<double> errors;
    const auto &a = layer(reference, name).pixels, &b = layer(gpu, name).pixels;
    for (size_t p = 0; p < a.size(); ++p) errors.push_back(std::abs(static_cast<double>(b[p]) / static_cast<double>(a[p]) - 1.0));
    std::sort(errors.begin(), errors.end());
    const std::string what = std::string("GPU at 96 even samples against reference mode, ") + name;
    bound(what + ", median", errors[errors.size() / 2], 2e-3, "tables of the air");
    bound(what + ", worst pixel", errors.back(), 8e-3, "tables of the air; silhouettes of the puff");
  }
  for (const auto& truth : reference.layers)
    if (truth.name.starts_with("truth")) {
      const auto& other = layer(gpu, truth.name).pixels;
      double scale = 0.0, off = 0.0;
      for (size_t p = 0; p < other.size(); ++p) {
        scale = std::max(scale, std::abs(static_cast<double>(other[p])));
        off = std::max(off, std::abs(static_cast<double>(truth.pixels[p]) - static_cast<double>(other[p])));
      }
      bound(truth.name + " on the GPU against double, of its largest", off / std::max(scale, 1e-30), 3e-6, "single precision");
    }
}

TEST(ReferenceMode, SpectralImageAndProbe) {
  const auto sim =
      scene(greyWall("spectral_image: {band: [3 um, 5 um], bins: 4}, channels: [{name: a, response: {band: [3 um, 5 um]}}]") +
            "probes: [{name: q, position: [0.5 m, 0 m, 0 m], normal: [1, 0, 0.2], resolution: 16, channels: [{name: a, response: {band: [3 um, 5 um]}, "
            "output: irradiance}]}]\n");
  const auto fine = withSampling(sim, referenceSampling()), even = withSampling(sim, evenly(96));
  needContext();
  const WorldState state = advance(sim, 0.0);
  auto image = [&](const Simulation& s) { return SpectralRenderer(s, s.cameras[0], shaderLibrary(), std::make_shared<const GpuScene>(s)).render(state, 0); };
  const Frame a = image(fine), b = image(even);
  double worst = 0.0;
  for (size_t l = 0; l < a.layers.size(); ++l)
    for (size_t p = 0; p < a.layers[l].pixels.size(); ++p)
      worst = std::max(worst, std::abs(static_cast<double>(b.layers[l].pixels[p]) / static_cast<double>(a.layers[l].pixels[p]) - 1.0));
  bound("spectral image, Gauss points on the GPU against reference mode", worst, 5e-5, "Planck's law at the middles of bins; single precision");
  const double q = probeReading(fine)[0];
  figure("probe, 96 even samples on the GPU against reference mode", probeReading(even)[0], q, 5e-5, "Planck's law at the middles of bins; single precision");
}

TEST(ReferenceMode, TellsHowFarAPictureIs) {
  auto sim = withSampling(scene(kScene), referenceSampling());
  // What is told is of rows and small bodies, whatever their wavelengths.
  sim.cameras[0].outputs.resize(1);
  sim.cameras[0].zoomedSamples = 32;
  needContext();
  CameraRenderer renderer(sim, sim.cameras[0], cameraPlan(sim, sim.cameras[0]), shaderLibrary(), std::make_shared<const GpuScene>(sim));
  for (int picture = 0; picture < 2; ++picture) {
    std::vector<double> shares;
    renderer.setProgress([&](double s) { shares.push_back(s); });
    renderer.render(advance(sim, 0.0));
    ASSERT_GT(shares.size(), 2u);  // several rows at once on many cores
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_LT(shares.front(), 0.5);
    EXPECT_EQ(shares.back(), 1.0);
  }
}

// It shades on the CPU, and tells truth there.
TEST(ReferenceMode, DrawsOnTheGpuWhatIsSeenAlone) {
  needContext();
  const Simulation sim = withSampling(scene(kScene), referenceSampling());
  const Camera& camera = sim.cameras[0];
  const Plan plan = makePlan(sim, camera.outputs, camera.spectral, camera.where);
  ASSERT_TRUE(plan.terms.shadows);
  const auto gpu = std::make_shared<const GpuScene>(sim);
  const auto programsOf = [&](bool truth) {
    Camera own = camera;
    own.truth.range = truth;
    const long before = programsSoFar().programs;
    CameraRenderer renderer(sim, own, plan, shaderLibrary(), gpu);
    renderer.setWanted({0});
    renderer.render(advance(sim, 0.0));
    return static_cast<double>(programsSoFar().programs - before);
  };
  bound("programs of a first reference without truth", programsOf(false), 4.0,
        "what each subpixel sees: of a picture or a part of one, of many bodies at once, behind boxes; which panes it meets");
  bound("programs of a further one", programsOf(false), 1.0, "those of solids are the scene's");
  bound("programs of one with truth", programsOf(true), 1.0, "the same");
}

}  // namespace
}  // namespace pitviper::test
