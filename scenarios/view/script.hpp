#pragma once
// What drives a window without a person: a text of one command a line.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

struct ScriptLine {
  enum class Kind { Open, Wait, Click, Drag, Type, Key, Scroll, Screenshot, Film, EndFilm, Picture, Resize, Print, Expect, Quit };
  Kind kind = Kind::Wait;
  std::vector<std::string> words;  ///< behind the command
  Location where;
};

/// `#` begins a comment; words in quotes hold spaces. Errors: UserError for a word that is none, or too few or many behind it.
std::vector<ScriptLine> parseScript(const std::string& text, const std::string& fileName);
std::vector<ScriptLine> readScript(const std::filesystem::path& file);

/// The commands with what they take, for --help.
std::string scriptHelp();

/// A number of a script's word. Errors: UserError.
double scriptNumber(const ScriptLine& line, std::size_t word);

}  // namespace pitviper
