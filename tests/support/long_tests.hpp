#pragma once
// What repeats a claim on more of the same kind, and takes long, is tried where it is asked for: PITVIPER_LONG=1.
#include <cstdlib>
#include <string>

namespace pitviper::test {

/// Whether the long tests are asked for too, by PITVIPER_LONG=1.
inline bool runsLong() {
  const char* text = std::getenv("PITVIPER_LONG");
  return text != nullptr && std::string(text) == "1";
}

}  // namespace pitviper::test
