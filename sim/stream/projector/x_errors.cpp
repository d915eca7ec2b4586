#include "sim/stream/projector/x_errors.hpp"

#include <X11/Xlib.h>

#include <atomic>

namespace pitviper {
namespace {

// Xlib's handlers are the process'.
Display* watched = nullptr;
XErrorHandler errorBefore = nullptr;
XIOErrorHandler ioErrorBefore = nullptr;
std::atomic<const char*> gone = nullptr;

int onError(Display* display, XErrorEvent* event) {
  if (display != watched) return errorBefore != nullptr ? errorBefore(display, event) : 0;
  if (event->error_code == BadWindow || event->error_code == BadDrawable) gone = "the window is gone";
  return 0;
}

int onIoError(Display* display) {
  if (display != watched) return ioErrorBefore != nullptr ? ioErrorBefore(display) : 0;
  gone = "the X server is gone";
  return 0;
}

/// Instead of exit().
void goOn(Display*, void*) {}

}  // namespace

void XErrors::watch(void* display) {
  if (display == nullptr) return;
  isWatching_ = true;
  gone = nullptr;
  watched = static_cast<Display*>(display);
  errorBefore = XSetErrorHandler(onError);
  ioErrorBefore = XSetIOErrorHandler(onIoError);
  XSetIOErrorExitHandler(watched, goOn, nullptr);
}

XErrors::~XErrors() {
  if (!isWatching_) return;
  XSetErrorHandler(errorBefore);
  XSetIOErrorHandler(ioErrorBefore);
  watched = nullptr;
}

std::string XErrors::fatal() const {
  const char* text = isWatching_ ? gone.load() : nullptr;
  return text != nullptr ? text : "";
}

}  // namespace pitviper
