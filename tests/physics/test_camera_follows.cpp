// The camera that follows, through the whole pipeline: closed loops on drawn pictures against closed forms, replays to the bit, commands, the plan of its
// field.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "scenarios/commands/commands.hpp"
#include "sensors/gimbal/gimbal_choice.hpp"
#include "sim/frame/frame_number.hpp"
#include "sim/plan/sight_rays.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/run/run.hpp"
#include "sim/run/stream_loop.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kRate_rad_s = 0.05, kTick_s = 0.01, kPixel_rad = 5e-4, kRange_m = 1000.0, kSpan_s = 0.6;

/// A hot ball 4 pixels across that crosses from left to right at an even rate (to 2e-4 of it: the square of 0.015 rad), a camera of 64 x 64 pixels whose
/// detector counts, without a lens that spreads.
std::string crossing(const std::string& gimbal, const std::string& more = "") {
  const double most = 0.5 * kRate_rad_s * kSpan_s * kRange_m;
  return "seed: 5\ntime: {rate: 100 Hz, frames: 61}\nbackground: {temperature: 250 K}\nmaterials: {black: {components: [{reflection: lambertian, reflectance: "
         "0.05}]}}\n"
         "entities: [{name: ball, shape: {model: sphere, radius: 1 m, segments: 48}, material: black, temperature: 500 K, motion: [{time: 0 s, position: [" +
         std::to_string(-most) + " m, 1000 m, 0 m]}, {time: 0.6 s, position: [" + std::to_string(most) +
         " m, 1000 m, 0 m]}]}]\n"
         "cameras: [{name: seeker, film: {width: 64, height: 64, pitch: 50 um}, focal_length: 100 mm, aperture: 50 mm, exposure: 1 ms, position: [0 m, 0 m, 0 "
         "m], "
         "heading: 0 deg, look_at: ball, gimbal: {" +
         gimbal +
         "}, stages: [{stage: detector, full_well: 1e8, bits: 16, read_noise: 300}], "
         "channels: [{name: mw, response: {band: [3.7 um, 4.8 um]}, quantum_efficiency: 0.7, output: counts}]}]\n" +
         more;
}

struct Ran {
  std::map<int, Frame> frames;
  RunReport report;
};

Ran ran(const Simulation& sim, RunRange range) {
  needContext();
  Ran all;
  all.report = runFrames(sim, shaderLibrary(), range, [&](const std::shared_ptr<const Frame>& f) { all.frames[f->number] = *f; });
  return all;
}

const std::vector<double>& listOf(const Frame& f, const std::string& name) {
  for (const Attribute& a : f.attributes)
    if (a.name == name) return std::get<std::vector<double>>(a.value);
  static const std::vector<double> none{NAN, NAN};
  ADD_FAILURE() << "no " << name << " in frame " << f.number;
  return none;
}

std::string textOf(const Frame& f, const std::string& name) {
  for (const Attribute& a : f.attributes)
    if (a.name == name) return std::get<std::string>(a.value);
  return "";
}

PoseRecord recordOf(const Ran& all) { return posesOf(all.report.poses.at("seeker"), "seeker_poses.csv"); }

// Rationale: a first-order loop of time constant T, whose demand is the line of the last picture. With steps h and q = exp(-h / T) the error of a target at the
// rate s goes by e -> s h + q e, hence s h / (1 - q) in the end; driven by the truth it is s T. The centroid's bias on a ball of 4 pixels is the tolerance.
TEST(CameraFollows, LagsAsItsClosedFormSays) {
  const double lag_s = 0.05, q = std::exp(-kTick_s / lag_s);
  const Ran truth = ran(scene(crossing("driver: truth, lag: 50 ms")), {0, 60}), closed = ran(scene(crossing("driver: centroid, lag: 50 ms")), {0, 60});
  // Half way the rate is the even one; six lags have gone, of the start exp(-6) is left.
  const double byTruth = listOf(truth.frames.at(30), "pitviper.gimbal.target_px")[0], byCentroid = listOf(closed.frames.at(30), "pitviper.gimbal.target_px")[0];
  figure("gimbal by truth: behind its target [px]", byTruth, kRate_rad_s * lag_s / kPixel_rad, 5e-3, "s T; exp(-6) of the start is left");
  figure("gimbal by centroid: behind its target [px]", byCentroid, kRate_rad_s * kTick_s / (1.0 - q) / kPixel_rad, 1e-2,
         "s h / (1 - exp(-h / T)); bias of the centroid");
  const Frame& last = closed.frames.at(60);
  EXPECT_EQ(textOf(last, "pitviper.gimbal.driver"), "centroid");
  EXPECT_EQ(textOf(last, "pitviper.gimbal.mode"), "tracks");
  EXPECT_EQ(textOf(truth.frames.at(60), "pitviper.gimbal.driver"), "truth");
  figure("centroid against truth in its picture [px]", listOf(last, "pitviper.gimbal.centroid_px")[0] - 32.0, listOf(last, "pitviper.gimbal.target_px")[0],
         1e-2, "bias of the centroid on a ball of 4 pixels");
  EXPECT_NEAR(numberOf(last, "pitviper.gimbal.track_error_px", 0.0), std::abs(listOf(last, "pitviper.gimbal.centroid_px")[0] - 32.0), 0.1);
  EXPECT_EQ(textOf(closed.frames.at(0), "pitviper.gimbal.mode"), "searches");
}

