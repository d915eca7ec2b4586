#include "scenarios/view/yaml_edit.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/view/yaml_places.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

std::string shellWord(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || std::string_view("_./:,+%@-").find(c) != std::string_view::npos;
  });
  if (plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

bool hasControls(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; });
}

/// Whether a text is read as itself without quotes, within brackets or not.
bool isPlain(const std::string& t) {
  if (t.empty() || t == "~" || t == "null" || t == "Null" || t == "NULL" || t == "-" || t.front() == ' ' || t.back() == ' ' || t.back() == ':' ||
      hasControls(t))
    return false;
  if (std::string_view("?:,[]{}#&*!|>'\"%@`").find(t.front()) != std::string_view::npos || t.starts_with("- ") || t.starts_with("---") || t.starts_with("..."))
    return false;
  return t.find_first_of(",[]{}") == std::string::npos && t.find(": ") == std::string::npos && t.find(" #") == std::string::npos;
}

std::string inDoubleQuotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 32 || c == 127) {
      quoted += print("\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

/// `quote`: as it was written so far, which stays.
std::string scalarText(const std::string& text, char quote = ' ') {
  if (quote == '\'' && !hasControls(text)) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
    return quoted + "'";
  }
  return quote != '"' && isPlain(text) ? text : inDoubleQuotes(text);
}

std::string flowText(const Value& v) {
  std::string text;
  switch (v.kind) {
    case Value::Kind::Null:
      return "null";
    case Value::Kind::Scalar:
      return scalarText(v.text);
    case Value::Kind::List:
      for (const Value& item : v.items) text += (text.empty() ? "" : ", ") + flowText(item);
      return "[" + text + "]";
    case Value::Kind::Map:
      for (const auto& [key, item] : v.entries) text += (text.empty() ? "" : ", ") + scalarText(key) + ": " + flowText(item);
      return "{" + text + "}";
  }
  return text;
}

std::vector<std::string> wordsOfPath(const std::string& path) {
  std::vector<std::string> words;
  for (std::size_t from = 0;;) {
    const std::size_t dot = path.find('.', from);
    words.push_back(path.substr(from, dot - from));
    if (dot == std::string::npos) return words;
    from = dot + 1;
  }
}

bool isWorkedOut(const std::string& text) {
  if (text.starts_with('=')) return true;
  for (std::size_t i = text.find('$'); i != std::string::npos; i = text.find('$', i + 2))
    if (i + 1 >= text.size() || text[i + 1] != '$') return true;
  return false;
}

/// A scalar that a scenario's reader takes for other than it is written.
bool holdsExpression(const Value& v) {
  return (v.kind == Value::Kind::Scalar && (v.text.starts_with('=') || v.text.find('$') != std::string::npos)) ||
         std::any_of(v.items.begin(), v.items.end(), holdsExpression) ||
         std::any_of(v.entries.begin(), v.entries.end(), [](const auto& e) { return holdsExpression(e.second); });
}

bool standsForOthers(const Value& entry) { return entry.kind == Value::Kind::Map && (entry.find("include") || entry.find("repeat")); }

/// One change of one text.
class YamlEdit {
 public:
  YamlEdit(const std::string& text, const std::string& fileName, const YamlChange& change)
      : text_(text),
        file_(fileName),
        change_(change),
        tree_(parseYaml(text, fileName)),
        places_(text),
        value_(parseYaml(change.value + "\n", "--set " + change.path)) {}

  std::string result() {
    collectAliases(tree_);
    checkPath();
    walk();
    std::string changed = text_;
    std::sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) { return a.begin > b.begin; });
    for (const Piece& p : pieces_) changed.replace(p.begin, p.end - p.begin, p.text);
    check(changed);
    return changed;
  }

 private:
  struct Piece {
    std::size_t begin, end;
    std::string text;
  };

  [[noreturn]] void refuse(const Location& where, const std::string& why) const {
    throw UserError(where, "'" + change_.path.substr(0, 100) + "' cannot be changed in this file: " + why, "a value that stands in it, for itself",
                    "copy it as " + asSetOptions({change_}));
  }

  void checkPath() {
    words_ = wordsOfPath(change_.path);
    const Location top{file_, 1, 1, -1};
    if (change_.path.find('=') != std::string::npos || std::find(words_.begin(), words_.end(), "") != words_.end())
      refuse(top, "that is no path of keys, joined by dots");
    if (words_[0] == "extends" || words_[0] == "include") refuse(top, "it says what the scenario is put together from");
    if (words_[0] != "parameters" && holdsExpression(value_)) refuse(top, "its value would be worked out here, and is taken as it is by --set");
    for (const char* key : {"extends", "include"})
      if (const Value* other = tree_.find(key)) others_ = &other->where;
    if (const Value* include = tree_.find("include")) included_ = &include->where;
  }
  /// Maps are put together with those of files that are included at the top, and lists at the top joined; --set replaces them.
  void refuseJoined(const Value* old, bool ownEntry) const {
    if (!included_ || ownEntry || words_[0] == "parameters") return;
    const bool lists = value_.kind == Value::Kind::List || (old && old->kind == Value::Kind::List);
    if (value_.kind == Value::Kind::Map || (lists && words_.size() == 1)) refuse(*included_, "it would be joined with what other files have there");
  }

  void collectAliases(const Value& v) {
    if (places_.isEmpty(v)) return;
    if (const std::string_view alias = places_.alias(v.where); !alias.empty()) {
      aliases_.insert(alias);
      return;
    }
    for (const Value& item : v.items) collectAliases(item);
    for (const auto& [key, item] : v.entries) collectAliases(item);
    for (const Location& key : v.keyPlaces)
      if (const std::string_view alias = places_.alias(key); !alias.empty()) aliases_.insert(alias);
  }
  bool isAlias(const Value& v) const { return !places_.isEmpty(v) && !places_.alias(v.where).empty(); }

  void refuseShared(const Value& v) const {
    if (places_.isEmpty(v)) return;
    if (isAlias(v)) refuse(v.where, "here is *" + std::string(places_.alias(v.where)) + ", which stands for what is written elsewhere");
    if (const std::string_view name = places_.anchor(v); aliases_.count(name) > 0)
      refuse(v.where, "&" + std::string(name) + " is used elsewhere, as *" + std::string(name) + ", which would change too");
  }
  /// All that goes with a value.
  void refuseWithin(const Value& v) const {
    if (isAlias(v)) return;
    if (v.kind == Value::Kind::Scalar && isWorkedOut(v.text)) refuse(v.where, "it is worked out from '" + v.text.substr(0, 60) + "'");
    if (standsForOthers(v)) refuse(v.where, "here stand entries of a file, or repeated ones");
    refuseShared(v);
    for (const Value& item : v.items) refuseWithin(item);
    for (const auto& [key, item] : v.entries) refuseWithin(item);
  }

  void walk() {
    const Value* at = &tree_;
    YamlContext context;
    bool ownEntry = false;  // below an entry of a list nothing is put together with other files
    for (std::size_t k = 0; k < words_.size(); ++k) {
      reached_ = &at->where;
      refuseShared(*at);
      const Value* next = nullptr;
      const YamlContext inner = places_.within(*at, context);
      // Where the value goes if the file has nothing but a key or a dash.
      YamlPlaces::Key head;
      if (at->kind == Value::Kind::Map) {
        next = at->find(words_[k]);
        if (!next) return add(*at, context, k, ownEntry);
        head = places_.key(at->keyPlaces[indexOf(*at, *next)], inner.inFlow);
      } else if (at->kind == Value::Kind::List) {
        next = item(*at, words_[k], ownEntry);
        ownEntry = true;
        if (places_.isEmpty(*next)) {
          if (inner.inFlow) refuse(at->where, "nothing is written at its place");
          head = {places_.afterDash(*at, static_cast<std::size_t>(next - at->items.data())), true};
        }
      } else if (at->kind == Value::Kind::Scalar && isWorkedOut(at->text)) {
        refuse(at->where, "here stands '" + at->text.substr(0, 60) + "', which is worked out");
      } else {
        refuse(at->where, std::string("here is ") + at->kindName() + "; what is below it is not in this file");
      }
      const bool keyed = at->kind == Value::Kind::Map;
      at = next;
      context = inner;
      if (k + 1 < words_.size()) {
        if (places_.isEmpty(*at)) refuse(*reached_, "'" + words_[k] + "' holds nothing to go into");
        continue;
      }
      refuseJoined(at, ownEntry);
      if (wordsOf(*at) == wordsOf(value_)) return;
      if (places_.isEmpty(*at)) {
        pieces_.push_back({head.end, head.end, (head.colon ? " " : ": ") + flowText(value_)});
        return;
      }
      refuseShared(*at);
      refuseWithin(*at);
      replace(*at, value_, context, keyed ? head.end : std::string::npos);
    }
  }

  static std::size_t indexOf(const Value& map, const Value& entry) {
    return static_cast<std::size_t>(std::find_if(map.entries.begin(), map.entries.end(), [&](const auto& e) { return &e.second == &entry; }) -
                                    map.entries.begin());
  }

  /// By number or name, as --set counts them when all entries are written out.
  const Value* item(const Value& list, const std::string& word, bool ownEntry) const {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    const Value* found = nullptr;
    const auto others = std::find_if(list.items.begin(), list.items.end(), standsForOthers);
    if (error == std::errc() && end == word.data() + word.size()) {
      if (!ownEntry && included_) refuse(*included_, "the numbers count entries of other files too");
      if (index < list.items.size()) found = &list.items[index];
      if (others != list.items.end() && (!found || others - list.items.begin() <= static_cast<std::ptrdiff_t>(index)))
        refuse(others->where, "the numbers count included and repeated entries too");
    } else {
      for (const Value& i : list.items)
        if (const Value* name = i.kind == Value::Kind::Map ? i.find("name") : nullptr; name && name->text == word) found = &i;
    }
    if (!found && others != list.items.end()) refuse(others->where, "'" + word + "' is not written here; it is among what is included or repeated");
    if (!found) refuse(list.where, "'" + word + "' is not in this list");
    if (standsForOthers(*found)) refuse(found->where, "here stand entries of a file, or repeated ones");
    return found;
  }

  /// `head`: behind the key's colon.
  void replace(const Value& old, const Value& now, const YamlContext& context, std::size_t head) {
    const std::size_t begin = places_.start(old), end = places_.end(old, context);
    const std::string_view span = std::string_view(text_).substr(begin, end - begin);
    const bool brackets = places_.hasBrackets(old);
    if (!isAlias(old) && sameShape(old, now) && (brackets || span.find('#') != std::string_view::npos)) {
      const YamlContext inner = places_.within(old, context);
      for (std::size_t k = 0; k < old.items.size(); ++k) replaceWhereOther(old.items[k], now.items[k], inner, std::string::npos);
      for (std::size_t k = 0; k < old.entries.size(); ++k)
        replaceWhereOther(old.entries[k].second, now.entries[k].second, inner, places_.key(old.keyPlaces[k], inner.inFlow).end);
      return;
    }
    const bool quoted = old.kind == Value::Kind::Scalar && now.kind == Value::Kind::Scalar && !isAlias(old) && old.quoted;
    const std::string text = quoted ? scalarText(now.text, text_[begin]) : flowText(now);
    const bool block = !brackets && (old.kind == Value::Kind::Map || old.kind == Value::Kind::List) && !isAlias(old);
    if (block && head != std::string::npos) {
      // Up to the key's line; comments between stay.
      std::string between = text_.substr(head, begin - head);
      const std::size_t lineEnd = between.rfind('\n');
      if (lineEnd != std::string::npos && places_.anchor(old).empty()) {
        between.erase(lineEnd > 0 && between[lineEnd - 1] == '\r' ? lineEnd - 1 : lineEnd);
        pieces_.push_back({head, end, " " + text + between});
        return;
      }
    }
    pieces_.push_back({begin, end, text});
  }
  void replaceWhereOther(const Value& old, const Value& now, const YamlContext& context, std::size_t head) {
    if (wordsOf(old) != wordsOf(now)) replace(old, now, context, head);
  }

  /// Whether the values of `a` can change one by one into those of `b`.
  bool sameShape(const Value& a, const Value& b) const {
    if (a.kind != b.kind || (a.kind != Value::Kind::List && a.kind != Value::Kind::Map)) return false;
    if (a.items.size() != b.items.size() || a.entries.size() != b.entries.size() || a.items.size() + a.entries.size() == 0) return false;
    for (std::size_t k = 0; k < a.entries.size(); ++k)
      if (a.entries[k].first != b.entries[k].first || places_.isEmpty(a.entries[k].second)) return false;
    return std::none_of(a.items.begin(), a.items.end(), [&](const Value& item) { return places_.isEmpty(item); });
  }

  void add(const Value& map, const YamlContext& context, std::size_t word, bool ownEntry) {
    const bool parameter = words_[0] == "parameters";
    if (parameter && (word > 1 || words_.size() != 2 || !others_)) refuse(map.where, "there is no parameter '" + words_.back() + "'");
    refuseJoined(nullptr, ownEntry);
    if (!ownEntry && others_ && !parameter && word + 1 < words_.size() && (word == 0 || included_))
      refuse(*others_, "'" + words_[word] + "' comes from another file");
    std::string text = flowText(value_);
    for (std::size_t k = words_.size(); k-- > word;) {
      text = scalarText(words_[k]) + ": " + text;
      if (k > word) text = "{" + text + "}";
    }
    const YamlContext inner = places_.within(map, context);
    if (places_.hasBrackets(map)) {
      const std::size_t brace = places_.start(map) + 1;
      const std::size_t at = map.entries.empty() ? brace : lastEnd(map, inner);
      pieces_.push_back({at, at, (map.entries.empty() ? "" : ", ") + text});
      return;
    }
    if (inner.inFlow || map.entries.empty()) refuse(map.where, "a key cannot be added to a map without braces within a list");
    std::size_t at = std::min(text_.size(), text_.find('\n', lastEnd(map, inner)));
    const std::size_t firstLine = text_.find('\n');
    const bool carriageReturns = firstLine != std::string::npos && firstLine > 0 && text_[firstLine - 1] == '\r';
    if (at < text_.size() && at > 0 && text_[at - 1] == '\r') --at;
    pieces_.push_back({at, at, (carriageReturns ? "\r\n" : "\n") + std::string(inner.indent, ' ') + text});
  }
  std::size_t lastEnd(const Value& map, const YamlContext& inner) const {
    const Value& last = map.entries.back().second;
    return places_.isEmpty(last) ? places_.key(map.keyPlaces.back(), inner.inFlow).end : places_.end(last, inner);
  }

  void check(const std::string& changed) const {
    Value expected = tree_;
    applyOverride(expected, change_.path + "=" + change_.value);
    bool same = false;
    try {
      same = wordsOf(parseYaml(changed, file_)) == wordsOf(expected);
    } catch (const UserError&) {
      // Not a scenario any more: refused below.
    }
    if (!same) refuse(*reached_, "it is written in a way that cannot be kept");
  }

  const std::string& text_;
  const std::string& file_;
  const YamlChange& change_;
  const Value tree_;
  const YamlPlaces places_;
  const Value value_;
  std::vector<std::string> words_;
  std::set<std::string_view> aliases_;
  const Location* others_ = nullptr;    ///< where other files are named that the scenario is put together from
  const Location* included_ = nullptr;  ///< the same of `include` alone
  const Location* reached_ = nullptr;   ///< the last map or list on the path
  std::vector<Piece> pieces_;
};

}  // namespace

