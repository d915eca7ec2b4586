#include "scenarios/view/yaml_places.hpp"

#include <algorithm>

namespace pitviper {
namespace {

constexpr std::string_view kFlowMarks = ",[]{}";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool isBlankOrEnd(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool isFlowMark(char c) { return kFlowMarks.find(c) != std::string_view::npos; }

}  // namespace

YamlPlaces::YamlPlaces(std::string_view text) : text_(text), lines_{text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0} {
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', end + 1)) lines_.push_back(end + 1);
}

std::size_t YamlPlaces::at(const Location& place) const {
  const auto line = static_cast<std::size_t>(std::max(1, place.line)) - 1;
  return line < lines_.size() ? std::min(text_.size(), lines_[line] + static_cast<std::size_t>(std::max(1, place.column)) - 1) : text_.size();
}

std::size_t YamlPlaces::column(std::size_t offset) const {
  const std::size_t before = offset == 0 ? std::string_view::npos : text_.rfind('\n', offset - 1);
  return before == std::string_view::npos ? offset : offset - before - 1;
}

std::size_t YamlPlaces::afterBlanks(std::size_t from) const {
  while (from < text_.size()) {
    if (isBlankOrEnd(text_[from])) {
      ++from;
    } else if (text_[from] == '#') {
      from = std::min(text_.size(), text_.find('\n', from));
    } else {
      break;
    }
  }
  return from;
}

std::size_t YamlPlaces::afterProperties(std::size_t from) const {
  while (charAt(from) == '&' || charAt(from) == '!') from = afterBlanks(wordEnd(from));
  return from;
}

std::size_t YamlPlaces::wordEnd(std::size_t from) const {
  while (from < text_.size() && !isBlankOrEnd(text_[from]) && !isFlowMark(text_[from])) ++from;
  return from;
}

std::size_t YamlPlaces::quotedEnd(std::size_t from) const {
  const char quote = text_[from];
  for (std::size_t i = from + 1; i < text_.size(); ++i) {
    if (quote == '"' && text_[i] == '\\') {
      ++i;
    } else if (text_[i] == quote) {
      if (quote == '"' || charAt(i + 1) != '\'') return i + 1;
      ++i;
    }
  }
  return text_.size();
}

/// Over further lines as long as these are its own: indented deeper than what it stands in, and no comment between.
std::size_t YamlPlaces::plainEnd(std::size_t from, const YamlContext& context) const {
  std::size_t end = from;
  for (std::size_t i = from;;) {
    for (; i < text_.size() && text_[i] != '\n'; ++i) {
      const char c = text_[i], next = charAt(i + 1);
      if (context.inFlow && isFlowMark(c)) return end;
      if (c == ':' && (isBlankOrEnd(next) || (context.inFlow && isFlowMark(next)))) return end;
      if (c == '#' && i > 0 && isBlankOrEnd(text_[i - 1])) return end;
      if (!isBlankOrEnd(c)) end = i + 1;
    }
    while (i < text_.size() && isBlankOrEnd(text_[i])) ++i;
    if (i >= text_.size() || text_[i] == '#' || (!context.inFlow && column(i) <= context.indent)) return end;
  }
}

/// Of a text behind '|' or '>'. Its first line says how deep the others are at least, unless a digit does.
std::size_t YamlPlaces::literalEnd(std::size_t from, std::size_t indent) const {
  std::size_t end = wordEnd(from);
  bool known = text_.substr(from, end - from).find_first_of("123456789") != std::string_view::npos;
  std::size_t least = indent + 1;
  for (std::size_t line = text_.find('\n', from); line != std::string_view::npos; line = text_.find('\n', line + 1)) {
    std::size_t i = line + 1;
    while (i < text_.size() && text_[i] == ' ') ++i;
    if (i >= text_.size()) break;
    if (text_[i] == '\n' || text_[i] == '\r') continue;
    const std::size_t deep = i - line - 1;
    if (deep < least) break;
    if (!known) least = deep, known = true;
    end = std::min(text_.size(), text_.find('\n', i));
    if (text_[end - 1] == '\r') --end;
  }
  return end;
}

std::size_t YamlPlaces::flowEnd(std::size_t from) const {
  int depth = 0;
  for (std::size_t i = from; i < text_.size();) {
    const char c = text_[i];
    if (isBlankOrEnd(c) || c == '#') {
      i = afterBlanks(i);
    } else if (c == '[' || c == '{') {
      ++depth, ++i;
    } else if (c == ']' || c == '}') {
      ++i;
      if (--depth == 0) return i;
    } else if (c == ',' || c == ':' || c == '?') {
      ++i;
    } else if (c == '"' || c == '\'') {
      i = quotedEnd(i);
    } else if (c == '&' || c == '*' || c == '!') {
      i = wordEnd(i);
    } else {
      i = std::max(i + 1, plainEnd(i, {true, 0}));
    }
  }
  return text_.size();
}

bool YamlPlaces::hasBrackets(const Value& value) const {
  const char c = charAt(start(value));
  return (value.kind == Value::Kind::List && c == '[') || (value.kind == Value::Kind::Map && c == '{');
}

YamlContext YamlPlaces::within(const Value& map, const YamlContext& context) const {
  return {context.inFlow || hasBrackets(map), column(map.kind == Value::Kind::Map && !map.keyPlaces.empty() ? at(map.keyPlaces[0]) : start(map))};
}

std::size_t YamlPlaces::end(const Value& value, const YamlContext& context) const {
  const std::size_t from = start(value);
  const char c = charAt(from);
  if (c == '*') return wordEnd(from);
  if (hasBrackets(value)) return flowEnd(from);
  const YamlContext inner = within(value, context);
  if (value.kind == Value::Kind::Map && !value.entries.empty()) {
    const Value& last = value.entries.back().second;
    return isEmpty(last) ? key(value.keyPlaces.back(), inner.inFlow).end : end(last, inner);
  }
  if (value.kind == Value::Kind::List && !value.items.empty())
    return isEmpty(value.items.back()) ? afterDash(value, value.items.size() - 1) : end(value.items.back(), inner);
  if (c == '"' || c == '\'') return quotedEnd(from);
  if ((c == '|' || c == '>') && !context.inFlow) return literalEnd(from, context.indent);
  return plainEnd(from, context);
}

YamlPlaces::Key YamlPlaces::key(const Location& place, bool inFlow) const {
  const std::size_t from = afterProperties(at(place));
  const char c = charAt(from);
  std::size_t end = 0;
  if (c == '"' || c == '\'') {
    end = quotedEnd(from);
  } else if (c == '*') {
    end = wordEnd(from);
  } else {
    end = plainEnd(from, {inFlow, inFlow ? 0 : text_.size()});
  }
  const std::size_t colon = afterBlanks(end);
  return charAt(colon) == ':' ? Key{colon + 1, true} : Key{end, false};
}

std::size_t YamlPlaces::afterDash(const Value& list, std::size_t item) const {
  std::size_t dash = start(list);
  for (std::size_t k = 0; k < item; ++k) dash = afterBlanks(isEmpty(list.items[k]) ? dash + 1 : end(list.items[k], {false, column(dash)}));
  return dash + 1;
}

bool YamlPlaces::isEmpty(const Value& value) const {
  if (value.kind != Value::Kind::Null) return false;
  const std::size_t from = start(value);
  if (charAt(from) == '*') return false;
  const std::string_view word = text_.substr(from, wordEnd(from) - from);
  return word != "~" && word != "null" && word != "Null" && word != "NULL";
}

std::string_view YamlPlaces::anchor(const Value& value) const {
  for (std::size_t from = at(value.where); charAt(from) == '&' || charAt(from) == '!'; from = afterBlanks(wordEnd(from)))
    if (text_[from] == '&') return text_.substr(from + 1, wordEnd(from) - from - 1);
  return {};
}

std::string_view YamlPlaces::alias(const Location& place) const {
  const std::size_t from = at(place);
  return charAt(from) == '*' ? text_.substr(from + 1, wordEnd(from) - from - 1) : std::string_view{};
}

}  // namespace pitviper
