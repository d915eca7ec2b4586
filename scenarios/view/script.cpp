#include "scenarios/view/script.hpp"

#include <cctype>
#include <cstdlib>

#include "sim/parameters/read_file.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

struct Command {
  const char* name;
  ScriptLine::Kind kind;
  std::size_t fewest, most;
  const char* takes;
  const char* about;
};

using Kind = ScriptLine::Kind;

constexpr Command kCommands[] = {
    {"open", Kind::Open, 1, 1, "FILE", "another scenario"},
    {"wait", Kind::Wait, 1, 2, "done|picture|sketch|draft|problem|good|probe|sphere|dial|'T s' [LIMIT]",
     "until the picture is as asked, is there, or of that kind; a saved scenario is wrong, or good; these are ready; so long. LIMIT: seconds, else 120"},
    {"click", Kind::Click, 1, 3, "NAME [X Y]", "the middle of what has that name; of a picture a pixel, of a plot a value, else a share of its sides"},
    {"drag", Kind::Drag, 5, 6, "NAME X Y X2 Y2 [STEPS]", "with the left button from one such place to another"},
    {"scroll", Kind::Scroll, 2, 4, "NAME BY [X Y]", "the wheel"},
    {"type", Kind::Type, 1, 1, "TEXT", "letters"},
    {"key", Kind::Key, 1, 1, "KEY", "such as space, ctrl+z, shift+right, f1"},
    {"screenshot", Kind::Screenshot, 1, 1, "FILE.png", "the whole window"},
    {"picture", Kind::Picture, 1, 1, "FILE.png", "the layers alone, each with its colour bar"},
    {"film", Kind::Film, 1, 2, "FILE.mp4 [RATE]", "every frame of the window from here on"},
    {"end_film", Kind::EndFilm, 0, 0, "", ""},
    {"resize", Kind::Resize, 2, 2, "WIDTH HEIGHT", "the window, pixels"},
    {"print", Kind::Print, 1, 1, "NAME", "on the standard output, what stands there; * for all"},
    {"expect", Kind::Expect, 2, 2, "NAME TEXT", "ends with 1 unless what stands there has that text in it"},
    {"quit", Kind::Quit, 0, 0, "", ""},
};

std::vector<std::string> wordsOf(const std::string& line, const Location& where) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < line.size();) {
    const char c = line[i];
    if (std::isspace(static_cast<unsigned char>(c))) {
      ++i;
    } else if (c == '#') {
      break;
    } else if (c == '"' || c == '\'') {
      const std::size_t end = line.find(c, i + 1);
      if (end == line.npos) throw UserError(where, "a quote that does not end", "a second one", "add it");
      words.push_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      const std::size_t from = i;
      while (i < line.size() && !std::isspace(static_cast<unsigned char>(line[i])) && line[i] != '#') ++i;
      words.push_back(line.substr(from, i - from));
    }
  }
  return words;
}

}  // namespace

std::vector<ScriptLine> parseScript(const std::string& text, const std::string& fileName) {
  std::vector<ScriptLine> script;
  int number = 0;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    ++number;
    const Location where{fileName, number, 1, -1};
    std::vector<std::string> words = wordsOf(text.substr(from, end - from), where);
    from = end + 1;
    if (words.empty()) continue;
    const Command* found = nullptr;
    std::vector<std::string> names;
    for (const Command& c : kCommands) {
      names.emplace_back(c.name);
      if (words[0] == c.name) found = &c;
    }
    if (!found) throw unknownWord(where, "a script has no", words[0], names);
    words.erase(words.begin());
    if (words.size() < found->fewest || words.size() > found->most)
      throw UserError(where, std::string("'") + found->name + "' with " + std::to_string(words.size()) + " words behind it",
                      std::string(found->name) + " " + found->takes, "write it so");
    script.push_back({found->kind, std::move(words), where});
  }
  return script;
}

std::vector<ScriptLine> readScript(const std::filesystem::path& file) { return parseScript(readWholeFile(file, {}, {file.string(), 0, 0, -1}), file.string()); }

std::string scriptHelp() {
  std::string all;
  for (const Command& c : kCommands) {
    std::string line = std::string("  ") + c.name + (*c.takes ? std::string(" ") + c.takes : std::string());
    if (*c.about) line += std::string(": ") + c.about;
    all += line + "\n";
  }
  return all;
}

double scriptNumber(const ScriptLine& line, std::size_t word) {
  const std::string& text = line.words.at(word);
  char* end = nullptr;
  const double v = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || (*end != '\0' && std::string(end) != " s" && std::string(end) != "s"))
    throw UserError(line.where, "'" + text + "' is not a number", "a number such as 12.5", "write one");
  return v;
}

}  // namespace pitviper
