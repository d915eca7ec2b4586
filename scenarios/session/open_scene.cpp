#include "scenarios/session/open_scene.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <list>
#include <map>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/session/plan_turn.hpp"
#include "scenarios/session/same_bodies.hpp"
#include "scenarios/session/same_drawing.hpp"
#include "sim/camera/sensor_chain.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/frame/limits_check.hpp"
#include "sim/gl/context.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/plan/planner.hpp"
#include "sim/run/camera_line.hpp"
#include "sim/run/drawings_beside.hpp"
#include "sim/stream/command_models.hpp"

namespace pitviper {
namespace {

/// How often it looks whether a plan that is made beside is there.
constexpr std::chrono::milliseconds kLookBeside{5};

/// Drawings that are kept with other keys than a world holds.
constexpr std::size_t kMostKept = 8;  // 20 to 130 MB each

/// Whether a camera's pictures depend on those before.
bool remembers(const Camera& camera, const Simulation& sim) { return camera.follower || warmUpOf(camera, sim.time.step_s) > 0; }

/// Its text is read once: a scene is what its file was.
SceneSource inMemory(SceneSource source) {
  if (source.text) return source;
  loadYaml(source.file, {source.file, 0, 0, -1}, &source.text.emplace());
  source.base = std::filesystem::path(source.file).parent_path();
  return source;
}

int frameAt(const TimeAxis& time, double time_s) { return static_cast<int>(std::lround((time_s - time.start_s) / time.step_s)); }

/// The frame that a command holds from, as of a scenario's own.
int tickOf(const TimeAxis& time, double time_s) { return std::max(0, static_cast<int>(std::ceil((time_s - time.start_s) / time.step_s - kSameTick))); }

}  // namespace

/// One call at a time.
class OpenScene::Use {
 public:
  explicit Use(OpenScene& scene) : lock_(scene.inUse_, std::try_to_lock) {
    const Location where{"scene '" + scene.source_.file + "'", 0, 0, -1};
    if (!lock_) throw UserError(where, "another thread is using it", "one call at a time", "give each thread a scene of its own, or take turns by a lock");
    if (!scene.thread_) throw UserError(where, "it has been closed", "an open scene", "load it again");
  }

 private:
  std::unique_lock<std::mutex> lock_;
};

/// What a planner tells the thread that waits for it.
struct OpenScene::Told {
  std::atomic<double> share = 0.0;
  std::atomic<bool> ends = false;
};

/// What is drawn by; all of it is of the scene's thread.
struct OpenScene::Desk {
  struct Drawn {
    std::shared_ptr<const Simulation> sim;
    std::shared_ptr<const Simulation> planned;  ///< what its line looks at: that, with frames of what is expected
    std::string words;                          ///< wordsOf() its tree
    std::shared_ptr<const ExpandedScenario> expanded;
    std::unique_ptr<CameraLine> line;
    std::unique_ptr<DrawingsBeside> beside;
    std::optional<int> last;  ///< frame
    const Plan* plan() const { return line && !line->isDraft() ? &line->renderer().plan() : nullptr; }
  };
  struct Meter {
    std::shared_ptr<const Simulation> sim;
    std::size_t camera = 0;
    std::unique_ptr<PixelPartsMeter> meter;
  };
  using Planning = std::function<void(double)>;
  GlContext context;
  std::shared_ptr<const Simulation> bodiesOf;
  std::shared_ptr<const GpuScene> bodies;
  std::map<std::size_t, Drawn> now;               ///< by camera
  std::list<std::pair<std::size_t, Drawn>> kept;  ///< those used last first; that of the scene that changes are held against last, and never gone
  std::optional<Meter> meter;

  void takeBodies(const std::shared_ptr<const Simulation>& sim) {
    if (bodies && (bodiesOf == sim || sameBodies(*bodiesOf, *sim))) return;
    bodies = std::make_shared<const GpuScene>(*sim);
    bodiesOf = sim;
  }

