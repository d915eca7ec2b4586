#include "sim/frame/frame.hpp"

#include "sim/parameters/print.hpp"

namespace pitviper {

std::string frameFileStem(const std::string& camera, int number, const std::string& kind) {
  return camera + print("_%05d", number) + (kind.empty() ? "" : "_" + kind);
}

std::string frameFileStem(const Frame& frame) { return frameFileStem(frame.camera, frame.number, frame.kind); }

}  // namespace pitviper
