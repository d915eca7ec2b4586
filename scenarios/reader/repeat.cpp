#include "scenarios/reader/repeat.hpp"

#include <cmath>
#include <optional>

#include "scenarios/reader/expression.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

/// "1, 2, 3 m" as a list, as vectors may be written; nothing for another text.
std::optional<Value> asVector(const Value& v) {
  if (v.kind != Value::Kind::Scalar) return std::nullopt;
  Value all;
  all.kind = Value::Kind::List;
  all.where = v.where;
  for (size_t from = 0; from <= v.text.size();) {
    const size_t comma = std::min(v.text.find(',', from), v.text.size());
    Value part;
    part.kind = Value::Kind::Scalar;
    part.where = v.where;
    part.text = v.text.substr(from, comma - from);
    all.items.push_back(std::move(part));
    from = comma + 1;
  }
  if (all.items.size() != 3) return std::nullopt;
  const auto last = splitQuantity(all.items[2].text);
  for (Value& part : all.items) {
    const auto q = splitQuantity(part.text);
    if (!q || !last) return std::nullopt;
    if (q->unit.empty() && !last->unit.empty()) part.text += " " + last->unit;
  }
  return all;
}

std::string shown(const Value& v) { return v.kind == Value::Kind::Scalar ? "'" + v.text.substr(0, 60) + "'" : std::string(v.kindName()); }

void addNumber(Value& value, const Value& step, long long times) {
  const auto number = splitQuantity(value.text), more = splitQuantity(step.text);
  if (!number)
    throw UserError(step.where, "'every' adds to " + shown(value) + " at " + value.where.text(), "a number with its unit there",
                    "remove it here, or write a number there");
  if (!more) throw UserError(step.where, "'every' adds " + shown(step), "a number with its unit", "write '10 m'");
  const auto unit = parseUnit(number->unit), moreUnit = parseUnit(more->unit);
  if (!unit || !moreUnit || unit->dims != moreUnit->dims)
    throw UserError(step.where, "'every' adds " + shown(step) + " to " + shown(value) + " at " + value.where.text(),
                    "two values of one kind, as lengths or times", "correct the units");
  if (times == 0) return;
  const double added = number->unit == more->unit ? more->value : more->value * moreUnit->factor / unit->factor;
  const double sum = number->value + static_cast<double>(times) * added;
  if (!std::isfinite(sum)) throw UserError(step.where, "'every' adds up to more than a double holds", "a smaller step", "correct it");
  value.text = numberText(sum) + (number->unit.empty() ? "" : " " + number->unit);
}

}  // namespace

void addSteps(Value& value, const Value& steps, long long times) {
  if (steps.kind == Value::Kind::Map && value.kind == Value::Kind::Map) {
    for (size_t k = 0; k < steps.entries.size(); ++k) {
      const auto& [key, step] = steps.entries[k];
      Value* at = value.find(key);
      if (!at)
        throw UserError(steps.keyPlaces[k], "'every' adds to '" + key.substr(0, 60) + "', which the entry at " + value.where.text() + " does not have",
                        "a key that is there", "write '" + key.substr(0, 60) + "' there as it is for the first");
      addSteps(*at, step, times);
    }
    return;
  }
  if (steps.kind == Value::Kind::Map && value.kind == Value::Kind::List) {
    for (Value& item : value.items) addSteps(item, steps, times);
    return;
  }
  const auto vector = asVector(value);
  const auto step = asVector(steps);
  if (vector || step) {
    Value sum = vector ? *vector : value;
    addSteps(sum, step ? *step : steps, times);
    if (times != 0) value = std::move(sum);
    return;
  }
  if (steps.kind == Value::Kind::List && value.kind == Value::Kind::List && steps.items.size() == value.items.size()) {
    for (size_t k = 0; k < steps.items.size(); ++k) addSteps(value.items[k], steps.items[k], times);
    return;
  }
  if (steps.kind == Value::Kind::Scalar && value.kind == Value::Kind::Scalar) return addNumber(value, steps, times);
  const auto size = [](const Value& v) { return v.kind == Value::Kind::List ? " of " + std::to_string(v.items.size()) : std::string(); };
  throw UserError(steps.where,
                  "'every' has " + shown(steps) + size(steps) + " where the entry has " + shown(value) + size(value) + " (" + value.where.text() + ")",
                  "the same form as in the entry", "write it as it is there");
}

}  // namespace pitviper
