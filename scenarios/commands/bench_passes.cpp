#include "scenarios/commands/bench_passes.hpp"

#include <cstdlib>
#include <optional>

#include "scenarios/commands/commands.hpp"
#include "sim/camera/camera_renderer.hpp"

namespace pitviper {
namespace {

/// Programs ask the environment when they are made.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    if (!value.empty()) setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (before_) setenv(name_, before_->c_str(), 1);
    else unsetenv(name_);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

/// Never moved: passes keep references to the simulation and the plan.
struct Prepared {
  explicit Prepared(const BenchSetting& setting)
      : simulation(benchSimulation(setting)), scene(std::make_shared<const GpuScene>(simulation)), state(advance(simulation, 0.0)) {}
  Simulation simulation;
  std::shared_ptr<const GpuScene> scene;
  WorldState state;
};

struct PreparedPass : Prepared {
  explicit PreparedPass(const BenchSetting& setting)
      : Prepared(setting),
        plan(makePlan(simulation, camera().outputs, camera().spectral, camera().where)),
        view(cameraView(camera(), state, 1)),
        drawn(simulation.entities.size(), 1),
        pass(makeScenePass(simulation, plan, shaderLibrary(), scene, false, camera().pinhole.apertureArea_m2())) {
    pass->setState(state);
  }
  const Camera& camera() const { return simulation.cameras[0]; }
  Plan plan;
  View view;
  std::vector<char> drawn;
  std::unique_ptr<ScenePass> pass;
};

struct PreparedFrame : Prepared {
  explicit PreparedFrame(const BenchSetting& setting)
      : Prepared(setting), renderer(simulation, simulation.cameras[0], cameraPlan(simulation, simulation.cameras[0]), shaderLibrary(), scene) {}
  CameraRenderer renderer;
};

}  // namespace

DrawFrame preparePass(const BenchSetting& setting) {
  const Environment shading("PITVIPER_SHADING", setting.shading);
  return [p = std::make_shared<PreparedPass>(setting)] { p->pass->draw(p->view, p->state, p->drawn); };
}

DrawFrame prepareWholeFrame(const BenchSetting& setting) {
  return [p = std::make_shared<PreparedFrame>(setting)] { p->renderer.render(p->state); };
}

}  // namespace pitviper
