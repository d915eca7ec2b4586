#pragma once
// Frames without drawing: what the processor does of a frame by itself, whatever draws it.
#include <array>

namespace pitviper {

/// While it lives nothing is drawn, dispatched, cleared or copied out of targets, on any thread; states are set, and numbers handed over and read, as ever.
/// What has been drawn before stays, so that what is read is of the last frame. All that draws must have drawn before, which finds the driver's functions.
class Undrawn {
 public:
  Undrawn();
  ~Undrawn();
  Undrawn(const Undrawn&) = delete;
  Undrawn& operator=(const Undrawn&) = delete;

 private:
  std::array<void (*)(), 7> before_;
};

}  // namespace pitviper
