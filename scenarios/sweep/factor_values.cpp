#include "scenarios/sweep/factor_values.hpp"

#include <algorithm>
#include <string_view>

#include "scenarios/reader/expression.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/table.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

std::size_t factorNamed(std::string_view name, const Location& where, const std::vector<SweepFactor>& factors) {
  std::vector<std::string> names;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].name == name) return f;
    names.push_back(factors[f].name);
  }
  throw unknownWord(where, "there is no factor", std::string(name), names, "write it under 'vary:', or '$$' for a dollar");
}

/// A piece of a text: words, or the name of a factor.
struct TextPiece {
  std::string text;
  bool factor = false;
};

/// "$name", "${name}" and "$$" within a text.
std::vector<TextPiece> piecesOf(std::string_view text, const Location& where) {
  std::vector<TextPiece> pieces;
  while (!text.empty()) {
    const std::size_t dollar = std::min(text.find('$'), text.size());
    if (dollar > 0) pieces.push_back({std::string(text.substr(0, dollar))});
    text.remove_prefix(dollar);
    if (text.empty()) break;
    text.remove_prefix(1);
    if (text.starts_with('$')) {
      pieces.push_back({"$"});
      text.remove_prefix(1);
      continue;
    }
    const bool braces = text.starts_with('{');
    const std::size_t length = nameLength(text.substr(braces ? 1 : 0));
    if (length == 0 || (braces && (text.size() <= length + 1 || text[length + 1] != '}')))
      throw UserError(where, "a dollar without a name (" + tokenOf(text) + " behind it)", "'$name', '${name}' or '$$' for a dollar",
                      "write '$$' if a dollar is meant");
    pieces.push_back({std::string(text.substr(braces ? 1 : 0, length)), true});
    text.remove_prefix(length + (braces ? 2 : 0));
  }
  return pieces;
}

void addNames(const Value& value, const std::vector<SweepFactor>& factors, std::set<std::string>& names) {
  if (value.kind == Value::Kind::Scalar)
    for (const TextPiece& piece : piecesOf(value.text, value.where))
      if (piece.factor) names.insert(factors[factorNamed(piece.text, value.where, factors)].name);
  for (const Value& item : value.items) addNames(item, factors, names);
  for (const auto& [key, item] : value.entries) addNames(item, factors, names);
}

std::string evaluatedFor(std::string_view expression, const Location& where, const DrawnFactors& drawn) {
  return evaluate(expression, where, [&](std::string_view name) -> WrittenQuantity {
    const std::size_t f = factorNamed(name, where, drawn.factors);
    const SweepFactor& factor = drawn.factors[f];
    if (factor.choices.empty()) return {drawn.values[f], factor.unit};
    const std::string word = factorText(factor, drawn.values[f]);
    const auto number = splitQuantity(word);
    if (!number || !parseUnit(number->unit))
      throw UserError(where, "factor '" + factor.name + "' is '" + word.substr(0, 60) + "' and stands in an expression", "a number with its unit",
                      "use a factor of numbers, or '$" + factor.name + "' alone");
    return *number;
  });
}

}  // namespace

std::string factorText(const SweepFactor& factor, double value) {
  if (!factor.choices.empty()) return factor.choices[static_cast<std::size_t>(value)];
  return numberText(value) + (factor.unit.empty() ? "" : " " + factor.unit);
}

std::set<std::string> factorsIn(const Value& value, const std::vector<SweepFactor>& factors) {
  std::set<std::string> names;
  addNames(value, factors, names);
  return names;
}

Value workedOut(const Value& value, const DrawnFactors& drawn) {
  Value out = value;
  for (Value& item : out.items) item = workedOut(item, drawn);
  for (auto& [key, item] : out.entries) item = workedOut(item, drawn);
  if (value.kind != Value::Kind::Scalar) return out;
  if (value.text.starts_with('=')) {
    out.quoted = false;
    out.text = evaluatedFor(std::string_view(value.text).substr(1), value.where, drawn);
  } else if (value.text.find('$') != std::string::npos) {
    out.text.clear();
    out.quoted = false;
    for (const TextPiece& piece : piecesOf(value.text, value.where)) {
      if (!piece.factor) {
        out.text += piece.text;
        continue;
      }
      const std::size_t f = factorNamed(piece.text, value.where, drawn.factors);
      out.text += factorText(drawn.factors[f], drawn.values[f]);
    }
  }
  return out;
}

Constraint readConstraint(const Value& value, const std::vector<SweepFactor>& factors) {
  const std::string text = readText(value, "a constraint");
  const std::size_t at = text.find_first_of("<>");
  const std::size_t length = at != std::string::npos && at + 1 < text.size() && text[at + 1] == '=' ? 2 : 1;
  if (at == std::string::npos || text.find_first_of("<>=", at + length) != std::string::npos)
    throw UserError(value.where, "the constraint '" + readable(text.substr(0, 60)) + "' is no comparison", "two expressions with <, <=, > or >= between them",
                    at == std::string::npos ? "write '$range < 3 km'" : "write each comparison as a constraint of its own");
  factorsIn(value, factors);
  return {value.where, text, text.substr(0, at), text.substr(at + length), text.substr(at, length)};
}

bool meets(const Constraint& constraint, const DrawnFactors& drawn) {
  const std::string left = evaluatedFor(constraint.left, constraint.where, drawn), right = evaluatedFor(constraint.right, constraint.where, drawn);
  const auto a = splitQuantity(left), b = splitQuantity(right);
  const auto inUnitOfB = a && b ? (a->unit == b->unit ? a->value : convert(*a, b->unit)) : std::nullopt;
  if (!inUnitOfB)
    throw UserError(constraint.where, "'" + left + "' and '" + right + "' cannot be compared", "two values of one kind, as lengths or times",
                    "correct the units");
  const double x = *inUnitOfB, y = b->value;
  if (constraint.comparison == "<") return x < y;
  if (constraint.comparison == "<=") return x <= y;
  if (constraint.comparison == ">") return x > y;
  return x >= y;
}

}  // namespace pitviper
