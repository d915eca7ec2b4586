#include "scenarios/view/pixel_probe.hpp"

#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

constexpr int kBins = 48;

}  // namespace

struct PixelProbeDesk::Own {
  GlContext context;
  ViewedScenePointer scene;
  std::size_t number = 0;
  std::shared_ptr<const GpuScene> bodies;
  std::unique_ptr<PixelPartsMeter> meter;
};

PixelProbeDesk::PixelProbeDesk(const ShaderLibrary& library) : library_(library), own_(std::make_unique<Own>()) {}

PixelProbeDesk::~PixelProbeDesk() = default;

std::shared_ptr<const PixelProbe> PixelProbeDesk::look(const PixelProbeWish& wish, const std::function<bool()>& isStale,
                                                       const std::function<void(std::shared_ptr<const PixelProbe>)>& tell) {
  if (!wish.picture || !wish.picture->image) return nullptr;
  const ShownPicture& picture = *wish.picture;
  const Simulation& sim = picture.wish.scene->simulation;
  Own& o = *own_;
  if (o.scene != picture.wish.scene || o.number != picture.wish.camera || !o.meter) {
    o.meter.reset();
    o.scene = picture.wish.scene;
    o.number = picture.wish.camera;
    o.bodies = std::make_shared<const GpuScene>(sim);
    o.meter = std::make_unique<PixelPartsMeter>(sim, sim.cameras[o.number], library_, o.bodies);
  }
  WorldState state = worldWith(sim, picture.wish.hands, picture.wish.time_s)(picture.wish.time_s);
  if (picture.image->pointing) state = pointed(std::move(state), sim.cameras[o.number], picture.image->pointing->followed.pose);
  PixelProbe probe{picture.number, wish.column, wish.row, o.meter->at(state, wish.column, wish.row), {}};
  if (!(wish.high_um > wish.low_um)) return std::make_shared<const PixelProbe>(std::move(probe));
  tell(std::make_shared<const PixelProbe>(probe));
  if (isStale()) return nullptr;
  probe.spectrum = o.meter->spectrum(state, wish.column, wish.row, wish.low_um, wish.high_um, kBins);
  return std::make_shared<const PixelProbe>(std::move(probe));
}

}  // namespace pitviper
