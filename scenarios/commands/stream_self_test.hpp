#pragma once
// Streams that go to themselves: what each way of a frame or a command takes on this machine, without drawing.
#include <string>

namespace pitviper {

struct SelfTestWish {
  int width = 640, height = 512;
  double rate_hz = 60.0, duration_s = 5.0;  ///< of each transport
};

/// Prints a table. Returns 0, or 3 where a frame of shared memory or of the network was neither received nor counted as lost. Errors: UserError,
/// std::runtime_error.
int streamSelfTest(const SelfTestWish& wish);

}  // namespace pitviper
