// Spectral images and `pitviper integrate` as a user runs them, and what is refused.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "sim/image/exr.hpp"

namespace {

namespace fs = std::filesystem;
using pitviper::ExrImage;

const char* const kScenario =
    "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 300 K}]\n"
    "cameras:\n"
    "- {name: c, film: {width: 6, height: 5, pitch: 20 um}, field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [9 m, 0 m, 0 m],\n"
    "   spectral_image: {band: [3 um, 5 um], bins: 20}, channels: [{name: mw, response: {band: [3 um, 5 um]}}]}\n";
const char* const kSensor = "channels:\n- {name: mw, response: {band: [3.2 um, 4.6 um]}}\n";

struct Result {
  int code = -1;
  std::string out, err;
};

std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class Integrate : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    write("scene.yaml", kScenario);
    write("sensor.yaml", kSensor);
    const Result r = pitviper("run scene.yaml --out frames --preview");
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("1 frame of 1 camera and 1 spectral image in frames"), std::string::npos) << r.out;
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name, std::ios::binary) << text; }
  Result pitviper(const std::string& arguments) const {
    const std::string line = "cd '" + folder_.string() + "' && PITVIPER_HOME='" + PITVIPER_SOURCE_DIR + "' timeout 7200 '" + PITVIPER_PROGRAM + "' " +
                             arguments + " >.stdout 2>.stderr";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readAll(folder_ / ".stdout"), readAll(folder_ / ".stderr")};
  }
  /// The spectral image with something done to it, as bad.exr.
  void damaged(const std::function<void(ExrImage&)>& change) const {
    ExrImage image = pitviper::readExr(folder_ / kImage);
    change(image);
    pitviper::writeExr(folder_ / "bad.exr", image);
  }
  /// Exit code 2, one line that begins with `begin` and holds `words`, nothing written.
  void refused(const std::string& arguments, const std::string& begin, const std::vector<std::string>& words) const {
    const Result r = pitviper(arguments);
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_EQ(r.err.substr(0, begin.size()), begin) << r.err;
    EXPECT_EQ(r.err.find('\n'), r.err.size() - 1) << r.err;
    for (const auto& word : words) EXPECT_NE(r.err.find(word), std::string::npos) << "'" << word << "' in: " << r.err;
    EXPECT_NE(r.err.find("; expected "), std::string::npos) << r.err;
    EXPECT_NE(r.err.find("; fix: "), std::string::npos) << r.err;
    EXPECT_FALSE(fs::exists(folder_ / "out.exr"));
    EXPECT_EQ(r.out, "");
  }
  static constexpr const char* kImage = "frames/c_00000_spectral.exr";
  fs::path folder_ = fs::temp_directory_path() / ("pitviper_integrate_" + std::to_string(getpid()));
};

