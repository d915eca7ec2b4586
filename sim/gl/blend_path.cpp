#include "sim/gl/blend_path.hpp"

#include <epoxy/gl.h>

#include <cstdlib>

#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

bool isOffered(BlendPath path) {
  if (path == BlendPath::FramebufferFetch) return epoxy_has_gl_extension("GL_EXT_shader_framebuffer_fetch");
  if (path == BlendPath::TextureBarrier) return epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_texture_barrier");
  return true;
}

}  // namespace

std::string nameOf(BlendPath path) {
  switch (path) {
    case BlendPath::FramebufferFetch:
      return "fetch";
    case BlendPath::TextureBarrier:
      return "barrier";
    case BlendPath::PingPong:
      break;
  }
  return "ping_pong";
}

BlendPath chooseBlendPath() {
  const char* wish = std::getenv("PITVIPER_BLEND");
  const std::string asked = wish ? wish : "";
  for (BlendPath path : {BlendPath::FramebufferFetch, BlendPath::TextureBarrier, BlendPath::PingPong}) {
    if (!asked.empty() && asked != nameOf(path)) continue;
    if (isOffered(path)) return path;
    if (!asked.empty()) throw GlError("PITVIPER_BLEND asks for '" + asked + "', which this driver does not offer; leave it unset, or take ping_pong");
  }
  throw GlError("PITVIPER_BLEND is '" + asked + "'; it can be fetch, barrier or ping_pong");
}

}  // namespace pitviper
