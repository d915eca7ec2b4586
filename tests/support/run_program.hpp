#pragma once
// The program as a user runs it.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace pitviper::test {

struct Result {
  int code = -1;  ///< 128: ended by a signal
  std::string output;
};

/// Runs a shell command line, both streams together.
inline Result run(const std::string& line) {
  Result r;
  FILE* pipe = popen((line + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) r.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  r.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return r;
}

inline Result pitviper(const std::string& arguments) {
  return run(std::string("PITVIPER_HOME=") + PITVIPER_SOURCE_DIR + " " + PITVIPER_PROGRAM + " " + arguments);
}

}  // namespace pitviper::test