TEST_F(Integrate, RendersOnceAndAppliesASensorLater) {
  EXPECT_FALSE(fs::exists(folder_ / "frames/c_00000_spectral.png"));
  const ExrImage image = pitviper::readExr(folder_ / kImage);
  ASSERT_EQ(image.layers.size(), 20u);
  for (size_t k = 0; k < image.layers.size(); ++k) {  // in order of wavelength as in order of name
    const std::string& name = image.layers[k].name;
    const auto edges = pitviper::numbersOf(*image.findAttribute("bin_um." + name));
    ASSERT_TRUE(edges && edges->size() == 2u);
    EXPECT_EQ((*edges)[0], 3.0 + 2.0 * static_cast<double>(k) / 20.0);
    EXPECT_NEAR(std::get<double>(image.findAttribute("wavelength_um." + name)->value), 3.05 + 0.1 * static_cast<double>(k), 1e-12);
    EXPECT_EQ(std::get<std::string>(image.findAttribute("unit." + name)->value), "W/(m2 sr um)");
  }
  EXPECT_EQ(image.layers[7].name, "S0.3750nm");
  EXPECT_EQ(std::get<std::string>(image.findAttribute("spectralLayoutVersion")->value), "1.0");
  EXPECT_EQ(std::get<std::string>(image.findAttribute("emissiveUnits")->value), "W.m^-2.sr^-1.um^-1");
  for (const char* name : {"pitviper.pose_ecef_m", "pitviper.scenario_sha256", "pitviper.aperture_m", "entity.1.name"})
    EXPECT_NE(image.findAttribute(name), nullptr) << name;

  const Result r = pitviper(std::string("integrate ") + kImage + " sensor.yaml --preview");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("mw.radiance"), std::string::npos);
  EXPECT_NE(r.out.find("frames/c_00000_spectral_sensor.exr"), std::string::npos) << r.out;
  EXPECT_TRUE(fs::exists(folder_ / "frames/c_00000_spectral_sensor.png"));
  const ExrImage frame = pitviper::readExr(folder_ / "frames/c_00000_spectral_sensor.exr");
  EXPECT_NE(frame.find("mw.radiance"), nullptr);
  for (const char* name : {"binning_error.mw.radiance", "unit.mw.radiance", "band_um.mw.radiance", "pitviper.sensor", "pitviper.sensor_sha256",
                           "pitviper.spectral_image", "pitviper.pose_ecef_m", "pitviper.scenario_sha256", "entity.1.name"})
    EXPECT_NE(frame.findAttribute(name), nullptr) << name;
  EXPECT_EQ(frame.findAttribute("bin_um.S0.3050nm"), nullptr);
  ASSERT_EQ(pitviper(std::string("integrate ") + kImage + " sensor.yaml --out again/other.exr").code, 0);
  EXPECT_EQ(readAll(folder_ / "again/other.exr"), readAll(folder_ / "frames/c_00000_spectral_sensor.exr")) << "the same bytes twice";
  EXPECT_EQ(pitviper(std::string("info ") + kImage).code, 0);
  const Result shipped = pitviper(std::string("integrate ") + kImage + " '" + PITVIPER_SOURCE_DIR + "/scenarios/sensors/mw_insb.yaml' --out shipped.exr");
  EXPECT_EQ(shipped.code, 0) << shipped.err;
  const Result check = pitviper("check scene.yaml");
  EXPECT_NE(check.out.find("20 bins, 3 to 5 um, in 2 passes"), std::string::npos) << check.out;
}

TEST_F(Integrate, RefusesSensorsTheBinsDoNotServe) {
  const std::string line = std::string("integrate ") + kImage + " bad.yaml --out out.exr";
  write("bad.yaml", "channels:\n- {name: lw, response: {band: [4 um, 12 um]}}\n");
  refused(line, "bad.yaml:2:3: ", {"channel 'lw' responds from 4 to 12 um", "within 3 to 5 um", "spectral_image: {band: [3 um, 12 um]}"});
  write("bad.yaml", "channels:\n- {name: mw, response: insb_mwir}\n");
  refused(line, "bad.yaml:2:3: ", {"channel 'mw' responds from 1 to "});
  write("bad.yaml", "chanels:\n- {name: mw, response: {band: [3 um, 4 um]}}\n");
  refused(line, "bad.yaml:1:1: ", {"unknown key 'chanels'", "did you mean 'channels'?"});
  write("bad.yaml", "channels:\n- {name: mw, response: {band: [3 um, 4 um]}, output: electrons, quantum_efficiency: 0.5}\n");
  refused(line, "bad.yaml:2:", {"'electrons' needs an exposure time"});
  write("bad.yaml", "focal_length: 50 mm\npixel_pitch: 2 mm\nchannels: [{name: mw, response: {band: [3 um, 4 um]}}]\n");
  refused(line, "bad.yaml:2:14: ", {"times the angle of the image's", "a pixel pitch of"});
  write("bad.yaml", "optics: {band: [8 um, 9 um]}\nchannels:\n- {name: mw, response: {band: [3 um, 4 um]}, output: flux}\n");
  refused(line, "bad.yaml:3:", {"channel 'mw'", "zero"});
  write("bad.yaml", "");
  refused(line, "bad.yaml:1:1: ", {"the file holds nothing"});
  refused(std::string("integrate ") + kImage + " nothing.yaml", "nothing.yaml: ", {"cannot read the file"});
  refused(std::string("integrate ") + kImage, "pitviper integrate: ", {"too few arguments"});
  refused(std::string("integrate ") + kImage + " sensor.yaml --out frames/../" + kImage, "--out ", {"the spectral image itself"});
  refused(std::string("integrate ") + kImage + " sensor.yaml --out frame.png", "--out frame.png: ", {"ends in .exr"});
}

