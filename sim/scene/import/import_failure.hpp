#pragma once
// What is wrong with a file being imported; becomes an ImportReply at the module's border.
#include <string>

#include "sim/parameters/error.hpp"

namespace pitviper {

struct ImportFailure {
  Location where;
  std::string wrong, expected, fix;
};

[[noreturn]] inline void failAtByte(const std::string& file, unsigned long long byte, const std::string& wrong, const std::string& expected = "",
                                    const std::string& fix = "") {
  throw ImportFailure{{file, 0, 0, static_cast<long long>(byte)}, wrong, expected, fix};
}

}  // namespace pitviper
