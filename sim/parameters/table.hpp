#pragma once
// Each model declares the parameters it takes in one table; the reader fills and checks them from it, and the key
// reference in scenarios/README.md is printed from the same table.
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "sim/parameters/value.hpp"

namespace pitviper {

class TimeCourse;
class Record;

/// The member of a struct that a key's value goes into.
struct Binding {
  Binding() = default;
  template <class Object, class Field>
  Binding(Field Object::*member);
  const std::type_info* object = nullptr;
  std::function<void(const Record& record, std::string_view key, void* object)> put;
};

enum class ParameterType { Number, Course, Integer, Boolean, Text, Choice, Vector, List, Map, Spectrum, Any };

struct Parameter {
  std::string key;
  ParameterType type = ParameterType::Number;
  std::string unit;  ///< canonical unit of numbers, vectors and spectra; "" is dimensionless
  std::string description;
  bool required = false;
  std::string defaultText;  ///< as a user would write it; empty: absent unless given
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool exclusiveMinimum = false;
  std::vector<std::string> choices;
  size_t minimumItems = 0;
  size_t maximumItems = 4096;
  Binding into = {};
};

/// Short ways to write a table. `into`: where Record::fill() puts the value.
Parameter number(std::string key, std::string unit, std::string description, Binding into = {});
/// A number, or a number over time (sim/parameters/time_course.hpp).
Parameter course(std::string key, std::string unit, std::string description, Binding into = {});
Parameter integer(std::string key, std::string description, long long minimum, long long maximum, Binding into = {});
Parameter boolean(std::string key, std::string description, Binding into = {});
Parameter text(std::string key, std::string description, Binding into = {});
Parameter choice(std::string key, std::vector<std::string> choices, std::string description);
/// Words and what they stand for.
template <class Object, class Field>
Parameter choice(std::string key, std::type_identity_t<std::vector<std::pair<const char*, Field>>> words, std::string description, Field Object::*into);
Parameter vector3(std::string key, std::string unit, std::string description, Binding into = {});
Parameter list(std::string key, std::string description, size_t minimumItems = 0, size_t maximumItems = 4096);
Parameter map(std::string key, std::string description);
Parameter spectrum(std::string key, std::string unit, std::string description);
Parameter any(std::string key, std::string description);

Parameter required(Parameter p);
Parameter withDefault(Parameter p, std::string text);
Parameter within(Parameter p, double minimum, double maximum);
Parameter above(Parameter p, double minimum);
Parameter atLeast(Parameter p, double minimum);

struct ParameterTable {
  std::string title;  ///< as in the key reference: "camera"
  std::string description;
  std::vector<Parameter> parameters;

  const Parameter* find(std::string_view key) const;
};

/// A map of a user's file read by a table: unknown and duplicate keys, missing required keys, wrong kinds, wrong units and
/// values out of range have been refused (UserError) by the time one exists.
class Record {
 public:
  Record(const Value& value, const ParameterTable& table);

  bool has(std::string_view key) const;       ///< given, or has a default
  bool given(std::string_view key) const;     ///< written by the user
  double number(std::string_view key) const;  ///< in the table's unit
  TimeCourse course(std::string_view key) const;  ///< the same, of a number or a course
  long long integer(std::string_view key) const;
  bool boolean(std::string_view key) const;
  std::string text(std::string_view key) const;
  glm::dvec3 vector(std::string_view key) const;
  const Value& value(std::string_view key) const;  ///< the raw node; UserError if absent
  const Value* find(std::string_view key) const;
  void read(std::string_view key, double& into) const { into = number(key); }
  void read(std::string_view key, int& into) const { into = static_cast<int>(integer(key)); }
  void read(std::string_view key, long long& into) const { into = integer(key); }
  void read(std::string_view key, std::uint64_t& into) const { into = static_cast<std::uint64_t>(integer(key)); }
  void read(std::string_view key, bool& into) const { into = boolean(key); }
  void read(std::string_view key, std::string& into) const { into = text(key); }
  void read(std::string_view key, glm::dvec3& into) const { into = vector(key); }
  void read(std::string_view key, TimeCourse& into) const;
  template <class Field>
  void read(std::string_view key, std::optional<Field>& into) const {
    read(key, into.emplace());
  }
  /// Every member of it that a key of the table is bound to; one whose key is absent and has no default stays as it is.
  template <class Object>
  void fill(Object& object) const {
    fill(typeid(Object), &object);
  }
  Location where(std::string_view key) const;  ///< of the value, or of the record where absent
  const Location& where() const { return value_->where; }
  const Value& whole() const { return *value_; }

 private:
  const Parameter& parameter(std::string_view key) const;
  void fill(const std::type_info& type, void* object) const;
  const Value* value_;
  const ParameterTable* table_;
  std::map<std::string, Value, std::less<>> defaults_;
};

template <class Object, class Field>
Binding::Binding(Field Object::*member)
    : object(&typeid(Object)), put([member](const Record& r, std::string_view key, void* o) { r.read(key, static_cast<Object*>(o)->*member); }) {}

template <class Object, class Field>
Parameter choice(std::string key, std::type_identity_t<std::vector<std::pair<const char*, Field>>> words, std::string description, Field Object::*into) {
  std::vector<std::string> names;
  for (const auto& [name, value] : words) names.emplace_back(name);
  Parameter p = choice(std::move(key), std::move(names), std::move(description));
  p.into.object = &typeid(Object);
  p.into.put = [words = std::move(words), into](const Record& r, std::string_view k, void* o) {
    for (const auto& [name, value] : words)
      if (r.text(k) == name) static_cast<Object*>(o)->*into = value;
  };
  return p;
}

/// A number in `unit` read from one node; `name` is for messages.
double readNumber(const Value& value, std::string_view unit, std::string_view name);
/// Three numbers: a list of three quantities, or one scalar "x, y, z unit".
glm::dvec3 readVector(const Value& value, std::string_view unit, std::string_view name);
/// Refuses anything that is not a map / a list.
const Value& asMap(const Value& value, std::string_view name);
const Value& asList(const Value& value, std::string_view name);
std::string readText(const Value& value, std::string_view name);

/// The nearest of `candidates` to `word`, or empty where none is near.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);
/// "did you mean 'x'?", or `otherwise` where none is near.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates, const std::string& otherwise = "choose one");
/// "a, b, c".
std::string listed(const std::vector<std::string>& words, const char* between = ", ");
/// `wrong` 'word' ("there is no command 'blow'"); expected: one of the names; fix: the nearest of them, or `otherwise`.
UserError unknownWord(const Location& where, const std::string& wrong, const std::string& word, const std::vector<std::string>& names,
                      const std::string& otherwise = "choose one");

/// The table as Markdown rows.
std::string describe(const ParameterTable& table);

}  // namespace pitviper