std::string withChanges(const std::string& text, const std::string& fileName, const std::vector<YamlChange>& changes) {
  std::string changed = text;
  for (const YamlChange& change : changes) {
    std::string next = YamlEdit(changed, fileName, change).result();
    changed = std::move(next);
  }
  return changed;
}

void writeChanges(const std::filesystem::path& file, const std::vector<YamlChange>& changes) {
  const std::string text = readWholeFile(file, {.what = "a readable YAML file", .mostBytes = kLargestYamlBytes, .fix = "check the name"});
  const std::string changed = withChanges(text, file.string(), changes);
  if (changed == text) return;
  std::error_code unknown;
  const std::filesystem::path real = std::filesystem::canonical(file, unknown);
  writeFileAtomically(unknown ? file : real, changed);
}

std::string asSetOptions(const std::vector<YamlChange>& changes) {
  std::string options;
  for (const YamlChange& c : changes) options += (options.empty() ? "--set " : " --set ") + shellWord(c.path) + "=" + shellWord(c.value);
  return options;
}

std::string numberText(double value, const char* unit, double resolution) {
  constexpr int kDigits = std::numeric_limits<double>::max_digits10;
  const double size = std::abs(value), most = 0.5 * std::max(0.0, resolution);
  const bool decimal = size == 0.0 || (size >= 1e-4 && size < 1e15);
  std::string text;
  for (int digits = decimal ? 0 : 1; digits <= kDigits + 4; ++digits) {
    text = decimal ? print("%.*f", digits, value) : print("%.*g", digits, value);
    if (std::abs(std::strtod(text.c_str(), nullptr) - value) <= most) break;
  }
  if (std::strtod(text.c_str(), nullptr) == 0.0) text = "0";
  return unit && *unit ? text + " " + unit : text;
}

}  // namespace pitviper
