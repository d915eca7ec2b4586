// A sensor applied to a spectral image against the same sensor in the scene, and against closed forms.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/sensor_reader.hpp"
#include "sim/frame/file_formats.hpp"
#include "sim/frame/integrate.hpp"
#include "sim/run/spectral_renderer.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

class SpectralImages : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// Through the file, as a user's.
  SpectralImage imageOf(const Simulation& sim) const {
    needContext();
    SpectralRenderer renderer(sim, sim.cameras.at(0), shaderLibrary(), std::make_shared<const GpuScene>(sim));
    writeExrFile(folder_ / "image.exr", renderer.render(advance(sim, 0.0), 0), {});
    return readSpectralImage(folder_ / "image.exr");
  }
  IntegratedFrame integrated(const SpectralImage& image, const std::string& sensor) const {
    std::ofstream(folder_ / "sensor.yaml") << sensor;
    const fs::path home = PITVIPER_SOURCE_DIR;
    const Sensor s = readSensor(folder_ / "sensor.yaml", image.pinhole, image.exposure_s,
                                {home / "materials/library", home / "atmosphere/library", home / "sensors/library"});
    return integrateSpectralImage(image, s.outputs, s.pinhole, s.exposure_s);
  }
  fs::path folder_ = fs::temp_directory_path() / ("pitviper_spectral_" + std::to_string(getpid()));
};

/// A grey, lit plate before a colder field in air, half over the picture; the camera's channels as text.
std::string greyScene(const std::string& channels, const std::string& spectral, const std::string& optics = "0.9") {
  return "atmosphere: {extinction: 0.4 /km, temperature: 285 K}\nbackground: {temperature: 250 K}\nambient: {temperature: 270 K}\n"
         "entities: [{name: p, shape: {model: plate, width: 40 m, height: 30 m}, temperature: 315 K,\n"
         "  material: {components: [{reflection: lambertian, reflectance: 0.2}]}, position: [0 m, 10 m, 0 m]}]\n"
         "cameras:\n- {name: c, film: {width: 12, height: 10, pitch: 60 um}, field_of_view: 4 deg, aperture: 30 mm, exposure: 3 ms, optics: " +
         optics +
         ", position: [700 m, 0 m, 0 m],\n"
         "   heading: 270 deg, spectral_image: " +
         spectral + ",\n   channels: " + channels + "}\n";
}

/// Relative differences of two layers, sorted.
std::vector<double> differences(const FrameLayer& a, const FrameLayer& b) {
  std::vector<double> d;
  for (size_t p = 0; p < a.pixels.size(); ++p) d.push_back(std::abs(static_cast<double>(a.pixels[p]) / static_cast<double>(b.pixels[p]) - 1.0));
  std::sort(d.begin(), d.end());
  return d;
}

TEST_F(SpectralImages, BinsAreMeansOfPlanck) {
  const auto sim = scene(
      "entities: [{name: p, shape: {model: plate, width: 9 m, height: 9 m}, material: blackbody, temperature: 300 K}]\n"
      "cameras: [{name: c, film: {width: 3, height: 3, pitch: 20 um}, field_of_view: 1 deg, aperture: 30 mm, position: [9 m, 0 m, 0 m], look_at: p,\n"
      "  spectral_image: {band: [3 um, 12 um], bins: 36, spacing: log}, channels: [{name: a, response: {band: [3 um, 12 um]}}]}]\n");
  const SpectralImage image = imageOf(sim);
  ASSERT_EQ(image.bins.size(), 36u);
  EXPECT_DOUBLE_EQ(image.edge_um.front(), 3.0);
  EXPECT_DOUBLE_EQ(image.edge_um.back(), 12.0);
  double worst = 0.0;
  for (size_t k = 0; k < image.bins.size(); ++k) {
    const double low = image.edge_um[k], high = image.edge_um[k + 1];
    worst = std::max(worst, std::abs(static_cast<double>(image.bins[k][4]) / (blackBodyBand(low, high, 300.0) / (high - low)) - 1.0));
  }
  bound("36 bins of a spectral image, 300 K, 3-12 um, worst error", worst, 1e-6, "series of the Planck integral over each bin; single precision");
  const auto result = integrated(image, "channels: [{name: mw, response: {band: [3 um, 12 um]}, output: [radiance, flux]}]\n");
  figure("black plate integrated later, 3-12 um [W/(m2 sr)]", at(layer(result.frame, "mw.radiance"), result.frame, 1, 1), blackBodyBand(3, 12, 300), 1e-6,
         "series of the Planck integral; single precision");
}

