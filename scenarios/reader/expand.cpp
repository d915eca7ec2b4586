#include "scenarios/reader/expand.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "scenarios/reader/expression.hpp"
#include "scenarios/reader/layers.hpp"
#include "scenarios/reader/move_files.hpp"
#include "scenarios/reader/repeat.hpp"
#include "scenarios/reader/scope.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

/// As of a parsed file: places hold names of files.
constexpr std::size_t kMostBytes = 256u << 20;
/// Values within values, parameters within parameters: each is a level of our own recursion, of about 2 kB.
constexpr int kDeepestExpansion = 256;
/// A bit each in Variable::loops.
constexpr int kDeepestRepeat = 16;
constexpr std::size_t kLongestExpandedText = 64u << 10;

bool isEntry(const Value& v) { return v.kind == Value::Kind::Map && (v.find("repeat") || v.find("include")); }

/// Whether anything in a tree is other than it will be.
bool needsExpansion(const Value& v) {
  if (v.kind == Value::Kind::Scalar) return v.text.find('$') != std::string::npos || v.text.starts_with('=');
  for (const Value& item : v.items)
    if (isEntry(item) || needsExpansion(item)) return true;
  for (const auto& [key, item] : v.entries)
    if (needsExpansion(item)) return true;
  return false;
}

int heightOf(const Value& v) {
  int h = 0;
  for (const auto& i : v.items) h = std::max(h, heightOf(i));
  for (const auto& [k, e] : v.entries) h = std::max(h, heightOf(e));
  return h + 1;
}

/// An entry of a list, and on which loops its name depends.
struct Entry {
  Value value;
  unsigned long nameLoops = 0;
};

class Expander {
 public:
  Expander(IncludedFiles& files, Layers& layers) : files_(files), layers_(layers) {}

  Value expand(const Value& v, Scope& scope, int depth) {
    const Level level(*this, v.where);
    if (depth > kDeepestYaml) tooDeep(v.where);
    switch (v.kind) {
      case Value::Kind::Scalar:
        return expandText(v, scope, depth);
      case Value::Kind::Map:
        return expandMap(v, scope, depth, {}, nullptr);
      case Value::Kind::List:
        return expandList(v, scope, depth);
      case Value::Kind::Null:
        break;
    }
    charge(v);
    return v;
  }

  /// All keys but some.
  Value expandMap(const Value& v, Scope& scope, int depth, const std::set<std::string_view>& without, unsigned long* nameLoops) {
    Value out;
    out.kind = v.kind;
    out.where = v.where;
    charge(out);
    for (size_t k = 0; k < v.entries.size(); ++k) {
      const auto& [key, item] = v.entries[k];
      if (without.count(key) > 0) continue;
      bytes_ += key.size() + v.keyPlaces[k].file.size();
      const bool name = nameLoops && key == "name";
      const unsigned long before = loops_;
      if (name) loops_ = 0;
      out.entries.emplace_back(key, expand(item, scope, depth + 1));
      out.keyPlaces.push_back(v.keyPlaces[k]);
      if (name) *nameLoops = loops_;
      loops_ |= before;
    }
    return out;
  }

 private:
  /// Counts our own recursion.
  struct Level {
    Level(Expander& e, const Location& where) : expander(e) {
      if (++expander.levels_ <= kDeepestExpansion) return;
      --expander.levels_;
      throw UserError(where, "parameters and files within each other more than " + std::to_string(kDeepestExpansion) + " levels deep", "fewer levels",
                      "write some of them out");
    }
    ~Level() { --expander.levels_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    Expander& expander;
  };