  /// By the plan of what was drawn before, where that holds, or another.
  Drawn made(const OpenScene& scene, const std::shared_ptr<const Simulation>& own, const std::shared_ptr<const ExpandedScenario>& expanded, std::size_t number,
             const Drawn* before, const Planning& planning) {
    takeBodies(own);
    const auto sim = scene.expected_.empty() ? own : std::make_shared<const Simulation>(withFramesOf(*own, scene.expected_));
    const Camera& camera = sim->cameras[number];
    // Its tables are of its air alone.
    const Plan* earlier = before && before->plan() && sameAir(*before->sim, *own) ? before->plan() : nullptr;
    const Camera drawn = drawnCamera(camera);
    const PlanTurn turn(*sim, drawn, [&] { planning(0.0); });
    Plan plan = cameraPlan(*sim, drawn, planning, earlier);
    auto line = std::make_unique<CameraLine>(*sim, camera, shaderLibrary(),
                                             std::make_unique<CameraDrawing>(*sim, camera, std::move(plan), shaderLibrary(), bodies), false);
    if (earlier && drawAlike(*earlier, line->renderer().plan())) line->renderer().takeAir(before->line->renderer());
    return {own, sim, wordsOf(expanded->tree), expanded, std::move(line), nullptr, {}};
  }

  /// Whether what is drawn by one serves a scene: they differ in what a world holds alone, and that is within limits, by which plans are made.
  bool serves(const Drawn& drawn, const OpenScene& scene, std::size_t number, const StateAt& stateAt, double time_s) const {
    const Simulation& sim = *scene.simulation_;
    const Camera& camera = sim.cameras[number];
    return drawn.plan() && sim.limits.any() && !remembers(camera, sim) && wordsOf(withWorldOf(scene.expanded_->tree, drawn.expanded->tree)) == drawn.words &&
           differInWorldAlone(*drawn.sim, sim, number) && outsideLimits(*drawn.sim, drawn.sim->cameras[number], worldFor(camera, stateAt(time_s))).empty();
  }

  /// That of the scene that changes are held against.
  Drawn& foundation(const OpenScene& scene, std::size_t number, const Planning& planning) {
    for (auto& [camera, drawn] : kept)
      if (camera == number && drawn.sim == scene.kept_) return drawn;
    kept.emplace_back(number, made(scene, scene.kept_, scene.keptExpanded_, number, nullptr, planning));
    return kept.back().second;
  }

  /// One that serves a scene whatever was drawn before: of the same keys, but for what a world holds, which is that of the foundation.
  Drawn* keptFor(const OpenScene& scene, std::size_t number, const StateAt& stateAt, double time_s, const Planning& planning) {
    Drawn& first = foundation(scene, number, planning);
    if (!scene.simulation_->limits.any() || remembers(scene.simulation_->cameras[number], *scene.simulation_)) return nullptr;
    Value tree = withWorldOf(scene.expanded_->tree, first.expanded->tree);
    const std::string words = wordsOf(tree);
    auto found = std::find_if(kept.begin(), kept.end(), [&](const auto& k) { return k.first == number && k.second.words == words; });
    if (found == kept.end()) {
      const auto expanded = std::make_shared<const ExpandedScenario>(ExpandedScenario{std::move(tree), words});
      const auto sim = std::make_shared<const Simulation>(scene.source_.read(*expanded));
      kept.emplace_front(number, made(scene, sim, expanded, number, &first, planning));
      found = kept.begin();
      if (kept.size() > kMostKept) {
        auto last = std::prev(kept.end());
        while (last != kept.begin() && last->second.sim == scene.kept_) --last;
        if (last != kept.begin()) kept.erase(last);
      }
    } else if (found->second.sim != scene.kept_) {
      kept.splice(kept.begin(), kept, found);
    }
    return serves(found->second, scene, number, stateAt, time_s) ? &found->second : nullptr;
  }

