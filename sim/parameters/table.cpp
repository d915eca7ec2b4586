#include "sim/parameters/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <set>

#include "sim/parameters/time_course.hpp"
#include "sim/parameters/unit_conversion.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

Parameter make(const std::string& key, ParameterType type, const std::string& unit, const std::string& description, const Binding& into = {}) {
  Parameter p;
  p.key = key, p.type = type, p.unit = unit, p.description = description, p.into = into;
  return p;
}

std::string shortNumber(double v) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::general, 6).ptr;
  return std::string(buffer, end);
}

constexpr std::size_t kLongestText = 4000;

std::string quotedShort(std::string_view text) {
  std::string s(text.substr(0, 60));
  if (text.size() > 60) s += "...";
  return "'" + s + "'";
}

/// The unit people write: degrees for angles, Celsius is theirs to choose.
std::string writtenUnit(std::string_view unit) { return unit == "rad" ? "deg" : std::string(unit); }

std::string rangeText(Parameter p) {
  const bool low = std::isfinite(p.minimum), high = std::isfinite(p.maximum);
  const std::string unit = p.unit.empty() ? "" : " " + writtenUnit(p.unit);
  if (p.unit == "rad") {
    p.minimum *= 57.29577951308232;
    p.maximum *= 57.29577951308232;
  }
  if (low && high && p.exclusiveMinimum) return "above " + shortNumber(p.minimum) + ", at most " + shortNumber(p.maximum) + unit;
  if (low && high) return shortNumber(p.minimum) + " to " + shortNumber(p.maximum) + unit;
  if (low) return (p.exclusiveMinimum ? "above " : "at least ") + shortNumber(p.minimum) + unit;
  if (high) return "at most " + shortNumber(p.maximum) + unit;
  return "";
}

/// `written` is shown as the user wrote it.
void checkRange(const Parameter& p, double v, const Value& written) {
  const bool low = p.exclusiveMinimum ? v <= p.minimum : v < p.minimum;
  if (low || v > p.maximum)
    throw UserError(written.where,
                    p.key + " is out of range (" +
                        (written.kind == Value::Kind::Scalar ? written.text.substr(0, 60) : shortNumber(v) + (p.unit.empty() ? "" : " " + p.unit)) + ")",
                    rangeText(p), "change the value of '" + p.key + "'");
}

long long readInteger(const Value& value, std::string_view name) {
  long long v = 0;
  const std::string& t = value.text;
  const auto [end, error] = std::from_chars(t.data(), t.data() + t.size(), v);
  if (value.kind != Value::Kind::Scalar || error != std::errc() || end != t.data() + t.size())
    throw UserError(value.where,
                    std::string(name) + " is " + (value.kind == Value::Kind::Scalar ? "not a whole number (" + quotedShort(t) + ")" : value.kindName()),
                    "a whole number such as 16", "write '" + std::string(name) + ": 16'");
  return v;
}

bool readBoolean(const Value& value, std::string_view name) {
  if (value.kind == Value::Kind::Scalar) {
    if (value.text == "true" || value.text == "yes" || value.text == "on") return true;
    if (value.text == "false" || value.text == "no" || value.text == "off") return false;
  }
  throw UserError(
      value.where,
      std::string(name) + " is " + (value.kind == Value::Kind::Scalar ? "neither true nor false (" + quotedShort(value.text) + ")" : value.kindName()),
      "true or false", "write '" + std::string(name) + ": true'");
}

void check(const Parameter& p, const Value& v) {
  switch (p.type) {
    case ParameterType::Number:
      checkRange(p, readNumber(v, p.unit, p.key), v);
      break;
    case ParameterType::Course:
      if (isCourse(v) || v.kind != Value::Kind::Scalar) readCourse(v, p.unit, p.key, p.minimum, p.maximum);
      else checkRange(p, readNumber(v, p.unit, p.key), v);
      break;
    case ParameterType::Integer:
      checkRange(p, static_cast<double>(readInteger(v, p.key)), v);
      break;
    case ParameterType::Boolean:
      readBoolean(v, p.key);
      break;
    case ParameterType::Text:
      readText(v, p.key);
      break;
    case ParameterType::Choice:
      if (v.kind != Value::Kind::Scalar || std::find(p.choices.begin(), p.choices.end(), v.text) == p.choices.end()) {
        const std::string near = nearestWord(v.text, p.choices);
        throw UserError(v.where, p.key + " cannot be " + (v.kind == Value::Kind::Scalar ? quotedShort(v.text) : v.kindName()), "one of " + listed(p.choices),
                        near.empty() ? "choose one of these" : "write '" + near + "'");
      }
      break;
    case ParameterType::Vector: {
      const glm::dvec3 x = readVector(v, p.unit, p.key);
      for (int i = 0; i < 3; ++i) checkRange(p, x[i], v.kind == Value::Kind::List ? v.items[static_cast<size_t>(i)] : v);
      break;
    }
    case ParameterType::List: {
      asList(v, p.key);
      if (v.items.size() < p.minimumItems || v.items.size() > p.maximumItems)
        throw UserError(v.where, p.key + " has " + std::to_string(v.items.size()) + " entries",
                        std::to_string(p.minimumItems) + " to " + std::to_string(p.maximumItems),
                        v.items.size() < p.minimumItems ? "add entries" : "remove entries");
      break;
    }
    case ParameterType::Map:
      asMap(v, p.key);
      break;
    case ParameterType::Spectrum:
    case ParameterType::Any:
      break;
  }
}