  [[noreturn]] static void tooDeep(const Location& where) {
    throw UserError(where, "nested deeper than " + std::to_string(kDeepestYaml) + " levels once parameters stand in their places", "a flatter scenario",
                    "write lists and maps within each other less deep");
  }
  void charge(std::size_t values, std::size_t bytes, const Location& where) {
    values_ += values;
    bytes_ += bytes;
    if (values_ > kMostYamlNodes || bytes_ > kMostBytes)
      throw UserError(where,
                      "the scenario holds more than " + std::to_string(kMostYamlNodes) + " values or 256 MB, parameters and repeated entries written out",
                      "fewer", "repeat less often, and put large tables into CSV files");
  }
  void charge(const Value& v) { charge(1, v.text.size() + v.where.file.size(), v.where); }
  void chargeAll(const Value& v) {
    charge(v);
    for (const auto& i : v.items) chargeAll(i);
    for (const auto& [k, e] : v.entries) bytes_ += k.size() + v.where.file.size(), chargeAll(e);
  }

  Value expandList(const Value& v, Scope& scope, int depth) {
    Value out;
    out.kind = v.kind;
    out.where = v.where;
    charge(out);
    for (const Value& item : v.items) {
      if (!isEntry(item)) {
        out.items.push_back(expand(item, scope, depth + 1));
        continue;
      }
      std::vector<Entry> entries;
      expandEntry(item, scope, depth + 1, {}, entries);
      for (Entry& e : entries) out.items.push_back(std::move(e.value));
    }
    return out;
  }

  void expandEntry(const Value& item, Scope& scope, int depth, std::set<std::string_view> without, std::vector<Entry>& out) {
    const Level level(*this, item.where);
    if (depth > kDeepestYaml) tooDeep(item.where);
    if (item.kind == Value::Kind::Map && without.count("repeat") == 0)
      if (const Value* repeat = item.find("repeat")) {
        without.insert("repeat");
        return repeatEntry(item, *repeat, scope, depth, without, out);
      }
    if (item.kind == Value::Kind::Map && item.find("include")) return includeEntry(item, scope, depth, out);
    Entry entry;
    entry.value = item.kind == Value::Kind::Map ? expandMap(item, scope, depth, without, &entry.nameLoops) : expand(item, scope, depth);
    out.push_back(std::move(entry));
  }

  void repeatEntry(const Value& item, const Value& asked, Scope& scope, int depth, const std::set<std::string_view>& without, std::vector<Entry>& out) {
    if (repeats_ >= kDeepestRepeat)
      throw UserError(asked.where, "entries repeated within each other more than " + std::to_string(kDeepestRepeat) + " deep", "fewer",
                      "write some of them out");
    const Value repeat = expand(asked, scope, depth);
    const Record r(repeat, tables::repeat());
    const std::string name = r.text("as");
    checkName(name, r.where("as"));
    if (scope.find(name).first)
      throw UserError(r.where("as"), "'" + name + "' is the name of a parameter or of a repeated entry around this one", "another name",
                      "write 'as: " + name + "2'");
    const unsigned long bit = 1ul << repeats_;
    ++repeats_;
    for (long long i = 0, count = r.integer("count"); i < count; ++i) {
      charge(1, 0, asked.where);
      Scope inner;
      inner.outer = &scope;
      inner.chain = scope.chain;
      Variable& number = inner.variables[name];
      number.value.emplace();
      number.value->kind = Value::Kind::Scalar;
      number.value->where = asked.where;
      number.value->text = std::to_string(i);
      number.keyPlace = r.where("as");
      number.loops = bit;
      const size_t first = out.size();
      expandEntry(item, inner, depth, without, out);
      for (size_t k = first; k < out.size(); ++k) {
        Value* named = out[k].value.kind == Value::Kind::Map ? out[k].value.find("name") : nullptr;
        if (named && named->kind == Value::Kind::Scalar && (out[k].nameLoops & bit) == 0) named->text += "_" + std::to_string(i);
        if (const Value* every = r.find("every")) {
          checkMap(*every);
          addSteps(out[k].value, *every, i);
        }
      }
    }
    --repeats_;
    loops_ &= ~bit;
  }
  static void checkMap(const Value& every) { asMap(every, "every"); }