// Rationale: the picture of frame k acts at tick k + 1. A target that leaps up by three pixels at frame k is seen there by the camera as it looked before; the
// next frame has turned toward it.
TEST(CameraFollows, PictureOfAFrameActsAtTheNext) {
  const int k = 20;
  const std::string leap = "commands: [{command: move, at: 0.2 s, entity: ball, position: [-5 m, 1000 m, 1.5 m], velocity: [50 m/s, 0 m/s, 0 m/s]}]\n";
  const PoseRecord still = recordOf(ran(scene(crossing("driver: centroid, lag: 20 ms")), {0, 30})),
                   leapt = recordOf(ran(scene(crossing("driver: centroid, lag: 20 ms", leap)), {0, 30}));
  for (int f = 0; f <= k; ++f) EXPECT_EQ(still.rows[static_cast<size_t>(f)].pose.orientation, leapt.rows[static_cast<size_t>(f)].pose.orientation) << f;
  const double turned = leapt.rows[k + 1].angle_rad.y - still.rows[k + 1].angle_rad.y;
  figure("gimbal: elevation one tick after a leap [rad]", turned, 1.5e-3 * -std::expm1(-kTick_s / 0.02), 3e-2,
         "leap (1 - exp(-h / T)); a ball on other pixels");
}

// Rationale: what a closed loop has recorded is what its frames were drawn with. A replay of one frame has its pixels, to the bit, and says who drives; so has
// a run of some frames, which draws those before by itself; so has a second run.
TEST(CameraFollows, ReplaysAndPartsAreTheSameToTheBit) {
  const std::string text = crossing(
      "driver: centroid, rate: 20 deg/s, acceleration: 400 deg/s2, lag: 10 ms, jitter: {rms: 100 urad, corner: 15 Hz}, boresight: [1 mrad, -0.5 mrad]");
  Simulation sim = scene(text);
  const Ran whole = ran(sim, {0, 25});
  const Ran again = ran(sim, {23, 25});
  EXPECT_EQ(whole.report.poses.at("seeker"), again.report.poses.at("seeker"));
  for (int f : {23, 24, 25}) {
    EXPECT_EQ(layer(whole.frames.at(f), "mw.counts").pixels, layer(again.frames.at(f), "mw.counts").pixels) << f;
    EXPECT_EQ(listOf(whole.frames.at(f), "pitviper.gimbal.centroid_px"), listOf(again.frames.at(f), "pitviper.gimbal.centroid_px")) << f;
  }
  sim.cameras[0].follower = replayChoice(std::make_shared<const PoseRecord>(recordOf(whole)), sim.cameras[0]);
  const Ran replay = ran(sim, {24, 24});
  EXPECT_EQ(layer(whole.frames.at(24), "mw.counts").pixels, layer(replay.frames.at(24), "mw.counts").pixels);
  EXPECT_EQ(textOf(replay.frames.at(24), "pitviper.gimbal.driver"), "poses");
  EXPECT_EQ(listOf(whole.frames.at(24), "pitviper.gimbal.angles_rad"), listOf(replay.frames.at(24), "pitviper.gimbal.angles_rad"));
  // A camera of no gimbal looks where a record says, too.
  Simulation bare = scene(text);
  bare.cameras[0].follower.reset();
  bare.cameras[0].follower = replayChoice(std::make_shared<const PoseRecord>(recordOf(whole)), bare.cameras[0]);
  EXPECT_EQ(layer(ran(bare, {24, 24}).frames.at(24), "mw.counts").pixels, layer(replay.frames.at(24), "mw.counts").pixels);
  EXPECT_THROW(ran(sim, {26, 26}), UserError);
}

