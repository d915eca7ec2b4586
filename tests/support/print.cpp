#include "tests/support/print.hpp"

#include <cstdarg>
#include <cstdio>

namespace pitviper::test {

std::string print(const char* pattern, ...) {
  char line[512];
  va_list list;
  va_start(list, pattern);
  std::vsnprintf(line, sizeof line, pattern, list);
  va_end(list);
  return line;
}

}  // namespace pitviper::test
