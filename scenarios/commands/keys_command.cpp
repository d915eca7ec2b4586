#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/scenario_reader.hpp"

namespace pitviper {

CommandLine keysCommand() {
  return {{"keys", "", "the reference of every scenario key (Markdown)"}, "Prints the key reference as in scenarios/README.md.", {}, [](const Arguments&) {
            std::fputs(keyReference().c_str(), stdout);
            return 0;
          }};
}

}  // namespace pitviper