  void includeEntry(const Value& item, Scope& scope, int depth, std::vector<Entry>& out) {
    static const std::vector<std::string> keys = {"include", "with", "repeat"};
    std::set<std::string_view> seen;
    for (size_t k = 0; k < item.entries.size(); ++k) {
      const std::string& key = item.entries[k].first;
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        throw UserError(item.keyPlaces[k], "an entry that is included has the key '" + key.substr(0, 60) + "' besides", "one of " + listed(keys),
                        "write it into that file, as a parameter: 'with: {" + key.substr(0, 60) + ": ...}' here, '$" + key.substr(0, 60) + "' there");
      if (!seen.insert(key).second) throw UserError(item.keyPlaces[k], "duplicate key '" + key + "'", "each key once", "remove one of the two");
    }
    const Value name = expand(*item.find("include"), scope, depth);
    const IncludedFile& file = files_.open(name, false, *scope.chain);
    const Value& tree = layers_.of(file, false, *scope.chain);
    const FileChain chain = chainOf(file, *scope.chain);
    Scope own;
    own.chain = &chain;
    if (const Value* with = item.find("with")) {
      std::optional<Value> whole;
      if (with->kind == Value::Kind::Scalar) whole = expand(*with, scope, depth), with = &*whole;
      asMap(*with, "with");
      for (size_t k = 0; k < with->entries.size(); ++k) {
        const auto& [key, value] = with->entries[k];
        checkName(key, with->keyPlaces[k]);
        if (own.variables.count(key) > 0) throw UserError(with->keyPlaces[k], "duplicate key '" + key + "' in with", "each key once", "remove one of the two");
        Variable& given = own.variables[key];
        given.keyPlace = with->keyPlaces[k];
        if (whole) {
          given.value = value;
          chargeAll(value);
          continue;
        }
        const unsigned long before = loops_;
        loops_ = 0;
        given.value = expand(value, scope, depth);
        given.loops = loops_;
        loops_ = before;
      }
    }
    if (tree.kind == Value::Kind::Map) {
      declare(tree, own);
      expandEntry(tree, own, depth, {"parameters"}, out);
    } else if (tree.kind == Value::Kind::List) {
      for (const Value& entry : tree.items) expandEntry(entry, own, depth, {}, out);
    } else {
      throw UserError(name.where, "'" + file.shown + "' holds " + tree.kindName(), "a list of entries, or the map of one", "correct the file");
    }
    for (const auto& [key, variable] : own.variables)
      if (!variable.raw && !variable.used)
        throw UserError(variable.keyPlace, "'" + file.shown + "' has no parameter '" + key + "' and does not use $" + key,
                        own.variables.size() > 1 ? "one of " + listed(othersOf(own, key)) : "none: it uses none", "remove it");
  }
  static std::vector<std::string> othersOf(const Scope& scope, const std::string& name) {
    std::vector<std::string> names = scope.namesLike(name);
    names.erase(std::remove(names.begin(), names.end(), name), names.end());
    return names;
  }

 public:
  /// A file's parameters; what was given from outside holds.
  void declare(const Value& tree, Scope& scope) {
    const Value* parameters = tree.find("parameters");
    if (!parameters) return;
    asMap(*parameters, "parameters");
    charge(parameters->entries.size(), 0, parameters->where);
    std::set<std::string_view> seen;
    for (size_t k = 0; k < parameters->entries.size(); ++k) {
      const auto& [name, value] = parameters->entries[k];
      checkName(name, parameters->keyPlaces[k]);
      if (!seen.insert(name).second)
        throw UserError(parameters->keyPlaces[k], "duplicate key '" + name + "' in parameters", "each key once", "remove one of the two");
      Variable& v = scope.variables[name];
      v.raw = &value;
      if (!v.value) v.keyPlace = parameters->keyPlaces[k];
    }
  }

