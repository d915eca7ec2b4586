#include "scenarios/view/picture_maker.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <list>

#include "scenarios/view/plan_beside.hpp"
#include "sim/plan/plan.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/run/camera_line.hpp"
#include "sim/run/drawings_beside.hpp"

namespace pitviper {
namespace {

using Clock = std::chrono::steady_clock;

/// What the drawing thread gives way by to the window's.
constexpr int kBehindWindow = 5;
/// How often it looks whether something made beside is there.
constexpr std::chrono::milliseconds kLook{20};

double secondsSince(Clock::time_point from) { return std::chrono::duration<double>(Clock::now() - from).count(); }

/// Curves are dragged a step after another: only what comes to rest is planned.
constexpr std::chrono::milliseconds kQuiet{250};

/// Whether what has been found of a scene's air holds for another that was edited from it.
bool sameAir(const Simulation& a, const Simulation& b) {
  return a.air == b.air && a.surroundings == b.surroundings && a.ground.has_value() == b.ground.has_value() &&
         (!a.ground || &a.materialOf(*a.ground) == &b.materialOf(*b.ground));
}

int frameAt(const TimeAxis& time, double time_s) { return std::max(0, static_cast<int>(std::lround((time_s - time.start_s) / time.step_s))); }

}  // namespace

const char* nameOf(Tier tier) {
  switch (tier) {
    case Tier::Sketch:
      return "sketch";
    case Tier::Draft:
      return "draft";
    case Tier::Edited:
      return "edited";
    case Tier::Asked:
      return "as asked";
    case Tier::File:
      return "file";
  }
  return "";
}

/// What the drawing thread has at hand; all of it is of its own.
struct PictureMaker::Desk {
  explicit Desk(const ShaderLibrary& library_used) : library(library_used) {}
  ~Desk() {
    beside.reset();
    left.clear();
    line.reset();
  }
  const ShaderLibrary& library;
  GlContext context;
  ViewedScenePointer scene, drawnScene;  ///< the second: that of the line, which is a sketch's of the first at first
  std::size_t camera = 0;
  std::shared_ptr<const GpuScene> bodies;  ///< of `geometry`, in this thread's context
  std::shared_ptr<const int> geometry;
  std::unique_ptr<CameraLine> line;
  Tier tier = Tier::Sketch;
  int lastFrame = -1;
  std::optional<std::vector<double>> held;  ///< what the plan at hand loses, of an edited scene for which it holds
  Clock::time_point changed;
  bool isKnown = false;  ///< the plan of what is to be drawn next needs not be made
  /// What is made beside, and what is left to end by itself; each keeps the scene that it reads.
  struct Beside {
    ViewedScenePointer scene;
    Tier tier;
    std::unique_ptr<DrawingsBeside> made;  ///< or
    std::unique_ptr<PlanBeside> plan;
    bool isReady() const { return plan ? plan->isReady() : made->isReady(); }
    double share() const { return plan ? plan->share() : made->share(); }
  };
  std::optional<Beside> beside;
  struct Left {
    std::thread thread;
    std::shared_ptr<std::atomic<bool>> isOver;
    ~Left() {
      if (thread.joinable()) thread.join();
    }
  };
  std::list<Left> left;

  const Camera& cameraOf(const ViewedScene& s) const { return s.simulation.cameras[camera]; }

  /// What nobody waits for any more ends beside.
  void leave() {
    left.remove_if([](Left& l) { return l.isOver->load(); });
    if (!beside) return;
    auto over = std::make_shared<std::atomic<bool>>(false);
    left.emplace_back();
    left.back().isOver = over;
    left.back().thread = std::thread([old = std::make_shared<Beside>(std::move(*beside)), over]() mutable {
      old.reset();
      *over = true;
    });
    beside.reset();
  }

  void takeBodies(const ViewedScene& s) {
    if (bodies && geometry == s.geometry) return;
    bodies = std::make_shared<const GpuScene>(s.simulation);
    geometry = s.geometry;
  }

