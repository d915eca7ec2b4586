#include "scenarios/commands/code_lines.hpp"

#include <fstream>
#include <string>

namespace pitviper {

long codeLines(const std::filesystem::path& folder) {
  long lines = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto kind = entry.path().extension();
    if (!entry.is_regular_file() || (kind != ".cpp" && kind != ".hpp" && kind != ".glsl")) continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) lines += line.find_first_not_of(" \t\r") != std::string::npos;
  }
  return lines;
}

}  // namespace pitviper