  /// What draws a camera of a scene.
  Drawn& lineFor(const OpenScene& scene, std::size_t number, const StateAt& stateAt, double time_s, bool draft, const Planning& planning) {
    const auto sim = scene.simulation_;
    Drawn& own = now[number];
    if (own.line && own.sim == sim) {
      if (own.beside && (!draft || own.beside->isReady())) takeOver(own, planning);
      return own;
    }
    if (scene.kept_) {
      if (Drawn* drawn = keptFor(scene, number, stateAt, time_s, planning)) return *drawn;
    } else if (serves(own, scene, number, stateAt, time_s)) {
      return own;
    }
    Drawn fresh;
    if (draft && hasDraft(*sim, sim->cameras[number])) {
      takeBodies(sim);
      fresh = {sim, sim, wordsOf(scene.expanded_->tree), scene.expanded_, nullptr, nullptr, {}};
      fresh.line = std::make_unique<CameraLine>(*sim, sim->cameras[number], shaderLibrary(), bodies, planning, false, true);
      fresh.beside = std::make_unique<DrawingsBeside>(*sim, shaderLibrary(), std::vector<std::size_t>{number}, DrawingsBeside::Which::First, time_s);
    } else {
      fresh = made(scene, sim, scene.expanded_, number, scene.kept_ ? &foundation(scene, number, planning) : &own, planning);
    }
    own.beside.reset();  // before what it looks at
    own.line.reset();
    own = std::move(fresh);
    return own;
  }

  void takeOver(Drawn& drawn, const std::function<void(double)>& planning) {
    while (!drawn.beside->isReady()) {
      planning(drawn.beside->share());
      std::this_thread::sleep_for(kLookBeside);
    }
    std::vector<DrawingsBeside::Made> made = drawn.beside->take();
    const std::string why = drawn.beside->why();
    drawn.beside.reset();
    if (made.empty()) throw GlError(why);
    drawn.line->takeOver(std::move(made[0].drawing));
    drawn.last.reset();
  }

