#include "scenarios/view/reference_difference.hpp"

#include <algorithm>
#include <cmath>

#include "sim/camera/camera_renderer.hpp"
#include "sim/gl/context.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {
namespace {

constexpr int kCoarsest = 32, kFinest = 4;
/// Of a wish that another follows some pixels too many are worked out.
constexpr std::size_t kAtOnce = 64;

}  // namespace

struct ReferenceDesk::Own {
  GlContext context;
  ViewedScenePointer scene;
  std::size_t number = 0;
  Camera camera;
  std::shared_ptr<const GpuScene> bodies;
  std::unique_ptr<CameraRenderer> renderer;
};

ReferenceDesk::ReferenceDesk(const ShaderLibrary& library) : library_(library), own_(std::make_unique<Own>()) {}

ReferenceDesk::~ReferenceDesk() = default;

std::shared_ptr<const ReferenceDifference> ReferenceDesk::look(const ShownPicture& picture, const std::function<bool()>& isStale,
                                                               const std::function<void(std::shared_ptr<const ReferenceDifference>)>& tell) {
  if (!picture.image || picture.tier == Tier::Sketch) return nullptr;
  const CameraImage& drawn = *picture.image;
  const Simulation& sim = picture.wish.scene->simulation;
  Own& o = *own_;
  if (o.scene != picture.wish.scene || o.number != picture.wish.camera || !o.renderer) {
    o.renderer.reset();
    o.scene = picture.wish.scene;
    o.number = picture.wish.camera;
    o.camera = drawnCamera(sim.cameras[o.number]);
    o.camera.spectral = {};
    o.camera.spectral.reference = true;
    o.camera.plan.clear();
    o.camera.truth = {};
    o.bodies = std::make_shared<const GpuScene>(sim);
    o.renderer = std::make_unique<CameraRenderer>(sim, o.camera, cameraPlan(sim, o.camera), library_, o.bodies);
  }
  WorldState state = worldWith(sim, picture.wish.hands, picture.wish.time_s)(picture.wish.time_s);
  if (drawn.pointing) state = pointed(std::move(state), o.camera, drawn.pointing->followed.pose);
  o.renderer->setParts(drawn.parts);
  o.renderer->setSolidAngles(drawn.solidAngles, cameraAt(o.camera, state).pinhole.focalLength_m);
  auto result = std::make_shared<ReferenceDifference>();
  result->picture = picture.number;
  result->width = drawn.width, result->height = drawn.height;
  const auto all = static_cast<std::size_t>(drawn.width) * static_cast<std::size_t>(drawn.height);
  std::vector<std::size_t> outputs;
  std::vector<int> slots;
  for (std::size_t k = 0; k < o.camera.outputs.size(); ++k)
    if (const int slot = drawn.slotOfOutput[k]; std::find(slots.begin(), slots.end(), slot) == slots.end()) {
      slots.push_back(slot);
      outputs.push_back(k);
      result->channels.push_back({o.camera.outputs[k].channel, std::vector<float>(all, NAN), 0.0, 0.0});
    }
  std::vector<double> floors, squares(outputs.size(), 0.0);
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    std::vector<double> sorted = drawn.slots[static_cast<std::size_t>(slots[k])];
    const auto bright = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 99 / 100);
    std::nth_element(sorted.begin(), bright, sorted.end());
    floors.push_back(std::max(kDark * *bright, o.renderer->plan().darkFloors()[static_cast<std::size_t>(o.renderer->plan().slotOfOutput[outputs[k]])]));
  }
  for (int step = kCoarsest; step >= kFinest; step /= 2) {
    std::vector<int> pixels;
    for (int y = step / 2; y < drawn.height; y += step)
      for (int x = step / 2; x < drawn.width; x += step) pixels.push_back(y * drawn.width + x);
    for (std::size_t from = 0; from < pixels.size(); from += kAtOnce) {
      if (isStale()) return nullptr;
      const std::vector<int> some(pixels.begin() + static_cast<std::ptrdiff_t>(from),
                                  pixels.begin() + static_cast<std::ptrdiff_t>(std::min(from + kAtOnce, pixels.size())));
      o.renderer->setWanted(some);
      const CameraImage exact = o.renderer->render(state);
      for (std::size_t k = 0; k < outputs.size(); ++k) {
        ReferenceDifference::Channel& channel = result->channels[k];
        for (int p : some) {
          const auto at = static_cast<std::size_t>(p);
          const double want = exact.slots[static_cast<std::size_t>(exact.slotOfOutput[outputs[k]])][at];
          const double off = (drawn.slots[static_cast<std::size_t>(slots[k])][at] - want) / std::max(std::abs(want), floors[k]);
          // A square of the step's size stands for the pixel in its middle until finer ones are known.
          const int x = p % drawn.width, y = p / drawn.width;
          for (int v = std::max(y - step / 2, 0); v < std::min(y + (step + 1) / 2, drawn.height); ++v)
            for (int u = std::max(x - step / 2, 0); u < std::min(x + (step + 1) / 2, drawn.width); ++u)
              channel.relative[static_cast<std::size_t>(v * drawn.width + u)] = static_cast<float>(off);
          channel.largest = std::max(channel.largest, std::abs(off));
          squares[k] += off * off;
        }
        channel.rms = std::sqrt(squares[k] / static_cast<double>(result->pixels + static_cast<int>(some.size())));
      }
      result->pixels += static_cast<int>(some.size());
      result->step = step;
      tell(std::make_shared<const ReferenceDifference>(*result));
    }
  }
  return result;
}

}  // namespace pitviper
