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
    std::string_view text = library_.text(path);
    int number = 0;
    while (!text.empty()) {
      const size_t end = text.find('\n');
      const std::string_view current = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++number;
      if (current.starts_with("//@use ")) {
        file(std::string(current.substr(7)));
      } else if (current.starts_with("//@slot ")) {
        const std::string slot(current.substr(8));
        if (const auto own = slots_.generated.find(slot); own != slots_.generated.end()) {
          generated(slot, own->second);
          continue;
        }
        const auto chosen = slots_.files.find(slot);
        if (chosen == slots_.files.end()) throw std::logic_error(path + ": no file chosen for shader slot '" + slot + "'");
        file(chosen->second);
      } else if (current == "//@constants") {
        for (const auto& [name, value] : slots_.constants) line("const int " + name + " = " + std::to_string(value) + ";", "plan constant " + name);
      } else {
        line(current, path + ":" + std::to_string(number));
      }
    }
  }

  void generated(const std::string& slot, std::string_view text) {
    while (!text.empty()) {
      const size_t end = text.find('\n');
      const std::string_view current = text.substr(0, end);
      if (current.starts_with("//@use ")) file(std::string(current.substr(7)));
      else line(current, "generated " + slot);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
  }

  AssembledShader take() { return std::move(out_); }

 private:
  const ShaderLibrary& library_;
  const ShaderSlots& slots_;
  AssembledShader out_;
  std::set<std::string> used_;
};

}  // namespace

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
