#pragma once
// What a sweep's file says of one factor.
#include <optional>
#include <string>

#include "scenarios/sweep/distribution.hpp"
#include "scenarios/sweep/sample_design.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

struct WrittenFactor {
  SweepFactor factor;
  std::string key;  ///< path of the scenario's key; empty: used as $name only
  Location where, keyPlace;
  std::optional<Distribution> distribution;  ///< none where a table has its values
};

/// An entry of `vary`. Errors: UserError for distributions without support, units that differ, and what does not go with the design.
WrittenFactor readFactor(const Value& entry, Design design);

const ParameterTable& factorTable();
const ParameterTable& normalTable();
const ParameterTable& factorGridTable();

/// A name of a column of the sweep's results. Error: UserError for other than letters, digits and '_', and for names of columns that every sweep has.
void checkColumnName(const std::string& name, const Location& where);

}  // namespace pitviper