// Rationale: a detector that remembers sees pictures before the first frame; the gimbal stands where it starts then, and a part of a run has the whole's
// pixels.
TEST(CameraFollows, PartsOfARunWithADetectorThatRemembers) {
  std::string text = crossing("driver: centroid, lag: 30 ms");
  text.replace(text.find("read_noise: 300"), 15, "read_noise: 300, lag: 0.2");
  for (const char* driver : {"centroid", "truth"}) {
    text.replace(text.find("driver: ") + 8, text.find(", lag: 30") - text.find("driver: ") - 8, driver);
    const Simulation sim = scene(text);
    const Ran whole = ran(sim, {0, 12}), part = ran(sim, {12, 12});
    EXPECT_EQ(layer(whole.frames.at(12), "mw.counts").pixels, layer(part.frames.at(12), "mw.counts").pixels) << driver;
  }
}

// Rationale: what is exposed while the camera turns is smeared by the gimbal's own motion: a still background's ball seen by a conical scan of one turn an
// exposure becomes a ring.
TEST(CameraFollows, TurnsWhileItExposes) {
  std::string text = crossing("driver: truth, scan: {pattern: conical, radius: 5 mrad, frequency: 100 Hz}");
  text.replace(text.find("exposure: 1 ms"), 14, "exposure: 10 ms, motion_blur: true, exposure_parts: 60");
  const Frame f = ran(scene(text), {10, 10}).frames.at(10);
  const auto& counts = layer(f, "mw.counts").pixels;
  double radius = 0.0, weight = 0.0, middle = 0.0;
  const float background = counts[0];
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double excess = static_cast<double>(counts[static_cast<size_t>(64 * y + x)]) - static_cast<double>(background);
      if (excess < 50.0) continue;
      const double r = std::hypot(x + 0.5 - 32.0, y + 0.5 - 32.0);
      radius += r * excess, weight += excess;
      if (r < 4.0) middle += excess;
    }
  figure("conical scan while it exposes: radius of the ring [px]", radius / weight, 10.0, 2e-2, "R / pixel; the ball's own size adds r^2 / (4 R) on a circle");
  EXPECT_EQ(middle, 0.0);
}

// Rationale: commands are demanded of the gimbal, which turns there at its rate; what is driven otherwise refuses them.
TEST(CameraFollows, CommandsAreDemandedOfTheGimbal) {
  const std::string commands =
      "commands: [{command: point, at: 0.1 s, camera: seeker, azimuth: 10 deg, elevation: 2 deg}, {command: look, at: 0.4 s, camera: seeker, heading: 5 "
      "deg}]\n";
  const PoseRecord r = recordOf(ran(scene(crossing("driver: commands, rate: 20 deg/s", commands)), {0, 60}));
  const double start = r.rows[0].angle_rad.x, degree = kPi / 180.0;
  EXPECT_EQ(r.rows[10].angle_rad.x, start);
  EXPECT_NEAR(r.rows[15].angle_rad.x - start, 20.0 * degree * 0.05, 1e-9);                  // five ticks at its rate; sums of a hundred servo steps
  EXPECT_NEAR(r.rows[60].angle_rad.x, r.rows[40].angle_rad.x - 20.0 * degree * 0.2, 1e-9);  // on its way from there to 5 deg right of north
  EXPECT_EQ(r.rows[20].driver, GimbalDriver::Commands);
  for (const char* driver : {"truth", "centroid"}) {
    try {
      scene(crossing(std::string("driver: ") + driver, commands));
      ADD_FAILURE() << driver;
    } catch (const UserError& e) {
      EXPECT_NE(std::string(e.what()).find(driver), std::string::npos) << e.what();
    }
  }
}

/// A user's program in lockstep: it finds the target in each frame that it gets, says where to look, and lets the clock go on.
class Host final : public CommandPort {
 public:
  Host(const Simulation& sim, CommandInbox& inbox) : sim_(sim), inbox_(inbox) {}
  std::string place() const override { return "a test"; }
  void frameOut(const Frame& frame) override {
    const Pinhole& film = sim_.cameras[0].pinhole;
    ThresholdRule rule;
    rule.leastNoise = 0.289;
    const Centroid c = centroidOf(layer(frame, "mw.counts").pixels, film.width, film.height, Gate{}, rule);
    if (!c.found) return;
    const std::vector<double>& q = listOf(frame, "pitviper.orientation_ecef_wxyz");
    const glm::dvec3 d = glm::inverse(glm::quat_cast(sim_.frame.ecefFromLocal())) * (glm::dquat(q[0], q[1], q[2], q[3]) * directionOfFilm(film, c.at_px));
    char text[120];
    std::snprintf(text, sizeof text, "%.17g, %.17g, %.17g", d.x, d.y, d.z);
    inbox_.put({commandOf({{"command", "point"}, {"camera", "seeker"}, {"direction", text}}, "a test", sim_, NAN), 0, 0});
  }
  void tickDone(const TickDone&) override { inbox_.step({}); }