const char* typeName(const Parameter& p) {
  switch (p.type) {
    case ParameterType::Number:
      return "number";
    case ParameterType::Course:
      return "number or course";
    case ParameterType::Integer:
      return "integer";
    case ParameterType::Boolean:
      return "true/false";
    case ParameterType::Text:
      return "text";
    case ParameterType::Choice:
      return "choice";
    case ParameterType::Vector:
      return "vector";
    case ParameterType::List:
      return "list";
    case ParameterType::Map:
      return "map";
    case ParameterType::Spectrum:
      return "spectrum";
    case ParameterType::Any:
      return "any of";
  }
  return "";
}

}  // namespace

Parameter number(std::string k, std::string u, std::string d, Binding to) { return make(k, ParameterType::Number, u, d, to); }
Parameter course(std::string k, std::string u, std::string d, Binding to) { return make(k, ParameterType::Course, u, d, to); }
Parameter integer(std::string k, std::string d, long long lo, long long hi, Binding to) {
  return within(make(k, ParameterType::Integer, "", d, to), static_cast<double>(lo), static_cast<double>(hi));
}
Parameter boolean(std::string k, std::string d, Binding to) { return make(k, ParameterType::Boolean, "", d, to); }
Parameter text(std::string k, std::string d, Binding to) { return make(k, ParameterType::Text, "", d, to); }
Parameter choice(std::string k, std::vector<std::string> c, std::string d) {
  Parameter p = make(k, ParameterType::Choice, "", d);
  p.choices = std::move(c);
  return p;
}
Parameter vector3(std::string k, std::string u, std::string d, Binding to) { return make(k, ParameterType::Vector, u, d, to); }
Parameter list(std::string k, std::string d, size_t lo, size_t hi) {
  Parameter p = make(k, ParameterType::List, "", d);
  p.minimumItems = lo, p.maximumItems = hi;
  return p;
}
Parameter map(std::string k, std::string d) { return make(k, ParameterType::Map, "", d); }
Parameter spectrum(std::string k, std::string u, std::string d) { return make(k, ParameterType::Spectrum, u, d); }
Parameter any(std::string k, std::string d) { return make(k, ParameterType::Any, "", d); }

Parameter required(Parameter p) {
  p.required = true;
  return p;
}
Parameter withDefault(Parameter p, std::string t) {
  p.defaultText = std::move(t);
  return p;
}
Parameter within(Parameter p, double lo, double hi) {
  p.minimum = lo;
  p.maximum = hi;
  return p;
}
Parameter above(Parameter p, double lo) {
  p.minimum = lo;
  p.exclusiveMinimum = true;
  return p;
}
Parameter atLeast(Parameter p, double lo) {
  p.minimum = lo;
  return p;
}

const Parameter* ParameterTable::find(std::string_view key) const {
  for (const auto& p : parameters)
    if (p.key == key) return &p;
  return nullptr;
}

Record::Record(const Value& value, const ParameterTable& table) : value_(&value), table_(&table) {
  asMap(value, table.title);
  std::vector<std::string> names;
  for (const auto& p : table.parameters) names.push_back(p.key);
  std::set<std::string_view> seen;
  for (size_t i = 0; i < value.entries.size(); ++i) {
    const auto& [key, node] = value.entries[i];
    const Location& at = i < value.keyPlaces.size() ? value.keyPlaces[i] : node.where;
    const Parameter* p = table.find(key);
    if (!p) {
      throw UserError(at, "unknown key " + quotedShort(key) + " in " + table.title, "one of " + listed(names), didYouMean(key, names, "remove it"));
    }
    if (!seen.insert(key).second) throw UserError(at, "duplicate key " + quotedShort(key) + " in " + table.title, "each key once", "remove one of the two");
    check(*p, node);
  }
  for (const auto& p : table.parameters) {
    if (seen.count(p.key)) continue;
    if (p.required) throw UserError(value.where, "missing key '" + p.key + "' in " + table.title, p.description, "add '" + p.key + ":' here");
    if (!p.defaultText.empty()) {
      Value d;
      d.kind = Value::Kind::Scalar;
      d.where = value.where;
      d.text = p.defaultText;
      check(p, d);
      defaults_[p.key] = std::move(d);
    }
  }
}

