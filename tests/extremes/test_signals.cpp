// Radiances from 1e-30 to 1e9 W/(m2 sr um) through every mode, through files and previews; counts to 1e22; spectra that are zero, or one line.
#include "scenarios/commands/commands.hpp"
#include "sim/frame/file_formats.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/frame/integrate.hpp"
#include "sim/image/exr.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/run/spectral_renderer.hpp"
#include "tests/extremes/extremes.hpp"
#include "tests/support/fog_world.hpp"

namespace pitviper::test {
namespace {

constexpr const char* kRadiances[] = {"1e-30", "1e-20", "1e-9", "1", "1e9", "1e20", "1e30"};
std::string background(const std::string& radiance) { return "background: {radiance: " + radiance + " W/(m2 sr um)}\n"; }

TEST(Radiance, FromFaintToBlinding) {
  const TemporaryFolder folder;
  Range drawn("radiance 1e-30 to 1e30 W/(m2 sr um), direct, buffered, in double", 1e-6, "4 um of it; single precision");
  Range written("radiance 1e-30 to 1e30 W/(m2 sr um) written as EXR and read again", 0.0, "every bit");
  Range integrated("radiance 1e-30 to 1e30 W/(m2 sr um) as a spectral image, written, read, integrated", 1e-6, "4 um of it");
  for (const char* radiance : kRadiances) {
    const double want = 4.0 * std::stod(radiance);
    for (const char* mode : {"render: {mode: direct}\n", "render: {mode: buffered}\n", "accuracy: reference\n"})
      drawn.add(middle(mode + background(radiance) + Look{}.yaml()), want, radiance);
    const Frame f = finiteFrame(background(radiance) + Look{}.yaml());
    const auto file = std::filesystem::path(folder.put("f.exr", ""));
    writeExrFile(file, f, {});
    written.add(static_cast<double>(readExr(file).layers.at(0).pixels.at(12)), middleOf(f), radiance);
    writePreviewFile(folder.put("f.png", ""), f);

    const Simulation sim = scene(background(radiance) + Look{.more = "spectral_image: {band: [8 um, 12 um], bins: 4}, "}.yaml());
    SpectralRenderer renderer(sim, sim.cameras.at(0), shaderLibrary(), std::make_shared<const GpuScene>(sim));
    writeExrFile(file, renderer.render(advance(sim, 0.0), 0), {});
    const SpectralImage image = readSpectralImage(file);
    const IntegratedFrame i = integrateSpectralImage(image, sim.cameras[0].outputs, image.pinhole, 0.0);
    integrated.add(static_cast<double>(i.frame.layers.at(0).pixels.at(12)), want, radiance);
    EXPECT_TRUE(std::isfinite(i.binning.at(0).maximum));
  }
}

// Beside each other in one picture: the faint is not lost in the light of the bright, and the preview has a colour for both.
TEST(Radiance, FaintBesideBlinding) {
  const TemporaryFolder folder;
  const std::string yaml =
      "background: {radiance: 1e-30 W/(m2 sr um)}\nentities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: "
      "100000 K, position: [0 "
      "m, 2 m, 0 m]}]\n" +
      Look{.field_deg = 10, .more = "small_bodies: 0, "}.yaml();
  double hot = 0.0;  // trapezoidal, 1e-3 um
  for (int k = 0; k <= 4000; ++k) hot += (k % 4000 ? 1e-3 : 0.5e-3) * planck(8.0 + 1e-3 * k, 100000);
  for (const char* mode : {"", "render: {mode: buffered}\n", "accuracy: reference\n"}) {
    const Frame f = finiteFrame(mode + yaml);
    EXPECT_NEAR(at(f.layers[0], f, 0, 2) / 4e-30, 1.0, 1e-6) << mode;
    EXPECT_NEAR(at(f.layers[0], f, 4, 2) / hot, 1.0, 4e-5) << mode;  // bins of 5 1/cm in double
    writePreviewFile(folder.put("f.png", ""), f);
  }
}

// The whole chain from watts to photons, electrons and volts, its factors in double precision.
TEST(Signals, CountsFromNothingToTheMost) {
  Range counts("photons, electrons, volts, joules on a pixel, counts 1e-34 to 1e36", 2e-4,
               "L x pixel x aperture x time, by hand; the pixel's own size: cos4 over 0.4 deg");
  const double pixel = std::pow(2.0 * std::tan(kPi / 180.0) / 5.0, 2), aperture = 0.25 * kPi, perJoule = 4e-6 / (6.62607015e-34 * 299792458.0);
  double least = 1e300, most = 0.0;
  for (const char* radiance : {"1e-30", "1e-9", "1", "1e9", "1e15"})
    for (double exposure : {1e-12, 1.0, 1e6}) {
      Look look{
          .more = "exposure: " + text(exposure) + " s, ",
          .channels = "[{name: a, response: {band: [3.9 um, 4.1 um]}, quantum_efficiency: 0.5, gain: 2 V/W, output: [photons, electrons, volts, exposure]}]"};
      std::string yaml = background(radiance) + look.yaml();
      yaml.replace(yaml.find("aperture: 20 mm"), 15, "aperture: 1 m");
      const Frame f = renderFrame(scene(yaml));
      const double flux = std::stod(radiance) * 0.2 * pixel * aperture, photons = flux * perJoule * exposure;
      const std::string at = std::string(radiance) + ", " + text(exposure) + " s";
      const double want[] = {photons, 0.5 * photons, 2.0 * flux, flux * exposure};
      for (size_t k = 0; k < 4; ++k) {
        const double got = middleOf(f, k);
        if (want[k] < 1.2e-38) {  // beyond single precision: nothing, never a wrong number
          EXPECT_GE(got, 0.0) << at;
          EXPECT_LE(got, 1.2e-38) << at;
          continue;
        }
        least = std::min(least, want[k]), most = std::max(most, want[k]);
        counts.add(got, want[k], at);
      }
    }
  EXPECT_LT(least, 1e-30);
  EXPECT_GT(most, 1e22);
}

std::string error(const std::string& yaml) {
  try {
    renderFrame(scene(yaml));
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(Spectra, ZeroEverywhere) {
  const std::string zeros = "{wavelength: um, unit: UNIT, values: [[3, 0], [14, 0]]}";
  auto unit = [&](std::string u) { return std::string(zeros).replace(zeros.find("UNIT"), 4, u); };
  Look none;
  none.channels = "[{name: a, response: " + unit("\"1\"") + "}]";
  EXPECT_NE(error(plate(300) + none.yaml()).find("zero everywhere"), std::string::npos);
  Range kept("plate under lights, air, ambient, reflectance, emission whose spectra are 0", 2e-5, "B(300 K); bins of 5 1/cm in double");
  for (const char* mode : {"", "render: {mode: buffered}\n", "accuracy: reference\n"}) {
    kept.add(middle(mode +
                    ("sun: {azimuth: 0 deg, elevation: 40 deg, irradiance: " + unit("W/(m2 um)") + "}\nlights: [{name: l, intensity: " + unit("W/(sr um)") +
                     ", position: [2 m, 0 m, 0 m]}]\nambient: {radiance: " + unit("W/(m2 sr um)") + "}\natmosphere: {extinction: " + unit("1/m") +
                     ", temperature: 250 K}\n") +
                    plate(300, "{components: [{reflection: lambertian, reflectance: " + unit("\"1\"") + "}]}") + Look{.from = "[9 m, 1 m, 1 m]"}.yaml()),
             blackBodyBand(8, 12, 300), mode);
    EXPECT_EQ(middle(mode + plate(300, "{emission: {emissivity: " + unit("\"1\"") + "}}") + Look{}.yaml()), 0.0);
    EXPECT_EQ(middle(mode + ("background: {radiance: " + unit("W/(m2 sr um)") + "}\n") + Look{}.yaml()), 0.0);
  }
}

// One triangular line in a table: as response its integral times the radiance at its middle.
TEST(Spectra, ResponseOfOneLine) {
  Range line("response of one line 1e-3 to 1e-8 um wide", 2e-5, "width x B at its middle");
  for (double width : {1e-3, 1e-5, 1e-7, 1e-8})
    for (const char* mode : {"", "render: {mode: buffered}\n", "accuracy: reference\n"}) {
      char values[160];
      std::snprintf(values, sizeof values, "[[%.12g, 0], [10, 1], [%.12g, 0]]", 10.0 - width, 10.0 + width);
      Look look;
      look.channels = "[{name: a, response: {wavelength: um, unit: \"1\", values: " + std::string(values) + "}}]";
      line.add(middle(mode + plate(300) + look.yaml()), width * planck(10.0, 300), mode + text(width));
    }
}

// Sources, surfaces and media of one line, under a response that holds it. Reference mode integrates its own bins of 5 1/cm (0.05 um at 10 um); the
// line is wider than that. What a few samples see of a line is the plan's; here it must be finite, and not below nothing.
TEST(Spectra, OfOneLine) {
  const std::string line = "{wavelength: um, unit: UNIT, values: [[8, 0], [9.5, 0], [10, 1], [10.5, 0], [12, 0]]}";
  auto unit = [&](std::string u) { return std::string(line).replace(line.find("UNIT"), 4, u); };
  const double half = 0.5;
  Range lit("plate lit by sun and lamp of one line, in double", 2e-3, "its integral; bins of 5 1/cm across its bends");
  for (const char* mode : {"", "render: {mode: buffered}\n", "accuracy: reference\n"}) {
    const std::string white = plate(0, "white_lambertian");
    const double sun = middle(mode + ("sun: {azimuth: 90 deg, elevation: 0 deg, irradiance: " + unit("W/(m2 um)") + "}\n") + white + Look{}.yaml());
    const double lamp =
        middle(mode + ("lights: [{name: l, intensity: " + unit("W/(sr um)") + ", visible: false, position: [2 m, 0 m, 0 m]}]\n") + white + Look{}.yaml());
    const double emitted = middle(mode + plate(300, "{emission: {emissivity: " + unit("\"1\"") + "}}") + Look{}.yaml());
    for (double v : {sun, lamp, emitted}) EXPECT_GE(v, 0.0) << mode;
    if (std::string(mode) != "accuracy: reference\n") continue;
    lit.add(sun, half / kPi, "sun");
    lit.add(lamp, half / kPi / 4.0, "lamp");
    double want = 0.0;  // trapezoidal, 1e-3 um
    for (int k = -500; k <= 500; ++k) want += 1e-3 * (1.0 - std::abs(k) / 500.0) * planck(10.0 + 1e-3 * k, 300);
    lit.add(emitted, want, "emissivity");
  }
}

}  // namespace
}  // namespace pitviper::test
