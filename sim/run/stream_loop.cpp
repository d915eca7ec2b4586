#include "sim/run/stream_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "sim/gl/timing.hpp"
#include "sim/run/accuracy_dial.hpp"
#include "sim/run/bare_timer.hpp"
#include "sim/run/camera_line.hpp"
#include "sim/run/drawings_beside.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// Before the first tick: sinks' threads have come to rest.
constexpr std::int64_t kBeforeFirst_ns = 20000000;
/// How long a stream that was stopped, or waits for a step, goes without looking whether it is to end.
constexpr std::int64_t kLook_ns = 50000000;

std::int64_t residentMemory_kB() {
  long pages = 0, resident = 0;
  if (std::FILE* f = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(f, "%ld %ld", &pages, &resident) != 2) resident = 0;
    std::fclose(f);
  }
  constexpr std::int64_t kPage_kB = 4;
  return resident * kPage_kB;
}

std::int64_t nanoseconds(double s) { return std::llround(s * 1e9); }

/// Attributes that a stamp takes over.
class AttributeLook {
 public:
  explicit AttributeLook(const Frame& frame) {
    for (const Attribute& a : frame.attributes) byName_.emplace(a.name, &a.value);
  }
  template <class T>
  const T* find(const std::string& name) const {
    const auto found = byName_.find(name);
    return found == byName_.end() ? nullptr : std::get_if<T>(found->second);
  }

 private:
  std::map<std::string_view, const decltype(Attribute::value)*> byName_;
};

/// What points a camera and came without a time is of the time since the tick before, whose frame the host has answered: it is seen in this tick already, as
/// what a camera finds in its own pictures.
decltype(Command::change) pointingSince(decltype(Command::change) change, double before_s) {
  return [change = std::move(change), before_s](Courses& courses, double at_s) {
    std::map<std::string, std::uint64_t> newest;
    for (const auto& [camera, pointings] : courses.pointings) newest[camera] = pointings.back().number;
    change(courses, at_s);
    for (auto& [camera, pointings] : courses.pointings)
      for (Pointing& p : pointings)
        if (p.number > newest[camera]) p.at_s = before_s;
  };
}

struct Tick {
  std::uint64_t number = 0;
  std::int64_t begins_ns = 0, due_ns = 0;
  WorldState state;
  StateAt stateAt;
  std::uint64_t hostFrame = 0;
  std::int64_t newestCommand_ns = -1;
  std::shared_ptr<TickDone> done;
};

/// A camera's turn in a tick.
struct Job {
  std::shared_ptr<const Tick> tick;
  std::size_t camera = 0;
  std::int64_t begun_ns = 0;
  std::size_t rung = 0;  ///< of accuracy
};

class StreamLoop {
 public:
  StreamLoop(const Simulation& sim, const ShaderLibrary& library, const StreamWish& wish, CommandInbox& inbox, const std::vector<Sink*>& sinks,
             const std::vector<CommandPort*>& ports, const RunProgress& progress, const std::function<void(std::uint64_t)>& ticked)
      : sim_(sim),
        wish_(wish),
        inbox_(inbox),
        sinks_(sinks),
        ports_(ports),
        ticked_(ticked),
        drawnFrame_(progress.drawn),
        world_(sim),
        account_(namesOf(sim)),
        pacer_(
            realTime() ? wish.late : LatePolicy::Send, realTime() && wish.holds, account_, [this](const std::shared_ptr<const Frame>& f) { handOver(f); },
            [this](const TickDone& done) {
              for (CommandPort* port : ports_) port->tickDone(done);
            },
            wish.thread) {
    report_.refused = askFor(wish.thread);
    period_ns_ = nanoseconds(sim.time.step_s);
    delay_ns_ = wish.delay_ns > 0 ? wish.delay_ns : period_ns_;
    const auto scene = std::make_shared<const GpuScene>(sim);
    std::vector<std::size_t> drafts;
    for (std::size_t c = 0; wish.drafts && c < sim.cameras.size(); ++c)
      if (hasDraft(sim, sim.cameras[c])) drafts.push_back(c);
    for (const Camera& camera : sim.cameras)
      lines_.push_back(std::make_unique<CameraLine>(
          sim, camera, library, scene,
          [&](double share) {
            if (progress.planning) progress.planning(camera, share);
          },
          realTime(), std::find(drafts.begin(), drafts.end(), lines_.size()) != drafts.end()));
    prepare();
    for (const auto& line : lines_) line->warmUp(wish.firstFrame);
    if (!drafts.empty()) beside_.emplace(sim, library, drafts, realTime() ? DrawingsBeside::Which::AllRungs : DrawingsBeside::Which::First, timeOf(0));
  }

