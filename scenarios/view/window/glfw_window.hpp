#pragma once
// The window itself: GLFW's, Dear ImGui in it, and one way in for mouse and keys, which scripts use too.
#include <memory>
#include <string>

#include "sim/image/picture.hpp"

struct GLFWwindow;

namespace pitviper {

struct WindowOptions {
  int width = 1440, height = 900;
  float scale = 0.0f;  ///< of text and all else; 0: the display's
  std::string title = "pitviper";
  bool isScripted = false;  ///< what a person does is not heard
};

class GlfwWindow {
 public:
  /// Throws UserError where there is no display or no window can be made.
  explicit GlfwWindow(const WindowOptions& options);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  /// Takes what mouse and keys have done, waiting for it at most so long. Whether they did anything lately.
  bool listen(double wait_s);
  /// Throws std::runtime_error where the display is gone.
  void beginFrame();
  void endFrame();
  /// Throws std::runtime_error where the display is gone.
  bool isClosed();
  float scale() const { return scale_; }
  void setTitle(const std::string& title);
  void resize(int width, int height);
  int width() const;
  int height() const;
  /// Whether frames from now on are kept for pixels().
  void keepPixels(bool keep);
  /// What the last frame that was kept showed.
  const Rgb8Image& pixels() const;

  /// Ends a wait of beginFrame(); from any thread.
  static void wake();

  /// As GLFW's callbacks: whoever calls them.
  void onCursor(double x, double y);
  void onButton(int button, bool down, int mods);
  void onScroll(double x, double y);
  void onKey(int key, bool down, int mods);
  void onChar(unsigned code);

 private:
  void readPixels();
  void refuseGone() const;
  struct Own;
  std::unique_ptr<Own> own_;
  float scale_ = 1.0f;
};

}  // namespace pitviper