 private:
  const Variable& variable(std::string_view name, const Location& where, Scope& scope) {
    const auto [found, home] = scope.find(name);
    if (!found) {
      std::vector<std::string> names;
      for (const std::string& other : scope.namesLike(name)) names.push_back("$" + other);
      throw UserError(
          where, "there is no parameter '" + std::string(name.substr(0, 60)) + "'", names.empty() ? "none: there are none" : "one of " + listed(names),
          scope.chain->above
              ? "declare it under 'parameters:' of this file, or give it 'with: {" + std::string(name.substr(0, 60)) + ": ...}' where the file is included"
              : "write it under 'parameters:', or '$$' for a dollar");
    }
    found->used = true;
    if (!found->value) {
      if (found->busy) {
        std::string way = "$" + std::string(name);
        for (size_t k = waiting_.size(); k-- > 0;) {
          way = "$" + waiting_[k] + " -> " + way;
          if (waiting_[k] == name) break;
        }
        throw UserError(where, "parameters that hold themselves: " + way, "values that end somewhere", "write one of them out");
      }
      found->busy = true;
      waiting_.emplace_back(name);
      const unsigned long before = loops_;
      loops_ = 0;
      found->value = expand(*found->raw, *home, 1);
      found->loops = loops_;
      loops_ = before;
      waiting_.pop_back();
      found->busy = false;
    }
    loops_ |= found->loops;
    return *found;
  }

  /// A name at the front of a text behind a dollar: "speed" or "{speed}", with its length; empty where there is none.
  static std::pair<std::string_view, size_t> nameAt(std::string_view t) {
    const bool braces = !t.empty() && t[0] == '{';
    const size_t length = nameLength(t.substr(braces ? 1 : 0));
    if (length == 0 || (braces && (t.size() <= length + 1 || t[length + 1] != '}'))) return {};
    return {t.substr(braces ? 1 : 0, length), length + (braces ? 2 : 0)};
  }

  Value expandText(const Value& v, Scope& scope, int depth) {
    charge(v);
    const std::string_view t = v.text;
    if (t.starts_with('=')) {
      if (t.size() > kLongestExpandedText) throw UserError(v.where, "an expression of more than 64 kB", "a shorter one", "use parameters for its parts");
      Value out = v;
      out.text = evaluate(t.substr(1), v.where, [&](std::string_view name) { return numberOf(name, v.where, scope); });
      return out;
    }
    if (t.find('$') == std::string_view::npos) return v;
    if (t[0] == '$')
      if (const auto [name, length] = nameAt(t.substr(1)); length > 0 && length + 1 == t.size()) {
        const Value& value = *variable(name, v.where, scope).value;
        if (depth + heightOf(value) - 1 > kDeepestYaml) tooDeep(v.where);
        chargeAll(value);
        return value;
      }
    Value out = v;
    out.text.clear();
    for (size_t at = 0; at < t.size();) {
      const size_t dollar = t.find('$', at);
      out.text += t.substr(at, dollar - at);
      if (dollar == std::string_view::npos) break;
      const std::string_view rest = t.substr(dollar + 1);
      if (rest.starts_with('$')) {
        out.text += '$';
        at = dollar + 2;
        continue;
      }
      const auto [name, length] = nameAt(rest);
      if (length == 0)
        throw UserError(v.where, "a dollar without a name (" + tokenOf(t.substr(dollar + 1)) + " behind it)", "'$name', '${name}' or '$$' for a dollar",
                        "write '$$' if a dollar is meant");
      const Value& value = *variable(name, v.where, scope).value;
      if (value.kind != Value::Kind::Scalar)
        throw UserError(v.where, "parameter '" + std::string(name) + "' is " + value.kindName() + " (" + value.where.text() + ") and stands within a text",
                        "a single value", "let '$" + std::string(name) + "' stand alone");
      out.text += value.text;
      charge(0, value.text.size(), v.where);
      if (out.text.size() > kLongestExpandedText + t.size())
        throw UserError(v.where, "a text that becomes longer than 64 kB", "a shorter one", "shorten its parameters");
      at = dollar + 1 + length;
    }
    return out;
  }