TEST_F(SpectralImages, FlatResponsesAreExact) {
  const std::string channels =
      "[{name: a, response: {band: [3 um, 5 um]}, gain: 2e6 V/W, output: [radiance, radiance_per_um, flux, irradiance, exposure, volts]},"
      " {name: b, response: {band: [3.5 um, 4.25 um]}, output: [radiance, focal_irradiance]}]";
  const auto sim = scene(greyScene(channels, "{band: [3 um, 5 um], bins: 32}"));
  const auto result = integrated(imageOf(sim), "optics: 0.9\nchannels: " + channels + "\n");
  const Frame direct = renderFrame(sim);
  ASSERT_EQ(result.frame.layers.size(), direct.layers.size());
  double worst = 0.0, stated = 0.0;
  for (size_t l = 0; l < direct.layers.size(); ++l) {
    EXPECT_EQ(result.frame.layers[l].name, direct.layers[l].name);
    EXPECT_EQ(result.frame.layers[l].unit, direct.layers[l].unit);
    worst = std::max(worst, differences(result.frame.layers[l], direct.layers[l]).back());
    stated = std::max(stated, result.binning[l].maximum);
  }
  bound("flat channels integrated later against drawn, 8 quantities, worst pixel", worst, 1e-6, "same integral; single precision");
  bound("stated error of these", stated, 0.0, "a flat response meets bin means exactly");
}

// Of responses that change over a bin the error is stated: it is what is found, to the next order in the bin's width.
TEST_F(SpectralImages, TheStatedErrorIsTheTrueOne) {
  const std::string channels =
      "[{name: slope, response: {wavelength: um, unit: \"1\", values: [[3, 0.1], [5, 1]]}},\n"
      "    {name: roof, response: {wavelength: um, unit: \"1\", values: [[3.2, 0], [3.6, 1], [4.7, 0]]}},\n"
      "    {name: cut, response: {band: [3.4 um, 4.4 um]}},\n"
      "    {name: photons, response: {band: [3 um, 5 um]}, quantum_efficiency: insb_mwir, output: electrons}]";
  const auto sim = scene(greyScene(channels, "{band: [3 um, 5 um], bins: 16}"));
  const auto result = integrated(imageOf(sim), "optics: 0.9\nchannels: " + channels + "\n");
  const Frame direct = renderFrame(sim);
  for (size_t l = 0; l < direct.layers.size(); ++l) {
    const std::string name = "16 bins, " + direct.layers[l].name;
    const auto found = differences(result.frame.layers[l], direct.layers[l]);
    const double median = found[found.size() / 2], worst = found.back();
    EXPECT_GT(median, 1e-5) << name << ": too exact to tell";
    figure(name + ", median error stated", result.binning[l].median, median, 0.1, "first order in the bin's width; the next is h2 L'''/L'");
    figure(name + ", largest error stated", result.binning[l].maximum, worst, 0.1, "the same");
  }
}

// Bodies and lights smaller than a pixel, and subpixels, are in the bins as they are in the channels.
TEST_F(SpectralImages, HoldSmallBodiesAndLights) {
  const std::string channels = "[{name: a, response: {band: [3 um, 5 um]}, output: [radiance, flux]}]";
  const auto sim = scene(
      "atmosphere: {extinction: 0.1 /km, temperature: 280 K}\nbackground: {temperature: 260 K}\n"
      "entities: [{name: s, shape: {model: sphere, radius: 0.4 m}, material: blackbody, temperature: 800 K}]\n"
      "lights: [{name: f, intensity: {blackbody: 2000 K, area: 0.02 m2}, position: [0 m, 60 m, 20 m]}]\n"
      "cameras: [{name: c, film: {width: 15, height: 15, pitch: 20 um}, field_of_view: 5 deg, aperture: 30 mm, samples: 2, position: [2 km, 0 m, 0 m], "
      "look_at: s,\n"
      "  spectral_image: {band: [3 um, 5 um], bins: 40}, channels: " +
      channels + "}]\n");
  const auto result = integrated(imageOf(sim), "channels: " + channels + "\n");
  const Frame direct = renderFrame(sim);
  bound("small body and light integrated later against drawn, worst pixel",
        std::max(differences(result.frame.layers[0], direct.layers[0]).back(), differences(result.frame.layers[1], direct.layers[1]).back()), 1e-6,
        "same integral; single precision");
  figure("the same, all flux [W]", sum(layer(result.frame, "a.flux")), sum(layer(direct, "a.flux")), 1e-6, "same integral; single precision");
}

// The pixels keep their angles: another focal length changes the pitch, and irradiance on the film follows the aperture only.
TEST_F(SpectralImages, AnotherCameraLooksThroughTheSamePixels) {
  const auto sim = scene(greyScene("[{name: a, response: {band: [3 um, 5 um]}, output: [flux, focal_irradiance]}]", "{band: [3 um, 5 um], bins: 8}", "1"));
  const auto image = imageOf(sim);
  const std::string channels = "channels: [{name: a, response: {band: [3 um, 5 um]}, output: [flux, focal_irradiance]}]\n";
  const auto as = integrated(image, channels), other = integrated(image, "aperture: 60 mm\npixel_pitch: 30 um\n" + channels);
  figure("twice the aperture, flux", sum(other.frame.layers[0]) / sum(as.frame.layers[0]), 4.0, 1e-6, "aperture area");
  figure("twice the aperture, half the pitch, film irradiance", sum(other.frame.layers[1]) / sum(as.frame.layers[1]), 16.0, 1e-6, "F-number");
}

}  // namespace
}  // namespace pitviper::test
