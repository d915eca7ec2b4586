#include "scenarios/view/window/glfw_window.hpp"

#define GLFW_INCLUDE_NONE  // OpenGL is epoxy's
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "scenarios/view/window/style.hpp"
#include "sim/parameters/error.hpp"
#include "sim/stream/projector/x_errors.hpp"

/// As in GLFW/glfw3native.h, which includes more of X11 than the packages bring.
extern "C" struct _XDisplay* glfwGetX11Display(void);

namespace pitviper {
namespace {

/// Of a window's side.
constexpr int kMostPixels = 16384;

std::string glfwSays() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "GLFW gives no reason";
}

struct Library {
  Library() {
    if (glfwInit()) return;
    throw UserError({"view", 0, 0, -1}, "there is no display (" + glfwSays() + ")", "a running X server or Wayland compositor",
                    "set DISPLAY, as in DISPLAY=:0; without a screen: xvfb-run pitviper view SCENARIO.yaml --script FILE");
  }
  ~Library() { glfwTerminate(); }
};

GlfwWindow* windowOf(GLFWwindow* window) { return static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window)); }

}  // namespace

struct GlfwWindow::Own {
  XErrors errors;  ///< outlives the display
  Library library;
  GLFWwindow* window = nullptr;
  bool isScripted = false;
  ImVec2 mouse{-1e6f, -1e6f};
  std::array<bool, 3> isDown{}, wasPressed{};
  bool heard = true, keeps = false;
  double heard_s = 0.0;
  Rgb8Image kept;
  ~Own() {
    if (ImGui::GetCurrentContext()) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui_ImplGlfw_Shutdown();
      ImGui::DestroyContext();
    }
    if (window) glfwDestroyWindow(window);
  }
};

GlfwWindow::GlfwWindow(const WindowOptions& options) : own_(std::make_unique<Own>()) {
  own_->isScripted = options.isScripted;
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, options.scale > 0.0f ? GLFW_FALSE : GLFW_TRUE);
  own_->window = glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
  if (!own_->window)
    throw UserError({"view", 0, 0, -1}, "no window can be made (" + glfwSays() + ")", "a display with OpenGL 3.3",
                    "install libgl1-mesa-dri, or the card's driver");
  own_->errors.watch(glfwGetX11Display());
  glfwMakeContextCurrent(own_->window);
  glfwSwapInterval(1);
  float across = 1.0f, up = 1.0f;
  glfwGetWindowContentScale(own_->window, &across, &up);
  scale_ = options.scale > 0.0f ? options.scale : std::max({across, up, 1.0f});
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  setStyle(scale_);
  ImGui_ImplGlfw_InitForOpenGL(own_->window, false);
  ImGui_ImplOpenGL3_Init("#version 330");
  glfwSetWindowUserPointer(own_->window, this);
  glfwSetWindowFocusCallback(own_->window, ImGui_ImplGlfw_WindowFocusCallback);
  glfwSetCursorEnterCallback(own_->window, ImGui_ImplGlfw_CursorEnterCallback);
  if (own_->isScripted) return;
  glfwSetCursorPosCallback(own_->window, [](GLFWwindow* w, double x, double y) { windowOf(w)->onCursor(x, y); });
  glfwSetMouseButtonCallback(own_->window, [](GLFWwindow* w, int button, int action, int mods) { windowOf(w)->onButton(button, action == GLFW_PRESS, mods); });
  glfwSetScrollCallback(own_->window, [](GLFWwindow* w, double x, double y) { windowOf(w)->onScroll(x, y); });
  glfwSetKeyCallback(own_->window, [](GLFWwindow* w, int key, int, int action, int mods) { windowOf(w)->onKey(key, action != GLFW_RELEASE, mods); });
  glfwSetCharCallback(own_->window, [](GLFWwindow* w, unsigned code) { windowOf(w)->onChar(code); });
}

GlfwWindow::~GlfwWindow() = default;

void GlfwWindow::onCursor(double x, double y) { own_->heard = true, own_->mouse = ImVec2(static_cast<float>(x), static_cast<float>(y)); }