  StreamReport run() {
    const std::int64_t start = monotonic_ns();
    first_ns_ = start + kBeforeFirst_ns;
    std::optional<BareTimer> bare;
    if (realTime() && !wish_.outsideClock) bare.emplace(first_ns_ + period_ns_ / 2, period_ns_);
    std::optional<Job> current = next(nullptr);
    if (current) begin(*current);
    while (current) {
      CameraLine& line = *lines_[current->camera];
      const CameraImage image = line.finish();
      // While the processor works out what the sensor makes of this picture the next may be drawn already, if its time has come.
      std::optional<Job> following;
      const bool overlaps = wish_.clock != StreamClock::Lockstep && !waitsForItself(*current) && isDue(*current);
      if (overlaps && (following = next(&*current))) begin(*following);
      put(*current, line, image);
      if (!overlaps && (following = next(&*current))) begin(*following);
      current = std::move(following);
    }
    pacer_.finish();
    if (bare) {
      bare->end();
      report_.bareTimer = bare->lateness();
      report_.bareTimerLate = bare->late();
    }
    report_.ticks = ticks_;
    report_.period_ns = realTime() ? period_ns_ : 0;
    report_.delay_ns = realTime() ? delay_ns_ : 0;
    for (std::size_t c = 0; c < account_.cameras(); ++c) report_.cameras.push_back(account_.of(c));
    for (std::size_t c = 0; c < dials_.size(); ++c)
      if (lines_[c]->rungs() > 1) {
        for (std::size_t r = 0; r < lines_[c]->rungs(); ++r)
          report_.rungs.push_back({lines_[c]->camera().name, lines_[c]->accuracyOf(r), dials_[c].frames()[r]});
        report_.turns += dials_[c].turns();
      }
    report_.causes = causes_.counts();
    report_.seconds = 1e-9 * static_cast<double>(monotonic_ns() - start);
    report_.memoryAfter_kB = residentMemory_kB();
    return std::move(report_);
  }

 private:
  static std::vector<std::string> namesOf(const Simulation& sim) {
    std::vector<std::string> names;
    for (const Camera& c : sim.cameras) names.push_back(c.name);
    return names;
  }
  bool realTime() const { return wish_.clock == StreamClock::RealTime; }
  double timeOf(std::uint64_t tick) const { return sim_.time.at(wish_.firstFrame + static_cast<int>(tick)); }
  std::int64_t beginOf(std::uint64_t tick) const { return first_ns_ + static_cast<std::int64_t>(tick) * period_ns_; }

  /// Programs are compiled by what draws with them, and what a frame takes is known from the second on.
  void prepare() {
    const StateAt scenarios = [this](double t) { return advance(sim_, t); };
    const double time_s = timeOf(0);
    for (const auto& line : lines_) {
      line->prepare(scenarios, time_s);
      if (!realTime()) continue;
      std::vector<double> work_ns;
      for (std::size_t r = 0; r < line->rungs(); ++r) {
        line->setRung(r);
        std::int64_t least = INT64_MAX;
        constexpr int kTries = 3;
        for (int k = 0; k < kTries; ++k) {
          const std::int64_t from = monotonic_ns();
          line->begin(scenarios, time_s);
          line->finish();
          least = std::min(least, monotonic_ns() - from);
        }
        work_ns.push_back(static_cast<double>(least));
      }
      line->setRung(0);
      dials_.push_back(dialOf(std::move(work_ns)));
    }
  }

  AccuracyDial dialOf(std::vector<double> work_ns) const { return {std::move(work_ns), period_ns_ / static_cast<std::int64_t>(lines_.size())}; }

  /// Where what was asked for has been made beside, it draws from here on; no picture is begun.
  void goOver() {
    if (!beside_ || !beside_->isReady()) return;
    for (DrawingsBeside::Made& made : beside_->take()) {
      lines_[made.camera]->takeOver(std::move(made.drawing));
      if (realTime()) dials_[made.camera] = dialOf(std::move(made.work_ns));
    }
    report_.whyDrafts = beside_->why();
    beside_.reset();
  }

