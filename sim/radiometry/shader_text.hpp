#pragma once
// Shader source compiled into the program: path from the repository root, and text.
#include <span>
#include <string_view>

namespace pitviper {
struct ShaderText {
  std::string_view path;
  std::string_view text;
};
}  // namespace pitviper