void GlfwWindow::onButton(int button, bool down, int mods) {
  own_->heard = true;
  if (button < 0 || button >= 3) return;
  own_->isDown[static_cast<std::size_t>(button)] = down;
  if (down) own_->wasPressed[static_cast<std::size_t>(button)] = true;
  ImGui_ImplGlfw_MouseButtonCallback(own_->window, button, down ? GLFW_PRESS : GLFW_RELEASE, mods);
}

void GlfwWindow::onScroll(double x, double y) { own_->heard = true, ImGui_ImplGlfw_ScrollCallback(own_->window, x, y); }

void GlfwWindow::onKey(int key, bool down, int mods) {
  own_->heard = true;
  ImGui_ImplGlfw_KeyCallback(own_->window, key, 0, down ? GLFW_PRESS : GLFW_RELEASE, mods);
  if (!own_->isScripted) return;
  ImGuiIO& io = ImGui::GetIO();
  io.KeyCtrl = mods & GLFW_MOD_CONTROL, io.KeyShift = mods & GLFW_MOD_SHIFT, io.KeyAlt = mods & GLFW_MOD_ALT;
}

void GlfwWindow::onChar(unsigned code) { own_->heard = true, ImGui_ImplGlfw_CharCallback(own_->window, code); }

bool GlfwWindow::listen(double wait_s) {
  if (wait_s > 0.0) glfwWaitEventsTimeout(wait_s);
  else glfwPollEvents();
  constexpr double kLately_s = 0.5;
  const double now_s = glfwGetTime();
  if (std::exchange(own_->heard, false) || own_->isDown[0] || own_->isDown[1]) own_->heard_s = now_s;
  return now_s - own_->heard_s < kLately_s;
}

void GlfwWindow::beginFrame() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  refuseGone();  // a display that is gone has no sizes
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(std::max(io.DisplaySize.x, 1.0f), std::max(io.DisplaySize.y, 1.0f));
  io.MousePos = own_->mouse;
  for (std::size_t b = 0; b < 3; ++b) io.MouseDown[b] = own_->isDown[b] || own_->wasPressed[b];
  own_->wasPressed = {};
  ImGui::NewFrame();
}

void GlfwWindow::endFrame() {
  ImGui::Render();
  glViewport(0, 0, width(), height());
  const ImVec4 back = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
  glClearColor(back.x, back.y, back.z, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (own_->keeps) readPixels();
  glfwSwapBuffers(own_->window);
}

void GlfwWindow::refuseGone() const {
  if (const std::string gone = own_->errors.fatal(); !gone.empty()) throw std::runtime_error("view: " + gone);
}

bool GlfwWindow::isClosed() {
  refuseGone();
  return glfwWindowShouldClose(own_->window) == GLFW_TRUE;
}

void GlfwWindow::wake() { glfwPostEmptyEvent(); }

void GlfwWindow::setTitle(const std::string& title) { glfwSetWindowTitle(own_->window, title.c_str()); }

void GlfwWindow::resize(int width, int height) { glfwSetWindowSize(own_->window, width, height); }

// Of a display that has just gone sizes are any number.
int GlfwWindow::width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(own_->window, &width, &height);
  return std::clamp(width, 0, kMostPixels);
}

int GlfwWindow::height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(own_->window, &width, &height);
  return std::clamp(height, 0, kMostPixels);
}

void GlfwWindow::keepPixels(bool keep) { own_->keeps = keep; }

const Rgb8Image& GlfwWindow::pixels() const { return own_->kept; }

void GlfwWindow::readPixels() {
  const int w = width(), h = height();
  own_->kept = Rgb8Image(w, h, {});
  std::vector<std::uint8_t> rows(own_->kept.rgb.size());
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, w, h, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
  const std::size_t row = 3 * static_cast<std::size_t>(w);
  for (int y = 0; y < h; ++y)
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(h - 1 - y)), row,
                own_->kept.rgb.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(y)));
}

}  // namespace pitviper
