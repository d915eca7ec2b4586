#pragma once
// A window, or a whole monitor, and the OpenGL context that draws in it.
#define GLFW_INCLUDE_NONE  // OpenGL is epoxy's
#include <GLFW/glfw3.h>

#include <memory>

#include "sim/stream/projector/code_table.hpp"
#include "sim/stream/projector/projector_module.hpp"
#include "sim/stream/projector/x_errors.hpp"

namespace pitviper {

/// Made, used and destroyed on one thread. GLFW says that this be the main one; on X11 and Wayland any will do, as long as it is always the same.
class DisplayWindow {
 public:
  /// Throws ProjectorFailure.
  explicit DisplayWindow(const ProjectorOptions& options);

  /// `pixels`: width x height of them.
  void load(const std::vector<ShownCode>& pixels);
  /// What was loaded last, or black.
  void draw();
  /// Shows what was drawn, at the next vertical blanking where the display has one, and waits for it.
  void swap();
  /// Escape, or the window's own button. Throws ProjectorFailure where the window or the display is gone.
  bool isClosed();
  /// Of the monitor, or of the fastest that the window may be on.
  double nominalRate_hz() const { return nominalRate_hz_; }

 private:
  struct Library {
    Library();
    ~Library();
  };
  struct Close {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
  };
  GLFWmonitor* chooseMonitor();
  void makeWindow();
  void checkDepth() const;
  void makePicture();

  XErrors errors_;  ///< outlives the display
  Library library_;
  ProjectorOptions options_;
  double nominalRate_hz_ = 0.0;
  std::unique_ptr<GLFWwindow, Close> window_;
  unsigned framebuffer_ = 0, texture_ = 0;  ///< gone with the window's context
  bool isLoaded_ = false;
};

}  // namespace pitviper
