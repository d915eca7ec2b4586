#include "sim/gl/shader_assembler.hpp"

#include <regex>
#include <set>
#include <stdexcept>

namespace pitviper {

void ShaderLibrary::add(std::span<const ShaderText> texts) {
  for (const auto& t : texts) texts_.emplace(t.path, t.text);
}

std::string_view ShaderLibrary::text(const std::string& path) const {
  const auto found = texts_.find(path);
  if (found == texts_.end()) throw std::logic_error("no shader file '" + path + "' is compiled in");
  return found->second;
}

namespace {

class Assembler {
 public:
  Assembler(const ShaderLibrary& library, const ShaderSlots& slots) : library_(library), slots_(slots) {}

  void line(std::string_view text, const std::string& from) {
    out_.source.append(text);
    out_.source += '\n';
    out_.origin.push_back(from);
  }

  void file(const std::string& path) {
    if (!used_.insert(path).second) return;
    write(linesOf(library_.text(path), [&](size_t number) { return path + ":" + std::to_string(number); }));
  }

  AssembledShader take() { return std::move(out_); }

 private:
  struct Line {
    std::string text, from;
  };

  /// `placeOf`(number, from 1 on).
  template <class PlaceOf>
  static std::vector<Line> linesOf(std::string_view text, const PlaceOf& placeOf) {
    std::vector<Line> lines;
    while (!text.empty()) {
      const size_t end = text.find('\n');
      lines.push_back({std::string(text.substr(0, end)), placeOf(lines.size() + 1)});
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return lines;
  }

  void write(std::span<const Line> lines) {
    for (size_t n = 0; n < lines.size(); ++n) {
      const auto& [text, from] = lines[n];
      if (text.starts_with("//@use ")) {
        file(text.substr(7));
      } else if (text.starts_with("//@slot ")) {
        slot(text.substr(8), from);
      } else if (text.starts_with("//@each ")) {
        const size_t end = endOf(lines, n);
        each(text.substr(8), from, lines.subspan(n + 1, end - n - 1));
        n = end;
      } else if (text == "//@constants") {
        for (const auto& [name, value] : slots_.constants) line("const int " + name + " = " + std::to_string(value) + ";", "plan constant " + name);
      } else {
        line(text, from);
      }
    }
  }

  void slot(const std::string& name, const std::string& from) {
    if (const auto own = slots_.generated.find(name); own != slots_.generated.end())
      return write(linesOf(own->second, [&](size_t) { return "generated " + name; }));
    const auto chosen = slots_.files.find(name);
    if (chosen == slots_.files.end()) throw std::logic_error(from + ": no file chosen for shader slot '" + name + "'");
    file(chosen->second);
  }

  static size_t endOf(std::span<const Line> lines, size_t begin) {
    int open = 0;
    for (size_t n = begin; n < lines.size(); ++n) {
      if (lines[n].text.starts_with("//@each ")) ++open;
      if (lines[n].text == "//@end" && --open == 0) return n;
    }
    throw std::logic_error(lines[begin].from + ": no //@end to this //@each");
  }

  /// `what`: "k COUNT".
  void each(const std::string& what, const std::string& from, std::span<const Line> lines) {
    const std::string word = "{" + what.substr(0, what.find(' ')) + "}", count = what.substr(what.find(' ') + 1);
    const auto constant = slots_.constants.find(count);
    if (constant == slots_.constants.end() && count.find_first_not_of("0123456789") != std::string::npos)
      throw std::logic_error(from + ": no constant " + count);
    const long long times = constant != slots_.constants.end() ? constant->second : std::stoll(count);
    for (long long k = 0; k < times; ++k) {
      std::vector<Line> own(lines.begin(), lines.end());
      for (Line& l : own)
        for (size_t at = l.text.find(word); at != std::string::npos; at = l.text.find(word, at)) l.text.replace(at, word.size(), std::to_string(k));
      write(own);
    }
  }

  const ShaderLibrary& library_;
  const ShaderSlots& slots_;
  AssembledShader out_;
  std::set<std::string> used_;
};

}  // namespace

std::string planNumbers(const std::string& name, int unit) {
  return "layout(binding = " + std::to_string(unit) + ") uniform samplerBuffer " + name + "Numbers;\nvec4 " + name + "(int i) { return texelFetch(" + name +
         "Numbers, i); }\n";
}

AssembledShader assembleShader(const ShaderLibrary& library, const std::string& mainPath, const ShaderSlots& slots) {
  Assembler a(library, slots);
  a.line("#version 450 core", "dialect");
  for (const auto& name : slots.extensions) a.line("#extension " + name + " : require", "plan extension");
  a.line("#define PHYSICS", "dialect");
  a.line("#define Real float", "dialect");
  a.line("#define Vec2 vec2", "dialect");
  a.line("#define Vec3 vec3", "dialect");
  a.line("#define Vec4 vec4", "dialect");
  // Largest x for which exp(-x) is a normal single precision number: ln(2^126) = 87.33.
  a.line("const float kExpLimit = 87.33;", "dialect");
  a.line("const float kFar = 1.0e30;  // an infinite distance [m]", "dialect");
  a.file(mainPath);
  return a.take();
}

std::string AssembledShader::mapLog(const std::string& log) const {
  static const std::regex place(R"((^|\n)\s*\d+(:|\()(\d+)(\(\d+\)|\)))");
  std::string out;
  auto at = log.cbegin();
  for (std::smatch m; std::regex_search(at, log.cend(), m, place); at = m.suffix().first) {
    out.append(at, m[0].first);
    const size_t number = std::stoul(m[3]);
    out += m[1].str() + (number >= 1 && number <= origin.size() ? origin[number - 1] : "line " + m[3].str());
  }
  out.append(at, log.cend());
  return out;
}

}  // namespace pitviper
