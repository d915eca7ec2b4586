#pragma once
// Puts a program's source together from files: one file per slot, each used file once, and knows where every line came from.
//
// In a .glsl file:   //@use path        the file's text is inserted here, once per program
//                    //@slot name       the file chosen for that slot is inserted here
//                    //@constants       the structural constants of the plan are inserted here
//                    //@each k COUNT    the lines to its //@end once for each k from 0 on, {k} replaced; COUNT: a constant of the plan, or a number.
//                                       Arrays written out so: drivers without a GPU keep real ones in memory, several times slower
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sim/radiometry/shader_text.hpp"

namespace pitviper {

/// All shader files of the program, by path.
class ShaderLibrary {
 public:
  void add(std::span<const ShaderText> texts);
  /// Throws std::logic_error for a path that is not there: a mistake in the program, not of the user.
  std::string_view text(const std::string& path) const;

 private:
  std::map<std::string, std::string_view, std::less<>> texts_;
};

struct AssembledShader {
  std::string source;
  /// Where line i + 1 of the source came from: "path:line".
  std::vector<std::string> origin;

  /// A compiler's log with its line numbers replaced by file:line. Understands Mesa's "0:12(3):" and NVIDIA's "0(12) :".
  std::string mapLog(const std::string& log) const;
};

struct ShaderSlots {
  std::map<std::string, std::string> files;      ///< slot -> path
  std::map<std::string, std::string> generated;  ///< slot -> text written by the plan; its //@use lines count
  std::map<std::string, long long> constants;    ///< structural counts: const int NAME = value
  std::vector<std::string> extensions;           ///< GLSL extensions the program requires
};

/// Declares `name`(i), numbers that are a plan's own, four to an entry, in a buffer bound as a texture to `unit`. They are not in the text, so that plans alike
/// but for their numbers share a program: as constants they cost a frame as much (0.98 to 1.01 times, without a GPU), and each edit seconds of compiling.
std::string planNumbers(const std::string& name, int unit);

AssembledShader assembleShader(const ShaderLibrary& library, const std::string& mainPath, const ShaderSlots& slots);

}  // namespace pitviper
