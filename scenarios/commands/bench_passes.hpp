#pragma once
// What `bench` times: a drawing pass, or the whole way to an image in memory. All that bench knows of the renderer is behind this.
#include <functional>

#include "scenarios/commands/bench_scenarios.hpp"

namespace pitviper {

/// Each call draws one frame with what was set up once. Needs a current GlContext as long as it lives.
using DrawFrame = std::function<void()>;

/// Visibility, shading, integration into the channels; the picture stays on the device.
DrawFrame preparePass(const BenchSetting& setting);

/// CameraRenderer::render: read back, in double precision, resolved into pixels.
DrawFrame prepareWholeFrame(const BenchSetting& setting);

}  // namespace pitviper