  /// Whether the tick after this camera's last has begun, or another camera of this tick is to come.
  bool isDue(const Job& job) const {
    if (lines_[job.camera]->camera().truth.targets) return false;  // rates of targets are the world's at their tick
    if (job.camera + 1 < lines_.size()) return true;
    if (wish_.clock == StreamClock::Free) return true;
    if (wish_.outsideClock) return false;
    return inbox_.isRunning() && monotonic_ns() >= beginOf(job.tick->number + 1);
  }

  /// Where the camera looks next is not known before this picture has been looked at.
  bool waitsForItself(const Job& job) const { return lines_.size() == 1 && lines_[job.camera]->looksAtItsPictures(); }

  /// The next camera of the tick, or the first of the next tick, for which it waits; none: the end.
  std::optional<Job> next(const Job* before) {
    if (before && before->camera + 1 < lines_.size()) return Job{before->tick, before->camera + 1};
    if (lines_.empty()) return std::nullopt;
    const std::optional<std::uint64_t> number = waitForTick();
    if (!number) return std::nullopt;
    auto tick = std::make_shared<Tick>();
    tick->number = *number;
    tick->begins_ns = !realTime() ? monotonic_ns() : wish_.outsideClock ? outside_ns_ : beginOf(*number);
    tick->due_ns = realTime() ? tick->begins_ns + delay_ns_ : 0;
    std::vector<PacedFrame> expected;
    for (std::size_t c = 0; c < lines_.size(); ++c)
      expected.push_back({c, *number, nullptr, tick->begins_ns, tick->due_ns, 0, 0, nullptr, c + 1 == lines_.size()});
    if (realTime()) report_.start.add(monotonic_ns() - tick->begins_ns);
    obey(*tick);
    tick->done = doneOf(tick->number);
    if (wish_.clock == StreamClock::Lockstep && step_ && step_->ticks == 0) tick->done->ticket = step_->ticket;
    for (PacedFrame& e : expected) {
      e.done = tick->done;
      pacer_.expect(e);
    }
    tick->state = world_.at(timeOf(*number));
    tick->stateAt = [this](double t) { return world_.at(t); };
    return Job{tick, 0};
  }

  std::shared_ptr<TickDone> doneOf(std::uint64_t number) const {
    return std::make_shared<TickDone>(TickDone{number, hostFrame_, wish_.firstFrame + static_cast<int>(number), timeOf(number), {}, 0});
  }

  void obey(Tick& tick) {
    const double time_s = timeOf(tick.number);
    constexpr std::size_t kMostWaiting = 16384;
    for (LiveCommand& c : inbox_.take()) {
      if (std::isnan(c.command.at_s)) {
        c.command.at_s = time_s;
        if (tick.number > 0) c.command.change = pointingSince(std::move(c.command.change), timeOf(tick.number - 1));
      }
      if (waiting_.size() >= kMostWaiting) inbox_.refuse("too many for later", "more than " + std::to_string(kMostWaiting) + " commands wait for their time");
      else waiting_.emplace(c.command.at_s, std::move(c));
    }
    // Those for later wait; the others hold in the order of their times, and of their arrival.
    const auto later = waiting_.upper_bound(time_s + kSameTick * sim_.time.step_s);
    for (auto due = waiting_.begin(); due != later; ++due) {
      const LiveCommand& c = due->second;
      world_.apply(c.command, wish_.firstFrame + static_cast<int>(tick.number));
      if (c.received_ns < lastCommand_ns_) continue;
      lastCommand_ns_ = c.received_ns;
      if (c.hostFrame) hostFrame_ = c.hostFrame;
    }
    waiting_.erase(waiting_.begin(), later);
    tick.newestCommand_ns = lastCommand_ns_;
    if (step_ && step_->hostFrame) hostFrame_ = step_->hostFrame;
    tick.hostFrame = hostFrame_;
  }

