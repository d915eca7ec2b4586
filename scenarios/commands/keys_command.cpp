#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/scenario_reader.hpp"

namespace pitviper {

CommandLine keysCommand(const std::string& ofSweeps) {
  return {{"keys", "", "the reference of every key of scenarios and sweeps (Markdown)"},
          "Prints the key reference as in scenarios/README.md.",
          {},
          [ofSweeps](const Arguments&) {
            std::fputs((keyReference() + ofSweeps).c_str(), stdout);
            return 0;
          }};
}

}  // namespace pitviper
