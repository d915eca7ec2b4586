#include "sim/frame/frame.hpp"

#include <cstdio>

namespace pitviper {

std::string frameFileStem(const std::string& camera, int number, const std::string& kind) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "_%05d", number);
  return camera + digits + (kind.empty() ? "" : "_" + kind);
}

std::string frameFileStem(const Frame& frame) { return frameFileStem(frame.camera, frame.number, frame.kind); }

}  // namespace pitviper