 private:
  const Simulation& sim_;
  CommandInbox& inbox_;
};

// Rationale: in lockstep a user's tracker is as quick as the one here: what it says of frame k is seen in frame k + 1. The gates differ, and with them by how
// much noise and the ball's edge pull: under a tenth of a pixel.
TEST(CameraFollows, AUsersTrackerInLockstepIsAsQuick) {
  needContext();
  const Simulation sim = scene(crossing("driver: commands, lag: 50 ms"));
  CommandInbox inbox;
  Host host(sim, inbox);
  StreamWish wish;
  wish.clock = StreamClock::Lockstep;
  wish.ticks = 41;
  std::string lines = posesHeader();
  wish.poses = [&](const Camera&, const std::string& more) { lines += more; };
  inbox.step({});
  streamFrames(sim, shaderLibrary(), wish, inbox, {}, {&host});
  const PoseRecord theirs = posesOf(lines, "stream"), ours = recordOf(ran(scene(crossing("driver: centroid, lag: 50 ms")), {0, 40}));
  ASSERT_EQ(theirs.rows.size(), 41u);
  EXPECT_NE(theirs.rows[1].angle_rad.x, theirs.rows[0].angle_rad.x);
  double worst = 0.0;
  for (size_t k = 0; k < 41; ++k) worst = std::max(worst, glm::length(theirs.rows[k].angle_rad - ours.rows[k].angle_rad));
  bound("a user's tracker in lockstep beside the one here [px]", worst / kPixel_rad, 0.1, "a whole picture against a gate");
}

// Rationale: the plan must hold for every line that the gimbal may take within its limits, and for none that it may not: half of its lines are of pointings
// anywhere in them, and bodies that only those see are aimed at.
TEST(CameraFollows, PlanCoversTheGimbalsField) {
  const std::string field = "driver: truth, azimuth: 30 deg, elevation: [-10 deg, 20 deg]";
  std::string text = crossing(field);
  text.replace(
      text.find("entities: ["), 11,
      "entities: [{name: aside, shape: {model: sphere, radius: 5 m}, material: black, temperature: 400 K, position: [400 m, 1000 m, 100 m]}, {name: behind, "
      "shape: {model: sphere, radius: 5 m}, material: black, temperature: 400 K, position: [0 m, -1000 m, 0 m]}, ");
  const Simulation sim = scene(text);
  SightRays rays(sim, {&sim.cameras[0], nullptr}, 3);
  constexpr double kHalf_rad = 0.0161 * 1.4143;  // to a corner of the film
  int wide = 0;
  double left = 0.0, right = 0.0, high = 0.0, low = 0.0;
  constexpr int kLines = 600;
  for (int n = 0; n < kLines; ++n) {
    const glm::dvec3 d = rays.fromFilm().line.direction;
    const double azimuth = std::atan2(-d.x, d.y), elevation = std::asin(d.z);  // north is forward
    wide += std::abs(azimuth) > 0.05 || std::abs(elevation) > 0.05;
    left = std::max(left, azimuth), right = std::min(right, azimuth), high = std::max(high, elevation), low = std::min(low, elevation);
  }
  // Half of them, less the part of the field around the target (0.1 x 0.1 of 1.05 x 0.52 rad): 0.49 of 600, sigma 12.
  EXPECT_NEAR(wide, 0.49 * kLines, 4.0 * 12.3);
  const double azimuth = 30.0 * kPi / 180.0;
  for (const double reached : {left, -right}) {
    EXPECT_LT(reached, azimuth + kHalf_rad / std::cos(high));
    EXPECT_GT(reached, 0.95 * azimuth);  // the nearest to its edge of 150 on that side: within 1 / 150 of it, 0.05 by exp(-7)
  }
  EXPECT_LT(high, 20.0 * kPi / 180.0 + kHalf_rad);
  EXPECT_GT(low, -10.0 * kPi / 180.0 - kHalf_rad);
  int aside = 0, behind = 0;
  for (int n = 0; n < 300; ++n) {
    const int seen = rays.aimed().line.hits.solid.entity;
    aside += seen == 0, behind += seen == 1;
  }
  EXPECT_GT(aside, 30);  // of three bodies, one out of reach
  EXPECT_EQ(behind, 0);
  // The key of the plan tells fields apart.
  EXPECT_NE(scene(crossing(field)).cameras[0].follower->fingerprint,
            scene(crossing("driver: truth, azimuth: 31 deg, elevation: [-10 deg, 20 deg]")).cameras[0].follower->fingerprint);
}