  /// The number of the next tick to be drawn, once it has begun.
  std::optional<std::uint64_t> waitForTick() {
    if (isOver() || inbox_.isEnding()) return std::nullopt;  // also within a step of many ticks
    if (wish_.clock == StreamClock::Free) return ticks_++;
    if (wish_.clock == StreamClock::Lockstep) {
      while (!step_ || step_->ticks == 0) {
        step_.reset();
        if (inbox_.isEnding()) return std::nullopt;
        if ((step_ = inbox_.waitForStep(kLook_ns))) stepped_ns_ = monotonic_ns(), drawn_ns_ = 0;
      }
      --step_->ticks;
      return ticks_++;
    }
    for (;;) {
      if (inbox_.isEnding() || isOver()) return std::nullopt;
      if (!inbox_.isRunning()) {  // simulated time stands still, and goes on where it stopped
        const std::int64_t from = monotonic_ns();
        while (!inbox_.isRunning() && !inbox_.isEnding()) sleepUntil_ns(monotonic_ns() + kLook_ns / 10);
        first_ns_ += monotonic_ns() - from;
        continue;
      }
      if (wish_.outsideClock) {
        const std::optional<std::int64_t> began = wish_.outsideClock(ticks_);
        if (!began) return std::nullopt;
        outside_ns_ = *began;
        return ticks_++;
      }
      const std::int64_t begins = beginOf(ticks_), now = monotonic_ns();
      // Wholly gone, and what began now would not be there when it is due: time does not wait.
      if (now >= begins + std::max(period_ns_, delay_ns_ - period_ns_)) {
        const auto done = doneOf(ticks_);
        for (std::size_t c = 0; c < lines_.size(); ++c) {
          const PacedFrame gone{c, ticks_, nullptr, begins, begins + delay_ns_, 0, 0, done, c + 1 == lines_.size()};
          pacer_.expect(gone);
          pacer_.put(gone);
        }
        ++ticks_;
        continue;
      }
      if (!sleepUntil_ns(begins, [this] { return inbox_.isEnding() || !inbox_.isRunning(); })) continue;
      return ticks_++;
    }
  }

  bool isOver() const { return wish_.ticks > 0 && ticks_ >= wish_.ticks; }

  void begin(Job& job) {
    if (job.camera == 0) {
      goOver();
      report_.drafts += std::any_of(lines_.begin(), lines_.end(), [](const auto& l) { return l->isDraft(); });
    }
    CameraLine& line = *lines_[job.camera];
    if (realTime()) line.setRung(job.rung = dials_[job.camera].rung());
    job.begun_ns = monotonic_ns();
    line.begin(job.tick->stateAt, job.tick->state.time_s, wish_.firstFrame + static_cast<int>(job.tick->number));
  }

  void put(const Job& job, CameraLine& line, const CameraImage& image) {
    const Tick& tick = *job.tick;
    // The next frame may be begun already, with another rung: what is told of this one comes with its image.
    auto frame = std::make_shared<Frame>(line.frame(image, tick.state, wish_.firstFrame + static_cast<int>(tick.number), tick.stateAt));
    if (line.camera().follower) {
      const std::string poses = line.takePoses();
      if (wish_.poses) wish_.poses(line.camera(), poses);
    }
    if (drawnFrame_) drawnFrame_(line.camera(), *frame, tick.state, image.pointing ? image.pointing->followed.pose : cameraAt(line.camera(), tick.state).pose);
    const std::int64_t made = monotonic_ns();
    frame->stamp = stampOf(*frame, line.camera(), image, tick, job, made);
    // For files; what the pacer finds it adds.
    frame->attributes.push_back({"pitviper.stream.sequence", std::to_string(tick.number)});
    if (tick.hostFrame) frame->attributes.push_back({"pitviper.stream.host_frame", std::to_string(tick.hostFrame)});
    if (frame->stamp->poseAge_ns >= 0) frame->attributes.push_back({"pitviper.stream.pose_age_s", 1e-9 * static_cast<double>(frame->stamp->poseAge_ns)});
    if (realTime()) {
      const std::int64_t work = made - std::max(job.begun_ns, lastMade_ns_);
      dials_[job.camera].look(job.rung, work, made > tick.due_ns, made);
    }
    if (realTime()) {
      const LateCause* late = causes_.look({tick.begins_ns, job.begun_ns, tick.due_ns, made, handing_ns_, beside_.has_value(), watch_.read()});
      if (late) frame->attributes.push_back({"pitviper.stream.late_cause", nameOf(*late)});
    }
    lastMade_ns_ = made;
    drawn_ns_ += made - job.begun_ns;
    const bool isLast = job.camera + 1 == lines_.size();
    pacer_.put({job.camera, tick.number, frame, tick.begins_ns, tick.due_ns, job.begun_ns, made, tick.done, isLast});
    handing_ns_ = monotonic_ns() - made;
    if (!isLast) return;
    if (tick.done->ticket) report_.answer.add(monotonic_ns() - stepped_ns_ - drawn_ns_);
    constexpr std::uint64_t kSettled = 100;
    if (report_.memoryBefore_kB == 0 && tick.number >= (wish_.ticks > 0 ? std::min(kSettled, wish_.ticks / 10) : kSettled))
      report_.memoryBefore_kB = residentMemory_kB();
    if (ticked_) ticked_(tick.number);
  }

