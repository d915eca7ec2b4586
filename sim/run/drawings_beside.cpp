#include "sim/run/drawings_beside.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/camera/exposure_parts.hpp"

namespace pitviper {
namespace {

/// What a thread gives way by to those that draw, and all threads that it begins.
constexpr int kGivesWay = 10;
/// Pictures of each rung; the shortest time counts, as others draw beside.
constexpr int kTries = 3;

struct Ended {};

}  // namespace

DrawingsBeside::DrawingsBeside(const Simulation& simulation, const ShaderLibrary& library, std::vector<std::size_t> cameras, Which which, double time_s)
    : simulation_(simulation), library_(library), cameras_(std::move(cameras)), which_(which), time_s_(time_s), thread_([this] {
        setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kGivesWay);
        try {
          make();
        } catch (const Ended&) {
        } catch (const GlError& e) {
          made_.clear();
          why_ = e.what();
        } catch (...) {
          made_.clear();
          thrown_ = std::current_exception();
        }
        isReady_ = true;
      }) {}

DrawingsBeside::~DrawingsBeside() { ends_ = true; }

void DrawingsBeside::make() {
  const auto look = [this](double share) {
    share_ = share;
    if (ends_) throw Ended();
  };
  const auto context = std::make_shared<GlContext>();
  // Whatever is thrown, drawings go while their context is current here.
  struct Release {
    GlContext& context;
    std::vector<Made>& made;
    bool isWhole = false;
    ~Release() {
      if (!isWhole) made.clear();
      context.release();
    }
  } release{*context, made_};
  const auto scene = std::make_shared<const GpuScene>(simulation_);
  const StateAt stateAt = [this](double t) { return advance(simulation_, t); };
  for (const std::size_t number : cameras_) {
    const Camera& camera = simulation_.cameras[number];
    std::vector<double> accuracies = rungsOf(camera);
    if (which_ != Which::AllRungs) accuracies.resize(1);
    if (which_ == Which::Draft) accuracies = {kDraft};
    made_.push_back({number, std::make_unique<CameraDrawing>(simulation_, camera, library_, scene, accuracies, look, context), {}});
    Made& made = made_.back();
    const ExposureParts parts = exposureParts(simulation_, camera, stateAt, time_s_);
    for (std::size_t rung = 0; rung < made.drawing->rungs(); ++rung) {
      double least_ns = INFINITY;
      for (int k = 0; k <= kTries; ++k) {  // the first has programs compiled
        look(1.0);
        const auto from = std::chrono::steady_clock::now();
        if (parts.times_s.size() > 1) renderParts(made.drawing->renderer(rung), parts, stateAt, {});
        else made.drawing->renderer(rung).render(stateAt(parts.times_s[0]));
        if (k > 0) least_ns = std::min(least_ns, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - from).count());
      }
      made.work_ns.push_back(least_ns);
    }
  }
  release.isWhole = true;
}

std::vector<DrawingsBeside::Made> DrawingsBeside::take() {
  thread_.join();
  if (thrown_) std::rethrow_exception(thrown_);
  return std::move(made_);
}

}  // namespace pitviper
