#include "sensors/gimbal/gimbal_follower.hpp"

#include "sensors/gimbal/gimbal_choice.hpp"

namespace pitviper {
namespace {

class GimbalFollower final : public Follower {
 public:
  GimbalFollower(const FollowOptions& options, std::shared_ptr<const PoseRecord> record)
      : options_(options), replay_(std::move(record)), loop_(replay_ ? FollowLoop(options, *replay_) : FollowLoop(options)) {}

  Followed tick(const FollowerTick& now) override {
    if (ticked_) obey(now);
    Followed at = said(loop_.tick(followTick(now)));
    if (!ticked_) obey(now);  // what the first frame has been told is there at the second
    ticked_ = true;
    return at;
  }

  Pose during(const FollowerTick& then) const override { return loop_.during(followTick(then)); }

  Tracked look(std::span<const float> picture) override {
    const Centroid c = loop_.look(picture);
    Tracked t{c.found, c.at_px, {}, c.signal, c.background, c.threshold, c.pixels, c.saturated};
    if (c.found) t.fromAxis_px = c.at_px - 0.5 * glm::dvec2(options_.film.width, options_.film.height);
    return t;
  }

  std::string takeRecord() override {
    std::string lines;
    for (const PoseRow& row : loop_.takeRecord()) lines += poseLine(row);
    return lines;
  }

 private:
  void obey(const FollowerTick& now) {
    for (const Pointing& p : now.pointings) {
      if (p.number <= obeyed_) continue;
      obeyed_ = p.number;
      if (replay_ || options_.driver != GimbalDriver::Commands) continue;
      if (p.inBase) loop_.command(anglesOf(p.direction), p.at_s);
      else loop_.commandAlong(p.direction, p.at_s);
    }
  }

  Followed said(const PoseRow& row) const {
    Followed at{row.pose, nameOf(row.driver), {}, row.angle_rad, {}, row.locked};
    if (row.driver == GimbalDriver::Poses) {
      at.mode = "replays";
      return at;
    }
    at.rate_rad_s = loop_.gimbal().rate_rad_s;
    if (row.driver == GimbalDriver::Centroid) at.mode = loop_.tracker().searches() ? "searches" : row.locked ? "tracks" : "coasts";
    else at.mode = row.locked ? "follows" : "at its limit";
    return at;
  }

  FollowOptions options_;
  std::shared_ptr<const PoseRecord> replay_;
  FollowLoop loop_;
  bool ticked_ = false;
  std::uint64_t obeyed_ = 0;
};

}  // namespace

std::unique_ptr<Follower> makeGimbalFollower(const FollowOptions& options, std::shared_ptr<const PoseRecord> record) {
  return std::make_unique<GimbalFollower>(options, std::move(record));
}

}  // namespace pitviper