const Parameter& Record::parameter(std::string_view key) const {
  const Parameter* p = table_->find(key);
  if (!p) throw std::logic_error("parameter '" + std::string(key) + "' is not in table '" + table_->title + "'");
  return *p;
}

const Value* Record::find(std::string_view key) const {
  parameter(key);
  if (const Value* v = value_->find(key)) return v;
  const auto d = defaults_.find(key);
  return d == defaults_.end() ? nullptr : &d->second;
}
bool Record::has(std::string_view key) const { return find(key) != nullptr; }
bool Record::given(std::string_view key) const { return value_->find(key) != nullptr; }
const Value& Record::value(std::string_view key) const {
  const Value* v = find(key);
  if (!v) throw UserError(value_->where, "missing key '" + std::string(key) + "' in " + table_->title, parameter(key).description, "add it here");
  return *v;
}
Location Record::where(std::string_view key) const {
  const Value* v = value_->find(key);
  return v ? v->where : value_->where;
}
double Record::number(std::string_view key) const { return readNumber(value(key), parameter(key).unit, key); }
void Record::read(std::string_view key, TimeCourse& into) const { into = course(key); }
void Record::fill(const std::type_info& type, void* object) const {
  for (const Parameter& p : table_->parameters)
    if (p.into.object && *p.into.object == type && has(p.key)) p.into.put(*this, p.key, object);
}
TimeCourse Record::course(std::string_view key) const { return readCourse(value(key), parameter(key).unit, key); }
long long Record::integer(std::string_view key) const { return readInteger(value(key), key); }
bool Record::boolean(std::string_view key) const { return readBoolean(value(key), key); }
std::string Record::text(std::string_view key) const { return readText(value(key), key); }
glm::dvec3 Record::vector(std::string_view key) const { return readVector(value(key), parameter(key).unit, key); }

double readNumber(const Value& value, std::string_view unit, std::string_view name) {
  const std::string what(name);
  if (value.kind != Value::Kind::Scalar) throw UserError(value.where, what + " is " + value.kindName(), unitExample(unit), "write one value with its unit");
  const auto written = splitQuantity(value.text);
  if (!written)
    throw UserError(value.where, what + " is not a finite number (" + quotedShort(value.text) + ")", unitExample(unit),
                    "write a number" + std::string(unit.empty() || unit == "1" ? "" : " with its unit"));
  const auto converted = convert(*written, unit);
  if (!converted || !std::isfinite(*converted)) {
    if (written->unit.empty())
      throw UserError(value.where, what + " has no unit (" + quotedShort(value.text) + ")", unitExample(unit),
                      "write " + quotedShort(value.text + " " + writtenUnit(unit)) + " if that is meant");
    const bool light = unit.starts_with("W") && parseUnit(written->unit);
    throw UserError(value.where, what + " has the wrong unit " + quotedShort(written->unit), unitExample(unit),
                    light ? conversionOf(written->unit, unit)
                          : "write it in " + (unit.empty()  ? std::string("plain numbers")
                                              : unit == "K" ? std::string("K or degC")
                                                            : writtenUnit(unit)));
  }
  return *converted;
}

glm::dvec3 readVector(const Value& value, std::string_view unit, std::string_view name) {
  glm::dvec3 v(0.0);
  const std::string shape = unit.empty() || unit == "1"
                                ? "three numbers: [x, y, z]"
                                : "three numbers with their unit: [x " + std::string(unit) + ", y " + std::string(unit) + ", z " + std::string(unit) + "]";
  if (value.kind == Value::Kind::List && value.items.size() == 3) {
    for (int i = 0; i < 3; ++i) v[i] = readNumber(value.items[static_cast<size_t>(i)], unit, name);
    return v;
  }
  if (value.kind == Value::Kind::Scalar) {  // "x, y, z unit"
    std::string_view t = value.text;
    std::vector<std::string_view> parts;
    while (true) {
      const size_t comma = t.find(',');
      parts.push_back(t.substr(0, comma));
      if (comma == std::string_view::npos) break;
      t.remove_prefix(comma + 1);
    }
    if (parts.size() == 3) {
      const auto last = splitQuantity(parts[2]);
      if (last) {
        for (int i = 0; i < 3; ++i) {
          Value part;
          part.kind = Value::Kind::Scalar;
          part.where = value.where;
          part.text = std::string(parts[static_cast<size_t>(i)]);
          const auto q = splitQuantity(part.text);
          if (q && q->unit.empty() && i < 2) part.text += " " + last->unit;
          v[i] = readNumber(part, unit, name);
        }
        return v;
      }
    }
  }
  throw UserError(value.where, std::string(name) + " is not a vector", shape, "write three components");
}

