#include "sim/stream/projector/display_window.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <atomic>
#include <string>

#include "sim/stream/projector/projector_failure.hpp"

/// As in GLFW/glfw3native.h, which includes more of X11 than the packages bring.
extern "C" struct _XDisplay* glfwGetX11Display(void);

namespace pitviper {
namespace {

/// Of a monitor that tells none, as a virtual one.
constexpr double kUsualRate_hz = 60.0;

/// GLFW has one display for the process, and one thread for it.
std::atomic<bool> inUse = false;

std::string glfwReason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "GLFW gives no reason";
}

std::string sizeText(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

}  // namespace

DisplayWindow::Library::Library() {
  if (inUse.exchange(true)) throw ProjectorFailure("there is one already", "one projector at a time", "close the other");
  if (glfwInit()) return;
  const std::string reason = glfwReason();
  inUse = false;
  throw ProjectorFailure("there is no display (" + reason + ")", "a running X server",
                         "set DISPLAY, as in DISPLAY=:0, or start one: Xvfb :99 -screen 0 1280x1024x24");
}

DisplayWindow::Library::~Library() {
  glfwTerminate();
  inUse = false;
}

DisplayWindow::DisplayWindow(const ProjectorOptions& options) : options_(options) {
  makeWindow();
  checkDepth();
  makePicture();
}

GLFWmonitor* DisplayWindow::chooseMonitor() {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  if (options_.monitor >= count)
    throw ProjectorFailure("there is no monitor " + std::to_string(options_.monitor),
                           count > 0 ? "0 to " + std::to_string(count - 1) : "a window: there are none", "see 'xrandr --listmonitors'");
  GLFWmonitor* chosen = options_.monitor >= 0 ? monitors[options_.monitor] : nullptr;
  int fastest_hz = 0;
  for (int i = 0; i < count; ++i)
    if (const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]); mode != nullptr && (chosen == nullptr || chosen == monitors[i]))
      fastest_hz = std::max(fastest_hz, mode->refreshRate);
  nominalRate_hz_ = fastest_hz > 0 ? fastest_hz : kUsualRate_hz;
  return chosen;
}

void DisplayWindow::makeWindow() {
  int width = options_.width * options_.scale, height = options_.height * options_.scale;
  GLFWmonitor* monitor = chooseMonitor();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // a projector goes on when somebody works at another monitor
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_ALPHA_BITS, 0);
  if (monitor != nullptr) {
    const GLFWvidmode mode = *glfwGetVideoMode(monitor);
    if (width > mode.width || height > mode.height)
      throw ProjectorFailure("a picture of " + sizeText(width, height) + " pixels is larger than the monitor's " + sizeText(mode.width, mode.height),
                             "one that fits", "make the camera's film or the scale smaller");
    width = mode.width, height = mode.height;
    glfwWindowHint(GLFW_RED_BITS, mode.redBits);
    glfwWindowHint(GLFW_GREEN_BITS, mode.greenBits);
    glfwWindowHint(GLFW_BLUE_BITS, mode.blueBits);
    glfwWindowHint(GLFW_REFRESH_RATE, mode.refreshRate);  // as it is: no change of mode
  }
  window_.reset(glfwCreateWindow(width, height, "pitviper projector", monitor, nullptr));
  if (!window_)
    throw ProjectorFailure("no window can be made (" + glfwReason() + ")", "a display with OpenGL 3.3", "install libgl1-mesa-dri, or the card's driver");
  errors_.watch(glfwGetX11Display());
  glfwSetKeyCallback(window_.get(), [](GLFWwindow* window, int key, int, int action, int) {
    if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) glfwSetWindowShouldClose(window, GLFW_TRUE);
  });
  if (monitor != nullptr) {
    glfwSetInputMode(window_.get(), GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
    glfwSetGamma(monitor, 1.0f);  // a night light's ramp would bend codes; GLFW puts it back
  }
  glfwMakeContextCurrent(window_.get());
  glfwSwapInterval(1);
}

void DisplayWindow::checkDepth() const {
  for (GLenum channel : {GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE, GL_FRAMEBUFFER_ATTACHMENT_GREEN_SIZE, GL_FRAMEBUFFER_ATTACHMENT_BLUE_SIZE}) {
    GLint bits = 0;
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, GL_BACK_LEFT, channel, &bits);
    if (bits < 8)
      throw ProjectorFailure("the display has " + std::to_string(bits) + " bits a channel", "8 or more",
                             "set its depth to 24: Xvfb :99 -screen 0 1280x1024x24");
  }
}

void DisplayWindow::makePicture() {
  glDisable(GL_DITHER);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, options_.width, options_.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  if (glCheckFramebufferStatus(GL_READ_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE || glGetError() != GL_NO_ERROR)
    throw ProjectorFailure("the driver cannot hold a picture of " + sizeText(options_.width, options_.height) + " pixels", "a smaller one",
                           "make the camera's film smaller");
}

void DisplayWindow::load(const std::vector<ShownCode>& pixels) {
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, options_.width, options_.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  isLoaded_ = true;
}

void DisplayWindow::draw() {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_.get(), &width, &height);
  glViewport(0, 0, width, height);
  glClear(GL_COLOR_BUFFER_BIT);
  if (!isLoaded_) return;
  // Nearest, in whole squares: each pixel is a copy. Rows run down in a frame and up in a window.
  const int shownWidth = options_.width * options_.scale, shownHeight = options_.height * options_.scale;
  const int left = (width - shownWidth) / 2, bottom = (height - shownHeight) / 2;
  glBlitFramebuffer(0, 0, options_.width, options_.height, left, bottom + shownHeight, left + shownWidth, bottom, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void DisplayWindow::swap() {
  glfwSwapBuffers(window_.get());
  glFinish();  // a swap only queues itself
}

bool DisplayWindow::isClosed() {
  glfwPollEvents();
  if (const std::string gone = errors_.fatal(); !gone.empty()) throw ProjectorFailure(gone, "", "");
  return glfwWindowShouldClose(window_.get()) == GLFW_TRUE;
}

}  // namespace pitviper
