#include "scenarios/reader/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <sstream>

#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

constexpr const char* kLargestText = "at most 4 MB";

/// Builds the tree from the parser's events: no recursion of our own, every node with its place.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(std::string_view text, std::string file)
      : text_(text), file_(std::move(file)), most_(std::min(kMostYamlNodes, kMostPlaceBytes / (file_.size() + 1))) {}

  Value take() { return std::move(root_); }
  const Location& where() const { return root_.where; }
  bool hasRoot() const { return done_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnAnchor(const YAML::Mark&, const std::string&) override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Value v = make(Value::Kind::Null, mark);
    add(std::move(v), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw UserError(place(mark), "an alias to a node that is not finished", "an anchor written before", "write the value out");
    count_ += size(found->second);
    checkCount(mark);
    Value copy = found->second;
    copy.where = place(mark);
    add(std::move(copy), 0);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& text) override {
    Value v = make(Value::Kind::Scalar, mark);
    v.text = text;
    v.quoted = tag == "!";
    if (v.quoted) refuseOpenQuote(mark);
    if (!v.quoted && (text == "~" || text == "null")) v.kind = Value::Kind::Null;
    add(std::move(v), anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open(make(Value::Kind::List, mark), anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open(make(Value::Kind::Map, mark), anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    Value value;
    YAML::anchor_t anchor = 0;
    bool haveKey = false;
    std::string key;
    Location keyPlace;
  };

  Location place(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1, -1}; }
  Value make(Value::Kind kind, const YAML::Mark& mark) {
    Value v;
    v.kind = kind;
    v.where = place(mark);
    ++count_;
    checkCount(mark);
    return v;
  }
  void checkCount(const YAML::Mark& mark) const { checkCount(place(mark)); }
  void checkCount(const Location& where) const {
    if (count_ > most_)
      throw UserError(where, "the file holds more than " + std::to_string(most_) + " values, aliases written out", "fewer values",
                      "put large tables into CSV files and use fewer aliases");
  }
  static std::size_t size(const Value& v) {
    std::size_t n = 1;
    for (const auto& i : v.items) n += size(i);
    for (const auto& [k, e] : v.entries) n += size(e);
    return n;
  }
  /// yaml-cpp takes a quote that is never closed for one that closes at the end of the file.
  void refuseOpenQuote(const YAML::Mark& mark) const {
    std::size_t at = mark.pos < 0 ? text_.size() : static_cast<std::size_t>(mark.pos);
    if (at >= text_.size() || (text_[at] != '"' && text_[at] != '\'')) return;  // begins with a tag or an anchor
    const char quote = text_[at];
    for (++at; at < text_.size(); ++at) {
      if (text_[at] == quote && !(quote == '\'' && at + 1 < text_.size() && text_[at + 1] == quote)) return;
      if (text_[at] == quote || (text_[at] == '\\' && quote == '"')) ++at;
    }
    throw UserError(place(mark), "the quote that opens here is never closed", "a quote at the end of the text", "close it");
  }
  void open(Value v, YAML::anchor_t anchor) {
    if (stack_.size() >= kDeepestYaml)
      throw UserError(v.where, "nested deeper than " + std::to_string(kDeepestYaml) + " levels", "a flatter file", "check the brackets");
    stack_.push_back({std::move(v), anchor, false, "", {}});
  }
  void close() {
    Open top = std::move(stack_.back());
    stack_.pop_back();
    add(std::move(top.value), top.anchor);
  }
  void add(Value v, YAML::anchor_t anchor) {
    if (anchor != 0) {
      count_ += size(v);  // anchors within anchors are kept once for each level
      checkCount(v.where);
      anchors_[anchor] = v;
    }
    if (stack_.empty()) {
      root_ = std::move(v);
      done_ = true;
      return;
    }
    Open& top = stack_.back();
    if (top.value.kind == Value::Kind::List) {
      top.value.items.push_back(std::move(v));
    } else if (!top.haveKey) {
      if (v.kind != Value::Kind::Scalar) throw UserError(v.where, std::string("a key is ") + v.kindName(), "a word before the colon", "write 'key: value'");
      top.haveKey = true;
      top.key = v.text;
      top.keyPlace = v.where;
    } else {
      top.haveKey = false;
      top.value.entries.emplace_back(top.key, std::move(v));
      top.value.keyPlaces.push_back(top.keyPlace);
    }
  }

  /// Every node's place holds the file's name: a name of 4000 characters allows fewer nodes.
  static constexpr std::size_t kMostPlaceBytes = 256u << 20;

  std::string_view text_;
  std::string file_;
  std::size_t most_;
  std::vector<Open> stack_;
  std::map<YAML::anchor_t, Value> anchors_;
  std::size_t count_ = 0;
  Value root_;
  bool done_ = false;
};

/// A file of another encoding, or no text at all, would be read as something nobody wrote.
void refuseOtherThanText(std::string_view text, const std::string& file) {
  Location at{file, 1, 1, -1};
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8Length(text.substr(i));
    const auto c = static_cast<unsigned char>(text[i]);
    if (length == 0 || (c < 32 && c != '\n' && c != '\r' && c != '\t') || c == 127) {
      const std::string code = print("0x%02x", c);
      throw UserError(at, length == 0 ? std::string("the byte ") + code + " is not UTF-8" : std::string("the control character ") + code,
                      "a text file in UTF-8", "save the file as UTF-8 text, or remove the byte");
    }
    i += length;
    ++at.column;
    if (c == '\n') ++at.line, at.column = 1;
  }
}

/// yaml-cpp recurses per level: a quick look at the brackets keeps it from being driven deep before its events come.
void refuseDeepFlow(const std::string& text, const std::string& file) {
  int depth = 0;
  Location at{file, 1, 0, -1};
  for (char c : text) {
    ++at.column;
    if (c == '\n') ++at.line, at.column = 0;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (depth > kDeepestYaml * 4)
      throw UserError(at, "brackets nested deeper than " + std::to_string(kDeepestYaml) + " levels", "a flatter file", "check the brackets");
  }
}

}  // namespace