  FrameStamp stampOf(const Frame& frame, const Camera& camera, const CameraImage& image, const Tick& tick, const Job& job, std::int64_t made) const {
    FrameStamp s;
    s.sequence = tick.number;
    s.hostFrame = tick.hostFrame;
    s.time_ns = nanoseconds(tick.state.time_s);
    s.exposureStart_ns = nanoseconds(tick.state.time_s - 0.5 * image.exposure_s);
    s.exposureEnd_ns = nanoseconds(tick.state.time_s + 0.5 * image.exposure_s);
    s.renderStart_tai_ns = taiOf_ns(job.begun_ns);
    s.renderEnd_tai_ns = taiOf_ns(made);
    s.due_tai_ns = tick.due_ns > 0 ? taiOf_ns(tick.due_ns) : 0;
    s.poseAge_ns = tick.newestCommand_ns >= 0 ? job.begun_ns - tick.newestCommand_ns : -1;
    s.gain = cameraAt(camera, tick.state).gains.common;
    s.accuracy = image.accuracy;
    for (double e : image.predictedError) s.predictedError = std::max(s.predictedError, e);
    const AttributeLook look(frame);
    s.isOutsideLimits = look.find<std::string>("pitviper.outside_limits") != nullptr;
    if (const auto* p = look.find<std::vector<double>>("pitviper.pose_ecef_m")) s.position_ecef_m = {(*p)[0], (*p)[1], (*p)[2]};
    if (const auto* q = look.find<std::vector<double>>("pitviper.orientation_ecef_wxyz")) s.orientation_ecef = glm::dquat((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
    if (const auto* g = look.find<std::vector<double>>("pitviper.pose_geodetic_deg_deg_m"))
      s.latitude_deg = (*g)[0], s.longitude_deg = (*g)[1], s.height_m = (*g)[2];
    s.sight_ecef = s.orientation_ecef * glm::dvec3(1.0, 0.0, 0.0);
    const int target = camera.mount.lookAtEntity >= 0 ? camera.mount.lookAtEntity : 0;
    s.column_px = s.row_px = NAN;
    if (const auto* seen = look.find<std::vector<double>>("entity." + std::to_string(target + 1) + ".range_column_row"))
      s.column_px = (*seen)[1], s.row_px = (*seen)[2];
    return s;
  }

  void handOver(const std::shared_ptr<const Frame>& frame) {
    for (Sink* sink : sinks_) sink->take(frame);
    for (CommandPort* port : ports_) port->frameOut(*frame);
  }

  const Simulation& sim_;
  const StreamWish& wish_;
  CommandInbox& inbox_;
  const std::vector<Sink*>& sinks_;
  const std::vector<CommandPort*>& ports_;
  const std::function<void(std::uint64_t)>& ticked_;
  const decltype(RunProgress::drawn) drawnFrame_;
  StreamReport report_;
  World world_;
  StreamAccount account_;
  FramePacer pacer_;
  std::vector<std::unique_ptr<CameraLine>> lines_;
  std::vector<AccuracyDial> dials_;
  ProcessWatch watch_;
  LateCauses causes_;
  std::optional<DrawingsBeside> beside_;
  std::multimap<double, LiveCommand> waiting_;  ///< by their times
  std::int64_t period_ns_ = 0, delay_ns_ = 0, first_ns_ = 0, outside_ns_ = 0, lastMade_ns_ = 0, lastCommand_ns_ = -1, stepped_ns_ = 0, drawn_ns_ = 0,
               handing_ns_ = 0;
  std::uint64_t ticks_ = 0, hostFrame_ = 0;
  std::optional<Step> step_;
};

}  // namespace

std::uint64_t StreamReport::unaccounted() const {
  std::uint64_t missing = 0;
  for (const CameraAccount& a : cameras) missing += ticks > a.accounted() ? ticks - a.accounted() : a.accounted() - ticks;
  return missing;
}

StreamReport streamFrames(const Simulation& simulation, const ShaderLibrary& library, const StreamWish& wish, CommandInbox& inbox,
                          const std::vector<Sink*>& sinks, const std::vector<CommandPort*>& ports, const RunProgress& progress,
                          const std::function<void()>& ready, const std::function<void(std::uint64_t)>& ticked) {
  StreamLoop loop(simulation, library, wish, inbox, sinks, ports, progress, ticked);
  if (ready) ready();
  return loop.run();
}

}  // namespace pitviper
