#pragma once
// printf into a string, for the fixed columns of files that tests write.
#include <string>

namespace pitviper::test {

/// At most 511 characters.
std::string print(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace pitviper::test