  PixelPartsMeter& meterFor(const std::shared_ptr<const Simulation>& sim, std::size_t camera) {
    if (meter && meter->sim == sim && meter->camera == camera) return *meter->meter;
    takeBodies(sim);
    meter.reset();
    meter = Meter{sim, camera, std::make_unique<PixelPartsMeter>(*sim, sim->cameras[camera], shaderLibrary(), bodies)};
    return *meter->meter;
  }
};

OpenScene::OpenScene(SceneSource source)
    : source_(inMemory(std::move(source))),
      expanded_(std::make_shared<const ExpandedScenario>(source_.expanded())),
      simulation_(std::make_shared<const Simulation>(source_.read(*expanded_))),
      thread_(std::make_unique<GlThread>()) {}

OpenScene::~OpenScene() {
  if (thread_) thread_->run([this] { desk_.reset(); });
}

void OpenScene::close() {
  const std::unique_lock lock(inUse_, std::try_to_lock);
  if (!lock) throw UserError({"scene '" + source_.file + "'", 0, 0, -1}, "another thread is using it", "a scene at rest", "close it when its calls are over");
  if (!thread_) return;
  thread_->run([this] { desk_.reset(); });
  thread_.reset();
}

template <class Work>
auto OpenScene::onDesk(Work&& work, const SceneProgress& progress) {
  Told told;
  const auto planning = [&told](double share) {
    told.share = share;
    if (told.ends) throw SceneInterrupted();
  };
  return thread_->run(
      [&] {
        if (!desk_) desk_ = std::make_unique<Desk>();
        return work(*desk_, planning);
      },
      [&] {
        if (progress && progress(told.share)) told.ends = true;
      });
}

SceneSource OpenScene::source() const {
  const std::lock_guard lock(state_);
  return source_;
}

std::shared_ptr<const ExpandedScenario> OpenScene::expanded() const {
  const std::lock_guard lock(state_);
  return expanded_;
}

std::shared_ptr<const Simulation> OpenScene::simulation() const {
  const std::lock_guard lock(state_);
  return simulation_;
}

std::shared_ptr<World> OpenScene::worldAt(int frame) const {
  if (commands_.empty() || commands_.back().tick <= frame) return commanded_;
  if (before_.second && before_.first == frame) return before_.second;
  auto world = std::make_shared<World>(*simulation_);
  for (const Commanded& c : commands_)
    if (c.tick <= frame) world->apply(readCommand(c.words, *simulation_, c.time_s), c.tick);
  before_ = {frame, world};
  return world;
}

StateAt OpenScene::stateAt(std::optional<int> frame) const {
  const auto sim = simulation_;
  if (!commanded_) return [sim](double t) { return advance(*sim, t); };
  if (frame) return [sim, world = worldAt(*frame)](double t) { return world->at(t); };
  return [this, sim](double t) { return worldAt(frameAt(sim->time, t))->at(t); };
}

void OpenScene::change(std::vector<std::string> sets) {
  const Use use(*this);
  SceneSource source = source_;
  source.sets = std::move(sets);
  auto expanded = std::make_shared<const ExpandedScenario>(source.expanded());
  auto simulation = std::make_shared<const Simulation>(source.read(*expanded));
  std::shared_ptr<World> world;
  std::vector<Commanded> commands = commands_;
  if (commanded_) world = std::make_shared<World>(*simulation);
  for (Commanded& c : commands) {
    c.tick = tickOf(simulation->time, c.time_s);
    world->apply(readCommand(c.words, *simulation, c.time_s), c.tick);
  }
  commands_ = std::move(commands);
  before_ = {-1, nullptr};
  commanded_ = std::move(world);
  const std::lock_guard lock(state_);
  simulation_ = std::move(simulation);
  source_ = std::move(source);
  expanded_ = std::move(expanded);
}

void OpenScene::keepDrawings() {
  const Use use(*this);
  kept_ = simulation_;
  keptExpanded_ = expanded_;
}

void OpenScene::expect(const std::vector<std::vector<std::string>>& variations, double time_s) {
  const Use use(*this);
  std::vector<ExpectedWorld> expected;
  for (const auto& sets : variations) {
    SceneSource source = source_;
    source.sets.insert(source.sets.end(), sets.begin(), sets.end());
    const auto sim = std::make_shared<const Simulation>(source.read(source.expanded()));
    expected.push_back({sim, advance(*sim, time_s)});
  }
  expected_ = std::move(expected);
  onDesk([](Desk& desk, const auto&) { desk.now.clear(), desk.kept.clear(); });
}

void OpenScene::command(const Value& words, double time_s) {
  const Use use(*this);
  const Command command = readCommand(words, *simulation_, time_s);
  const int tick = tickOf(simulation_->time, time_s), last = commands_.empty() ? 0 : commands_.back().tick;
  if (tick < last)
    throw UserError(words.where, "a command for frame " + std::to_string(tick) + " after one for frame " + std::to_string(last), "commands whose times rise",
                    "forget those before (reset)");
  if (!commanded_) commanded_ = std::make_shared<World>(*simulation_);
  commanded_->apply(command, tick);
  commands_.push_back({words, time_s, tick});
}

void OpenScene::forgetCommands() {
  const Use use(*this);
  commanded_.reset();
  commands_.clear();
  before_ = {-1, nullptr};
}

WorldState OpenScene::world(double time_s) {
  const Use use(*this);
  return stateAt(frameAt(simulation_->time, time_s))(time_s);
}

DrawnFrame OpenScene::draw(const DrawWish& wish, const SceneProgress& progress) {
  const Use use(*this);
  return onDesk(
      [&](Desk& desk, const auto& planning) {
        const auto sim = simulation_;
        const Camera& camera = sim->cameras[wish.camera];
        const int frame = frameAt(sim->time, wish.time_s);
        const StateAt own = stateAt(frame);
        Desk::Drawn& drawn = desk.lineFor(*this, wish.camera, own, wish.time_s, wish.draft, planning);
        const bool isOther = drawn.sim != sim || drawn.planned != sim;
        const auto drawnBy = [&camera, isOther](const StateAt& world) {
          return isOther ? StateAt([&camera, world](double t) { return worldFor(camera, world(t)); }) : world;
        };
        const StateAt state = drawnBy(own), before = isOther || commanded_ ? drawnBy(stateAt()) : StateAt();
        if (remembers(camera, *sim) && drawn.last) {
          if (*drawn.last + 1 != frame) drawn.line->startAgain(frame, shaderLibrary(), before);
        } else if (!drawn.last) {
          drawn.line->warmUp(frame, before);
        }
        drawn.last = frame;
        CameraLine& line = *drawn.line;
        line.setNoise(wish.noise);
        line.begin(state, wish.time_s, frame);
        const bool audits = wish.audited && !line.isDraft();
        const CameraImage image = line.finish(audits ? std::optional(frame) : std::nullopt, audits);
        const WorldState world = state(wish.time_s);
        Frame f = line.frame(image, world, frame, isOther || commanded_ ? state : StateAt());
        f.time_s = wish.time_s;
        for (Attribute& a : f.attributes) {
          if (a.name == kScenarioHash) a.value = sim->sha256;
          if (a.name == kScenarioContent) a.value = sim->content;
        }
        DrawnFrame result;
        result.isDraft = line.isDraft();
        result.isOutsideLimits = !outsideLimits(*sim, camera, world).empty();
        const Plan& plan = line.renderer().plan();
        for (const int slot : plan.slotOfOutput)
          if (!plan.predictedError.empty()) result.predicted.push_back(plan.predictedError[static_cast<std::size_t>(slot)]);
        if (audits) result.audit = line.auditor().tally();
        result.frame = std::make_shared<Frame>(std::move(f));
        return result;
      },
      progress);
}

Plan OpenScene::plan(std::size_t camera, const SceneProgress& progress) {
  const Use use(*this);
  return onDesk(
      [&](Desk& desk, const auto& planning) {
        return desk.lineFor(*this, camera, stateAt(frameAt(simulation_->time, simulation_->time.start_s)), simulation_->time.start_s, false, planning)
            .line->renderer()
            .plan();
      },
      progress);
}

bool OpenScene::isPlanned(std::size_t camera, double time_s) {
  const Use use(*this);
  return onDesk([&](Desk& desk, const auto&) {
    const auto drawn = desk.now.find(camera);
    if (drawn != desk.now.end() && drawn->second.line) {
      if (drawn->second.sim == simulation_) return !drawn->second.line->isDraft();
      if (desk.serves(drawn->second, *this, camera, stateAt(frameAt(simulation_->time, time_s)), time_s)) return true;
    }
    return !hasDraft(*simulation_, simulation_->cameras[camera]);
  });
}

PixelParts OpenScene::parts(std::size_t camera, double time_s, int column, int row) {
  const Use use(*this);
  return onDesk(
      [&](Desk& desk, const auto&) { return desk.meterFor(simulation_, camera).at(stateAt(frameAt(simulation_->time, time_s))(time_s), column, row); });
}

PixelSpectrum OpenScene::spectrum(std::size_t camera, double time_s, int column, int row, double low_um, double high_um, int bins) {
  const Use use(*this);
  return onDesk([&](Desk& desk, const auto&) {
    return desk.meterFor(simulation_, camera).spectrum(stateAt(frameAt(simulation_->time, time_s))(time_s), column, row, low_um, high_um, bins);
  });
}

}  // namespace pitviper
