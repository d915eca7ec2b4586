#pragma once
// Factors in a sweep's values and constraints: "$range", "= $range * cos($aspect)", "$range < 3 * $visibility".
#include <set>
#include <string>
#include <vector>

#include "scenarios/sweep/sweep.hpp"
#include "sim/parameters/value.hpp"

namespace pitviper {

/// What one sample's factors are.
struct DrawnFactors {
  const std::vector<SweepFactor>& factors;
  const std::vector<double>& values;
};

/// A factor's value as scenarios have it: "3.25 km", a choice's word. Numbers read back as the same double.
std::string factorText(const SweepFactor& factor, double value);

/// The names of all factors behind dollars in a value. Errors: UserError at the scalar for what is no factor, and for a dollar without a name.
std::set<std::string> factorsIn(const Value& value, const std::vector<SweepFactor>& factors);

/// The value with every scalar worked out: one that begins with '=' is an expression (scenarios/reader/expression.hpp), `$name` and `${name}` are the factor's
/// value as text, alone or within a text, `$$` is a dollar. Errors: UserError at the scalar.
Value workedOut(const Value& value, const DrawnFactors& drawn);

/// A comparison of two expressions.
struct Constraint {
  Location where;
  std::string text, left, right;
  std::string comparison;  ///< < <= > >=
};

/// Errors: UserError for what is no comparison, or holds what is no factor.
Constraint readConstraint(const Value& value, const std::vector<SweepFactor>& factors);
/// Errors: UserError for what evaluate() refuses and for two sides of different kinds.
bool meets(const Constraint& constraint, const DrawnFactors& drawn);

}  // namespace pitviper
