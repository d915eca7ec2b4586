#include "sim/scene/import/json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sim/scene/import/import_failure.hpp"

namespace pitviper {
namespace {

/// A glTF nests about ten deep; the bound keeps the stack.
constexpr int kDeepest = 64;

class JsonParser {
 public:
  JsonParser(const std::string& file, std::string_view text, std::size_t base) : file_(file), text_(text), base_(base) {}

  Json run() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    Json json = value(0);
    space();
    if (at_ != text_.size()) fail("something follows the end of the JSON text", "nothing");
    return json;
  }

 private:
  [[noreturn]] void fail(const std::string& wrong, const std::string& expected) const { failInJson(file_, text_, base_, at_, wrong, expected); }

  void space() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }
  bool accept(char c) {
    space();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail("the JSON text is damaged here", std::string("'") + c + "'");
  }

  Json value(int depth) {
    if (depth > kDeepest) fail("the JSON text is nested too deeply", std::to_string(kDeepest) + " levels at most");
    space();
    Json json;
    json.offset = at_;
    if (accept('{')) {
      json.kind = Json::Kind::Object;
      if (accept('}')) return json;
      do {
        space();
        const std::size_t nameAt = at_;
        std::string name = string();
        expect(':');
        Json member = value(depth + 1);
        if (!json.members.try_emplace(std::move(name), std::move(member)).second)
          failInJson(file_, text_, base_, nameAt, "this member is there twice", "each once");
      } while (accept(','));
      expect('}');
    } else if (accept('[')) {
      json.kind = Json::Kind::Array;
      if (accept(']')) return json;
      do json.items.push_back(value(depth + 1));
      while (accept(','));
      expect(']');
    } else if (at_ < text_.size() && text_[at_] == '"') {
      json.kind = Json::Kind::String;
      json.text = string();
    } else if (!literal("null", Json::Kind::Null, json) && !literal("true", Json::Kind::Bool, json) && !literal("false", Json::Kind::Bool, json)) {
      json.kind = Json::Kind::Number;
      const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), json.number);
      if (error != std::errc{} || !std::isfinite(json.number)) fail("the JSON text is damaged here", "a value");
      at_ = static_cast<std::size_t>(end - text_.data());
    }
    return json;
  }

  bool literal(std::string_view word, Json::Kind kind, Json& json) {
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    json.kind = kind;
    json.number = word == "true" ? 1.0 : 0.0;
    return true;
  }

  std::string string() {
    expect('"');
    std::string out;
    while (at_ < text_.size() && text_[at_] != '"') {
      char c = text_[at_++];
      if (static_cast<unsigned char>(c) < 32) fail("a string holds a control character", "an escape");
      if (c == '\\') {
        if (at_ == text_.size()) break;
        c = text_[at_++];
        constexpr std::string_view kNames = "bfnrt", kMeanings = "\b\f\n\r\t";
        if (c == 'u') {
          unsigned code = 0;
          const std::string_view digits = text_.substr(at_, 4);
          if (digits.size() != 4 || std::from_chars(digits.data(), digits.data() + 4, code, 16).ptr != digits.data() + 4)
            fail("an escape is damaged", "four hexadecimal digits");
          at_ += 4;
          c = code < 128 ? static_cast<char>(code) : '?';  // names and file names that matter here are plain or UTF-8
        } else if (const std::size_t known = kNames.find(c); known != kNames.npos) {
          c = kMeanings[known];
        } else if (c != '"' && c != '\\' && c != '/') {
          fail("an escape is unknown", "one of \" \\ / b f n r t u");
        }
      }
      out += c;
    }
    if (at_ == text_.size()) fail("a string has no end", "'\"'");
    ++at_;
    return out;
  }

  const std::string& file_;
  std::string_view text_;
  std::size_t base_, at_ = 0;
};

void writeText(const std::string& text, std::string& out) {
  out += '"';
  for (char c : text) {
    char code[8];
    std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
    if (c == '"' || c == '\\' || static_cast<unsigned char>(c) < 32) out += code;
    else out += c;
  }
  out += '"';
}

void writeNumber(double number, std::string& out) {
  char digits[32];
  // Indices and sizes as whole numbers: exact below 2^53.
  const bool whole = std::abs(number) < 9007199254740992.0 && number == std::floor(number);
  const auto end =
      whole ? std::to_chars(digits, digits + sizeof digits, static_cast<long long>(number)) : std::to_chars(digits, digits + sizeof digits, number);
  out.append(digits, end.ptr);
}

void write(const Json& json, std::string& out) {
  bool first = true;
  const auto comma = [&] {
    if (!std::exchange(first, false)) out += ',';
  };
  switch (json.kind) {
    case Json::Kind::Null:
      out += "null";
      break;
    case Json::Kind::Bool:
      out += json.number != 0.0 ? "true" : "false";
      break;
    case Json::Kind::Number:
      writeNumber(json.number, out);
      break;
    case Json::Kind::String:
      writeText(json.text, out);
      break;
    case Json::Kind::Array:
      out += '[';
      for (const Json& item : json.items) comma(), write(item, out);
      out += ']';
      break;
    case Json::Kind::Object:
      out += '{';
      for (const auto& [name, member] : json.members) comma(), writeText(name, out), out += ':', write(member, out);
      out += '}';
      break;
  }
}

}  // namespace

std::string writeJson(const Json& json) {
  std::string out;
  write(json, out);
  return out;
}

Json parseJson(const std::string& file, std::string_view text, std::size_t base) { return JsonParser(file, text, base).run(); }

void failInJson(const std::string& file, std::string_view text, std::size_t base, std::size_t offset, const std::string& wrong, const std::string& expected) {
  if (base > 0) failAtByte(file, base + offset, wrong, expected);
  const std::string_view before = text.substr(0, offset);
  const std::size_t lineStart = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
  throw ImportFailure{
      {file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')), 1 + static_cast<int>(offset - lineStart)}, wrong, expected, ""};
}

}  // namespace pitviper
