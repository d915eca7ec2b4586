// Programs put together from files: lines written out, numbers of a plan, and where each line came from.
#include <gtest/gtest.h>

#include <stdexcept>

#include "sim/gl/shader_assembler.hpp"

namespace pitviper::test {
namespace {

/// The lines that a file gives, after those that all programs begin with.
std::vector<std::string> linesOf(const std::string& text, const ShaderSlots& slots, std::vector<std::string>* origin = nullptr) {
  const ShaderText texts[] = {{"test/a.glsl", "// begin\n"}, {"test/b.glsl", text}};
  ShaderLibrary library;
  library.add(texts);
  const AssembledShader s = assembleShader(library, "test/b.glsl", slots);
  std::vector<std::string> lines;
  size_t number = 0;
  for (size_t at = 0; at < s.source.size(); ++number) {
    const size_t end = s.source.find('\n', at);
    if (s.origin[number].starts_with("test/b") || s.origin[number].starts_with("generated")) {
      lines.push_back(s.source.substr(at, end - at));
      if (origin) origin->push_back(s.origin[number]);
    }
    at = end + 1;
  }
  return lines;
}

TEST(ShaderAssembler, WritesLinesOut) {
  ShaderSlots slots;
  slots.constants = {{"LIGHTS", 2}, {"NONE", 0}};
  std::vector<std::string> origin;
  EXPECT_EQ(linesOf("first\n//@each l LIGHTS\na{l} of\n//@each v 3\nb{l}{v}\n//@end\n//@end\n//@each x NONE\nnever {x}\n//@end\nlast\n", slots, &origin),
            (std::vector<std::string>{"first", "a0 of", "b00", "b01", "b02", "a1 of", "b10", "b11", "b12", "last"}));
  EXPECT_EQ(origin[1], "test/b.glsl:3");
  EXPECT_EQ(origin[8], "test/b.glsl:5");
  EXPECT_EQ(origin[9], "test/b.glsl:11");
}

TEST(ShaderAssembler, WritesGeneratedLinesOut) {
  ShaderSlots slots;
  slots.generated["sum"] = "//@each i 2\ns += f({i});\n//@end\n";
  EXPECT_EQ(linesOf("//@slot sum\n", slots), (std::vector<std::string>{"s += f(0);", "s += f(1);"}));
}

TEST(ShaderAssembler, RefusesWhatDoesNotEndOrCount) {
  EXPECT_THROW(linesOf("//@each l 2\na\n", {}), std::logic_error);
  EXPECT_THROW(linesOf("//@each l MANY\na\n//@end\n", {}), std::logic_error);
  EXPECT_THROW(linesOf("//@slot nothing\n", {}), std::logic_error);
}

}  // namespace
}  // namespace pitviper::test