const Value& asMap(const Value& value, std::string_view name) {
  if (value.kind != Value::Kind::Map)
    throw UserError(value.where, std::string(name) + " is " + value.kindName(), "a map of keys ('key: value' lines)",
                    "write its keys as 'key: value' lines, indented below it");
  return value;
}

const Value& asList(const Value& value, std::string_view name) {
  if (value.kind != Value::Kind::List)
    throw UserError(value.where, std::string(name) + " is " + value.kindName(), "a list ('- item' lines, or [a, b])", "write it as a list");
  return value;
}

std::string readText(const Value& value, std::string_view name) {
  if (value.kind != Value::Kind::Scalar || value.text.empty())
    throw UserError(value.where, std::string(name) + " is " + (value.kind == Value::Kind::Scalar ? "empty" : value.kindName()), "a word or a name",
                    "write one name");
  // A file name that stops at a zero byte, or that no file system takes, would be another than the one written.
  if (value.text.size() > kLongestText || std::any_of(value.text.begin(), value.text.end(), [](unsigned char c) { return c < 32 && c != '\n' && c != '\t'; }))
    throw UserError(
        value.where,
        std::string(name) + (value.text.size() > kLongestText ? " is longer than " + std::to_string(kLongestText) + " bytes" : " holds a control character"),
        "plain text", "shorten or correct it");
  return value.text;
}

std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates) {
  size_t best = word.size() / 2 + 1;
  std::string nearest;
  if (word.size() > 60) return nearest;
  // A part of a longer name ("grass" of "green_grass") is nearer than a word of other letters ("glass").
  for (const auto& c : candidates)
    if (word.size() >= 3 && c.size() > word.size() && (c.find("_" + std::string(word)) != std::string::npos || c.rfind(std::string(word) + "_", 0) == 0))
      return c;
  for (const auto& c : candidates) {
    std::vector<size_t> row(c.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= word.size(); ++i) {
      size_t diagonal = row[0];
      row[0] = i;
      for (size_t j = 1; j <= c.size(); ++j) {
        const size_t above = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (word[i - 1] == c[j - 1] ? 0u : 1u)});
        diagonal = above;
      }
    }
    if (row[c.size()] < best) {
      best = row[c.size()];
      nearest = c;
    }
  }
  // The same beginning means the same thing: "transparency" for "transmission".
  constexpr size_t kSameBeginning = 5;
  for (const auto& c : candidates)
    if (nearest.empty() && word.size() > kSameBeginning && c.size() > kSameBeginning && c.compare(0, kSameBeginning, word, 0, kSameBeginning) == 0) nearest = c;
  return nearest;
}

std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates, const std::string& otherwise) {
  const std::string near = nearestWord(word, candidates);
  return near.empty() ? otherwise : "did you mean '" + near + "'?";
}

std::string listed(const std::vector<std::string>& words, const char* between) {
  std::string all;
  for (const auto& w : words) all += (all.empty() ? "" : between) + w;
  return all;
}

UserError unknownWord(const Location& where, const std::string& wrong, const std::string& word, const std::vector<std::string>& names,
                      const std::string& otherwise) {
  return UserError(where, wrong + " '" + word.substr(0, 60) + "'", names.empty() ? "none: there are none" : "one of " + listed(names),
                   didYouMean(word, names, otherwise));
}

std::string describe(const ParameterTable& table) {
  std::string out = "### " + table.title + "\n\n";
  if (!table.description.empty()) out += table.description + "\n\n";
  out += "| key | type | unit | default | range | meaning |\n|---|---|---|---|---|---|\n";
  for (const auto& p : table.parameters) {
    std::string range = p.type == ParameterType::Choice ? listed(p.choices)
                        : p.type == ParameterType::List && p.minimumItems > 0
                            ? std::to_string(p.minimumItems) + " to " + std::to_string(p.maximumItems) + " entries"
                            : rangeText(p);
    out += "| `" + p.key + "` | " + typeName(p) + " | " + writtenUnit(p.unit) + " | " +
           (p.required ? "required" : (p.defaultText.empty() ? "-" : p.defaultText)) + " | " + range + " | " + p.description + " |\n";
  }
  return out;
}

}  // namespace pitviper
