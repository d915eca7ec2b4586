#pragma once
// A value as YAML on one line, for assignments "path.to.key=value".
#include <string>

#include "sim/parameters/value.hpp"

namespace pitviper {

/// Flow style; parseYaml() reads the same value from it. Scalars are in quotes where they were, or where YAML would take them for something else.
std::string yamlLine(const Value& value);

}  // namespace pitviper
