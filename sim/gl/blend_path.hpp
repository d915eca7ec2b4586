#pragma once
// How a fragment reads the target pixel that it is about to write: what Duvenhage 2006 section 7 calls a programmable blend.
#include <string>
#include <vector>

namespace pitviper {

enum class BlendPath {
  FramebufferFetch,  ///< EXT_shader_framebuffer_fetch: reads it in order, whatever overlaps
  TextureBarrier,    ///< reads it as a texture; a barrier between draws that overlap
  PingPong           ///< reads a copy, renewed between draws that overlap
};

/// The first of the three that the current context offers, or the one that the environment variable PITVIPER_BLEND names (fetch, barrier,
/// ping_pong). Throws GlError for a name that is none, or that the driver cannot do.
BlendPath chooseBlendPath();
/// What the current context can do, best first.
std::vector<BlendPath> offeredBlendPaths();
/// "fetch", "barrier", "ping_pong".
std::string nameOf(BlendPath path);

}  // namespace pitviper