TEST(CameraFollows, LooksAtALight) {
  const std::string text =
      "time: {rate: 100 Hz, frames: 5}\nlights: [{name: flare, intensity: 100 W/(sr um), motion: [{time: 0 s, position: [0 m, 500 m, 0 m]}, {time: 1 s, "
      "position: [100 m, 500 m, 50 m]}]}]\n"
      "cameras: [{name: seeker, film: {width: 16, height: 16, pitch: 50 um}, focal_length: 100 mm, aperture: 50 mm, position: [0 m, 0 m, 0 m], look_at: flare, "
      "gimbal: {driver: truth}, "
      "channels: [{name: mw, response: {band: [3.7 um, 4.8 um]}}]}]\n";
  const Frame f = ran(scene(text), {4, 4}).frames.at(4);
  EXPECT_NEAR(listOf(f, "pitviper.gimbal.target_px")[0], 0.0, 1e-9);  // a gimbal without lag: rounding alone
  const auto& mw = layer(f, "mw.radiance").pixels;
  const auto brightest = std::max_element(mw.begin(), mw.end()) - mw.begin();
  EXPECT_TRUE(brightest == 7 * 16 + 7 || brightest == 7 * 16 + 8 || brightest == 8 * 16 + 7 || brightest == 8 * 16 + 8)
      << brightest;  // the four around the axis
}

TEST(CameraFollows, ReadmesExampleIsOne) {
  std::ifstream in(std::string(PITVIPER_SOURCE_DIR) + "/scenarios/README.md");
  std::stringstream all;
  all << in.rdbuf();
  const std::string text = all.str(), mark = "```yaml follows\n";
  const size_t from = text.find(mark);
  ASSERT_NE(from, std::string::npos);
  const Simulation sim = scene(text.substr(from + mark.size(), text.find("```", from + mark.size()) - from - mark.size()));
  ASSERT_TRUE(sim.cameras.at(0).follower);
  EXPECT_EQ(sim.cameras[0].follower->driver, "centroid");
  EXPECT_NE(sim.cameras[0].follower->words.find("azimuth +-40 deg, elevation -10 deg to 60 deg"), std::string::npos) << sim.cameras[0].follower->words;
}

// Rationale: what is wrong with a gimbal is said where it is written, with the fix.
TEST(CameraFollows, BadInputIsNamed) {
  const std::vector<std::pair<std::string, std::string>> all = {
      {"azimuth: 20 deg, elevation: [1 deg, 10 deg]", "cannot see its target at the start"},
      {"driver: nobody", "driver"},
      {"elevation: [10 deg, -10 deg]", "do not rise"},
      {"elevation: [-100 deg, 10 deg]", "out of range"},
      {"lag: 1 ms, bandwidth: 3 Hz", "a lag and a bandwidth"},
      {"tracker: {threshold: 4}", "a tracker of a gimbal that truth drives"},
      {"driver: centroid, tracker: {channel: lw}", "no channel 'lw'"},
      {"jitter: {rms: 3 urad}", "go together"},
      {"jitter: {spectrum: [[5 Hz, 1 urad2/Hz], [3 Hz, 1 urad2/Hz]]}", "do not rise"},
      {"scan: {pattern: conical, radius: 1 deg}", "without 'frequency'"},
      {"scan: {pattern: conical, radius: 1 deg, frequency: 3 Hz, lines: 4}", "conical scan has no 'lines'"},
      {"rate: 5 deg", "rate"},
      {"azimut: 3 deg", "azimuth"},
  };
  for (const auto& [gimbal, says] : all) {
    try {
      scene(crossing(gimbal));
      ADD_FAILURE() << gimbal;
    } catch (const UserError& e) {
      EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << gimbal << ": " << e.what();
      EXPECT_EQ(std::string(e.what()).rfind("test.yaml:", 0), 0u) << e.what();
    }
  }
  std::string blind = crossing("driver: truth");
  blind.erase(blind.find("look_at: ball, "), 15);
  EXPECT_THROW(scene(blind), UserError);
}

}  // namespace
}  // namespace pitviper::test
