#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/reader/scenario_reader.hpp"

namespace pitviper {

int keysCommand(const Arguments& arguments) {
  const Options o("keys", arguments, {}, 0, 0);
  std::fputs(keyReference().c_str(), stdout);
  return 0;
}

}  // namespace pitviper
