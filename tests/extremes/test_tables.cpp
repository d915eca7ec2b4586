// Not-a-number and infinity in any table that goes in: refused with a message that names the place, never drawn.
#include <limits>
#include <sstream>

#include "atmosphere/absorber_table.hpp"
#include "atmosphere/tabulated_csv.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/sensor_reader.hpp"
#include "sim/frame/file_formats.hpp"
#include "sim/frame/integrate.hpp"
#include "sim/image/exr.hpp"
#include "sim/parameters/error.hpp"
#include "sim/run/spectral_renderer.hpp"
#include "sim/scene/mesh_tools.hpp"
#include "sim/scene/primitives.hpp"
#include "tests/extremes/extremes.hpp"
#include "tests/support/fog_world.hpp"

namespace pitviper::test {
namespace {

int replaced = 0, taken = 0;

class NotANumber : public ::testing::Test {
 protected:
  static void TearDownTestSuite() {
    bound("numbers of input replaced by nan or infinity and not refused at their file", taken, 0,
          "of " + std::to_string(replaced) + ": scenario, CSV, sensor file, air table, air CSV");
  }
};

constexpr const char* kNotNumbers[] = {"nan", ".nan", "inf", "-.inf", "1e999"};

template <class Read>
std::string refusal(Read read) {
  try {
    read();
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

/// Every number of a text, a number of its own between blanks, commas, colons or brackets, once replaced by each; `read` takes the text. The text as it is is
/// taken.
template <class Read>
void sweep(const std::string& good, const std::string& place, Read read) {
  ASSERT_EQ(refusal([&] { read(good); }), "") << good;
  int numbers = 0;
  auto splits = [](char c) { return std::string(" ,[]:\n{}").find(c) != std::string::npos; };
  for (size_t from = 0; from < good.size(); ++from) {
    if (from > 0 && !splits(good[from - 1])) continue;
    size_t to = from;
    while (to < good.size() && !splits(good[to])) ++to;
    const std::string word = good.substr(from, to - from);
    if (word.empty() || word.find_first_not_of("0123456789.-+e") != std::string::npos || word.find_first_of("0123456789") == std::string::npos) continue;
    ++numbers;
    for (const char* bad : kNotNumbers) {
      const std::string text = good.substr(0, from) + bad + good.substr(to);
      const std::string message = refusal([&] { read(text); });
      ++replaced;
      taken += message.substr(0, place.size()) != place;
      EXPECT_EQ(message.substr(0, place.size()), place) << bad << " for " << word << " at " << from << " of\n"
                                                        << good << "\n: " << (message.empty() ? "taken" : message);
      EXPECT_NE(message.find("; expected "), std::string::npos) << message;
    }
  }
  EXPECT_GT(numbers, 0) << good;
}

void scenario(const std::string& good) {
  sweep(good, "test.yaml:", [](const std::string& text) { scene(text); });
}

const std::string kPlateOf = "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, temperature: 300 K, material: ";
std::string material(const std::string& m) { return kPlateOf + m + "}]\n" + Look{.pixels = 1}.yaml(); }

TEST_F(NotANumber, InSpectraOfAScenario) {
  auto table = [](const std::string& unit) { return "{wavelength: um, unit: " + unit + ", values: [[7, 0.5], [13, 0.6]]}"; };
  Look look;
  look.channels = "[{name: a, response: " + table("\"1\"") + ", quantum_efficiency: " + table("\"1\"") + "}]";
  scenario(plate(300) + look.yaml());
  look.channels = "[{name: a, response: {band: [8 um, 12 um], value: 0.5}, gain: 2 V/W}]";
  look.more = "optics: 0.9, exposure: 2 ms, near: 0.1 m, ";
  scenario(plate(300) + look.yaml());
  scenario("sun: {azimuth: 90 deg, elevation: 20 deg, irradiance: " + table("W/(m2 um)") + "}\nambient: {radiance: " + table("W/(m2 sr um)") +
           "}\nbackground: {radiance: " + table("W/(m2 sr um)") + "}\natmosphere: {extinction: " + table("1/m") + ", radiance: " + table("W/(m2 sr um)") +
           ", temperature: 280 K, top: 3 km}\n" + plate(300) + Look{}.yaml());
  scenario("lights: [{name: l, intensity: {product: [" + table("W/(sr um)") +
           ", 0.5], scale: 2}, radius: 0.1 m, position: [1 m, 0 m, 0 m], level: [[0 s, 0.5], [1 s, 0.7]]}]\n" + plate(300) + Look{}.yaml());
  scenario(
      "lights: [{name: l, intensity: {blackbody: 2000 K, area: 0.1 m2}, motion: [{time: 0 s, position: [1 m, 0 m, 0 m]}, {time: 1 s, position: [2 m, 0 m, 0 "
      "m]}]}]\n" +
      plate(300) + Look{}.yaml());
}

TEST_F(NotANumber, InMaterialsOfAScenario) {
  scenario(
      material("{components: [{reflection: phong, reflectance: 0.3, exponent: 20, modifier: {rows: [[0.5, 0.6]]}}, {reflection: lambertian, reflectance: "
               "{wavelength: um, unit: \"1\", "
               "values: [[7, 0.1], [13, 0.2]]}}]}"));
  scenario(
      material("{components: [{reflection: table, wavelength: [7 um, 13 um], angles: [{angle: incidence, count: 2, last: 90 deg}], values: [[0.1, 0.1], [0.05, "
               "0.05]]}]}"));
  scenario(material(
      "{emission: {emissivity: 0.8, angular: [[0 deg, 1], [80 deg, 0.5]]}, transmission: {transmittance: 0.1, angular: [[0 deg, 1], [80 deg, 0.5]]}}"));
  scenario(material("{emission: {wavelength: [7 um, 13 um], angles: [{angle: view, count: 2, last: 90 deg}], values: [[0.7, 0.7], [0.1, 0.1]]}}"));
  scenario(
      "entities: [{name: p, shape: {model: sphere, radius: 1 m}, temperature: 300 K, material: {absorption: {wavelength: um, unit: 1/m, values: [[7, 0.1], "
      "[13, 0.2]]}, radiance: {wavelength: "
      "um, unit: W/(m2 sr um), values: [[7, 0.1], [13, 0.2]]}}}]\n" +
      Look{}.yaml());
}

TEST_F(NotANumber, InBodiesAndPlacesOfAScenario) {
  const std::string look = Look{.pixels = 1, .more = "spectral: {samples: 4}, spectral_image: {band: [8 um, 12 um], bins: 4}, "}.yaml();
  scenario("seed: 3\norigin: {latitude: 12 deg, longitude: 34 deg, height: 5 m}\ntime: {start: 1 s, rate: 30 Hz, frames: 2}\n" + plate(300) + look);
  scenario(
      "entities: [{name: p, shape: {model: terrain, size: 100 m, height_map: {rows: [[1 m, 2 m], [3 m, 4 m]]}}, material: {}, temperature: {rows: [[300 K, 310 "
      "K]]}, position: [1 m, 2 m, 3 m], "
      "heading: 10 deg, pitch: 5 deg, roll: 1 deg}]\n" +
      look);
  scenario(
      "entities: [{name: p, shape: {model: cone, radius: 1 m, top_radius: 0.5 m, length: 2 m, segments: 16}, material: {}, temperature: 300 K, geodetic: "
      "{latitude: 0.01 deg, longitude: 0 deg, "
      "height: 5 m}}]\n" +
      look);
  scenario(
      "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: {}, temperature: 300 K, motion: [{time: 0 s, position: [0 m, 0 m, 0 m], "
      "heading: 3 deg}, {time: 1 s, position: "
      "[1 m, 0 m, 0 m], heading: 4 deg}]}]\nprobes: [{name: q, position: [1 m, 0 m, 0 m], normal: [0, 0, 1], resolution: 16, channels: [{name: a, response: "
      "{band: [8 um, 12 um]}}]}]\n");
}

TEST_F(NotANumber, InFiles) {
  const TemporaryFolder folder;
  const std::string csv = (std::filesystem::path(folder.put("r.csv", ""))).string();
  sweep("wavelength [um],response [1]\n8,0.5\n12,0.6\n", csv, [&](const std::string& text) {
    folder.put("r.csv", text);
    Look look;
    look.channels = "[{name: a, response: {file: " + csv + "}}]";
    scene(plate(300) + look.yaml());
  });
  const std::filesystem::path home = PITVIPER_SOURCE_DIR;
  const std::string sensor = folder.put("s.yaml", "");
  sweep("focal_length: 50 mm\naperture: 20 mm\nexposure: 1 ms\nchannels: [{name: a, response: {wavelength: um, unit: \"1\", values: [[8, 0.5], [12, 0.6]]}}]\n",
        sensor, [&](const std::string& text) {
          folder.put("s.yaml", text);
          readSensor(sensor, scene(plate(300) + Look{}.yaml()).cameras[0].pinhole, 0.0,
                     {home / "materials/library", home / "atmosphere/library", home / "sensors/library"});
        });
  sweep(
      "pitviper-air 1\ntitle made\nsource made\nvisibility_km 23\namount gas 1 gas\namount dust 1 haze\nlevel 0 288 1 1\nlevel 10000 220 0.1 0.01\nbin 700 0.5 "
      "0.1 0.2\nbin 25000 0.5 0.1 0.2\n",
      "a.air", [](const std::string& text) {
        std::istringstream in(text);
        AbsorberTable::read(in, "a.air");
      });
  for (const char* air : {"wavelength_um, range_km, transmittance, path_radiance_W/(m2 sr um)\n4.0, 1, 0.93, 0.012\n4.0, 2, 0.90, 0.014\n5.0, 1, 0.9, "
                          "0.013\n5.0, 2, 0.86, 0.015\n",
                          "wavelength_um, extinction_1/km\n4.0, 0.1\n5.0, 0.2\n", "wavelength_um, transmittance_1km\n4.0, 0.9\n5.0, 0.8\n"})
    sweep(air, "a.csv", [](const std::string& text) {
      std::istringstream in(text);
      readAirCsv(in, "a.csv");
    });
}

TEST_F(NotANumber, InTablesMadeInCode) {
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(Spectrum(Spectrum::Table{{1, 2, 3}, {0, bad, 0}, Outside::Zero, "t"}), std::invalid_argument);
    EXPECT_THROW(Spectrum(Spectrum::Table{{1, bad, 3}, {0, 1, 0}, Outside::Zero, "t"}), std::invalid_argument);
    EXPECT_THROW(makePlate(bad, 1), std::invalid_argument);
    for (int what = 0; what < 3; ++what) {
      Mesh mesh = makePlate(1, 1);
      (what == 0 ? mesh.positions[1].y : what == 1 ? mesh.normals[1].y : mesh.uv[1].y) = static_cast<float>(bad);
      EXPECT_THROW(validateMesh(mesh, {}), UserError) << what;
    }
  }
}

// One pixel of one bin of a spectral image.
TEST_F(NotANumber, InASpectralImage) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.put("i.exr", "");
  const Simulation sim = scene("background: {radiance: 1 W/(m2 sr um)}\n" + Look{.more = "spectral_image: {band: [8 um, 12 um], bins: 4}, "}.yaml());
  needContext();
  SpectralRenderer renderer(sim, sim.cameras.at(0), shaderLibrary(), std::make_shared<const GpuScene>(sim));
  Frame frame = renderer.render(advance(sim, 0.0), 0);
  for (float bad : {NAN, INFINITY, -INFINITY}) {
    frame.layers.at(1).pixels.at(7) = bad;
    writeExrFile(file, frame, {});
    const std::string message = refusal([&] {
      const SpectralImage image = readSpectralImage(file);
      integrateSpectralImage(image, sim.cameras[0].outputs, image.pinhole, 0.0);
    });
    EXPECT_NE(message.find("finite"), std::string::npos) << bad << ": " << (message.empty() ? "taken" : message);
  }
}

}  // namespace
}  // namespace pitviper::test
