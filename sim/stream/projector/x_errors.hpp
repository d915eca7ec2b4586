#pragma once
// Where a window or its server is gone, Xlib ends the program; here that ends the projector alone.
#include <string>

namespace pitviper {

/// Notes the errors of one X display while it lives; those of others go where they went before. One at a time.
class XErrors {
 public:
  ~XErrors();
  XErrors() = default;
  XErrors(const XErrors&) = delete;
  XErrors& operator=(const XErrors&) = delete;

  /// `display`: Xlib's; null where windows are not X11's: nothing is noted. After GLFW has made its window, since that sets handlers of its own.
  void watch(void* display);
  /// That the window or the server is gone; empty: neither. Other errors are ignored, such as of a driver without gamma ramps.
  std::string fatal() const;

 private:
  bool isWatching_ = false;
};

}  // namespace pitviper
