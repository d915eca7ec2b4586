#pragma once
// The loop that points a camera: a driver demands, the gimbal follows, every tick is kept. One tick is one frame.
//
// Order of a frame: tick() says where the camera looks at its time; the picture is drawn with that; look() (Centroid) or command() (Commands) says where it is
// to look from then on. So the picture of frame k acts on the gimbal from the time of tick k (later by FollowOptions::latency_s) and shows at tick k + 1.
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sensors/gimbal/centroid.hpp"
#include "sensors/gimbal/gimbal.hpp"
#include "sensors/gimbal/pose_record.hpp"

namespace pitviper {

struct FollowOptions {
  GimbalOptions gimbal;
  GimbalDriver driver = GimbalDriver::Truth;
  TrackerOptions tracker;
  Pinhole film;            ///< for what a place in a picture means
  double latency_s = 0.0;  ///< from the tick of a picture until what was found in it acts; any length
  std::uint64_t seed = 0;
  std::string camera;  ///< name: cameras jitter apart
};

/// The world at a tick.
struct FollowTick {
  double time_s = 0.0;
  std::int64_t frame = 0;
  Pose carrier;                      ///< in the local frame; of a camera that nothing carries, its own mount
  glm::dvec3 cameraPosition{0.0};    ///< in the local frame
  std::optional<glm::dvec3> target;  ///< its true place: drives Truth, and all at the first tick
  double focalLength_m = 0.0;        ///< of the film at that time; 0: as FollowOptions::film has it
};

class FollowLoop {
 public:
  /// Errors: std::invalid_argument for unsound options.
  explicit FollowLoop(const FollowOptions& options);
  /// A replay. `record` must outlive the loop.
  FollowLoop(const FollowOptions& options, const PoseRecord& record);

  /// What the gimbal is demanded at the first tick: at the target with the aim's offset, straight ahead without one. For requireWithinLimits().
  glm::dvec2 demandAtStart(const FollowTick& first) const;

  /// The camera at a tick, kept in record(). At the first the gimbal stands still where demandAtStart() says, or at its limit. Ticks rise.
  /// Errors: std::invalid_argument for times that do not rise; UserError for a frame that a replay does not hold.
  PoseRow tick(const FollowTick& now);
  /// The camera at a time between the last tick but one and the next: for what moves while a frame is exposed. Keeps nothing and changes nothing. Truth: `then`
  /// says where the target is by then; else the demands go on as they stand. Before the first tick the gimbal stands where it starts. A replay turns evenly
  /// from row to row. Errors: std::invalid_argument before there was a tick.
  Pose during(const FollowTick& then) const;

  /// Centroid: searches the last tick's picture. Without a target the line to the last one is held.
  /// Errors: std::invalid_argument before the first tick and for a picture that has not the film's size.
  Centroid look(std::span<const float> picture);
  /// Commands, from the last tick on: azimuth and elevation in the carrier's axes, or a direction in the local frame, which need not be of length 1. The aim's
  /// offset does not apply. Errors: std::invalid_argument for what is no direction.
  /// `from_s`: from then on, if that is after the last tick.
  void command(const glm::dvec2& angles_rad, double from_s = -INFINITY);
  void commandAlong(const glm::dvec3& direction, double from_s = -INFINITY);

  const std::vector<PoseRow>& record() const { return record_; }
  /// Forgets the rows so far: a stream may run for days.
  std::vector<PoseRow> takeRecord() { return std::exchange(record_, {}); }
  const GimbalState& gimbal() const { return course_.gimbal; }
  const CentroidTracker& tracker() const { return tracker_; }

 private:
  /// A direction in the local frame, or in the carrier's axes, from a time on.
  struct Line {
    double from_s;
    glm::dvec3 direction;
    bool inCarrier, isAim;
  };
  /// What a tick leaves to the next.
  struct Course {
    GimbalState gimbal;
    std::vector<Line> lines;  ///< the one that holds, then those to come
    FollowTick last;
  };
  glm::dvec2 anglesAt(const Line& line, const Pose& carrier) const;
  glm::dvec2 demandOfLine(const Line& line, const glm::dvec2& angles, double time_s) const;
  void begin(const FollowTick& first);
  void advance(Course& course, const FollowTick& now) const;
  void follow(Course& course, const FollowTick& now, const Line& was, const Line& is, double until_s) const;
  glm::dquat believed(const FollowTick& at, const glm::dvec2& angle_rad) const;
  glm::dquat sight(const FollowTick& at, const glm::dvec2& angle_rad) const;
  bool knowsWhere(const FollowTick& now) const;
  /// A direction in the local frame is held there, or, where the gimbal is not stabilised, as it lies to the carrier now.
  void demandAlong(const glm::dvec3& direction, double from_s, bool isAim);
  void demand(const Line& line);

  FollowOptions options_;
  const PoseRecord* replay_ = nullptr;
  JitterCourse jitter_;
  CentroidTracker tracker_;
  Pose replayedAt(double time_s) const;
  Pinhole filmAt(const FollowTick& at) const;

  Course course_;
  std::optional<Course> before_;    ///< as the last tick but one left it, with what came since
  std::optional<glm::dvec3> seen_;  ///< local direction in which the tracker saw the target last
  std::vector<PoseRow> record_;
  std::optional<PoseRow> row_;  ///< of the last tick
};

}  // namespace pitviper
