// A user's own check of the promise: `audit`, and the same by hand with two runs; and plans that are given where they do not belong.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "sim/image/exr.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

/// An outline that crosses pixels, a body of a third of a pixel, a small bright part of a large body, a texture finer than pixels, a pane.
std::string sceneText(const std::string& more = "",
                      const std::string& channels = "[{name: mw, response: {band: [3.4 um, 4.2 um]}, output: [radiance, photons]}]") {
  return "name: scene\natmosphere: {extinction: 2e-5 1/m, temperature: 280 K}\n"
         "materials:\n"
         "  m: {components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", values: [[3, 0.1], [3.8, 0.7], [6, 0.3]]}}]}\n"
         "  pane: {transmission: {transmittance: {wavelength: um, unit: \"1\", values: [[3, 0.9], [3.7, 0.3], [6, 0.8]]}}, components: []}\n"
         "entities:\n"
         "  - {name: wall, shape: {model: plate, width: 40 m, height: 40 m}, material: m, temperature: 305 K, position: [0 m, 2 km, 60 m], heading: 170 deg, "
         "roll: 17 deg}\n"
         "  - {name: ball, shape: {model: sphere, radius: 0.3 m}, material: m, temperature: 600 K, position: [11 m, 1.9 km, 66 m]}\n"
         "  - {name: jet, shape: {model: jet}, material: m, temperature: 290 K, position: [-5 m, 1.5 km, 52 m], heading: 70 deg, parts: {nozzle: {temperature: "
         "800 K}}}\n"
         "  - {name: window, shape: {model: plate, width: 12 m, height: 12 m}, material: pane, temperature: 300 K, position: [4 m, 1.2 km, 58 m], heading: 175 "
         "deg}\n"
         "cameras: [{name: c, film: {width: 20, height: 20}, field_of_view: 1.6 deg, aperture: 5 mm, exposure: 1 ms, position: [0 m, 0 m, 50 m], look_at: "
         "wall, channels: " +
         channels + "}]\n" + more;
}

class AuditCommand : public ::testing::Test {
 protected:
  Result run(const std::string& arguments) const {
    return test::run("cd " + folder_.path().string() + " && XDG_CACHE_HOME=" + (folder_.path() / "cache").string() + " PITVIPER_HOME=" + PITVIPER_SOURCE_DIR +
                     " " + PITVIPER_PROGRAM + " " + arguments);
  }
  /// Largest difference of a layer's pixels, as `audit` has it.
  double apart(const std::string& planned, const std::string& reference, const std::string& layer) const {
    const auto of = [&](const std::string& name) {
      const ExrImage image = readExr(folder_.path() / name);
      for (const auto& l : image.layers)
        if (l.name == layer) return l.pixels;
      return std::vector<float>();
    };
    const auto ours = of(planned), theirs = of(reference);
    if (ours.empty() || ours.size() != theirs.size()) return INFINITY;
    auto sorted = theirs;
    std::sort(sorted.begin(), sorted.end());
    const double floor = 1e-3 * static_cast<double>(sorted[sorted.size() * 99 / 100]);
    double most = 0.0;
    for (size_t p = 0; p < ours.size(); ++p)
      most = std::max(most, std::abs(static_cast<double>(ours[p]) - static_cast<double>(theirs[p])) / std::max(static_cast<double>(theirs[p]), floor));
    return most;
  }
  TemporaryFolder folder_;
};

TEST_F(AuditCommand, TheReferenceAlongAPlansLinesIsWithinWhatWasAsked) {
  folder_.put("s.yaml", sceneText("accuracy: 1 %\n"));
  EXPECT_EQ(run("run s.yaml --out planned").code, 0);
  const Result exact = run("run s.yaml --out exact --set accuracy=reference --plan planned/c.plan");
  ASSERT_EQ(exact.code, 0) << exact.output;
  for (const char* layer : {"mw.radiance", "mw.photons"})
    bound(std::string("two runs of one scenario, planned at 1 % and by the reference along its lines, every pixel, ") + layer + ", off by",
          apart("planned/c_00000.exr", "exact/c_00000.exr", layer), 0.01, "asked for");
}

TEST_F(AuditCommand, SaysWhatItFoundAndEndsByIt) {
  folder_.put("s.yaml", sceneText("accuracy: 1 %\n"));
  const Result good = run("audit s.yaml --out found");
  EXPECT_EQ(good.code, 0) << good.output;
  for (const char* part : {"camera c: 1 frame of 20x20 pixels of 2x2 lines", "mw.radiance: largest ", "asked 1 %, predicted ", "worst at "})
    EXPECT_NE(good.output.find(part), std::string::npos) << part << "\n" << good.output;
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "found/c_audit.png"));
  std::ifstream csv(folder_.path() / "found/audit.csv");
  std::string heading, row;
  std::getline(csv, heading);
  std::getline(csv, row);
  EXPECT_EQ(std::count(heading.begin(), heading.end(), ','), std::count(row.begin(), row.end(), ',')) << row;
  EXPECT_TRUE(row.starts_with("c,mw.radiance,0.01,")) << row;
  EXPECT_EQ(run("audit s.yaml --camera d").code, 2);
  EXPECT_EQ(run("audit s.yaml --frames 0:3").code, 2);
  const Result itself = run("audit s.yaml --set accuracy=reference");
  EXPECT_EQ(itself.code, 2);
  EXPECT_NE(itself.output.find("draws the reference itself"), std::string::npos) << itself.output;
}

