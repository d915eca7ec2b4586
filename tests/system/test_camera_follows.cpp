// The camera that follows as users have it: records that runs leave, replays, what the plan and the frames say, mistakes.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "sim/image/exr.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

std::string scenario(const std::string& gimbal) {
  return "name: crossing\nseed: 3\ntime: {rate: 100 Hz, frames: 12}\nbackground: {temperature: 250 K}\nmaterials: {m: {components: []}}\n"
         "entities:\n- {name: ball, shape: {model: sphere, radius: 1 m}, material: m, temperature: 400 K, motion: [{time: 0 s, position: [-5 m, 1000 m, 0 m]}, "
         "{time: 1 s, position: [45 m, 1000 m, 10 m]}]}\n"
         "cameras:\n- {name: seeker, film: {width: 48, height: 48, pitch: 50 um}, focal_length: 100 mm, aperture: 50 mm, exposure: 1 ms, position: [0 m, 0 m, "
         "0 m], "
         "look_at: ball, heading: 0 deg, gimbal: {" +
         gimbal +
         "},\n   stages: [{stage: detector, full_well: 1e8, read_noise: 300}], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, quantum_efficiency: "
         "0.8, output: counts}]}\n";
}

class Follows : public ::testing::Test {
 protected:
  std::string file(const std::string& gimbal) { return folder_.put("crossing.yaml", scenario(gimbal)); }
  std::string out(const char* name) const { return (folder_.path() / name).string(); }
  static std::string bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream s;
    s << in.rdbuf();
    return s.str();
  }
  static std::string text(const ExrImage& image, const std::string& name) {
    const Attribute* a = image.findAttribute(name);
    const std::string* v = a ? std::get_if<std::string>(&a->value) : nullptr;
    return v ? *v : "";
  }
  TemporaryFolder folder_;
};

// Rationale: a closed loop can be looked at again frame by frame. Expected: the run leaves a record; one frame of it drawn with that has the same pixels and
// says that poses drive it; the record in the folder stays; a part of the run by itself leaves it too, with a note, and has the same bytes.
TEST_F(Follows, RunsLeavePosesThatOneFrameReplays) {
  const std::string yaml = file("driver: centroid, lag: 20 ms, jitter: {rms: 50 urad, corner: 20 Hz}");
  const Result whole = pitviper("run " + yaml + " --out " + out("a"));
  ASSERT_EQ(whole.code, 0) << whole.output;
  const fs::path record = folder_.path() / "a" / "seeker_poses.csv";
  ASSERT_TRUE(fs::exists(record));
  const std::string poses = bytes(record);
  EXPECT_NE(poses.find("time_s,frame,qw"), std::string::npos);
  EXPECT_EQ(poses.rfind("# pitviper", 0), 0u);
  const Result one = pitviper("run " + yaml + " --frames 9 --poses " + record.string() + " --out " + out("b"));
  ASSERT_EQ(one.code, 0) << one.output;
  const ExrImage closed = readExr(folder_.path() / "a" / "seeker_00009.exr"), replay = readExr(folder_.path() / "b" / "seeker_00009.exr");
  ASSERT_TRUE(closed.find("mw.counts") && replay.find("mw.counts"));
  EXPECT_EQ(closed.find("mw.counts")->pixels, replay.find("mw.counts")->pixels);
  EXPECT_EQ(text(closed, "pitviper.gimbal.driver"), "centroid");
  EXPECT_EQ(text(replay, "pitviper.gimbal.driver"), "poses");
  EXPECT_FALSE(fs::exists(folder_.path() / "b" / "seeker_poses.csv"));
  const Result part = pitviper("run " + yaml + " --frames 8:9 --out " + out("a"));
  ASSERT_EQ(part.code, 0) << part.output;
  EXPECT_NE(part.output.find("frames 0 to 7 are drawn first"), std::string::npos) << part.output;
  EXPECT_EQ(bytes(record), poses);
  const Result apart = pitviper("run " + yaml + " --frames 8:9 --out " + out("c"));
  ASSERT_EQ(apart.code, 0) << apart.output;
  EXPECT_EQ(bytes(folder_.path() / "a" / "seeker_00009.exr"), bytes(folder_.path() / "c" / "seeker_00009.exr"));
}

// Rationale: what a stream of a gimbal did is a record too. Expected: free running, the same poses as the run's.
TEST_F(Follows, StreamsLeaveTheSamePoses) {
  const std::string yaml = file("driver: centroid, lag: 20 ms");
  ASSERT_EQ(pitviper("run " + yaml + " --out " + out("a")).code, 0);
  const Result streamed =
      pitviper("stream " + yaml + " --clock free --frames 12 --shared-memory /pitviper.test." + std::to_string(getpid()) + ".follows --out " + out("s"));
  ASSERT_EQ(streamed.code, 0) << streamed.output;
  EXPECT_EQ(bytes(folder_.path() / "s" / "seeker_poses.csv"), bytes(folder_.path() / "a" / "seeker_poses.csv"));
}

TEST_F(Follows, PlanAndCheckSayWhatPointsIt) {
  const Result plan = pitviper("plan " + file("azimuth: 20 deg, elevation: [-5 deg, 30 deg]") + " --set accuracy='5 %'");
  ASSERT_EQ(plan.code, 0) << plan.output;
  EXPECT_NE(plan.output.find("gimbal: azimuth +-20 deg, elevation -5 deg to 30 deg, driven by the truth: its whole field"), std::string::npos) << plan.output;
}

// Rationale: mistakes of users end with 2 and say where. Expected: file, line, column, what was wrong.
TEST_F(Follows, MistakesAreSaidWhereTheyAre) {
  const Result blind = pitviper("check " + file("azimuth: 20 deg, elevation: [5 deg, 30 deg]"));
  EXPECT_EQ(blind.code, 2);
  EXPECT_NE(blind.output.find("crossing.yaml:9:"), std::string::npos) << blind.output;
  EXPECT_NE(blind.output.find("cannot see its target at the start"), std::string::npos) << blind.output;
  const std::string yaml = file("driver: centroid");
  const auto refused = [&](const std::string& name, const std::string& content, const std::string& says) {
    const std::string record = folder_.put(name, content);
    const Result r = pitviper("run " + yaml + " --frames 3 --poses " + record + " --out " + out("x"));
    EXPECT_EQ(r.code, 2) << name;
    EXPECT_NE(r.output.find(says), std::string::npos) << r.output;
  };
  const std::string header = "time_s,frame,qw,qx,qy,qz,x_m,y_m,z_m,azimuth_rad,elevation_rad,driver,locked\n";
  refused("other_poses.csv", header, "poses of no camera of this scenario");
  refused("seeker_poses.csv", "nonsense\n", "seeker_poses.csv:1:1");
  refused("seeker_poses.csv", header + "0,0,1,0,0,0,0,0,0,0,0,truth,1\n0.01,1,1,0,0,0,nan,0,0,0,0,truth,1\n", "seeker_poses.csv:3:");
  refused("seeker_poses.csv", header + "0,0,1,0,0,0,0,0,0,0,0,truth,1\n", "frame 3 is not in the poses");
}

}  // namespace
}  // namespace pitviper::test
