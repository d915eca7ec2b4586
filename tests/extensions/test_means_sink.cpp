// A sink in one file: means of each layer over the film, a line a frame. No other file knows it.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <numeric>
#include <sstream>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/frame/frame.hpp"
#include "sim/stream/sink_models.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper {
namespace {

class MeansSink final : public Sink {
 public:
  MeansSink(SinkPlace place, double factor) : place_(std::move(place)), factor_(factor) {}
  void start() override { ensureWritableFolder(place_.folder); }
  void take(const std::shared_ptr<const Frame>& frame) override {
    for (const FrameLayer& l : frame->layers) {
      const double sum = std::accumulate(l.pixels.begin(), l.pixels.end(), 0.0);
      text_ += std::to_string(frame->number) + "," + l.name + "," + std::to_string(factor_ * sum / static_cast<double>(l.pixels.size())) + "\n";
    }
  }
  void finish(const std::function<void(double)>&) override { writeFileAtomically(place_.folder / "means.csv", text_, place_.mayReplace); }

 private:
  SinkPlace place_;
  double factor_;
  std::string text_;
};

SinkModel meansSink() {
  return {"means", "Means over the film.", {folderParameter(), withDefault(number("factor", "", "of each"), "1")}, [](const Record& r, const Simulation&) {
            return [folder = readFolder(r), factor = r.number("factor")](const Simulation&, const SinkPlace& place) -> std::unique_ptr<Sink> {
              return std::make_unique<MeansSink>(place.below(folder), factor);
            };
          }};
}

[[maybe_unused]] const bool kRegistered = sinkModels().add(meansSink());

}  // namespace

namespace test {
namespace {

const std::string kScene =
    "name: means\ntime: {rate: 10 Hz, frames: 2}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0}]}}\n"
    "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: m, temperature: 300 K}]\n"
    "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 0.1 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: p, "
    "channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\ncommands: [{command: temperature, at: 0.05 s, entity: p, value: 400 K}]\n";

// Used from YAML by `run`: black bodies of 300 and 400 K, twice as bright by its own key; no other file is written.
TEST(MeansSink, TakesEveryFrame) {
  const TemporaryFolder folder;
  const std::string scenario = folder.put("s.yaml", kScene + "sinks: [{sink: means, folder: deep, factor: 2}]\n");
  const std::filesystem::path out = folder.path() / "out";
  ASSERT_EQ(perform(runCommand(), {scenario, "--out", out.string()}), 0);
  std::ifstream in(out / "deep/means.csv");
  std::string line;
  std::vector<double> means;
  while (std::getline(in, line)) means.push_back(std::stod(line.substr(line.rfind(',') + 1)));
  ASSERT_EQ(means.size(), 2u);
  figure("mean of a frame of 300 K, twice [W/(m2 sr)]", means[0], 2.0 * blackBodyBand(3, 5, 300), 2e-6, "Planck, six digits written");
  figure("mean of a frame heated to 400 K, twice [W/(m2 sr)]", means[1], 2.0 * blackBodyBand(3, 5, 400), 2e-6, "Planck, six digits written");
  EXPECT_FALSE(std::filesystem::exists(out / "c_00000.exr")) << "sinks are those of the scenario";
}

TEST(MeansSink, IsReadByItsTable) {
  EXPECT_NE(keyReference().find("### sink: means"), std::string::npos);
  const auto refusal = [](const std::string& sinks) -> std::string {
    try {
      scene(kScene + "sinks: " + sinks + "\n");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("[files, previews, means]"), "");
  EXPECT_NE(refusal("[mean]").find("did you mean 'means'?"), std::string::npos) << refusal("[mean]");
  EXPECT_NE(refusal("[{sink: means, factor: 1 m}]").find("factor"), std::string::npos);
  EXPECT_NE(refusal("[{sink: files, folder: ../../elsewhere}]").find("outside"), std::string::npos);
  EXPECT_NE(refusal("[{sink: files, folder: /tmp}]").find("outside"), std::string::npos);
}

// Sinks that would write over each other, or into each other's files: refused before anything is drawn.
TEST(SinkModels, EachHasFilesOfItsOwn) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder.path() / "out";
  const auto refusal = [&](const std::string& sinks, const std::vector<std::string>& more = {}) -> std::string {
    Arguments arguments{folder.put("s.yaml", kScene + "sinks: " + sinks + "\n"), "--out", out.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    try {
      perform(runCommand(), arguments);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("[files, files]").find("two sinks write"), std::string::npos);
  EXPECT_NE(refusal("[previews]", {"--preview"}).find("two sinks write"), std::string::npos);
  EXPECT_NE(refusal("[{sink: files, folder: c.plan}]").find("c.plan"), std::string::npos);
  EXPECT_NE(refusal("[files, {sink: previews, folder: c_00001.exr}]").find("c_00001.exr"), std::string::npos);
  EXPECT_NE(refusal("[{sink: previews, ranges: {mw.radance: [1, 2]}}]").find("did you mean 'mw.radiance'?"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out / "c_00000.exr"));
  EXPECT_EQ(refusal("[files, {sink: files, folder: again}, {sink: previews, ranges: {mw.radiance: [1, 2]}}]"), "");
  EXPECT_TRUE(std::filesystem::exists(out / "again/c_00001.exr") && std::filesystem::exists(out / "c_00001.png"));
}

TEST(SinkModels, TwoOfOneNameAreRefused) {
  Registry<SinkModel> two("sink", {meansSink(), meansSink()});
  EXPECT_THROW(two.all(), std::logic_error);
}

}  // namespace
}  // namespace test
}  // namespace pitviper
