#include "sim/gl/context.hpp"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "sim/gl/driver_cache.hpp"
#include "sim/gl/sampler_slots.hpp"

namespace pitviper {
namespace {

bool hasWord(const char* list, const char* word) {
  if (!list) return false;
  const size_t n = std::strlen(word);
  for (const char* p = list; (p = std::strstr(p, word)); p += n)
    if ((p == list || p[-1] == ' ') && (p[n] == ' ' || p[n] == '\0')) return true;
  return false;
}

/// Made so far: a new one may stand where one stood before.
std::atomic<unsigned> gContexts{0};

constexpr const char* kInstall = "install Mesa's software renderer: apt-get install libegl1 libgl1 libgl1-mesa-dri, or a GPU driver with EGL";

/// The library of entry points ends the process where it finds none: what it would look for is looked for before.
void checkEgl() {
  bool hasGl = false;
  for (const char* library : {"libOpenGL.so.0", "libGL.so.1"}) {
    void* at = hasGl ? nullptr : dlopen(library, RTLD_LAZY | RTLD_LOCAL);
    hasGl |= at != nullptr;
    if (at) dlclose(at);
  }
  if (!hasGl) throw GlError(std::string("there is no OpenGL library (libOpenGL.so.0 or libGL.so.1); ") + kInstall);
  if (!epoxy_has_egl()) throw GlError(std::string("there is no EGL library (libEGL.so.1); ") + kInstall);
  if (!hasWord(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_platform_base"))
    throw GlError(std::string("EGL has no driver behind it (no file in /usr/share/glvnd/egl_vendor.d, or where __EGL_VENDOR_LIBRARY_DIRS says, names one "
                              "that loads); ") +
                  kInstall);
}

std::vector<EGLDeviceEXT> devices() {
  EGLint count = 0;
  if (!hasWord(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_device_enumeration") &&
      !hasWord(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_device_base"))
    return {};
  if (!eglQueryDevicesEXT(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> found(static_cast<size_t>(count));
  eglQueryDevicesEXT(count, found.data(), &count);
  found.resize(static_cast<size_t>(count));
  return found;
}

EGLDisplay openDevice(EGLDeviceEXT device) { return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr); }

EGLContext makeContext(EGLDisplay display, EGLContext shared = EGL_NO_CONTEXT) {
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) return EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  const EGLint configWanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglChooseConfig(display, configWanted, &config, 1, &configs) || configs < 1) config = nullptr;
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLContext context = eglCreateContext(display, config, shared, wanted);
  if (context == EGL_NO_CONTEXT) return context;
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    return EGL_NO_CONTEXT;
  }
  return context;
}

std::string string(GLenum name) {
  const auto* s = reinterpret_cast<const char*>(glGetString(name));
  return s ? s : "";
}

}  // namespace

GlLimits currentLimits() {
  GlLimits l;
  l.vendor = string(GL_VENDOR);
  l.renderer = string(GL_RENDERER);
  l.version = string(GL_VERSION);
  l.software = l.renderer.find("llvmpipe") != std::string::npos || l.renderer.find("softpipe") != std::string::npos;
  GLint viewport[2] = {0, 0}, attachments = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &l.largestTexture);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  l.largestTexture = std::min({l.largestTexture, viewport[0], viewport[1]});
  glGetIntegerv(GL_MAX_DRAW_BUFFERS, &l.drawBuffers);
  glGetIntegerv(GL_MAX_COLOR_ATTACHMENTS, &attachments);
  l.drawBuffers = std::min(l.drawBuffers, attachments);
  glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &l.uniformBlock);
  return l;
}

bool isSoftware() {
  thread_local std::pair<EGLContext, unsigned> asked;
  thread_local bool is = false;
  if (const std::pair now(eglGetCurrentContext(), gContexts.load()); now != asked || now.first == EGL_NO_CONTEXT) {
    asked = now;
    is = currentLimits().software;
  }
  return is;
}

SharedContext SharedContext::ofCurrent() { return {eglGetCurrentDisplay(), eglGetCurrentContext()}; }

void GlContext::begin() {
  ++gContexts;
  displayBefore_ = eglGetCurrentDisplay();
  before_ = eglGetCurrentContext();
}

GlContext::GlContext(const SharedContext& shared) : display_(shared.display) {
  begin();
  context_ = makeContext(shared.display, shared.context);
  if (!context_) throw GlError("the driver has no further context that shares objects with one");
  limits_ = currentLimits();
  if (limits_.software) fillSamplerSlots();
}

GlContext::GlContext(std::string device) {
  begin();
  if (const char* wish = std::getenv("PITVIPER_GL"); wish && *wish && device == "auto") device = wish;
  prepareDriverCache();
  checkEgl();
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  auto tryDisplay = [&](EGLDisplay candidate) {
    context = makeContext(candidate);
    if (context != EGL_NO_CONTEXT) display = candidate;
    return context != EGL_NO_CONTEXT;
  };
  if (device.rfind("device:", 0) == 0) {
    const auto all = devices();
    const size_t index = static_cast<size_t>(std::strtoul(device.c_str() + 7, nullptr, 10));
    if (index >= all.size()) throw GlError("EGL offers " + std::to_string(all.size()) + " devices, there is no '" + device + "'; use PITVIPER_GL=surfaceless");
    tryDisplay(openDevice(all[index]));
  } else if (device == "auto" || device == "surfaceless") {
    if (device == "auto") {
      for (EGLDeviceEXT d : devices()) {
        if (hasWord(eglQueryDeviceStringEXT(d, EGL_EXTENSIONS), "EGL_MESA_device_software")) continue;
        if (tryDisplay(openDevice(d))) break;
      }
    }
    if (context == EGL_NO_CONTEXT) tryDisplay(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  } else {
    throw GlError("PITVIPER_GL is '" + device + "'; it can be auto, surfaceless or device:N");
  }
  if (context == EGL_NO_CONTEXT) throw GlError("no OpenGL 4.5 core context through EGL (tried " + device + "); " + kInstall);
  display_ = display;
  context_ = context;
  limits_ = currentLimits();
  if (limits_.software) fillSamplerSlots();
}

GlContext::~GlContext() {
  if (eglGetCurrentContext() == context_) release();
  eglDestroyContext(display_, context_);
}

void GlContext::release() {
  if (before_) eglMakeCurrent(displayBefore_, EGL_NO_SURFACE, EGL_NO_SURFACE, before_);
  else eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  before_ = nullptr;
}

UsedContext::UsedContext(const GlContext* context) : isUsed_(context != nullptr) {
  if (!isUsed_) return;
  display_ = context->display_;
  displayBefore_ = eglGetCurrentDisplay();
  before_ = eglGetCurrentContext();
  eglBindAPI(EGL_OPENGL_API);
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context->context_)) throw GlError("a context of another thread cannot be used here");
}

UsedContext::~UsedContext() {
  if (!isUsed_) return;
  if (before_) eglMakeCurrent(displayBefore_, EGL_NO_SURFACE, EGL_NO_SURFACE, before_);
  else eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void checkUniformSize(std::size_t bytes, const char* what) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &limit);
  if (bytes > static_cast<std::size_t>(limit))
    throw GlError(std::string(what) + " take " + std::to_string(bytes) + " bytes, this driver's uniform blocks hold " + std::to_string(limit) +
                  "; use fewer spectral samples, channels or lights");
}

void checkGl(const char* doing) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  std::string name = error == GL_OUT_OF_MEMORY                   ? "out of memory"
                     : error == GL_INVALID_OPERATION             ? "invalid operation"
                     : error == GL_INVALID_VALUE                 ? "invalid value"
                     : error == GL_INVALID_ENUM                  ? "invalid enum"
                     : error == GL_INVALID_FRAMEBUFFER_OPERATION ? "incomplete framebuffer"
                                                                 : "error " + std::to_string(error);
  throw GlError(std::string("OpenGL: ") + name + " while " + doing);
}

}  // namespace pitviper