Value parseYaml(const std::string& text, const std::string& fileName) {
  if (text.size() > kLargestYamlBytes)
    throw UserError({fileName, 1, 1, -1}, "the file has " + std::to_string(text.size()) + " bytes", kLargestText, "put large tables into CSV files");
  refuseOtherThanText(text, fileName);
  refuseDeepFlow(text, fileName);
  TreeBuilder builder(text, fileName);
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    if (!parser.HandleNextDocument(builder) || !builder.hasRoot())
      throw UserError({fileName, 1, 1, -1}, "the file holds nothing", "a YAML document", "write a scenario; see scenarios/README.md");
    Value root = builder.take();
    TreeBuilder rest(text, fileName);
    if (parser.HandleNextDocument(rest) && rest.hasRoot())
      throw UserError(rest.where(), "a second document begins here (after '---')", "one document in a file", "remove it, or put it into a file of its own");
    return root;
  } catch (const YAML::Exception& e) {
    throw UserError({fileName, e.mark.line + 1, e.mark.column + 1, -1}, "not well-formed YAML: " + e.msg, "YAML 1.2",
                    "check indentation (by blanks, never tabs), quotes and brackets here and in the line above");
  }
}

Value loadYaml(const std::filesystem::path& file, const Location& askedAt, std::string* textOut, const std::string& shown) {
  std::string text = readWholeFile(
      file, {.what = "a readable YAML file", .mostBytes = kLargestYamlBytes, .fix = "check the name", .fixLarge = "put large tables into CSV files"}, askedAt);
  Value tree = parseYaml(text, shown.empty() ? file.string() : shown);
  if (textOut) *textOut = std::move(text);
  return tree;
}

void applyOverride(Value& tree, const std::string& assignment) {
  const Location here{"--set " + (assignment.size() > 100 ? assignment.substr(0, 100) + "..." : assignment), 0, 0, -1};
  const size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) throw UserError(here, "not an assignment", "path.to.key=value", "write --set cameras.0.samples=2");
  Value value = parseYaml(assignment.substr(equals + 1) + "\n", here.file);
  value.where = here;
  Value* at = &tree;
  std::string path = assignment.substr(0, equals), walked;
  while (!path.empty()) {
    const size_t dot = path.find('.');
    const std::string step = path.substr(0, dot);
    path = dot == std::string::npos ? "" : path.substr(dot + 1);
    Value* next = nullptr;
    if (at->kind == Value::Kind::Map) {
      next = at->find(step);
      if (!next) {  // a key the scenario leaves to its default, or a map of such keys: a wrong one is refused when the scenario is read
        Value fresh;
        fresh.kind = path.empty() ? Value::Kind::Null : Value::Kind::Map;
        fresh.where = here;
        at->entries.emplace_back(step, std::move(fresh));
        at->keyPlaces.push_back(here);
        next = &at->entries.back().second;
      }
    } else if (at->kind == Value::Kind::List) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), index);
      if (error == std::errc() && end == step.data() + step.size()) {
        if (index < at->items.size()) next = &at->items[index];
      } else {
        for (Value& item : at->items) {
          const Value* name = item.kind == Value::Kind::Map ? item.find("name") : nullptr;
          if (name && name->text == step) next = &item;
        }
      }
    }
    if (!next)
      throw UserError(here, "there is no '" + step + "'" + (walked.empty() ? "" : " under '" + walked + "'"),
                      "keys, list numbers from 0, or names, joined by dots", "check the path");
    walked += (walked.empty() ? "" : ".") + step;
    at = next;
  }
  *at = std::move(value);
}

}  // namespace pitviper
