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

std::vector<BlendPath> offeredBlendPaths() {
  std::vector<BlendPath> all;
  for (BlendPath path : {BlendPath::FramebufferFetch, BlendPath::TextureBarrier, BlendPath::PingPong})
    if (isOffered(path)) all.push_back(path);
  return all;
}

BlendPath chooseBlendPath() {
  const auto offered = offeredBlendPaths();
  const char* wish = std::getenv("PITVIPER_BLEND");
  if (!wish || !*wish) return offered.front();
  std::string names;
  for (BlendPath path : offered) {
    if (wish == nameOf(path)) return path;
    names += (names.empty() ? "" : ", ") + nameOf(path);
  }
  throw GlError(std::string("PITVIPER_BLEND is '") + wish + "', which is none of what this driver offers: " + names + "; leave it unset, or take one of these");
}

}  // namespace pitviper
