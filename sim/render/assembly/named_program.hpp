#pragma once
#include <string>

namespace pitviper {

/// A program of a pass, for whoever wants to see what is in it.
struct NamedProgram {
  std::string name, text;
};

}  // namespace pitviper