  void begin(const PictureWish& wish) {
    const bool sameBodies = scene && scene->geometry == wish.scene->geometry && camera == wish.camera;
    const bool sameAsked = sameBodies && cameraOf(*scene).spectral.accuracy == wish.scene->simulation.cameras[camera].spectral.accuracy;
    leave();
    isKnown = false;
    scene = wish.scene;
    changed = Clock::now();
    camera = wish.camera;
    lastFrame = -1;
    const Camera& c = cameraOf(*scene);
    if (sameAsked && line && (tier == Tier::Asked || tier == Tier::Edited)) {
      // The plan before the edit draws the edited scene at once; whether it still holds is found beside.
      const Plan plan = line->renderer().plan();
      held.reset();
      auto edited =
          std::make_unique<CameraLine>(scene->simulation, c, library, std::make_unique<CameraDrawing>(scene->simulation, c, plan, library, bodies), true);
      if (sameAir(drawnScene->simulation, scene->simulation)) edited->renderer().takeAir(line->renderer());
      line = std::move(edited);  // before the scene goes that the old one looks at
      drawnScene = scene;
      tier = Tier::Edited;
      return;
    }
    line.reset();
    if (sameAsked && tier == Tier::Asked && !hasDraft(scene->simulation, c)) return drawAsAsked();
    held.reset();
    drawnScene = sketchOf(*scene);
    takeBodies(*drawnScene);
    const Camera& sketched = cameraOf(*drawnScene);
    Plan plan = makePlan(drawnScene->simulation, sketched.outputs, sketched.spectral, sketched.where);
    line = std::make_unique<CameraLine>(drawnScene->simulation, sketched, library,
                                        std::make_unique<CameraDrawing>(drawnScene->simulation, sketched, std::move(plan), library, bodies), true);
    tier = Tier::Sketch;
  }

  void planBeside(Tier next) {
    beside = Beside{scene, next, nullptr, nullptr};
    if (tier == Tier::Edited) {
      beside->plan = std::make_unique<PlanBeside>(scene, camera, line->renderer().plan());
      return;
    }
    beside->made =
        std::make_unique<DrawingsBeside>(scene->simulation, library, std::vector<std::size_t>{camera},
                                         next == Tier::Draft ? DrawingsBeside::Which::Draft : DrawingsBeside::Which::First, scene->simulation.time.start_s);
  }

  /// Of an edited scene: what draws it is as asked already where its plan still holds.
  void takePlan(Plan plan) {
    tier = Tier::Asked;
    held = plan.predictedError;
    if (drawAlike(plan, line->renderer().plan())) return;
    held.reset();
    auto asked = std::make_unique<CameraDrawing>(scene->simulation, cameraOf(*scene), std::move(plan), library, bodies);
    line = std::make_unique<CameraLine>(scene->simulation, cameraOf(*scene), library, std::move(asked), false);
    lastFrame = -1;
  }

  /// Whether something better draws from here on.
  bool takeOver() {
    if (isKnown) {
      isKnown = false;
      drawAsAsked();
      return true;
    }
    if (!beside || !beside->isReady()) return false;
    if (beside->plan) {
      Plan plan = beside->plan->take();
      beside.reset();
      takePlan(std::move(plan));
      return true;
    }
    const Tier next = beside->tier;
    std::vector<DrawingsBeside::Made> made = beside->made->take();
    const std::string why = beside->made->why();
    beside.reset();
    if (made.empty()) throw GlError(why);
    line.reset();
    drawnScene = scene;
    line = std::make_unique<CameraLine>(scene->simulation, cameraOf(*scene), library, std::move(made[0].drawing), next == Tier::Draft);
    tier = next;
    lastFrame = -1;
    return true;
  }

  /// By its plan, which is at hand.
  void drawAsAsked() {
    const Camera& c = cameraOf(*scene);
    line.reset();
    drawnScene = scene;
    takeBodies(*scene);
    line = std::make_unique<CameraLine>(scene->simulation, c, library, bodies, std::function<void(double)>());
    tier = Tier::Asked;
    lastFrame = -1;
  }

  /// What is better than what draws now is made beside, once that has drawn.
  bool planNext() {
    if (beside || isKnown || !line || tier == Tier::Asked) return false;
    if (tier == Tier::Edited && Clock::now() - changed < kQuiet) return false;
    if (!hasDraft(scene->simulation, cameraOf(*scene))) return isKnown = true;
    planBeside(tier == Tier::Sketch ? Tier::Draft : Tier::Asked);
    return true;
  }

