#include "scenarios/view/plan_beside.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "sim/camera/camera_image.hpp"
#include "sim/camera/camera_renderer.hpp"

namespace pitviper {
namespace {

/// What it gives way by to those that draw.
constexpr int kGivesWay = 10;

struct Ended {};

}  // namespace

PlanBeside::PlanBeside(ViewedScenePointer scene, std::size_t camera, Plan earlier)
    : scene_(std::move(scene)), camera_(camera), earlier_(std::move(earlier)), thread_([this] {
        setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kGivesWay);
        try {
          const Camera drawn = drawnCamera(scene_->simulation.cameras[camera_]);
          made_ = cameraPlan(
              scene_->simulation, drawn,
              [this](double share) {
                share_ = share;
                if (ends_) throw Ended();
              },
              &earlier_);
        } catch (const Ended&) {
        } catch (...) {
          thrown_ = std::current_exception();
        }
        isReady_ = true;
      }) {}

Plan PlanBeside::take() {
  thread_.join();
  if (thrown_) std::rethrow_exception(thrown_);
  return std::move(made_);
}

}  // namespace pitviper
