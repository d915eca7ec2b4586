#pragma once
// The parameter tables of a scenario: what the reader accepts is what the key reference says.
#include <vector>

#include "sim/parameters/table.hpp"

namespace pitviper::tables {

const ParameterTable& scenario();
const ParameterTable& render();
const ParameterTable& origin();
const ParameterTable& time();
const ParameterTable& limits();
const ParameterTable& airLibrary();
const ParameterTable& background();
const ParameterTable& ground();
const ParameterTable& sun();
const ParameterTable& ambient();
const ParameterTable& material();
const ParameterTable& texture();
const ParameterTable& emission();
const ParameterTable& transmission();
const ParameterTable& light();
const ParameterTable& entity();
const ParameterTable& part();
const ParameterTable& shape();
const ParameterTable& waypoint();
const ParameterTable& geodetic();
const ParameterTable& camera();
const ParameterTable& film();
const ParameterTable& channel();
const ParameterTable& spectral();
const ParameterTable& spectralImage();
const ParameterTable& sensor();
const ParameterTable& probe();

/// All of them and the spectrum, in the order of the key reference.
std::vector<const ParameterTable*> all();

}  // namespace pitviper::tables