  ShownPicturePointer draw(const PictureWish& wish, std::uint64_t number) {
    const auto from = Clock::now();
    auto picture = std::make_shared<ShownPicture>();
    const Simulation& sim = drawnScene->simulation;
    const Camera& c = cameraOf(*drawnScene);
    picture->wish = wish;
    picture->number = number;
    picture->tier = tier;
    HandChanges hands = wish.hands;
    if (tier == Tier::Sketch) hands.lightLevels.clear();
    const StateAt stateAt = worldWith(sim, hands, wish.time_s);
    const int frame = frameAt(sim.time, wish.time_s);
    const bool isFlown = hands.flown.count(c.name) > 0;
    std::optional<int> tick;
    if (c.follower && !isFlown) {
      if (frame != lastFrame + 1 && frame != lastFrame) line->startAgain(frame, library);
      tick = frame;
    }
    lastFrame = frame;
    line->begin(stateAt, wish.time_s, tick);
    const CameraImage image = line->finish();
    const WorldState state = stateAt(wish.time_s);
    picture->frame = line->frame(image, state, frame, stateAt);
    const CameraState at = cameraAt(c, state);
    picture->image = std::make_shared<const CameraImage>(image);
    picture->pose = image.pointing ? image.pointing->followed.pose : at.pose;
    picture->pinhole = at.pinhole;
    const Plan& plan = line->renderer().plan();
    picture->groups = plan.nodeCount();
    picture->accuracy = plan.accuracy;
    for (double e : held ? *held : plan.predictedError) picture->error = std::max(picture->error, e);
    if (tier == Tier::Edited || tier == Tier::Sketch) picture->error = -1.0;
    for (const TermShare& t : plan.shares) (t.kept ? picture->kept : picture->dropped).push_back(t.term);
    picture->draw_ms = 1e3 * secondsSince(from);
    return picture;
  }
};

PictureMaker::PictureMaker(const ShaderLibrary& library, std::function<void()> told)
    : library_(library), told_(std::move(told)), since_(Clock::now()), thread_([this] { run(); }) {}

PictureMaker::~PictureMaker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void PictureMaker::want(const PictureWish& wish) {
  const std::lock_guard lock(mutex_);
  if (wish_ && *wish_ == wish) return;
  wish_ = wish;
  isNew_ = true;
  isDone_ = false;
  wake_.notify_all();
}

ShownPicturePointer PictureMaker::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

MakerStatus PictureMaker::status() const {
  const std::lock_guard lock(mutex_);
  MakerStatus s = status_;
  s.since_s = secondsSince(since_);
  return s;
}

bool PictureMaker::isDone() const {
  const std::lock_guard lock(mutex_);
  return isDone_;
}

void PictureMaker::run() {
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kBehindWindow);
  std::unique_ptr<Desk> desk;
  std::uint64_t number = 0;
  const auto say = [this](const std::string& doing, const std::string& error, bool fresh) {
    const std::lock_guard lock(mutex_);
    if (fresh) since_ = Clock::now();
    status_.doing = doing;
    status_.error = error;
  };
  const auto awaited = [&]() -> std::string {
    if (desk && desk->isKnown) return "preparing";
    if (!desk || !desk->beside) return "";
    return desk->beside->tier == Tier::Draft ? "planning a draft" : "planning";
  };
  try {
    desk = std::make_unique<Desk>(library_);
  } catch (const std::exception&) {  // said with the first wish
  }
  for (;;) {
    PictureWish wish;
    bool fresh = false;
    {
      std::unique_lock lock(mutex_);
      if (!desk || !desk->isKnown) wake_.wait_for(lock, kLook, [this] { return isNew_ || ends_; });
      if (ends_) break;
      if (!wish_) continue;
      wish = *wish_;
      fresh = isNew_;
      isNew_ = false;
      if (desk && desk->beside) status_.share = desk->beside->share();
    }
    try {
      if (!desk) desk = std::make_unique<Desk>(library_);
      bool draws = fresh;
      if (desk->scene != wish.scene || desk->camera != wish.camera || (fresh && !desk->line)) {
        say("preparing", "", true);
        desk->begin(wish);
        say(awaited(), "", true);
        draws = true;
      }
      if (desk->line && desk->takeOver()) {
        say(awaited(), "", true);
        draws = true;
      }
      if (!draws || !desk->line) {
        if (desk->planNext()) say(awaited(), "", true);
        continue;
      }
      auto picture = desk->draw(wish, ++number);
      if (desk->planNext()) say(awaited(), "", true);
      const std::lock_guard lock(mutex_);
      newest_ = std::move(picture);
      isDone_ = !isNew_ && !desk->beside && !desk->isKnown && desk->tier == Tier::Asked;
      if (told_) told_();
    } catch (const std::exception& e) {
      if (desk) desk->leave();
      say("", e.what(), true);
      const std::lock_guard lock(mutex_);
      isDone_ = !isNew_;
      if (told_) told_();
    }
  }
  desk.reset();
}

}  // namespace pitviper