// A plan that is not the scenario's own would be drawn with in silence: every way in which it can be another's is a message.
TEST_F(AuditCommand, APlanOfAnythingElseIsRefused) {
  folder_.put("s.yaml", sceneText("accuracy: 3 %\n"));
  ASSERT_EQ(run("run s.yaml --out a").code, 0);
  EXPECT_EQ(run("run s.yaml --out b --plan a/c.plan").code, 0);
  const auto bytes = [&](const std::string& name) {
    std::ifstream in(folder_.path() / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_TRUE(bytes("a/c.plan") == bytes("b/c.plan"));
  const struct {
    std::string change, word;
  } others[] = {{"--set entities.wall.temperature='306 K'", "a plan of another scenario"},
                {"--set atmosphere.extinction='3e-5 1/m'", "a plan of another scenario"},
                {"--set materials.m.components.0.reflectance=0.2", "a plan of another scenario"},
                {"--set cameras.c.film.width=21", "a plan of a camera 'c' that is another"},
                {"--set cameras.c.channels.0.response.band='[3.4 um, 4 um]'", "a plan of a camera 'c' that is another"},
                {"--set cameras.c.position='[0 m, 0 m, 51 m]'", "a plan of a camera 'c' that is another"},
                {"--set accuracy='1 %'", "a plan for an accuracy of 3 %; 1 % is asked for"},
                {"--set accuracy=none", "a plan of a camera 'c' that is another"},  // it has one sample a pixel then
                {"--set accuracy=none --set cameras.c.samples=auto", "a plan for an accuracy of 3 %; none is asked for"}};
  for (const auto& other : others)
    for (const std::string& command : {std::string("run"), "stream --frames 1 --shared-memory /pitviper_" + std::to_string(getpid())}) {
      const Result r = run(command + " s.yaml " + other.change + " --plan a/c.plan --out c");
      EXPECT_EQ(r.code, 2) << command << " " << other.change;
      EXPECT_NE(r.output.find("a/c.plan: " + other.word), std::string::npos) << command << " " << other.change << ": " << r.output;
    }
  // The reference takes a plan of its own scenario alone, too.
  EXPECT_EQ(run("run s.yaml --out d --set accuracy=reference --set entities.wall.temperature='306 K' --plan a/c.plan").code, 2);
  folder_.put("c.plan", "pitviper plan 5 1 1\nnonsense\n");
  EXPECT_NE(run("run s.yaml --out d --plan c.plan").output.find("c.plan: not a plan, or not one that says what it was made for"), std::string::npos);
  folder_.put("c.plan", bytes("a/c.plan").substr(0, bytes("a/c.plan").size() / 2));
  EXPECT_NE(run("run s.yaml --out d --plan c.plan").output.find("c.plan: a damaged plan"), std::string::npos);
}

TEST_F(AuditCommand, APlanWithoutAnAccuracyIsReadAgain) {
  folder_.put("s.yaml", sceneText("accuracy: none\n"));
  ASSERT_EQ(run("run s.yaml --out a").code, 0);
  // Reading marks a file as used, writing puts another in its place.
  const auto written = [&] {
    for (const auto& f : std::filesystem::directory_iterator(folder_.path() / "cache/pitviper")) {
      struct stat of {};
      if (f.path().filename().string().starts_with("table-plan-") && stat(f.path().c_str(), &of) == 0) return static_cast<long long>(of.st_ino);
    }
    return -1LL;
  };
  const auto first = written();
  ASSERT_NE(first, -1);
  const Result again = run("run s.yaml --out b --plan a/c.plan");
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(run("run s.yaml --out c").code, 0);
  EXPECT_EQ(written(), first) << "the plan in the cache serves";
  EXPECT_EQ(apart("a/c_00000.exr", "b/c_00000.exr", "mw.radiance"), 0.0);
}

TEST_F(AuditCommand, APlanOfAnotherScenarioIsNotReplaced) {
  folder_.put("s.yaml", sceneText("accuracy: 3 %\n"));
  std::filesystem::create_directories(folder_.path() / "out");
  folder_.put("out/c.plan", "what somebody else keeps here\n");
  const Result r = run("run s.yaml --out out");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.output.find("c.plan: is there already"), std::string::npos) << r.output;
  EXPECT_EQ(run("run s.yaml --out out --overwrite").code, 0);
  EXPECT_EQ(run("run s.yaml --out out").code, 0) << "its own";
}

}  // namespace
}  // namespace pitviper::test