  WrittenQuantity numberOf(std::string_view name, const Location& where, Scope& scope) {
    const Value& value = *variable(name, where, scope).value;
    const auto number = value.kind == Value::Kind::Scalar ? splitQuantity(value.text) : std::nullopt;
    if (!number || !parseUnit(number->unit))
      throw UserError(where,
                      "parameter '" + std::string(name) + "' is " +
                          (value.kind == Value::Kind::Scalar ? "'" + value.text.substr(0, 60) + "'" : value.kindName()) + " (" + value.where.text() +
                          ") and stands in an expression",
                      "a number with its unit", "write it as a number, or use it alone");
    return *number;
  }

  IncludedFiles& files_;
  Layers& layers_;
  std::size_t values_ = 0, bytes_ = 0;
  int levels_ = 0, repeats_ = 0;
  unsigned long loops_ = 0;  ///< on which the value depends that is being expanded
  std::vector<std::string> waiting_;
};

bool isParameter(const std::string& assignment) { return assignment.starts_with("parameters.") || assignment.starts_with("parameters="); }

/// "parameters.speed=300 m/s": of a parameter that there is.
void setParameter(Value& tree, const std::string& assignment) {
  const Location here{"--set " + assignment.substr(0, 100), 0, 0, -1};
  const size_t dot = assignment.find('.'), equals = assignment.find('=');
  if (equals == std::string::npos || dot == std::string::npos || dot > equals)
    throw UserError(here, "not one parameter", "parameters.name=value", "write --set 'parameters.speed=300 m/s'");
  const std::string rest = assignment.substr(dot + 1, equals - dot - 1), name = rest.substr(0, rest.find('.'));
  const Value* parameters = tree.find("parameters");
  if (!parameters || !parameters->find(name)) {
    std::vector<std::string> names;
    if (parameters)
      for (const auto& [key, value] : parameters->entries) names.push_back(key);
    throw unknownWord(here, "there is no parameter", name, names, "write it under 'parameters:' of the scenario");
  }
  applyOverride(tree, assignment);
}

/// What a scenario is put together from cannot come from outside; its parts' keys are gone by then.
void refuseFromOutside(const Value& tree) {
  for (const char* key : {"extends", "include"})
    if (const Value* e = tree.find(key))
      throw UserError(e->where, std::string("what a scenario ") + (*key == 'e' ? "extends" : "includes") + " cannot be set from outside", "other keys",
                      std::string("write '") + key + "' into the file");
}

}  // namespace

ExpandedScenario expandScenario(const std::string& text, const std::string& fileName, const std::filesystem::path& base,
                                const std::vector<std::string>& overrides, const Libraries& libraries, const std::vector<std::filesystem::path>& roots) {
  ExpandedScenario result;
  IncludedFiles files(fileName, base, libraries, roots);
  Layers layers(files);
  Value tree = layers.merged(parseYaml(text, fileName), true, files.scenario());
  for (const auto& o : overrides)
    if (isParameter(o)) setParameter(tree, o);
  if (tree.kind == Value::Kind::Map && (tree.find("parameters") || needsExpansion(tree))) {
    Expander expander(files, layers);
    Scope scope;
    scope.chain = &files.scenario();
    expander.declare(tree, scope);
    Value expanded = expander.expandMap(tree, scope, 1, {"parameters"}, nullptr);
    for (const auto& [name, v] : scope.variables)
      if (!v.used && (v.keyPlace.file == fileName || v.raw->where.file.starts_with("--set")))
        throw UserError(v.keyPlace, "nothing uses the parameter '" + name + "'", "'$" + name + "' somewhere", "remove it, or use it");
    tree = std::move(expanded);
  }
  moveFiles(
      tree, [&](const std::string& file) { return files.folderOf(file); }, base);
  result.identity = text + files.identity();
  for (const auto& o : overrides) {
    if (!isParameter(o)) applyOverride(tree, o);
    result.identity += "\n--set " + o;
  }
  refuseFromOutside(tree);
  result.tree = std::move(tree);
  return result;
}

}  // namespace pitviper