TEST_F(Integrate, RefusesImagesThatAreNotSpectral) {
  const std::string line = "integrate bad.exr sensor.yaml --out out.exr";
  refused("integrate frames/c_00000.exr sensor.yaml", "frames/c_00000.exr: ", {"is not a spectral image", "spectral_image: {band:"});
  refused("integrate nothing.exr sensor.yaml", "nothing.exr: ", {"cannot read the file"});
  const std::string bytes = readAll(folder_ / kImage);
  write("bad.exr", bytes.substr(0, bytes.size() / 2));
  refused(line, "bad.exr: ", {});
  write("bad.exr", bytes.substr(0, 300));
  refused(line, "bad.exr: ", {});
  damaged([](ExrImage& image) { image.layers.erase(image.layers.begin() + 7); });
  refused(line, "bad.exr: ", {"leave a gap", "'S0.3650nm'", "'S0.3850nm'", "3.6 to 3.7 um"});
  auto attribute = [](const char* name, auto value) {
    return [=](ExrImage& image) {
      for (auto& a : image.attributes)
        if (a.name == name) a.value = value;
    };
  };
  damaged(attribute("bin_um.S0.3350nm", std::string("3.3 3.45")));
  refused(line, "bad.exr: ", {"overlap", "'S0.3350nm'", "'S0.3450nm'"});
  for (const char* broken : {"3.3 oops", "3.3", "nan nan", "5 3", "-1 3.4", ""}) {
    damaged(attribute("bin_um.S0.3350nm", std::string(broken)));
    refused(line, "bad.exr: ", {"'bin_um.S0.3350nm' is not a bin"});
  }
  for (const float broken : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    damaged([broken](ExrImage& image) { image.layers.at(2).pixels.at(static_cast<size_t>(image.width) + 1) = broken; });
    refused(line, "bad.exr: ", {"is not finite at column 1, row 1"});
  }
  damaged(attribute("unit.S0.3350nm", std::string("W/(m2 sr)")));
  refused(line, "bad.exr: ", {"'S0.3350nm' is not spectral radiance"});
  damaged(attribute("pitviper.focal_length_m", 0.0));
  refused(line, "bad.exr: ", {"'pitviper.focal_length_m' is not a number above zero"});
  damaged(attribute("pitviper.pitch_x_m", 1e9));
  refused(line, "bad.exr: ", {"do not belong together"});
  damaged([](ExrImage& image) { std::erase_if(image.attributes, [](const auto& a) { return a.name == "pitviper.aperture_m"; }); });
  refused(line, "bad.exr: ", {"has no attribute 'pitviper.aperture_m'"});
}

TEST_F(Integrate, ScenariosAskForWhatCanBe) {
  auto bad = [this](const std::string& spectral, const std::string& before, const std::vector<std::string>& words) {
    const std::string text(kScenario), was = "{band: [3 um, 5 um], bins: 20}";
    std::string changed = text;
    changed.replace(text.find(was), was.size(), spectral);
    write("bad.yaml", changed);
    refused("check bad.yaml", "bad.yaml:" + before, words);
  };
  bad("{bins: 20}", "4:", {"'band'"});
  bad("{band: [5 um, 3 um]}", "4:", {"empty or outside the spectral axis"});
  bad("{band: [3 um, 5 um], bins: 513}", "4:", {"bins is out of range (513)", "2 to 512"});
  bad("{band: [3 um, 5 um], bin: 20}", "4:", {"unknown key 'bin'", "did you mean 'bins'?"});
  bad("{band: [3 um, 3.00000001 um]}", "4:", {"too narrow for 32 bins"});
  write("bad.yaml",
        std::string(
            "materials:\n  paint: {components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", values: [[2.9, 0.1], [5, 0.2]]}}]}\n") +
            "background: {temperature: 3 K}\n" + kScenario);
  Result r = pitviper("check bad.yaml --set entities.p.material=paint");
  EXPECT_EQ(r.code, 0) << r.err;
  refused("check bad.yaml --set entities.p.material=paint --set 'cameras.c.spectral_image.band=[2 um, 4 um]'",
          "bad.yaml:2:10: ", {"material 'paint' has no data for channel 'spectral_image' (2 um to 4 um)"});
  refused("check scene.yaml --set cameras.c.film.width=16384 --set cameras.c.film.height=4000", "", {"134 million"});
}

}  // namespace
